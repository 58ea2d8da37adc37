# SPDX-License-Identifier: Apache-2.0
"""scripts_test.py SOURCES: every script of tools/ refuses wrong arguments, and those that count are right on small
inputs. `scripts_test.py SOURCES Sizes.test_limits` runs one case."""
import concurrent.futures
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time
import unittest

SOURCES = pathlib.Path(sys.argv[1]).resolve()
WRONG = {  # of each script wrong arguments and what it then says; all but setup exit with 2
    "abi": (["--bogus"], "expected versions, found '--bogus'"),
    "build-cost": (["--bogus"], "unrecognized arguments: --bogus"),
    "coverage": (["bogus"], "expected no arguments, found 'bogus'"),
    "docs": (["bogus"], "expected nothing, or a build folder and one for the site"),
    "fuzz": (["bogus"], "expected SECONDS and targets of yaml"),
    "package": (["--bogus"], "expected nothing or --try, found '--bogus'"),
    "run": ([], "expected a pipeline"),
    "setup": (["bogus"], "expected build, test, ci, docs, bench, package or abi, found 'bogus'"),
    "sizes": (["--bogus"], "unrecognized arguments: --bogus"),
    "skipped": (["bogus.xml"], "there is no file bogus.xml"),
    "test": (["--bogus"], "expected --quick or an option of ctest, found '--bogus'"),
    "tidy": (["bogus.cpp"], "there is no file"),
    "../.ci/run": (["--bogus"], "expected nothing or --nightly, found '--bogus'"),
}


def call(program, *arguments, **environment):
    done = subprocess.run([program, *arguments], capture_output=True, text=True, check=False,
                          env={**os.environ, "ALTIPLAN_SKIP_SETUP": "1", **environment})
    return done.returncode, done.stdout + done.stderr


class Arguments(unittest.TestCase):
    def test_every_script_is_known(self):
        scripts = {path.name for path in (SOURCES / "tools").iterdir() if path.is_file() and not path.suffix}
        self.assertEqual(scripts, {name for name in WRONG if "/" not in name})

    def test_wrong_ones_are_refused(self):
        for script, (arguments, message) in WRONG.items():
            with self.subTest(script):
                code, printed = call(SOURCES / "tools" / script, *arguments)
                self.assertEqual(code, 1 if script == "setup" else 2, printed)
                self.assertIn(message, printed)

    def test_help(self):
        for script in ("build-cost", "sizes", "skipped", "tidy"):
            code, printed = call(SOURCES / "tools" / script, "--help")
            self.assertEqual(code, 0, printed)
            self.assertIn(script, printed)


class InAFolder(unittest.TestCase):
    """A source tree of our own, with the script in it."""

    def setUp(self):
        made = tempfile.TemporaryDirectory()
        self.addCleanup(made.cleanup)
        self.root = pathlib.Path(made.name).resolve()
        self.script = self.root / "tools" / self.NAME
        self.script.parent.mkdir()
        shutil.copy(SOURCES / "tools" / self.NAME, self.script)

    def write(self, name, text, mode=0o644):
        path = self.root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
        path.chmod(mode)
        return path


class Sizes(InAFolder):
    NAME = "sizes"

    def test_guides(self):
        self.write("framework/include/altiplan/short.hpp", "int a;\n" * 120)
        self.write("framework/src/long.cpp", "// why\n" * 291 + "void f() {\n" + "  ;\n" * 59 + "}\n")
        self.write("plugins/planner/x/README.md", "x\n" * 60)
        self.write("plugins/planner/x/x_test.cpp", "x\n" * 201)
        code, printed = call(self.script)
        self.assertEqual(code, 0, printed)
        self.assertEqual(sorted(printed.splitlines()), [
            "algorithm    352 lines, guide 350: framework/src/long.cpp",
            "function      61 lines, guide  60: framework/src/long.cpp:292",
            "looked at 1 interfaces, 1 functions, 1 algorithms, 1 tests, 1 READMEs; 3 above a guide",
            "test         201 lines, guide 200: plugins/planner/x/x_test.cpp"])

    def test_limits(self):
        self.write("framework/include/altiplan/params.hpp", "int a;\n" * 500)
        self.write("framework/src/long.cpp", "// why\n" * 2000)
        self.write("framework/include/altiplan/short.hpp", "int a;\n" * 120)
        self.assertEqual(call(self.script, "--limits"), (0, ""))
        self.write("framework/include/altiplan/short.hpp", "int a;\n" * 121)
        self.assertEqual(call(self.script, "--limits"), (
            1, "interface    121 lines, limit 120: framework/include/altiplan/short.hpp\n"))


