"""Python values as parameters, which become literals of ARL or values in a settings file."""

from __future__ import annotations

import json
import math
import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from decimal import Decimal
from fractions import Fraction
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .problems import RefusedError

__all__ = ["FrameLike", "Literal", "Parameters"]

Parameters = Mapping[str, Any]
"""Places and their values: `{"global.pitch": 80, "scenario.event.1.at": 2.5, "override": 50}`."""

FrameLike = Sequence[float] | NDArray[np.float64] | Mapping[str, float] | None
"""A frame: x, y, z in mm, a, b, c in deg, as six numbers or by name (see `Session.global_value`); None: identity."""

COMMAND_NAMES = {"scenario": "io", "max_time": "max-time", "start_time": "start-time"}
"""The command's names of parameters that have another name in Python."""
PYTHON_NAMES = {theirs: ours for ours, theirs in COMMAND_NAMES.items()}


def _renamed(name: str, names: Mapping[str, str]) -> str:
    first, point, rest = name.partition(".")
    # `scenario.event.1.at` is a place in the scenario; only the names of files are followed by places.
    return names.get(first, first) + point + rest if not point or first in ("scenario", "io") else name


def of_command(name: str) -> str:
    """The command's name of a parameter; the command's name itself is accepted, too."""
    return _renamed(name, COMMAND_NAMES)


def of_python(name: str) -> str:
    """The Python name of one of the command's parameters."""
    return _renamed(name, PYTHON_NAMES)


@dataclass(frozen=True)
class Literal:
    """A literal of ARL as written, for values that Python does not have: `Literal("fine")`."""

    text: str


def plain(value: Any, place: str = "the value") -> Any:
    """A value as JSON represents it; `place` names it in errors."""
    if isinstance(value, Literal):
        if not isinstance(value.text, str):
            raise RefusedError(f"{place}: a literal is a string, not {value.text!r}")
        return {"arl": value.text}
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, np.ndarray):
        value = value.tolist()
    if isinstance(value, (bool, int, str)):
        return value
    if isinstance(value, (float, Decimal, Fraction)):
        if not math.isfinite(value):
            raise RefusedError(f"{place}: {value} is not a number of ARL")
        return float(value)
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    if isinstance(value, Mapping):
        return {str(name): plain(inner, f"{place}.{name}") for name, inner in value.items()}
    if isinstance(value, Sequence) and not isinstance(value, (bytes, bytearray)):
        return [plain(inner, f"{place}[{at}]") for at, inner in enumerate(value)]
    raise RefusedError(f"{place}: ARL has no value for {value!r}")


def as_json(parameters: Parameters) -> str:
    """Parameters in the form that the Rust side reads, in their order."""
    if not isinstance(parameters, Mapping):
        raise RefusedError(f"parameters are a dictionary of names and values, not {parameters!r}")
    named: dict[str, Any] = {}
    for name, value in parameters.items():
        _join(named, {of_command(str(name)): plain(value, str(name))})
    return json.dumps(named)


def of_json(value: Any) -> Any:
    """The Python value for a value of ARL as the Rust side reports it."""
    if isinstance(value, list):
        return [of_json(inner) for inner in value]
    if isinstance(value, dict):
        if value.keys() == {"arl"}:
            return Literal(value["arl"])
        return {name: of_json(inner) for name, inner in value.items()}
    return value


def gathered(
    globals: Parameters | None, points: Parameters | None, set: Parameters | None, **options: Any
) -> dict[str, Any]:
    """The parameters of a run, from the arguments of `Program.run`."""
    parameters: dict[str, Any] = {}
    for named in (globals, points):
        if named is not None and not isinstance(named, Mapping):
            raise RefusedError(f"globals and points are dictionaries of names and values, not {named!r}")
        _join(parameters, {f"global.{name}": value for name, value in (named or {}).items()})
    for name, value in (set or {}).items():
        _join(parameters, {of_command(str(name)): value})
    _join(parameters, {of_command(name): value for name, value in options.items() if value is not None})
    return parameters


def _join(parameters: dict[str, Any], others: Parameters) -> None:
    twice = parameters.keys() & others.keys()
    if twice:
        raise RefusedError(f"{min(twice)} is given twice")
    parameters.update(others)
