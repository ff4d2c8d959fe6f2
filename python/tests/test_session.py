"""Runs that are stepped."""

import _thread
import pickle
import threading

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

import arl2rs


def test_a_session_gets_inputs_and_gives_observations(short):
    program = arl2rs.compile(short)
    with program.session(globals={"waits": True}, watch=["do.2", "di.1", "global.parts"]) as session:
        assert session["do.2"] == 0 and session["t"] == 0 and np.isnan(session["global.parts"])
        with pytest.raises(arl2rs.RefusedError, match="first cycle"):
            session.set_global("parts", 6)
        while session["line"] == 0 or session["j1"] < 1 - 1e-9:
            session.step()
        session.step(1000)
        assert (session["do.2"], session["di.1"], session["global.parts"]) == (0, 0, 3)
        session.set(di_1=session["do.2"] + 1)
        assert session["di.1"] == 1
        session.set_global("parts", 6)
        assert session["global.parts"] == 6
        session.set_global("place", {"x": -1})
        assert session.global_value("parts") == 6 and not session.is_over
        while not session.is_over:
            session.step(10)
        assert session.code == 0 and session["do.2"] == 1
        assert session.result().output == "a 2 -1 2 12\n"
        assert session.state()["do"][:3] == "010"
    with pytest.raises(arl2rs.SessionError, match="closed"):
        session.step()


def test_steps_are_those_of_a_run(program):
    whole = program.run()
    with program.session(trace=True) as session:
        rows = []
        while not session.is_over:
            rows.append(session.step(7, alone=True))
        result = session.result()
    assert result.trace.array.tobytes() == whole.trace.array.tobytes() and result.messages == whole.messages
    np.testing.assert_array_equal(
        np.array(rows[:-1])[:, : len(session.columns)], whole.trace.array[6::7][: len(rows) - 1]
    )


def test_results_may_be_asked_for_in_between(program):
    with program.session(trace=True) as session:
        session.step(1000)
        first = session.result()
        session.step(1000)
        second = session.result()
    assert (first.outcome, len(first.trace), len(second.trace)) == ("runs", 1000, 2000)
    assert first.messages == second.messages[: len(first.messages)]


def test_every_array_that_is_handed_out_is_its_own(program):
    with program.session(trace=True) as session:
        rows = [session.step(100) for _ in range(5)]
        assert [round(row[0], 3) for row in rows] == [0.099, 0.199, 0.299, 0.399, 0.499]
        assert not any(np.shares_memory(one, other) for one in rows for other in rows if one is not other)
        before = session.observe()
        before[:] = 0
        assert session["t"] == 0.499 and session.observe()[0] == 0.499
        first = session.result().trace
        first.array[:] = 0
        assert session.result().trace.t[-1] == 0.499
    robot = arl2rs.Robot("kr10-r1420")
    pose = robot.forward(robot.home)
    assert pose.flags.writeable and not np.shares_memory(pose, robot.forward(robot.home))


def test_an_alarm_is_raised_by_the_step_that_meets_it_and_named_by_all_that_follow(short):
    with arl2rs.compile(short).session(globals={"parts": 0}) as session:
        with pytest.raises(arl2rs.AlarmError) as met:
            while not session.is_over:
                session.step(100)
        alarm = met.value
        assert (alarm.number, alarm.file, alarm.line) == (20001, "short.arl", 15) and "20001" in alarm.text
        assert session.is_over and session.code == 3 and session.alarms == (alarm.alarm,)
        for act in (
            session.step,
            lambda: session.set(di_1=True),
            lambda: session.order("di.1 = true"),
            lambda: session.set_global("parts", 1),
        ):
            with pytest.raises(arl2rs.AlarmError) as again:
                act()
            assert again.value.alarm == alarm.alarm
        assert session.observe()[0] > 0 and session.result().outcome == "alarm"


def test_a_run_that_is_over_stays_as_it_is(short):
    session = arl2rs.compile(short).session()
    session.step(100_000)
    last = session.step()
    np.testing.assert_array_equal(session.step(5), last)
    with pytest.raises(arl2rs.RefusedError, match=r"di\.1 = true: the run ended at .* s \(ended\)"):
        session.set(di_1=True)
    assert repr(session).startswith("Session(") and "over" in repr(session)
    session.close()
    session.close()
    assert repr(session) == "Session(closed)" and session.is_closed
    with pytest.raises(arl2rs.SessionError, match="closed"):
        session.observe()


