"""Programs that are checked, compiled and run."""

import _thread
import json
import pickle
import subprocess
import sys
import threading
import time

import numpy as np
import pytest

import arl2rs


def test_mistakes_have_a_place(tmp_path):
    wrong = tmp_path / "wrong.arl"
    wrong.write_text('func void main()\n    movej 5\n    int a = "b"\nendfunc\n')
    found = arl2rs.check(wrong)
    assert [(it.line, it.is_error) for it in found] == [(2, True), (3, True)]
    assert str(found[0]).startswith(f"{found[0].file}:2:5: error[ARL")
    with pytest.raises(arl2rs.CompileError) as raised:
        arl2rs.compile(wrong)
    assert raised.value.line == 2 and raised.value.diagnostics == found
    assert arl2rs.check(wrong, background=True)[0].line == 2


def test_warnings_are_no_errors(tmp_path):
    source = tmp_path / "warned.arl"
    source.write_text("func void main()\n    int unused = 5\n    movej j:{200, 0, 0, 0, 0, 0}\nendfunc\n")
    found = arl2rs.check(source, robot="six-10")
    assert found and not any(it.is_error for it in found)


def test_programs_and_exceptions_go_to_other_processes(short, tmp_path):
    program = pickle.loads(pickle.dumps(arl2rs.compile(short)))
    result = program.run(globals={"parts": 0})
    with pytest.raises(arl2rs.AlarmError) as alarmed:
        result.check()
    wrong = tmp_path / "wrong.arl"
    wrong.write_text("func void main()\n    movej 5\nendfunc\n")
    with pytest.raises(arl2rs.CompileError) as refused:
        arl2rs.compile(wrong)
    for raised in (alarmed.value, refused.value):
        again = pickle.loads(pickle.dumps(raised))
        assert (type(again), str(again), again.line) == (type(raised), str(raised), raised.line)
    with pytest.raises(arl2rs.RefusedError, match="a file"):
        arl2rs.check()


def test_what_is_not_there_is_told(tmp_path):
    with pytest.raises(arl2rs.ArlError, match=r"none\.arl"):
        arl2rs.compile(tmp_path / "none.arl")
    with pytest.raises(arl2rs.RefusedError, match="nobody"):
        arl2rs.check(tmp_path / "none.arl", robot="nobody")


def test_a_run_is_that_of_the_command_to_the_last_bit(program, example, tmp_path):
    result = program.run()
    command = [sys.executable, "-m", "arl2rs", "run", "pick_and_place.arl", "--io", "scenario.toml"]
    command += ["--trace", tmp_path / "t.csv", f"--report={tmp_path / 'r.jsonl'}", "--state-dir", tmp_path / "state"]
    ran = subprocess.run(command, cwd=example, check=True, capture_output=True, text=True)
    assert result.output == ran.stdout and result.ended and result.code == 0
    assert list(result.report) == [json.loads(line) for line in (tmp_path / "r.jsonl").read_text().splitlines()]
    written = np.genfromtxt(tmp_path / "t.csv", delimiter=",", names=True)
    assert len(written) == len(result.trace)
    for column in result.trace.columns:
        np.testing.assert_allclose(result.trace[column], written[column], rtol=0, atol=1e-6, equal_nan=True)
    again = program.run()
    assert again == result and again.trace.array.tobytes() == result.trace.array.tobytes()


def test_the_trace_has_views(program):
    trace = program.run().trace
    assert trace.joints.shape == (len(trace), 6) and trace.external.shape == (len(trace), 0)
    assert trace.tcp.shape == trace.velocities.shape == (len(trace), 6)
    assert trace.t[1] == 0.001 and trace.line.max() == 56 and trace.motion.max() == 38
    assert 500 < trace.speed.max() < 5000
    assert list(trace.to_pandas().columns) == list(trace.to_polars().columns) == [it for it in trace.columns if it[:2] != "ej"]
    assert trace.to_pandas()["line"].dtype == np.int64 and trace.to_pandas().notna().all().all()
    with pytest.raises(KeyError, match="nope"):
        trace["nope"]


def test_parameters_are_other_values(short):
    program = arl2rs.compile(short)
    assert program.run().output == "a 4 1 2 12\n"
    result = program.run(
        globals={"parts": 2, "name": 'say "b"', "row": np.array([7, 8, 9])},
        points={"place": {"y": 5.5}},
        set={"global.angle": np.float64(30)},
    )
    assert result.output == 'say "b" 6 1 5.5 78\n'
    assert abs(result.trace["j1"][-1] - 30) < 1e-9
    slow = program.run(robot="six-10", set={"robot.axis.1.vel": 1}, globals={"angle": 2}, trace=False)
    assert slow.cycle_time > program.run(robot="six-10", globals={"angle": 2}).cycle_time + 1 and slow.trace is None
    assert program.run(override=50).cycle_time > program.run().cycle_time
    assert program.run(globals={"waits": arl2rs.Literal("false")}).ended


