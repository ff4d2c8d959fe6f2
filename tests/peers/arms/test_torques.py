"""Torques and contacts: what programs see of them, against what MuJoCo computes and simulates."""

import numpy as np
import pytest

from arm import Payload
from conftest import PROGRAMS

LOAD = Payload(5.0, (0.02, -0.01, 0.08), (0.02, 0.02, 0.02))


def test_the_torques_that_programs_see(bench):
    """`cjttq` as commanded is what MuJoCo's inverse dynamics ask for, as measured what its motors give: to 1 % of the largest."""
    peer = bench.udp(bench.arm(payload=LOAD))
    cell = f'[[channel]]\nprogram = "{PROGRAMS / "watch.arl"}"\nbackground = true\n'
    run = bench.run(peer, PROGRAMS / "torques.arl", cell=cell)
    assert run.code == 0, run.err
    printed = np.array([[float(word) for word in line.split()] for line in run.out.splitlines()])
    assert printed.shape[0] > 80
    asked = np.array([peer.arm.asks(it.position, it.velocity, it.acceleration) for it in peer.commands])
    largest = np.abs(asked).max(axis=0)
    given = np.array(peer.motor)
    # The robot moved meanwhile: each axis needed much of what it needs at most.
    assert np.all(np.ptp(printed[:, :6], axis=0) > 0.5 * largest)
    for found, computed in (printed[:, :6], asked), (printed[:, 6:], given):
        off = [best(row, computed, largest) for row in found]
        assert max(part for _, part in off) < 0.01, off
        # Ten cycles from one to the next.
        assert np.all(np.diff([cycle for cycle, _ in off][:60]) >= 10)


def best(row, computed, largest):
    """The cycle whose torques are next to these, and how far off they are, as a part of the largest."""
    off = (np.abs(computed - row) / largest).max(axis=1)
    cycle = int(off.argmin())
    return cycle, off[cycle]


WALL = ((0.9766, 0.0, 1.0234), (0.02, 0.3, 0.3))


@pytest.mark.parametrize("driver", ["udp", "rsi"])
def test_a_wall_is_a_collision(bench, driver):
    # It stands behind where the robot begins.
    bench.change("home = [0, -90, 90, 0, 90, 0]", "home = [0, -90, 90, 0, 45, 0]")
    peer = getattr(bench, driver)(bench.arm(obstacle=WALL))
    run = bench.run(peer, PROGRAMS / "touch.arl")
    assert run.code == 3 and "touch.arl:7" in run.err, run.err
    assert peer.arm.stands
    # The flange did not go on against the wall as far as the line goes.
    assert "touched nothing" not in run.out


@pytest.mark.parametrize("driver", ["udp", "rsi"])
def test_no_wall_is_no_collision(bench, driver):
    """Friction, and motors that work at their limits, are none."""
    run = bench.run(getattr(bench, driver)(bench.arm()), PROGRAMS / "touch.arl")
    assert (run.code, run.out) == (0, "touched nothing\n"), run.err
