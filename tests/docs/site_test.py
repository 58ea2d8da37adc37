# SPDX-License-Identifier: Apache-2.0
"""site_test.py SOURCE BUILD: the documentation site builds without a warning and has a page for every
plugin, and its checks report each kind of error.

Skipped where mkdocs-material or doxygen is missing.
"""
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile

SOURCE, BUILD = (pathlib.Path(argument).resolve() for argument in sys.argv[1:3])
PROGRAM = BUILD / "bin/altiplan"


def missing():
    if not shutil.which("mkdocs") or not pathlib.Path("/usr/share/mkdocs/themes/material").exists():
        return "mkdocs-material"
    return None if shutil.which("doxygen") else "doxygen"


def run(*command):
    done = subprocess.run(command, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    return done.stdout, done.returncode


def builds(home):
    output, code = run(SOURCE / "tools/docs", BUILD, home / "site")
    assert code == 0, output
    print(output)
    asked, _ = run(PROGRAM, "plugins", "--json")
    answer = json.loads(asked)
    entries = answer["built_in"] + [entry for library in answer["libraries"]
                                    for entry in library["plugins"]]
    assert len(entries) > 40, entries
    for entry in entries:
        page = home / "site/plugins" / entry["kind"] / entry["name"] / "index.html"
        assert "Parameters" in page.read_text(), page


def refused(home, page, text, message):
    """Expects `message` for the same pages with one more line or page."""
    root = home / "source"
    for folder in ("docs", "plugins", "tools/site", "tools/viewer"):
        shutil.copytree(SOURCE / folder, root / folder,
                        ignore=shutil.ignore_patterns("*.cpp", "node_modules", "*.js"))
    for file in [*SOURCE.glob("*.md"), SOURCE / "LICENSE"]:
        shutil.copy(file, root)
    with (root / page).open("a") as out:
        out.write(text)
    output, code = run("/usr/bin/python3", "-B", root / "tools/site/source.py", root, PROGRAM,
                       home / "parts")
    assert code == 1 and message in output, f"{page}: exit code {code}\n{output}"
    shutil.rmtree(root)


def found(home, text, message):
    """Expects `message` from check.py for a page."""
    site = home / "page"
    site.mkdir(exist_ok=True)
    (site / "index.html").write_text(f'<h1 id="top">A page</h1>\n{text}\n')
    output, code = run("/usr/bin/python3", "-B", SOURCE / "tools/site/check.py", site)
    assert (code != 0) == bool(message) and message in output, f"{text}: exit code {code}\n{output}"


def main():
    if lacking := missing():
        print(f"skipped: needs {lacking} (tools/setup docs)")
        sys.exit(77)
    with tempfile.TemporaryDirectory() as name:
        home = pathlib.Path(name)
        builds(home)
        refused(home, "docs/of_nothing.md", "# Of nothing\n",
                "docs/of_nothing.md is in no group: add it to GROUPS")
        refused(home, "docs/view.md", "\n[a picture](images/none.png)\n",
                "docs/view.md: links to images/none.png, which is not there")
        found(home, '<a href="#top">up</a>', "")
        found(home, '<a href="#bottom">down</a>', "'#bottom' leads nowhere")
        found(home, '<a href="other.html">on</a>', "'other.html' leads nowhere")
        found(home, '<script src="https://example.org/a.js"></script>', "from the network")
        found(home, "<p>As follows:\n- first</p>", "a list or table is none")


main()