def test_what_does_not_fit_is_told_by_its_name(short):
    program = arl2rs.compile(short)
    for arguments, words in [
        ({"globals": {"part": 1}}, "did you mean `parts`"),
        ({"globals": {"parts": "x"}}, "expected a value of type int, found a string"),
        ({"globals": {"parts": None}}, "None is nothing"),
        ({"set": {"speed": 1}}, "there is no parameter `speed`"),
        ({"set": {"io.event.1.at": 1}}, "`scenario` says whose"),
        ({"set": {"robot.axis.1.vel": 1}}, "`robot` says whose"),
        ({"globals": ["parts"]}, "dictionaries"),
        ({"robot": "nobody"}, "no robot of this name"),
        ({"mode": "fast"}, "--mode fast"),
    ]:
        with pytest.raises(arl2rs.RefusedError, match=words):
            program.run(**arguments)
    for value in (float("nan"), np.inf, object(), {1}, b"a", arl2rs.Literal(5)):
        with pytest.raises(arl2rs.RefusedError, match="angle"):
            program.run(globals={"angle": value})
    with pytest.raises(arl2rs.RefusedError, match=r"global\.parts is given twice"):
        program.run(globals={"parts": 1}, set={"global.parts": 2})


def test_a_program_that_changes_is_compiled_while_the_old_one_lives(tmp_path):
    source = tmp_path / "changing.arl"
    source.write_text("func void main()\n    print 1\nendfunc\n")
    old = arl2rs.compile(source)
    source.write_text("func void main()\n    print 2\nendfunc\n")
    new = arl2rs.compile(source)
    assert (old.run().output, new.run().output) == ("1\n", "2\n")


def test_numbers_arrive_to_the_last_bit(short):
    program = arl2rs.compile(short)
    random = np.random.default_rng(1)
    with program.session() as session:
        session.step()
        for number in random.uniform(0, 1000, 200):
            session.set_global("angle", number)
            assert float(session.global_value("angle")) == number
    [row] = arl2rs.sweep(short, [{"global.angle": 449.49106478873813, "max-time": 1}])
    assert row["parameters"]["global.angle"] == 449.49106478873813


def test_any_text_may_be_printed(short):
    text = "a\u2028b\u2029 \U0001f916 \x85"
    assert arl2rs.compile(short).run(globals={"name": text}).output == text + " 4 1 2 12\n"


def test_alarms_have_file_and_line(short):
    result = arl2rs.compile(short).run(globals={"parts": 0})
    assert (result.outcome, result.code, result.alarms[0].number) == ("alarm", 3, 20001)
    with pytest.raises(arl2rs.AlarmError) as raised:
        result.check()
    assert (raised.value.file, raised.value.line) == ("short.arl", 15)


def test_a_run_that_waits_in_vain_ends(short):
    result = arl2rs.compile(short).run(globals={"waits": True})
    assert result.outcome == "stuck" and "nothing can change any more" in result.warnings[0]
    with pytest.raises(arl2rs.UnfinishedError, match="nothing can change"):
        result.check()
    assert arl2rs.compile(short).run(globals={"angle": 90}, max_time=0.1).outcome == "time_over"


@pytest.fixture(scope="module")
def endless(tmp_path_factory):
    source = tmp_path_factory.mktemp("endless") / "endless.arl"
    source.write_text(
        "func void main()\n    while(true)\n        movej j:{0, -90, 90, 0, 90, 0}\n        movej j:{5, -90, 90, 0, 90, 0}\n    endwhile\nendfunc\n"
    )
    return arl2rs.compile(source)


def test_ctrl_c_ends_a_run(endless):
    threading.Timer(0.3, _thread.interrupt_main).start()
    with pytest.raises(KeyboardInterrupt):
        endless.run(trace=False)


def test_other_threads_go_on_while_one_runs(endless):
    ended = []
    runs = threading.Thread(target=lambda: ended.append(endless.run(max_time=200, trace=False)))
    runs.start()
    longest, began = 0.0, time.perf_counter()
    last = began
    while runs.is_alive():
        now = time.perf_counter()
        longest, last = max(longest, now - last), now
    assert ended[0].outcome == "time_over"
    # Who waited for the whole run would have seen nothing in between.
    assert longest < 0.5 * (time.perf_counter() - began)


def test_a_recording_is_made(program, tmp_path):
    program.record(tmp_path / "run.mcap", globals={"pitch": 100})
    assert (tmp_path / "run.mcap").read_bytes().startswith(b"\x89MCAP0")
    with pytest.raises(arl2rs.ArlError, match="pich"):
        program.record(tmp_path / "run.mcap", globals={"pich": 100})


def test_a_picture_is_drawn(program, tmp_path):
    program.run().plot().savefig(tmp_path / "run.png")
    assert (tmp_path / "run.png").stat().st_size > 10_000
    with pytest.raises(arl2rs.RefusedError, match="trace=True"):
        program.run(trace=False).plot()


def test_the_command_is_there():
    ran = subprocess.run([sys.executable, "-m", "arl2rs", "explain", "ARL0203"], capture_output=True, text=True, check=True)
    assert "ARL0203" in ran.stdout
    assert subprocess.run([sys.executable, "-m", "arl2rs", "check", "none.arl"], check=False, capture_output=True).returncode == 1
    assert subprocess.run([sys.executable, "-m", "arl2rs", "fly"], check=False, capture_output=True).returncode == 2
