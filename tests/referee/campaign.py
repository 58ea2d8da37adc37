#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""campaign.py PROGRAM [--routes N] [--seed S] [--only N] [--out DIR] [--jobs N]: random worlds, planned,
smoothed, flown and shaken by PROGRAM, and judged again by the referee.

The same seed gives the same cases. A case with a difference is kept in DIR, and the command that runs
it again is printed; the exit code is then 1."""
import argparse
import collections
import json
import multiprocessing
import os
import shutil
import subprocess
import sys
import tempfile

import numpy as np

import layers
import page
import referee
import rules
import scenario as scenarios
import worlds

SPACE = ("astar", "bidirectional_astar", "dstar_lite", "theta_star", "lazy_theta_star",
         "stratified_theta", "spatial_slicing", "rrt", "rrt_connect", "rrt_star",
         "informed_rrt_star", "apf", "ompl")
LEVEL = ("anya", "jps", "ant_colony", "improved_ant_colony", "velocity_field", "astar", "theta_star",
         "rrt_star", "dstar_lite", "bidirectional_astar")
WING = ("rrt", "rrt_connect", "rrt_star", "informed_rrt_star", "hybrid_astar")
SMOOTHERS = ("prune", "shortcut", "bspline", "hermite", "trim", "waypoint_reduction")
OF_CELLS = {"anya", "astar", "bidirectional_astar", "dstar_lite", "theta_star", "lazy_theta_star",
            "jps", "stratified_theta", "spatial_slicing", "ant_colony", "improved_ant_colony"}


class Case:
    """One world and what is done in it."""

    def __init__(self, options, number):
        self.options, self.number = options, number
        self.rng = np.random.default_rng([options.seed, number])
        self.folder = os.path.join(options.out, f"case_{options.seed}_{number}")
        shutil.rmtree(self.folder, ignore_errors=True)
        os.makedirs(self.folder)
        self.found, self.counted = [], collections.Counter()

    def run(self):
        """(differences, what was judged); the folder stays where there is a difference."""
        kind = worlds.KINDS[self.number % len(worlds.KINDS)]
        self.world = worlds.World(self.rng, self.folder, kind)
        if self.world.settle():
            self.plan()
        if not self.found and self.options.only is None:
            shutil.rmtree(self.folder)
        else:
            with open(os.path.join(self.folder, "differences.txt"), "w", encoding="utf-8") as file:
                file.write("".join(f"{difference}\n" for difference in self.found))
        return self.found, self.counted

    def chance(self, share):
        return self.rng.random() < share

    def constraints(self):
        w, made, level = self.world, [], self.world.kind == "level"
        if w.kind == "wing":  # any corner is one too many
            return [{"turn_angle": {"max_deg": 0.5}}] if self.chance(0.5) else []
        if self.chance(0.4):
            made.append({"turn_angle": {"max_deg": float(self.rng.choice([30, 50, 95]))}})
        if self.chance(0.15):
            made.append({"turn_angle": {"max_deg": float(self.rng.choice([50, 100])),
                                        "plane": "spatial"}})
        if not level and self.chance(0.35):
            made.append({"climb_angle": {"max_deg": float(self.rng.choice([20, 46, 90]))}})
        if self.chance(0.4):
            made.append({"clearance": {"min_m": round(w.side / 200, 2)}})
        if self.chance(0.15):
            made.append({"leg_length": {"max_m": w.side / 2}})
        if self.chance(0.2):
            made.append({"route_length": {"max_ratio": 1.6}})
        if self.chance(0.2):
            made.append({"turn_radius": {"min_m": round(w.side / 100, 1)}})
        if w.kind in ("terrain", "hills") and self.chance(0.7):
            made.append({"ground_clearance": {"min_m": round(w.side / 100, 1)}})
        if not level and self.chance(0.3):
            made.append({"altitude": {"max_m": w.base + w.top, "min_m": w.base + 0.01 * w.top}})
        if w.kind in ("terrain", "hills") and self.chance(0.2):
            made.append({"altitude": {"max_m": w.top, "datum": "ground"}})
        return made

    def steps(self):
        w = self.world
        planner = str(self.rng.choice({"level": LEVEL, "wing": WING}.get(w.kind, SPACE)))
        step = {"plan": planner, "id": "route", "with": {}}
        if planner in OF_CELLS:
            cells = int(self.rng.integers(16, 30))
            step["with"]["cell_m"] = [round(w.side / cells, 2), round(w.side / cells, 2),
                                      round(w.top / 12, 2)]
        if planner in ("rrt_star", "informed_rrt_star"):
            step["with"]["max_iterations"] = 600
        if planner in ("ant_colony", "improved_ant_colony"):
            step["with"].update(ants=12, iterations=12)
        if planner == "ompl":
            step["with"].update(planner=str(self.rng.choice(["RRTConnect", "KPIECE1", "PRM"])),
                                max_iterations=4000)
        if planner == "apf":
            step["with"]["influence_m"] = round(w.side / 5, 1)
        if planner == "velocity_field":
            step["with"].update(ring_m=round(w.side / 10, 1), min_turn_radius_m=round(w.side / 50, 1))
        steps = [step]
        if w.kind == "wing":
            return [dict(step, within_s=5), {"smooth": "shortcut"}]
        for name in self.rng.choice(SMOOTHERS, int(self.rng.integers(1, 4)), replace=False):
            steps.append({"smooth": str(name)})
        if self.chance(0.5):
            steps.append(self.flight())
        return steps

    def flight(self):
        w = self.world
        fly = str(self.rng.choice(["apf", "apf", "route"]))
        if w.kind == "level" and self.chance(0.3):
            fly = "velocity_field"
        step = {"fly": fly, "with": {}, "max_time_s": 400}
        if fly == "apf":
            step["with"]["influence_m"] = round(w.side / 5, 1)
        if fly == "velocity_field":
            step["with"].update(ring_m=round(w.side / 10, 1), min_turn_radius_m=round(w.side / 50, 1))
        if self.chance(0.4):
            step["replan"] = "route"
        start, goal = (np.array(w.scenario[k]["at_m"]) for k in ("start", "goal"))
        speed = w.scenario["vehicle"]["speed_mps"]
        w.scenario["moving"] = []
        for n in range(int(self.rng.integers(0, 4))):
            velocity = self.rng.normal(0, 0.3 * speed, 3) * [1, 1, 0.2]
            at = start + (goal - start) * self.rng.uniform(0.2, 0.9) - velocity * 40
            w.scenario["moving"].append(
                {"sphere": {"at_m": worlds.rounded(at), "radius_m": w.size(0.005, 0.02),
                            "velocity_mps": worlds.rounded(velocity)},
                 # Routes are judged in time where it is said to be known: which the referee does not.
                 "id": f"drone_{n}", **({"known": False} if self.chance(0.5) else {})})
        w.scenario["events"] = self.events(start, goal, speed)
        for layer in w.scenario["environment"]:
            if "id" in layer and self.chance(0.15):
                layer["known"] = False
        return step

    def events(self, start, goal, speed):
        w, made = self.world, []
        total = np.linalg.norm(goal - start) / speed
        for n in range(int(self.rng.integers(0, 4))):
            # About where the vehicle is then: some appear over it.
            when = round(float(self.rng.uniform(0.1, 0.9) * total), 1)
            at = start + (goal - start) * np.clip(when / total + self.rng.choice([0, 0.1, 0.2]), 0, 1)
            at = at + self.rng.normal(0, w.side / 40, 3)
            made.append({"at_s": when, "id": f"pop_up_{n}", "known": bool(self.chance(0.3)),
                         "add": {"sphere": {"at_m": worlds.rounded(at), "radius_m": w.size(0.02, 0.06)}}})
            if self.chance(0.3):
                made.append({"at_s": when + 5, "remove": f"pop_up_{n}"})
            elif self.chance(0.3):
                made.append({"at_s": when + 7, "move": {
                    "layer": f"pop_up_{n}", "by_m": worlds.rounded(self.rng.normal(0, w.side / 30, 3))}})
        if self.chance(0.15):
            made.append({"when_near": {"at_m": worlds.rounded((start + goal) / 2),
                                       "within_m": round(w.side / 4, 1)},
                         "move_goal": {"at_m": worlds.rounded(goal + (start - goal) * 0.05)}})
        return made

    def plan(self):
        self.world.constraints = self.constraints() if self.chance(0.5) else []
        pipeline = {"altiplan": 1, "scenario": "scenario.yaml", "seed": int(self.rng.integers(1e6)),
                    "constraints": [] if self.world.constraints else self.constraints(),
                    "steps": self.steps()}
        self.world.write()
        path = worlds.write(self.folder, "pipeline.yaml", pipeline)
        self.result = os.path.join(self.folder, "result.json")
        code, _, err = self.altiplan("run", path, "--out", self.result)
        if code not in (0, 1):
            self.found.append(f"altiplan run: exit code {code}: {err.strip()[-300:]}")
            return
        with open(self.result, encoding="utf-8") as file:
            result = json.load(file)
        self.found += referee.judge_result(result)
        for step in result["steps"]:
            if len(step["route"]) > 1 and step["check"] is not None:
                self.counted[f"{step['verb']} {step['plugin']}"] += 1
        if result["flight"]:
            self.counted[f"fly {result['steps'][-1]['plugin']}: {result['flight']['status']}"] += 1
            self.again(result)
        if result["route"] and self.world.kind != "wing":
            self.shake(np.array(result["route"]))
            if self.chance(self.options.pages):
                scene = page.scene(self.options.program, self.result)
                self.found += page.profile_differences(scene, result["metrics"])
                self.counted["page"] += 1

    def again(self, result):
        """`altiplan check` says of the track what the flight said."""
        _, out, err = self.altiplan("check", self.result, "--json")
        told = json.loads(out).get("flight") if out else None
        if told is None or (bool(told["collisions"]) != bool(result["flight"]["collisions"])
                            or told["reached"] != result["flight"]["reached"]):
            self.found.append(f"altiplan check: of the flight {told} {err.strip()[-200:]}")

    def shake(self, route):
        for _ in range(self.options.shaken):
            moved = route + self.rng.normal(0, self.world.side * 10 ** self.rng.uniform(-4, -1.3),
                                            route.shape)
            moved[0] = route[0]
            if self.world.kind == "level":
                moved[:, 2] = route[:, 2]
            self.judge(moved, self.world.constraints, "shaken")
        if self.chance(self.options.limits):
            for constraint in self.limits_at(route):
                self.judge(route, [constraint], "at a limit")

    def limits_at(self, route):
        """Constraints just this side and just that side of what the route has."""
        mission = scenarios.of_file(os.path.join(self.folder, "scenario.yaml"))
        own = rules.measures(mission, route, *mission.known())
        corners = [s for _, _, s, _ in rules.turns(route, False) if s is not None]
        legs = np.linalg.norm(np.diff(route, axis=0), axis=1)
        clearance = own["min_clearance_m"]
        at = [("climb_angle", "max_deg", own["max_climb_deg"], {}),
              ("turn_angle", "max_deg", own["max_turn_deg"], {}),
              ("turn_angle", "max_deg", max(corners, default=None), {"plane": "spatial"}),
              ("clearance", "min_m", clearance if not mission.known()[1] else None, {}),
              ("turn_radius", "min_m", own["min_radius_m"], {}),
              ("ground_clearance", "min_m", own["min_ground_clearance_m"], {}),
              ("leg_length", "min_m", legs.min(), {}), ("leg_length", "max_m", legs.max(), {}),
              ("route_length", "max_m", own["length_m"], {}),
              ("altitude", "max_m", route[:, 2].max(), {}), ("altitude", "min_m", route[:, 2].min(), {}),
              ("altitude", "min_m", own["min_ground_clearance_m"], {"datum": "ground"})]
        for rule, key, value, more in at:
            if value is None or not mission.radius < value < 1e5:
                continue
            near = float(self.rng.choice([4e-6, 1e-4, 1e-2]))
            for limit in (value - near, value + near):
                if limit > 0 and not (key == "max_deg" and limit > (180 if "turn" in rule else 90)):
                    yield {rule: {key: float(limit), **more}}

    def judge(self, route, constraints, what):
        """A route of ours by `altiplan check --route`, and by the referee."""
        self.counted[what] += 1
        path = worlds.write(self.folder, "route.json", [[float(v) for v in p] for p in route])
        of = dict(self.world.scenario, constraints=constraints)
        scenario = worlds.write(self.folder, "shaken.yaml", of)
        code, out, err = self.altiplan("check", "--route", path, "--scenario", scenario, "--json")
        if code not in (0, 1):
            self.found.append(f"altiplan check --route: exit code {code}: {err.strip()[-300:]}")
            return
        told, mission = json.loads(out), scenarios.of_file(scenario)
        found = referee.judge_route(mission, rules.limits_of(mission), route, told["check"],
                                    told["metrics"], what)
        if found:
            n = self.counted[what]
            for name in ("route.json", "shaken.yaml"):
                shutil.copy(os.path.join(self.folder, name), os.path.join(
                    self.folder, f"{what.replace(' ', '_')}_{n}_{name}"))
        self.found += found

    def altiplan(self, *arguments):
        done = subprocess.run([self.options.program, *arguments], capture_output=True, text=True,
                              timeout=600, check=False)
        return done.returncode, done.stdout, done.stderr


def judged(of):
    options, number = of
    case = Case(options, number)
    try:
        return number, *case.run()
    except layers.NotJudged as reason:
        return number, [f"not judged: {reason}"], case.counted
    except Exception as error:  # pylint: disable=broad-except
        return number, [*case.found, f"the referee failed: {error!r}"], case.counted


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("program")
    parser.add_argument("--routes", type=int, default=100, help="how many are judged at least")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", type=int, help="one case alone")
    parser.add_argument("--out", help="where cases with differences stay; left out: a temporary folder")
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--shaken", type=int, default=2, help="shaken routes of each result")
    parser.add_argument("--limits", type=float, default=0.15, help="share of results held at limits")
    parser.add_argument("--pages", type=float, default=0.03, help="share of results that are viewed")
    return parser.parse_args()


def main():
    options = arguments()
    options.program = os.path.abspath(options.program)
    options.out = os.path.abspath(options.out or tempfile.mkdtemp(prefix="referee_"))
    numbers = [options.only] if options.only is not None else range(100 * options.routes)
    counted, differing = collections.Counter(), 0
    with multiprocessing.Pool(options.jobs) as pool:
        for number, found, of in pool.imap(judged, ((options, n) for n in numbers)):
            counted.update(of)
            if found:
                differing += 1
                print(f"case {number}: {len(found)} differences; again: {sys.argv[0]} {options.program} "
                      f"--seed {options.seed} --only {number} --out {options.out}")
                for difference in found[:5]:
                    print(f"  {difference}")
                sys.stdout.flush()
            if counted.total() >= options.routes:
                pool.terminate()
                break
    for name, count in sorted(counted.items()):
        print(f"{count:7} {name}")
    print(f"{counted.total()} judged, {differing} cases with differences")
    return 1 if differing else 0


if __name__ == "__main__":
    sys.exit(main())
