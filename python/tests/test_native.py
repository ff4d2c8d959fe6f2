"""The engine and native code do the same, and the engine needs nothing but Python."""

import os
import subprocess
import sys
import textwrap

import numpy as np

import arl2rs


def test_native_code_and_the_engine_give_the_same(short):
    runs = [arl2rs.compile(short, native=native).run(watch=["do.1"]) for native in (False, True)]
    engine, native = (run.trace for run in runs)
    assert runs[0].output == runs[1].output and runs[0].cycle_time == runs[1].cycle_time
    assert len(engine.t) > 100
    assert engine.to_pandas().equals(native.to_pandas())


def test_steps_of_both_are_the_same(short):
    seen = []
    for native in (False, True):
        with arl2rs.compile(short, native=native).session(watch=["do.1"]) as session:
            seen.append([session.step(50).copy() for _ in range(20)])
    assert np.array_equal(seen[0], seen[1], equal_nan=True)


def test_nothing_but_python_is_needed(short, tmp_path):
    script = """
        import sys, arl2rs
        program = arl2rs.compile(sys.argv[1])
        result = program.run(seed=3).check()
        assert result.motions > 0, result
        rows = arl2rs.grid({"override": [50, 100]})
        results = program.sweep(rows, cache=False, progress=False)
        assert [row["outcome"] for row in results] == ["ended", "ended"], list(results)
        program.record("run.mcap")
        with program.session() as session:
            session.step(10)
    """
    environment = {name: value for name, value in os.environ.items() if name not in ("PATH", "CARGO", "RUSTC")}
    environment |= {"PATH": str(tmp_path), "ARL2RS_CACHE": str(tmp_path / "cache")}
    command = [sys.executable, "-c", textwrap.dedent(script), str(short)]
    ran = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True, check=False)
    assert ran.returncode == 0, ran.stderr
    assert (tmp_path / "run.mcap").stat().st_size > 1000
    command = [sys.executable, "-m", "arl2rs", "test", "."]
    (tmp_path / "a.arl").write_text("func void main()\n  print 1\nendfunc\n")
    (tmp_path / "a.out").write_text("1\n")
    ran = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True, check=False)
    assert (ran.returncode, ran.stdout.splitlines()[-1]) == (0, "1 passed, 0 failed"), ran.stdout + ran.stderr
