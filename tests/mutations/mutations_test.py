# SPDX-License-Identifier: Apache-2.0
"""Random damage to valid files, through the real program.

Usage: mutations_test.py PROGRAM SOURCE_DIR COUNT SEED [CPU_SECONDS]

Every mutant goes through `validate` and `explain`, and through `run` with a small budget. Each call
ends by itself with 0, 1 or 3; with 4 only where it names a step that failed or a library that is
refused. A call that uses more than CPU_SECONDS of processor time (1 by default; `run` has two more)
hangs. The mutants that fail stay in a folder that is printed. Mutant N of a seed is always the
same: `mutations_test.py … 1 SEED/N` makes that one alone."""
import collections
import os
import pathlib
import random
import re
import resource
import shutil
import subprocess
import sys
import tempfile

EXTREMES = [b"0", b"-0", b"-1", b"1e999", b"-1e308", b"1e-320", b"nan", b".nan", b"inf", b".inf",
            b"99999999999999999999", b"9223372036854775807", b"-9223372036854775808", b"2147483648",
            b"0x10", b"010", b"1_000", b"1,5", b"1e8", b"0.0000001", b"~", b"true", b"''", b"[]",
            b"{}", b"[[[[[[[[", b"*a", b"&a 1", b"!!int 3", b"\xff", b"\x00", b"|", b"? :"]
NUMBER = re.compile(rb"-?\d+(?:\.\d+)?")
TOKEN = re.compile(rb"[\w.]+|[^\w\s]")


def flip(random_, text, _):
    at = random_.randrange(len(text))
    return text[:at] + bytes([text[at] ^ 1 << random_.randrange(8)]) + text[at + 1:]


def delete(random_, text, _):
    at = random_.randrange(len(text))
    return text[:at] + text[at + random_.choice([1, 2, 5, 20, 200]):]


def duplicate(random_, text, _):
    at = random_.randrange(len(text))
    end = at + random_.choice([1, 3, 10, 60])
    return text[:end] + text[at:end] * random_.choice([1, 1, 2, 50]) + text[end:]


def swap_lines(random_, text, _):
    lines = text.splitlines(keepends=True)
    a, b = random_.randrange(len(lines)), random_.randrange(len(lines))
    lines[a], lines[b] = lines[b], lines[a]
    return b"".join(lines)


def drop_line(random_, text, _):
    lines = text.splitlines(keepends=True)
    del lines[random_.randrange(len(lines))]
    return b"".join(lines)


def indent_line(random_, text, _):
    lines = text.splitlines(keepends=True)
    at = random_.randrange(len(lines))
    lines[at] = random_.choice([b" ", b"  ", b"\t", b"    "]) + lines[at]
    return b"".join(lines)


def replace_match(random_, text, pattern, by):
    found = list(pattern.finditer(text))
    if not found:
        return text + by
    match = random_.choice(found)
    return text[:match.start()] + by + text[match.end():]


def splice(random_, text, others):
    tokens = TOKEN.findall(random_.choice(others))
    return replace_match(random_, text, TOKEN, random_.choice(tokens))


def extreme(random_, text, _):
    return replace_match(random_, text, NUMBER, random_.choice(EXTREMES))


MUTATIONS = [flip, delete, duplicate, swap_lines, drop_line, indent_line, splice, splice, extreme,
             extreme]


