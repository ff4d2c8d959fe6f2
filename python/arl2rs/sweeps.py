"""Many runs of a program, and the table of their results."""

from __future__ import annotations

import itertools
import json
import time
import warnings
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Any, Protocol, Self, overload

import tqdm as _tqdm

from . import _arl2rs
from .choices import Engine
from .choices import Figure as Choice
from .keywords import named
from .notice import notice, say
from .problems import ArlError, RefusedError, StrPath, package_errors, there
from .program import given, takes_long
from .values import Parameters, as_json, of_python

with warnings.catch_warnings():
    # A notebook without ipywidgets shows a progress bar of characters, which needs no warning.
    warnings.simplefilter("ignore", _tqdm.TqdmWarning)
    from tqdm.auto import tqdm

if TYPE_CHECKING:
    import pandas
    import polars
    from matplotlib.figure import Figure

__all__ = ["Results", "Rows", "grid", "load_sweep", "sweep"]

PROGRESS_S = 30.0
"""The interval between reports of a sweep's progress where no bar is visible, s."""


class Frame(Protocol):
    """A table with columns: a pandas or polars data frame."""

    @property
    def columns(self) -> Any: ...


Rows = Iterable[Parameters] | Frame
"""Parameters of runs: a dictionary for each run, or a frame with a row for each."""


def grid(values: Mapping[str, Iterable[Any]]) -> list[dict[str, Any]]:
    """Returns every combination of the values of the parameters; the last parameter changes fastest.

    >>> grid({"global.pitch": [80, 100], "override": [50, 100]})[1]
    {'global.pitch': 80, 'override': 100}
    """
    return [dict(zip(values, row, strict=True)) for row in itertools.product(*values.values())]


class Results(Sequence[dict[str, Any]]):
    """The results of runs, one row per run: `run`, `parameters`, `outcome`, `code`, `cycle_time` (s), `moving`,
    `standing` (s), `motions`, `way` (mm), `alarms`, `output`, `collisions` if they were looked for, and `problem` if
    a run could not begin or was lost."""

    def __init__(self, lines: Iterable[str], names: Sequence[Iterable[str]] = ()) -> None:
        self.lines = list(lines)
        """The rows as JSON, as `arl2rs sweep` writes them."""
        self._rows: list[dict[str, Any]] = [json.loads(line) for line in self.lines]
        # Parameters are returned under the names under which they were given.
        for row, own in zip(self._rows, names, strict=False):
            row["parameters"] = dict(zip(own, row["parameters"].values(), strict=True))

    @overload
    def __getitem__(self, index: int) -> dict[str, Any]: ...
    @overload
    def __getitem__(self, index: slice) -> list[dict[str, Any]]: ...
    def __getitem__(self, index: int | slice) -> dict[str, Any] | list[dict[str, Any]]:
        return self._rows[index]

    def __len__(self) -> int:
        return len(self._rows)

    def __repr__(self) -> str:
        outcomes: dict[str, int] = {}
        for row in self:
            outcomes[row["outcome"]] = outcomes.get(row["outcome"], 0) + 1
        counts = ", ".join(f"{count} {outcome}" for outcome, count in sorted(outcomes.items()))
        return f"Results({len(self)} runs: {counts})" if counts else "Results(no runs)"

    def best(self, figure: Choice = "cycle_time") -> dict[str, Any]:
        """Returns the run with the smallest value of a figure, among those that reached their end."""
        ended = [row for row in self if row["outcome"] == "ended"]
        if not ended:
            why = [row.get("problem") or (row["alarms"] or [{"text": row["outcome"]}])[0]["text"] for row in self]
            raise ArlError(f"no run reached its end{': ' + why[0] if why else ''}")
        return min(ended, key=lambda row: row[figure])

    def flat(self) -> list[dict[str, Any]]:
        """Returns the rows with a single value per column: parameters by name, the first alarm, the number of
        collisions and the first one."""
        looked = any("collisions" in row for row in self)
        return [{**dict(_flat(row, looked)), "problem": row.get("problem")} for row in self]

    def to_pandas(self) -> pandas.DataFrame:
        """Returns a pandas data frame. Needs pandas."""
        import pandas

        return pandas.DataFrame(self.flat())

    def to_polars(self) -> polars.DataFrame:
        """Returns a polars data frame. Needs polars."""
        import polars

        return polars.DataFrame(self.flat(), infer_schema_length=None)

    def plot(self, parameter: str, figure: Choice = "cycle_time") -> Figure:
        """Plots a figure over a parameter; runs that did not end are crosses at the bottom. Needs matplotlib."""
        from .plots import plot_sweep

        if not any(parameter in row["parameters"] for row in self):
            raise RefusedError(f"no run has a parameter {parameter!r}")
        return plot_sweep(self.flat(), parameter, figure)

    def write(self, path: StrPath) -> None:
        """Writes the rows as JSON lines."""
        Path(path).write_text("".join(line + "\n" for line in self.lines), encoding="utf-8")


def _flat(row: Mapping[str, Any], looked: bool) -> Iterator[tuple[str, Any]]:
    if looked:
        row = {"collisions": None, **row}
    for name, value in row.items():
        if name == "parameters":
            yield from ((place, json.dumps(it) if isinstance(it, (dict, list)) else it) for place, it in value.items())
        elif name == "alarms":
            first = value[0] if value else {}
            yield from ((f"alarm_{part}", first.get(part)) for part in ("number", "text", "file", "line"))
        elif name == "collisions":
            first = value[0] if value else {}
            yield name, None if value is None else len(value)
            yield from ((f"collision_{part}", first.get(part)) for part in ("time", "file", "line", "distance"))
            yield "collision_bodies", ", ".join(first["bodies"]) if first else None
        else:
            yield name, "\n".join(value) if name == "output" else value


