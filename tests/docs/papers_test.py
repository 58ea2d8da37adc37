# SPDX-License-Identifier: Apache-2.0
"""papers_test.py PROGRAM SOURCE: the tables of docs/papers print what configs/papers declares, and each row of
theirs is declared. With ALTIPLAN_UPDATE=1 the figures of columns are written into the tables.

The head of a figure's column is its name; the paper's figures are in the column "NAME, paper" or "paper", or
in a row that begins with "paper". A claim's row names it, and has its verdict and estimate among other words.
"""
import json
import os
import pathlib
import re
import subprocess
import sys

PROGRAM, SOURCE = sys.argv[1], pathlib.Path(sys.argv[2])


def plain(cell):
    """The text of a Markdown cell."""
    return re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", cell).replace("\\", "").replace("`", "").strip()


class Table:
    """A Markdown table, its cells as plain text."""

    def __init__(self, heading, lines, begin):
        self.heading, self.lines, self.begin = heading, lines, begin
        self.head = self.cells(begin)
        self.rows = []
        for at in range(begin + 2, len(lines)):
            if not lines[at].startswith("|"):
                break
            self.rows.append(at)
        self.declared = set()

    def cells(self, at):
        return [plain(cell) for cell in re.split(r"(?<!\\)\|", self.lines[at])[1:-1]]

    def cell(self, at, name):
        return self.cells(at)[self.head.index(name)] if name in self.head else None

    def write(self, at, name, text):
        cells = re.split(r"(?<!\\)\|", self.lines[at])
        cells[1 + self.head.index(name)] = f" {text} "
        self.lines[at] = "|".join(cells)


class Page:
    def __init__(self, name):
        self.file = SOURCE / name
        self.lines = self.file.read_text().split("\n")
        self.tables, heading = [], ""
        for at, line in enumerate(self.lines):
            if line.startswith("#"):
                heading = line.lstrip("# ").strip()
            elif re.match(r"^\|[-|: ]+\|$", line):
                self.tables.append(Table(heading, self.lines, at - 1))

    def find(self, row):
        """The table and line of a declared row."""
        claims = {figure["claim"] for figure in row["figures"] if "claim" in figure}
        names = {figure["name"] for figure in row["figures"]}
        found = [(table, at) for table in self.tables if table.heading == row["heading"]
                 for at in table.rows
                 if table.cells(at)[0] == row["what"] and claims <= set(table.cells(at))
                 and names <= set(table.head)]
        return found[0] if len(found) == 1 else (None, len(found))


def has_paper(table, at, figure):
    """Whether the page prints the paper's figure."""
    beside = table.cell(at, figure["name"] + ", paper")
    beside = table.cell(at, "paper") if beside is None else beside
    of_paper = [table.cell(other, figure["name"]) for other in table.rows
                if table.cells(other)[0].startswith("paper")]
    return figure["paper"] in ([beside] if beside is not None else of_paper)


def figure_problem(table, at, figure):
    cell = table.cell(at, figure["name"])
    if "claim" in figure:
        fits = figure["documentation"] in cell
    else:
        fits = figure["documentation"] == cell
        if not fits and os.environ.get("ALTIPLAN_UPDATE") == "1":
            table.write(at, figure["name"], figure["documentation"])
            return None
    if not fits:
        return f"'{cell}', declared is '{figure['documentation']}'"
    if figure["paper"] and not has_paper(table, at, figure):
        return f"the paper's figure '{figure['paper']}' is missing"
    return None


def problems_of(paper):
    page = Page(paper["page"])
    for row in paper["rows"]:
        table, at = page.find(row)
        if table is None:
            yield f"{paper['page']}, {row['heading']}: {at} rows '{row['what']}' (row {row['id']})"
            continue
        table.declared.add(at)
        for figure in row["figures"]:
            if problem := figure_problem(table, at, figure):
                yield (f"{paper['page']}:{at + 1}: {row['what']}, {figure['name']}: {problem} "
                       f"(row {row['id']})")
    for table in page.tables:
        for at in table.rows if table.declared else []:
            if at not in table.declared and not table.cells(at)[0].startswith("paper"):
                yield f"{paper['page']}:{at + 1}: no row of {paper['file']} declares '{table.cells(at)[0]}'"
    if os.environ.get("ALTIPLAN_UPDATE") == "1":
        page.file.write_text("\n".join(page.lines))


def main():
    listed = subprocess.run([PROGRAM, "reproduce", "--list", "--json"], check=True,
                            stdout=subprocess.PIPE).stdout
    papers = json.loads(listed)
    assert len(papers) == 7, [paper["name"] for paper in papers]
    problems = [problem for paper in papers for problem in problems_of(paper)]
    if problems:
        sys.exit("\n".join(problems))
    print(sum(len(row["figures"]) for paper in papers for row in paper["rows"]), "figures")


main()
