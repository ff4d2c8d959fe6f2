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
    with pytest.raises(arl2rs.RefusedError, match="needs files"):
        arl2rs.check()


def test_what_is_not_there_is_reported(tmp_path):
    (tmp_path / "nine.arl").write_text("func void main()\nendfunc\n")
    for act in (arl2rs.compile, arl2rs.check, arl2rs.run, lambda program: arl2rs.sweep(program, [{}])):
        with pytest.raises(arl2rs.RefusedError, match=r"none\.arl: expected a program; did you mean .*nine\.arl"):
            act(tmp_path / "none.arl")
    with pytest.raises(arl2rs.RefusedError, match="is a folder"):
        arl2rs.compile(tmp_path)
    with pytest.raises(arl2rs.RefusedError, match="nobody"):
        arl2rs.check(tmp_path / "nine.arl", robot="nobody")
    with pytest.raises(arl2rs.RefusedError, match=r"no\.toml"):
        arl2rs.check(tmp_path / "nine.arl", cell="no.toml")


def test_a_scenario_that_is_not_there_is_reported_when_compiling(short, tmp_path):
    program = arl2rs.compile(short)
    for act in (
        lambda io: arl2rs.compile(short, scenario=io),
        lambda io: program.run(scenario=io),
        lambda io: program.session(scenario=io),
        lambda io: program.record("r.mcap", scenario=io),
        lambda io: arl2rs.sweep(short, [{}], scenario=io),
        lambda io: arl2rs.run(short, scenario=io),
    ):
        with pytest.raises(arl2rs.RefusedError, match=r"there is no file no\.toml: expected a scenario"):
            act("no.toml")
    wrong = tmp_path / "wrong.toml"
    wrong.write_text("[[event]]\nat = \n")
    with pytest.raises(arl2rs.RefusedError, match=r"wrong\.toml:2:\d+: "):
        arl2rs.compile(short, scenario=wrong)
    # An arl.toml names it.
    (tmp_path / "a.arl").write_text("func void main()\nendfunc\n")
    (tmp_path / "arl.toml").write_text('io = "no.toml"\n')
    with pytest.raises(arl2rs.RefusedError, match=r"no\.toml"):
        arl2rs.compile(tmp_path / "a.arl")


def test_slips_in_names_of_arguments_are_reported(short):
    program = arl2rs.compile(short)
    for act, words in [
        (lambda: arl2rs.sweep(short, [], procesess=3), "no argument `procesess`: did you mean `processes`"),
        (lambda: program.sweep([], procesess=3), "did you mean `processes`"),
        (lambda: program.run(overide=50), "did you mean `override`"),
        (lambda: arl2rs.run(short, overide=50), "did you mean `override`"),
        (lambda: program.record("r.mcap", overide=50), "did you mean `override`"),
        (lambda: arl2rs.compile(short, io="s.toml"), "it is called `scenario` here"),
        (lambda: program.run(**{"max-time": 3}), "did you mean `max_time`"),
        (lambda: arl2rs.check(short, sript_dir="a"), "did you mean `script_dir`"),
        (lambda: arl2rs.Program(short, robott="a"), "did you mean `robot`"),
        (lambda: arl2rs.Robot("kr10-r1420").inverse([0] * 6, nearr=3), "did you mean `near`"),
        (lambda: arl2rs.points("a", [[0] * 6], tipe="joint"), "did you mean `type`"),
    ]:
        with pytest.raises(TypeError, match=words):
            act()


def test_a_program_is_a_text(tmp_path):
    text = 'import "grip.arl"\nfunc void main()\n    grip::take()\n    print 3, offset[1].x\nendfunc\n'
    beside = {
        "grip.arl": "func void take()\n    movej j:{0, -90, 90, 0, 90, 0}\n    movej j:{5, -90, 90, 0, 90, 0}\nendfunc\n"
    }
    beside["program_data.arl"] = "pose offset[2] = {{x 1}, {x 2}}\n"
    program = arl2rs.compile(source=text, beside=beside)
    result = program.run()
    assert result.output == "32\n" and repr(program) == "Program(source=..)"
    assert pickle.loads(pickle.dumps(program)).run() == result
    assert arl2rs.run(source=text, beside=beside) == result
    assert program.sweep([{}])[0]["outcome"] == "ended"
    [wrong] = arl2rs.check(source=text, beside={**beside, "grip.arl": "func void take()\n    movej 5\nendfunc\n"})
    assert (wrong.file, wrong.line) == ("grip.arl", 2)
    with pytest.raises(arl2rs.CompileError) as raised:
        arl2rs.compile(source="func void main()\n    movej 5\nendfunc\n")
    assert (raised.value.file, raised.value.line) == ("program.arl", 2)
    for arguments, words in [
        ({}, "a file, or its text"),
        ({"program": "a.arl", "source": text}, "a file, or its text"),
        ({"program": "a.arl", "beside": beside}, "needs `source`"),
        ({"source": text, "beside": {"../a.arl": ""}}, "expected the name of a file"),
    ]:
        with pytest.raises(arl2rs.RefusedError, match=words):
            arl2rs.compile(**arguments)


