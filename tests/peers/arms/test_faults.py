"""What goes wrong between controller and arm, at full speed, against both drivers. After each: the documented alarm, set-points within the
limits to the last one, an arm that stands."""

import os
import re
import signal
import struct
import threading
import time

import numpy as np
import pytest

from conftest import PROGRAMS, RsiPeer, keep_limits, streamed
from udp_peer import POWER_CUT

TURN = PROGRAMS / "turn.arl"
NO_POSITION, NOT_FOLLOWING, DRIVES, LATE = 20071, 20070, 20072, 20074


@pytest.fixture(params=["udp", "rsi"])
def driver(request):
    return request.param


def peer_of(bench, driver, arm=None, **how):
    arm = arm or bench.arm()
    return getattr(bench, driver)(arm, **how)


def goes_wrong(peer):
    """Whether the arm is in the second motion, at speed."""
    if not hasattr(peer, "wrong"):
        peer.turning = getattr(peer, "turning", False) or peer.arm.position[0] < -70
        if not (peer.turning and peer.arm.velocity[0] > 100 and abs(peer.arm.position[0]) < 30):
            return False
        peer.wrong = peer.cycles
    return True


def ends_well(run, code=0):
    """No burst, no step, and the arm stands."""
    setpoints, period = streamed(run.peer)
    keep_limits(setpoints, period)
    assert run.code == code, run.err
    assert run.peer.arm.stands, run.peer.arm.velocity


def alarms(run, *numbers):
    ends_well(run, 3)
    reported = re.search(r"alarm (\d+): .* \(turn\.arl:4\)", run.err)
    assert reported and int(reported[1]) in numbers, run.err


def test_nothing_goes_wrong(bench, driver):
    run = bench.run(peer_of(bench, driver), TURN)
    assert run.out == "done\n"
    ends_well(run)


def test_the_arm_is_not_heard_any_more(bench, driver):
    run = bench.run(peer_of(bench, driver, tamper=lambda peer, state: [] if goes_wrong(peer) else [state]), TURN)
    alarms(run, NO_POSITION)


def test_states_come_late(bench):
    """Over UDP: a message of RSI waits for its answer, so that a late one is a missing one."""
    waiting = []

    def later(peer, state):
        if not peer.cycles:
            return [state]
        waiting.append(state)
        return [waiting.pop(0)] if len(waiting) > 10 else []

    # In the time of the robot a state that is late is none; here all are, by ten cycles.
    run = bench.run(bench.udp(bench.arm(), in_its_own_time=False, tamper=later), TURN)
    ends_well(run)
    assert run.out == "done\n"


def test_states_come_twice(bench, driver):
    run = bench.run(peer_of(bench, driver, tamper=lambda peer, state: [state, state]), TURN)
    ends_well(run)


def test_states_come_out_of_order(bench, driver):
    older = []

    def swapped(peer, state):
        older.append(state)
        return [state, older[-5]] if len(older) > 5 else [state]

    run = bench.run(peer_of(bench, driver, tamper=swapped), TURN)
    ends_well(run)


def no_number(peer, state):
    if not goes_wrong(peer):
        return [state]
    if isinstance(peer, RsiPeer):
        return [re.sub(rb'A3="[^"]*"', b'A3="nan"', state, count=1)]
    return [state[:56] + struct.pack("<d", float("nan")) + state[64:]]


def test_a_position_is_no_number(bench, driver):
    alarms(bench.run(peer_of(bench, driver, tamper=no_number), TURN), NO_POSITION)


def test_states_are_damaged(bench, driver):
    def damaged(peer, data):
        return [data[:-1], data[::-1], b"", bytes(2000)] if goes_wrong(peer) else [data]

    alarms(bench.run(peer_of(bench, driver, tamper=damaged), TURN), NO_POSITION)


def test_the_position_is_frozen(bench, driver):
    def frozen(peer, state):
        if not goes_wrong(peer):
            return [state]
        if isinstance(peer, RsiPeer):
            peer.axes = getattr(peer, "axes", re.search(rb"<AIPos[^>]*>", state)[0])
            return [re.sub(rb"<AIPos[^>]*>", peer.axes, state)]
        peer.axes = getattr(peer, "axes", state[40:136])
        return [state[:40] + peer.axes + state[136:]]

    alarms(bench.run(peer_of(bench, driver, tamper=frozen), TURN), NOT_FOLLOWING)


