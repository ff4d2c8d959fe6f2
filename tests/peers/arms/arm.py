"""A six-axis arm in MuJoCo, built from a robot file of arl2rs: its masses, motors with limited torques, friction, brakes.

Nothing of arl2rs computes here: geometry and masses are read from the TOML file, as docs/robots-and-cells.md describes
them, and MuJoCo does the rest. All inner numbers are rad, Nm, kg, m; what goes in and out is in deg.
"""

import tomllib
from dataclasses import dataclass

import mujoco
import numpy as np

AXES = 6
GRAVITY = 9.81
#: The length of a step of the physics, s.
STEP = 0.001
#: What the position loops are tuned to, rad/s, and how soon a lasting error is made up for, s.
BANDWIDTH = 100.0
INTEGRAL_TIME = 0.05
#: Motors are larger than the largest torque that an axis needs while all of them accelerate.
RESERVE = 1.2
#: Friction of the gears, as parts of the largest torque: dry, and viscous at full speed.
DRY, VISCOUS = 0.02, 0.02
#: A brake holds so many times what a motor gives.
BRAKE = 1.2
#: Slower than this a brake grips, rad/s.
GRIPS = 0.02
#: Slower than this an axis stands, deg/s.
STANDS = 0.05


@dataclass
class Payload:
    """What the flange carries: kg, m in the flange's frame, kg m2 about the centre of mass."""

    mass: float
    centre: tuple = (0.0, 0.0, 0.0)
    inertia: tuple = (1e-6, 1e-6, 1e-6)


def model_of(robot, payload=None, obstacle=None):
    """The MJCF text of a robot file (a dict), whose joints have the inner angles of the OPW geometry."""
    geometry = robot["geometry"]
    metres = {key: geometry[key] / 1000.0 for key in ("a1", "a2", "b", "c1", "c2", "c3", "c4")}
    places = [
        (0.0, 0.0, metres["c1"]),
        (metres["a1"], metres["b"], 0.0),
        (0.0, 0.0, metres["c2"]),
        (metres["a2"], 0.0, metres["c3"]),
        (0.0, 0.0, 0.0),
        (0.0, 0.0, 0.0),
    ]
    turns = ["0 0 1", "0 1 0", "0 1 0", "0 0 1", "0 1 0", "0 0 1"]
    body, ends = "", ""
    for axis, (link, place, turn) in enumerate(zip(robot["link"], places, turns), 1):
        xx, xy, xz, yy, yz, zz = (value * 1e-6 for value in link["inertia"])
        com = " ".join(repr(value / 1000.0) for value in link["com"])
        body += (
            f'<body name="link{axis}" pos="{" ".join(map(repr, place))}">'
            f'<inertial pos="{com}" mass="{link["mass"]!r}" fullinertia="{xx!r} {yy!r} {zz!r} {xy!r} {xz!r} {yz!r}"/>'
            f'<joint name="j{axis}" type="hinge" axis="{turn}" frictionloss="1"/>'
        )
        ends += "</body>"
    flange = f'<body name="flange" pos="0 0 {metres["c4"]!r}">'
    if payload:
        flange += (
            f'<inertial pos="{" ".join(map(repr, payload.centre))}" mass="{payload.mass!r}" '
            f'diaginertia="{" ".join(map(repr, payload.inertia))}"/>'
        )
    # The hand that can touch something.
    flange += '<geom type="sphere" size="0.04" mass="0" contype="1" conaffinity="2"/>'
    if not payload:
        flange += '<inertial pos="0 0 0" mass="1e-9" diaginertia="1e-9 1e-9 1e-9"/>'
    flange += "</body>"
    wall = ""
    if obstacle:
        at, size = obstacle
        wall = (
            f'<geom name="wall" type="box" pos="{" ".join(map(repr, at))}" size="{" ".join(map(repr, size))}" '
            'contype="2" conaffinity="1" solref="0.005 1"/>'
        )
    return (
        f'<mujoco><option timestep="{STEP}" gravity="0 0 {-GRAVITY}" integrator="implicitfast">'
        f'<flag energy="disable"/></option><compiler angle="radian" balanceinertia="false" inertiafromgeom="false"/>'
        f"<worldbody>{wall}{body}{flange}{ends}</worldbody></mujoco>"
    )


