"""Sweeps on several machines, with Ray: `arl2rs.sweep(.., engine="ray")`.

The compiled program and the files that it reads are sent as one Ray object; each task executes some runs. The runs of a
node that dies, or of a task that never ends, are repeated elsewhere: a run depends on its parameters only, so this
changes nothing, and one result of each run counts. The nodes have the same operating system and processor as this
computer.
"""

from __future__ import annotations

import json
import time
import warnings
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import Any

import ray

from . import _arl2rs
from .problems import ArlError

__all__ = ["run"]

BATCH_S = 2.0
"""How long a task should take, s."""
GRACE_S = 60.0
"""How much longer than a run a task may take, s."""
TRIES = 3
"""How often a run is tried if its process or its node is lost."""

Words = list[str]
How = tuple[float | None, float | None]
"""The seconds after which a run is given up, and the clearance if collisions are looked for."""
_workers: dict[tuple[str, How], _arl2rs.Worker] = {}


class _OtherVersionError(Exception):
    """A node has another version of the package, which may find other collisions."""


def _make(
    version: str, key: str, files: list[tuple[str, bytes]], how: How, runs: list[tuple[int, Words]]
) -> list[tuple[int, str, bool]]:
    """Executes runs on a node. Its process keeps the worker, which ends runs that take too long, for the next task."""
    if version != _arl2rs.VERSION:
        raise _OtherVersionError(f"it has version {_arl2rs.VERSION}, the sweep {version}")
    if (key, how) not in _workers:
        _workers.clear()
        _workers[key, how] = _arl2rs.Worker(files, *how)
    return [(at, *_workers[key, how].run(words)) for at, words in runs]


@dataclass
class _Farm:
    """The state of a sweep: the runs that wait, the tasks under way, and the results."""

    bundle: _arl2rs.Bundle
    timeout: float | None
    waiting: list[tuple[int, Words]]
    kept: _arl2rs.Kept | None
    results: dict[int, str] = field(default_factory=dict)
    tries: dict[int, int] = field(default_factory=dict)
    tasks: dict[Any, list[tuple[int, Words]]] = field(default_factory=dict)
    begun: dict[Any, float] = field(default_factory=dict)
    batch: int = 1

    def __post_init__(self) -> None:
        self._files = ray.put(self.bundle.files)
        # Ray itself restarts a task whose node has died.
        self._remote = ray.remote(num_cpus=1, max_retries=-1)(_make)
        self._key = self.bundle.key

    def begin(self) -> None:
        """Starts tasks, twice as many as there are cores, so that no core waits."""
        most = 2 * _cores()
        while self.waiting and len(self.tasks) < most:
            runs, self.waiting = self.waiting[: self.batch], self.waiting[self.batch :]
            task = self._remote.remote(
                _arl2rs.VERSION, self._key, self._files, (self.timeout, self.bundle.clearance), runs
            )
            self.tasks[task], self.begun[task] = runs, time.monotonic()

    def wait(self) -> None:
        """Collects finished tasks. A task that takes too long may be waiting for a core that others use, or be on a
        frozen node: its runs are started again, one by one, and this does not count as a try."""
        done, _ = ray.wait(list(self.tasks), num_returns=1, timeout=1.0)
        for task in done:
            self.begun.pop(task)
            self._take(task, self.tasks.pop(task))
        allowed = (self.timeout or _arl2rs.TIMEOUT) + 10 * BATCH_S + GRACE_S
        for task, began in list(self.begun.items()):
            if time.monotonic() - began > allowed:
                self.batch = 1
                self.waiting += self.tasks.pop(task)
                self._cancel(task)

    def end(self) -> None:
        """Cancels the tasks under way."""
        for task in list(self.tasks):
            self._cancel(task)

    def _cancel(self, task: Any) -> None:
        self.begun.pop(task, None)
        self.tasks.pop(task, None)
        ray.cancel(task, force=True)

    def _take(self, task: Any, runs: list[tuple[int, Words]]) -> None:
        try:
            came = ray.get(task)
        except ray.exceptions.RayError as problem:
            _refuse_nodes_without_the_package(problem)
            # A single run may have killed its node: from now on each run has its own task.
            self.batch = 1
            for at, words in runs:
                if self._counts(at):
                    self.waiting.append((at, words))
                else:
                    why = str(getattr(problem, "cause", None) or problem).strip().splitlines()
                    self.results.setdefault(at, _arl2rs.lost("crashed", why[-1] if why else type(problem).__name__))
            return
        for (at, words), (_, result, again) in zip(runs, came, strict=True):
            if json.loads(result)["outcome"] == "crashed" and self._counts(at):
                self.waiting.append((at, words))
                continue
            if at not in self.results and again and self.kept is not None:
                self._keep(self.kept, words, result)
            self.results.setdefault(at, result)

    def _counts(self, at: int) -> bool:
        self.tries[at] = self.tries.get(at, 0) + 1
        return self.tries[at] < TRIES

    def _keep(self, kept: _arl2rs.Kept, words: Words, result: str) -> None:
        try:
            kept.keep(words, result)
        except OSError as problem:
            self.kept = None
            _not_kept(problem)


