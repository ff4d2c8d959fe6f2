"""Words of which one is meant: type checkers find a slip in them."""

from typing import Literal

__all__ = ["Engine", "Family", "Figure", "Mode", "Outcome", "PointType", "Severity"]

Engine = Literal["local", "ray"]
"""Where the runs of a sweep are made."""
Family = Literal["six-axis", "scara"]
"""The build of a robot."""
Figure = Literal["cycle_time", "moving", "standing", "motions", "way"]
"""A number that there is of each run of a sweep."""
Mode = Literal["auto", "manual", "manufast"]
"""The operating mode."""
Outcome = Literal["ended", "alarm", "time_over", "stuck", "stopped", "runs", "refused", "crashed", "hung"]
"""What became of a run; `runs`: it is not over."""
PointType = Literal["pose", "joint"]
"""The types of targets."""
Severity = Literal["error", "warning"]
"""How bad a diagnostic is."""