class Arm:
    """The arm and its drives: they follow set-points while they are on; while they are off brakes hold it."""

    def __init__(self, file, payload=None, obstacle=None, torque_share=1.0):
        with open(file, "rb") as opened:
            self.robot = tomllib.load(opened)
        self.signs = np.array(self.robot["geometry"]["signs"], float)
        self.offsets = np.radians(np.array(self.robot["geometry"]["offsets"], float))
        self.model = mujoco.MjModel.from_xml_string(model_of(self.robot, payload, obstacle))
        self.data = mujoco.MjData(self.model)
        self.scratch = mujoco.MjData(self.model)
        self.axes = self.robot["axis"][:AXES]
        self.speeds = np.radians([axis["vel"] for axis in self.axes])
        self.needs = self._needs()
        self.limits = self.needs * RESERVE * torque_share
        self.model.dof_frictionloss[:] = self.needs * DRY
        self.held = np.full(AXES, np.nan)
        self.model.dof_damping[:] = self.needs * VISCOUS / self.speeds
        self.power, self.fault = False, ""
        self.sum = np.zeros(AXES)
        self.torque = np.zeros(AXES)
        self.reference = np.zeros(AXES)
        self.speed_before = np.zeros(AXES)
        self.place(self.robot.get("home", [0.0] * AXES)[:AXES])
        self._brake()

    def _needs(self):
        """The largest torque that each axis needs while all axes accelerate as they may, of many positions."""
        random = np.random.default_rng(1)
        low = np.array([axis["min"] for axis in self.axes])
        high = np.array([axis["max"] for axis in self.axes])
        accelerations = np.radians([axis["acc"] for axis in self.axes])
        most = np.zeros(AXES)
        matrix = np.zeros((AXES, AXES))
        for position in random.uniform(low, high, (500, AXES)):
            self.scratch.qpos[:] = self.inner(position)
            self.scratch.qvel[:] = 0.0
            mujoco.mj_forward(self.model, self.scratch)
            mujoco.mj_fullM(self.model, self.scratch, matrix)
            most = np.maximum(most, np.abs(self.scratch.qfrc_bias) + np.abs(matrix) @ accelerations)
        return most

    def inner(self, axes):
        """The joints' own angles (rad) of axes in deg."""
        return np.radians(np.array(axes, float)) * self.signs - self.offsets

    def outer(self, inner):
        """Axes in deg."""
        return np.degrees((inner + self.offsets) * self.signs)

    def place(self, axes):
        """Puts the arm somewhere, deg."""
        self.data.qpos[:] = self.inner(axes)
        self.data.qvel[:] = 0.0
        self.reference[:] = self.data.qpos
        mujoco.mj_forward(self.model, self.data)

    @property
    def position(self):
        """deg."""
        return self.outer(self.data.qpos)

    @property
    def velocity(self):
        """deg/s."""
        return np.degrees(self.data.qvel * self.signs)

    @property
    def motor_torque(self):
        """What the motors give at the axes, Nm, in the sense of the axes."""
        return self.torque * self.signs

    @property
    def stands(self):
        return bool(np.all(np.abs(self.velocity) < STANDS))

    def asks(self, axes, speeds, accelerations):
        """What MuJoCo's inverse dynamics ask for, without friction: Nm; deg, deg/s, deg/s2."""
        scratch = self.scratch
        scratch.qpos[:] = self.inner(axes)
        scratch.qvel[:] = np.radians(speeds) * self.signs
        mujoco.mj_forward(self.model, scratch)
        matrix = np.zeros((AXES, AXES))
        mujoco.mj_fullM(self.model, scratch, matrix)
        return (matrix @ (np.radians(accelerations) * self.signs) + scratch.qfrc_bias) * self.signs

    def switch(self, on):
        if on and not self.power and not self.fault:
            self.power = True
            self.sum[:] = 0.0
            self.reference[:] = self.data.qpos
            self.speed_before[:] = 0.0
            self.held[:] = np.nan
        elif not on and self.power:
            self._brake()

    def fail(self, why):
        """The drives have a fault: brakes."""
        self.fault = why
        self._brake()

    def _brake(self):
        self.power = False
        self.torque[:] = 0.0
        self.held[:] = np.nan

    def _brake_torque(self, stiffness, damping):
        """Brakes rub until an axis stands, and hold it there."""
        grip = self.limits * BRAKE
        stops = np.isnan(self.held) & (np.abs(self.data.qvel) < GRIPS)
        self.held[stops] = self.data.qpos[stops]
        off = np.where(np.isnan(self.held), 0.0, self.held - self.data.qpos)
        return np.clip(self.data.qfrc_bias + stiffness * off - damping * self.data.qvel, -grip, grip)

    def follow(self, target, seconds, feed_forward=None):
        """Goes on for so long, to be there (deg) at the end; with the torques that whoever plans the motion asks for (Nm)."""
        steps = max(1, round(seconds / STEP))
        begin, end = self.reference.copy(), self.inner(target)
        speed = (end - begin) / (steps * STEP)
        acceleration = (speed - self.speed_before) / (steps * STEP)
        matrix = np.zeros((AXES, AXES))
        for step in range(steps):
            mujoco.mj_fullM(self.model, self.data, matrix)
            stiffness = np.diag(matrix) * BANDWIDTH**2
            damping = 2.0 * np.diag(matrix) * BANDWIDTH
            if self.power:
                here = begin + (end - begin) * (step / steps)
                off = here - self.data.qpos
                if feed_forward is None:
                    ahead = matrix @ acceleration + self.data.qfrc_bias
                else:
                    ahead = np.array(feed_forward) * self.signs
                self.sum += off * STEP / INTEGRAL_TIME
                asked = ahead + stiffness * (off + self.sum)
                asked += damping * (speed - self.data.qvel)
                self.torque = np.clip(asked, -self.limits, self.limits)
                # What the motor cannot give is not summed up.
                self.sum -= np.where(asked != self.torque, off * STEP / INTEGRAL_TIME, 0.0)
            self.data.qfrc_applied[:] = self.torque if self.power else self._brake_torque(stiffness, damping)
            mujoco.mj_step(self.model, self.data)
        self.reference, self.speed_before = (end, speed) if self.power else (self.data.qpos.copy(), np.zeros(AXES))

    def rest(self, seconds):
        """Goes on without set-points: holds where it is, or brakes."""
        if self.power:
            self.follow(self.outer(self.reference), seconds)
        else:
            self.follow(self.position, seconds)
