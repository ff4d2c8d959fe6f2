"""The arm's side of the packets over UDP, docs/udp-and-rsi.md, with an arm in MuJoCo behind it."""

import socket
import struct
import time
from dataclasses import dataclass, field

import numpy as np

COMMAND = struct.Struct("<4sHBBIIQII12d12d6d6d")
STATE = struct.Struct("<4sHBBIIQQII12d12d6d64s")
OFF, ON, FAULT = 0, 1, 2
POWER_OFF, POWER_ON, POWER_CUT = 0, 1, 2
CYCLIC, TORQUE = 1, 2
#: Without a set-point for so long the arm brakes, s.
WATCHDOG = 0.05
#: Before the first set-point motors that are on go off after so long, s.
IDLE = 10.0


@dataclass
class Command:
    session: int
    power: int
    sequence: int
    period: float
    cyclic: bool
    position: np.ndarray
    velocity: np.ndarray
    acceleration: np.ndarray
    torque: np.ndarray | None
    at: float = field(default_factory=time.monotonic)

    @staticmethod
    def parse(data):
        if len(data) != COMMAND.size:
            return None
        magic, version, _own, _external, session, power, sequence, period, flags, *numbers = COMMAND.unpack(data)
        if magic != b"ARLC" or version != 1:
            return None
        position, velocity, acceleration, torque = (np.array(part) for part in (numbers[:6], numbers[12:18], numbers[24:30], numbers[30:36]))
        return Command(
            session, power, sequence, period * 1e-6, bool(flags & CYCLIC), position, velocity, acceleration,
            torque if flags & TORQUE else None,
        )


class UdpPeer:
    """Answers each command; `tamper` may change, delay, double or drop what is said: it gets a state's bytes and gives a list."""

    def __init__(self, arm, in_its_own_time=True, tamper=None):
        self.arm = arm
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.bind(("127.0.0.1", 0))
        self.address = "127.0.0.1:%d" % self.socket.getsockname()[1]
        self.in_its_own_time = in_its_own_time
        self.tamper = tamper
        self.commands, self.actual, self.motor = [], [], []
        self.sent = 0
        self.session, self.before = None, None
        self.highest = 0
        self.cycles = 0
        self.newest = None
        self.on_cycle = None

    def state(self):
        arm = self.arm
        self.sent += 1
        drives = FAULT if arm.fault else ON if arm.power else OFF
        text = arm.fault.encode()[:64]
        zeros = [0.0] * 6
        return STATE.pack(
            b"ARLS", 1, 6, 0, self.session or 0, drives, self.sent, self.highest, 3, len(text),
            *arm.position, *zeros, *arm.velocity, *zeros, *arm.motor_torque, text.ljust(64, b"\0"),
        )

    def take(self, data, sender):
        command = Command.parse(data)
        if command is None:
            return
        if command.session != self.session:
            if not self.may_begin(command):
                return
            self.before, self.session, self.highest, self.newest = self.session, command.session, 0, None
        if command.sequence <= self.highest:
            return
        self.highest, self.newest = command.sequence, command
        self.arm.switch(command.power == POWER_ON)
        if command.cyclic:
            self.cycles += 1
            self.commands.append(command)
            if self.on_cycle:
                self.on_cycle(self)
            if self.in_its_own_time:
                self.arm.follow(command.position, command.period, command.torque)
                self.note()
        self.say(sender)

    def may_begin(self, command):
        """Whether a command may begin another run: the one before has ended, and this one begins with the motors off."""
        if command.cyclic or command.power != POWER_OFF or command.session == self.before:
            return False
        is_used = self.newest is not None and time.monotonic() - self.newest.at < WATCHDOG
        return self.arm.stands and not is_used

    def say(self, sender):
        state = self.state()
        for packet in self.tamper(self, state) if self.tamper else [state]:
            self.socket.sendto(packet, sender)

    def note(self):
        self.actual.append(self.arm.position)
        self.motor.append(self.arm.motor_torque)

    def serve(self, process, after=0.3):
        """Until the process has ended, and for some time of the arm after it."""
        if self.in_its_own_time:
            self.socket.settimeout(0.05)
            while process.poll() is None:
                try:
                    self.take(*self.socket.recvfrom(2048))
                except TimeoutError:
                    pass
            self.arm.switch(False)
            self.arm.rest(after)
            return
        self._serve_in_real_time(process, after)

    def _serve_in_real_time(self, process, after):
        """The arm's time is the world's: it follows the newest set-point, and brakes where none comes any more."""
        self.socket.setblocking(False)
        at, until = time.monotonic(), None
        while until is None or time.monotonic() < until:
            if until is None and process.poll() is not None:
                until = time.monotonic() + after
            self._receive()
            now = time.monotonic()
            while at + 0.001 <= now:
                at += 0.001
                command = self.newest
                if command and not command.cyclic and now - command.at > IDLE:
                    self.arm.switch(False)
                if command and command.cyclic and self.arm.power and now - command.at > WATCHDOG:
                    self.arm.fail("no set-points")
                if command and command.cyclic and self.arm.power:
                    self.arm.follow(command.position, 0.001, command.torque)
                    self.note()
                else:
                    self.arm.rest(0.001)
            time.sleep(0.0002)

    def _receive(self):
        while True:
            try:
                self.take(*self.socket.recvfrom(2048))
            except BlockingIOError:
                return
