"""Runs programs with an arm in MuJoCo behind a driver. `ARL2RS` names the command."""

import os
import socket
import subprocess
import threading
import tomllib
from pathlib import Path

import numpy as np
import pytest

from arm import Arm
from rsi_peer import RsiPeer
from udp_peer import POWER_ON, UdpPeer

ARL2RS = os.environ.get("ARL2RS")
HERE = Path(__file__).parent
ROOT = HERE.parents[2]
ROBOT = ROOT / "arl-robot/src/robot/files/kr10-r1420.toml"
PROGRAMS = HERE / "programs"
#: No run takes so long, s.
HANGS = 120


def pytest_collection_modifyitems(items):
    if not ARL2RS:
        skipped = pytest.mark.skip(reason="ARL2RS does not name the command")
        for item in items:
            item.add_marker(skipped)


def free_port():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


class Run:
    """A run that has ended: its exit code, what it said, and the peer that the arm hangs on."""

    def __init__(self, peer, code, out, err):
        self.peer, self.code, self.out, self.err = peer, code, out, err


class Bench:
    """What tests put together: a robot file, a cell, a program, an arm and a driver."""

    def __init__(self, folder):
        self.folder = folder
        self.robot = folder / "robot.toml"
        self.text = ROBOT.read_text()

    def change(self, old, new):
        """Changes the robot file."""
        assert old in self.text, old
        self.text = self.text.replace(old, new)

    def profile(self, name):
        self.change('profile = "S"', f'profile = "{name}"')

    def arm(self, **how):
        self.robot.write_text(self.text)
        return Arm(self.robot, **how)

    def udp(self, arm, **how):
        return UdpPeer(arm, **how)

    def rsi(self, arm, **how):
        return RsiPeer(arm, free_port(), **how)

    def start(self, peer, program, *options, cell=""):
        """Starts a run; `cell` stands behind the keys of [controller]."""
        time = "robot" if peer.in_its_own_time else "world"
        if isinstance(peer, RsiPeer):
            place = f'protocol = "rsi"\nlisten = "127.0.0.1:{peer.to[1]}"'
            cycle = peer.period * 1000
        else:
            place, cycle = f'protocol = "udp"\naddress = "{peer.address}"', 1.0
        # Machines that run tests are busy: only one test is about late cycles.
        late = "" if "late_limit" in cell else "late_limit = 1000000\n"
        self.cell = self.folder / "cell.toml"
        self.cell.write_text(f'[driver]\n{place}\ntime = "{time}"\n[controller]\ncycle = {cycle}\n{late}{cell}')
        command = [
            ARL2RS, "run", str(program), "--robot", str(self.robot), "--cell", str(self.cell), "--drive",
            "--state-dir", str(self.folder / "state"), *map(str, options),
        ]
        return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)

    def run(self, peer, program, *options, cell="", after=1.0):
        process = self.start(peer, program, *options, cell=cell)
        return self.finish(peer, process, after)

    def finish(self, peer, process, after=1.0):
        # A run that hangs is one that was killed.
        watch = threading.Timer(HANGS, process.kill)
        watch.start()
        try:
            peer.serve(process, after)
            out, err = process.communicate(timeout=HANGS)
        finally:
            watch.cancel()
            process.kill()
            process.wait()
        return Run(peer, process.returncode, out, err)


@pytest.fixture
def bench(tmp_path):
    return Bench(tmp_path)


@pytest.fixture(scope="session", autouse=True)
def compiled():
    """Compiles the runtime and the programs here: that may take a minute, and no robot would wait for it."""
    if ARL2RS:
        for program in sorted(PROGRAMS.glob("*.arl")):
            subprocess.run([ARL2RS, "run", program, "--engine", "native", "--max-time", "0.001"], capture_output=True, check=False)


def keep_limits(setpoints, period, file=ROBOT, braking=1.0):
    """Rows of set-points (deg) that follow each other keep the speeds of the robot file, and so many times its accelerations."""
    axes = tomllib.loads(Path(file).read_text())["axis"][:6]
    rows = [row for row in setpoints if len(row)]
    for before, after in zip(rows, rows[1:]):
        # In between the robot had to do without: the motion has not gone on meanwhile.
        step = np.abs(np.array(after[0]) - np.array(before[-1]))
        assert np.all(step <= np.array([own["vel"] for own in axes]) * period * 1.001), step
    for row in rows:
        speed = np.diff(np.array(row).reshape(-1, 6), axis=0) / period
        acceleration = np.diff(speed, axis=0) / period
        for axis, own in enumerate(axes):
            assert np.abs(speed[:, axis]).max(initial=0.0) <= own["vel"] * 1.001, own["name"]
            assert np.abs(acceleration[:, axis]).max(initial=0.0) <= own["acc"] * braking * 1.01, own["name"]


def streamed(peer):
    """Rows of set-points (deg) until the power was cut or was off, and the length of a cycle."""
    if isinstance(peer, RsiPeer):
        return peer.setpoints, peer.period
    on = []
    for command in peer.commands:
        if command.power != POWER_ON:
            break
        on.append(command.position)
    return [on], 0.001
