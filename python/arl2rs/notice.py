"""Messages about long operations where no progress bar is visible."""

from __future__ import annotations

import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager

__all__ = ["notice", "say"]

PATIENCE_S = 2.0
"""Operations that take less time give no message, s."""


def say(text: str) -> None:
    """Writes a message to standard error, if there is one."""
    if sys.stderr is not None:
        print(f"arl2rs: {text}", file=sys.stderr, flush=True)


@contextmanager
def notice(text: str) -> Iterator[None]:
    """Writes this message if the block takes longer than `PATIENCE_S`. On a terminal the command has its own
    spinner."""
    if sys.stderr is None or sys.stderr.isatty():
        yield
        return
    timer = threading.Timer(PATIENCE_S, say, [text])
    timer.daemon = True
    timer.start()
    try:
        yield
    finally:
        timer.cancel()
