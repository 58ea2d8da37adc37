# SPDX-License-Identifier: Apache-2.0
"""misbehaving_test.py PROGRAM DOC PLUGINS [--no-crashes]: runs every row of the document's table.

A row is a fault, a pipeline's steps, what its scenario adds, status, exit code and words that the
message must hold; a status of '-' stands for no result. With --no-crashes the rows that end in a
signal are left out: a sanitizer ends those in its own way."""
import concurrent.futures
import json
import os
import re
import resource
import subprocess
import sys
import tempfile

PROGRAM, DOC, PLUGINS = (os.path.abspath(path) for path in sys.argv[1:4])
NO_CRASHES = "--no-crashes" in sys.argv[4:]
SCENARIO = """altiplan: 1
volume: {min_m: [0, 0, 0], max_m: [1000, 1000, 1000]}
start: {at_m: [100, 500, 500]}
goal: {at_m: [900, 500, 500]}
"""


def rows():
    with open(DOC) as stream:
        for line in stream:
            cells = [cell.strip() for cell in line.strip().strip("|").split("|")]
            if len(cells) == 6 and cells[1].startswith("`"):
                yield [cell.strip("`") for cell in cells]


def run(row):
    """What is wrong with this row; "" where nothing is."""
    _, steps, scenario, status, code, words = row
    with tempfile.TemporaryDirectory(prefix="altiplan_rogue_") as folder:
        def write(name, text):
            with open(os.path.join(folder, name), "w") as stream:
                stream.write(text)
        write("s.yaml", SCENARIO + ("" if scenario == "-" else scenario + "\n"))
        write("p.yaml", "altiplan: 1\nscenario: s.yaml\nsteps: [" + steps + "]\n")
        done = subprocess.run(
            [PROGRAM, "run", "p.yaml", "--json", "--out", "r.json", "--timeout", "0.5",
             "--plugin-path", PLUGINS, "--plugin-path",
             os.path.join(os.path.dirname(PLUGINS), "broken_plugins")],
            cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
            text=True, errors="replace", timeout=600,
            preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CORE, (0, 0)))
        said = done.stderr
        wrong = []
        if done.returncode != int(code):
            wrong.append("exit code %d" % done.returncode)
        out = os.path.join(folder, "r.json")
        if status == "-":
            if os.path.exists(out) or done.stdout:
                wrong.append("there is a result")
        elif not os.path.exists(out):
            wrong.append("there is no result")
        else:
            with open(out) as stream:
                text = stream.read()
            if text != done.stdout:
                wrong.append("stdout is not the result")
            result = json.loads(text)
            if result["status"] != status:
                wrong.append("status " + result["status"])
            said += result["message"] + "".join(s["message"] for s in result["steps"])
        said = re.sub(r"\s+", " ", said)
        for part in words.split(" … "):
            if part not in said:
                wrong.append("'%s' is not in the message" % part)
        return "" if not wrong else "%s: %s\n    %s" % (row[:3], "; ".join(wrong), said[:600])


def main():
    table = list(rows())
    if len(table) < 40:
        sys.exit("only %d rows in %s" % (len(table), DOC))
    chosen = [row for row in table if not (NO_CRASHES and "(SIG" in row[5])]
    if len(chosen) < len(table):
        print("left out under a sanitizer: %d rows that crash" % (len(table) - len(chosen)))
    with concurrent.futures.ThreadPoolExecutor(8) as pool:
        wrong = [text for text in pool.map(run, chosen) if text]
    print("%d of %d rows as documented" % (len(chosen) - len(wrong), len(chosen)))
    sys.exit("\n".join(wrong) or 0)


main()