def test_points_and_parts_are_watched(short):
    program = arl2rs.compile(short)
    with program.session(watch=["global.place", "global.row", "do.2", "global.place.x", "global.row[1]"]) as session:
        assert session.watched[:3] == ("global.place.x", "global.place.y", "global.place.z")
        assert session.watched[8:] == (
            "global.row[0]",
            "global.row[1]",
            "global.row[2]",
            "do.2",
            "global.place.x",
            "global.row[1]",
        )
        assert np.isnan(session["global.place.x"])
        session.step()
        assert (session["global.place.x"], session["global.row[1]"], session["do.2"]) == (1, 2, 0)
        # Not set.
        assert np.isnan(session["global.place.z"])
        session.set_global("place", {"x": 7.5})
        assert session["global.place.x"] == 7.5
    for name, words in [
        ("global.place.w", "there is global.place with .x"),
        ("global.row[3]", r"there is global\.row\[0\.\.2\]"),
        ("global.name", "a string is not a number"),
        ("global.plac", "did you mean `place`"),
    ]:
        with pytest.raises(arl2rs.RefusedError, match=words):
            program.session(watch=[name])


def test_a_run_is_watched_too(short):
    program = arl2rs.compile(short)
    trace = program.run(watch=["do.2", "global.place.x"]).trace
    plain = program.run().trace
    assert trace.watched == ("do.2", "global.place.x") and trace.array[:, :21].tobytes() == plain.array.tobytes()
    assert set(trace["do.2"][:-2]) == {0} and trace["do.2"][-1] == 1 and trace["global.place.x"][-1] == 1
    assert list(trace.to_pandas().columns[-3:]) == ["do.2", "global.place.x", "file"]
    assert trace.tcp.shape[1] == 6


def test_values_have_types(tmp_path):
    source = "\n".join(
        [
            "int n = -3",
            "double d = 5",
            "bool b = true",
            'string s = "a \\"b\\""',
            "pose p = {x 900, y -0.5, z 400, a 0, b 180, c 0}",
            "joint j[2] = {{0, -90, 90, 0, 90, 0}, {1, 2, 3, 4, 5, 6}}",
            "int m[2][3] = {{1, 2, 3}, {4, 5, 6}}",
            "tool t = {{0, 0, 100, 0, 0, 0}, false}",
            "controlmode mode",
            "func void main()",
            "    waituntil getdi(1)",
            "    print n, d, b, s, p.x, j[0].j1, m[1][2], t.t_frame.z, mode",
            "endfunc\n",
        ]
    )
    program = arl2rs.compile(source=source)
    with program.session() as session:
        session.step()
        value = session.global_value
        assert (value("n"), value("b"), value("s")) == (-3, True, 'a "b"')
        assert value("d") == 5.0 and type(value("d")) is float and type(value("n")) is int
        pose = value("p")
        assert {name: pose[name] for name in "xyzabc"} == {
            "x": 900.0,
            "y": -0.5,
            "z": 400.0,
            "a": 0.0,
            "b": 180.0,
            "c": 0.0,
        }
        assert type(pose["x"]) is float and pose["cfg"] == 0 and "ej1" not in pose
        assert [point["j2"] for point in value("j")] == [-90.0, 2.0]
        assert value("m") == [[1, 2, 3], [4, 5, 6]] and value("M") == value("m")
        assert value("t")["t_frame"]["z"] == 100.0
        assert isinstance(value("mode"), arl2rs.Literal)
        for name in ("n", "d", "b", "s", "p", "j", "m", "t", "mode"):
            before = session.global_literal(name)
            session.set_global(name, value(name))
            assert session.global_literal(name) == before
    with program.session(watch=["global.m"]) as session:
        session.step()
        assert session.watched[:4] == ("global.m[0][0]", "global.m[0][1]", "global.m[0][2]", "global.m[1][0]")
        assert list(session.observe()[-6:]) == [1, 2, 3, 4, 5, 6]


def test_a_program_tells_what_it_has(program):
    assert list(program.points) == ["home", "feeder", "pallet"]
    feeder = program.points["feeder"]
    assert (feeder.type, feeder.file, feeder.line, feeder.sizes, feeder.constant) == (
        "pose",
        "pick_and_place_data.arl",
        3,
        (),
        False,
    )
    assert feeder.first == "{x 900, y -500, z 400, a 0, b 180, c 0}"
    assert feeder.value(feeder.first)["y"] == -500.0
    assert "pitch" in program.variables and program.variables["pitch"].type == "double"
    assert str(program.signals[0]) == "di.1" and {signal.signal for signal in program.signals} >= {
        "di.64",
        "do.1",
        "ai.1",
        "ao.1",
    }


