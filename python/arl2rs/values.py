"""Values of Python as parameters: what becomes a literal of ARL, or a value in a settings file."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

__all__ = ["Literal", "Parameters"]

Parameters = Mapping[str, Any]
"""Places and their values: `{"global.pitch": 80, "io.event.1.at": 2.5, "override": 50}`."""


@dataclass(frozen=True)
class Literal:
    """A literal of ARL as it stands, for what Python has no value for: `Literal("fine")`."""

    text: str


def plain(value: Any) -> Any:
    """A value as JSON has it."""
    if isinstance(value, Literal):
        return {"arl": value.text}
    if isinstance(value, np.generic):
        return value.item()
    if isinstance(value, np.ndarray):
        return value.tolist()
    if isinstance(value, Mapping):
        return {str(name): plain(inner) for name, inner in value.items()}
    if isinstance(value, Sequence) and not isinstance(value, str):
        return [plain(inner) for inner in value]
    return value


def as_json(parameters: Parameters) -> str:
    """Parameters as the Rust side reads them, in their order."""
    return json.dumps({name: plain(value) for name, value in parameters.items()}, default=str, allow_nan=False)


def gathered(globals: Parameters | None, points: Parameters | None, set: Parameters | None, **options: Any) -> dict[str, Any]:
    """The parameters of a run, of the arguments that `Program.run` has."""
    parameters: dict[str, Any] = {}
    for named in (globals, points):
        parameters.update({f"global.{name}": value for name, value in (named or {}).items()})
    parameters.update(set or {})
    parameters.update({name.replace("_", "-"): value for name, value in options.items() if value is not None})
    return parameters
