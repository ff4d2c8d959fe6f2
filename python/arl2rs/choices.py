"""Words to choose from: type checkers find typos in them."""

from typing import Literal

__all__ = ["Engine", "Family", "Figure", "Mode", "Outcome", "PointType", "Severity"]

Engine = Literal["local", "ray"]
"""Where the runs of a sweep are executed."""
Family = Literal["six-axis", "scara"]
"""The kinematic type of a robot."""
Figure = Literal["cycle_time", "moving", "standing", "motions", "way"]
"""A figure that each run of a sweep has; `way` is the distance that the TCP moved."""
Mode = Literal["auto", "manual", "manufast"]
"""The operating mode."""
Outcome = Literal["ended", "alarm", "time_over", "stuck", "stopped", "runs", "refused", "crashed", "hung"]
"""How a run ended; `runs`: the run is not over."""
PointType = Literal["pose", "joint"]
"""The types of targets."""
Severity = Literal["error", "warning"]
"""The severity of a diagnostic."""
