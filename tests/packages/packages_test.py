# SPDX-License-Identifier: Apache-2.0
"""packages_test.py BUILD: the packages in BUILD/packages on a clean Debian 12, as a new user does.

Installs them by apt, which resolves what they depend on; runs pipelines; writes a plugin by
`altiplan new` and does all that its README says, word for word and timed; removes the packages.
Needs root. The clean system is kept in BUILD/debian12.tar.
"""
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time

sys.path.append(str(pathlib.Path(__file__).resolve().parent.parent / "sdk"))
import walk  # noqa: E402

BUILD = pathlib.Path(sys.argv[1]).resolve()
MOST_SECONDS = 600  # from an installed package to the report of a study
CONFIGS = "/usr/share/altiplan/configs"
PIPELINES = f"{CONFIGS}/pipelines"
PICTURE = f"""import altiplan
result = altiplan.go("{CONFIGS}/data/jacksboro_fault.tif", start=(-84.38, 36.48), goal=(-84.12, 36.70),
                     out="first", max_agl=120)
result.plot().savefig("first.png")
"""
# All that a planner needs.
PLANNER = """import altiplan
@altiplan.planner("bends", "Straight to the goal, or around what is in the way with one bend")
class Bends:
    def plan(self, request):
        (x, y, z), (to_x, to_y, to_z) = request.start, request.goal
        for tried in range(101):
            if request.budget.spent(tried):
                return None
            out = 0.1 * ((tried + 1) // 2) * (-1) ** tried
            bend = ((x + to_x) / 2 - out * (to_y - y), (y + to_y) / 2 + out * (to_x - x),
                    (z + to_z) / 2)
            route = [request.start, bend, request.goal]
            if not request.world.violations(route):
                return route
"""
STUDY = f"""altiplan: 1
name: bends
scenarios: [{{file: {CONFIGS}/scenarios/fusion_random.yaml}}]
pipelines: [{{id: bends, file: bends.yaml}}, {{id: astar, file: {PIPELINES}/hills_astar.yaml}}]
"""


def clean_system():
    """The archive of a Debian 12 with apt and nothing that is not essential."""
    archive = BUILD / "debian12.tar"
    if not archive.exists():
        part = BUILD / "debian12.part.tar"
        subprocess.run(["mmdebstrap", "--quiet", "--variant=apt", "bookworm", part], check=True)
        part.rename(archive)
    return archive


class System:
    """Runs commands in the root folder, in sessions with processes of their own."""

    def __init__(self, root):
        self.home = root / "home/author"
        # `altiplan` finds what it is installed with by /proc.
        enter = ["unshare", "--mount", "--pid", "--fork", "--kill-child", f"--root={root}",
                 "--wd=/", "--mount-proc"]
        self.root = walk.Shell("/", [*enter, "bash", "--norc"])
        self.do("export DEBIAN_FRONTEND=noninteractive; useradd --create-home author")
        self.author = walk.Shell("/", [*enter, "su", "-", "author", "-c", "bash --norc"])

    def do(self, command, shell=None):
        """The output and the seconds of a command that must succeed."""
        start = time.monotonic()
        output, code, _ = (shell or self.root).run(command)
        seconds = time.monotonic() - start
        print(f"{seconds:7.1f} s  {command}", flush=True)
        if code != 0:
            sys.exit(f"$ {command}\nexit code {code}\n{output}")
        for line in output.splitlines():
            if line.startswith(("Need to get", "After this operation")):  # apt-get
                print(f"           {line}")
        return output, seconds

    def as_author(self, command):
        return self.do(command, self.author)


def program_alone(system):
    """The package altiplan needs none of the others."""
    output, _ = system.do("apt-get install --yes --no-install-recommends /packages/altiplan_*.deb")
    assert "gdal" not in output, output
    system.as_author("altiplan --version")
    system.as_author("altiplan plugins --strict")
    system.as_author(f"altiplan run {PIPELINES}/hills_astar.yaml --out alone.json")
    system.as_author("altiplan check alone.json && altiplan view alone.json -o page.html")


def all_of_them(system):
    system.do("apt-get install --yes /packages/*.deb")
    output, _ = system.as_author("altiplan plugins --strict")
    for name in ("terrain", "mesh", "ompl"):
        assert name in output, output
    system.as_author(f"altiplan run {PIPELINES}/ridge_crossing.yaml")  # terrain, by GDAL
    system.as_author(f"altiplan run {PIPELINES}/city_theta_star.yaml")


def python_package(system):
    """The Python package runs a pipeline; an import by root leaves nothing behind, see removed()."""
    for shell in (system.root, system.author):
        output, _ = system.do(
            "/usr/bin/python3 -c 'import altiplan; "
            f"print(altiplan.__file__, altiplan.run(\"{PIPELINES}/hills_astar.yaml\").status)'", shell)
        assert output == "/usr/lib/python3/dist-packages/altiplan/__init__.py solved\n", output
    system.as_author("/usr/bin/python3 -c 'import pandas, matplotlib'")  # recommended
    files = system.home / "python"
    files.mkdir()
    for name, text in {"picture.py": PICTURE, "bends.py": PLANNER, "study.yaml": STUDY,
                       "bends.yaml": "altiplan: 1\nsteps: [{plan: bends}]\n"}.items():
        (files / name).write_text(text)
    system.do("chown -R author /home/author/python")
    system.as_author("cd python && /usr/bin/python3 picture.py && test -s first.png")
    output, _ = system.as_author("altiplan check-plugin bends.py")
    assert " 0 failed" in output, output
    system.as_author("altiplan study study.yaml --out study.db --plugin-path .")
    output, _ = system.as_author(
        "/usr/bin/python3 -c 'import altiplan; print(list(altiplan.Study(\"study.db\").runs().outcome))'; "
        "cd ..")
    assert output == "['solved', 'solved']\n", output


def plugin_of_ones_own(system):
    """From `altiplan new` to the report of a study: the seconds that it takes."""
    total = system.as_author("altiplan new planner my_planner && cd my_planner")[1]
    readme, _ = system.as_author("cat README.md")
    for line in walk.typed(readme):
        total += system.as_author(line)[1]
    print(f"{total:7.1f} s  in all, of {MOST_SECONDS}")
    assert total < MOST_SECONDS
    # Installed beside altiplan's own plugins, it needs no path.
    system.do("cmake --install /home/author/my_planner/build --prefix /usr")
    system.as_author("unset ALTIPLAN_PLUGIN_PATH; altiplan plugins --strict | grep my_planner")
    system.do("xargs rm -v < /home/author/my_planner/build/install_manifest.txt")


def removed(system):
    system.do("apt-get remove --yes altiplan altiplan-dev altiplan-plugins-geo "
              "python3-altiplan")
    output, _ = system.do("find / -xdev -iname '*altiplan*' -not -path '/packages/*' "
                          "-not -path '/home/*' -not -path '/var/lib/dpkg/*'")
    assert output == "", output
    system.do("! ldconfig -p | grep altiplan")


def main():
    archive = clean_system()
    with tempfile.TemporaryDirectory(dir=BUILD) as root:
        subprocess.run(["tar", "-x", "-f", archive, "-C", root], check=True)
        root = pathlib.Path(root)
        shutil.copyfile("/etc/resolv.conf", root / "etc/resolv.conf")
        (root / "packages").mkdir()
        for file in (BUILD / "packages").glob("*.deb"):
            shutil.copy(file, root / "packages")
        root.chmod(0o755)
        system = System(root)
        system.do("apt-get update")
        program_alone(system)
        all_of_them(system)
        python_package(system)
        plugin_of_ones_own(system)
        removed(system)


main()
