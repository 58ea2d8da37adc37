# SPDX-License-Identifier: Apache-2.0
"""bad_plugins_test.py PROGRAM DOC PLUGINS [--all] [NAME…]: each plugin broken on purpose fails the tests that
the document's table says, and no others. Without --all a few of them: for each test one that it was made for,
and one with which nothing is wrong (all shipped plugins are such).

A plugin is held to the tests that the table says; those with which nothing is wrong, and all with --all,
are held to every test, as only that finds what fails beside the table.

The first of them, in bold, is the one that is there for its fault. Each test of `altiplan check-plugin`
fails for some plugin, and for one of each kind where it is a test of plugins. With ALTIPLAN_UPDATE=1 the
table is written anew; which test is the first is taken over where it failed. NAMEs restrict what is run."""
import concurrent.futures
import glob
import json
import os
import re
import subprocess
import sys
import tempfile

PROGRAM, DOC, PLUGINS = (os.path.abspath(path) for path in sys.argv[1:4])
UPDATE = bool(os.environ.get("ALTIPLAN_UPDATE"))
ALL = UPDATE or "--all" in sys.argv[4:]
NAMES = [name for name in sys.argv[4:] if name != "--all"]
HERE = os.path.dirname(os.path.abspath(__file__))
BEGIN, END = "<!-- bad plugins -->", "<!-- /bad plugins -->"
SOUND = "nothing: all pass"
ROUNDS = "4"
# Tests that look at the clock are for plugins that are about it: else a busy machine fails them.
TIMED = {"planner/late": "deadlines", "planner/stops_late": "stops", "smoother/late": "deadlines"}
OPTIONS = {"planner/never_returns": ["--time-limit", "4"],
           "planner/stops_itself": ["--time-limit", "4"],
           "planner/hoards": ["--memory-limit", "300"]}


def altiplan(*arguments):
    with tempfile.TemporaryDirectory(prefix="altiplan_bad_") as folder:
        done = subprocess.run([PROGRAM, *arguments], env={**os.environ, "TMPDIR": folder}, text=True,
                              stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                              stderr=subprocess.PIPE, errors="replace", timeout=600)
        left = os.listdir(folder)
    if left:
        sys.exit("%s left %s in TMPDIR" % (arguments, left))
    return done


def base_of(library):
    sets = os.path.join(HERE, "bad_%s.yaml" % os.path.splitext(os.path.basename(library))[0])
    return ["check-plugin", library] + (["--sets", sets] if os.path.exists(sets) else [])


def named(test):
    """Its plugin ("library" for those of a library), and its own name."""
    plugin, _, name = test.rpartition("/")
    return plugin, name


# Of those that are broken themselves nothing but the tests of libraries is looked at.
LIBRARIES = {
    "no_manifest": "has nothing to do with altiplan",
    "other_api": "was built for another API",
    "open_symbols": "exports a function beside its list of plugins",
    "no_list": "exports no list of plugins",
    "undefined_symbol": "calls a function that no library has",
    "ends_the_process": "aborts where it is loaded",
    "libaltiplan_constraint_theta": "is named unlike its plugin",
    "other_kind": "announces a smoother and holds a constraint",
}


class Bad:
    """A plugin or a library, and the names of the tests that it failed."""

    def __init__(self, library, key, does, only):
        self.library, self.key, self.does, self.only = library, key, does, only
        self.failed, self.contracts = [], {}

    def says(self):
        """The last cells of its row: what failed, the first in bold, and which contract they found violated."""
        names = ["`%s`" % name for name in self.failed]
        if not names:
            return SOUND + " | –"
        contract = self.contracts[self.failed[0]]
        return "%s | %s" % (", ".join(["**%s**" % names[0]] + names[1:]), contract.split(":")[0])

    def run(self, told):
        """What is wrong with the run itself; "" where nothing is. `told`: the cells of its row."""
        timed = TIMED.get(self.key)
        tests = [] if ALL else re.findall(r"`(\w+)`", told.split(" | ")[0])
        only = self.only + ("(%s)$" % "|".join(tests) if tests else ".*" + timed if timed else "")
        done = altiplan(*base_of(self.library), "--json", "--rounds", ROUNDS, "--jobs", "1",
                        "--only", only,
                        *([] if timed else ["--untimed"]), *OPTIONS.get(self.key, []))
        try:
            verdicts = json.loads(done.stdout)["tests"]
        except json.JSONDecodeError:
            return "%s: no JSON: %s" % (self.key, done.stdout + done.stderr)
        for verdict in verdicts:
            if verdict["status"] == "failed":
                name = named(verdict["name"])[1]
                self.failed.append(name)
                self.contracts[name] = verdict["findings"][0]["contract"]
        if done.returncode != (4 if self.failed else 0):
            return "%s: exit code %d, failed %s" % (self.key, done.returncode, self.failed)
        return ""


