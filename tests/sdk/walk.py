# SPDX-License-Identifier: Apache-2.0
"""Walks through a page of docs/ as a reader would: writes the files that it shows, runs its
commands and looks for the output that it shows.

The page's files are those of a folder of tests/sdk, and what else it is given; with ALTIPLAN_UPDATE=1 they
are written into the page first.
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys

FILE_BLOCK = re.compile(r"^`(\S+)`:\n\n```(\w+)\n(.*?)^```$", re.M | re.S)
CONSOLE_BLOCK = re.compile(r"^```console\n(.*?)^```$", re.M | re.S)


def install(build, home):
    """Installs the build, and moves it to home/altiplan: it must not know where it is."""
    subprocess.run(["cmake", "--install", build, "--prefix", home / "first"], check=True,
                   stdout=subprocess.DEVNULL)
    (home / "first").rename(home / "altiplan")


def commands(block):
    """(command, lines of expected output) of a console block."""
    found = []
    for line in block.splitlines():
        if line.startswith("$ "):
            found.append((line[2:], []))
        else:
            found[-1][1].append(line)
    return found


def typed(readme):
    """The commands of a README's blocks, lines that a backslash goes on with joined."""
    blocks = re.findall(r"^```sh\n(.*?)^```$", readme, re.M | re.S)
    return "".join(blocks).replace("\\\n", " ").splitlines()


def shows(output, expected):
    """True if the lines appear in that order; … stands for anything, spaces count as one."""
    text, at = " ".join(output.split()), 0
    for part in (" ".join(part.split()) for line in expected for part in line.split("…")):
        at = text.find(part, at)
        if at < 0:
            return False
        at += len(part)
    return True


def compiler_cache(folder):
    """Variables by which what lies in the folder is not compiled again when another folder of a moment ago
    held the same."""
    if not shutil.which("ccache"):
        return {}
    cache = subprocess.run(["ccache", "--get-config", "cache_dir"], check=True, text=True,
                           stdout=subprocess.PIPE).stdout.strip()
    if not os.access(cache, os.W_OK):
        return {}
    return {"CMAKE_CXX_COMPILER_LAUNCHER": "ccache", "CCACHE_DIR": cache,
            "CCACHE_BASEDIR": str(folder), "CCACHE_NOHASHDIR": "1"}


class Shell:
    """A bash session that tells the output and exit code of each command."""

    def __init__(self, folder, program=("bash", "--norc")):
        environment = {name: value for name, value in os.environ.items()
                       if not name.startswith("ALTIPLAN_")}
        environment |= {"HOME": str(folder), "NO_COLOR": "1"} | compiler_cache(folder)
        self.bash = subprocess.Popen(program, cwd=folder, env=environment, text=True,
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
        sys.exit(f"the shell ended in: {command}")


class Page:
    def __init__(self, page, files, others=None):
        """`others`: contents of files, by name, that stand elsewhere."""
        self.page = page
        self.contents = {str(file.relative_to(files)): file.read_text()
                         for file in files.rglob("*") if file.is_file()} | (others or {})

    def fail(self, text):
        sys.exit(f"{self.page.name}: {text}")

    def text(self):
        text = self.page.read_text()
        if os.environ.get("ALTIPLAN_UPDATE") == "1":
            text = FILE_BLOCK.sub(
                lambda m: f"`{m[1]}`:\n\n```{m[2]}\n{self.contents[m[1]]}```", text)
            self.page.write_text(text)
        return text

    def steps(self):
        """(start, kind, …) of what the reader writes and types, in the order of the page."""
        text = self.text()
        found = [(m.start(), "file", m[1], m[3]) for m in FILE_BLOCK.finditer(text)]
        found += [(m.start(), "console", m[1]) for m in CONSOLE_BLOCK.finditer(text)]
        return sorted(found)

    def walk(self, home):
        """The folder that the reader ends in, and the shell."""
        shell = Shell(home)
        folder = home
        unused = set(self.contents)
        for step in self.steps():
            if step[1] == "file":
                self.write(folder, *step[2:])
                unused.discard(step[2])
                continue
            for command, expected in commands(step[2]):
                output, code, folder = shell.run(command)
                if code != 0 or not shows(output, expected):
                    self.fail(f"$ {command}\nexit code {code}\n{output}\nexpected:\n"
                              + "\n".join(expected))
        if unused:
            self.fail(f"does not show {sorted(unused)}")
        return folder, shell

    def write(self, folder, name, content):
        if content != self.contents.get(name):
            self.fail(f"{name} differs from the file of that name; ALTIPLAN_UPDATE=1 mends it")
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(content)
