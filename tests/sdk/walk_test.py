# SPDX-License-Identifier: Apache-2.0
"""walk_test.py SOURCE BUILD: walks through docs/writing-a-plugin.md as a reader would.

Installs the build, moves the installation, writes the files that the page shows, runs its commands
and looks for the output that it shows. Then holds the routes of the page's own environment and
constraint against geometry of this file's own, with and without them. The page's files are those of
tests/sdk/my_plugins; with ALTIPLAN_UPDATE=1 they are written into the page first.
"""
import json
import math
import os
import pathlib
import re
import subprocess
import sys
import tempfile

SOURCE, BUILD = (pathlib.Path(argument) for argument in sys.argv[1:3])
PAGE = SOURCE / "docs/writing-a-plugin.md"
FILES = SOURCE / "tests/sdk/my_plugins"
FILE_BLOCK = re.compile(r"^`(\S+)`:\n\n```(\w+)\n(.*?)^```$", re.M | re.S)
CONSOLE_BLOCK = re.compile(r"^```console\n(.*?)^```$", re.M | re.S)


def fail(text):
    sys.exit(f"{PAGE.name}: {text}")


def page():
    text = PAGE.read_text()
    if os.environ.get("ALTIPLAN_UPDATE") == "1":
        text = FILE_BLOCK.sub(
            lambda m: f"`{m[1]}`:\n\n```{m[2]}\n{(FILES / m[1]).read_text()}```", text)
        PAGE.write_text(text)
    return text


def steps(text):
    """(start, kind, …) of what the reader writes and types, in the order of the page."""
    found = [(m.start(), "file", m[1], m[3]) for m in FILE_BLOCK.finditer(text)]
    found += [(m.start(), "console", m[1]) for m in CONSOLE_BLOCK.finditer(text)]
    return sorted(found)


def commands(block):
    """(command, lines of expected output) of a console block."""
    found = []
    for line in block.splitlines():
        if line.startswith("$ "):
            found.append((line[2:], []))
        else:
            found[-1][1].append(line)
    return found


class Shell:
    """A bash session that tells the output and exit code of each command."""

    def __init__(self, folder, environment):
        self.bash = subprocess.Popen(["bash", "--norc"], cwd=folder, env=environment, text=True,
                                     stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                                     stderr=subprocess.STDOUT)

    def run(self, command):
        self.bash.stdin.write(f"{command}\necho \"@@ $? $PWD\"\n")
        self.bash.stdin.flush()
        lines = []
        for line in self.bash.stdout:
            if line.startswith("@@ "):
                _, code, folder = line.split(maxsplit=2)
                return "".join(lines), int(code), pathlib.Path(folder.strip())
            lines.append(line)
        fail(f"the shell ended in: {command}")


def shows(output, expected):
    """Whether the lines appear in that order; … stands for anything, spaces count as one."""
    pattern = ".*".join(
        ".*".join(re.escape(" ".join(part.split())) for part in line.split("…"))
        for line in expected)
    return re.search(pattern, " ".join(output.split()), re.S)


def walk(text, home):
    environment = {name: value for name, value in os.environ.items()
                   if not name.startswith("ALTIPLAN_")}
    environment |= {"HOME": str(home), "NO_COLOR": "1"}
    shell = Shell(home, environment)
    folder = home
    for step in steps(text):
        if step[1] == "file":
            name, content = step[2:]
            if content != (FILES / name).read_text() and name != "CMakeLists.txt":
                fail(f"{name} differs from tests/sdk/my_plugins/{name}; ALTIPLAN_UPDATE=1 mends it")
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            (folder / name).write_text(content)
            continue
        for command, expected in commands(step[2]):
            output, code, folder = shell.run(command)
            if code != 0 or not shows(output, expected):
                fail(f"$ {command}\nexit code {code}\n{output}\nexpected:\n" + "\n".join(expected))
    unused = {str(file.relative_to(FILES)) for file in FILES.rglob("*") if file.is_file()}
    unused -= {step[2] for step in steps(text) if step[1] == "file"}
    if unused:
        fail(f"does not show {sorted(unused)}")
    return folder, shell


def points(route):
    """The route in steps of a few metres."""
    for a, b in zip(route, route[1:]):
        n = max(1, int(math.dist(a, b) / 2))
        for i in range(n + 1):
            yield tuple(p + (q - p) * i / n for p, q in zip(a, b))


def from_wires(p, a, b):
    """Horizontal distance from the outer wire of a power line with two towers."""
    length = math.dist(a, b) ** 2
    t = min(1, max(0, ((p[0] - a[0]) * (b[0] - a[0]) + (p[1] - a[1]) * (b[1] - a[1])) / length))
    return math.dist(p[:2], [a[i] + (b[i] - a[i]) * t for i in (0, 1)]) - 15


def judge(folder, shell, name, drop):
    """Runs flight.yaml without the lines that hold a word; what its flight keeps from what."""
    for file in ("scenario.yaml", "flight.yaml"):
        lines = (folder / file).read_text().splitlines(keepends=True)
        kept = [line for line in lines if not any(word in line for word in drop)]
        (folder / f"{name}_{file}").write_text(
            "".join(kept).replace("scenario: scenario", f"scenario: {name}_scenario"))
    output, code, _ = shell.run(f"altiplan run {name}_flight.yaml --out {name}.json")
    if code > (1 if drop else 0):
        fail(output)
    result = json.loads((folder / f"{name}.json").read_text())
    flown = list(points([p[1:] for p in result["flight"]["track"]]))
    planned = list(points(result["route"]))
    return {
        "wires": min(from_wires(p, (2000, -1500), (2000, 700)) for p in planned),
        "new_wires": min(from_wires(p, (4300, 200), (4300, 500)) for p in flown),
        "village": min(math.dist(p[:2], (2000, 900)) for p in planned) - 300,
        "second_village": min(math.dist(p[:2], (4300, 900)) for p in flown) - 340,
    }


def honours(folder, shell):
    """The vehicle's radius is 5 m."""
    kept = judge(folder, shell, "all", [])
    assert kept["wires"] >= 5 and kept["new_wires"] >= 5, kept
    assert kept["village"] >= -1e-3 and kept["second_village"] >= -1e-3, kept
    # The same without them: else nothing would be shown.
    without = judge(folder, shell, "no_wires", ["[2000, 700]", "id: wires"])
    assert without["wires"] < 0, without
    without = judge(folder, shell, "no_new_wires", ["[4300, 500]", "id: new_wires", "known"])
    assert without["new_wires"] < 0, without
    without = judge(folder, shell, "no_village", ["[2000, 900]"])
    assert without["village"] < -100, without
    without = judge(folder, shell, "no_second_village", ["[4300, 900]"])
    assert without["second_village"] < -1, without


def main():
    with tempfile.TemporaryDirectory() as folder:
        home = pathlib.Path(folder)
        subprocess.run(["cmake", "--install", BUILD, "--prefix", home / "first"], check=True,
                       stdout=subprocess.DEVNULL)
        (home / "first").rename(home / "altiplan")
        honours(*walk(page(), home))


main()
