# SPDX-License-Identifier: Apache-2.0
"""peer_test.py PROGRAM COUNT: another implementation of MAVLink reads what this one writes.

Skipped where node or its packages are missing (`npm ci --ignore-scripts` in this folder)."""
import pathlib
import shutil
import subprocess
import sys

PROGRAM, COUNT = sys.argv[1:3]
FOLDER = pathlib.Path(__file__).resolve().parent


def main():
    node = shutil.which("node")
    if not node or not (FOLDER / "node_modules" / "node-mavlink").is_dir():
        print("skipped: node or node-mavlink is not installed (npm ci --ignore-scripts)")
        return 77
    with subprocess.Popen([PROGRAM, COUNT], stdout=subprocess.PIPE) as writer:
        return subprocess.run([node, "read_messages.mjs"], cwd=FOLDER, stdin=writer.stdout,
                              check=False).returncode


sys.exit(main())
