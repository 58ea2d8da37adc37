# SPDX-License-Identifier: Apache-2.0
"""check.py SITE: checks that all links of a built site lead to existing pages and headings, that it loads
nothing from the network, and that no list or table was rendered as a paragraph."""
import html.parser
import pathlib
import re
import sys
import urllib.parse

NOT_SEEN = re.compile(r"^(?:- |\d\. |(?:<p>)?\|[-|]+$).*", re.M)
LOADED = {("script", "src"), ("img", "src"), ("link", "href"), ("iframe", "src"), ("source", "src")}


class Page(html.parser.HTMLParser):
    def __init__(self, file):
        super().__init__()
        self.anchors, self.links, self.loads = set(), set(), set()
        text = file.read_text()
        self.feed(text)
        self.not_seen = NOT_SEEN.findall(re.sub(r"<pre.*?</pre>", "", text, flags=re.S))

    def handle_starttag(self, tag, attrs):
        for name, value in attrs:
            if name in ("id", "name") and value:
                self.anchors.add(value)
            elif name in ("href", "src") and value:
                self.links.add(value)
                if (tag, name) in LOADED:
                    self.loads.add(value)


def leads_nowhere(pages, file, link):
    address = urllib.parse.urlsplit(link)
    if address.scheme or address.netloc:
        return False
    target = (file.parent / urllib.parse.unquote(address.path)).resolve() if address.path else file
    if not target.exists():
        return True
    anchor = urllib.parse.unquote(address.fragment)
    # Doxygen links to headings of omitted items.
    return (bool(anchor) and target in pages and target.parent.name != "api"
            and anchor not in pages[target].anchors)


def main():
    site = pathlib.Path(sys.argv[1]).resolve()
    pages = {file: Page(file) for file in site.rglob("*.html")}
    problems = []
    for file, page in sorted(pages.items()):
        name = file.relative_to(site)
        if name == pathlib.Path("404.html"):  # its links are for the root of a server
            continue
        problems += [f"{name}: '{link}' leads nowhere" for link in sorted(page.links)
                     if leads_nowhere(pages, file, link)]
        problems += [f"{name}: loads {link} from the network" for link in sorted(page.loads)
                     if re.match(r"(https?:)?//", link)]
        problems += [f"{name}: a list or table is none: {line}" for line in page.not_seen]
    for file in site.rglob("*.css"):
        problems += [f"{file.relative_to(site)}: loads {link} from the network" for link in
                     re.findall(r"url\(['\"]?((?:https?:)?//[^)'\"]+)", file.read_text())]
    if problems:
        sys.exit("\n".join(problems))
    print(f"{len(pages)} pages, {sum(len(page.links) for page in pages.values())} links")


main()
