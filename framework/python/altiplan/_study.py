# SPDX-License-Identifier: Apache-2.0
"""Studies: run by the program, read from their database, as tables of pandas."""
import csv
import html
import json
import os
import pathlib
import re
import sqlite3
import tempfile
import warnings
import zlib
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, Dict, Iterator, List, Optional, Sequence, Union

from . import _altiplan, _program, _values
from ._error import Error

if TYPE_CHECKING:
    import pandas

_Path = Union[str, "os.PathLike[str]"]
_APPLICATION_ID = 0x616C7470
_FORMAT = 2
_COLUMNS = ("run", "scenario", "pipeline", "repetition", "seed", "outcome", "message", "wall_time_s",
            "cpu_time_s", "peak_memory_mb", "key", "place", "session")
_ROWS_AT_ONCE = 100_000
_WHOLE = re.compile(r"-?\d{1,15}")


def study(file: _Path, out: _Path, *, jobs: int = 1, reuse: int = 1, sample: Optional[float] = None,
          filter: Optional[str] = None, shard: Optional[str] = None, traces: bool = False,
          fresh: bool = False, plugin_path: Sequence[_Path] = ()) -> "Study":
    """Runs a study's pipelines in its scenarios, each run in a process of its own, and stores them
    in the database `out`, as `altiplan study` does; runs that are stored already are not repeated,
    except with `fresh`.

    `jobs` runs go on at once, each process does `reuse` of them. `sample` is a fraction of the
    scenarios and repetitions, `filter` a regular expression on 'PIPELINE SCENARIO #REPETITION',
    `shard` a part such as "1/4". `traces` stores those of searches too. Ctrl-C raises
    KeyboardInterrupt; the same call then goes on. Error for files and plugins that are refused."""
    arguments = ["study", os.path.abspath(_values.path(file, "file")),
                 "--out", os.path.abspath(_values.path(out, "out")),
                 f"--jobs={_values.whole(jobs, 'jobs', 1, 1024)}",
                 f"--reuse={_values.whole(reuse, 'reuse', 1, 1000000)}",
                 *_program.paths(_values.paths(plugin_path, "plugin_path"))]
    if sample is not None:
        arguments.append(f"--sample={_values.fraction(sample, 'sample')}")
    for name, value in (("filter", filter), ("shard", shard)):
        if value is not None:
            arguments.append(f"--{name}={_values.text(value, name)}")
    arguments += ["--traces"] * bool(traces) + ["--fresh"] * bool(fresh)
    for sentence in _program.call(*arguments):
        warnings.warn(sentence, stacklevel=2)
    return Study(out)


