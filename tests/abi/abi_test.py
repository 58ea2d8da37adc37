# SPDX-License-Identifier: Apache-2.0
"""abi_test.py SOURCE BUILD [REV…]: plugins of earlier versions in today's altiplan, that of BUILD.

For each version (the tags v* where none is named): its SDK is built and installed by itself; the
projects that its `altiplan new` writes and the plugins of its docs/how-to/write-a-plugin.md are built
against that; then today's altiplan loads and runs them, and their tests run on today's library.
Where the API version says that this is not supported, they must be refused, and say so. With the
last version today's library and interfaces are compared by abidiff: what changed must show in the
API version. docs/reference/abi.md says what that means. What is built stays in BUILD/abi.
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys

sys.path.append(str(pathlib.Path(__file__).resolve().parent.parent / "sdk"))
import walk  # noqa: E402

SOURCE, BUILD = (pathlib.Path(argument).resolve() for argument in sys.argv[1:3])
KINDS = ["constraint", "environment", "local_planner", "planner", "smoother", "tuner"]
# Types are told from debugging information, each wherever it is used.
DEBUG = "-g -femit-class-debug-always"
SKIPPED = 77


def skip(reason):
    print(f"skipped: {reason}")
    sys.exit(SKIPPED)


def git(*arguments, **options):
    return subprocess.run(["git", "-C", SOURCE, *arguments], capture_output=True, **options)


def quietly(command, **options):
    done = subprocess.run([str(word) for word in command], stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, text=True, **options)
    if done.returncode != 0:
        sys.exit(f"$ {' '.join(map(str, command))}\n{done.stdout}")


def versions():
    """The commits to look at by their names, the last of them the newest."""
    if git("rev-parse", "HEAD").returncode != 0:
        skip("no git repository, so no earlier version to compare with")
    names = sys.argv[3:] or git("tag", "--list", "v*", "--sort=version:refname",
                                text=True).stdout.split()
    if not names:
        skip("no tag v* (a shallow clone has none)")
    found = {}
    for name in names:
        commit = git("rev-parse", "--verify", f"{name}^{{commit}}", text=True)
        if commit.returncode != 0:
            sys.exit(f"no such version: {name}")
        found[name] = commit.stdout.strip()
    return found


class Sdk:
    """A version's source, and its SDK installed by itself."""

    def __init__(self, name, tree, folder):
        self.name = name
        self.tree = tree
        self.prefix = folder / "sdk"
        header = (tree / "framework/include/altiplan/api.hpp").read_text()
        self.api = tuple(int(re.search(rf"define ALTIPLAN_API_{part} (\d+)", header)[1])
                         for part in ("MAJOR", "MINOR"))
        build = folder / "build"
        launcher = ["-DCMAKE_CXX_COMPILER_LAUNCHER=ccache"] if shutil.which("ccache") else []
        environment = os.environ | {"CCACHE_BASEDIR": str(tree), "CCACHE_NOHASHDIR": "1"}
        quietly(["cmake", "-S", tree, "-B", build, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
                 "-DBUILD_TESTING=OFF", f"-DCMAKE_CXX_FLAGS={DEBUG}",
                 f"-DCMAKE_INSTALL_PREFIX={self.prefix}", "-DCMAKE_INSTALL_LIBDIR=lib", *launcher])
        quietly(["cmake", "--build", build, "--parallel", os.cpu_count(),
                 "--target", "altiplan", "altiplan_conformance",
                 *(["altiplan_formats"] if (tree / "framework/src/formats").exists() else []),
                 *(["altiplan_checksum"] if (tree / "tools/checksum").exists() else [])],
                env=environment)
        shutil.rmtree(self.prefix, ignore_errors=True)
        for component in ("library", "sdk"):
            quietly(["cmake", "--install", build, "--component", component])
        self.library = self.prefix / "lib/libaltiplan.so"
        hashed = self.prefix / "include/altiplan/api_hash.hpp"  # from API 2.0 on
        self.hash = hashed.read_text() if hashed.exists() else ""
        self.probe = folder / "probe.so"
        quietly(["g++", "-std=c++20", *DEBUG.split(), "-fPIC", "-shared", "-fvisibility=hidden",
                 f"-I{self.prefix}/include", "-isystem/usr/include/eigen3",
                 SOURCE / "tests/abi/probe.cpp", "-o", self.probe])

    def version(self):
        return ".".join(map(str, self.api))


def extracted(commit, folder):
    tree = folder / "source"
    if not tree.exists():
        part = folder / "part"
        part.mkdir(parents=True)
        archive = git("archive", commit, check=True).stdout
        subprocess.run(["tar", "-x", "-C", part], input=archive, check=True)
        part.rename(tree)
    return tree


