"""A run that is stepped."""

from __future__ import annotations

import json
from types import TracebackType
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from . import _arl2rs
from .problems import RefusedError, told
from .result import Result, of_summary
from .trace import Trace
from .values import plain

__all__ = ["Session"]


class Session:
    """A run that goes on as far as it is told, on the thread that began it: `Program.session` makes it.

    It may be used in a `with` statement; at its end the run ends.
    """

    def __init__(self, run: _arl2rs.Session, columns: tuple[str, ...], watched: tuple[str, ...], traced: bool) -> None:
        self._run, self.columns, self.watched, self._traced = run, columns, watched, traced
        self._numbers = np.full(len(columns) + len(watched), np.nan)
        if watched:
            run.watch(list(watched))
        run.observe(self._numbers)
        # Variables have their first values in the first cycle.
        for at, name in enumerate(watched):
            if name.startswith("global."):
                self._numbers[len(columns) + at] = np.nan
        self.code: int | None = None
        """The exit code, once the run is over."""
        self._said = ""
        self._rows: list[NDArray[np.float64]] = []

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: type[BaseException] | None, value: BaseException | None, trace: TracebackType | None) -> None:
        self.close()

    def step(self, cycles: int = 1, *, alone: bool = False) -> NDArray[np.float64]:
        """Goes on for so many control cycles, or to the end of the run; gives what is observed then.

        The array is that of the last call: `columns` of the trace (time in s, line, motion, axes in deg, TCP in mm and deg), then what is
        `watched`. `alone`: nobody changes anything any more, so that a program that waits in vain ends the run.
        """
        if cycles < 0:
            raise RefusedError(f"a session does not step back: {cycles} cycles")
        with told:
            self.code = self._run.step(cycles, alone, self._numbers)
        return self._numbers

    def observe(self) -> NDArray[np.float64]:
        """What `step` gave last, as it is now."""
        with told:
            self._run.observe(self._numbers)
        return self._numbers

    def __getitem__(self, name: str) -> float:
        """One of the numbers that are observed, by the name of its column or of what is watched."""
        names = (*self.columns, *self.watched)
        if name not in names:
            raise KeyError(f"{name!r} is not observed: {', '.join(names)} are")
        return float(self._numbers[names.index(name)])

    @property
    def is_over(self) -> bool:
        """Whether the run has come to an end."""
        return self.code is not None

    @property
    def time(self) -> float:
        """Controller time, s."""
        with told:
            return self._run.time

    def order(self, order: str) -> None:
        """Does what an event of a scenario does: `di.5 = true`, `ai.2 = 4.2`, `pendant = "pause"`, `override = 50`."""
        with told:
            self._run.order(order)

    def set(self, **signals: bool | float) -> None:
        """Sets inputs, by what the cell calls them or as `di_5`, `ai_2`. Digital ones take truth values, 0 and 1."""
        for name, value in signals.items():
            kind, _, channel = name.partition("_")
            is_numbered = kind in ("di", "ai", "internal") and channel.isdigit()
            given = plain(value, name)
            # What is observed is a number.
            if given in (0, 1) and is_numbered and kind != "ai":
                given = bool(given)
            self.order(f"{f'{kind}.{channel}' if is_numbered else name} = {json.dumps(given)}")
        self.observe()

    def global_value(self, name: str) -> str:
        """The value of a global variable, as a literal of ARL."""
        self._has_values()
        with told:
            return self._run.global_value(name)

    def set_global(self, name: str, value: Any) -> None:
        """Gives a global variable a value; components that a dictionary leaves out keep theirs."""
        self._has_values()
        with told:
            self._run.set_global(name, _arl2rs.literal(json.dumps(plain(value, name))))
        self.observe()

    def _has_values(self) -> None:
        if self.time == 0:
            raise RefusedError("global variables get their first values in the first cycle: step first, or give `globals` to the session")

    def state(self) -> dict[str, Any]:
        """How everything stands: channels, axes, TCP, inputs and outputs."""
        with told:
            state: dict[str, Any] = json.loads(self._run.state())["state"]
        return state

    def stop(self) -> None:
        """Ends the programs: the robots stop on their paths within the steps that follow."""
        with told:
            self._run.stop()

    def result(self) -> Result:
        """What came of the run, or how far it is."""
        with told:
            self._said += self._run.take_said()
            self._rows.append(np.frombuffer(self._run.take_rows()).reshape(-1, len(self.columns)))
            if len(self._rows) > 1:
                self._rows = [np.concatenate(self._rows)]
            trace = Trace(self._rows[0], self.columns) if self._traced else None
            return of_summary(self._run.summary(), self._said, self._run.report(), trace)

    def finish(self) -> Result:
        """Goes on to the end of the run, where nobody changes anything any more; gives what came of it."""
        with told:
            self.code = self._run.go_on(2**63, True)
        return self.result()

    def close(self) -> None:
        """Ends the run."""
        with told:
            self._run.close()

    def __repr__(self) -> str:
        return f"Session({self.time:.3f} s, {'over' if self.is_over else 'runs'})"
