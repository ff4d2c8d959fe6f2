"""Programs: checked, compiled, run."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from . import _arl2rs
from .problems import ArlError, Diagnostic, RefusedError, told
from .result import Result
from .session import Session
from .values import Parameters, as_json, gathered

if TYPE_CHECKING:
    from .sweeps import Results

__all__ = ["Program", "check", "compile", "run"]

StrPath = str | os.PathLike[str]
MAX_TIME = _arl2rs.MAX_TIME
"""A run that takes longer in the robot's time is ended, where nobody says otherwise; s."""


def given(
    program: StrPath,
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
) -> dict[str, Any]:
    """What is run, as the Rust side has it."""
    return {
        "program": Path(program),
        "robot": None if robot is None else os.fspath(robot),
        "cell": None if cell is None else Path(cell),
        "io": None if scenario is None else Path(scenario),
        "script_dir": None if script_dir is None else Path(script_dir),
        "files": [Path(file) for file in files],
        "max_time": max_time,
        "timeout": timeout,
        "collisions": collisions,
        "clearance": clearance,
    }


def check(
    *files: StrPath,
    robot: StrPath | None = None,
    cell: StrPath | None = None,
    script_dir: StrPath | None = None,
    strict: bool = False,
    background: bool = False,
) -> list[Diagnostic]:
    """Finds the mistakes in programs without running them, as `arl2rs check` does.

    `robot` is the name of a built-in robot or a robot file, `cell` a cell file, `script_dir` the folder that `/home/ae/script/` means in an
    import. `strict` also warns where more is accepted than the controller would take; `background`: the programs have no robot.

    >>> from pathlib import Path
    >>> wrong = Path("wrong.arl")
    >>> _ = wrong.write_text("func void main()\\n    movej 5\\nendfunc\\n")
    >>> [diagnostic] = check(wrong)
    >>> diagnostic.line, diagnostic.severity
    (2, 'error')
    """
    if not files:
        raise RefusedError("check() needs a file")
    settings = given(files[0], robot=robot, cell=cell, script_dir=script_dir)
    with told:
        found = _arl2rs.check([Path(file) for file in files], settings, strict, background)
    return [Diagnostic.of_json(text) for text in found]


def compile(
    program: StrPath,
    *,
    robot: StrPath | None = None,
    cell: StrPath | None = None,
    scenario: StrPath | None = None,
    script_dir: StrPath | None = None,
) -> Program:
    """Compiles a program into this process, unless that was done before: then it is loaded at once.

    An `arl.toml` beside the program, or above it, says what is not said here. Compiling needs Rust (cargo); what is compiled does not.

    Raises `CompileError` where the program has mistakes, `RefusedError` where robot, cell or files are none.
    """
    return Program(program, robot=robot, cell=cell, scenario=scenario, script_dir=script_dir)


def run(
    program: StrPath,
    *,
    robot: StrPath | None = None,
    cell: StrPath | None = None,
    script_dir: StrPath | None = None,
    **arguments: Any,
) -> Result:
    """Compiles a program where needed, and runs it: `compile(..).run(..)`."""
    return compile(program, robot=robot, cell=cell, script_dir=script_dir).run(**arguments)


def _compiled(program: Path, arguments: dict[str, Any]) -> Program:
    return Program(program, **arguments)


def _full(path: StrPath | None) -> StrPath | None:
    """A file in full; the name of a robot stays."""
    return Path(path).absolute() if path is not None and Path(path).exists() else path