class BuildCost(InAFolder):
    NAME = "build-cost"

    def setUp(self):
        super().setUp()
        self.build = self.root / "build/release"
        self.write("own.hpp", "// 1\n// 2\n// 3\n")
        self.write("a.cpp", '#include "own.hpp"\n#include "../outside/big.hpp"\nint a;\n')
        self.write("b.cpp", '#include "own.hpp"\nint b;\n')
        self.write("build/outside/big.hpp", "\n" * 100_000)
        self.write("build/release/compile_commands.json", json.dumps(
            [{"command": f"c++ -o plugins/planner/CMakeFiles/{name}.dir/{name}.o -c {name}.cpp"} for name in "ab"]))
        self.write("build/release/CMakeCache.txt", "CMAKE_CXX_COMPILER:FILEPATH=/usr/bin/c++\n"
                   "CMAKE_BUILD_TYPE:STRING=Release\n")
        self.write("build/release/build.ninja", """
rule compile
  command = c++ -I$root/build/release -MD -MF $out.d -c $in -o $out
  depfile = $out.d
  deps = gcc
build plugins/planner/CMakeFiles/a.dir/a.o: compile $root/a.cpp
build plugins/planner/CMakeFiles/b.dir/b.o: compile $root/b.cpp
build all: phony plugins/planner/CMakeFiles/a.dir/a.o plugins/planner/CMakeFiles/b.dir/b.o
""".replace("$root", str(self.root)))

    def made(self, *targets):
        subprocess.run(["ninja", "-C", self.build, *targets], check=True, capture_output=True)

    def test_without_a_build(self):
        code, printed = call(self.script)
        self.assertEqual(code, 1)
        self.assertIn("build first", printed)

    def test_times(self):
        self.made()
        log = self.build / ".ninja_log"
        log.write_text("# ninja log v5\n1000\t3500\t0\tplugins/planner/CMakeFiles/a.dir/a.o\tx\n"
                       "0\t1000\t0\tplugins/planner/CMakeFiles/b.dir/b.o\tx\n0\t9000\t0\tgone.o\tx\n"
                       "5000\t5500\t0\tbuild.ninja\tx\n")
        code, printed = call(self.script, "1")
        self.assertEqual(code, 0, printed)
        self.assertEqual(printed.splitlines(), [
            "    2.5 s  plugins/planner/CMakeFiles/a.dir/a.o", "",
            "      4 s  plugins/planner", "      4 s  in all, 3 outputs"])

    def test_line(self):
        self.made("plugins/planner/CMakeFiles/a.dir/a.o")
        self.assertEqual(call(self.script, "--line")[0], 77)  # not all is built
        self.made()
        code, printed = call(self.script, "--line")
        self.assertEqual(code, 0, printed)
        # 3 of own.hpp twice, 3, 2 and 100,000; 8 of them our own, each counted once
        self.assertIn("for each of 8 lines", printed)
        self.assertIn("0.1 million lines read for 2 objects", printed)

    def test_growth(self):
        self.made()
        figure = self.write("figure.json", '{"built": "otherwise", "ms_per_line": 1}')
        self.assertEqual(call(self.script, "--against", figure)[0], 77)
        self.assertEqual(call(self.script, "--against", figure, ALTIPLAN_UPDATE="1")[0], 0)
        written = json.loads(figure.read_text())
        for grown, expected in ((1.09, 0), (1.12, 1)):
            figure.write_text(json.dumps({**written, "ms_per_line": written["ms_per_line"] / grown}))
            code, printed = call(self.script, "--against", figure)
            self.assertEqual(code, expected, printed)


class Skipped(InAFolder):
    NAME = "skipped"

    def test_reasons(self):
        results = self.write("results.xml", """<testsuite>
<testcase name="page" status="notrun"><skipped message="SKIP_RETURN_CODE=77"/>
<system-out>one line\nskipped: needs chromium (tools/setup ci)\n</system-out></testcase>
<testcase name="disk" status="notrun"><skipped message="SKIP_RETURN_CODE=77"/></testcase>
<testcase name="good" status="run"><system-out>fine</system-out></testcase></testsuite>""")
        code, printed = call(self.script, results)
        self.assertEqual((code, printed.splitlines()), (0, [
            "", "2 tests were skipped:", "  disk: SKIP_RETURN_CODE=77",
            "  page: needs chromium (tools/setup ci)", "The packages that they need: tools/setup ci"]))
        results = self.write("results.xml", "<testsuite><testcase name='good'/></testsuite>")
        self.assertEqual(call(self.script, results), (0, ""))


