"""The result of a run."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from .choices import Outcome
from .problems import AlarmError, RefusedError, UnfinishedError
from .trace import Trace

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = ["Alarm", "Message", "Result"]


@dataclass(frozen=True)
class Alarm:
    """An alarm of a run."""

    number: int
    """The number for `arl2rs explain`."""
    text: str
    file: str
    line: int
    """From 1; 0 where no line is to blame."""
    channel: str

    def __str__(self) -> str:
        return self.text


@dataclass(frozen=True)
class Message:
    """A message that a program printed."""

    time: float
    """Controller time, s."""
    channel: str
    hmi: bool
    """Whether it goes to the operator panel."""
    console: bool
    """Whether it goes to the terminal."""
    text: str


@dataclass(frozen=True)
class Result:
    """The result of a run."""

    outcome: Outcome
    """`ended`, `alarm`, `time_over`, `stuck` (nothing could change any more), `stopped`; `runs` while not over."""
    code: int | None
    """The exit code of `arl2rs run`: 0 ended, 3 alarm, 4 out of time, 130 stopped."""
    cycle_time: float | None
    """How long the run took in the robot's time, s."""
    moving: float | None = None
    """How long the first robot moved, s."""
    standing: float | None = None
    """How long it stood still, s."""
    motions: int | None = None
    """How many motions it executed."""
    way: float | None = None
    """The distance that its TCP moved, mm."""
    alarms: tuple[Alarm, ...] = ()
    """All alarms, including those of channels that ended before the run did, and those that were cleared."""
    ended_by: Alarm | None = None
    """The alarm that ended the run: that of the first channel that was ended by an alarm."""
    messages: tuple[Message, ...] = field(default=(), repr=False)
    warnings: tuple[str, ...] = ()
    report: tuple[Mapping[str, Any], ...] = field(default=(), repr=False)
    """One row per motion, as `arl2rs run --report=FILE` writes it: with channel, motion, file, line, start,
    duration."""
    totals: tuple[Mapping[str, Any], ...] = field(default=(), repr=False)
    """The totals of each channel's motions: channel, cycle_time, moving, standing, motions."""
    trace: Trace | None = field(default=None, repr=False, compare=False)

    @property
    def ended(self) -> bool:
        """Whether the program reached its end."""
        return self.outcome == "ended"

    @property
    def output(self) -> str:
        """What the program printed for the operator panel or the terminal, one line per message."""
        lines = [message.text for message in self.messages if message.hmi or message.console]
        return "".join(line if line.endswith("\n") else line + "\n" for line in lines)

    def check(self) -> Result:
        """Returns the result itself if the program reached its end.

        Raises `AlarmError` with file and line if an alarm ended the run, `UnfinishedError` if it did not end.
        """
        if self.ended_by is not None:
            raise AlarmError(self.ended_by)
        if not self.ended:
            raise UnfinishedError("; ".join(self.warnings) or f"the run did not reach its end: {self.outcome}")
        return self

    def plot(self) -> Figure:
        """Plots the motion: the path of the TCP, its speed, the axes. Needs matplotlib."""
        from .plots import plot

        if self.trace is None:
            raise RefusedError("the run has no trace: run it with trace=True")
        return plot(self.trace)


def alarms_of(figures: Mapping[str, Any]) -> tuple[Alarm, ...]:
    """The alarms of a summary."""
    return tuple(Alarm(**alarm) for alarm in figures["alarms"])


def ended_by(figures: Mapping[str, Any]) -> Alarm | None:
    """The alarm that ended the run of a summary."""
    alarm = figures["ended_by"]
    return None if alarm is None else Alarm(**alarm)


def of_summary(
    summary: str, output: str, report: str = "", rows: NDArray[np.float64] | None = None, columns: tuple[str, ...] = ()
) -> Result:
    """Makes the result from what the Rust side reports; `rows` are those of the trace."""
    figures = json.loads(summary)
    figures.pop("real_time", None)
    alarms, ending = alarms_of(figures), ended_by(figures)
    del figures["alarms"], figures["ended_by"]
    lines = [json.loads(line) for line in output.split("\n") if line]
    reports = [json.loads(line) for line in report.split("\n") if line]
    motions = tuple(row for row in reports if "motion" in row)
    # The trace is that of the first robot.
    files = {row["motion"]: row["file"] for row in motions if row["channel"] == 1 and "file" in row}
    return Result(
        **figures,
        alarms=alarms,
        ended_by=ending,
        messages=tuple(Message(**line["message"]) for line in lines if "message" in line),
        warnings=tuple(line["warning"] for line in lines if "warning" in line),
        report=motions,
        totals=tuple(row for row in reports if "motion" not in row),
        trace=None if rows is None else Trace(rows, columns, files),
    )
