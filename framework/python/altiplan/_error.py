# SPDX-License-Identifier: Apache-2.0
"""The exception of the package, in Python so that it can be pickled."""
from typing import Any, Dict, Optional, Sequence, Tuple


class Error(Exception):
    """What altiplan refuses: a file, a parameter, a plugin.

    `file`, `line`, `column` (from 1) and `key` tell the place of the first problem, `reason` is a
    plugin's machine-readable cause; each is None where it does not apply. `problems` lists every
    problem of the files as a dict with file, line, column, key and message."""

    def __init__(self, message: str = "", file: Optional[str] = None, line: Optional[int] = None,
                 column: Optional[int] = None, key: Optional[str] = None,
                 reason: Optional[str] = None, problems: Sequence[Dict[str, Any]] = ()):
        super().__init__(message)
        self.message = message
        self.file = file
        self.line = line
        self.column = column
        self.key = key
        self.reason = reason
        self.problems = list(problems)

    def __reduce__(self) -> Tuple[Any, ...]:
        return type(self), (self.message, self.file, self.line, self.column, self.key,
                            self.reason, self.problems)
