"""A robot controller that speaks RSI as KUKA documents it, with an arm in MuJoCo behind it: it sends its axes each cycle, and takes
corrections from where RSI began in the answer with the same IPOC."""

import re
import socket
import time

import numpy as np

#: After so many cycles in a row without an answer the robot brakes.
LATE_LIMIT = 10
CORRECTION = re.compile(rb'<AK A1="([^"]*)" A2="([^"]*)" A3="([^"]*)" A4="([^"]*)" A5="([^"]*)" A6="([^"]*)"/>')
IPOC = re.compile(rb"<IPOC>(\d+)</IPOC>")
STOP = re.compile(rb"<Stop>([01])</Stop>")


class RsiPeer:
    def __init__(self, arm, port, period=0.004, in_its_own_time=True, tamper=None):
        self.arm = arm
        self.period = period
        self.to = ("127.0.0.1", port)
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.in_its_own_time = in_its_own_time
        self.tamper = tamper
        self.ipoc = 1000
        self.late, self.in_a_row = 0, 0
        self.cycles = 0
        self.setpoints, self.actual, self.motor = [[]], [], []
        self.stopped, self.stopped_at_speed = False, False
        self.on_cycle = None
        arm.switch(True)
        self.origin = arm.position
        self.correction = np.zeros(6)

    def message(self):
        arm = self.arm
        self.ipoc += round(self.period * 1000)
        axes = " ".join(f'A{axis}="{value:.6f}"' for axis, value in enumerate(arm.position, 1))
        torque = " ".join(f'A{axis}="{value:.4f}"' for axis, value in enumerate(arm.motor_torque, 1))
        ready = int(arm.power)
        return (
            f'<Rob Type="KUKA"><AIPos {axes}/><Torque {torque}/><Delay D="{self.late}"/><Ready>{ready}</Ready>'
            f"<IPOC>{self.ipoc}</IPOC></Rob>"
        ).encode()

    def send(self):
        message = self.message()
        for packet in self.tamper(self, message) if self.tamper else [message]:
            self.socket.sendto(packet, self.to)

    def answer(self, limit):
        """Waits for the answer to the newest message."""
        until = time.monotonic() + limit
        while (left := until - time.monotonic()) > 0:
            self.socket.settimeout(left)
            try:
                data = self.socket.recv(2048)
            except (TimeoutError, ConnectionRefusedError):
                return False
            ipoc, correction, stop = IPOC.search(data), CORRECTION.search(data), STOP.search(data)
            if not (ipoc and correction and stop) or int(ipoc[1]) != self.ipoc:
                continue
            self.correction = np.array([float(value) for value in correction.groups()])
            if stop[1] == b"1" and not self.stopped:
                self.stopped, self.stopped_at_speed = True, not self.arm.stands
            return True
        return False

    def cycle(self, limit):
        if self.stopped:
            # RSI has ended.
            self.arm.switch(False)
            self.arm.rest(self.period)
            time.sleep(0.001)
            return
        self.send()
        answered = self.answer(limit)
        self.in_a_row = 0 if answered else self.in_a_row + 1
        self.late += not answered
        self.cycles += 1
        if self.on_cycle:
            self.on_cycle(self)
        if (self.stopped or self.in_a_row > LATE_LIMIT) and self.arm.power:
            self.arm.switch(False)
        target = self.origin + self.correction
        if self.arm.power:
            # What is answered without a gap: in between the robot had to do without.
            if not answered and self.setpoints[-1]:
                self.setpoints.append([])
            if answered:
                self.setpoints[-1].append(target)
            self.arm.follow(target, self.period)
            self.actual.append(self.arm.position)
            self.motor.append(self.arm.motor_torque)
        else:
            self.arm.rest(self.period)

    def begin(self):
        """RSI begins when somebody listens."""
        self.late, self.in_a_row, self.cycles = 0, 0, 0

    def serve(self, process, after=0.3):
        begun = False
        at = time.monotonic()
        while process.poll() is None:
            if self.in_its_own_time:
                # At first nobody listens yet; then each message is answered.
                before = self.late
                self.cycle(0.5 if begun else 0.02)
                begun |= self.late == before
                if not begun:
                    self.begin()
            else:
                self.cycle(self.period)
                begun |= self.in_a_row == 0
                if not begun:
                    self.begin()
                at = max(at + self.period, time.monotonic() - 0.02)
                time.sleep(max(0.0, at - time.monotonic()))
        self.arm.switch(False)
        self.arm.rest(after)