class World:
    """The valid files, in memory, and the folder where each mutant is laid out."""

    def __init__(self, source, folder):
        configs = source / "configs"
        terrain = (configs / "data/jacksboro_fault.tif").read_bytes()
        real = {"pipeline.yaml": (configs / "pipelines/ridge_crossing.yaml").read_bytes().replace(
                    b"../scenarios/jacksboro_ridge.yaml", b"scenario.yaml"),
                "scenario.yaml": (configs / "scenarios/jacksboro_ridge.yaml").read_bytes().replace(
                    b"../data/", b""),
                "jacksboro_fault.tif": terrain}
        valid = source / "tests/bad_files"
        small = {name: (valid / name).read_bytes()
                 for name in ("pipeline.yaml", "scenario.yaml", "ground.asc", "zones.geojson")}
        self.sets = [(real, ["pipeline.yaml", "scenario.yaml", "jacksboro_fault.tif"], [2, 2, 1]),
                     (small, list(small), [4, 6, 1, 2])]
        data = source / "../shared/data"
        for name, file in (("zones", "city/finland_lennatyspaikat.geojson"),
                           ("terrain", "dem/elev_vinschgau.tif"),
                           ("terrain", "dem/srtmgl3_boulder_co.asc")):
            path = data / file
            if not path.is_file():
                print(f"without {path}, which is not there")
                continue
            crs = ", crs: EPSG:4326" if path.suffix == ".asc" else ""
            layer = f"  - {name}: {{file: {path.name}{crs}}}\n".encode()
            scenario = b"altiplan: 1\nenvironment:\n" + layer + (
                b"volume: {min_m: [0, 0, 0], max_m: [2000, 2000, 5000]}\n"
                b"start: {at_m: [100, 500, 4500]}\ngoal: {at_m: [900, 500, 4500]}\n")
            pipeline = (b"altiplan: 1\nscenario: scenario.yaml\nsteps:\n"
                        b"  - plan: astar\n    with: {cell_m: [100, 100, 100]}\n")
            self.sets.append(({"pipeline.yaml": pipeline, "scenario.yaml": scenario,
                               path.name: path.read_bytes()}, [path.name], [1]))
        self.texts = [files[name] for files in (real, small)
                      for name in ("pipeline.yaml", "scenario.yaml")]
        self.folder = folder

    def make(self, seed, number):
        """Lays out mutant `number`; a sentence that says what it is."""
        random_ = random.Random(f"{seed}/{number}")
        files, names, weights = random_.choices(self.sets, [5, 8] + [1] * (len(self.sets) - 2))[0]
        files = dict(files)
        name = random_.choices(names, weights)[0]
        done = []
        for _ in range(random_.choice([1, 1, 1, 2, 4])):
            mutation = random_.choice(MUTATIONS)
            files[name] = mutation(random_, files[name] or b" ", self.texts) or b" "
            done.append(mutation.__name__)
        for file, content in files.items():
            path = self.folder / file
            if not path.exists() or path.read_bytes() != content:
                path.write_bytes(content)
        return f"{seed}/{number}: {name}: {', '.join(done)}"


def call(arguments, folder, cpu_s):
    """Exit code (negative: a signal), output and processor time of a call of the program."""
    def limit():
        resource.setrlimit(resource.RLIMIT_CPU, (cpu_s, cpu_s + 5))
    with tempfile.TemporaryFile() as output:
        process = subprocess.Popen(arguments, stdin=subprocess.DEVNULL, stdout=output,
                                   stderr=subprocess.STDOUT, cwd=folder, preexec_fn=limit)
        try:
            process.wait(timeout=60 + cpu_s)
        except subprocess.TimeoutExpired:  # sleeps for ever: the limit on time used sees nothing
            process.kill()
            process.wait()
        output.seek(0)
        text = output.read(100_000).decode(errors="replace")
    return process.returncode, text


def wrong(verb, code, text):
    """Why the end of a call is not as it should be; "" where it is."""
    if code < 0:
        return f"ended by signal {-code}"
    if code == 4 and verb == "run":
        return "" if "failed" in text or "refused" in text else "exit 4 without a failed step"
    if code not in ((0, 1, 3) if verb == "run" else (0, 3)):
        return f"exit {code}"
    if code == 3 and not text.strip():
        return "exit 3 without a message"
    return "" if "AddressSanitizer" not in text and "runtime error" not in text else "sanitizer"


def main():
    program, source = os.path.abspath(sys.argv[1]), pathlib.Path(sys.argv[2]).resolve()
    count, seed = int(sys.argv[3]), sys.argv[4]
    cpu_s = int(sys.argv[5]) if len(sys.argv) > 5 else 1
    folder = pathlib.Path(tempfile.mkdtemp(prefix="altiplan_mutations_"))
    kept = pathlib.Path(tempfile.gettempdir()) / f"altiplan_mutants_{os.getpid()}"
    world = World(source, folder)
    seed, _, first = seed.partition("/")
    first = int(first or 0)
    codes = collections.Counter()
    failed = 0
    calls = (("validate", ["pipeline.yaml", "scenario.yaml"], cpu_s),
             ("explain", ["pipeline.yaml"], cpu_s),
             ("run", ["pipeline.yaml", "--threads", "1", "--set", "steps.0.within_s=0.2"],
              cpu_s + 2))
    for number in range(first, first + count):
        what = world.make(seed, number)
        for verb, arguments, limit in calls:
            code, text = call([program, verb, *arguments], folder, limit)
            codes[verb, code] += 1
            reason = wrong(verb, code, text)
            if reason:
                failed += 1
                shutil.copytree(folder, kept / f"{seed}_{number}_{verb}", dirs_exist_ok=True)
                print(f"{what}: {verb}: {reason}\n{text[:2000]}")
    shutil.rmtree(folder)
    for (verb, code), times in sorted(codes.items()):
        print(f"{verb}: exit {code}: {times}")
    if failed:
        print(f"{failed} calls failed; their files are in {kept}")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
