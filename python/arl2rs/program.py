"""Checks, compiles and runs programs."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Iterable, Mapping, Sequence
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, Unpack

from . import _arl2rs
from .choices import Mode
from .keywords import CompileArguments, RecordArguments, RunArguments, SweepArguments, named
from .notice import notice
from .problems import ArlError, CompileError, Diagnostic, RefusedError, StrPath, package_errors, there
from .result import Result
from .session import Beginning, Session
from .values import Parameters, as_json, gathered
from .variables import Signal, Variable, Watch, variables_by_name

if TYPE_CHECKING:
    from .sweeps import Results, Rows

__all__ = ["Program", "check", "compile", "run"]

MAX_TIME = _arl2rs.MAX_TIME
"""The robot's time after which a run is ended by default, s."""
NO_SCENARIO = "none"
"""In place of a scenario: the run has none, even if an `arl.toml` or `compile` names one."""
NAME = "program.arl"
"""The name of the main file of a program given as text."""


def takes_long(what: str, native: bool | None) -> str:
    """What is said of a program that is made ready, where that takes long."""
    if native:
        return f"compiling {what}: this takes a minute or two the first time, and seconds after a change"
    return f"making {what} ready"


def given(
    program: StrPath,
    *,
    robot: StrPath | None = None,
    cell: StrPath | None = None,
    scenario: StrPath | None = None,
    script_dir: StrPath | None = None,
    native: bool | None = None,
    files: Iterable[StrPath] = (),
    max_time: float | None = None,
    timeout: float | None = None,
    collisions: bool = False,
    clearance: float | None = None,
) -> dict[str, Any]:
    """What is to be run, as the Rust side expects it."""
    return {
        "program": Path(program),
        "robot": None if robot is None else os.fspath(robot),
        "cell": None if cell is None else Path(cell),
        "io": None if scenario is None else Path(scenario),
        "script_dir": None if script_dir is None else Path(script_dir),
        "native": native,
        "files": [Path(file) for file in files],
        "max_time": max_time,
        "timeout": timeout,
        "collisions": collisions,
        "clearance": clearance,
    }


def _text(source: str, beside: Mapping[str, str] | None) -> _arl2rs.Text:
    with package_errors:
        return _arl2rs.Text([(NAME, source), *(beside or {}).items()])


@named
def check(
    *files: StrPath,
    source: str | None = None,
    beside: Mapping[str, str] | None = None,
    robot: StrPath | None = None,
    cell: StrPath | None = None,
    script_dir: StrPath | None = None,
    strict: bool = False,
    background: bool = False,
) -> list[Diagnostic]:
    """Finds the mistakes in programs without running them, as `arl2rs check` does.

    Instead of files it takes the text of a program, `source`, and the texts of the files `beside` it, by their names.
    `robot` is the name of a built-in robot or a robot file, `cell` a cell file, `script_dir` the folder that
    `/home/ae/script/` in an import stands for. `strict` also warns about what arl2rs accepts but the controller would
    not; `background`: the programs have no robot.

    Raises `RefusedError` if a file, the robot or the cell does not exist.

    >>> [diagnostic] = check(source="func void main()\\n    movej 5\\nendfunc\\n")
    >>> diagnostic.file, diagnostic.line, diagnostic.severity
    ('program.arl', 2, 'error')
    """
    if (source is None) == (not files):
        raise RefusedError("check() needs files, or the text of a program as `source`")
    text = None if source is None else _text(source, beside)
    paths = [there(file, "a program") for file in files] if text is None else [text.path]
    settings = given(paths[0], robot=robot, cell=cell, script_dir=script_dir)
    with package_errors:
        found = _arl2rs.check(paths, settings, strict, background)
    return [_shown(Diagnostic.of_json(line), text) for line in found]


def _shown(diagnostic: Diagnostic, text: _arl2rs.Text | None) -> Diagnostic:
    """Restores the given file names in a diagnostic of a program given as text."""
    return diagnostic if text is None else diagnostic.below(text.path.parent)


