# SPDX-License-Identifier: Apache-2.0
"""interfaces_test.py SOURCE: the pages of docs/interfaces agree with the code.

Between their marks are the contracts of the headers, the files of `altiplan new`, which tests/sdk/new_test.py
builds, and pieces of snippets.cpp; with ALTIPLAN_UPDATE=1 the test writes them. Quoted messages occur in the
source, and the page of the kit lists every header of it.
"""
import os
import pathlib
import re
import sys
import textwrap

SOURCE = pathlib.Path(sys.argv[1])
PAGES = SOURCE / "docs/interfaces"
TEMPLATES = SOURCE / "tools/altiplan/templates"
BESIDE = {"environment": ["ground", "field"]}  # further headers of a kind, with contracts of their own
KINDS = sorted(folder.name for folder in TEMPLATES.iterdir() if folder.name not in ("shared", "python"))
MARK = re.compile(r"^(<!-- (contract of|example|test|code) (\w+) -->\n).*?^(<!-- /\w+ -->)$", re.M | re.S)
COMMENT_AND_CLASS = re.compile(r"((?:^ *///.*\n)+)(?:class|struct) (?:ALTIPLAN_API )?(\w+)", re.M)


def contract(text):
    """[(class, [clause])] of a header, in its order. Clauses are numbered from 1."""
    found = []
    for comment, name in COMMENT_AND_CLASS.findall(text):
        words = " ".join(re.sub(r"^ *///", "", comment, flags=re.M).split())
        _, begins, listed = words.partition("Contract")
        parts = []
        while begins and (clause := re.search(rf"(?:^|\s){len(parts) + 1}\. ", listed)):
            parts.append(listed[:clause.start()].strip())
            listed = listed[clause.end():]
        if parts:
            found.append((name, [*parts[1:], listed.strip()]))
    return found


def contract_list(kind):
    """The contract of the interface itself first."""
    found = []
    for header in [kind, *BESIDE.get(kind, [])]:
        its = contract((SOURCE / f"framework/include/altiplan/{header}.hpp").read_text())
        assert its, f"no contract in {header}.hpp"
        found += [(header, name, listed) for name, listed in its]
    found.sort(key=lambda entry: entry[1].lower() != kind.replace("_", ""))
    return "\n".join(f"Of `{name}`, in `altiplan/{header}.hpp`:\n\n"
                     + "".join(f"{number}. {clause}\n" for number, clause in enumerate(listed, 1))
                     for header, name, listed in found)


def file_of(kind, name):
    own = TEMPLATES / kind / name
    file = own if own.exists() else TEMPLATES / "shared" / name
    return (f"`{name}`:\n\n```cpp\n{file.read_text()}```\n"
            .replace("@name@", f"my_{kind}").replace("@kind@", kind))


def snippet(name):
    text = (SOURCE / "tests/docs/snippets.cpp").read_text()
    code = re.search(rf"^ *// {name} {{\n(.*?)^ *// }}$", text, re.M | re.S)
    return f"```cpp\n{textwrap.dedent(code[1])}```\n"


def filled(match):
    opening, what, name, closing = match.groups()
    text = {"contract of": contract_list, "code": snippet,
            "example": lambda kind: file_of(kind, "@name@.cpp"),
            "test": lambda kind: file_of(kind, "@name@_test.cpp")}[what](name)
    return opening + text + closing


def up_to_date(page):
    text = page.read_text()
    wanted = MARK.sub(filled, text)
    if os.environ.get("ALTIPLAN_UPDATE") == "1":
        page.write_text(wanted)
        return []
    return [] if text == wanted else [f"{page}: out of date; ALTIPLAN_UPDATE=1 mends it"]


def parts_of(kind):
    text = (PAGES / f"{kind}.md").read_text()
    marks = [(what, of) for _, what, of, _ in MARK.findall(text) if what != "code"]
    return ([] if marks == [("contract of", kind), ("example", kind), ("test", kind)] else
            [f"{kind}.md: expected the marks of its contract, example and test, found {marks}"])


def sources():
    """The string literals of the sources, adjacent ones joined."""
    folders = ["framework/src", "framework/host", "framework/study", "framework/tune",
               "framework/conformance"]
    text = "\n".join(file.read_text() for folder in folders
                     for file in sorted((SOURCE / folder).rglob("*.[ch]pp")))
    return re.sub(r'"\s*\n?\s*"', "", text)


def unknown_messages(page, code):
    """Messages quoted in the table of mistakes, second column, that are not in the code."""
    _, _, table = page.read_text().partition("## Common mistakes")
    quoted = [message for row in re.findall(r"^\|.*\|(.*)\|$", table, re.M)
              for message in re.findall(r"`([^`]+)`", row)]
    parts = [(message, part.strip(" ,")) for message in quoted for part in message.split("…")]
    return [f"{page.name}: no message has the words '{part}' of '{message}'"
            for message, part in parts if part not in code]


def main():
    problems = []
    code = sources()
    for kind in KINDS:
        problems += parts_of(kind)
    for page in sorted(PAGES.glob("*.md")):
        problems += up_to_date(page) + unknown_messages(page, code)
    kit = (PAGES / "kit.md").read_text()
    root = SOURCE / "framework/include/altiplan/kit"
    headers = {str(file.relative_to(root)) for file in root.glob("**/*.hpp")}
    headers |= {f"formats/{file.name}" for file in (root.parent / "formats").glob("*.hpp")}
    named = set()
    for section in re.split(r"^(?=## )", kit, flags=re.MULTILINE):
        heading, _, rows = section.partition("\n")
        folder = re.findall(r"`(\w+/)`", heading)
        of_all = folder[0] if len(folder) == 1 else ""  # the heading names the folder of its rows
        named |= {of_all + name for name in re.findall(r"`([\w/]+\.hpp)`", rows)}
    problems += [f"kit.md: does not list {name}" for name in sorted(headers - named)]
    problems += [f"kit.md: there is no {name}" for name in sorted(named - headers)]
    shown = {name for page in PAGES.glob("*.md")
             for _, what, name, _ in MARK.findall(page.read_text()) if what == "code"}
    made = set(re.findall(r"// (\w+) {$", (SOURCE / "tests/docs/snippets.cpp").read_text(), re.M))
    problems += [f"snippets.cpp: no page shows {name}" for name in sorted(made - shown)]
    if problems:
        sys.exit("\n".join(problems))


main()
