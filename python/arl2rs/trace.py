"""The motion of a run: one row per control cycle."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    import pandas
    import polars

__all__ = ["Trace"]


@dataclass(frozen=True, eq=False)
class Trace:
    """The set-points of the first robot while its program runs, one row per control cycle."""

    array: NDArray[np.float64]
    """The trace: a row for each cycle, a column for each of `columns`. Axes that the robot does not have are NaN."""
    columns: tuple[str, ...]
    """The columns of the command's trace, then what was watched."""
    files: Mapping[int, str] = field(default_factory=dict, repr=False)
    """The file of each motion, by its running number."""

    def __len__(self) -> int:
        return len(self.array)

    def __getitem__(self, column: str) -> NDArray[np.float64]:
        """Returns a column by its name: `trace["j1"]`."""
        if column not in self.columns:
            raise KeyError(f"{column!r} is not a column: expected one of {', '.join(self.columns)}")
        return self.array[:, self.columns.index(column)]

    @property
    def t(self) -> NDArray[np.float64]:
        """Controller time at the start of the cycle, s."""
        return self["t"]

    @property
    def line(self) -> NDArray[np.int64]:
        """The line of the motion being executed; 0: none."""
        return self["line"].astype(np.int64)

    @property
    def file(self) -> NDArray[np.object_]:
        """The file of `line`, relative to the folder of the main file; empty while no motion is executed."""
        motions, where = np.unique(self.motion, return_inverse=True)
        return np.array([self.files.get(int(motion), "") for motion in motions], dtype=object)[where]

    @property
    def motion(self) -> NDArray[np.int64]:
        """The running number of the motion being executed; 0: none."""
        return self["motion"].astype(np.int64)

    @cached_property
    def joints(self) -> NDArray[np.float64]:
        """The robot's own axes, one column each, deg (mm where they are linear)."""
        return self._there("j")

    @cached_property
    def external(self) -> NDArray[np.float64]:
        """The external axes, one column each, deg (mm)."""
        return self._there("ej")

    @property
    def tcp(self) -> NDArray[np.float64]:
        """The TCP in the world: x, y, z in mm, a, b, c in deg."""
        first = self.columns.index("x")
        return self.array[:, first : first + 6]

    @property
    def watched(self) -> tuple[str, ...]:
        """The columns that were also watched."""
        return self.columns[self.columns.index("x") + 6 :]

    @cached_property
    def velocities(self) -> NDArray[np.float64]:
        """The velocities of the robot's own axes from each cycle to the next, deg/s (mm/s); the last row repeats the
        one before it."""
        return _rate(self.joints, self.t)

    @cached_property
    def speed(self) -> NDArray[np.float64]:
        """The speed of the TCP, mm/s."""
        return np.asarray(np.linalg.norm(_rate(self.tcp[:, :3], self.t), axis=1))

    def _frame(self) -> dict[str, NDArray[Any]]:
        """The columns that the robot has, then the file; line and motion are whole numbers."""
        whole = {"line": self.line, "motion": self.motion}
        there = (
            name for name in self.columns if name in self.watched or not (len(self) and np.isnan(self[name]).all())
        )
        return {**{name: whole.get(name, self[name]) for name in there}, "file": self.file}

    def _there(self, kind: str) -> NDArray[np.float64]:
        own = self.columns[: self.columns.index("x")]
        at = [index for index, name in enumerate(own) if name.rstrip("123456") == kind]
        axes = self.array[:, at]
        return axes[:, ~np.isnan(axes).all(axis=0)] if len(axes) else axes[:, :0]

    def to_pandas(self) -> pandas.DataFrame:
        """Returns the trace as a pandas data frame. Needs pandas."""
        import pandas

        return pandas.DataFrame(self._frame())

    def to_polars(self) -> polars.DataFrame:
        """Returns the trace as a polars data frame. Needs polars."""
        import polars

        return polars.DataFrame(self._frame())


def _rate(places: NDArray[np.float64], t: NDArray[np.float64]) -> NDArray[np.float64]:
    if len(t) < 2:
        return np.zeros_like(places)
    rates = np.diff(places, axis=0) / np.diff(t)[:, None]
    return np.vstack([rates, rates[-1:]])
