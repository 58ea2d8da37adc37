# SPDX-License-Identifier: Apache-2.0
"""Calls of a program in which the system fails it, by the preloaded library of faults.cpp."""
import collections
import errno
import mmap
import os
import signal
import struct
import subprocess
import tempfile
import uuid

# in the order of fate.hpp, with the errors that a system gives for each. EINTR is not among those of
# open and read: Linux gives it for pipes and terminals, and no file here is one; libraries that read
# files (GDAL) rightly expect none.
ERRORS = {
    "open": ("EIO", "EMFILE", "ENFILE", "ENOMEM", "EACCES", "KILL"),
    "read": ("EIO", "HALF", "KILL"),
    "write": ("EIO", "ENOSPC", "EINTR", "HALF", "KILL"),
    "sync": ("EIO", "ENOSPC", "KILL"),
    "truncate": ("EIO", "ENOSPC", "KILL"),
    "rename": ("EIO", "ENOSPC", "EACCES", "KILL"),
    "link": ("EIO", "ENOSPC", "EACCES", "KILL"),
    "unlink": ("EIO", "EACCES", "KILL"),
    "mkdir": ("EIO", "ENOSPC"),
    "stat": ("EIO", "ENOMEM"),
    "close": ("EIO", "KILL"),
    "lock": ("ENOLCK", "EIO"),
    "fork": ("EAGAIN", "ENOMEM", "KILL"),
    "map": ("ENOMEM",),
    "descriptor": ("EMFILE", "ENFILE"),
}
CALLS = tuple(ERRORS)
SPECIAL = {"KILL": -1, "HALF": -2}
SCOPES = ("tree", "process", "children")
KEPT, PATH = 64, 248
STATE_SIZE = 4 * (len(CALLS) + 3) + KEPT * (8 + PATH)


class Fault(collections.namedtuple("Fault", "calls nth times error scope below")):
    """The nth of these calls ("open,descriptor") and those that follow, `times` in all (0: from then
    on), counted in a scope, that concern files of the input, of libraries too, or all."""

    def __str__(self):
        return "%s %d %d %s %s %s" % self

    @classmethod
    def read(cls, text):
        calls, nth, times, error, scope, below = text.split()
        return cls(calls, int(nth), int(times), error, scope, below)

    def reason(self):
        """What the system says."""
        return os.strerror(getattr(errno, self.error))


def counting(calls=",".join(CALLS), scope="tree", below="files"):
    return Fault(calls, 0, 1, "EIO", scope, below)


class Ended:
    """How a call has ended: its exit code (negative: the signal; None: it hangs), what it said, how
    many calls of the system it made of each kind, and the [kind, path] of those that failed."""

    def __init__(self, code, out, err, state):
        self.code, self.out, self.err = code, out, err
        numbers = struct.unpack_from("%dI" % (len(CALLS) + 2), state)
        self.counted = dict(zip(CALLS, numbers))
        self.failures = numbers[-1]
        self.failed = []
        for n in range(min(self.failures, KEPT)):
            at = 4 * (len(CALLS) + 3) + n * (8 + PATH)
            call, _ = struct.unpack_from("Ii", state, at)
            path = state[at + 8:at + 8 + PATH].split(b"\0")[0].decode(errors="replace")
            self.failed.append((CALLS[call], path))


def with_id(mark):
    """Processes with this text in their environment."""
    found = []
    for name in filter(str.isdigit, os.listdir("/proc")):
        try:
            with open("/proc/%s/environ" % name, "rb") as stream:
                if mark.encode() in stream.read():
                    found.append(int(name))
        except OSError:
            pass  # gone, a zombie, or another user's
    return found


def end_all(mark):
    """Ends what is left of a call."""
    for process in with_id(mark):
        try:
            os.kill(process, signal.SIGKILL)
        except ProcessLookupError:
            pass


class Injector:
    def __init__(self, program, library, below, timeout):
        """`below`: folders by the names that faults call them by."""
        self.program, self.library, self.below, self.timeout = program, library, below, timeout

    def call(self, arguments, folder, fault=None):
        mark = uuid.uuid4().hex
        with tempfile.NamedTemporaryFile() as file:
            file.truncate(STATE_SIZE)
            variables = dict(os.environ, ALTIPLAN_TEST=mark)
            if fault:
                kinds = sum(1 << CALLS.index(call) for call in fault.calls.split(","))
                code = SPECIAL.get(fault.error) or getattr(errno, fault.error)
                variables.update(LD_PRELOAD=self.library, FAULTS_STATE=file.name,
                                 FAULTS_CALLS=str(kinds), FAULTS_NTH=str(fault.nth),
                                 FAULTS_TIMES=str(fault.times), FAULTS_ERROR=str(code),
                                 FAULTS_SCOPE=fault.scope, FAULTS_BELOW=self.below[fault.below])
            process = subprocess.Popen([self.program, *arguments], cwd=folder, env=variables,
                                       stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                       stderr=subprocess.PIPE, start_new_session=True)
            try:
                out, err = process.communicate(timeout=self.timeout)
                code = process.returncode
            except subprocess.TimeoutExpired:
                end_all(mark)
                out, err = process.communicate()
                code = None
            with mmap.mmap(file.fileno(), STATE_SIZE) as state:
                ended = Ended(code, out.decode(errors="replace"), err.decode(errors="replace"),
                              state[:])
        ended.mark = mark
        return ended