def test_a_session_goes_on_from_a_snapshot(program):
    with program.session(trace=True) as session:
        session.step(1000)
        session.set(di_9=True)
        session.set_global("clearance", 160.0)
        for _ in range(1000):
            session.step()
        session.step(0)
        assert len(session._done) == 4 and len(session._known) == 3, "what grows is kept once"
        snapshot = session.snapshot()
        ahead = session.step(1000)
        whole = session.result()
    assert snapshot.time == 2.0 and repr(snapshot) == "Snapshot(2.000 s)"
    for again in (snapshot, pickle.loads(pickle.dumps(snapshot))):
        with again.resume() as session:
            assert session.time == 2.0 and session.global_value("clearance") == 160.0
            assert session.snapshot().done == snapshot.done
            assert session.step(1000).tobytes() == ahead.tobytes()
            assert session.result().trace.array.tobytes() == whole.trace.array.tobytes()
    with snapshot.resume() as session:
        session.order("override = 50")
        assert session.step(1000).tobytes() != ahead.tobytes()
    with pytest.raises(arl2rs.RefusedError, match="state_dir"), program.session(state_dir="state") as session:
        session.snapshot()


def test_cycles_before_ctrl_c_are_in_a_snapshot(tmp_path):
    source = tmp_path / "endless.arl"
    source.write_text("func void main()\n    while(true)\n        waittime 0.1\n    endwhile\nendfunc\n")
    with arl2rs.compile(source).session() as session:
        session.step(3)
        threading.Timer(0.3, _thread.interrupt_main).start()
        with pytest.raises(KeyboardInterrupt):
            session.step(2**40)
        session.step(4)
        assert session.time > 1
        with session.snapshot().resume() as again:
            assert again.time == session.time


def test_inputs_by_name_take_what_is_observed(tmp_path):
    (tmp_path / "cell.toml").write_text('[names]\n"di.5" = "ready"\n"ai.1" = "pressure"\n')
    source = tmp_path / "waits.arl"
    source.write_text("func void main()\n    waituntil getdi(5)\n    print getai(1)\nendfunc\n")
    with arl2rs.compile(source, cell=tmp_path / "cell.toml").session() as session:
        session.set(pressure=1, ready=np.float64(1.0))
        session.step(10)
        assert session.is_over and session.result().output == "1\n"


def test_a_snapshot_that_leads_elsewhere_is_refused(example):
    program = arl2rs.compile(example / "pick_and_place.arl", scenario=example / "scenario.toml")
    data = example / "pick_and_place_data.arl"
    with program.session() as session:
        session.step(3000)
        snapshot = session.snapshot()
    before = data.read_text()
    data.write_text(before.replace("y -500", "y -450"))
    try:
        with pytest.raises(arl2rs.SessionError, match=r"repeating the run up to 3\.000 s"):
            snapshot.resume()
    finally:
        data.write_text(before)


def test_a_robot_is_stopped_on_its_path(program):
    with program.session() as session:
        session.step(1200)
        session.stop()
        while not session.is_over:
            session.step(10)
        assert session.code == 130


def test_what_is_wrong_is_reported(short):
    program = arl2rs.compile(short)
    for names in (["do.9999"], ["door"], ["global.name"], ["global.nobody"]):
        with pytest.raises(arl2rs.RefusedError, match=names[0].removeprefix("global.")):
            program.session(watch=names)
    with program.session() as session:
        with pytest.raises(arl2rs.RefusedError, match="expected true or false"):
            session.set(di_1=5)
        with pytest.raises(KeyError, match="speed"):
            session["speed"]


def test_a_session_stays_on_its_thread(short):
    session = arl2rs.compile(short).session()
    problems = []

    def step():
        for act in (session.step, session.state, session.result, session.observe, session.close):
            try:
                act()
            except arl2rs.SessionError as problem:
                problems.append(str(problem))

    thread = threading.Thread(target=step)
    thread.start()
    thread.join()
    assert problems == ["a run stays on the thread that began it"] * 5
    session.step()


@pytest.fixture
def environment(short):
    return arl2rs.Environment(
        arl2rs.compile(short),
        actions={"di.1": bool, "override": (10.0, 100.0)},
        reward=lambda session: -0.01,
        watch=["do.2"],
        globals={"waits": True},
        max_time=20.0,
        cycles=100,
    )


