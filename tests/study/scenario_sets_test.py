# SPDX-License-Identifier: Apache-2.0
"""scenario_sets_test.py PROGRAM SOURCES: scenario sets as published as variants of a study.

With ALTIPLAN_TEST_DATA (default SOURCES/../shared/data) some scenarios of each map there are planned too.
"""
import csv
import os
import pathlib
import shutil
import struct
import sys
import unittest

from case import StudyCase

SOURCES = pathlib.Path(sys.argv.pop())
DATA = pathlib.Path(os.environ.get("ALTIPLAN_TEST_DATA", SOURCES / ".." / "shared" / "data")).resolve()

MAP = "type octile\nheight 3\nwidth 4\nmap\n....\n.@@.\n....\n"
SCEN = "version 1\n" + "".join(f"0\ta.map\t4\t3\t{line}\n" for line in
                               ("0\t0\t3\t2\t5", "0\t0\t0\t2\t2", "0\t0\t3\t0\t3"))
VOXELS = "voxel 4 4 4\n1 1 1\n"
VOXEL_SCEN = "version 1\na.3dmap\n0 0 0 0 3 3 4.24264 1\n3 3 3 0 0 3 4.24264 1\n"
GRID = "{file: grid.yaml, id: rooms, from: a.map.scen%s}"
STUDY = """altiplan: 1
scenarios: [%s]
pipelines: [{id: astar, file: cells.yaml}]
metrics: [{name: reference_gap}, {name: length_m}]
"""
PIPELINE = """altiplan: 1
scenario: grid.yaml
steps: [{plan: astar, with: {moves: cells, corner: free_box}}]
"""
LENGTHS = """SELECT scenarios.name, outcome, a.value, b.value FROM runs JOIN scenarios ON scenarios.id = scenario
JOIN run_values a ON a.run = runs.id AND a.quantity = (SELECT id FROM quantities WHERE name = 'length_m')
JOIN run_values b ON b.run = runs.id AND b.quantity = (SELECT id FROM quantities WHERE name = 'reference')"""
POLE = ("<sdf version='1.6'><world name='default'><model name='m'><pose>-2.25 8 0 0 0 0</pose><link name='l'>"
        "<collision name='c'><geometry><cylinder><radius>0.075</radius><length>1</length></cylinder></geometry>"
        "</collision></link></model></world></sdf>\n")


def npy(rows):
    head = ("{'descr': '<i8', 'fortran_order': False, 'shape': (%d, 2), }" % len(rows)).ljust(117) + "\n"
    return (b"\x93NUMPY\x01\x00" + struct.pack("<H", len(head)) + head.encode()
            + b"".join(struct.pack("<qq", *row) for row in rows))


