"""Plots of runs, with matplotlib."""

from __future__ import annotations

import io
from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from .trace import Trace

__all__ = ["plot", "plot_sweep"]

_MOST_POINTS = 20_000


class Picture(Figure):
    """A figure that a notebook displays automatically."""

    def _repr_png_(self) -> bytes:
        image = io.BytesIO()
        self.savefig(image, format="png")
        return image.getvalue()


def plot(trace: Trace) -> Figure:
    """Plots the path of the TCP from above and from the front, its speed, and the velocities of the axes over time."""
    step = max(1, len(trace) // _MOST_POINTS)
    t, tcp, speed, velocities = (all[::step] for all in (trace.t, trace.tcp, trace.speed, trace.velocities))
    figure = Picture(figsize=(10, 7), layout="constrained")
    above, front, over_time, axes = figure.subplots(2, 2).flat
    for place, (across, up), names in ((above, (0, 1), "xy"), (front, (0, 2), "xz")):
        place.plot(tcp[:, across], tcp[:, up], linewidth=1)
        place.set(xlabel=f"{names[0]} in mm", ylabel=f"{names[1]} in mm", aspect="equal")
        place.set_adjustable("datalim")
    over_time.plot(t, speed, linewidth=1)
    over_time.set(xlabel="time in s", ylabel="speed of the TCP in mm/s")
    for axis, velocity in enumerate(np.transpose(velocities), 1):
        axes.plot(t, velocity, linewidth=0.8, label=f"axis {axis}")
    axes.set(xlabel="time in s", ylabel="velocity in deg/s (mm/s)")
    if velocities.shape[1]:
        axes.legend(fontsize="small", ncols=2)
    return figure


_UNITS = {"cycle_time": "s", "moving": "s", "standing": "s", "way": "mm"}


def plot_sweep(rows: Sequence[dict[str, Any]], parameter: str, figure: str) -> Figure:
    """Plots a figure of the runs that ended over a parameter; the others are crosses at the bottom."""
    rows = [row for row in rows if row.get(parameter) is not None]
    ended = [row for row in rows if row["outcome"] == "ended"]
    picture = Picture(figsize=(8, 5), layout="constrained")
    axes = picture.subplots()
    axes.plot([row[parameter] for row in ended], [row[figure] for row in ended], ".", label="ended")
    others = [row[parameter] for row in rows if row["outcome"] != "ended"]
    if others:
        axes.plot(others, [0.02] * len(others), "rx", transform=axes.get_xaxis_transform(), label="did not end")
        axes.legend()
    unit = f" in {_UNITS[figure]}" if figure in _UNITS else ""
    axes.set(xlabel=parameter, ylabel=figure.replace("_", " ") + unit)
    return picture