def test_files_of_a_trace_are_those_of_the_first_robot_s_motions(program):
    columns = program.columns
    rows = np.zeros((4, len(columns)))
    rows[:, columns.index("motion")] = [0, 1, 2, 1]
    report = '{"channel":1,"motion":1,"file":"a.arl"}\n{"channel":1,"motion":2,"file":"b.arl"}\n'
    report += '{"channel":2,"motion":1,"file":"c.arl"}\n{"channel":1,"cycle_time":1,"motions":2}\n'
    summary = '{"outcome":"ended","code":0,"cycle_time":1,"alarms":[],"ended_by":null}'
    result = arl2rs.result.of_summary(summary, "", report, rows, columns)
    assert list(result.trace.file) == ["", "a.arl", "b.arl", "a.arl"]
    assert [row["file"] for row in result.report] == ["a.arl", "b.arl", "c.arl"] and result.totals[0]["motions"] == 2


def test_lines_have_their_file():
    text = 'import "grip.arl"\nfunc void main()\n    movej j:{9, -90, 90, 0, 90, 0}\n    grip::take()\nendfunc\n'
    beside = {"grip.arl": "func void take()\n    movej j:{5, -90, 90, 0, 90, 0}\nendfunc\n"}
    result = arl2rs.run(source=text, beside=beside)
    assert [(row["file"], row["line"]) for row in result.report] == [("program.arl", 3), ("grip.arl", 2)]
    trace = result.trace
    assert {(file, int(line)) for file, line in zip(trace.file, trace.line, strict=True)} >= {
        ("program.arl", 3),
        ("grip.arl", 2),
    }
    assert set(trace.file[trace.motion == 0]) <= {""} and list(trace.to_pandas()["file"]) == list(trace.file)


def test_the_report_has_a_row_for_each_motion(program):
    result = program.run()
    assert len(result.report) == result.motions and all("motion" in row for row in result.report)
    [totals] = result.totals
    assert totals["motions"] == result.motions and totals["cycle_time"] == pytest.approx(result.cycle_time, abs=1e-6)


def test_500_points_come_from_an_array():
    turn = np.linspace(0, 2 * np.pi, 500)
    fixed = np.ones_like(turn)
    circle = np.column_stack(
        [850 + 60 * np.cos(turn), 60 * np.sin(turn), 900 * fixed, 0 * fixed, 180 * fixed, 0 * fixed]
    )
    text = "func void main()\n    movej j:{9, -90, 90, 0, 90, 0}\n    ptp p:weld[0]\n"
    text += "    for(int i=1;i<500;i++)\n        lin p:weld[i], vl:100mm/s, sl:1mm\n    endfor\nendfunc\n"
    program = arl2rs.compile(source=text, beside={"program_data.arl": arl2rs.points("weld", circle)})
    assert program.points["weld"].sizes == (500,)
    result = program.run().check()
    assert result.motions == 501 and np.abs(result.trace.tcp[-1, :3] - circle[-1, :3]).max() < 1e-6
    # The same program with other points.
    higher = program.run(points={"weld": circle + np.array([0, 0, 50, 0, 0, 0])}).check()
    assert abs(higher.trace.tcp[-1, 2] - 950) < 1e-6


