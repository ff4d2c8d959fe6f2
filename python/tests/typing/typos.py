"""A typo in each line that ends with `# typo`: mypy finds each of them, and nothing else."""

import arl2rs

program = arl2rs.compile("pick.arl", scenaro="s.toml")  # typo
arl2rs.compile("pick.arl", io="s.toml")  # typo
arl2rs.check("pick.arl", strikt=True)  # typo
arl2rs.run("pick.arl", overide=50)  # typo
arl2rs.run("pick.arl", max_time="10")  # typo
program.run(global_={"pitch": 1})  # typo
program.run(override="50")  # typo
program.record("run.mcap", sed=3)  # typo
program.sweep([], procesess=3)  # typo
arl2rs.sweep("pick.arl", [{}], colisions=True)  # typo
arl2rs.sweep("pick.arl", 5)  # typo
program.session(watsh=["do.1"])  # typo
session = program.session(watch=["do.1"])
session.stepp(10)  # typo
session.step(cycle=10)  # typo
session.set(di_1="on")  # typo
print(session.result().cycletime)  # typo
arl2rs.sweep("pick.arl", [{}], engine="rey")  # typo
program.run(mode="automatic")  # typo
print(session.result().outcome == "endet")  # typo
print(program.sweep([]).best("cycletime"))  # typo
arl2rs.points("weld", [[0] * 6], type="poses")  # typo
robot = arl2rs.Robot("kr10-r1420")
robot.inverse([0] * 6, neer=None)  # typo
robot.forwards([0] * 6)  # typo
arl2rs.Environment(program, actions={}, reward=float, cycels=3)  # typo
print(arl2rs.AlarmError.nummer)  # typo