class Tidy(InAFolder):
    """Against a clang-tidy of our own that notes its calls and objects to the word `bad`."""
    NAME = "tidy"

    def setUp(self):
        super().setUp()
        self.write(".clang-tidy", "Checks: '*'\n")
        self.write("own.hpp", "// 1\n")
        self.write("a.cpp", '#include "own.hpp"\n')
        self.write("b.cpp", "int b;\n")
        self.write("commands.json", json.dumps(
            [{"file": str(self.root / name), "command": f"env ccache /usr/bin/c++ -I{self.root} -Dx=1 -o x.o "
                                                        f"-c {self.root / name}"} for name in ("a.cpp", "b.cpp")]))
        self.write("bin/cmake", '#!/bin/bash\nmkdir -p "$ROOT/build/tidy"\n'
                   'cp "$ROOT/commands.json" "$ROOT/build/tidy/compile_commands.json"\n', 0o755)
        self.write("bin/clang-tidy", '#!/bin/bash\n[[ $1 != --version ]] || { echo 1; exit; }\n'
                   'sleep "${SLOW:-0}"\nfor word; do [[ ! -f $word ]] || file=$word; done\n'
                   'echo "${file##*/}" >> "$ROOT/calls"\n'
                   '! grep -Hn bad "$file"\n', 0o755)

    def tidy(self, *arguments, **environment):
        (self.root / "calls").unlink(missing_ok=True)
        code, printed = call(self.script, "--cache", self.root / "cache", *arguments, ROOT=str(self.root),
                             PATH=f"{self.root}/bin:{os.environ['PATH']}", **environment)
        calls = self.root / "calls"
        return code, printed, sorted(calls.read_text().split()) if calls.exists() else []

    def test_what_is_known_is_not_looked_at_again(self):
        files = [self.root / "a.cpp", self.root / "b.cpp"]
        self.assertEqual(self.tidy(*files), (
            0, "tidy: 2 files, 0 known, 2 looked at, 0 with findings\n", ["a.cpp", "b.cpp"]))
        self.assertEqual(self.tidy(*files)[2], [])
        self.write("own.hpp", "// 2\n")
        self.assertEqual(self.tidy(*files)[2], ["a.cpp"])
        self.write(".clang-tidy", "Checks: 'x'\n")
        self.assertEqual(self.tidy(*files)[2], ["a.cpp", "b.cpp"])

    def test_findings_are_found_again(self):
        self.write("b.cpp", "int bad;\n")
        for _ in range(2):
            code, printed, calls = self.tidy(self.root / "b.cpp")
            self.assertEqual((code, calls), (1, ["b.cpp"]))
            self.assertIn("b.cpp:1:int bad;", printed)

    def test_a_header_has_the_options_of_its_neighbour(self):
        self.assertEqual(self.tidy(self.root / "own.hpp")[0], 0)
        self.assertEqual(self.tidy(self.root / "own.hpp")[2], [])

    def test_the_time_is_limited(self):
        files = [self.write(f"{name}.cpp", "int x;\n") for name in "cdefghijklmnop" * 20][:14] * 20
        code, printed, calls = self.tidy("--minutes", "0.02", *files, SLOW="1")
        self.assertEqual(code, 0)
        self.assertIn("left after 0.02 minutes, from ", printed)
        self.assertLess(len(calls), 100)


class Unbuilt(unittest.TestCase):
    """What stands at bin/altiplan until the program is built, in a tree whose cmake is one of ours."""

    def setUp(self):
        made = tempfile.TemporaryDirectory()
        self.addCleanup(made.cleanup)
        self.tree = pathlib.Path(made.name).resolve()
        (self.tree / "lib/altiplan/plugins").mkdir(parents=True)
        (self.tree / "bin").mkdir()
        template = (SOURCES / "tools/altiplan/first/unbuilt.sh.in").read_text()
        self.write("unbuilt.sh", template.replace("@CMAKE_BINARY_DIR@", str(self.tree)))
        self.program = self.tree / "bin/altiplan"
        self.program.symlink_to(self.tree / "unbuilt.sh")

    def write(self, name, text):
        path = self.tree / name
        path.write_text(text)
        path.chmod(0o755)

    def cmake(self, script):
        self.write("cmake", "#!/bin/sh\n" + script)
        return {"PATH": f"{self.tree}:{os.environ['PATH']}"}

    def test_builds_and_calls_the_program(self):
        # A linker removes the link before it writes.
        built = f"sleep 1; rm {self.program}; printf '#!/bin/sh\\necho \"$#: $*\"\\nexit 3\\n' > {self.program}; chmod +x {self.program}"
        path = self.cmake(f'[ "$*" = "--build {self.tree} --target altiplan_cli" ] || exit 1\n{built}\n')
        self.assertEqual(call(self.program, "a b", "c", **path),
                         (3, "2: a b c\naltiplan: building the program (needed for the first time; minutes)\n"))
        self.assertEqual(call(self.program, "d", **path), (3, "1: d\n"))

    def test_who_calls_meanwhile_waits(self):
        built = f"sleep 1; rm {self.program}; printf '#!/bin/sh\\necho $*\\n' > {self.program}; chmod +x {self.program}"
        path = self.cmake(built + "\n")
        with concurrent.futures.ThreadPoolExecutor() as pool:
            first = pool.submit(call, self.program, "a", **path)
            time.sleep(0.4)
            second = pool.submit(call, self.program, "b", **path)
            building = "altiplan: building the program (needed for the first time; minutes)\n"
            self.assertEqual([first.result(), second.result()], [(0, "a\n" + building), (0, "b\n" + building)])

    def test_a_build_that_fails_is_tried_again(self):
        path = self.cmake("echo no compiler; exit 1\n")
        for _ in range(2):
            code, printed = call(self.program, "run", **path)
            self.assertEqual(code, 4, printed)
            self.assertIn(f"building it failed; {self.tree}/unbuilt.log shows why", printed)
            self.assertEqual((self.tree / "unbuilt.log").read_text(), "no compiler\n")
            self.assertTrue(self.program.is_symlink())


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]])
