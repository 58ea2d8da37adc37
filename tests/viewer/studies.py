# SPDX-License-Identifier: Apache-2.0
"""Stores of studies for the tests of the report's page: runs that are planned, and runs that are
made up, many of them and with hostile names."""
import hashlib
import json
import math
import os
import random
import subprocess

HOSTILE = "</script><script>altiplan_report.errors.push('ran')</script>\"'&$_%\n\\x<b>"

# No hill reaches the cap: how far a route is from a plateau takes twenty times as long to find.
SCENARIO = """altiplan: 1
name: Hills
environment:
  - hills: {count: 12, extent_m: 20000}
volume: {min_m: [0, 0, 0], max_m: [20000, 20000, 4600]}
start: {at_m: [1000, 1000], above_ground_m: 200}
goal: {at_m: [19000, 19000], above_ground_m: 200, tolerance_m: 50}
"""
PIPELINE = """altiplan: 1
scenario: hills.yaml
constraints:
  - ground_clearance: {min_m: 50}
steps:
  - plan: astar
    with: {cell_m: [500, 500, 100]}
"""
PIPELINES = {"octile": "", "greedy": "0.2", "pruned": ""}

STUDY = """altiplan: 1
name: {name}
seed: 7
scenarios:
  - {{file: hills.yaml}}
pipelines:
{pipelines}
repetitions: {repetitions}
metrics:
  - {{name: length_m}}
  - {{name: plan_time_s}}
  - {{name: expanded}}
  - {{name: min_clearance_m}}
claims:
  - id: greedy_is_no_worse
    that: median({second}.length_m / {first}.length_m)
    is: <= 1.05
  - id: greedy_is_quicker
    that: median({second}.expanded / {first}.expanded)
    is: <= 0.5
  - id: solves_all
    that: share({second}.solved)
    is: ">= 0.99"
"""


def quoted(text):
    return json.dumps(text)


def study_text(name, pipelines, repetitions):
    """`pipelines` are ids; the first two are in the claims."""
    entries = "\n".join(f"  - {{id: {quoted(each)}, file: p.yaml}}" for each in pipelines)
    first, second = (list(pipelines) * 2)[:2]
    return STUDY.format(name=quoted(name), pipelines=entries, repetitions=repetitions,
                        first=first, second=second)


def store(make_store, path, content):
    if os.path.exists(path):
        os.remove(path)
    subprocess.run([make_store, path], input=json.dumps(content).encode("utf-8"), check=True)
    return path


def content_of(name, pipelines, scenarios, repetitions, runs):
    return {"study": {"name": name, "text": study_text(name, pipelines, repetitions),
                      "path": "study.yaml", "seed": "7"},
            "scenarios": [{"name": each, "of": "hills"} for each in scenarios],
            "pipelines": [{"name": each, "of": each, "file": "p.yaml"} for each in pipelines],
            "runs": runs}


def run_of(scenario, pipeline, repetition, **keys):
    key = hashlib.sha256(f"{scenario}\n{pipeline}\n{repetition}".encode()).hexdigest()
    seed = int(hashlib.sha256(f"{scenario}\n{repetition}".encode()).hexdigest()[:15], 16)
    return {"key": key, "scenario": scenario, "pipeline": pipeline, "repetition": repetition,
            "seed": seed, **keys}


def values_of(result):
    """The numbers of the top-level metrics of a result."""
    values = {name: value for name, value in result["metrics"].items() if value is not None}
    values["solved"] = float(result["status"] == "solved")
    return values


def planned(program, folder, scenarios=6):
    """Really planned: three pipelines in drawn hills, one crashed run and one without a route."""
    def write(name, text):
        with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
            file.write(text)

    write("hills.yaml", SCENARIO)
    runs = []
    names = [f"hills[seed={seed}]" for seed in range(1, scenarios + 1)]
    for seed, scenario in enumerate(names, 1):
        for pipeline, weight in PIPELINES.items():
            text = PIPELINE
            if weight:
                text = text.replace("100]}", f"100], weight_g: {weight}, weight_h: 0.8}}")
            if pipeline == "pruned":
                text += "  - smooth: prune\n"
            write(f"{pipeline}.yaml", text)
            out = os.path.join(folder, "result.json")
            done = subprocess.run(
                [program, "run", os.path.join(folder, f"{pipeline}.yaml"), "--out", out, "--set",
                 f"scenario.environment.0.hills.seed={seed}"] + (
                     ["--set", "steps.0.within_iterations=5"]
                     if (seed, pipeline) == (2, "octile") else []),
                capture_output=True, text=True, check=False)
            assert done.returncode in (0, 1), done.stderr
            with open(out, encoding="utf-8") as file:
                text = file.read()
            result = json.loads(text)
            run = run_of(scenario, pipeline, 0, outcome=result["status"],
                         message=result["message"], result=text, values=values_of(result))
            if (seed, pipeline) == (3, "greedy"):
                run = run_of(scenario, pipeline, 0, outcome="crashed",
                             message="astar: segmentation fault while planning " + HOSTILE)
            runs.append(run)
    return content_of("Hills", list(PIPELINES), names, 1, runs)


