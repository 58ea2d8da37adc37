# SPDX-License-Identifier: Apache-2.0
"""Calls the program altiplan, for what must not be done in Python's process: a study forks its
workers and adopts their orphans."""
import os
import re
import signal
import subprocess
from typing import Any, Dict, List, NoReturn, Sequence

from ._error import Error

_PLACED = re.compile(r"(/.*?):(\d+):(\d+): (?:(\w+(?:\.\w+)*): )?(.*)")
_INTERRUPTED = 130


def _path() -> str:
    """The program of the same build or installation: the module's folder is
    PREFIX/lib/python3/dist-packages/altiplan, the program PREFIX/bin/altiplan."""
    prefix = os.path.abspath(__file__)
    for _ in range(5):
        prefix = os.path.dirname(prefix)
    program = os.path.join(prefix, "bin", "altiplan")
    if not os.access(program, os.X_OK):
        raise Error(f"{program}: the program is not there; install the package altiplan, or build all")
    return program


def _refuse(text: str, code: int) -> NoReturn:
    problems: List[Dict[str, Any]] = []
    for line in text.splitlines():
        placed = _PLACED.fullmatch(line)
        if placed:
            problems.append({"file": placed[1], "line": int(placed[2]), "column": int(placed[3]),
                             "key": placed[4], "message": placed[5]})
    message = text.strip().removeprefix("altiplan: ") or f"the program ended with the exit code {code}"
    first = problems[0] if problems else {}
    raise Error(message, first.get("file"), first.get("line"), first.get("column"),
                first.get("key"), problems=problems)


def call(*arguments: str, results: Sequence[int] = (0,)) -> List[str]:
    """Runs a command; returns the lines of its warnings. Error with its message if it ends with an exit
    code that is not one of `results`. Ctrl-C stops it as it stops the program, which keeps what is done, and raises KeyboardInterrupt."""
    # In a session of its own, so that Ctrl-C in a terminal reaches it once: from here.
    with subprocess.Popen([_path(), *arguments], stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                          stderr=subprocess.PIPE, start_new_session=True) as process:
        try:
            _, errors = process.communicate()
        except BaseException:
            _stop(process)
            raise
    text = errors.decode("utf-8", "replace")
    if process.returncode == _INTERRUPTED:  # by somebody else's signal
        raise KeyboardInterrupt
    if process.returncode not in results:
        _refuse(text, process.returncode)
    return text.splitlines()


def _stop(process: "subprocess.Popen[bytes]") -> None:
    """The program ends within a second and leaves nothing unfinished; not if it is killed."""
    process.send_signal(signal.SIGTERM)
    try:
        process.communicate(timeout=10)
    except BaseException:
        process.kill()
        raise


def paths(folders: Sequence[str]) -> List[str]:
    """Options for the folders of plugins."""
    return [part for folder in folders for part in ("--plugin-path", os.path.abspath(folder))]
