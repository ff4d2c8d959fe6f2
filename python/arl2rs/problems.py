"""Exceptions and diagnostics, with file and line if there is one."""

from __future__ import annotations

import difflib
import json
import os
from dataclasses import dataclass, replace
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING

from . import _arl2rs
from .choices import Severity

if TYPE_CHECKING:
    from .result import Alarm

__all__ = ["AlarmError", "ArlError", "CompileError", "Diagnostic", "RefusedError", "SessionError", "UnfinishedError"]


StrPath = str | os.PathLike[str]


@dataclass(frozen=True)
class Diagnostic:
    """A report of the checker about a place in a program."""

    code: str
    """The code for `arl2rs explain`: `ARL0203`."""
    severity: Severity
    """`error` or `warning`."""
    message: str
    file: str
    line: int
    """From 1."""
    column: int
    """From 1, in characters."""
    end_line: int
    end_column: int
    help: str | None = None
    """What would be right."""

    @classmethod
    def of_json(cls, text: str) -> Diagnostic:
        """Creates a diagnostic from the object that `arl2rs check --format json` writes."""
        return cls(**{name: value for name, value in json.loads(text).items() if name in cls.__dataclass_fields__})

    def below(self, folder: Path) -> Diagnostic:
        """Returns the same diagnostic, with its file relative to this folder if it lies below."""
        path, folder = Path(os.path.abspath(self.file)), Path(os.path.abspath(folder))
        return replace(self, file=path.relative_to(folder).as_posix()) if path.is_relative_to(folder) else self

    @property
    def is_error(self) -> bool:
        """Whether the program is refused because of it."""
        return self.severity == "error"

    def __str__(self) -> str:
        text = f"{self.file}:{self.line}:{self.column}: {self.severity}[{self.code}]: {self.message}"
        return f"{text}\n  help: {self.help}" if self.help else text


class ArlError(Exception):
    """The base of all exceptions of this package."""


class CompileError(ArlError):
    """A program has mistakes: `diagnostics` lists them."""

    def __init__(self, diagnostics: list[Diagnostic]) -> None:
        self.diagnostics = diagnostics
        errors = [diagnostic for diagnostic in diagnostics if diagnostic.is_error]
        super().__init__("\n".join(str(diagnostic) for diagnostic in errors))
        self.file = errors[0].file if errors else None
        self.line = errors[0].line if errors else None

    def __reduce__(self) -> tuple[type[CompileError], tuple[list[Diagnostic]]]:
        return type(self), (self.diagnostics,)


class RefusedError(ArlError, ValueError):
    """The request is not possible: an unknown variable, a value that does not fit, a missing file."""


class AlarmError(ArlError):
    """A run ended with an alarm: `number`, `text`, `file`, `line` and `channel` are those of the alarm."""

    def __init__(self, alarm: Alarm) -> None:
        self.alarm = alarm
        super().__init__(alarm.text)
        self.number, self.text, self.channel = alarm.number, alarm.text, alarm.channel
        self.file, self.line = alarm.file, alarm.line

    def __reduce__(self) -> tuple[type[AlarmError], tuple[Alarm]]:
        return type(self), (self.alarm,)


class UnfinishedError(ArlError):
    """A run did not reach its end, and no alarm ended it: it ran out of time, waited in vain, or was stopped."""


class SessionError(ArlError, RuntimeError):
    """A session is closed, is on another thread, or has crashed."""


class _PackageErrors:
    """Converts the exceptions of the Rust side into those of the package."""

    def __enter__(self) -> None:
        pass

    def __exit__(
        self, kind: type[BaseException] | None, problem: BaseException | None, trace: TracebackType | None
    ) -> None:
        match problem:
            case _arl2rs.Mistakes():
                raise CompileError([Diagnostic.of_json(text) for text in problem.args[0]]) from None
            case _arl2rs.Refused():
                raise RefusedError(problem.args[0]) from None
            case _arl2rs.Gone():
                raise SessionError(problem.args[0]) from None
            case _arl2rs.Failed():
                raise ArlError(problem.args[0]) from None


package_errors = _PackageErrors()
"""Within this block exceptions are those of the package. All share one: a step of a session takes microseconds."""


def there(path: StrPath, what: str) -> Path:
    """Returns the path of an existing file.

    Raises `RefusedError` if there is no such file, with the name of the file that is probably meant.
    """
    path = Path(path)
    if path.is_file():
        return path
    if path.is_dir():
        raise RefusedError(f"{path} is a folder: expected {what}")
    files = sorted(path.parent.iterdir()) if path.parent.is_dir() else []
    # A name without an extension is close to all names that have one.
    beside = [file.name for file in files if not path.suffix or file.suffix == path.suffix]
    near = difflib.get_close_matches(path.name, beside, 1)
    meant = f"; did you mean {path.parent / near[0]}?" if near else ""
    raise RefusedError(f"there is no file {path}: expected {what}{meant}")