class Program:
    """A compiled program in this process: `compile` makes it."""

    def __init__(
        self,
        program: StrPath,
        *,
        robot: StrPath | None = None,
        cell: StrPath | None = None,
        scenario: StrPath | None = None,
        script_dir: StrPath | None = None,
    ) -> None:
        self.path = Path(program)
        self._given = given(program, robot=robot, cell=cell, scenario=scenario, script_dir=script_dir)
        self._arguments = {"robot": robot, "cell": cell, "scenario": scenario, "script_dir": script_dir}
        with told:
            self._library = _arl2rs.Library(self._given)

    def __repr__(self) -> str:
        return f"Program({str(self.path)!r})"

    def __reduce__(self) -> tuple[Any, ...]:
        """Another process loads it again, from where it is compiled."""
        return _compiled, (self.path.absolute(), {name: _full(path) for name, path in self._arguments.items()})

    def sweep(self, rows: Iterable[Parameters], **arguments: Any) -> Results:
        """Runs it once for each row of parameters: `arl2rs.sweep` with the robot, the cell and the scenario that it was compiled with."""
        from .sweeps import sweep

        return sweep(self.path, rows, **{**self._arguments, **arguments})

    @property
    def columns(self) -> tuple[str, ...]:
        """The names of the columns of a trace."""
        return tuple(self._library.columns)

    def run(
        self,
        *,
        scenario: StrPath | None = None,
        robot: StrPath | None = None,
        globals: Parameters | None = None,
        points: Parameters | None = None,
        set: Parameters | None = None,
        override: float | None = None,
        mode: str | None = None,
        seed: int | None = None,
        max_time: float | None = MAX_TIME,
        start_time: str | None = None,
        state_dir: StrPath | None = None,
        trace: bool = True,
    ) -> Result:
        """Runs the program to its end on the virtual clock; the same arguments give the same result, to the last bit.

        - `scenario`: what the outside does to the inputs, a file.
        - `robot`: another robot, by name or file.
        - `globals`, `points`: other first values of global variables: numbers, truth values, texts, lists; for structures dictionaries, whose
          missing components keep their values: `points={"feeder": {"z": 120}}`.
        - `set`: other values at single places: `{"robot.axis.1.vel": 90, "io.event.2.at": 1.5, "cell.controller.cycle": 2}`.
        - `override` in percent; `mode`: `auto`, `manual`, `manufast`; `seed` of `rand`.
        - `max_time`: after so many seconds of the robot's time it is ended; None: never.
        - `start_time`: the date at the start, `2000-01-01T00:00:00`.
        - `state_dir`: the folder that keeps system variables between runs; without it nothing is kept.
        - `trace`: whether to keep the motion; a second of it takes some 170 kB.

        Other threads go on meanwhile; Ctrl-C ends it. Raises `RefusedError` where something is not there or does not fit.
        """
        parameters = gathered(globals, points, set, override=override, mode=mode, seed=seed, max_time=max_time, start_time=start_time)
        with self._begin(self._words(scenario, robot, state_dir, parameters), trace) as session:
            return session.finish()

    def session(
        self,
        *,
        scenario: StrPath | None = None,
        robot: StrPath | None = None,
        globals: Parameters | None = None,
        points: Parameters | None = None,
        set: Parameters | None = None,
        override: float | None = None,
        mode: str | None = None,
        seed: int | None = None,
        max_time: float | None = None,
        start_time: str | None = None,
        state_dir: StrPath | None = None,
        watch: Sequence[str] = (),
        trace: bool = False,
    ) -> Session:
        """A run that is stepped: inputs in, observations out. The arguments are those of `run`; `watch` names signals (`do.1`, or what the
        cell calls them) and global variables (`global.placed`) that are observed."""
        parameters = gathered(globals, points, set, override=override, mode=mode, seed=seed, max_time=max_time, start_time=start_time)
        return self._begin(self._words(scenario, robot, state_dir, parameters), trace, watch)

    def _begin(self, words: list[str], trace: bool, watch: Sequence[str] = ()) -> Session:
        with told:
            return Session(self._library.begin([*words, "--report"], trace), self.columns, tuple(watch), trace)

    def record(self, recording: StrPath, **arguments: Any) -> None:
        """Runs the program by the command, and records the run for `arl2rs view` and viewers of robot data, as an mcap file; the description of the
        robots is written beside it, `cell.urdf`. The arguments are `scenario`, `robot`, `globals`, `points`, `set`, `override`, `mode`, `seed`, `max_time` of `run`."""
        scenario, robot = arguments.pop("scenario", None), arguments.pop("robot", None)
        named = [arguments.pop(name, None) for name in ("globals", "points", "set")]
        with tempfile.TemporaryDirectory() as nothing_kept:
            words = self._words(scenario, robot, nothing_kept, gathered(*named, **arguments))
            command = [sys.executable, "-m", "arl2rs", "run", self.path.absolute(), "--record", recording, *words]
            ran = subprocess.run(command, capture_output=True, text=True, check=False)
        if ran.returncode not in (0, 3, 4):
            raise ArlError(ran.stderr.strip())

    def _words(self, scenario: StrPath | None, robot: StrPath | None, state_dir: StrPath | None, parameters: Parameters) -> list[str]:
        parameters = dict(parameters)
        named = {"--io": scenario, "--robot": robot, "--state-dir": state_dir}
        for option, name in (("--io", "io"), ("--robot", "robot")):
            named[option] = parameters.pop(name, named[option])
        words = dict(zip(self._library.words[::2], self._library.words[1::2], strict=True))
        words.update({option: os.fspath(value) for option, value in named.items() if value is not None})
        for what, option, argument in (("robot.", "--robot", "robot"), ("cell.", "--cell", "cell"), ("io.", "--io", "scenario")):
            places = [place for place in parameters if place.startswith(what)]
            if places and option not in words:
                raise RefusedError(f"{places[0]}: `{argument}` says whose value this is: name it, in compile() or here")
        with told:
            return [word for pair in words.items() for word in pair] + _arl2rs.words(as_json(parameters))
