# SPDX-License-Identifier: Apache-2.0
"""The page in tools/viewer/dist is the one that its sources make: it says from which it was made."""
import hashlib
import os
import re
import unittest

VIEWER = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "tools", "viewer")


def sources():
    """As tools/viewer/bundle.mjs counts them."""
    names = [os.path.relpath(os.path.join(folder, name), VIEWER)
             for folder, _, files in os.walk(os.path.join(VIEWER, "src")) for name in files]
    total = hashlib.sha256()
    for name in sorted(names + ["LICENSES.md", "bundle.mjs", "package-lock.json"]):
        total.update(f"{name}\n".encode())
        with open(os.path.join(VIEWER, name), "rb") as file:
            total.update(file.read())
    return total.hexdigest()


class Sources(unittest.TestCase):
    def test_the_page_is_made_of_them(self):
        with open(os.path.join(VIEWER, "dist", "viewer.html"), encoding="utf-8") as file:
            said = re.search(r'<meta name="sources" content="(\w+)">', file.read())
        self.assertIsNotNone(said, "run tools/viewer/build and commit dist/")
        self.assertEqual(said.group(1), sources(), "run tools/viewer/build and commit dist/")


if __name__ == "__main__":
    unittest.main()
