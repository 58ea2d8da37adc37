# SPDX-License-Identifier: Apache-2.0
"""pages_test.py SOURCE BUILD: runs the commands that the pages show, in a folder with a copy of configs/.

A line of a block that begins with the name of a program is a command. Each is run, once, or stands in
NOT_RUN with the reason; the pages of WALKED have tests of their own, which also look for the output shown.
"""
import pathlib
import re
import shutil
import sys
import tempfile

import walk

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from night import NIGHTLY  # noqa: E402

SOURCE, BUILD = (pathlib.Path(argument).resolve() for argument in sys.argv[1:3])
WALKED = {"docs/how-to/write-a-plugin.md", "docs/how-to/plan-with-the-kit.md", "docs/how-to/swarm-with-the-kit.md",
          *(f"docs/tutorials/{page.name}" for page in (SOURCE / "docs/tutorials").glob("*.md"))}
NOT_RUN = {
    r"tools/(run|setup|test|docs|package)\b": "fetches packages, and builds all",
    r"tools/bench/": "draws what a benchmark of minutes measured",
    r"(cmake|ctest)\b": "builds all; that its outcome works, the other commands show",
    r"(cd|export) ": "of another folder",
    r"altiplan-bench\b":
        "minutes of measuring, or on published maps; the tests bench_… run such programs",
    r"altiplan tune\b": "minutes; tests/tune tunes less",
    r"altiplan report (?!(quick|rooms)\.db)": "of studies of minutes to hours, or of the reader's",
    r"altiplan (study|merge|slurm|replay|compare) (study|part-1|before)\.":
        "study.yaml is the reader's; tests/study",
    r"altiplan study configs/studies/barn-300": "of files that the reader fetches; study_scenario_sets",
    r"altiplan (fly result|view result\.flown)": "needs a vehicle; tests/link flies such results",
    r"altiplan edit ": "lasts as long as its page; viewer_edit opens one",
    r"altiplan view .*--png": "needs a browser; the tests viewer_… look at pictures",
    r"gdb\b|~/altiplan-asan|altiplan (run first\.yaml|check-plugin)":
        "of the reader's plugin, in a debugger or with sanitizers; sdk_walk and sdk_new make such",
}
if not NIGHTLY:
    NOT_RUN[r"(build/release/bin/)?altiplan (study|report) \S*quick\."] = "by night; docs_tutorial_first_study runs such"
COMMAND = re.compile(r"^(?:\$ )?((?:altiplan(?:-\w[\w-]*)?|tools/[\w/.]+|build/[\w/]+|~/[\w/-]+|cmake|"
                     r"ctest|cd|export|gdb)(?: .*|$))", re.M)
BLOCK = re.compile(r"^```(\w*)\n(.*?)^```$", re.M | re.S)
SAVED = re.compile(r"`(\w+\.(?:yaml|geojson))`[^`\n]*:\n\n```(?:yaml|json)\n(.*?)^```$", re.M | re.S)


def commands(text):
    """Lines that a backslash goes on with joined, without what is said about them."""
    blocks = "".join(block for language, block in BLOCK.findall(text)
                     if language in ("", "sh", "console")).replace("\\\n", " ")
    return [re.sub(r"\s+# .*", "", line) for line in COMMAND.findall(blocks)]


def same(command):
    """The command as the other page has it that shows it by another path."""
    return command.replace("build/release/bin/", "").replace("build/quick", "quick")


def without_times(table):
    return [re.sub(r" +[\d.]+$", "", line) for line in table.splitlines()]


def shows_the_first_run(shell):
    """The table of README.md is that of its pipeline, but for the last column: times."""
    readme = (SOURCE / "README.md").read_text()
    shown = re.search(r"^(ridge_crossing: solved\n.*?)^```$", readme, re.M | re.S)[1]
    printed, code, _ = shell.run("altiplan run configs/pipelines/ridge_crossing.yaml")
    if code != 0 or without_times(shown) != without_times(printed):
        sys.exit(f"README.md shows another run than\n{printed}")


def main():
    used, done = set(), set()
    with tempfile.TemporaryDirectory() as name:
        home = pathlib.Path(name)
        shutil.copytree(SOURCE / "configs", home / "configs")
        (home / "build").mkdir()
        (home / "build/release").symlink_to(BUILD)
        shell = walk.Shell(home)
        shell.run(f"export PATH={BUILD}/bin:$PATH")
        for page in [*sorted(SOURCE.glob("*.md")), *sorted((SOURCE / "docs").rglob("*.md"))]:
            if str(page.relative_to(SOURCE)) in WALKED:
                continue
            text = page.read_text()
            for file, content in SAVED.findall(text):
                (home / file).write_text(content)
            for command in commands(text):
                reasons = [pattern for pattern in NOT_RUN if re.match(pattern, command)]
                used.update(reasons)
                if reasons or same(command) in done:
                    continue
                output, code, _ = shell.run(command)
                if code != 0:
                    sys.exit(f"{page.name}: $ {command}\nexit code {code}\n{output}")
                done.add(same(command))
                print(f"{page.name}: $ {command}")
        shows_the_first_run(shell)
    if left := set(NOT_RUN) - used:
        sys.exit(f"NOT_RUN holds what no page shows: {sorted(left)}")


main()
