# SPDX-License-Identifier: Apache-2.0
"""tutorials_test.py SOURCE BUILD [NAME…]: follows each page of docs/tutorials as a reader would.

Writes the files that a page shows, runs its commands in a folder with a copy of configs/ and an installed
altiplan, and looks for the output shown. NAMEs select pages."""
import pathlib
import shutil
import sys
import tempfile
import time

SOURCE, BUILD = (pathlib.Path(argument).resolve() for argument in sys.argv[1:3])
sys.path.insert(0, str(SOURCE / "tests/sdk"))
import walk  # noqa: E402


def walked(page):
    """Runs the page and returns the time of its commands (s)."""
    files = {name: content for name, _, content in walk.FILE_BLOCK.findall(page.read_text())}
    with tempfile.TemporaryDirectory() as name:
        home = pathlib.Path(name)
        shutil.copytree(SOURCE / "configs", home / "configs")
        (home / "build").mkdir()
        (home / "build/release").symlink_to(BUILD)
        if "$HOME/altiplan" in page.read_text():
            walk.install(BUILD, home)
        begin = time.monotonic()
        walk.Page(page, home / "none", files).walk(home)
        return time.monotonic() - begin


def main():
    names = sys.argv[3:]
    pages = [page for page in sorted((SOURCE / "docs/tutorials").glob("*.md"))
             if not names or page.stem in names]
    assert pages, f"no page of docs/tutorials is named {names}"
    for page in pages:
        print(f"{page.stem}: {walked(page):.1f} s", flush=True)


main()