@named
def compile(
    program: StrPath | None = None,
    *,
    source: str | None = None,
    beside: Mapping[str, str] | None = None,
    robot: StrPath | None = None,
    cell: StrPath | None = None,
    scenario: StrPath | None = None,
    script_dir: StrPath | None = None,
    native: bool | None = None,
) -> Program:
    """Checks a program and makes it ready to run in this process.

    Instead of a file it takes the text of a program, `source`, and the texts of the files `beside` it, by their names:
    data files, modules. An `arl.toml` beside the program's file, or above it, provides the settings that are not given
    here. With `native` the program is compiled to native code, which needs Rust (cargo), the first time a minute or
    two, and pays where a program calculates much. Otherwise it runs at once; the results are the same to the last bit.

    Raises `CompileError` if the program has mistakes, `RefusedError` if the program, the robot, the cell or the
    scenario does not exist.

    >>> compile(source="func void main()\\n    print 6 * 7\\nendfunc\\n").run().output
    '42\\n'
    """
    return Program(
        program,
        source=source,
        beside=beside,
        robot=robot,
        cell=cell,
        scenario=scenario,
        script_dir=script_dir,
        native=native,
    )


@named
def run(
    program: StrPath | None = None,
    *,
    source: str | None = None,
    beside: Mapping[str, str] | None = None,
    cell: StrPath | None = None,
    script_dir: StrPath | None = None,
    native: bool | None = None,
    **arguments: Unpack[RunArguments],
) -> Result:
    """Runs a program: `compile(..).run(..)`."""
    compiled = Program(
        program,
        source=source,
        beside=beside,
        robot=arguments.get("robot"),
        cell=cell,
        script_dir=script_dir,
        native=native,
    )
    return compiled.run(**arguments)


def _compiled(arguments: dict[str, Any]) -> Program:
    return Program(**arguments)


def _full(path: StrPath | None) -> StrPath | None:
    """The absolute path of a file; the name of a robot is unchanged."""
    if path is None or os.fspath(path) == NO_SCENARIO:
        return path
    return Path(path).absolute() if Path(path).exists() else path


def _scenario(path: StrPath | None) -> StrPath | None:
    """The path of an existing scenario, or the word for none."""
    return path if path is None or os.fspath(path) == NO_SCENARIO else there(path, "a scenario")


