"""What can be set, watched and read in a program: global variables and signals."""

from __future__ import annotations

import itertools
import json
import re
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from math import prod
from pathlib import PurePath
from typing import Any

from . import _arl2rs
from .problems import RefusedError
from .values import of_json

__all__ = ["Signal", "Variable", "Watch", "variables_by_name"]

MOST_COLUMNS = 10_000
"""The most numbers of one variable that can be watched."""


@dataclass(frozen=True)
class Signal:
    """A signal of a cell."""

    signal: str
    """`di.5`"""
    name: str | None = None
    """The name of the signal in the cell."""

    def __str__(self) -> str:
        return self.name or self.signal


@dataclass(frozen=True)
class Variable:
    """A global variable as declared."""

    name: str
    file: str
    """Relative to the folder of the main file."""
    line: int
    """From 1."""
    type: str
    """The type of the variable, or of the elements of an array: `pose`."""
    sizes: tuple[int, ...]
    """The sizes of an array; empty for a single value."""
    constant: bool
    """Whether the variable is `const` and cannot be set."""
    first: str | None
    """The initial value as declared in ARL; None without one."""
    numbers: tuple[str, ...]
    """The places of the numbers in a value: `.x`; `('',)` for a number."""

    @property
    def is_point(self) -> bool:
        """Whether the variable is a target or an array of targets."""
        return self.type.lower() in ("pose", "joint")

    def value(self, literal: str) -> Any:
        """Converts a literal of the variable's type: int, float, bool, str, lists for arrays, dictionaries for
        structures, `Literal` for the rest."""
        value = of_json(json.loads(_arl2rs.value(literal, self.type)))
        for size in reversed(self.sizes[1:]):
            value = _rows(value, size)
        return value

    def columns(self, name: str, part: str) -> list[tuple[str, str]]:
        """The numbers of a part of the variable: their names, and their places on the Rust side, where arrays have
        one dimension."""
        indices = re.match(r"(\[\d+\])*", part)
        taken = tuple(int(index) for index in re.findall(r"\d+", indices.group())) if indices else ()
        rest = part[indices.end() :] if indices else part
        fits = len(taken) <= len(self.sizes) and all(
            index < size for index, size in zip(taken, self.sizes, strict=False)
        )
        numbers = [
            number for number in self.numbers if number == rest.lower() or (not rest and not number.startswith(".ej"))
        ]
        numbers = numbers or [number for number in self.numbers if rest and number.startswith(f"{rest.lower()}.")]
        left = self.sizes[len(taken) :]
        if not fits or not numbers or (rest and left):
            raise RefusedError(f"`global.{name}{part}`: {self._shape(name)}")
        if prod(left) * len(numbers) > MOST_COLUMNS:
            raise RefusedError(f"`global.{name}{part}` has more than {MOST_COLUMNS} numbers: watch only some of them")
        all_columns = []
        for others in itertools.product(*map(range, left)):
            at = (*taken, *others)
            flat = 0
            for index, size in zip(at, self.sizes, strict=True):
                flat = flat * size + index
            for number in numbers:
                label = f"global.{name}{''.join(f'[{index}]' for index in at)}{number}"
                all_columns.append((label, f"global.{name}{f'[{flat}]' if at else ''}{number}"))
        return all_columns

    def _shape(self, name: str) -> str:
        if not any(self.numbers) and not self.numbers:
            return f"a {self.type} is not a number, nor made of numbers"
        shape = "".join(f"[0..{size - 1}]" for size in self.sizes)
        parts = ", ".join(number for number in self.numbers if number)
        return f"there is global.{name}{shape}" + (f" with {parts}" if parts else "")


def _rows(values: Sequence[Any], size: int) -> list[list[Any]]:
    return [list(values[start : start + size]) for start in range(0, len(values), size)]


def variables_by_name(found: Iterable[Mapping[str, Any]]) -> dict[str, Variable]:
    """The variables that the Rust side reports, by their names."""
    variables = [Variable(**{**one, "sizes": tuple(one["sizes"]), "numbers": tuple(one["numbers"])}) for one in found]
    count = Counter(variable.name.lower() for variable in variables)
    names = (f"{PurePath(it.file).stem}::{it.name}" if count[it.name.lower()] > 1 else it.name for it in variables)
    return dict(zip(names, variables, strict=True))


def find(name: str, variables: Mapping[str, Variable]) -> Variable | None:
    """The variable with a name, ignoring case, with or without its file."""
    own = name.rpartition("::")[2].lower()
    for known, variable in variables.items():
        if known.lower() == name.lower() or (
            f"{PurePath(variable.file).stem}::{own}".lower() == name.lower() and variable.name.lower() == own
        ):
            return variable
    return None


@dataclass(frozen=True)
class Watch:
    """What is observed after the row of a trace."""

    names: tuple[str, ...] = ()
    """The names of the numbers."""
    places: tuple[str, ...] = ()
    """The names of the numbers on the Rust side."""

    @classmethod
    def of(cls, names: Sequence[str], variables: Mapping[str, Variable]) -> Watch:
        """Leaves signals as they are, and replaces a global variable by all of its numbers."""
        columns: list[tuple[str, str]] = []
        for name in names:
            path = name.removeprefix("global.")
            own = re.split(r"[.\[]", path, maxsplit=1)[0]
            variable = find(own, variables) if path != name else None
            # The Rust side reports names that do not exist.
            columns += [(name, name)] if variable is None else variable.columns(own, path[len(own) :])
        return cls(tuple(label for label, _ in columns), tuple(place for _, place in columns))
