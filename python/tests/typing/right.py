"""Right uses: mypy has nothing to say of them."""

import gymnasium
import numpy as np

import arl2rs

program = arl2rs.compile("pick.arl", scenario="scenario.toml", robot="six-10", cell=None)
text = arl2rs.compile(
    source="func void main()\nendfunc\n", beside={"program_data.arl": arl2rs.points("weld", np.zeros((5, 6)))}
)
result: arl2rs.Result = program.run(globals={"pitch": 100}, points={"feeder": {"y": -400}}, override=80, watch=["do.1"])
assert result.outcome == "ended" or result.outcome == "alarm"
slow = program.run(mode="manual")
seconds: float = result.cycle_time or 0.0
number: int = result.alarms[0].number
assert result.trace is not None
speed: float = float(result.trace.speed.max())
file: str = result.trace.file[0]
arl2rs.run("pick.arl", globals={"pitch": 1}, max_time=10.0, trace=False)
diagnostics: list[arl2rs.Diagnostic] = arl2rs.check("pick.arl", "place.arl", strict=True)

with program.session(watch=["do.1", "global.feeder"], trace=True) as session:
    row = session.step(10)
    first: float = row[0]
    session.set(di_1=True, ai_2=4.2)
    session.set_global("pitch", 90)
    value = session.global_value("pitch") + 1
    snapshot: arl2rs.Snapshot = session.snapshot()
    try:
        snapshot.resume().step(cycles=5, alone=True)
    except arl2rs.AlarmError as alarm:
        print(alarm.number, alarm.text, alarm.file, alarm.line)

rows = arl2rs.grid({"global.pitch": [80, 100]})
results = program.sweep(rows, processes=2, collisions=True)
best: float = results.best()["cycle_time"]
arl2rs.sweep("pick.arl", results.to_pandas(), scenario="scenario.toml", engine="ray", timeout=60.0)

robot = arl2rs.Robot("kr10-r1420")
pose = robot.forward([0, -90, 90, 0, 20, 0], tool=(0, 0, 100, 0, 0, 0))
joints = robot.inverse(pose, near=robot.home, cfg=0)
reached: bool = bool(robot.reaches(pose))
low: float = robot.axes[0].min

environment = arl2rs.Environment(
    program,
    actions={"di.1": bool, "override": (10.0, 100.0)},
    reward=lambda session: -session.time,
    globals={"waits": True},
    flat=True,
)
observation, info = environment.reset(seed=1)
observation, reward, terminated, truncated, info = environment.step(np.array([1.0, 50.0]))
space: gymnasium.spaces.Space[object] = environment.observation_space
points: list[str] = list(program.points)
signal: str | None = program.signals[0].name
