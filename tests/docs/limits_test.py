# SPDX-License-Identifier: Apache-2.0
"""limits_test.py SOURCE: each page of the documentation stays short and easy to reach.

README.md has at most 90 lines, a plugin's README 60, a page of docs/ 2,500 words, and every page of docs/ is two
clicks or fewer from README.md."""
import pathlib
import re
import sys

SOURCE = pathlib.Path(sys.argv[1]).resolve()
MAX_README_LINES, MAX_PLUGIN_LINES, MAX_WORDS, MAX_CLICKS = 90, 60, 2500, 2
LINK = re.compile(r"\]\(([^)#\s]+\.md)(?:#[^)\s]*)?\)")


def lines(page):
    return len(page.read_text().splitlines())


def linked(page):
    return {(page.parent / target).resolve() for target in LINK.findall(page.read_text())
            if ":" not in target}


def reached():
    """Pages within MAX_CLICKS of README.md."""
    found = front = {SOURCE / "README.md"}
    for _ in range(MAX_CLICKS):
        front = {page for one in front for page in linked(one) if page.exists()} - found
        found = found | front
    return found


def main():
    problems = []
    pages = sorted((SOURCE / "docs").rglob("*.md"))
    if (count := lines(SOURCE / "README.md")) > MAX_README_LINES:
        problems.append(f"README.md: {count} lines, at most {MAX_README_LINES}")
    for page in sorted((SOURCE / "plugins").glob("*/*/README.md")):
        if (count := lines(page)) > MAX_PLUGIN_LINES:
            problems.append(f"{page.relative_to(SOURCE)}: {count} lines, at most {MAX_PLUGIN_LINES}")
    for page in pages:
        if (count := len(page.read_text().split())) > MAX_WORDS:
            problems.append(f"{page.relative_to(SOURCE)}: {count} words, at most {MAX_WORDS}")
    problems += [f"{page.relative_to(SOURCE)}: more than {MAX_CLICKS} clicks from README.md"
                 for page in pages if page not in reached()]
    if problems:
        sys.exit("\n".join(problems))


main()