def test_arrays_become_points_to_the_last_bit():
    numbers = np.random.default_rng(1).uniform(-1e3, 1e3, (20, 6)) * 10.0 ** np.arange(-9, 3, 2)
    text = arl2rs.points("p", numbers) + arl2rs.points("q", numbers, type="joint", separate=True)
    text += arl2rs.points("r", numbers[:, :3]) + arl2rs.points("s", [[1, 2, 3]], components=["x", "cfg", "turn"])
    with arl2rs.compile(source=text + "func void main()\n    print 1\nendfunc\n").session() as session:
        session.step()
        assert [[row[name] for name in "xyzabc"] for row in session.global_value("p")] == numbers.tolist()
        assert [session.global_value("q20")[f"j{axis}"] for axis in range(1, 7)] == numbers[19].tolist()
        assert "a" not in session.global_value("r")[0] and session.global_value("s")[0]["cfg"] == 2
    for arguments, words in [
        (("1p", numbers), "is not a valid name of a variable"),
        (("p", numbers[0]), "found an array of shape"),
        (("p", [[1, np.nan, 3]]), "row 0 has a value that is not finite"),
        (("p", numbers, "place"), None),
    ]:
        with pytest.raises(arl2rs.RefusedError if words else TypeError, match=words):
            arl2rs.points(*arguments)
    with pytest.raises(arl2rs.RefusedError, match="'w' is none of x"):
        arl2rs.points("p", [[1]], components=["w"])


def test_a_run_is_that_of_the_command_to_the_last_bit(program, example, tmp_path):
    result = program.run()
    command = [sys.executable, "-m", "arl2rs", "run", "pick_and_place.arl", "--io", "scenario.toml"]
    command += ["--trace", tmp_path / "t.csv", f"--report={tmp_path / 'r.jsonl'}", "--state-dir", tmp_path / "state"]
    ran = subprocess.run(command, cwd=example, check=True, capture_output=True, text=True)
    assert result.output == ran.stdout and result.ended and result.code == 0
    assert [*result.report, *result.totals] == [
        json.loads(line) for line in (tmp_path / "r.jsonl").read_text().splitlines()
    ]
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
    assert (
        list(trace.to_pandas().columns)
        == list(trace.to_polars().columns)
        == [*(it for it in trace.columns if it[:2] != "ej"), "file"]
    )
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


def test_what_does_not_fit_is_reported_by_its_name(short):
    program = arl2rs.compile(short)
    for arguments, words in [
        ({"globals": {"part": 1}}, "did you mean `parts`"),
        ({"globals": {"parts": "x"}}, "expected a value of type int, found a string"),
        ({"globals": {"parts": None}}, "ARL has no value for None"),
        ({"set": {"speed": 1}}, "there is no parameter `speed`"),
        ({"set": {"io.event.1.at": 1}}, "`scenario`, which is not given"),
        ({"set": {"robot.axis.1.vel": 1}}, "`robot`, which is not given"),
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
            assert session.global_value("angle") == number
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


def test_the_alarm_that_ended_a_run_is_not_one_that_was_cleared(tmp_path):
    source = tmp_path / "twice.arl"
    source.write_text(
        "func void main()\n    waittime 0.1\n    if(getdi(1)) waittime getai(1) - 5\n    print 1 % getai(2)\nendfunc\n"
    )
    scenario = tmp_path / "twice.toml"
    scenario.write_text(
        '[[event]]\nat = 0.5\npendant = "clear"\n[[event]]\nat = 0.6\ndi.1 = true\npendant = "reset"\n'
        '[[event]]\nat = 0.7\npendant = "start"\n'
    )
    result = arl2rs.compile(source, scenario=scenario).run()
    assert [alarm.line for alarm in result.alarms] == [4, 3]
    with pytest.raises(arl2rs.AlarmError) as raised:
        result.check()
    assert raised.value.alarm == result.ended_by == result.alarms[1]


def test_no_scenario_is_a_word(example):
    with_it = arl2rs.compile(example / "pick_and_place.arl", scenario=example / "scenario.toml")
    without = arl2rs.compile(example / "pick_and_place.arl", scenario="none")
    assert with_it.run(scenario="none") == without.run() == arl2rs.compile(example / "pick_and_place.arl").run()
    assert with_it.run() != without.run()


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
    ran = subprocess.run(
        [sys.executable, "-m", "arl2rs", "explain", "ARL0203"], capture_output=True, text=True, check=True
    )
    assert "ARL0203" in ran.stdout
    assert (
        subprocess.run(
            [sys.executable, "-m", "arl2rs", "check", "none.arl"], check=False, capture_output=True
        ).returncode
        == 1
    )
    assert subprocess.run([sys.executable, "-m", "arl2rs", "fly"], check=False, capture_output=True).returncode == 2
