# SPDX-License-Identifier: Apache-2.0
"""sanitized.py LIBRARIES LIST COMMAND…: runs a test of a build with GCC's address sanitizer, whose LIBRARIES must
be loaded before Python. Exits as the test does, but with 1 if a process of it, such as a worker, made an error
in memory or ended with a leak that is not Python's: one with altiplan among those that asked for the memory, or
one that the LIST does not name."""
import os
import pathlib
import re
import subprocess
import sys
import tempfile

OPTIONS = {
    # Reports go to files, leaks of the interpreter change no exit code, and errors end in a signal.
    "ASAN_OPTIONS": "log_path={folder}/report:exitcode=0:abort_on_error=1:handle_segv=0:"
                    "stack_trace_format='    #%n %F %S (%m)'",
    "UBSAN_OPTIONS": "log_path={folder}/report:abort_on_error=1",
}
# In Python's code, which keeps no frame pointers, stacks end early. To follow them is right, and slow.
WHOLE_STACKS = ":fast_unwind_on_malloc=0:malloc_context_size=40"
FRAME = re.compile(r" {4}#\d+ .*\((\S*)\)$", re.MULTILINE)
OURS = re.compile(r"/(_altiplan\.|libaltiplan|altiplan$|tests/plugins/)")
NOBODY = re.compile(r"/(libasan|libubsan|libstdc\+\+|libc)\.so")  # who asks for somebody else


def environment(libraries, folder, whole_stacks):
    """What the sanitizer reads, in the test and in the processes that it starts."""
    found = {**os.environ, "LD_PRELOAD": libraries, "PYTHONMALLOC": "malloc"}  # Python's own hides errors
    for name, options in OPTIONS.items():
        found[name] = os.environ.get(name, "") + ":" + options.format(folder=folder)
    if whole_stacks:
        found["ASAN_OPTIONS"] += WHOLE_STACKS
    return found


def names(file):
    """Those in a list of leaks."""
    return [line[len("leak:"):].strip() for line in file.read_text().splitlines() if line.startswith("leak:")]


def is_known(leak, known):
    """Whether a leak is one of those that the list names."""
    modules = FRAME.findall(leak)
    if any(OURS.search(module) for module in modules):
        return False
    asks = next((module for module in modules if not NOBODY.search(module)), "nobody")
    return any(one in asks for one in known)


def of_interest(report, known):
    """The report, without leaks that are known; empty if there is nothing else."""
    head, *leaks = re.split(r"^(?=(?:Direct|Indirect) leak of )", report, flags=re.MULTILINE)
    if "LeakSanitizer: detected memory leaks" not in head:
        return report
    return "".join(leak for leak in leaks if not is_known(leak, known))


def main(libraries, named, *command):
    known = names(pathlib.Path(named))
    with tempfile.TemporaryDirectory(prefix="altiplan_sanitized_") as folder:
        whole = os.environ.get("ALTIPLAN_WHOLE_STACKS") == "1"
        code = subprocess.run(command, env=environment(libraries, folder, whole), check=False).returncode
        for file in sorted(pathlib.Path(folder).iterdir()):
            text = of_interest(file.read_text(errors="replace"), known)
            if text:
                print(text, flush=True)
                code = code or 1
    return code if code >= 0 else 128 - code


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
