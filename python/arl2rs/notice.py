"""What takes long says so where nobody sees a bar."""

from __future__ import annotations

import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager

__all__ = ["notice", "say"]

PATIENCE_S = 2.0
"""What is done sooner says nothing; s."""


def say(text: str) -> None:
    """Says it on the standard error, where that is there."""
    if sys.stderr is not None:
        print(f"arl2rs: {text}", file=sys.stderr, flush=True)


@contextmanager
def notice(text: str) -> Iterator[None]:
    """Says this after some seconds within it. On a terminal the command's own sign turns."""
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
