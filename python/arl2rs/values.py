"""Values of Python as parameters: what becomes a literal of ARL, or a value in a settings file."""

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

from .problems import RefusedError

__all__ = ["Literal", "Parameters"]

Parameters = Mapping[str, Any]
"""Places and their values: `{"global.pitch": 80, "io.event.1.at": 2.5, "override": 50}`."""


@dataclass(frozen=True)
class Literal:
    """A literal of ARL as it stands, for what Python has no value for: `Literal("fine")`."""

    text: str


def plain(value: Any, place: str = "the value") -> Any:
    """A value as JSON has it; `place` is what it is for."""
    if isinstance(value, Literal):
        if not isinstance(value.text, str):
            raise RefusedError(f"{place}: a literal is a text, not {value.text!r}")
        return {"arl": value.text}
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, np.ndarray):
        value = value.tolist()
    if isinstance(value, (bool, int, str)):
        return value
    if isinstance(value, (float, Decimal, Fraction)):
        if not math.isfinite(value):
            raise RefusedError(f"{place}: {value} is no number of ARL")
        return float(value)
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    if isinstance(value, Mapping):
        return {str(name): plain(inner, f"{place}.{name}") for name, inner in value.items()}
    if isinstance(value, Sequence) and not isinstance(value, (bytes, bytearray)):
        return [plain(inner, f"{place}[{at}]") for at, inner in enumerate(value)]
    raise RefusedError(f"{place}: {value!r} is nothing that ARL has a value for")


def as_json(parameters: Parameters) -> str:
    """Parameters as the Rust side reads them, in their order."""
    if not isinstance(parameters, Mapping):
        raise RefusedError(f"parameters are a dictionary of names and values, not {parameters!r}")
    return json.dumps({name: plain(value, name) for name, value in parameters.items()})


def gathered(globals: Parameters | None, points: Parameters | None, set: Parameters | None, **options: Any) -> dict[str, Any]:
    """The parameters of a run, of the arguments that `Program.run` has."""
    parameters: dict[str, Any] = {}
    for named in (globals, points):
        if named is not None and not isinstance(named, Mapping):
            raise RefusedError(f"globals and points are dictionaries of names and values, not {named!r}")
        _join(parameters, {f"global.{name}": value for name, value in (named or {}).items()})
    _join(parameters, set or {})
    parameters.update({name.replace("_", "-"): value for name, value in options.items() if value is not None})
    return parameters


def _join(parameters: dict[str, Any], others: Parameters) -> None:
    twice = parameters.keys() & others.keys()
    if twice:
        raise RefusedError(f"{min(twice)} is given twice")
    parameters.update(others)
