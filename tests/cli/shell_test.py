# SPDX-License-Identifier: Apache-2.0
"""shell_test.py PROGRAM: completion in bash, zsh and fish, and manual pages; what is not installed is skipped."""
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

PROGRAM = sys.argv[1]


def program(*arguments):
    return subprocess.run([PROGRAM, *arguments], capture_output=True, text=True, timeout=600, check=True).stdout


class Shell(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.commands = re.findall(r"^  ([a-z][a-z_-]*) {2,}", program("--help"), re.M)

    def script(self, shell):
        file = self.folder / ("altiplan." + shell)
        file.write_text(program("completion", shell))
        return str(file)

    def bash(self, *words):
        done = subprocess.run(
            ["bash", "--norc", "-c", 'source "$0"; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _altiplan; '
             'printf "%s\\n" "${COMPREPLY[@]}"', self.script("bash"), "altiplan", *words],
            capture_output=True, text=True, timeout=600, check=True)
        self.assertEqual(done.stderr, "")
        return done.stdout.split()

    def test_bash_completes_commands_options_and_words(self):
        self.assertIn("run", self.commands)
        self.assertEqual(set(self.bash("")), set(self.commands))
        self.assertEqual(self.bash("ru"), ["run"])
        self.assertEqual(self.bash("run", "--se"), ["--seed", "--set"])
        self.assertEqual(self.bash("run", "a.yaml", "--trace-l"), ["--trace-limit"])
        self.assertEqual(self.bash("--log-level", "info", "--lo"), ["--log-level"])
        self.assertEqual(self.bash("export", "r.json", "--to", "q"), ["qgc-plan"])
        self.assertIn("--version", self.bash("--"))
        self.assertEqual(self.bash("completion", "z"), ["zsh"])
        self.assertEqual(self.bash("run", "a"), [])  # files, by default

    def test_every_option_of_help_is_completed(self):
        for command in self.commands:
            shown = set(re.findall(r"(?:^|,| )(--[a-z][a-z0-9-]*)", program(command, "--help").split("Example")[0]))
            told = set(self.bash(command, "--"))
            self.assertLessEqual({word for word in shown if "..." not in word} - told,
                                 set(), command)

    def test_zsh(self):
        if not shutil.which("zsh"):
            self.skipTest("no zsh")
        done = subprocess.run(
            ["zsh", "-f", "-c", "autoload -Uz compinit; compinit -D -u; source $0; print $_comps[altiplan]",
             self.script("zsh")], capture_output=True, text=True, timeout=600, check=False)
        self.assertEqual((done.stdout.strip(), done.stderr), ("_altiplan", ""))

    def test_fish(self):
        if not shutil.which("fish"):
            self.skipTest("no fish")

        def complete(line):
            done = subprocess.run(["fish", "--no-config", "-c", 'source $argv[1]; complete -C $argv[2]',
                                   self.script("fish"), line], capture_output=True, text=True, timeout=600,
                                  check=False, env={"HOME": str(self.folder), "PATH": "/usr/bin:/bin"})
            self.assertEqual(done.stderr, "")
            return [word.split("\t")[0] for word in done.stdout.splitlines()]
        self.assertEqual(complete("altiplan ru"), ["run"])
        self.assertEqual(complete("altiplan export r.json --to q"), ["qgc-plan"])
        self.assertIn("--seed", complete("altiplan run --se"))

    def test_manual_pages(self):
        program("man", "--to", str(self.folder))
        pages = sorted(self.folder.glob("*.1"))
        self.assertEqual(len(pages), len(self.commands) + 1)
        self.assertEqual((self.folder / "altiplan-run.1").read_text(), program("man", "run"))
        self.assertIn("\\-\\-trace\\-limit", program("man", "run"))
        if not shutil.which("groff"):
            self.skipTest("no groff")
        for page in pages:
            done = subprocess.run(["groff", "-man", "-Tutf8", "-Kutf8", "-wall", "-z", str(page)],
                                  capture_output=True, text=True, timeout=600, check=True)
            self.assertEqual(done.stderr, "", page.name)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[2:])
