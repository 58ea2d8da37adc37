# SPDX-License-Identifier: Apache-2.0
"""`altiplan check` against another evaluator of missions: how autopilots fly them is modelled here a second time.

mission_oracle.py --program PATH [--seed S] [--count N] [--work DIR]: random missions.
mission_oracle.py --program PATH --section9: missions of which the right verdict is known.

A mission that some possible flight makes violate, or that the autopilot refuses, must not pass: exit code 1 if one
does, and its files are kept in DIR. Sound missions that are refused are counted."""
import argparse
import collections
import concurrent.futures
import json
import pathlib
import random
import subprocess
import sys

try:
    import oracle_missions
    import oracle_section9
    import oracle_world
    from oracle_commands import KINDS, kind_of
except ModuleNotFoundError as missing:
    if missing.name != "numpy":
        raise
    print("skipped: no numpy")
    sys.exit(77)

FORBIDDEN = ("must_fail", "refused", "not_judgeable")
NAMES = dict(zip(KINDS, ("ArduCopter", "ArduPlane", "QuadPlane", "PX4 copter", "PX4 plane", "PX4 VTOL"), strict=True))
MISSIONS_PER_WORLD = 50


class Answer:
    """What the program says: `word` is pass, fail, not_judged, bad input, or broken with the reason."""

    def __init__(self, code, out, err):
        self.out, self.err, self.broken, self.violations = out, err, "", []
        if code == 3:
            self.word = "bad input"
            return
        try:
            answer = json.loads(out)
            self.word = answer["verdict"]
            self.violations = answer["violations"]
            self.check(code)
        except (ValueError, KeyError, TypeError) as error:
            self.word, self.broken = "broken", f"exit code {code}, {error!r}"

    def check(self, code):
        if self.word not in ("pass", "fail", "not_judged"):
            self.broken = f"verdict {self.word}"
        elif code != (0 if self.word == "pass" else 1):
            self.broken = f"exit code {code} with {self.word}"
        elif (self.word == "fail") != bool(self.violations) and self.word != "not_judged":
            self.broken = f"{self.word} with {len(self.violations)} violations"
        for violation in self.violations:
            times = violation.get("time_s")
            if times and not times[0] <= times[1]:
                self.broken = f"times {times}"

    def reason(self):
        first = self.violations[0] if self.violations else {}
        name = first.get("rule", first.get("constraint", ""))
        return f"{name}: item {first.get('item', first.get('items', ''))} {first.get('message', '')}".strip()


