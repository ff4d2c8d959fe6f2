"""The same programs through RSI, in cycles of 4 ms and of 12 ms, in all profiles."""

import numpy as np
import pytest

from conftest import PROGRAMS, ROOT, keep_limits, streamed

CASES = [PROGRAMS / "sweep.arl", ROOT / "tests/conformance/motion/spl_rounds_off_into_lin.arl"]


@pytest.mark.parametrize("profile", "TSO")
@pytest.mark.parametrize("period", [0.004, 0.012])
@pytest.mark.parametrize("program", CASES, ids=lambda program: program.stem)
def test_the_arm_follows(bench, program, period, profile):
    bench.profile(profile)
    peer = bench.rsi(bench.arm(), period=period)
    run = bench.run(peer, program)
    assert run.code == 0, run.err
    setpoints, period = streamed(peer)
    (setpoints,) = [row for row in setpoints if row]
    off = np.abs(np.array(setpoints) - np.array(peer.actual)[-len(setpoints) :]).max()
    assert off < 0.3, f"{off:.3f} deg"
    keep_limits([setpoints], period, bench.robot)
    # All messages were answered, but those before the controller was there, and the last one tells to stop.
    assert peer.stopped and peer.arm.stands


def test_another_cycle_is_refused(bench):
    peer = bench.rsi(bench.arm(), period=0.012)
    process = bench.start(peer, CASES[0])
    text = bench.cell.read_text().replace("cycle = 12.0", "cycle = 4.0")
    bench.cell.write_text(text)
    run = bench.finish(peer, process)
    assert run.code == 2 and "the robot has cycles of 12 ms, but the cell has 4 ms: set `cycle = 12`" in run.err, run.err
