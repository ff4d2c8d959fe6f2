"""Many runs of a program, and the table of what came of them."""

from __future__ import annotations

import itertools
import json
import warnings
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, overload

from tqdm.auto import tqdm

from . import _arl2rs
from .problems import ArlError, RefusedError, told
from .program import StrPath, given
from .values import Parameters, as_json

if TYPE_CHECKING:
    import pandas
    import polars
    from matplotlib.figure import Figure

__all__ = ["Results", "grid", "load_sweep", "sweep"]


def grid(values: Mapping[str, Iterable[Any]]) -> list[dict[str, Any]]:
    """Each value of each parameter with each of the others; the last parameter changes fastest.

    >>> grid({"global.pitch": [80, 100], "override": [50, 100]})[1]
    {'global.pitch': 80, 'override': 100}
    """
    return [dict(zip(values, row, strict=True)) for row in itertools.product(*values.values())]


class Results(Sequence[dict[str, Any]]):
    """What came of runs, a row each: `run`, `parameters`, `outcome`, `code`, `cycle_time` (s), `moving`, `standing` (s), `motions`, `way` (mm),
    `alarms`, `output`, `collisions` where they were looked for, and `problem` where a run could not begin or was lost."""

    def __init__(self, lines: Iterable[str]) -> None:
        self.lines = list(lines)
        """The rows as JSON, as `arl2rs sweep` writes them."""
        self._rows: list[dict[str, Any]] = [json.loads(line) for line in self.lines]

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
        told = ", ".join(f"{count} {outcome}" for outcome, count in sorted(outcomes.items()))
        return f"Results({len(self)} runs: {told})" if told else "Results(no runs)"

    def best(self, figure: str = "cycle_time") -> dict[str, Any]:
        """The run that ended with the smallest value of a figure."""
        ended = [row for row in self if row["outcome"] == "ended"]
        if not ended:
            why = [row.get("problem") or (row["alarms"] or [{"text": row["outcome"]}])[0]["text"] for row in self]
            raise ArlError(f"no run came to its end{': ' + why[0] if why else ''}")
        return min(ended, key=lambda row: row[figure])

    def flat(self) -> list[dict[str, Any]]:
        """The rows with a value for each column: parameters by their names, of alarms the first, of collisions how many, and the first."""
        looked = any("collisions" in row for row in self)
        return [{**dict(_flat(row, looked)), "problem": row.get("problem")} for row in self]

    def to_pandas(self) -> pandas.DataFrame:
        """A frame of pandas, which has to be installed."""
        import pandas

        return pandas.DataFrame(self.flat())

    def to_polars(self) -> polars.DataFrame:
        """A frame of polars, which has to be installed."""
        import polars

        return polars.DataFrame(self.flat(), infer_schema_length=None)

    def plot(self, parameter: str, figure: str = "cycle_time") -> Figure:
        """A picture of a figure over a parameter; runs that did not end are crosses at the bottom. matplotlib has to be installed."""
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
    """The file of `arl2rs sweep`: the arguments of `sweep` but for its rows, and the rows."""
    with told:
        settings, rows = _arl2rs.table(Path(file))
    settings["scenario"] = settings.pop("io")
    return settings, [json.loads(row) for row in rows]


def sweep(
    program: StrPath,
    rows: Iterable[Parameters],
    *,
    robot: StrPath | None = None,
    cell: StrPath | None = None,
    scenario: StrPath | None = None,
    script_dir: StrPath | None = None,
    files: Iterable[StrPath] = (),
    max_time: float | None = None,
    timeout: float | None = None,
    collisions: bool = False,
    clearance: float | None = None,
    engine: str = "local",
    processes: int = 0,
    cache: bool = True,
    progress: bool | None = None,
) -> Results:
    """Runs a program once for each row of parameters; gives what came of it, in the order of the rows.

    - `rows`: tables of parameters, as `grid` makes them: `global.NAME`, `robot.KEYS`, `cell.KEYS`, `io.KEYS`, `robot`, `io`, `override`, `mode`,
      `seed`, `max-time`, `start-time`.
    - `files`: what the program reads beside programs, data files and texts of its folder.
    - `max_time`: after so many seconds of the robot's time a run ends (3600); `timeout`: after so many on the clock it is given up (600).
    - `collisions`: whether each run looks for what its robots touch; with `clearance`, also for what comes nearer than so many mm.
    - `engine`: `local` makes the runs on `processes` of this computer (0: one for each core), `ray` on the nodes of a cluster of Ray
      (`arl2rs.farm`). The results are the same to the last bit.
    - `cache`: whether results that are known from earlier are taken, and new ones kept.
    - `progress`: whether a bar is shown; without it, where somebody looks.

    Raises `CompileError` or `RefusedError` before anything runs. A run that cannot begin, or is lost, has a row that says so.
    """
    texts = [as_json(row) for row in rows]
    settings = given(
        program,
        robot=robot,
        cell=cell,
        scenario=scenario,
        script_dir=script_dir,
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
    with told:
        bundle = _arl2rs.Bundle(settings, texts)
    lines: list[str] = []
    with tqdm(total=len(texts), unit="run", disable=None if progress is None else not progress) as bar, told:

        def came(count: int) -> None:
            bar.update(count - bar.n)

        def take(line: str) -> None:
            lines.append(line)
            came(len(lines))

        if engine == "ray":
            from . import farm

            lines.extend(farm.run(bundle, texts, timeout=timeout, cache=cache, came=came))
        else:
            _arl2rs.sweep(bundle, texts, processes, cache, take, lambda text: warnings.warn(text, stacklevel=4))
    return Results(lines)
