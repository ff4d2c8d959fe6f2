"""Runs that are stepped."""

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
        assert session.global_value("parts") == "6" and not session.is_over
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
            rows.append(session.step(7, alone=True).copy())
        result = session.result()
    assert result.trace.array.tobytes() == whole.trace.array.tobytes() and result.messages == whole.messages
    np.testing.assert_array_equal(np.array(rows[:-1])[:, : len(session.columns)], whole.trace.array[6::7][: len(rows) - 1])


def test_results_may_be_asked_for_in_between(program):
    with program.session(trace=True) as session:
        session.step(1000)
        first = session.result()
        session.step(1000)
        second = session.result()
    assert (first.outcome, len(first.trace), len(second.trace)) == ("runs", 1000, 2000)
    assert first.messages == second.messages[: len(first.messages)]


def test_a_robot_is_stopped_on_its_path(program):
    with program.session() as session:
        session.step(1200)
        session.stop()
        while not session.is_over:
            session.step(10)
        assert session.code == 130


def test_what_is_wrong_is_told(short):
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
    with pytest.raises(arl2rs.RefusedError, match="speed"):
        arl2rs.Environment(environment.program, actions={}, reward=float, observe=["speed"])
    for action in ("foo", "di.x", "do.1", "global.nobody"):
        with pytest.raises(arl2rs.RefusedError):
            arl2rs.Environment(environment.program, actions={action: bool}, reward=float)
    environment.reset(options={"globals": {"parts": 4}})
    assert environment.session.global_value("waits") == "true" and environment.session.global_value("parts") == "4"
    environment.close()
    with pytest.raises(gymnasium.error.ResetNeeded):
        environment.step(action)
