"""Points of a program, made from arrays."""

from __future__ import annotations

import re
from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from .choices import PointType
from .keywords import named
from .problems import RefusedError

__all__ = ["points"]

POSE = ("x", "y", "z", "a", "b", "c", "ej1", "ej2", "ej3", "ej4", "ej5", "ej6")
JOINT = ("j1", "j2", "j3", "j4", "j5", "j6", "ej1", "ej2", "ej3", "ej4", "ej5", "ej6")
MOST = 10_000
"""The most elements that an array of ARL can have."""


@named
def points(
    name: str,
    array: ArrayLike,
    *,
    type: PointType = "pose",
    components: Sequence[str] | None = None,
    separate: bool = False,
) -> str:
    """Returns the declaration of points for a data file or a program: each row of the array is a point.

    - `name` is the name of the variable: an array of `pose`, or of `joint` with `type="joint"`; with `separate` each
      point is a variable of its own: `name1`, `name2`, ..
    - `components` names the columns; by default x, y, z, a, b, c of a pose (three columns: x, y, z), and j1.. of a
      joint, then ej1.. in mm and deg.

    Raises `RefusedError` if the array does not have these columns, or has a value that is not finite.

    >>> points("weld", [[900, -50.5, 400, 0, 180, 0]])
    'pose weld[1] = {{x 900.0, y -50.5, z 400.0, a 0.0, b 180.0, c 0.0}}\\n'
    """
    if not re.fullmatch(r"[A-Za-z_]\w*", name, re.ASCII):
        raise RefusedError(f"{name!r} is not a valid name of a variable")
    if type not in ("pose", "joint"):
        raise RefusedError(f"type {type!r}: expected 'pose' or 'joint'")
    try:
        rows = np.asarray(array, dtype=np.float64)
    except (TypeError, ValueError) as problem:
        raise RefusedError(f"{name}: {problem}") from None
    if rows.ndim != 2 or not 0 < len(rows) <= MOST:
        raise RefusedError(f"expected 1 to {MOST} rows, a point each, found an array of shape {rows.shape}")
    known = POSE if type == "pose" else JOINT
    columns = tuple(components) if components is not None else known[: rows.shape[1]]
    unknown = [column for column in columns if column not in (*known, "cfg", "turn")]
    if unknown or len(columns) != rows.shape[1] or len(set(columns)) != len(columns):
        what = (
            f"{unknown[0]!r} is none of {', '.join(known)}"
            if unknown
            else f"{len(columns)} different names for {rows.shape[1]} columns"
        )
        raise RefusedError(f"components: {what}")
    if not np.isfinite(rows).all():
        row = int(np.argwhere(~np.isfinite(rows))[0][0])
        raise RefusedError(f"row {row} has a value that is not finite: {rows[row]}")
    braces = [
        "{" + ", ".join(_component(*one) for one in zip(columns, row, strict=True)) + "}" for row in rows.tolist()
    ]
    if separate:
        return "".join(f"{type} {name}{at} = {brace}\n" for at, brace in enumerate(braces, 1))
    return f"{type} {name}[{len(braces)}] = {{{', '.join(braces)}}}\n"


def _component(name: str, number: float) -> str:
    if name not in ("cfg", "turn"):
        return f"{name} {number!r}"
    if not number.is_integer():
        raise RefusedError(f"{name} is a whole number, not {number!r}")
    return f"{name} {int(number)}"