def load_sweep(file: StrPath) -> tuple[dict[str, Any], list[dict[str, Any]]]:
    """Reads a file of `arl2rs sweep`: returns the arguments of `sweep` except its rows, and the rows, with the Python
    names (`scenario`, `max_time`)."""
    with package_errors:
        settings, rows = _arl2rs.table(there(file, "the file of a sweep"))
    settings["scenario"] = settings.pop("io")
    return settings, [{of_python(name): value for name, value in json.loads(row).items()} for row in rows]


def rows_of(rows: Rows) -> list[Parameters]:
    """The rows of a table, without the empty cells of a frame."""
    if hasattr(rows, "columns"):
        to_rows = getattr(rows, "to_dicts", None)
        plain_rows: list[dict[str, Any]] = to_rows() if to_rows else rows.to_dict("records")  # type: ignore[union-attr]
        return [{str(name): value for name, value in row.items() if not _is_empty(value)} for row in _whole(plain_rows)]
    if isinstance(rows, Mapping):
        raise RefusedError("rows are a list of dictionaries, a run each: [{..}, {..}], or a frame")
    return list(rows)


def _is_empty(value: Any) -> bool:
    """Whether a value is None, or one of those that are not equal to themselves."""
    try:
        return value is None or bool(value != value)
    except (TypeError, ValueError):
        # pandas.NA has no truth value, an array has many.
        return type(value).__name__ in ("NAType", "NaTType")


def _whole(rows: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """Turns columns of whole numbers that became floats because of gaps back into whole numbers."""
    for name in rows[0] if rows else ():
        values = [row[name] for row in rows]
        there = [value for value in values if not _is_empty(value)]
        if len(there) < len(values) and all(isinstance(value, float) and value.is_integer() for value in there):
            for row in rows:
                row[name] = row[name] if _is_empty(row[name]) else int(row[name])
    return rows


@named
def sweep(
    program: StrPath,
    rows: Rows,
    *,
    robot: StrPath | None = None,
    cell: StrPath | None = None,
    scenario: StrPath | None = None,
    script_dir: StrPath | None = None,
    native: bool | None = None,
    files: Iterable[StrPath] = (),
    max_time: float | None = None,
    timeout: float | None = None,
    collisions: bool = False,
    clearance: float | None = None,
    engine: Engine = "local",
    processes: int = 0,
    cache: bool = True,
    progress: bool | None = None,
) -> Results:
    """Runs a program once for each row of parameters, and returns the results in the order of the rows.

    - `rows`: dictionaries of parameters, as `grid` makes them, or a pandas or polars data frame: `global.NAME`,
      `robot.KEYS`, `cell.KEYS`, `scenario.KEYS`, `robot`, `scenario`, `override`, `mode`, `seed`, `max_time`,
      `start_time`. The command's names are accepted, too.
    - `native`: whether the program is compiled to native code, as for `arl2rs.compile`.
    - `files`: the files that the program reads besides programs, data files and texts of its folder.
    - `max_time`: after this many seconds of the robot's time a run ends (3600); `timeout`: after this many on the
      clock it is given up (600).
    - `collisions`: whether each run is checked for contacts of its robots; with `clearance`, also for bodies that
      come closer than this many mm.
    - `engine`: `local` executes the runs on `processes` of this computer (0: one for each core), `ray` on the nodes
      of a Ray cluster (`arl2rs.farm`). The results are the same to the last bit.
    - `cache`: whether known results of earlier sweeps are used, and new ones kept.
    - `progress`: whether progress is shown: by a bar on a terminal and in a notebook, else by a line now and then.

    Raises `CompileError` or `RefusedError` before anything runs. A run that cannot begin, or is lost, has a row that
    says so.
    """
    table = rows_of(rows)
    texts = [as_json(row) for row in table]
    path = there(program, "a program")
    if scenario is not None:
        there(scenario, "a scenario")
    settings = given(
        path,
        robot=robot,
        cell=cell,
        scenario=scenario,
        script_dir=script_dir,
        native=native,
        files=files,
        max_time=max_time,
        timeout=timeout,
        collisions=collisions,
        clearance=clearance,
    )
    if processes < 0:
        raise RefusedError(f"{processes} processes: expected 0 or more")
    if engine not in ("local", "ray"):
        raise RefusedError(f"engine {engine!r}: expected 'local' or 'ray'")
    with (
        package_errors,
        notice(takes_long(f"{path.name} for {len(texts)} runs", native)),
    ):
        bundle = _arl2rs.Bundle(settings, texts)
    lines: list[str] = []
    with _Progress(len(texts), progress) as bar, package_errors:

        def take(line: str) -> None:
            lines.append(line)
            bar.came(len(lines))

        if engine == "ray":
            from . import farm

            lines.extend(farm.run(bundle, texts, timeout=timeout, cache=cache, came=bar.came))
        else:
            _arl2rs.sweep(bundle, texts, processes, cache, take, lambda text: warnings.warn(text, stacklevel=4))
    return Results(lines, [row.keys() for row in table])


class _Progress:
    """The progress of a sweep: a bar on a terminal or in a notebook, else a line now and then."""

    def __init__(self, total: int, shown: bool | None) -> None:
        self._total, self._came, self._last = total, 0, time.monotonic()
        self._bar = tqdm(total=total, unit="run", disable=None if shown is None else not shown)
        self._speaks = bool(self._bar.disable) and shown is not False

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, value: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._bar.close()

    def came(self, count: int) -> None:
        """Takes the number of finished runs."""
        self._bar.update(count - self._came)
        self._came = count
        if self._speaks and time.monotonic() - self._last > PROGRESS_S:
            self._last = time.monotonic()
            say(f"{count} of {self._total} runs")