def _refuse_nodes_without_the_package(problem: ray.exceptions.RayError) -> None:
    """A node that lacks the package, or has another version of it, would quickly lose every run that it is given."""
    cause = getattr(problem, "cause", None)
    is_import = isinstance(cause, ImportError) or str(cause).startswith("The remote function failed to import")
    if is_import or isinstance(cause, _OtherVersionError):
        why = str(cause).strip().splitlines()[-1]
        raise ArlError(
            f"a node does not have this arl2rs: install the same version on all nodes of the cluster ({why})"
        ) from problem


def _not_kept(problem: Exception) -> None:
    warnings.warn(f"results cannot be kept for the next sweep: {problem}", stacklevel=4)


def run(
    bundle: _arl2rs.Bundle, rows: list[str], *, timeout: float | None, cache: bool, came: Callable[[int], None]
) -> Iterator[str]:
    """Executes the runs of a bundle on the cluster that Ray is connected to, or on this computer.

    Returns their rows as JSON, in order. `came` is called with the number of finished runs.
    """
    kept = None
    try:
        kept = _arl2rs.Kept(bundle) if cache else None
    except _arl2rs.Failed as problem:
        _not_kept(problem)
    results: dict[int, str] = {}
    waiting: list[tuple[int, Words]] = []
    for at, row in enumerate(rows):
        try:
            words = bundle.words(row)
        except _arl2rs.Refused as problem:
            results[at] = _arl2rs.lost("refused", problem.args[0])
            continue
        known = kept.find(words) if kept else None
        if known is None:
            waiting.append((at, words))
        else:
            results[at] = known
    if waiting:
        _make_all(bundle, timeout, waiting, kept, results, came)
    came(len(results))
    return (bundle.row(at + 1, row, results[at]) for at, row in enumerate(rows))


def _make_all(
    bundle: _arl2rs.Bundle,
    timeout: float | None,
    waiting: list[tuple[int, Words]],
    kept: _arl2rs.Kept | None,
    results: dict[int, str],
    came: Callable[[int], None],
) -> None:
    if not ray.is_initialized():
        ray.init(log_to_driver=False)
    farm = _Farm(bundle, timeout, waiting, kept, results)
    began, before = time.monotonic(), len(results)
    try:
        while farm.waiting or farm.tasks:
            farm.begin()
            farm.wait()
            came(len(results))
            farm.batch = _batch(farm, (len(results) - before) / max(time.monotonic() - began, 1e-3))
    finally:
        farm.end()


def _cores() -> int:
    return max(1, int(ray.cluster_resources().get("CPU", 1)))  # type: ignore[no-untyped-call]


def _batch(farm: _Farm, rate: float) -> int:
    """How many runs a task should execute, given the runs finished per second; few towards the end, so that all cores
    finish together."""
    if any(farm.tries.values()):
        return 1
    cores = _cores()
    return max(1, min(int(rate / cores * BATCH_S), len(farm.waiting) // (2 * cores)))
