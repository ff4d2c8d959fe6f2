"""Words to choose from: type checkers find typos in them."""

from typing import Literal

__all__ = ["Engine", "Family", "Figure", "Mode", "Outcome", "PointType", "Severity"]

Engine = Literal["local", "ray"]
"""Where the runs of a sweep are made."""
Family = Literal["six-axis", "scara"]
"""The build of a robot."""
Figure = Literal["cycle_time", "moving", "standing", "motions", "way"]
"""A number that each run of a sweep has."""
Mode = Literal["auto", "manual", "manufast"]
"""The operating mode."""
Outcome = Literal["ended", "alarm", "time_over", "stuck", "stopped", "runs", "refused", "crashed", "hung"]
"""How a run ended; `runs`: it is not over."""
PointType = Literal["pose", "joint"]
"""The types of targets."""
Severity = Literal["error", "warning"]
"""How bad a diagnostic is."""
