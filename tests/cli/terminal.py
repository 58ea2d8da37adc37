# SPDX-License-Identifier: Apache-2.0
"""A program on a pseudo-terminal."""
import fcntl
import os
import pty
import re
import struct
import subprocess
import termios

COLOR = re.compile(r"\033\[[0-9;]*m")


def on_terminal(call, columns, cwd, **environment):
    """What the program prints on a terminal of so many columns, and its exit code."""
    master, slave = pty.openpty()
    fcntl.ioctl(slave, termios.TIOCSWINSZ, struct.pack("HHHH", 40, columns, 0, 0))
    plain = {key: value for key, value in os.environ.items() if key not in ("NO_COLOR", "TERM")}
    process = subprocess.Popen(list(map(str, call)), stdin=subprocess.DEVNULL, stdout=slave, stderr=slave,
                               cwd=cwd, env=plain | {"TERM": "xterm"} | environment)
    os.close(slave)
    printed = b""
    while True:
        try:
            some = os.read(master, 65536)
        except OSError:  # the program has closed its end
            break
        if not some:
            break
        printed += some
    os.close(master)
    return printed.decode().replace("\r\n", "\n"), process.wait()


def progress_of(printed):
    """The lines that were overwritten."""
    return [part for part in printed.split("\r\033[K")[1:-1] if part]
