"""Looks for a layout of a pick-and-place cell with a short cycle: where the feeder and the pallet stand, how high parts are lifted, how corners are
rounded off, how fast it goes.

    pip install "./python[plot]" optuna
    python examples/layout/layout.py [RUNS] [ENGINE]

Optuna asks for some layouts at a time; arl2rs makes their runs, on all cores or on a cluster of Ray (ENGINE: ray). It starts with the layout that
the program has, and draws layout.png.
"""

import sys
from pathlib import Path
from typing import Any

import optuna
from matplotlib.figure import Figure

import arl2rs

HERE = Path(__file__).parent
PROGRAM, CELL, SCENARIO = HERE / "layout.arl", HERE / "cell.toml", HERE / "scenario.toml"
AT_ONCE = 8

START = {
    "feeder_x": 900.0, "feeder_y": -500.0, "feeder_z": 400.0,
    "pallet_x": 800.0, "pallet_y": 300.0, "pallet_z": 350.0,
    "lift": 150.0, "zone": 0.0, "fast": 80.0, "slow": 200.0,
}  # fmt: skip

# mm, percent, mm/s: what the hall, the gripper and the parts allow.
BOUNDS = {
    "feeder_x": (500, 1000), "feeder_y": (-700, -250), "feeder_z": (250, 600),
    "pallet_x": (500, 900), "pallet_y": (100, 500), "pallet_z": (250, 600),
    "lift": (60, 200), "zone": (0, 80), "fast": (20, 100), "slow": (50, 250),
}  # fmt: skip


def parameters(layout: dict[str, float]) -> dict[str, Any]:
    """The parameters of the run that tries a layout."""
    rows: dict[str, Any] = {f"global.{name}": layout[name] for name in ("lift", "zone", "fast", "slow")}
    # Where the middle of what stands there is from the point, in mm.
    for body, (point, middle) in enumerate({"feeder": (0, 0, -300), "pallet": (60, 120, -300)}.items(), start=1):
        at = [layout[f"{point}_{axis}"] for axis in "xyz"]
        rows[f"global.{point}"] = dict(zip("xyz", at, strict=True))
        rows[f"cell.body.{body}.at"] = [a + b for a, b in zip(at, middle, strict=True)]
    return rows


def cost(row: dict[str, Any]) -> float:
    """Seconds of a cycle; what does not end, or touches something, is not a layout."""
    return float(row["cycle_time"]) if row["outcome"] == "ended" and not row["collisions"] else 1000.0


def search(runs: int, engine: str) -> tuple[optuna.Study, list[float]]:
    """Tries so many layouts; gives them, and the cycle time of each."""
    study = optuna.create_study(sampler=optuna.samplers.TPESampler(seed=1, multivariate=True))
    study.enqueue_trial(START)
    costs: list[float] = []
    while len(costs) < runs:
        trials = [study.ask() for _ in range(min(AT_ONCE, runs - len(costs)))]
        layouts = [{name: trial.suggest_float(name, *bounds) for name, bounds in BOUNDS.items()} for trial in trials]
        rows = map(parameters, layouts)
        how: dict[str, Any] = {"max_time": 120, "collisions": True, "engine": engine, "progress": False}
        results = arl2rs.sweep(PROGRAM, rows, cell=CELL, scenario=SCENARIO, **how)
        for trial, row in zip(trials, results, strict=True):
            study.tell(trial, cost(row))
            costs.append(cost(row))
    return study, costs


def draw(before: arl2rs.Result, after: arl2rs.Result, costs: list[float]) -> Figure:
    """The path from above before and after, and how the cycle time came down."""
    picture = Figure(figsize=(11, 5), layout="constrained")
    path, time = picture.subplots(1, 2)
    for result, label in ((before, "before"), (after, "after")):
        path.plot(*result.trace.tcp[:, :2].T, linewidth=1, label=f"{label}: {result.cycle_time:.1f} s")
    path.set(xlabel="x in mm", ylabel="y in mm", aspect="equal", title="The path of the TCP, from above")
    path.legend()
    best = [min(costs[: at + 1]) for at in range(len(costs))]
    time.plot([min(cost, 1.5 * costs[0]) for cost in costs], ".", markersize=3, label="a layout")
    time.plot(best, label="the best so far")
    time.set(xlabel="runs", ylabel="cycle time in s")
    time.legend()
    return picture


def main() -> None:
    """Searches, says what it found, and draws it."""
    runs = int(sys.argv[1]) if len(sys.argv) > 1 else 400
    optuna.logging.set_verbosity(optuna.logging.WARNING)
    study, costs = search(runs, sys.argv[2] if len(sys.argv) > 2 else "local")
    program = arl2rs.compile(PROGRAM, cell=CELL, scenario=SCENARIO)
    before, after = (program.run(set=parameters(layout)).check() for layout in (START, study.best_params))
    draw(before, after, costs).savefig("layout.png", dpi=150)
    print(f"{before.cycle_time:.2f} s before, {after.cycle_time:.2f} s after {len(costs)} runs")
    print({name: round(value, 1) for name, value in study.best_params.items()})


if __name__ == "__main__":
    main()