class Sets(StudyCase):
    def setUp(self):
        super().setUp()
        self.write("a.map", MAP)
        self.write("a.map.scen", SCEN)
        self.write("cells.yaml", PIPELINE)
        for name, layer, more in (("grid", "grid_map: {file: a.map}", "level_flight_at_m: 0.5\n"),
                                  ("voxels", "voxel_map: {file: a.3dmap}", "")):
            ends = "[0, 0]" if more else "[0, 0, 0]"
            self.write(name + ".yaml", f"altiplan: 1\nenvironment: [{{{layer}}}]\n{more}"
                       f"start: {{at_cell: {ends}}}\ngoal: {{at_cell: {ends}}}\n")

    def runs(self, scenarios, more="", *words):
        """The rows of runs.csv of a study of these scenarios."""
        self.write("sets.yaml", STUDY % scenarios + more)
        for old in ("sets.db", "report"):
            path = pathlib.Path(self.path(old))
            if path.is_dir():
                shutil.rmtree(path)
            path.unlink(missing_ok=True)
        self.call("study", self.path("sets.yaml"), "--out", self.path("sets.db"), *words)
        self.call("report", self.path("sets.db"), "-o", self.path("report"))
        return list(csv.DictReader(self.read("report/runs.csv").splitlines()))

    def refusal(self, scenarios):
        self.write("sets.yaml", STUDY % scenarios)
        return self.call("study", self.path("sets.yaml"), "--out", self.path("sets.db"), code=3)[1]

    def test_scenarios_of_a_file_are_variants_with_their_reference(self):
        runs = self.runs(GRID % "", "claims: [{id: same, that: max(astar.reference_gap), is: == 0}]\n",
                         "--gate")
        self.assertEqual([row["scenario"] for row in runs], [f"rooms[line={n}]" for n in (2, 3, 4)])
        self.assertEqual([float(row["reference"]) for row in runs], [5, 2, 3])
        self.assertEqual([float(row["reference_gap"]) for row in runs], [0, 0, 0])
        with open(self.path("report/tables/scenarios.csv"), encoding="utf-8") as file:
            table = list(csv.DictReader(file))
        self.assertEqual([row["reference"] for row in table], ["5", "2", "3"])

    def test_each_so_many_and_other_keys(self):
        runs = self.runs(GRID % ", every: 2, set: {vehicle.radius_m: [0, 0.25]}")
        self.assertEqual({row["scenario"] for row in runs},
                         {f"rooms[line={line},radius_m={radius}]" for line in (2, 4) for radius in (0, 0.25)})

    def test_a_wrong_reference_shows(self):
        self.write("a.map.scen", SCEN.replace("2\t5\n", "2\t4\n"))
        self.assertEqual(float(self.runs(GRID % "")[0]["reference_gap"]), 0.25)

    def test_scenarios_between_voxels(self):
        self.write("a.3dmap", VOXELS)
        self.write("a.3dmap.3dscen", VOXEL_SCEN)
        runs = self.runs("{file: voxels.yaml, from: a.3dmap.3dscen}")
        self.assertEqual([row["outcome"] for row in runs], ["solved"] * 2)
        for row in runs:
            self.assertAlmostEqual(float(row["length_m"]), float(row["reference"]), delta=1e-5)

    def test_mat_files(self):
        file = SOURCES / "plugins" / "environment" / "mat_terrain" / "conformance.mat"
        os.mkdir(self.path("moea"))
        for name in ("terrainStruct_m_2.mat", "terrainStruct_c_1.mat"):
            shutil.copy(file, self.path("moea/" + name))
        self.write("moea.yaml", "altiplan: 1\nenvironment: [{mat_terrain: {file: moea/terrainStruct_c_1.mat}}]\n"
                   "volume: {min_m: [0, 0, 0], max_m: [600, 600, 300]}\n"
                   "vehicle: {radius_m: 0}\nstart: {at_m: [0, 0, 50]}\ngoal: {at_m: [600, 600, 50]}\n")
        self.write("study.yaml", STUDY.replace("cells.yaml", "rrt.yaml") % "{file: moea.yaml, from: moea}")
        self.write("rrt.yaml", "altiplan: 1\nscenario: moea.yaml\nsteps: [{plan: rrt_connect}]\n")
        self.call("study", self.path("study.yaml"), "--out", self.path("s.db"))
        rows = self.rows(self.path("s.db"), "SELECT scenarios.name, outcome, overrides FROM runs "
                         "JOIN scenarios ON scenarios.id = scenario ORDER BY scenario")
        self.assertEqual([row[:2] for row in rows], [("moea[map=c_1]", "solved"), ("moea[map=m_2]", "solved")])
        self.assertIn("start.at_m=[0.0,0.0,40.", rows[0][2].replace(" ", ""), "raised to the ground")
        self.assertIn("goal.at_m=[600.0,600.0,100.0]", rows[0][2].replace(" ", ""))
        with open(self.path("moea/terrainStruct_c_1.mat"), "r+b") as stream:
            stream.truncate(400)
        self.assertIn("terrainStruct_c_1.mat: it is damaged", self.refused(
            "study", self.path("study.yaml"), "--out", self.path("t.db")))

    def barn(self):
        folder = pathlib.Path(self.path("barn"))
        (folder / "path_files").mkdir(parents=True)
        for world in (2, 10):
            (folder / f"world_{world}.world").write_text(POLE, encoding="utf-8")
            (folder / "path_files" / f"path_{world}.npy").write_bytes(npy([(15, 0), (15, 29)]))
        shutil.copy(SOURCES / "configs" / "scenarios" / "barn.yaml", self.path("barn.yaml"))
        scenario = self.read("barn.yaml").replace("../data/barn/world_0.world", "barn/world_2.world")
        self.write("barn.yaml", scenario)
        return folder

    def test_worlds_of_barn(self):
        self.barn()
        self.write("cells.yaml", self.read("cells.yaml").replace("grid.yaml", "barn.yaml").replace(
            "moves: cells,", "cell_m: [0.1, 0.1, 0.5],"))
        runs = self.runs("{file: barn.yaml, from: barn}")
        self.assertEqual([(row["scenario"], row["outcome"]) for row in runs],
                         [("barn[world=2]", "solved"), ("barn[world=10]", "solved")])
        # From (-2.25, 3) to the cells' x of 15 * 0.15 - 4.575, and to (-2.25, 13).
        for row in runs:
            aside = 15 * 0.15 - 4.575 + 2.25
            length = ((aside**2 + 2.075**2)**0.5 + 29 * 0.15 + (aside**2 + (13 - 9.425)**2)**0.5)
            self.assertAlmostEqual(float(row["reference"]), length, delta=1e-9)
            self.assertGreaterEqual(float(row["min_clearance_m"]), 0.215 - 1e-6)

    def test_what_is_wrong_is_refused_with_its_place(self):
        folder = self.barn()
        for name, text, entry, why in (
                ("a.map.scen", "version 1\n0\ta.map\t5\t3\t0\t0\t3\t2\t5\n", GRID % "",
                 "a.map.scen:2: is for a map of 5 x 3 cells, the map has 4 x 3"),
                ("a.map.scen", "version 1\n0\ta.map\t4\t3\t0\t0\t4\t2\t5\n", GRID % "",
                 "a.map.scen:2: expected the goal within the map's 4 cells"),
                ("a.map.scen", "version 1\n", GRID % "", "there is no scenario in it"),
                ("a.map.scen", SCEN, GRID % ", set: {start: {at_cell: [0, 0]}}",
                 "sets 'start.at_cell', which each scenario of 'from' does"),
                ("a.map", "type octile\n", GRID % "", "a.map: expected a map, which begins with its size"),
                ("b.scen", SCEN, "{file: grid.yaml, from: b.scen}", "expected a name such as arena.map.scen"),
                ("b.txt", SCEN, "{file: grid.yaml, from: b.txt}", "b.txt: expected a .scen, .3dscen or .mat file"),
                ("b.txt", "", "{file: grid.yaml, from: missing.map.scen}", "missing.map: there is no such file"),
                ("b.txt", "", "{file: grid.yaml, every: 2}", "every is of a set"),
                ("b.txt", "", "{file: barn.yaml, from: barn/path_files}", "expected worlds of BARN")):
            self.write("a.map", MAP)
            self.write("a.map.scen", SCEN)
            self.write(name, text)
            self.assertIn(why, self.refusal(entry), entry)
        path = folder / "path_files" / "path_2.npy"
        whole = path.read_bytes()
        for damaged, why in ((whole[:-1], "expected 2 rows"), (b"PK" + whole, "an array of NumPy's"),
                             (whole.replace(b"<i8", b"<f8"), "rows of two 64-bit integers"),
                             (whole[:9], "an array of NumPy's"), (npy([]), "at least one")):
            path.write_bytes(damaged)
            self.assertIn(why, self.refusal("{file: barn.yaml, from: barn}"))
        path.unlink()
        self.assertIn("path_2.npy: there is no such file", self.refusal("{file: barn.yaml, from: barn}"))

    def published(self, folder, base, pattern, count):
        """Some scenarios of each map: lengths as published, to the digits printed."""
        sets = sorted((DATA / folder).glob(pattern))
        if not sets:
            self.skipTest(f"{DATA / folder} is absent")
        for file in sets:
            scenarios = file.read_text(encoding="utf-8").splitlines()
            entry = f"{{file: {base}.yaml, from: {file}, every: {len(scenarios) // count}}}"
            base_text = self.read(base + ".yaml")
            self.write(base + ".yaml", base_text.replace("a.map", str(file)[:-5]).replace(
                "a.3dmap", str(file)[:-7]))
            self.write("sets.yaml", STUDY % entry)
            store = self.path(file.name + ".db")
            self.call("study", self.path("sets.yaml"), "--out", store, "--jobs", "2", "--reuse", "100")
            self.write(base + ".yaml", base_text)
            runs = self.rows(store, LENGTHS)
            self.assertGreaterEqual(len(runs), count)
            for scenario, outcome, length, reference in runs:
                self.assertEqual(outcome, "solved", scenario)
                decimals = len(str(reference).partition(".")[2])
                self.assertAlmostEqual(length, reference, delta=0.0061 if decimals <= 2 else 0.001, msg=scenario)

    def test_published_grids(self):
        self.published("grid2d", "grid", "*.map.scen", 3)

    def test_published_voxels(self):
        self.published("voxel3d", "voxels", "[DSC]*.3dscen", 2)


if __name__ == "__main__":
    StudyCase.program = sys.argv.pop(1)
    unittest.main()