class Study:
    """The database of a study, read only: `path`, `name`, and `planned`, how many runs there are to
    the study. Study(path): Error if there is none or it is of another kind."""

    def __init__(self, path: _Path):
        self.path = os.path.abspath(_values.path(path, "path"))
        with self._opened() as store:
            facts = dict(store.execute("SELECT name, value FROM study"))
        self.name: str = facts.get("name", "")
        self.planned = int(facts.get("planned", 0))
        self._files: Dict[str, str] = {}
        self._state: Any = None

    @contextmanager
    def _opened(self) -> Iterator[sqlite3.Connection]:
        """A connection that sees one state of the database."""
        try:
            os.stat(self.path)
        except OSError as error:
            raise Error(f"{self.path}: {error.strerror}", self.path) from None
        try:
            store = sqlite3.connect(pathlib.Path(self.path).as_uri() + "?mode=ro", uri=True,
                                    isolation_level=None)
            try:
                store.execute("BEGIN")
                kind = store.execute("PRAGMA application_id").fetchone()[0]
                version = store.execute("PRAGMA user_version").fetchone()[0]
                if kind != _APPLICATION_ID:
                    raise Error(f"{self.path}: not a database of a study", self.path)
                if version != _FORMAT:
                    raise Error(f"{self.path} is of version {version} of the store; this program supports "
                                f"version {_FORMAT}: run the study again with another out, or use the "
                                "program of that version", self.path)
                yield store
            finally:
                store.close()
        except sqlite3.Error as error:
            raise Error(f"{self.path}: {error}", self.path) from error

    def __repr__(self) -> str:
        with self._opened() as store:
            count = store.execute("SELECT count(*) FROM runs").fetchone()[0]
        return f"<altiplan.Study {self.name!r}: {count} of {self.planned} runs>"

    def runs(self) -> "pandas.DataFrame":
        """The stored runs as a pandas.DataFrame, one row each, by scenario, pipeline, repetition.

        Columns: `run`, its id; `scenario`, `pipeline`, `repetition`, `seed`; `outcome`, how it
        ended, and `message`; `wall_time_s`, `cpu_time_s`, `peak_memory_mb`; `key`, `place`,
        `session` (docs/reference/study-database.md); then each parameter that variants set, by its
        key, such as `steps.0.with.weight_g` or `scenario.environment.0.hills.seed`, None where it
        is not set; then every number of the results by its name, such as `length_m` or
        `steps.route.counters.expanded`, nan where a run has none. `solved` is a bool."""
        import numpy
        import pandas

        with self._opened() as store:
            rows = store.execute(
                "SELECT runs.id, scenarios.name, pipelines.name, repetition, seed, outcome, message, "
                "wall_time_s, cpu_time_s, peak_memory_mb, key, place, session, "
                "pipelines.overrides, scenarios.overrides "
                "FROM runs JOIN scenarios ON scenarios.id = scenario "
                "JOIN pipelines ON pipelines.id = pipeline "
                "ORDER BY scenario, pipeline, repetition").fetchall()
            names = dict(store.execute("SELECT id, name FROM quantities ORDER BY name"))
            row_of = {row[0]: i for i, row in enumerate(rows)}
            column_of = {quantity: i for i, quantity in enumerate(names)}
            values = numpy.full((len(rows), len(names)), numpy.nan)
            cursor = store.execute("SELECT run, quantity, value FROM run_values")
            while True:
                some = cursor.fetchmany(_ROWS_AT_ONCE)
                if not some:
                    break
                values[[row_of[run] for run, _, _ in some],
                       [column_of[quantity] for _, quantity, _ in some]] = [one[2] for one in some]
        parameters = [_parameters(*row[len(_COLUMNS):]) for row in rows]
        table: Dict[str, Any] = {name: [row[i] for row in rows]
                                 for i, name in enumerate(_COLUMNS)}
        for name in dict.fromkeys(name for each in parameters for name in each):
            table[name] = [each.get(name) for each in parameters]
        for quantity, i in column_of.items():
            name = names[quantity]
            if name not in table:
                table[name] = values[:, i].astype(bool) if name == "solved" else values[:, i]
        return pandas.DataFrame(table)

    def result(self, run: int) -> _altiplan.Result:
        """The result of the run with this id; it has no warnings and notes. KeyError without such a
        run, or where its process gave no result."""
        number = _values.whole(run, "run", 0, 2**63 - 1)
        with self._opened() as store:
            found = store.execute("SELECT result FROM results WHERE run = ?", (number,)).fetchone()
        if found is None or found[0] is None:
            raise KeyError(run)
        return _altiplan.stored(zlib.decompress(found[0]).decode(), [])

    def report(self, out: _Path, *, times: bool = True) -> str:
        """Writes the report's folder, as `altiplan report` does; without `times`, equal results give
        equal files. Returns the path of its page."""
        folder = os.path.abspath(_values.path(out, "out"))
        _program.call("report", self.path, "--out", folder, *([] if times else ["--no-times"]))
        return os.path.join(folder, "index.html")

    def tables(self) -> Dict[str, "pandas.DataFrame"]:
        """The tables of the report by name: `success`, `success-pairs`, `metrics`, `verdicts`,
        `pairs-METRIC`, `scenarios`, … Numbers are in full, shares from 0 to 1, nan for none; a column
        of intervals is two, "COLUMN from" and "COLUMN to"."""
        return self._frames("tables/")

    def figures(self) -> Dict[str, "pandas.DataFrame"]:
        """The numbers that the report's figures draw, by name: `success`, `boxes-METRIC`,
        `pairs-METRIC`, `ranks-METRIC`, … (docs/reference/report.md)."""
        return self._frames("figures/")

    def _frames(self, folder: str) -> Dict[str, "pandas.DataFrame"]:
        return {os.path.basename(name).rpartition(".")[0]: _frame(list(csv.reader(text.splitlines())))
                for name, text in self._report().items() if name.startswith(folder)}

    def _repr_html_(self) -> str:
        """The report's page in a frame, which works offline."""
        page = html.escape(self._report()["index.html"])
        return f'<iframe style="width: 100%; height: 640px; border: 0" srcdoc="{page}"></iframe>'

    def _report(self) -> Dict[str, str]:
        """The texts of the report by file, computed again if the database has changed."""
        now = os.stat(self.path) if os.path.exists(self.path) else None
        state = now and (now.st_mtime_ns, now.st_size)
        if not self._files or state != self._state:
            with tempfile.TemporaryDirectory(prefix="altiplan_") as folder:
                self.report(os.path.join(folder, "report"))
                root = pathlib.Path(folder) / "report"
                files = [root / "index.html", *sorted(root.glob("tables/*.csv")),
                         *sorted(root.glob("figures/*.csv"))]
                self._files = {str(file.relative_to(root)): file.read_text(encoding="utf-8")
                               for file in files}
            self._state = state
        return self._files


def _parameters(*overrides: str) -> Dict[str, Any]:
    """What a pipeline's and a scenario's variant set: key and value."""
    found: Dict[str, Any] = {}
    for assignments in overrides:
        for assignment in json.loads(assignments):
            key, _, text = assignment.partition("=")
            found[key.lstrip("~")] = _value(text) if not key.startswith("~") else None
    return found


def _value(text: str) -> Any:
    """A number or a Boolean; the text of anything else, by which rows can be grouped."""
    try:
        value = json.loads(text)
    except ValueError:
        return text
    return value if isinstance(value, (bool, int, float, str)) else text


def _frame(rows: List[List[str]]) -> "pandas.DataFrame":
    import pandas

    return pandas.DataFrame({name: _column([row[i] for row in rows[1:]])
                             for i, name in enumerate(rows[0] if rows else [])})


def _column(cells: List[str]) -> List[Any]:
    """Numbers if all of them are, with nan for none; else the texts, without the blank that keeps
    spreadsheets from reading a formula."""
    if all(_WHOLE.fullmatch(cell) for cell in cells):
        return [int(cell) for cell in cells]
    try:
        return [float(cell or "nan") for cell in cells]
    except ValueError:
        return [cell[1:] if cell[:1] == " " else cell for cell in cells]