def projects(old, folder):
    """What an author of that version has: a project of each kind, and the plugins of the page on
    writing one; the commands to be given in the folder of each."""
    shutil.rmtree(folder, ignore_errors=True)
    # `altiplan new` reads the templates beside the program: today's program fills that version's.
    (folder / "fill/bin").mkdir(parents=True)
    shutil.copy(BUILD / "bin/altiplan", folder / "fill/bin")
    shutil.copytree(old.tree / "tools/altiplan/templates", folder / "fill/share/altiplan/templates")
    for kind in KINDS:
        quietly([folder / "fill/bin/altiplan", "new", kind, f"my_{kind}"], cwd=folder)
    samples = folder / "my_plugins"
    pages = [old.tree / "docs" / page for page in ("how-to/write-a-plugin.md", "writing-a-plugin.md")]
    page = next(page for page in pages if page.exists()).read_text()  # by its name in that version
    for name, _, content in walk.FILE_BLOCK.findall(page):
        (samples / name).parent.mkdir(parents=True, exist_ok=True)
        (samples / name).write_text(content)
    lists = samples / "CMakeLists.txt"  # as the page's commands leave it
    text = lists.read_text() + "enable_testing()\n"
    for part in sorted(file.parent.name for file in samples.glob("*/CMakeLists.txt")):
        line = f"add_subdirectory({part})\n"
        text += "" if line in text else line
    lists.write_text(text)
    commands = {folder / f"my_{kind}": walk.typed((folder / f"my_{kind}/README.md").read_text())
                for kind in KINDS}
    commands[samples] = [
        "cmake -S . -B build", "cmake --build build", "ctest --test-dir build --output-on-failure",
        "export ALTIPLAN_PLUGIN_PATH=$PWD/build", "altiplan run first.yaml",
        "altiplan run flight.yaml"]
    return commands


def shell_of(old, folder):
    """Builds against that version, and runs today's."""
    shell = walk.Shell(folder)
    for line in (f"export CMAKE_PREFIX_PATH={old.prefix} PATH={BUILD}/bin:$PATH",
                 f"export LD_LIBRARY_PATH={BUILD}/lib CMAKE_BUILD_TYPE=Release",
                 "export CMAKE_GENERATOR=Ninja CMAKE_BUILD_PARALLEL_LEVEL=2"):
        shell.run(line)
    return shell


def loads(old, today, folder):
    """Whether plugins of that version must work; that they do, or are refused as documented."""
    supported = old.hash == today.hash
    sentence = (f"built for API {old.version()}, this altiplan offers {today.version()}"
                if old.api[0] != today.api[0] else "built with other headers; build it again")
    for project, lines in projects(old, folder).items():
        shell = shell_of(old, project)
        built = [line for line in lines if line.startswith("cmake")]
        looked = ["altiplan plugins --strict --plugin-path build"]
        for line in built + looked + [line for line in lines if line not in built]:
            output, code, _ = shell.run(line)
            where = f"{old.name}, {project.name}: $ {line}\nexit code {code}\n{output}"
            if line in looked and not supported:
                if code != 4 or sentence not in output:
                    sys.exit(f"{where}\nexpected exit code 4 and: {sentence}")
                break
            if code != 0:
                sys.exit(where)
        print(f"  {project.name}: {'works' if supported else 'refused, ' + sentence}", flush=True)
    shutil.rmtree(folder)


def abidiff(old, today, *options):
    """What abidiff says of the public types and functions; "" where nothing changed."""
    said = ""
    for a, b in ((old.library, today.library), (old.probe, today.probe)):
        done = subprocess.run(["abidiff", "--headers-dir1", old.prefix / "include",
                               "--headers-dir2", today.prefix / "include", *options, a, b],
                              capture_output=True, text=True)
        if done.returncode & 3:
            sys.exit(f"abidiff failed: {done.stderr}{done.stdout}")
        said += done.stdout if done.returncode else ""
    return said


def changes(old, today):
    """What changed must show in the API version."""
    broken = abidiff(old, today, "--no-added-syms")
    added = abidiff(old, today)
    if broken and today.api[0] == old.api[0]:
        sys.exit(f"{broken}\nabidiff: plugins built for {old.name} may fail with this altiplan: undo "
                 f"it, or raise ALTIPLAN_API_MAJOR, which is {old.api[0]} in both (docs/reference/abi.md)")
    if added and today.api == old.api:
        sys.exit(f"{added}\nabidiff: plugins built for this altiplan may need what {old.name} has "
                 f"not: raise ALTIPLAN_API_MINOR, which is {old.api[1]} in both (docs/reference/abi.md)")
    what = "incompatible changes" if broken else "additions" if added else "no change"
    print(f"abidiff from {old.name} (API {old.version()}) to API {today.version()}: {what}")


def main():
    for program in ("git", "abidiff"):
        if not shutil.which(program):
            skip(f"no {program} (tools/setup abi)")
    found = versions()
    work = BUILD / "abi"
    today = Sdk("today", SOURCE, work / "today")
    earlier = [Sdk(name, extracted(commit, work / commit), work / commit)
               for name, commit in found.items()]
    changes(earlier[-1], today)
    for old in earlier:
        print(f"plugins of {old.name}, API {old.version()}, in API {today.version()}", flush=True)
        loads(old, today, work / "projects")


main()
