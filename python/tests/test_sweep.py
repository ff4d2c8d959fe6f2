"""Sweeps on this computer."""

import _thread
import subprocess
import sys
import threading

import pandas
import polars
import pyarrow.parquet
import pytest

import arl2rs

ROWS = arl2rs.grid({"global.pitch": [80, 2000], "override": [50, 100]})


def test_a_table_comes_back_in_its_order(example):
    results = arl2rs.sweep(example / "pick_and_place.arl", ROWS, scenario=example / "scenario.toml")
    assert [row["parameters"] for row in results] == ROWS
    assert [row["outcome"] for row in results] == ["ended", "ended", "alarm", "alarm"]
    assert results[2]["alarms"][0]["line"] == 42
    assert results.best()["run"] == 2 and repr(results) == "Results(4 runs: 2 alarm, 2 ended)"
    frame = results.to_pandas()
    assert list(frame["global.pitch"]) == [80, 80, 2000, 2000] and list(frame["alarm_line"].dropna()) == [42, 42]
    assert results.to_polars()["outcome"].to_list() == ["ended", "ended", "alarm", "alarm"]
    serial = arl2rs.sweep(
        example / "pick_and_place.arl", ROWS, scenario=example / "scenario.toml", processes=1, cache=False
    )
    assert serial.lines == results.lines


def test_a_row_is_what_a_run_says(program):
    [row] = program.sweep([{"global.pitch": 100}])
    result = program.run(globals={"pitch": 100})
    assert (row["cycle_time"], row["moving"], row["way"], row["motions"]) == (
        result.cycle_time,
        result.moving,
        result.way,
        result.motions,
    )
    assert "\n".join(row["output"]) + "\n" == result.output


def test_the_file_of_a_sweep_is_that_of_the_command(example, tmp_path, capfd):
    table = example / "sweep.toml"
    table.write_text('program = "pick_and_place.arl"\nio = "scenario.toml"\n[grid]\n"global.pitch" = [80, 100.5]\n')
    settings, rows = arl2rs.load_sweep(table)
    assert rows == [{"global.pitch": 80}, {"global.pitch": 100.5}]
    results = arl2rs.sweep(**settings, rows=rows)
    from arl2rs.__main__ import command

    assert command(["arl2rs", "sweep", str(table), "-o", str(tmp_path / "r.parquet")]) == 0
    assert capfd.readouterr().out.splitlines() == results.lines
    parquet = pyarrow.parquet.read_table(tmp_path / "r.parquet").to_pandas()
    for column in (
        "run",
        "global.pitch",
        "outcome",
        "code",
        "cycle_time",
        "moving",
        "standing",
        "motions",
        "way",
        "output",
    ):
        assert list(parquet[column]) == list(results.to_pandas()[column]), column
    assert parquet["alarm_number"].isna().all()
    assert len(polars.read_parquet(tmp_path / "r.parquet")) == len(pandas.DataFrame(results.flat()))


def test_runs_look_for_collisions_where_that_is_asked_for(short, tmp_path):
    cell = tmp_path / "cell.toml"
    cell.write_text('[[body]]\nname = "post"\ncylinder = [100, 3000]\nat = [9000, 0, 0]\n')
    rows = [{}, {"cell.body.1.at": [600, 0, 0]}]
    results = arl2rs.sweep(short, rows, cell=cell, collisions=True)
    assert results[0]["collisions"] == []
    first = results[1]["collisions"][0]
    assert "post" in first["bodies"] and first["distance"] == 0 and first["file"] == "short.arl" and first["line"] > 0
    frame = results.to_pandas()
    assert list(frame["collisions"]) == [0, len(results[1]["collisions"])]
    assert frame["collision_bodies"][1] == ", ".join(first["bodies"]) and frame["collision_time"][1] == first["time"]
    assert arl2rs.sweep(short, rows, cell=cell, clearance=10_000)[0]["collisions"][0]["distance"] > 0
    assert "collisions" not in arl2rs.sweep(short, rows, cell=cell)[0]
    with pytest.raises(arl2rs.RefusedError, match="clearance"):
        arl2rs.sweep(short, rows, cell=cell, clearance=float("nan"))


def test_what_cannot_begin_has_a_row(example):
    with pytest.raises(arl2rs.RefusedError, match="there is no parameter `pitch`"):
        arl2rs.sweep(example / "pick_and_place.arl", [{"pitch": 1}, {"pitch": 2}])
    results = arl2rs.sweep(example / "pick_and_place.arl", [{"global.pich": 1}, {"robot": "nobody"}, {"speed": 1}])
    with pytest.raises(arl2rs.ArlError, match="pich"):
        results.best()
    with pytest.raises(arl2rs.RefusedError, match="speed2"):
        results.plot("speed2")
    assert [row["outcome"] for row in results] == ["refused"] * 3
    assert ["pich" in results[0]["problem"], "nobody" in results[1]["problem"], "speed" in results[2]["problem"]] == [
        True
    ] * 3


