"""Robots: axes, and the conversion from axes to poses and back."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Unpack

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _arl2rs
from .choices import Family
from .keywords import FrameArguments, named
from .problems import RefusedError, StrPath, package_errors
from .values import FrameLike

__all__ = ["Axis", "Robot", "robots"]

COMPONENTS = ("x", "y", "z", "a", "b", "c")
NOWHERE = (0.0,) * 6

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Axis:
    """An axis and its limits, in deg, deg/s, deg/s2, deg/s3; mm instead of deg where it is linear."""

    name: str
    """`j1`..; for external axes `ej1`.."""
    linear: bool
    min: float
    max: float
    vel: float
    acc: float
    jerk: float


def robots() -> list[str]:
    """Returns the names of the built-in robots; the first is the default."""
    return _arl2rs.robots()


class Robot:
    """A robot by its name or from a file: `Robot("kr10-r1420")`.

    Axes are in deg (mm where they are linear), without external axes; poses are x, y, z in mm, a, b, c in deg, as in
    a program. A pose is the TCP seen from the workpiece: `tool` is the frame of the tool seen from the flange, `wobj`
    the frame of the workpiece in the world, `base` the place of the robot in the world. With `stationary` the tool is
    fixed in the world and with `robhold` the workpiece is on the flange, as for `tool` and `wobj` of a program; both
    together or neither. Several poses or sets of axes are passed as one array with a row each.

    Raises `RefusedError` if there is no such robot, or if an array does not have the right shape.
    """

    def __init__(self, name: StrPath) -> None:
        with package_errors:
            self._robot = _arl2rs.Robot(os.fspath(name))
        self.name = self._robot.name
        self.family: Family = self._robot.family
        """`six-axis` or `scara`."""
        all_axes = tuple(Axis(*facts) for facts in self._robot.axes_facts)
        self._own = self._robot.own_count
        self.axes = all_axes[: self._own]
        """The robot's own axes."""
        self.external = all_axes[self._own :]
        """Its external axes."""
        self.home: Array = np.array(self._robot.home[: self._own])
        """The position where the simulated robot starts, without external axes."""
        self.configurations = tuple(self._robot.configurations)
        """The values that `cfg` can have."""

    def __repr__(self) -> str:
        return f"Robot({self.name!r})"

    @named
    def forward(
        self,
        joints: ArrayLike,
        **frames: Unpack[FrameArguments],
    ) -> Array:
        """Returns the pose of the TCP for axes, even beyond their ranges. Rows of axes give rows of poses."""
        rows, one = _rows(joints, self._own, "joints")
        with package_errors:
            poses, _ = self._robot.forward(rows, _frames(**frames))
        found = np.frombuffer(poses).reshape(-1, 6).copy()
        return found[0] if one else found

    def configuration(self, joints: ArrayLike) -> NDArray[np.int64]:
        """Returns the `cfg` of axes, as in poses of a program: an array for rows of axes, else one number."""
        rows, one = _rows(joints, self._own, "joints")
        with package_errors:
            _, cfgs = self._robot.forward(rows, _frames())
        found = np.array(list(cfgs), dtype=np.int64)
        return found[0] if one else found

    @named
    def inverse(
        self,
        poses: ArrayLike | Mapping[str, float],
        *,
        near: ArrayLike | None = None,
        cfg: int | None = None,
        turn: int = -1,
        chained: bool = False,
        **frames: Unpack[FrameArguments],
    ) -> Array:
        """Returns the axes that bring the TCP to a pose, within their ranges: those nearest to `near` (by default
        `home`), or of the configuration `cfg`. `turn` is as in a pose of a program.

        Rows of poses give rows of axes, each near its row of `near`, or all near its only row; with `chained` each
        near the row before it, as along a path. The row of a pose that is not reached is NaN.

        Raises `RefusedError` with the reason if a single pose is given and not reached.
        """
        rows, one = _pose_rows(poses)
        found, reasons = self._inverse(rows, near, (cfg, turn, chained), _frames(**frames))
        if one and reasons[0] is not None:
            shown = ", ".join(f"{name} {number:g}" for name, number in zip(COMPONENTS, rows[0], strict=True))
            raise RefusedError(f"{self.name} does not reach {{{shown}}}: {reasons[0]}")
        return found[0] if one else found

    @named
    def reaches(
        self,
        poses: ArrayLike | Mapping[str, float],
        **frames: Unpack[FrameArguments],
    ) -> NDArray[np.bool_]:
        """Returns whether the TCP can be at a pose with every axis within its range: an array for rows of poses, else
        one truth value."""
        rows, one = _pose_rows(poses)
        _, reasons = self._inverse(rows, None, (None, -1, False), _frames(**frames))
        found = np.array([reason is None for reason in reasons], dtype=np.bool_)
        return found[0] if one else found

    @named
    def why_not(
        self,
        poses: ArrayLike | Mapping[str, float],
        **frames: Unpack[FrameArguments],
    ) -> list[str | None]:
        """Returns for each pose the reason why it is not reached; None if it is reached."""
        rows, _ = _pose_rows(poses)
        return self._inverse(rows, None, (None, -1, False), _frames(**frames))[1]

    @named
    def solutions(
        self,
        pose: ArrayLike | Mapping[str, float],
        *,
        near: ArrayLike | None = None,
        **frames: Unpack[FrameArguments],
    ) -> dict[int, Array]:
        """Returns the axes for one pose in each configuration that reaches it, by `cfg`."""
        rows, _ = _pose_rows(pose)
        if len(rows) != 1:
            raise RefusedError(f"expected one pose, found {len(rows)}")
        setting = _frames(**frames)
        tried = {cfg: self._inverse(rows, near, (cfg, -1, False), setting) for cfg in self.configurations}
        return {cfg: found[0] for cfg, (found, reasons) in tried.items() if reasons[0] is None}

    def within(self, joints: ArrayLike) -> NDArray[np.bool_]:
        """Returns whether axes are within their ranges: an array for rows of axes, else one truth value."""
        rows, one = _rows(joints, self._own, "joints")
        low, high = (np.array([getattr(axis, end) for axis in self.axes]) for end in ("min", "max"))
        found: NDArray[np.bool_] = np.all((rows >= low) & (rows <= high), axis=1)
        return found[0] if one else found

    def _inverse(
        self, rows: Array, near: ArrayLike | None, how: tuple[int | None, int, bool], frames: _arl2rs.Frames
    ) -> tuple[Array, list[str | None]]:
        starts, _ = _rows(self.home if near is None else near, self._own, "near")
        if len(starts) not in (1, len(rows)):
            raise RefusedError(f"near has {len(starts)} rows: expected 1, or {len(rows)}, one for each pose")
        if not np.isfinite(starts).all():
            raise RefusedError("near: expected finite numbers: deg, or mm where an axis is linear")
        cfg = how[0]
        if cfg is not None and cfg not in self.configurations:
            raise RefusedError(
                f"{self.name} has no configuration {cfg}: expected one of {', '.join(map(str, self.configurations))}"
            )
        with package_errors:
            found, reasons = self._robot.inverse(rows, starts, how, frames)
        return np.frombuffer(found).reshape(-1, self._own).copy(), reasons


