#!/usr/bin/env python3
"""Writes arl-rt/tests/data/newton-euler.txt: axis torques computed by Pinocchio for the built-in robots.

    python3 -m venv venv && venv/bin/pip install pin && venv/bin/python scripts/newton-euler.py

The frames of the links are described in arl-rt/src/unit/dynamics/mod.rs. A line has: robot; axes (deg, mm), speeds and
accelerations (the same per s, per s2); the load's mass (kg), centre (mm) and inertia (kg mm2); force (N) and torque (Nm) on
the flange, in the base; the base's rotation vector (rad); the torques (Nm, N).
"""

import math
import random
import tomllib
from pathlib import Path

import numpy as np
import pinocchio as pin

ROOT = Path(__file__).resolve().parent.parent
ROBOTS = ROOT / "arl-robot/src/robot/files"
CASES = 8


def matrix(i):
    return np.array([[i[0], i[1], i[2]], [i[1], i[3], i[4]], [i[2], i[4], i[5]]])


def inertia(mass, com, i):
    return pin.Inertia(mass, np.array(com) / 1e3, matrix(i) / 1e6)


def build(robot, load):
    """The model, the directions and offsets (deg) of the axes, and the flange seen from the last joint (m)."""
    g = robot["geometry"]
    z, y, lift = pin.JointModelRZ, pin.JointModelRY, pin.JointModelPZ
    if robot["family"] == "six-axis":
        places = [(0, 0, g["c1"]), (g["a1"], g["b"], 0), (0, 0, g["c2"]), (g["a2"], 0, g["c3"]), (0, 0, 0), (0, 0, 0)]
        kinds = [z, y, y, z, y, z]
        signs, offsets, flange = g["signs"], g["offsets"], np.array([0, 0, g["c4"] / 1e3])
    else:
        places = [(0, 0, 0), (g["l1"], 0, 0), (g["l2"], 0, g["z0"]), (0, 0, 0)]
        kinds = [z, z, lift, z]
        signs, offsets, flange = [1] * 4, [0] * 4, np.zeros(3)
    model = pin.Model()
    joint = 0
    for kind, place, link in zip(kinds, places, robot["link"]):
        joint = model.addJoint(joint, kind(), pin.SE3(np.eye(3), np.array(place) / 1e3), f"j{joint + 1}")
        model.appendBodyToJoint(joint, inertia(link["mass"], link["com"], link["inertia"]), pin.SE3.Identity())
    model.appendBodyToJoint(joint, inertia(*load), pin.SE3(np.eye(3), flange))
    return model, signs, offsets, flange


def torques(robot, axes, rates, accelerations, load, force, torque, base):
    model, signs, offsets, flange = build(robot, load)
    up = pin.exp3(np.array(base)).T @ np.array([0, 0, 9.81])
    model.gravity.linear = -up
    linear = [robot["family"] == "scara" and i == 2 for i in range(len(axes))]
    unit = [1e-3 if one else math.pi / 180 for one in linear]
    q = np.array([(a * s - o) * u for a, s, o, u in zip(axes, signs, offsets, unit)])
    v = np.array([r * s * u for r, s, u in zip(rates, signs, unit)])
    a = np.array([r * s * u for r, s, u in zip(accelerations, signs, unit)])
    data = model.createData()
    pin.forwardKinematics(model, data, q)
    last = data.oMi[model.njoints - 1].rotation.T
    f, t = last @ np.array(force), last @ np.array(torque)
    outside = pin.StdVec_Force([pin.Force.Zero() for _ in range(model.njoints - 1)])
    outside.append(pin.Force(f, t + np.cross(flange, f)))
    return [t * s for t, s in zip(pin.rnea(model, data, q, v, a, outside), signs)]


def main():
    random.seed(1)
    lines = []
    for path in sorted(ROBOTS.glob("*.toml")):
        robot = tomllib.loads(path.read_text())
        for case in range(CASES):
            own = robot["axis"][: len(robot["link"])]
            axes = [round(random.uniform(a["min"], a["max"]), 3) for a in own]
            rates = [round(random.uniform(-1, 1) * a["vel"], 3) for a in own]
            accelerations = [round(random.uniform(-1, 1) * a["acc"], 3) for a in own]
            number = lambda n, size: [round(random.uniform(-size, size), 3) for _ in range(n)]
            full = case >= 2
            mass = round(random.uniform(1, 10), 3) if full else 0.0
            x, y, z = [round(random.uniform(1e3, 1e4), 3) for _ in range(3)] if full else [0.0] * 3
            xy, xz, yz = number(3, 500) if full else [0.0] * 3
            load = (mass, number(3, 150) if full else [0.0] * 3, [y + z, xy, xz, x + z, yz, x + y])
            force, torque = (number(3, 100), number(3, 20)) if case >= 4 else ([0.0] * 3, [0.0] * 3)
            base = number(3, 2) if case >= 6 else [0.0] * 3
            found = torques(robot, axes, rates, accelerations, load, force, torque, base)
            fields = [axes, rates, accelerations, [load[0], *load[1], *load[2]], force + torque, base, found]
            lines.append("; ".join([robot["name"]] + [" ".join(repr(float(x)) for x in field) for field in fields]))
    (ROOT / "arl-rt/tests/data/newton-euler.txt").write_text("\n".join(lines) + "\n")


main()
