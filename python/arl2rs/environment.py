"""A run as an environment of gymnasium."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import gymnasium
import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray

from .problems import RefusedError
from .program import Program
from .session import Session

__all__ = ["Environment"]

Observation = NDArray[np.float64]
Action = Mapping[str, Any]


class Environment(gymnasium.Env[Observation, Action]):
    """A run of a program that an agent takes part in: it gives inputs and global variables, and observes.

    - `actions`: what the agent sets, and within which bounds: `{"di.1": bool, "ai.2": (0.0, 10.0), "override": (10, 100), "global.speed": (50,
      250)}`. The action space has `Discrete(2)` for truth values and a `Box` of one number for the others.
    - `observe`: columns of the trace (without it the axes that the robot has, and the TCP) and `watch`: signals and global variables.
    - `cycles`: how many control cycles a step takes.
    - `reward`: what a step is worth, of the session after it.
    - `max_time`: after so many seconds of the robot's time an episode is truncated.

    Further arguments are those of `Program.session`. `reset(options={"globals": .., "points": .., "set": ..})` gives an episode other ones, its
    seed is that of `rand`. An episode terminates with the run: `info["outcome"]` says how, `info["alarms"]` why.
    """

    metadata: dict[str, Any] = {"render_modes": []}  # noqa: RUF012

    def __init__(
        self,
        program: Program,
        *,
        actions: Mapping[str, type[bool] | tuple[float, float]],
        reward: Callable[[Session], float],
        observe: Sequence[str] | None = None,
        watch: Sequence[str] = (),
        cycles: int = 10,
        max_time: float = 60.0,
        **arguments: Any,
    ) -> None:
        self.program, self.cycles, self._reward = program, cycles, reward
        self._arguments = {**arguments, "watch": watch, "max_time": max_time}
        self._session: Session | None = None
        self._before: dict[str, bool | float] = {}
        names: dict[str, spaces.Space[Any]] = {name: _space(bounds) for name, bounds in actions.items()}
        self._truths = {name for name, bounds in actions.items() if bounds is bool}
        self.action_space = spaces.Dict(names)
        with program.session(**self._arguments) as session:
            session.step(1)
            for name, bounds in actions.items():
                self._set(session, name, False if bounds is bool else float(bounds[0]))
            there = [name for name in session.columns[3:] if not np.isnan(session[name])]
            all_names = [*session.columns, *watch]
            unknown = [name for name in (observe or ()) if name not in all_names]
            if unknown or observe == []:
                raise RefusedError(f"observe: {unknown[0] if unknown else 'nothing'} is not there: {', '.join(all_names)} are")
            self.observed = [*(there if observe is None else observe), *watch]
            self._at = np.array([all_names.index(name) for name in self.observed])
        self.observation_space = spaces.Box(-np.inf, np.inf, (len(self.observed),), np.float64)

    @property
    def session(self) -> Session:
        """The run of this episode."""
        if self._session is None:
            raise gymnasium.error.ResetNeeded("an episode begins with reset()")
        return self._session

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Observation, dict[str, Any]]:
        """Begins an episode."""
        super().reset(seed=seed)
        self.close()
        arguments = dict(self._arguments)
        for name, value in (options or {}).items():
            before = arguments.get(name)
            arguments[name] = {**before, **value} if isinstance(before, dict) and isinstance(value, dict) else value
        if seed is not None:
            arguments["seed"] = seed
        self._session = self.program.session(**arguments)
        self._before = {}
        # Variables have their first values from the first cycle on.
        return self._observation(self._session.step(1)), {}

    def step(self, action: Action) -> tuple[Observation, float, bool, bool, dict[str, Any]]:
        """Sets what the action says, and goes on for some control cycles."""
        session = self.session
        for name, given in action.items():
            value = bool(given) if name in self._truths else float(np.ravel(given)[0])
            # A program may change its variables meanwhile; what it cannot change is told once.
            if name.startswith("global.") or self._before.get(name) != value:
                self._before[name] = value
                self._set(session, name, value)
        observation = self._observation(session.step(self.cycles))
        reward, info, late = float(self._reward(session)), {}, False
        if session.is_over:
            result = session.result()
            info = {"outcome": result.outcome, "cycle_time": result.cycle_time, "alarms": result.alarms}
            late = result.outcome == "time_over"
        return observation, reward, session.is_over and not late, late, info

    def close(self) -> None:
        """Ends the episode."""
        if self._session is not None:
            self._session.close()
            self._session = None

    def _set(self, session: Session, name: str, value: bool | float) -> None:
        if name.startswith("global."):
            session.set_global(name.removeprefix("global."), value)
        else:
            session.order(f"{name} = {str(value).lower()}")

    def _observation(self, numbers: Observation) -> Observation:
        return np.asarray(numbers[self._at])


def _space(bounds: type[bool] | tuple[float, float]) -> spaces.Space[Any]:
    if bounds is bool:
        return spaces.Discrete(2)
    low, high = bounds
    return spaces.Box(low, high, (1,), np.float64)
