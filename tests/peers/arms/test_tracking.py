"""The motion programs of the conformance corpus against an arm with masses, limited motors and friction, in all profiles.

`ARL_ARMS=all` takes all of them, and all of weaves, compensation and stops; `ARL_ARMS_TABLE=FILE` writes what was measured.
"""

import csv
import os
import re
from pathlib import Path

import numpy as np
import pytest

from conftest import PROGRAMS, ROOT, keep_limits, streamed

CONFORMANCE = ROOT / "tests/conformance"
FOLDERS = ("motion", "weave", "compensation", "stops")
#: Those that are run each time: of every kind of motion one.
FEW = (
    "motion/blending_keeps_going",
    "motion/cir_by_angle",
    "motion/ccir_through_two_points",
    "motion/lin_with_tool",
    "motion/dura_of_ptp",
    "motion/lin_turning_about_the_tool",
    "motion/spl_rounds_off_into_lin",
)
#: How far an axis may be from its set-point, deg: what a limit of the drives would be set to.
FOLLOWS = 0.15
#: A fast stop has so many times the deceleration of the robot file (tests/conformance/stops/fast_is_shorter.arl).
FAST = 5.0
#: How far planned torques may be from MuJoCo's, as a part of what each axis needs at most.
SAME = 1e-5


def corpus():
    for folder in FOLDERS:
        for program in sorted((CONFORMANCE / folder).glob("*.arl")):
            beside = {sidecar.name.removeprefix(program.stem) for sidecar in program.parent.glob(program.stem + ".*")}
            if ".out" in beside and beside <= {".arl", ".out", ".io.toml"} and "$VEL_PROFILE" not in program.read_text():
                yield f"{folder}/{program.stem}"


ALL = os.environ.get("ARL_ARMS") == "all"
CASES = list(corpus()) if ALL else FEW


def note(*row):
    if table := os.environ.get("ARL_ARMS_TABLE"):
        with open(table, "a", newline="") as file:
            csv.writer(file).writerow(row)


def by_line(trace, off, shares):
    """The largest distance from the set-point (deg) and the largest part of the motors' torque, of each line."""
    with open(trace) as file:
        lines = [int(row["line"] or 0) for row in csv.DictReader(file)]
    worst = {}
    for line, distance, share in zip(lines, off, shares):
        before = worst.get(line, (0.0, 0.0))
        worst[line] = (max(before[0], distance), max(before[1], share))
    return worst


#: Each time O is for one of them: it is what S is.
RUNS = [(case, profile) for case in CASES for profile in ("TSO" if ALL else "TS")] + [("sweep", profile) for profile in "TSO"]


@pytest.mark.parametrize(("case", "profile"), RUNS)
def test_the_arm_follows(bench, tmp_path, case, profile):
    bench.profile(profile)
    program = PROGRAMS / "sweep.arl" if case == "sweep" else CONFORMANCE / f"{case}.arl"
    scenario = program.with_suffix(".io.toml")
    options = ["--io", scenario] if scenario.exists() else []
    peer = bench.udp(bench.arm())
    run = bench.run(peer, program, "--trace", tmp_path / "trace.csv", *options)
    assert run.code == 0, run.err
    setpoints, period = streamed(peer)
    # The torques that we planned with are those of the arm's own masses.
    commands = peer.commands
    planned = np.array([command.torque for command in commands])
    asked = np.array([peer.arm.asks(it.position, it.velocity, it.acceleration) for it in commands])
    assert np.all(np.abs(planned - asked).max(axis=0) <= SAME * peer.arm.needs)
    off = np.abs(np.array([it.position for it in commands]) - np.array(peer.actual)).max(axis=1)
    shares = (np.abs(np.array(peer.motor)) / peer.arm.limits).max(axis=1)
    for line, (distance, share) in by_line(tmp_path / "trace.csv", off, shares).items():
        note(case, profile, line, len(commands), f"{distance:.4f}", f"{share:.3f}", run.out == expected(program))
    assert off.max() < FOLLOWS, f"{off.max():.3f} deg"
    stops_fast = re.search(r"stopmove.*\bfast\b", program.read_text())
    keep_limits(setpoints, period, bench.robot, FAST if stops_fast else 1.0)
    assert peer.arm.stands


def expected(program):
    out = program.with_suffix(".out")
    return out.read_text() if out.exists() else None


def test_a_run_is_the_same_each_time(bench):
    runs = []
    for _ in range(2):
        peer = bench.udp(bench.arm())
        assert bench.run(peer, PROGRAMS / "sweep.arl").code == 0
        runs.append((peer.actual, peer.motor))
    assert all(np.array_equal(one, other) for one, other in zip(*runs))
