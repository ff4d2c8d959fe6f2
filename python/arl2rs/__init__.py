"""Checks robot programs in ARL, runs them many times, and steps them.

>>> import arl2rs
>>> program = arl2rs.compile(source='int parts = 3\\nfunc void main()\\n    print parts, " parts"\\nendfunc\\n')
>>> program.run(globals={"parts": 5}).output
'5 parts\\n'
"""

from importlib.metadata import version as _version
from typing import TYPE_CHECKING

from .points import points
from .problems import AlarmError, ArlError, CompileError, Diagnostic, RefusedError, SessionError, UnfinishedError
from .program import Program, check, compile, run
from .result import Alarm, Message, Result
from .robot import Axis, Robot, robots
from .session import Session, Snapshot
from .sweeps import Results, grid, load_sweep, sweep
from .trace import Trace
from .values import Literal
from .variables import Signal, Variable

if TYPE_CHECKING:
    from .environment import Environment as Environment

__all__ = [
    "Alarm",
    "AlarmError",
    "ArlError",
    "Axis",
    "CompileError",
    "Diagnostic",
    "Literal",
    "Message",
    "Program",
    "RefusedError",
    "Result",
    "Results",
    "Robot",
    "Session",
    "SessionError",
    "Signal",
    "Snapshot",
    "Trace",
    "UnfinishedError",
    "Variable",
    "check",
    "compile",
    "grid",
    "load_sweep",
    "points",
    "robots",
    "run",
    "sweep",
]


__version__ = _version("arl2rs")


def __dir__() -> list[str]:
    return [*__all__, "Environment"]


def __getattr__(name: str) -> object:
    # gymnasium is imported only when it is needed.
    if name == "Environment":
        from .environment import Environment

        return Environment
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