class Program:
    """A program in this process, created by `compile`."""

    @named
    def __init__(
        self,
        program: StrPath | None = None,
        *,
        source: str | None = None,
        beside: Mapping[str, str] | None = None,
        robot: StrPath | None = None,
        cell: StrPath | None = None,
        scenario: StrPath | None = None,
        script_dir: StrPath | None = None,
        native: bool | None = None,
    ) -> None:
        if (source is None) == (program is None):
            raise RefusedError("expected a program: either a file, or its text as `source`")
        if beside is not None and source is None:
            raise RefusedError("`beside` needs `source`: a program from a file uses the files in its folder")
        self._text = None if source is None else _text(source, beside)
        self._source: dict[str, Any] = {} if source is None else {"source": source, "beside": beside}
        self.path = (
            there(program, "a program") if program is not None else Path() if self._text is None else self._text.path
        )
        self._arguments: CompileArguments = {
            "robot": robot,
            "cell": cell,
            "scenario": _scenario(scenario),
            "script_dir": script_dir,
            "native": native,
        }
        self._given = given(self.path, robot=robot, cell=cell, scenario=scenario, script_dir=script_dir, native=native)
        with package_errors, notice(takes_long(self.path.name, native)):
            try:
                self._library = _arl2rs.Library(self._given)
            except _arl2rs.Mistakes as problem:
                raise CompileError([_shown(Diagnostic.of_json(text), self._text) for text in problem.args[0]]) from None

    def __repr__(self) -> str:
        return f"Program({str(self.path)!r})" if self._text is None else "Program(source=..)"

    def __reduce__(self) -> tuple[Any, ...]:
        """Another process makes the program ready again."""
        program = self._source or {"program": self.path.absolute()}
        files = {"robot": self._arguments["robot"], "cell": self._arguments["cell"]}
        files |= {"scenario": self._arguments["scenario"], "script_dir": self._arguments["script_dir"]}
        paths = {name: _full(path) for name, path in files.items()}
        return _compiled, ({**program, **paths, "native": self._arguments["native"]},)

    @named
    def sweep(self, rows: Rows, **arguments: Unpack[SweepArguments]) -> Results:
        """Runs the program once for each row of parameters: `arl2rs.sweep` with the robot, the cell and the scenario
        that the program was compiled with."""
        from .sweeps import sweep

        return sweep(self.path, rows, **self._arguments, **arguments)

    @cached_property
    def variables(self) -> Mapping[str, Variable]:
        """The global variables, including points, in the order of their files and declarations. If several files have a
        variable of the same name, each name is preceded by its file: `grip::held`."""
        with package_errors:
            return variables_by_name([json.loads(text) for text in _arl2rs.variables(self._given)])

    @property
    def points(self) -> Mapping[str, Variable]:
        """The global variables that are targets: poses and joints, and arrays of them."""
        return {name: variable for name, variable in self.variables.items() if variable.is_point}

    @cached_property
    def signals(self) -> tuple[Signal, ...]:
        """The signals of the cell: inputs and outputs, each with its name in the cell."""
        with package_errors:
            return tuple(Signal(signal, name) for signal, name in _arl2rs.signals(self._given))

    @cached_property
    def _kinds(self) -> Mapping[str, str]:
        """The signals that have a name in the cell, by that name."""
        return {signal.name: signal.signal for signal in self.signals if signal.name is not None}

    @property
    def columns(self) -> tuple[str, ...]:
        """The names of the columns of a trace."""
        return tuple(self._library.columns)

    @named
    def run(
        self,
        *,
        scenario: StrPath | None = None,
        robot: StrPath | None = None,
        globals: Parameters | None = None,
        points: Parameters | None = None,
        set: Parameters | None = None,
        override: float | None = None,
        mode: Mode | None = None,
        seed: int | None = None,
        max_time: float | None = MAX_TIME,
        start_time: str | None = None,
        state_dir: StrPath | None = None,
        watch: Sequence[str] = (),
        trace: bool = True,
    ) -> Result:
        """Runs the program to its end on the virtual clock; the same arguments give the same result, to the last bit.

        - `scenario`: what happens at the inputs, a file; `"none"`: no scenario, even if `compile` or an `arl.toml`
          names one.
        - `robot`: another robot, by name or file.
        - `globals`, `points`: other initial values of global variables: numbers, truth values, texts, lists and arrays;
          for structures dictionaries, whose missing components keep their values: `points={"feeder": {"z": 120}}`.
        - `set`: other values at single places:
          `{"robot.axis.1.vel": 90, "scenario.event.2.at": 1.5, "cell.controller.cycle": 2}`.
        - `override` in percent; `mode`: `auto`, `manual`, `manufast`; `seed` of `rand`.
        - `max_time`: after this many seconds of the robot's time the run is ended; None: never.
        - `start_time`: the date at the start, `2000-01-01T00:00:00`.
        - `state_dir`: the folder that keeps system variables between runs; without it nothing is kept.
        - `watch`: signals (`do.1`, or their names in the cell) and global variables (`global.placed`,
          `global.feeder.x`) to add to the trace as columns. A point or an array has a column for each of its numbers.
        - `trace`: whether to keep the motion; a second of it takes about 170 kB.

        Other threads go on during the run; Ctrl-C ends it. Raises `RefusedError` if something does not exist or does
        not fit.
        """
        parameters = gathered(
            globals, points, set, override=override, mode=mode, seed=seed, max_time=max_time, start_time=start_time
        )
        with self._begin(self._words(scenario, robot, state_dir, parameters), trace, watch, state_dir) as session:
            return session.finish()

    @named
    def session(
        self,
        *,
        scenario: StrPath | None = None,
        robot: StrPath | None = None,
        globals: Parameters | None = None,
        points: Parameters | None = None,
        set: Parameters | None = None,
        override: float | None = None,
        mode: Mode | None = None,
        seed: int | None = None,
        max_time: float | None = None,
        start_time: str | None = None,
        state_dir: StrPath | None = None,
        watch: Sequence[str] = (),
        trace: bool = False,
    ) -> Session:
        """Begins a run that is stepped: inputs in, observations out. The arguments are those of `run`; what `watch`
        names is observed after the row of the trace."""
        parameters = gathered(
            globals, points, set, override=override, mode=mode, seed=seed, max_time=max_time, start_time=start_time
        )
        return self._begin(self._words(scenario, robot, state_dir, parameters), trace, watch, state_dir)

    def _begin(self, words: list[str], trace: bool, watch: Sequence[str], state_dir: StrPath | None) -> Session:
        if isinstance(watch, str):
            raise RefusedError(f"watch is a list of names: [{watch!r}]")
        watched = (
            Watch.of(watch, self.variables)
            if any(name.startswith("global.") for name in watch)
            else Watch.of(watch, {})
        )
        return Session(Beginning(self, tuple(words), watched, trace, keeps_state=state_dir is not None))

    @named
    def record(self, recording: StrPath, **arguments: Unpack[RecordArguments]) -> None:
        """Runs the program with the command, and records the run as an mcap file for `arl2rs view` and viewers of robot
        data; the description of the robots is written beside it, `cell.urdf`. The arguments are `scenario`, `robot`,
        `globals`, `points`, `set`, `override`, `mode`, `seed`, `max_time` of `run`."""
        scenario, robot = arguments.get("scenario"), arguments.get("robot")
        parameters = gathered(
            arguments.get("globals"),
            arguments.get("points"),
            arguments.get("set"),
            override=arguments.get("override"),
            mode=arguments.get("mode"),
            seed=arguments.get("seed"),
            max_time=arguments.get("max_time"),
        )
        with tempfile.TemporaryDirectory() as nothing_kept:
            words = self._words(scenario, robot, nothing_kept, parameters)
            native = self._arguments["native"]
            engine = [] if native is None else ["--engine", "native" if native else "engine"]
            run = ["run", os.fspath(self.path.absolute()), "--record", os.fspath(recording), *engine, *words]
            command = [sys.executable, "-m", "arl2rs", *run]
            with notice(takes_long(f"{self.path.name} for a recording", native)):
                ran = subprocess.run(command, capture_output=True, text=True, check=False)
        if ran.returncode not in (0, 3, 4):
            raise ArlError(ran.stderr.strip())

    def _words(
        self, scenario: StrPath | None, robot: StrPath | None, state_dir: StrPath | None, parameters: Parameters
    ) -> list[str]:
        parameters = dict(parameters)
        files = {
            "--io": parameters.pop("io", scenario),
            "--robot": parameters.pop("robot", robot),
            "--state-dir": state_dir,
        }
        _scenario(files["--io"])
        words = dict(zip(self._library.words[::2], self._library.words[1::2], strict=True))
        words.update({option: os.fspath(value) for option, value in files.items() if value is not None})
        if words.get("--io") == NO_SCENARIO:
            del words["--io"]
        for what, option, argument in (
            ("robot.", "--robot", "robot"),
            ("cell.", "--cell", "cell"),
            ("io.", "--io", "scenario"),
        ):
            places = [place for place in parameters if place.startswith(what)]
            if places and option not in words:
                raise RefusedError(
                    f"{argument}.{places[0].removeprefix(what)}: this is a value of `{argument}`, which is not given: give it in compile() or here"
                )
        with package_errors:
            return [word for pair in words.items() for word in pair] + _arl2rs.words(as_json(parameters))
