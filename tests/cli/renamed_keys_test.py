# SPDX-License-Identifier: Apache-2.0
"""renamed_keys_test.py PROGRAM BROKEN SOURCES: files of an earlier version are refused with the present
keys, and the script of CHANGELOG.md rewrites them."""
import json
import os
import re
import subprocess
import sys

SOURCES = sys.argv.pop(3)
import case  # pylint: disable=wrong-import-position
from case import CliCase, PROGRAM

PIPELINE = """altiplan: 1
scenario: scenario.yaml
constraints:
  - turn_angle: {max_deg: 120, plane: space}
steps:
  - plan: rrt
    id: tree
    with: {goal_share: 0.2}
  - smooth: hermite
    with: {least_leg_m: 20}
  - plan: improved_ant_colony
    with: {least_steps: 5}
"""
STUDY = """altiplan: 1
scenarios: [{file: scenario.yaml}]
pipelines: [{id: it, file: former.yaml}]
claims: [{id: all, that: share(it.steps.tree.stands), is: '> 0.9'}]
"""


def script():
    """The command of CHANGELOG.md without its files."""
    with open(os.path.join(SOURCES, "CHANGELOG.md"), encoding="utf-8") as file:
        return re.search(r"^sed -i .*?(?= FILES$)", file.read(), re.DOTALL | re.MULTILINE).group()


class RenamedKeys(CliCase):
    def setUp(self):
        super().setUp()
        self.write("former.yaml", PIPELINE)
        self.write("study.yaml", STUDY)

    def test_former_keys_are_refused_with_the_present_ones(self):
        _, err = self.call("validate", "former.yaml", code=3)
        self.assertIn("former.yaml:8:12: steps.0.with.goal_share: is now 'goal_bias'", err)
        self.assertIn("former.yaml:10:12: steps.1.with.least_leg_m: is now 'min_leg_m'", err)
        self.assertIn("former.yaml:12:12: steps.2.with.least_steps: is now 'min_steps'", err)
        self.assertIn("expected one of horizontal, spatial; found 'space'", err)

    def test_a_former_result_is_refused(self):
        self.call("run", self.pipeline, "--out", "result.json")
        result = json.loads(self.read("result.json"))
        result["steps"][0]["stands"] = result["steps"][0].pop("accepted")
        self.write("former.json", json.dumps(result))
        _, err = self.call("check", "former.json", code=3)
        self.assertIn("former.json: steps.0.stands: is now 'accepted'", err)

    def test_the_script_rewrites_them(self):
        subprocess.run(f"{script()} former.yaml study.yaml", shell=True, check=True,
                       cwd=self.folder)
        self.call("validate", "former.yaml")
        done = subprocess.run([PROGRAM, "study", "study.yaml", "--dry-run"], cwd=self.folder,
                              capture_output=True, text=True, check=False, timeout=600)
        self.assertEqual(done.returncode, 0, done.stderr)


if __name__ == "__main__":
    case.main()