def test_the_drives_have_a_fault(bench, driver):
    peer = peer_of(bench, driver)
    peer.on_cycle = lambda peer: peer.arm.fail("E07: over-current of axis 2") if goes_wrong(peer) else None
    run = bench.run(peer, TURN)
    alarms(run, DRIVES)
    # RSI has no words for it.
    assert driver == "rsi" or "E07: over-current of axis 2" in run.err


def test_an_emergency_stop(bench, driver, tmp_path):
    scenario = tmp_path / "stop.io.toml"
    scenario.write_text('[[event]]\nat = 1.4\npendant = "emergency_stop"\n')
    run = bench.run(peer_of(bench, driver), TURN, "--io", scenario, "--max-time", 4)
    # The program is paused, and nobody goes on with it.
    ends_well(run, 4)
    if driver == "udp":
        assert any(command.power == POWER_CUT for command in run.peer.commands)
    else:
        assert run.peer.stopped_at_speed
    assert abs(run.peer.arm.position[0]) < 79


def test_motors_that_are_too_weak(bench, driver):
    # They give less than half of what the accelerations of all axes ask for. And a limit for the distance that drives of their kind have.
    bench.text = bench.text.replace('name = "j1"', 'name = "j1"\nfollowing = 2.0')
    # From there all axes have far to go.
    bench.change("home = [0, -90, 90, 0, 90, 0]", "home = [0, 0, 0, 0, 0, 0]")
    alarm = bench.run(peer_of(bench, driver, bench.arm(torque_share=0.35)), TURN)
    assert alarm.code == 3 and f"alarm {NOT_FOLLOWING}" in alarm.err, alarm.err
    assert "j1 is 2." in alarm.err and alarm.peer.arm.stands
    keep_limits(*streamed(alarm.peer))


# What follows is about the time of the world.


class AtSpeed(threading.Thread):
    """Does something to a process when its arm is at speed."""

    def __init__(self, peer, act):
        super().__init__(daemon=True)
        self.peer, self.act = peer, act

    def run(self):
        while not goes_wrong(self.peer):
            time.sleep(0.001)
        self.act()


def in_the_world(bench, driver, act, cell=""):
    peer = peer_of(bench, driver, in_its_own_time=False)
    process = bench.start(peer, TURN, cell=cell)
    AtSpeed(peer, lambda: act(peer, process)).start()
    return bench.finish(peer, process)


def test_the_link_is_dead(bench, driver):
    """Nothing comes through any more, in either direction: the arm brakes by itself."""

    def cut(peer, _):
        peer.take = lambda *_: None
        peer.tamper = lambda *_: []

    run = in_the_world(bench, driver, cut)
    assert run.code == 3 and f"alarm {NO_POSITION}" in run.err, run.err
    assert run.peer.arm.stands
    keep_limits(*streamed(run.peer))


def test_the_controller_is_stopped_for_100_ms(bench, driver):
    def stop(_, process):
        process.send_signal(signal.SIGSTOP)
        time.sleep(0.1)
        process.send_signal(signal.SIGCONT)

    run = in_the_world(bench, driver, stop, cell="late_limit = 20\n")
    if driver == "udp":
        # What was lost is not made up for.
        came = np.array([command.at for command in run.peer.commands])
        back = came[np.argmax(np.diff(came)) + 1]
        assert np.sum((came >= back) & (came < back + 0.02)) <= 42
    # The arm has braked, or the controller found first that it had been away.
    assert run.code == 3 and re.search(rf"alarm ({DRIVES}|{LATE}|{NOT_FOLLOWING}|{NO_POSITION})", run.err), run.err
    assert run.peer.arm.stands
    keep_limits(*streamed(run.peer))


def test_the_controller_is_killed(bench, driver):
    run = in_the_world(bench, driver, lambda _, process: os.kill(process.pid, signal.SIGKILL))
    assert run.code == -signal.SIGKILL
    assert run.peer.arm.stands
    keep_limits(*streamed(run.peer))


def test_no_arm_is_there(bench):
    """Over UDP: for RSI a run waits 30 s."""
    peer = bench.udp(bench.arm())
    peer.take = lambda *_: None
    run = bench.run(peer, TURN)
    assert run.code == 2 and re.search(r"no arm answers at 127.0.0.1:\d+: no valid answer within 3 s", run.err), run.err
