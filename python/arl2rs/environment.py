"""A run as a gymnasium environment."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any, Unpack

import gymnasium
import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray

from .keywords import EpisodeArguments, named
from .problems import AlarmError, RefusedError, StrPath
from .program import Program
from .session import Session, Snapshot

__all__ = ["ID", "Environment"]

ID = "arl2rs/Program-v0"
"""The ID of the environment in gymnasium: `gymnasium.make("arl2rs.environment:arl2rs/Program-v0", program=.., ..)`."""

Observation = NDArray[np.float64]
Action = Mapping[str, Any] | NDArray[Any]


class Environment(gymnasium.Env[Observation, Any]):
    """A run of a program that an agent controls: it sets inputs and global variables, and observes the run.

    - `program`: a compiled program, or its file.
    - `actions`: what the agent sets, and within which bounds: `{"di.1": bool, "ai.2": (0.0, 10.0),
      "override": (10, 100), "global.speed": (50, 250)}`. The action space is a `Dict` with `Discrete(2)` for truth
      values and a `Box` of one number for the others; with `flat` it is one `Box` of float32 with a number for each
      action, in their order, where a truth value is true from 0.5 on.
    - `observe`: columns of the trace (by default the axes that the robot has, and the TCP) and `watch`: signals, global
      variables and points.
    - `cycles`: the number of control cycles per step.
    - `reward`: the reward of a step, computed from the session after it.
    - `max_time`: after this many seconds of the robot's time an episode is truncated.

    Further arguments are those of `Program.session`. `reset(options={"globals": .., "points": .., "set": ..})` gives an
    episode different ones; the seed of `reset` is that of `rand`. An episode terminates with the run: `info["outcome"]`
    says how, `info["alarms"]` why. After that, as before the first episode, a step raises gymnasium's `ResetNeeded`.
    """

    metadata: dict[str, Any] = {"render_modes": []}  # noqa: RUF012

    @named
    def __init__(
        self,
        program: Program | StrPath,
        *,
        actions: Mapping[str, type[bool] | tuple[float, float]],
        reward: Callable[[Session], float],
        observe: Sequence[str] | None = None,
        watch: Sequence[str] = (),
        cycles: int = 10,
        max_time: float = 60.0,
        flat: bool = False,
        render_mode: None = None,
        **arguments: Unpack[EpisodeArguments],
    ) -> None:
        self.program = program if isinstance(program, Program) else Program(program)
        self.cycles, self.render_mode, self._reward = cycles, render_mode, reward
        self._arguments: dict[str, Any] = {**arguments, "watch": tuple(watch), "max_time": max_time}
        self._session: Session | None = None
        self._is_over = True
        self._before: dict[str, bool | float] = {}
        self._actions = tuple(actions)
        self._truths = {name for name, bounds in actions.items() if bounds is bool}
        self.action_space: spaces.Space[Any] = (
            _box(actions) if flat else spaces.Dict({name: _space(bounds) for name, bounds in actions.items()})
        )
        with self.program.session(**self._arguments) as session:
            session.step(1)
            for name, bounds in actions.items():
                self._set(session, name, False if bounds is bool else float(bounds[0]))
            there = [name for name in session.columns[3:] if not np.isnan(session[name])]
            all_names = [*session.columns, *session.watched]
            unknown = [name for name in (observe or ()) if name not in all_names]
            if unknown or observe == []:
                raise RefusedError(
                    f"observe: expected some of {', '.join(all_names)}, found {unknown[0] if unknown else 'nothing'}"
                )
            self.observed = [*(there if observe is None else observe), *session.watched]
            self._at = np.array([all_names.index(name) for name in self.observed])
        self.observation_space = spaces.Box(-np.inf, np.inf, (len(self.observed),), np.float64)

    @property
    def session(self) -> Session:
        """The run of this episode."""
        if self._session is None:
            raise gymnasium.error.ResetNeeded("an episode begins with reset()")
        return self._session

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observation, dict[str, Any]]:
        """Begins an episode."""
        super().reset(seed=seed)
        self.close()
        arguments = dict(self._arguments)
        for name, value in (options or {}).items():
            before = arguments.get(name)
            arguments[name] = {**before, **value} if isinstance(before, dict) and isinstance(value, dict) else value
        if seed is not None:
            arguments["seed"] = seed
        self._session, self._is_over, self._before = self.program.session(**arguments), False, {}
        # Variables get their first values in the first cycle.
        return self._observation(_stepped(self._session, 1)), {}

    def step(self, action: Action) -> tuple[Observation, float, bool, bool, dict[str, Any]]:
        """Sets the values of the action, and runs `cycles` control cycles."""
        session = self.session
        if self._is_over:
            raise gymnasium.error.ResetNeeded("the episode is over: the next one begins with reset()")
        # If an alarm in the first cycle ended the run, there is nothing left to set.
        for name, value in () if session.is_over else self._chosen(action).items():
            # A program may change its variables between steps; what it cannot change is set only if the action changed.
            if name.startswith("global.") or self._before.get(name) != value:
                self._before[name] = value
                self._set(session, name, value)
        observation = self._observation(_stepped(session, self.cycles))
        reward, info, late = float(self._reward(session)), {}, False
        if session.is_over:
            result = session.result()
            info = {"outcome": result.outcome, "cycle_time": result.cycle_time, "alarms": result.alarms}
            late = result.outcome == "time_over"
            self._is_over = True
        return observation, reward, session.is_over and not late, late, info

    def close(self) -> None:
        """Ends the episode."""
        if self._session is not None:
            self._session.close()
            self._session, self._is_over = None, True

    def snapshot(self) -> Snapshot:
        """The current state of the episode: see `Session.snapshot`."""
        return self.session.snapshot()

    def restore(self, snapshot: Snapshot) -> Observation:
        """Continues from a snapshot of an episode of this or a similar environment; returns the observation there."""
        session = snapshot.resume()
        self.close()
        self._session, self._is_over, self._before = session, session.is_over, {}
        return self._observation(session.observe())

    def _chosen(self, action: Action) -> dict[str, bool | float]:
        """The values that the agent sets, by name."""
        if not isinstance(action, Mapping):
            numbers = np.ravel(action)
            if len(numbers) != len(self._actions):
                raise RefusedError(
                    f"an action has {len(self._actions)} numbers, not {len(numbers)}: {', '.join(self._actions)}"
                )
            return {
                name: bool(it >= 0.5) if name in self._truths else float(it)
                for name, it in zip(self._actions, numbers, strict=True)
            }
        return {
            name: bool(given) if name in self._truths else float(np.ravel(given)[0]) for name, given in action.items()
        }

    def _set(self, session: Session, name: str, value: bool | float) -> None:
        if name.startswith("global."):
            session.set_global(name.removeprefix("global."), value)
        else:
            session.order(f"{name} = {str(value).lower()}")

    def _observation(self, numbers: Observation) -> Observation:
        return np.asarray(numbers[self._at])


def _stepped(session: Session, cycles: int) -> Observation:
    """The observation after this many cycles. An alarm ends the episode; it is not raised as an error to the agent."""
    try:
        return session.step(cycles)
    except AlarmError:
        return session.observe()


def _space(bounds: type[bool] | tuple[float, float]) -> spaces.Space[Any]:
    if bounds is bool:
        return spaces.Discrete(2)
    low, high = bounds
    return spaces.Box(low, high, (1,), np.float64)


def _box(actions: Mapping[str, type[bool] | tuple[float, float]]) -> spaces.Box:
    bounds = np.array([(0, 1) if bound is bool else bound for bound in actions.values()], dtype=np.float32).reshape(
        -1, 2
    )
    return spaces.Box(bounds[:, 0], bounds[:, 1], dtype=np.float32)


if ID not in gymnasium.registry:
    gymnasium.register(ID, entry_point="arl2rs.environment:Environment")
