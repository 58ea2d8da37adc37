# SPDX-License-Identifier: Apache-2.0
"""new_test.py BUILD: projects that `altiplan new` writes, as their user meets them.

Each kind: the commands of its README word for word, with warnings as errors; what was built; the same
source by clang, where there is one. Then what is refused, and that it leaves nothing behind. By day the commands
of one kind alone, and of the others what clang makes of the plugin.
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

import walk

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from night import NIGHTLY  # noqa: E402

BUILD = pathlib.Path(sys.argv[1])
KINDS = ["constraint", "environment", "local_planner", "objective", "planner", "smoother", "task", "tuner"]
WARNINGS = "-Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Werror"


def clang(home, *arguments):
    subprocess.run(["clang++", "-std=c++20", *WARNINGS.split(), f"-I{home}/altiplan/include",
                    "-isystem/usr/include/eigen3", *arguments], check=True)


def written(shell, home, kind):
    """The folder of a new project, whose sources compile."""
    name = f"my_{kind}"
    before = set(home.iterdir())
    output, code, _ = shell.run(f"cd {home} && altiplan new {kind} {name}")
    assert code == 0 and f"{name}/README.md" in output, output
    folder = home / name
    assert set(home.iterdir()) - before == {folder}
    for file in folder.rglob("*"):
        text = file.read_text() if file.is_file() else ""
        assert not re.search(r"@\w+@", file.name + text), f"{file}: a placeholder is left"
    if shutil.which("clang++"):
        for source in folder.glob("*.cpp" if NIGHTLY else f"{name}.cpp"):
            clang(home, "-include-pch", home / "all.pch", "-fsyntax-only", source)
    return folder


def built(shell, folder, kind):
    """The commands of its README work."""
    for line in walk.typed((folder / "README.md").read_text()):
        output, code, _ = shell.run(f"cd {folder} && {line}")
        assert code == 0, f"{kind}: $ {line}\nexit code {code}\n{output}"
        assert "warning" not in output.lower(), f"{kind}: $ {line}\n{output}"
    assert [file.name for file in folder.rglob("*.so")] == [f"libaltiplan_{kind}_{folder.name}.so"]
    assert (folder / "report/index.html").stat().st_size > 10_000


def refused(shell, home, code, text, command):
    before = sorted(home.rglob("*"))
    output, got, _ = shell.run(command)
    assert got == code and text in output, f"$ {command}\nexit code {got}\n{output}"
    assert sorted(home.rglob("*")) == before, command


def refusals(shell, home):
    def usage(text, arguments):
        refused(shell, home, 2, text, f"altiplan new {arguments}")

    usage("expected one of constraint, environment,", "pilot mine")
    usage("name is required", "planner")
    for name in ("MyPlanner", "2nd", "a-b", "../up", "''", "a/b"):
        usage("expected lower-case letters", f"planner {name}")
    usage("at most 63 letters", f"planner {'a' * 64}")
    usage("a C++ keyword", "planner double")
    usage("has another meaning", "local_planner route")
    usage("marks test sources", "planner my_test")
    usage("is taken by the planner of", "planner astar")
    usage("is taken by the planner of", "local_planner astar")
    usage("is taken by a built-in environment", "environment box")
    (home / "mine").write_text("a file")
    (home / "dangling").symlink_to("nowhere")
    for name in ("my_planner", "mine", "dangling"):
        refused(shell, home, 3, "exists and is not overwritten", f"altiplan new planner {name}")
    refused(shell, home, 3, "cannot create the folder", "(cd /proc && altiplan new planner other)")
    # As on a full disk: nothing is left of what was begun.
    refused(shell, home, 3, "cannot write", "(ulimit -f 0; altiplan new planner other)")


def main():
    with tempfile.TemporaryDirectory() as name:
        home = pathlib.Path(name)
        walk.install(BUILD, home)
        os.environ |= {"CXXFLAGS": WARNINGS, "CMAKE_BUILD_TYPE": "None",  # which builds quickest
                       "CMAKE_GENERATOR": "Ninja", "CMAKE_BUILD_PARALLEL_LEVEL": "2"}
        shell = walk.Shell(home)
        shell.run(f"export PATH={home}/altiplan/bin:$PATH")
        if shutil.which("clang++"):  # what is included by all is read once
            clang(home, "-xc++-header", "-o", home / "all.pch",
                  home / "altiplan/include/altiplan/conformance_gtest.hpp")
        for kind in KINDS:
            folder = written(shell, home, kind)
            if NIGHTLY or kind == "planner":
                built(shell, folder, kind)
        output, code, _ = shell.run(f"cd {home} && {BUILD}/bin/altiplan new tuner from_the_build")
        assert code == 0, output
        shell.run("unset ALTIPLAN_PLUGIN_PATH")
        refusals(shell, home)


main()
