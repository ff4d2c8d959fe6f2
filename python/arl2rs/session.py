"""Runs that are stepped."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import dataclass
from types import TracebackType
from typing import TYPE_CHECKING, Any, Self

import numpy as np
from numpy.typing import NDArray

from . import _arl2rs
from .problems import AlarmError, RefusedError, SessionError, package_errors
from .result import Alarm, Result, alarms_of, ended_by, of_summary
from .values import plain
from .variables import Watch, find

if TYPE_CHECKING:
    from .program import Program

__all__ = ["Session", "Snapshot"]

ALARMED = 3
"""The exit code of a run that was ended by an alarm."""

Done = tuple[str, tuple[Any, ...]]
"""An action on a session: the name of a method of the Rust side, and its arguments."""


@dataclass(frozen=True)
class Beginning:
    """The settings that a session begins with."""

    program: Program
    words: tuple[str, ...]
    watch: Watch
    traced: bool
    keeps_state: bool


@dataclass(frozen=True)
class Snapshot:
    """The state of a session, taken by `Session.snapshot`; any number of sessions can continue from it.

    A run cannot be copied: to continue, everything that was done until then is repeated, which takes as long as it
    took the first time. A snapshot can be pickled, and continued in other processes. The repeated run writes the
    files of its program again, in the same places.
    """

    beginning: Beginning
    done: tuple[Done, ...]
    time: float
    """Controller time, s."""
    observed: bytes

    def resume(self) -> Session:
        """Returns a new session at the same point of the same run, on the calling thread.

        Raises `SessionError` if repeating the run gives another result: a file that the run reads has changed since.
        """
        session = Session(self.beginning)
        session._repeat(self.done)
        if session.time != self.time or session.observe().tobytes() != self.observed:
            session.close()
            raise SessionError(
                f"repeating the run up to {self.time:.3f} s gave another result: a file that the run reads has changed"
            )
        return session

    def __repr__(self) -> str:
        return f"Snapshot({self.time:.3f} s)"


class Session:
    """A run that is stepped by its caller, on the thread that began it; `Program.session` creates it.

    It can be used in a `with` statement, at whose end the run ends. An alarm that ends the run is raised as an
    `AlarmError`: by the step in which it occurs, and by every later call that acts on the run; the state can still be
    read.
    """

    def __init__(self, beginning: Beginning) -> None:
        self._beginning, self._program = beginning, beginning.program
        self.columns = self._program.columns
        """The columns of the trace: time in s, line, motion, axes in deg, TCP in mm and deg."""
        self.watched = beginning.watch.names
        """The names of what else is observed."""
        self._names = {name: at for at, name in reversed(list(enumerate((*self.columns, *self.watched))))}
        self._numbers = np.full(len(self.columns) + len(self.watched), np.nan)
        with package_errors:
            self._run = self._program._library.begin([*beginning.words, "--report"], beginning.traced)
            if self.watched:
                self._run.watch(list(beginning.watch.places))
            self._run.observe(self._numbers)
        # Variables get their first values in the first cycle.
        for at, name in enumerate(self.watched):
            if name.startswith("global."):
                self._numbers[len(self.columns) + at] = np.nan
        self.code: int | None = None
        """The exit code, once the run is over: 0 ended, 3 alarm, 4 out of time, 130 stopped."""
        self._closed = False
        self._output = ""
        self._rows: list[NDArray[np.float64]] = []
        self._done: list[Done] = []
        self._known: dict[Done, Done] = {}

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, value: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def step(self, cycles: int = 1, *, alone: bool = False) -> NDArray[np.float64]:
        """Runs this many control cycles, or to the end of the run, and returns what is observed then: a new array
        with the `columns` of the trace, then what is `watched`. Once the run is over, it no longer changes.

        `alone`: nothing is changed from outside any more, so that a program that waits in vain ends the run. Raises
        `AlarmError` if an alarm ends the run or has ended it; `observe` still returns what is observed.
        """
        if cycles < 0:
            raise RefusedError(f"a session cannot step back ({cycles} cycles): use resume() of an earlier snapshot()")
        self._go(self._run.step, cycles, alone, self._numbers)
        if self.code == ALARMED:
            raise self._alarm()
        return self._numbers.copy()

    def observe(self) -> NDArray[np.float64]:
        """Returns what is observed now, as a new array: `columns` of the trace, then what is `watched`."""
        with package_errors:
            self._run.observe(self._numbers)
        return self._numbers.copy()

    def __getitem__(self, name: str) -> float:
        """Returns one of the observed numbers, by the name of its column or of what is watched."""
        at = self._names.get(name)
        if at is None:
            raise KeyError(f"{name!r} is not observed: expected one of {', '.join(self._names)}")
        return float(self._numbers[at])

    @property
    def is_over(self) -> bool:
        """Whether the run has come to an end."""
        return self.code is not None

    @property
    def is_closed(self) -> bool:
        """Whether the session was closed."""
        return self._closed

    @property
    def time(self) -> float:
        """Controller time, s."""
        with package_errors:
            return self._run.time

    @property
    def alarms(self) -> tuple[Alarm, ...]:
        """The alarms so far; an alarm ends only the program of its channel."""
        with package_errors:
            return alarms_of(json.loads(self._run.summary()))

    def order(self, order: str) -> None:
        """Executes an order, as an event of a scenario does: `di.5 = true`, `ai.2 = 4.2`, `pendant = "pause"`,
        `override = 50`."""
        self._do("order", order)

    def set(self, **signals: bool | float) -> None:
        """Sets inputs, by their names in the cell or as `di_5`, `ai_2`. Digital inputs take truth values, 0 and 1."""
        for name, value in signals.items():
            kind, _, channel = name.rpartition("_")
            is_numbered = kind in ("di", "ai", "internal", "internal_do") and channel.isdigit()
            if not is_numbered:
                kind = self._program._kinds.get(name, "").partition(".")[0]
            given = plain(value, name)
            # What is observed is a number.
            if given in (0, 1) and kind in ("di", "internal", "internal_do"):
                given = bool(given)
            self.order(f"{f'{kind}.{channel}' if is_numbered else name} = {json.dumps(given)}")
        self.observe()

    def global_value(self, name: str) -> Any:
        """Returns the value of a global variable: int, float, bool or str; lists for arrays; for structures
        dictionaries of the components that are set (`{"x": 900.0, "y": -500.0}`), which `set_global` and `points`
        accept; a `Literal` for what Python has no value for."""
        literal = self.global_literal(name)
        variable = find(name, self._program.variables)
        return literal if variable is None else variable.value(literal)

    def global_literal(self, name: str) -> str:
        """Returns the value of a global variable as a literal of ARL."""
        self._has_values()
        with package_errors:
            return self._run.global_value(name)

    def set_global(self, name: str, value: Any) -> None:
        """Sets a global variable; components that a dictionary leaves out keep their values."""
        self._has_values()
        with package_errors:
            literal = _arl2rs.literal(json.dumps(plain(value, name)))
        self._do("set_global", name, literal)
        self.observe()

    def state(self) -> dict[str, Any]:
        """Returns the state of everything: channels, axes, TCP, inputs and outputs."""
        with package_errors:
            state: dict[str, Any] = json.loads(self._run.state())["state"]
        return state

    def stop(self) -> None:
        """Ends the programs: the robots stop on their paths within the steps that follow."""
        with package_errors:
            self._run.stop()
        self._note("stop")

    def result(self) -> Result:
        """Returns the result of the run, or its result so far."""
        with package_errors:
            self._output += self._run.take_said()
            names = (*self.columns, *self.watched)
            self._rows.append(np.frombuffer(self._run.take_rows()).reshape(-1, len(names)))
            self._rows = [np.concatenate(self._rows)]
            # Rows are handed out, and kept for the next result.
            rows = self._rows[0].copy() if self._beginning.traced else None
            return of_summary(self._run.summary(), self._output, self._run.report(), rows, names)

    def finish(self) -> Result:
        """Runs to the end without further changes from outside; returns the result, whose `check` raises an alarm."""
        self._go(self._run.go_on, 2**63, True)
        return self.result()

    def snapshot(self) -> Snapshot:
        """Returns the current state of the session, to continue from any number of times: for tree search, or
        learning with branches.

        It holds what was done until now, and `Snapshot.resume` repeats that: `Snapshot` describes the cost. Raises
        `RefusedError` for a run that is not the same every time: in real time, with connections, or with a
        `state_dir`.
        """
        if self._beginning.keeps_state:
            raise RefusedError("no snapshot of a run with a state_dir: it would begin with what it has written there")
        with package_errors:
            is_real = json.loads(self._run.summary())["real_time"]
        if is_real:
            raise RefusedError("no snapshot of a run in real time or with connections: it is not the same twice")
        return Snapshot(self._beginning, tuple(self._done), self.time, self.observe().tobytes())

    def close(self) -> None:
        """Ends the run. A closed session stays closed."""
        with package_errors:
            self._run.close()
        self._closed = True

    def __repr__(self) -> str:
        if self._closed:
            return "Session(closed)"
        try:
            time = f"{self.time:.3f} s"
        except SessionError as problem:
            return f"Session({problem})"
        return f"Session({time}, {'over' if self.is_over else 'runs'})"

    def _has_values(self) -> None:
        if self.time == 0:
            raise RefusedError(
                "global variables get their first values in the first cycle: step first, or give `globals` to the session"
            )

    def _go(self, act: Callable[..., int | None], cycles: int, alone: bool, *more: Any) -> None:
        """Runs cycles. Ctrl-C takes effect between cycles: those before it have been executed."""
        was_over, before = self.is_over, self._run.gone
        try:
            with package_errors:
                self.code = act(cycles, alone, *more)
        except KeyboardInterrupt:
            self._note_cycles(self._run.gone - before, alone)
            raise
        if not was_over:
            self._note_cycles(self._run.gone - before, alone)

    def _alarm(self) -> AlarmError:
        """The exception for the alarm that ended the run."""
        with package_errors:
            ending = ended_by(json.loads(self._run.summary()))
        return AlarmError(self.alarms[-1] if ending is None else ending)

    def _do(self, what: str, *arguments: str) -> None:
        """Acts on a run that is not over."""
        if self.code == ALARMED:
            raise self._alarm()
        if self.code is not None:
            with package_errors:
                outcome = json.loads(self._run.summary())["outcome"]
            raise RefusedError(f"{' = '.join(arguments)}: the run ended at {self.time:.3f} s ({outcome})")
        act: Callable[..., None] = getattr(self._run, what)
        with package_errors:
            act(*arguments)
        self._note(what, *arguments)

    def _note_cycles(self, cycles: int, alone: bool) -> None:
        """Notes cycles; consecutive cycles are one action."""
        what, arguments = self._done[-1] if self._done else ("", ())
        if what == "go_on" and arguments[1] == alone:
            cycles += self._done.pop()[1][0]
        self._note("go_on", cycles, alone)

    def _note(self, what: str, *arguments: Any) -> None:
        """Notes an action. Equal actions share one object: an episode of an agent has many steps."""
        if self._done:
            # The last action may still grow.
            self._done[-1] = self._known.setdefault(self._done[-1], self._done[-1])
        self._done.append((what, arguments))

    def _repeat(self, done: tuple[Done, ...]) -> None:
        for what, arguments in done:
            act: Callable[..., Any] = getattr(self._run, what)
            with package_errors:
                code = act(*arguments)
            self.code = code if what == "go_on" else self.code
        self._done = list(done)
