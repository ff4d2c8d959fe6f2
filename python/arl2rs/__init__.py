"""Robot programs in ARL: checked, compiled to native code, run a thousand times, stepped.

>>> import arl2rs
>>> from pathlib import Path
>>> _ = Path("hello.arl").write_text('int parts = 3\\nfunc void main()\\n    print parts, " parts"\\nendfunc\\n')
>>> program = arl2rs.compile("hello.arl")
>>> program.run(globals={"parts": 5}).output
'5 parts\\n'
"""

from importlib.metadata import version as _version

from .problems import AlarmError, ArlError, CompileError, Diagnostic, RefusedError, SessionError, UnfinishedError
from .program import Program, check, compile, run
from .result import Alarm, Message, Result
from .session import Session
from .sweeps import Results, grid, load_sweep, sweep
from .trace import Trace
from .values import Literal

__all__ = [
    "Alarm",
    "AlarmError",
    "ArlError",
    "CompileError",
    "Diagnostic",
    "Literal",
    "Message",
    "Program",
    "RefusedError",
    "Result",
    "Results",
    "Session",
    "SessionError",
    "Trace",
    "UnfinishedError",
    "check",
    "compile",
    "grid",
    "load_sweep",
    "run",
    "sweep",
]


__version__ = _version("arl2rs")


def __dir__() -> list[str]:
    return [*__all__, "Environment"]


def __getattr__(name: str) -> object:
    # gymnasium is imported only where somebody wants it.
    if name == "Environment":
        from .environment import Environment

        return Environment
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