def test_a_slip_in_all_rows_is_refused_at_once(example):
    for rows in ([{"global.pich": 1}, {"global.pich": 2}], arl2rs.grid({"global.pich": [1, 2], "override": [50, 100]})):
        with pytest.raises(arl2rs.RefusedError, match="there is no global variable `pich`: did you mean `pitch`"):
            arl2rs.sweep(example / "pick_and_place.arl", rows)
    results = arl2rs.sweep(example / "pick_and_place.arl", [{"global.pich": 1}, {"global.pitch": 80, "max_time": 1}])
    assert [row["outcome"] for row in results] == ["refused", "time_over"]


def test_rows_are_frames(short):
    rows = [{"global.parts": 2, "override": 50}, {"global.parts": 3}]
    expected = arl2rs.sweep(short, rows)
    for frame in (pandas.DataFrame(rows), polars.DataFrame(rows)):
        results = arl2rs.sweep(short, frame)
        assert results.lines == expected.lines
    # Whole numbers with gaps are floats in pandas.
    gaps = arl2rs.sweep(short, pandas.DataFrame([{"global.parts": 2}, {"override": 50}]))
    assert [row["outcome"] for row in gaps] == ["ended", "ended"] and gaps[0]["parameters"] == {"global.parts": 2}
    with pytest.raises(arl2rs.RefusedError, match="a list of dictionaries"):
        arl2rs.sweep(short, {"override": 50})


def test_names_are_those_of_python_and_the_command_s_are_taken(example):
    file, scenario = example / "pick_and_place.arl", example / "scenario.toml"
    ours = {"max_time": 2, "scenario": scenario, "scenario.event.1.at": 0.5, "start_time": "2026-11-28T12:00:00"}
    theirs = {"max-time": 2, "io": scenario, "io.event.1.at": 0.5, "start-time": "2026-11-28T12:00:00"}
    one, other = (arl2rs.sweep(file, [row]) for row in (ours, theirs))
    assert one.lines == other.lines and one[0]["outcome"] == "time_over"
    assert list(one[0]["parameters"]) == list(ours) and list(other[0]["parameters"]) == list(theirs)
    with pytest.raises(arl2rs.RefusedError, match="max-time is given twice"):
        arl2rs.sweep(file, [{"max_time": 2, "max-time": 3}])
    program = arl2rs.compile(file, scenario=scenario)
    runs = [
        program.run(set={place: 0.5}, max_time=2, trace=False) for place in ("scenario.event.1.at", "io.event.1.at")
    ]
    assert runs[0] == runs[1]
    (example / "names.toml").write_text('program = "pick_and_place.arl"\n[[run]]\nio = "scenario.toml"\nmax-time = 2\n')
    _, rows = arl2rs.load_sweep(example / "names.toml")
    assert list(rows[0]) == ["scenario", "max_time"]


def test_without_a_bar_a_message_says_what_takes_long(tmp_path):
    code = """
import time, arl2rs
from arl2rs import notice, sweeps
notice.PATIENCE_S = 0.05
sweeps.PROGRESS_S = 0.0
arl2rs.sweep("new.arl", [{"seed": 1}, {"seed": 2}], cache=False, native=True)
"""
    (tmp_path / "new.arl").write_text("func void main()\n    print rand()\nendfunc\n")
    shown = subprocess.run(
        [sys.executable, "-P", "-c", code], cwd=tmp_path, capture_output=True, text=True, check=True
    ).stderr
    assert "arl2rs: compiling new.arl for 2 runs" in shown and "arl2rs: 2 of 2 runs" in shown


def test_a_notebook_without_widgets_is_no_warning():
    # What tqdm looks at to find out whether it is in a notebook.
    code = """
import sys, types, warnings
warnings.simplefilter("error")
shell = types.SimpleNamespace(config={"IPKernelApp": {}})
sys.modules["IPython"] = types.SimpleNamespace(get_ipython=lambda: shell)
sys.modules["ipywidgets"] = None
import tqdm, arl2rs.sweeps
"""
    subprocess.run([sys.executable, "-P", "-c", code], check=True)


def test_mistakes_are_reported_before_anything_runs(tmp_path, example):
    wrong = tmp_path / "wrong.arl"
    wrong.write_text("func void main()\n    movej 5\nendfunc\n")
    with pytest.raises(arl2rs.CompileError):
        arl2rs.sweep(wrong, [{}])
    with pytest.raises(arl2rs.ArlError, match=r"none\.toml"):
        arl2rs.sweep(example / "pick_and_place.arl", [{}], scenario="none.toml")
    with pytest.raises(ValueError, match="cloud"):
        arl2rs.sweep(example / "pick_and_place.arl", [{}], engine="cloud")
    assert len(arl2rs.sweep(example / "pick_and_place.arl", [])) == 0


def test_ctrl_c_ends_a_sweep(tmp_path):
    source = tmp_path / "endless.arl"
    source.write_text("func void main()\n    while(true)\n    endwhile\nendfunc\n")
    arl2rs.sweep(source, [{}], max_time=0.1)
    threading.Timer(0.5, _thread.interrupt_main).start()
    with pytest.raises(KeyboardInterrupt):
        arl2rs.sweep(source, [{"seed": seed} for seed in range(4)], max_time=1e9, cache=False)