def made_up(scenarios, pipelines, repetitions, seed=1, hostile=False):
    """Drawn numbers of the kind that planners give."""
    draw = random.Random(seed)
    names = [f"hills[seed={n}]" + (HOSTILE if hostile and n == 0 else "") for n in range(scenarios)]
    ids = [f"p{n}" for n in range(pipelines)]
    runs = []
    for scenario in names:
        size = draw.lognormvariate(0, 0.4)
        for n, pipeline in enumerate(ids):
            for repetition in range(repetitions):
                chance = draw.random()
                outcome, message = "solved", ""
                if chance < 0.02 * n:
                    outcome, message = "timed_out", "astar: no route within 5 s"
                elif chance < 0.02 * n + 0.004:
                    outcome, message = "crashed", "astar: " + (HOSTILE if hostile else "SIGSEGV")
                values = {"solved": float(outcome == "solved"), "wall_time_s": draw.random(),
                          "cpu_time_s": draw.random(), "peak_memory_mb": 40 + 5 * draw.random()}
                if outcome != "crashed":
                    values.update({
                        "plan_time_s": 0.01 * size * draw.lognormvariate(n * 0.5, 0.6),
                        "setup_time_s": 0.002 * draw.random(),
                        "expanded": float(int(2000 * size * draw.lognormvariate(0.4 * n, 0.4)))})
                if outcome == "solved":
                    length = 25000 * size * (1 + 0.02 * n) * draw.lognormvariate(0, 0.02)
                    values.update({
                        "length_m": length, "waypoints": float(draw.randint(5, 90)),
                        "max_turn_deg": 45 + 20 * draw.random(), "max_climb_deg": 15.0,
                        "min_radius_m": 50 * draw.random(), "smoothness_rad": draw.random(),
                        "min_clearance_m": 50 + 5 * draw.random(), "duration_s": length / 20,
                        "min_ground_clearance_m": 50 + 5 * draw.random()})
                runs.append(run_of(scenario, pipeline, repetition, outcome=outcome,
                                   message=message, values=values))
    return content_of(HOSTILE if hostile else "Made up", ids, names, repetitions, runs)


def renamed(content, entry, names):
    """The content with other names for its pipelines, which become variants of one entry."""
    new = {old["name"]: name for old, name in zip(content["pipelines"], names, strict=True)}
    for run in content["runs"]:
        run["pipeline"] = new[run["pipeline"]]
    content["pipelines"] = [{"name": name, "of": entry, "file": "p.yaml"} for name in names]
    content["study"]["text"] = content["study"]["text"].split("claims:")[0]
    return content


def colonies(repetitions):
    """Runs of a colony of 100 in one scenario, beside those of a tree, with traces."""
    draw = random.Random(3)
    runs = []
    for repetition in range(repetitions):
        for pipeline in ("ants", "tree"):
            best, lines = math.inf, []
            for number in range(1, 51) if pipeline == "ants" else (40, 90, 400, 2500):
                shrink = 5 * number if pipeline == "ants" else number / 10
                mean = 1700 - shrink + 100 * draw.random()
                best = min(best, mean - 100 * draw.random())
                lines.append({"step": "plan", "kind": "iteration", "node": number, "parent": -1,
                              "at": [0, 0, 0], "value": best})
                if pipeline == "ants":
                    alive = min(100, 2 * number + draw.randint(0, 9)) if number > 3 else 0
                    lines[-1].update({"mean": mean if alive else None, "alive": alive})
                    best = best if alive else math.inf
                    lines[-1]["value"] = best if alive else None
            trace = "\n".join(json.dumps(line) for line in [{"altiplan_trace": 1}, *lines]) + "\n"
            runs.append(run_of("pocket", pipeline, repetition, outcome="solved", trace=trace,
                               values={"solved": 1.0, "length_m": best}))
    return content_of("Colonies", ["ants", "tree"], ["pocket"], repetitions, runs)