def write(case, folder, terrain):
    """Arguments of `check` for the case."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "mission.plan").write_text(json.dumps(case.plan, indent=1))
    arguments = ["check", str(folder / "mission.plan"), "--terrain", str(terrain), "--json"]
    if case.zones:
        oracle_world.write_zones(case.zones, case.world, folder / "zones.json")
        arguments += ["--airspace", str(folder / "zones.json")]
        arguments += ["--start-time", oracle_world.START.strftime("%Y-%m-%dT%H:%M:%SZ")]
    for key, value in (("--min-agl", case.min_agl), ("--max-agl", case.max_agl)):
        if value is not None:
            arguments += [key, str(value)]
    return arguments


def ask(program, arguments):
    try:
        run = subprocess.run([program, *arguments], capture_output=True, text=True, timeout=300)
    except subprocess.TimeoutExpired:
        return Answer(-1, "", "over 300 s")
    return Answer(run.returncode, run.stdout, run.stderr)


def kind(case):
    return kind_of(case.plan["mission"]["firmwareType"], case.plan["mission"]["vehicleType"])


class Report:
    """Counts by vehicle, and what is to be looked at."""

    def __init__(self):
        self.counts = {name: collections.Counter() for name in KINDS}
        self.passed, self.broken, self.sound, self.unread = [], [], [], []

    def add(self, case, verdict, answer, folder, arguments):
        counts = self.counts[kind(case)]
        counts.update(["missions", verdict.word, answer.word])
        sound = verdict.word == "must_pass" or verdict.word == "undecided" and verdict.clears_but_for_the_start()
        if verdict.word == "undecided" and sound:
            counts["clear but for its ends"] += 1
        if sound:
            counts["sound passed" if answer.word == "pass" else "sound " + answer.word] += 1
        is_false_pass = answer.word == "pass" and verdict.word in FORBIDDEN
        if is_false_pass:
            counts["false pass"] += 1
            self.passed.append((case.name, verdict.word, verdict.reasons()[:3]))
        if answer.broken:
            self.broken.append((case.name, answer.broken, answer.err[:300]))
        if answer.word == "bad input":
            self.unread.append((case.name, verdict.word, answer.err.strip()[:200]))
        if sound and answer.word == "fail":
            self.sound.append((case.name, answer.reason()))
        keeps = is_false_pass or answer.broken or sound and answer.word == "fail"
        if keeps:
            note = {"oracle": verdict.word, "reasons": verdict.reasons(), "doubts": verdict.doubts,
                    "program": answer.word, "arguments": arguments, "answer": answer.out[:20000], "stderr": answer.err}
            (folder / "verdict.json").write_text(json.dumps(note, indent=1))
        return keeps

    def table(self):
        columns = ["missions", "must_fail", "refused", "not_judgeable", "must_pass", "clear but for its ends",
                   "undecided", "pass", "fail", "not_judged", "bad input", "false pass", "sound passed", "sound fail",
                   "sound not_judged"]
        print(f"{'':12}" + "".join(f"{c.replace('clear but for its ends', 'clear*'):>14}" for c in columns))
        total = collections.Counter()
        for name in KINDS:
            total.update(self.counts[name])
            print(f"{NAMES[name]:12}" + "".join(f"{self.counts[name][c]:14}" for c in columns))
        print(f"{'all':12}" + "".join(f"{total[c]:14}" for c in columns))
        print("* undecided only because nobody knows an aeroplane's take-off or run-out; sound ones include them")
        share = total["not_judged"] / max(total["missions"], 1)
        print(f"not judged: {share:.1%} of all; of sound ones {total['sound not_judged']}")

    def print(self):
        self.table()
        for title, rows in (("passed, but may violate", self.passed),
                            ("answers that contradict themselves", self.broken),
                            ("sound, but refused", self.sound[:40]), ("bad input", self.unread[:20])):
            for row in rows:
                print(f"{title}: " + "; ".join(map(str, row)))
        print(f"{len(self.passed)} violating missions passed, {len(self.sound)} sound ones refused")
        return 1 if self.passed or self.broken else 0


def compare(options):
    """Cases are made here, in one order whatever the program's speed; two of it run at a time."""
    rng, report, waiting = random.Random(options.seed), Report(), []
    work = pathlib.Path(options.work)

    def finish(entry):
        case, verdict, folder, arguments, answer = entry
        if not report.add(case, verdict, answer.result(), folder, arguments):
            for file in folder.iterdir():
                file.unlink()
            folder.rmdir()

    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        for n in range(options.count):
            if n % MISSIONS_PER_WORLD == 0:
                world, = oracle_missions.worlds(rng, 1)
                work.mkdir(parents=True, exist_ok=True)
                terrain = work / f"world-{options.seed}-{n // MISSIONS_PER_WORLD}.asc"
                world.write(terrain)
            name = f"mission-{options.seed}-{n}"
            case = oracle_missions.make(random.Random(f"{options.seed}/{n}"), world, name)
            verdict, arguments = case.judge(), write(case, work / name, terrain)
            waiting.append((case, verdict, work / name, arguments, pool.submit(ask, options.program, arguments)))
            if len(waiting) > 8:
                finish(waiting.pop(0))
        for entry in waiting:
            finish(entry)
    return report.print()


def section9(options):
    """The table against the program."""
    wrong, work = 0, pathlib.Path(options.work)
    for n, (name, case, right) in enumerate(oracle_section9.TABLE):
        folder = work / f"section9-{n}"
        folder.mkdir(parents=True, exist_ok=True)
        case.world.write(folder / "dem.asc")
        answer = ask(options.program, write(case, folder, folder / "dem.asc"))
        good = not answer.broken and (answer.word == "pass") == (right == "pass")
        wrong += not good
        print(f"{'ok   ' if good else 'WRONG'} {name}: {answer.word}, right is {right}"
              + (f" ({answer.broken or answer.reason()})" if not good else ""))
    print(f"{wrong} of {len(oracle_section9.TABLE)} wrong")
    return 1 if wrong else 0


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", required=True)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--count", type=int, default=200)
    parser.add_argument("--work", default="mission_oracle")
    parser.add_argument("--section9", action="store_true")
    options = parser.parse_args()
    return section9(options) if options.section9 else compare(options)


if __name__ == "__main__":
    sys.exit(main())
