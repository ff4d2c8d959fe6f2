"""Sweeps on this computer."""

import _thread
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
    serial = arl2rs.sweep(example / "pick_and_place.arl", ROWS, scenario=example / "scenario.toml", processes=1, cache=False)
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
    assert ["pich" in results[0]["problem"], "nobody" in results[1]["problem"], "speed" in results[2]["problem"]] == [True] * 3


def test_mistakes_are_told_before_anything_runs(tmp_path, example):
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
