"""Names of arguments: a typo is reported with the closest name before anything is done."""

from __future__ import annotations

import difflib
import functools
import inspect
from collections.abc import Callable, Iterable, Sequence
from typing import ParamSpec, TypedDict, TypeVar, get_type_hints

from .choices import Engine, Mode
from .problems import StrPath
from .values import FrameLike, Parameters

__all__ = [
    "CompileArguments",
    "EpisodeArguments",
    "FrameArguments",
    "RecordArguments",
    "RunArguments",
    "SweepArguments",
    "named",
]

P = ParamSpec("P")
R = TypeVar("R")

_COMMAND_WORDS = {"io": "scenario", "jobs": "processes", "no_cache": "cache"}
"""The Python names of options that have another name in the command."""


class CompileArguments(TypedDict, total=False):
    """The arguments of `compile` besides the program."""

    robot: StrPath | None
    cell: StrPath | None
    scenario: StrPath | None
    script_dir: StrPath | None
    native: bool | None


class _AnyRun(TypedDict, total=False):
    scenario: StrPath | None
    robot: StrPath | None
    globals: Parameters | None
    points: Parameters | None
    set: Parameters | None
    override: float | None
    mode: Mode | None
    seed: int | None


class RecordArguments(_AnyRun, total=False):
    """The arguments of `Program.record` besides the recording."""

    max_time: float | None


class RunArguments(RecordArguments, total=False):
    """The arguments of `Program.run`."""

    start_time: str | None
    state_dir: StrPath | None
    watch: Sequence[str]
    trace: bool


class EpisodeArguments(_AnyRun, total=False):
    """The arguments of an episode of an `Environment` besides the environment's own."""

    start_time: str | None
    state_dir: StrPath | None
    trace: bool


class FrameArguments(TypedDict, total=False):
    """What lies between a pose and the flange of a `Robot`."""

    tool: FrameLike
    wobj: FrameLike
    base: FrameLike
    stationary: bool
    robhold: bool


class SweepArguments(TypedDict, total=False):
    """The arguments of `sweep` besides the program, its rows, and what the program is compiled with."""

    files: Iterable[StrPath]
    max_time: float | None
    timeout: float | None
    collisions: bool
    clearance: float | None
    engine: Engine
    processes: int
    cache: bool
    progress: bool | None


def named(function: Callable[P, R], /) -> Callable[P, R]:
    """Reports a typo in the name of an argument with the closest name, even if the arguments are passed on."""
    known = _names(function)

    @functools.wraps(function)
    def called(*args: P.args, **kwargs: P.kwargs) -> R:
        for name in kwargs:
            if name not in known:
                raise TypeError(f"{function.__name__}() has no argument `{name}`{_meant(name, known)}")
        return function(*args, **kwargs)

    return called


def _names(function: Callable[..., object]) -> list[str]:
    names: list[str] = []
    for parameter in inspect.signature(function).parameters.values():
        if parameter.kind is not inspect.Parameter.VAR_KEYWORD:
            names.append(parameter.name)
            continue
        # `**arguments: Unpack[RunArguments]`
        table = str(parameter.annotation).removeprefix("Unpack[").removesuffix("]")
        names += get_type_hints(globals()[table])
    return names


def _meant(name: str, known: list[str]) -> str:
    word = _COMMAND_WORDS.get(name)
    if word in known:
        return f": it is called `{word}` here"
    near = difflib.get_close_matches(name.replace("-", "_"), known, 1)
    return f": did you mean `{near[0]}`?" if near else f": there are {', '.join(it for it in known if it != 'self')}"
