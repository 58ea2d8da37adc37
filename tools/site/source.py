# SPDX-License-Identifier: Apache-2.0
"""source.py ROOT PROGRAM OUT: the pages of the site as mkdocs wants them, in OUT/source, and OUT/mkdocs.yml.

OUT/source is laid out as the repository is, so that a link from page to page needs no change. What is
added are pages of plugins, from their README and what `altiplan describe` says, and lists of what is
in a folder.
"""
import json
import pathlib
import re
import shutil
import sys

import plugins

ROOT, PROGRAM, OUT = (pathlib.Path(argument).resolve() for argument in sys.argv[1:4])
SOURCE = OUT / "source"

# Groups of the navigation and their pages, in the order that a newcomer needs. Entries without a matching
# page in the repository are skipped.
GROUPS = [
    ("Start", ["README.md", "docs/README.md"]),
    ("Tutorials", [f"docs/tutorials/{page}.md" for page in (
        "first-route", "first-plugin", "first-study", "reproduce-a-paper")]),
    ("How-to guides", [f"docs/how-to/{page}.md" for page in (
        "install", "survey-an-area", "view-results", "gallery", "exchange-missions", "way-home", "flying", "tune-parameters",
        "published-scenarios", "run-large-studies", "write-a-plugin", "plan-with-the-kit",
        "swarm-with-the-kit", "debug-a-plugin")]),
    ("Reference", [*(f"docs/reference/{page}.md" for page in (
        "cli", "files", "objectives", "performance", "result", "route-formats", "plugins", "studies", "report", "statistics", "run-outcomes",
        "study-database", "check-plugin", "conformance", "abi", "api")), "framework/python/README.md"]),
    ("Interfaces", ["docs/interfaces/README.md", "docs/interfaces/request-and-world.md",
                    *(f"docs/interfaces/{kind}.md" for kind in plugins.KINDS),
                    "docs/interfaces/*.md"]),
    ("Plugins", plugins.KINDS),
    ("Explanation", ["docs/explanation/*.md"]),
    ("Papers", ["docs/papers/README.md", "docs/papers/*.md"]),
    ("Decisions", ["docs/decisions/README.md", "docs/decisions/*.md"]),
    ("Developers", ["CONTRIBUTING.md", "docs/developers/*.md", "framework/*.md",
                    "tests/*/README.md", "tools/viewer/*.md", "CHANGELOG.md"]),
]
API = """# The API

[Classes, functions and headers](../../api/index.html), by Doxygen from the comments of the public headers: the
interfaces, what they are told, the kit, and the conformance suite. What a plugin needs of it at first stands
in [Interfaces](../interfaces/README.md).
"""
LISTED = {"docs/papers": "Papers, run again", "docs/decisions": "Decisions"}
FENCE = re.compile(r"^( *)```.*?^\1```$", re.M | re.S)
LINK = re.compile(r"(\]\()([^)\s]+)(\))")


def title(page):
    return re.search(r"^# (.+)$", (SOURCE / page).read_text(), re.M)[1].replace("`", "")


def outside_of_code(text, change):
    """The text, changed outside its code blocks."""
    parts, at = [], 0
    for block in FENCE.finditer(text):
        parts += [change(text[at:block.start()]), block[0]]
        at = block.end()
    return "".join(parts + [change(text[at:])])


def write(page, text, problems):
    """Writes a page, and copies the repository files other than pages that it links to."""
    def link(match):
        target, _, anchor = match[2].partition("#")
        if not target or re.match(r"[a-z]+:", target):
            return match[0]
        file = (ROOT / page).parent / target
        if file.is_dir():
            return f"{match[1]}{target.rstrip('/')}/README.md{anchor and '#'}{anchor}{match[3]}"
        if file.suffix == ".md" or (SOURCE / page).parent.joinpath(target).exists():
            return match[0]
        if not file.is_file():
            problems.append(f"{page}: links to {target}, which is not there")
            return match[0]
        copy = SOURCE / file.resolve().relative_to(ROOT)
        copy.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(file, copy)
        return match[0]

    def readable(part):
        # GitHub begins a list right after a paragraph, and goes on after a mark; mkdocs only after an
        # empty line.
        part = re.sub(r"^((?![-*] |\d+\. |[ |#<]).+)\n(?=- |1\. )", r"\1\n\n", part, flags=re.M)
        return LINK.sub(link, re.sub(r"^(<!-- .* -->)\n", r"\1\n\n", part, flags=re.M))

    (SOURCE / page).parent.mkdir(parents=True, exist_ok=True)
    (SOURCE / page).write_text(outside_of_code(text, readable))


def write_list(folder, heading, problems):
    pages = sorted((ROOT / folder).glob("*.md"))
    if ROOT / folder / "README.md" not in pages:
        lines = [f"- [{title(page.relative_to(ROOT))}]({page.name})" for page in pages]
        write(f"{folder}/README.md", f"# {heading}\n\n" + "\n".join(lines) + "\n", problems)


def nav(problems):
    """Every page once, by groups."""
    left = {str(page.relative_to(SOURCE)) for page in SOURCE.rglob("*.md")}
    groups = []
    for heading, patterns in GROUPS:
        if heading == "Plugins":
            pages, kinds = ["plugins/README.md"], []
            for kind in patterns:
                members = sorted(page for page in left if page.startswith(f"plugins/{kind}/"))
                own = f"plugins/{kind}/README.md"
                names = [{page.split("/")[2] + (" (design)" if page.endswith("design.md") else ""): page}
                         for page in members if page != own]
                kinds.append({plugins.plural(kind).capitalize(): [own, *names]})
                left -= set(members)
            groups.append({heading: pages + kinds})
            left -= set(pages)
            continue
        pages = []
        for pattern in patterns:
            found = sorted(str(page.relative_to(SOURCE)) for page in SOURCE.glob(pattern))
            pages += [page for page in found if page in left]
            left -= set(found)
        groups.append({heading: pages})
    problems += [f"{page} is in no group: add it to GROUPS in tools/site/source.py"
                 for page in sorted(left)]
    return groups


def main():
    shutil.rmtree(SOURCE, ignore_errors=True)
    problems = []
    for page in [*ROOT.glob("*.md"), *ROOT.glob("docs/**/*.md"), *ROOT.glob("tools/viewer/*.md"),
                 *ROOT.glob("tests/*/README.md"), *ROOT.glob("framework/*.md"),
                 *ROOT.glob("framework/python/*.md"),
                 *ROOT.glob("plugins/*/*/design.md")]:
        write(page.relative_to(ROOT), page.read_text(), problems)
    for page, text in plugins.pages(ROOT, PROGRAM, problems):
        write(page, text, problems)
    for folder, heading in LISTED.items():
        write_list(folder, heading, problems)
    (SOURCE / "docs/reference/api.md").write_text(API)  # its link is created by Doxygen
    groups = nav(problems)
    if problems:
        sys.exit("\n".join(problems))
    config = pathlib.Path(__file__).with_name("mkdocs.yml").read_text()
    (OUT / "mkdocs.yml").write_text(f"{config}nav: {json.dumps(groups)}\n")


main()
