# SPDX-License-Identifier: Apache-2.0
"""A program on a pseudo-terminal."""
import fcntl
import os
import pty
import re
import struct
import subprocess
import termios
import threading

END = b"\0"  # no program here prints one
COLOR = re.compile(r"\033\[[0-9;]*m")


def on_terminal(call, columns, cwd, **environment):
    """What the program prints on a terminal of so many columns, and its exit code."""
    master, slave = pty.openpty()
    fcntl.ioctl(slave, termios.TIOCSWINSZ, struct.pack("HHHH", 40, columns, 0, 0))
    plain = {key: value for key, value in os.environ.items() if key not in ("NO_COLOR", "TERM")}
    process = subprocess.Popen(list(map(str, call)), stdin=subprocess.DEVNULL, stdout=slave, stderr=slave,
                               cwd=cwd, env=plain | {"TERM": "xterm"} | environment)

    def mark_the_end():
        process.wait()
        os.write(slave, END)

    # The slave stays open until a mark behind the last byte has been read: a read of a terminal that
    # its last program has closed may fail while printed text is still on its way.
    waiting = threading.Thread(target=mark_the_end)
    waiting.start()
    printed = b""
    while not printed.endswith(END):
        printed += os.read(master, 65536)
    waiting.join()
    os.close(slave)
    os.close(master)
    return printed[:-len(END)].decode().replace("\r\n", "\n"), process.wait()


def progress_of(printed):
    """The lines that were overwritten."""
    return [part for part in printed.split("\r\033[K")[1:-1] if part]