def test_an_environment_passes_the_check_of_gymnasium(environment):
    with pytest.warns(UserWarning, match="infinity"):
        check_env(environment, skip_render_check=True)


def test_an_environment_is_flat_and_made_by_gymnasium(short):
    made = gymnasium.make(
        "arl2rs.environment:arl2rs/Program-v0",
        program=arl2rs.compile(short),
        actions={"di.1": bool, "override": (10.0, 100.0)},
        reward=lambda session: -0.01,
        flat=True,
        max_time=20.0,
        cycles=100,
    )
    space = made.action_space
    assert isinstance(space, gymnasium.spaces.Box) and space.dtype == np.float32
    assert list(space.low) == [0, 10] and list(space.high) == [1, 100]
    made.reset(seed=1)
    over = False
    while not over:
        _, _, over, truncated, info = made.step(np.array([1, 100], dtype=np.float32))
        assert not truncated
    assert info["outcome"] == "ended"
    several = gymnasium.make_vec(
        "arl2rs.environment:arl2rs/Program-v0",
        num_envs=2,
        vectorization_mode="sync",
        program=short,
        actions={"override": (10.0, 100.0)},
        reward=lambda session: session["t"],
        flat=True,
    )
    several.reset(seed=[1, 2])
    _, rewards, *_ = several.step(np.array([[10], [100]], dtype=np.float32))
    assert list(rewards) == [rewards[0]] * 2
    several.close()


def test_an_alarm_ends_an_episode_also_in_its_first_cycle():
    program = arl2rs.compile(source="int parts = 0\nfunc void main()\n    print 12 / parts\n    waittime 1\nendfunc\n")
    with pytest.raises(arl2rs.AlarmError):
        arl2rs.Environment(program, actions={"di.1": bool}, reward=lambda session: 0.0)
    environment = arl2rs.Environment(program, actions={"di.1": bool}, reward=lambda session: 0.0, globals={"parts": 1})
    environment.reset(options={"globals": {"parts": 0}})
    _, _, terminated, truncated, info = environment.step({"di.1": 1})
    assert (terminated, truncated, info["outcome"]) == (True, False, "alarm")


def test_an_episode_goes_on_from_a_snapshot(environment):
    environment.reset(seed=3)
    action = {"di.1": 0, "override": np.array([50.0])}
    environment.step(action)
    snapshot = environment.snapshot()
    ahead, *_ = environment.step(action)
    environment.step(action)
    environment.restore(snapshot)
    again, *_ = environment.step(action)
    assert again.tobytes() == ahead.tobytes()
    with pytest.raises(TypeError, match="did you mean `cycles`"):
        arl2rs.Environment(environment.program, actions={}, reward=float, cycels=3)


def test_an_episode_terminates_with_the_run_and_is_truncated_with_its_time(environment):
    action = {"di.1": 0, "override": np.array([100.0])}
    observation, info = environment.reset(seed=1)
    assert environment.observed == ["j1", "j2", "j3", "j4", "j5", "j6", "x", "y", "z", "a", "b", "c", "do.2"]
    terminated = truncated = False
    while not (terminated or truncated):
        observation, reward, terminated, truncated, info = environment.step(action)
        assert observation in environment.observation_space and reward == -0.01
    assert truncated and info["outcome"] == "time_over"
    environment.reset(options={"globals": {"waits": True, "parts": 0}})
    terminated = False
    while not terminated:
        _, _, terminated, truncated, info = environment.step({**action, "di.1": 1})
        assert not truncated
    assert info["outcome"] == "alarm" and info["alarms"][0].line == 15
    with pytest.raises(gymnasium.error.ResetNeeded, match="the episode is over"):
        environment.step({**action, "di.1": 1})
    with pytest.raises(arl2rs.RefusedError, match="speed"):
        arl2rs.Environment(environment.program, actions={}, reward=float, observe=["speed"])
    for action in ("foo", "di.x", "do.1", "global.nobody"):
        with pytest.raises(arl2rs.RefusedError):
            arl2rs.Environment(environment.program, actions={action: bool}, reward=float)
    environment.reset(options={"globals": {"parts": 4}})
    assert environment.session.global_value("waits") is True and environment.session.global_value("parts") == 4
    environment.close()
    with pytest.raises(gymnasium.error.ResetNeeded):
        environment.step(action)