def found():
    """What there is to check, in the order of the table."""
    listed = json.loads(altiplan("plugins", "--json", "--plugin-path", PLUGINS).stdout)["libraries"]
    sentences = {(p["kind"], p["name"]): p["sentence"] for library in listed
                 if library["file"].startswith(PLUGINS + os.sep) for p in library["plugins"]}
    bad, tests = [], {}
    for library in sorted(glob.glob(os.path.join(PLUGINS, "*.so"))):
        name = os.path.splitext(os.path.basename(library))[0]
        listed = [named(test) for test in altiplan(*base_of(library), "--list").stdout.split()]
        if name in LIBRARIES:
            bad.append(Bad(library, "library/" + name, LIBRARIES[name], "^library/"))
            listed = [(plugin, test) for plugin, test in listed if plugin == "library"]
        for plugin in dict.fromkeys(plugin for plugin, _ in listed if plugin != "library"):
            bad.append(Bad(library, plugin, sentences[tuple(plugin.split("/"))],
                           "^%s/" % plugin))
        for plugin, test in listed:
            tests.setdefault((plugin.split("/")[0], test), None)
    kinds = ["library", "planner", "local_planner", "smoother", "constraint", "environment", "tuner",
             "objective", "task"]
    bad.sort(key=lambda one: (kinds.index(one.key.split("/")[0]),
                              "nothing is wrong" not in one.does, one.key))
    return bad, list(tests)


def rows(text):
    """Of the table, by plugin: the cells that say which tests catch it."""
    found_rows = re.findall(r"^\| `([\w/]+)` \| [^|]* \| (.*) \|$",
                            text[text.index(BEGIN):text.index(END)], re.M)
    return dict(found_rows)


def a_few(bad, told):
    """One for each test in bold, and a sound one."""
    few = {}
    for one in bad:
        row = told.get(one.key, "").split(" | ")[0]
        test = re.match(r"\*\*`(\w+)`\*\*", row)
        few.setdefault(test[1] if test else row, one)
    return list(few.values())


def main():
    bad, tests = found()
    known = {one.key for one in bad}
    with open(DOC, encoding="utf-8") as stream:
        text = stream.read()
    told = rows(text)
    if NAMES:
        bad = [one for one in bad if any(name in one.key for name in NAMES)]
    elif not ALL:
        bad = a_few(bad, told)

    def run(one):
        return one.run(told.get(one.key, ""))

    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        wrong = list(pool.map(run, [one for one in bad if one.key not in TIMED]))
    wrong = [what for what in wrong + [run(one) for one in bad if one.key in TIMED] if what]
    for one in bad:
        first = re.match(r"\*\*`(\w+)`\*\*", told.get(one.key, ""))
        if first and first[1] in one.failed:
            one.failed.sort(key=lambda test: test != first[1])
    if UPDATE:
        table = ["| plugin | what it does | caught by | clause |", "|---|---|---|---|"]
        table += ["| `%s` | %s | %s |" % (one.key, one.does, one.says()) for one in bad]
        text = text[:text.index(BEGIN)] + "\n".join([BEGIN, *table, ""]) + text[text.index(END):]
        with open(DOC, "w", encoding="utf-8") as stream:
            stream.write(text)
        told = rows(text)
    wrong += ["%s: caught by %s, the document says %s" % (one.key, one.says(), told.get(one.key))
              for one in bad if told.get(one.key) != one.says()]
    wrong += ["%s: %s, yet nothing is wrong with it" % (one.key, one.says())
              for one in bad if one.failed and "nothing is wrong" in one.does]
    wrong += ["%s: nothing catches it" % one.key
              for one in bad if not one.failed and "nothing is wrong" not in one.does]
    wrong += ["%s: in the document alone, or there alone not" % key for key in sorted(told.keys() ^ known)]
    if ALL and not NAMES:
        first = {(one.key.split("/")[0], one.failed[0]) for one in bad if one.failed}
        wrong += ["%s/…/%s is the first to fail of no plugin" % test
                  for test in tests if test not in first]
    print("%d of %d plugins as documented" % (len(bad) - len(wrong), len(bad)))
    sys.exit("\n".join(wrong) or 0)


main()