def _frames(
    tool: FrameLike = None,
    wobj: FrameLike = None,
    base: FrameLike = None,
    stationary: bool = False,
    robhold: bool = False,
) -> _arl2rs.Frames:
    return _frame(tool, "tool"), _frame(wobj, "wobj"), _frame(base, "base"), stationary, robhold


def _frame(frame: FrameLike, what: str) -> tuple[float, ...]:
    if frame is None:
        return NOWHERE
    if isinstance(frame, Mapping):
        unknown = frame.keys() - set(COMPONENTS)
        if unknown:
            raise RefusedError(f"{what}: a frame has {', '.join(COMPONENTS)}, not {min(unknown)}")
        frame = [frame.get(name, 0.0) for name in COMPONENTS]
    rows, one = _rows(frame, 6, what)
    if not one or not np.isfinite(rows).all():
        raise RefusedError(f"{what}: expected six numbers, x, y, z in mm, a, b, c in deg")
    return tuple(float(number) for number in rows[0])


def _pose_rows(poses: ArrayLike | Mapping[str, float]) -> tuple[Array, bool]:
    if isinstance(poses, Mapping):
        missing = [name for name in COMPONENTS if name not in poses]
        if missing:
            raise RefusedError(f"the pose has no {missing[0]}: expected {', '.join(COMPONENTS)}")
        poses = [poses[name] for name in COMPONENTS]
    return _rows(poses, 6, "poses")


def _rows(values: ArrayLike, width: int, what: str) -> tuple[Array, bool]:
    """The values as rows of `width` numbers, and whether they were a single row without an array around it."""
    try:
        rows = np.ascontiguousarray(values, dtype=np.float64)
    except (TypeError, ValueError) as problem:
        raise RefusedError(f"{what}: {problem}") from None
    if rows.ndim not in (1, 2) or rows.shape[-1] != width:
        raise RefusedError(
            f"{what}: expected {width} numbers, or rows of {width}, found an array of shape {rows.shape}"
        )
    return rows.reshape(-1, width), rows.ndim == 1
