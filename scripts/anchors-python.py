#!/usr/bin/env python3
"""Measures the rivals of `cargo bench -p arl-benches --bench anchors` that are not on crates.io.

    python3 -m venv venv && venv/bin/pip install pin toppra ruckig && venv/bin/python scripts/anchors-python.py

Run it together with the bench: only ratios count. Times are processor time, the least of several rounds, without the cost
of a call from Python where that can be separated. The script prints the times and writes no files.
"""

import math
import random
import time
import timeit
from importlib.metadata import version

import numpy as np

LIMITS = [220.0, 210.0, 270.0, 381.0, 311.0, 492.0]  # kr10-r1420, deg/s
ACCELERATION, JERK = 5.0, 60.0
ROUNDS = 20


def least(work, calls):
    """The least time per call, us."""
    return min(timeit.repeat(work, number=calls, repeat=ROUNDS, timer=time.process_time)) / calls * 1e6


def inverse_dynamics():
    import pinocchio as pin

    # Six axes with arbitrary masses: the time of rnea does not depend on them.
    model = pin.Model()
    joint = 0
    kinds = [pin.JointModelRZ, pin.JointModelRY, pin.JointModelRY, pin.JointModelRZ, pin.JointModelRY, pin.JointModelRZ]
    for index, kind in enumerate(kinds):
        joint = model.addJoint(joint, kind(), pin.SE3(np.eye(3), np.array([0.1, 0.0, 0.4])), f"j{index + 1}")
        model.appendBodyToJoint(joint, pin.Inertia.Random(), pin.SE3.Identity())
    data = model.createData()
    q, v, a = (np.random.default_rng(seed).uniform(-1, 1, 6) for seed in (1, 2, 3))
    call = least(lambda: pin.rnea(model, data, q, v, a), 20_000)
    # The same call into C++ and back, three vectors in and one out, with almost no work in between.
    crossing = least(lambda: pin.integrate(model, q, v), 20_000)
    print(f"pinocchio {version('pin')}: rnea {call:.2f} us a call from Python, of which crossing takes some {crossing:.2f}")


def rest_to_rest():
    import ruckig

    rng = random.Random(7)
    solver = ruckig.Ruckig(6)
    trajectory = ruckig.Trajectory(6)

    def problem(moving):
        given = ruckig.InputParameter(6)
        vel = [math.radians(limit) for limit in LIMITS]
        acc, jerk = [ACCELERATION * limit for limit in vel], [JERK * limit for limit in vel]
        given.max_velocity, given.max_acceleration, given.max_jerk = vel, acc, jerk
        given.current_position = [rng.uniform(-2, 2) for _ in vel]
        given.target_position = [rng.uniform(-2, 2) for _ in vel]
        if moving:
            now = [rng.uniform(-1, 1) * limit for limit in acc]
            given.current_acceleration = now
            given.current_velocity = [
                rng.uniform(-1, 1) * (v - 0.5 * a * a / j) for v, a, j in zip(vel, now, jerk)
            ]
        return given

    for name, moving in (("rest to rest", False), ("from any state", True)):
        problems = [problem(moving) for _ in range(1000)]

        def work():
            for given in problems:
                solver.calculate(given, trajectory)

        print(f"ruckig {version('ruckig')} (C++): {name}, 6 axes {least(work, 1) / len(problems):.2f} us")


def splitmix(seed):
    """The random numbers of benches/src/random.rs."""
    mask = (1 << 64) - 1
    while True:
        seed = (seed + 0x9E3779B97F4A7C15) & mask
        z = ((seed ^ (seed >> 30)) * 0xBF58476D1CE4E5B9) & mask
        z = ((z ^ (z >> 27)) * 0x94D049BB133111EB) & mask
        yield ((z ^ (z >> 31)) >> 11) / (1 << 53)


def durations():
    """The paths of the bench's job `durations`, without jerk limits."""
    import toppra
    import toppra.algorithm as algorithm
    import toppra.constraint as constraint
    from scipy.interpolate import BSpline

    toppra.setup_logging("ERROR")
    limits = np.radians(LIMITS)
    symmetric = np.stack([-limits, limits], axis=1)
    both = [constraint.JointVelocityConstraint(symmetric), constraint.JointAccelerationConstraint(symmetric * ACCELERATION)]
    grid = np.linspace(0, 1, 1000)
    for seed in range(1, 6):
        numbers = splitmix(seed)
        at, points = np.zeros(6), []
        for _ in range(100):
            at = at + np.array([(2.0 * next(numbers) - 1.0) * 0.015 * limit for limit in limits])
            points.append(at)
        pieces = len(points) - 5
        spline = BSpline((np.arange(len(points) + 6) - 5) / pieces, np.array(points), 5)
        path = toppra.SplineInterpolator(grid, spline(grid))
        start = time.process_time()
        instance = algorithm.TOPPRA(both, path, gridpoints=grid, parametrizer="ParametrizeConstAccel")
        duration = instance.compute_trajectory(0, 0).duration
        taken = time.process_time() - start
        print(f"toppra {version('toppra')}: path {seed}: {duration:.3f} s, computed in {taken * 1e3:.0f} ms")


if __name__ == "__main__":
    inverse_dynamics()
    rest_to_rest()
    durations()
