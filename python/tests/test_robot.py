"""Robots: axes to poses and back."""

import subprocess
import sys

import numpy as np
import pytest

import arl2rs

ROBOTS = arl2rs.robots()


def axes_of(robot, count, seed=1):
    """Random axes within their ranges."""
    low, high = ([getattr(axis, end) for axis in robot.axes] for end in ("min", "max"))
    return np.random.default_rng(seed).uniform(low, high, (count, len(robot.axes)))


@pytest.mark.parametrize("name", ROBOTS)
def test_axes_come_back_from_their_poses(name):
    robot = arl2rs.Robot(name)
    axes = axes_of(robot, 200)
    poses = robot.forward(axes)
    assert poses.shape == (200, 6) and robot.reaches(poses).all() and robot.within(axes).all()
    # Where the wrist is straight, several axes are the same pose: the pose counts.
    back = robot.forward(robot.inverse(poses, near=axes))
    np.testing.assert_allclose(back[:, :3], poses[:, :3], atol=1e-6)
    assert np.abs((back[:, 3:] - poses[:, 3:] + 180) % 360 - 180).max() < 1e-5
    cfgs = robot.configuration(axes)
    for pose, cfg, row in zip(poses[:20], cfgs, axes, strict=False):
        found = robot.solutions(pose, near=row)
        assert int(cfg) in found and set(found) <= set(robot.configurations)
        np.testing.assert_allclose(robot.inverse(pose, near=row, cfg=int(cfg)), row, atol=1e-4)


def test_the_pose_is_that_of_a_run():
    text = "tool grip = {{10, 20, 150, 0, 30, 0}, false}\nfunc void main()\n    movej j:{10, -80, 95, 5, 40, -20}, t:grip\nendfunc\n"
    result = arl2rs.run(source=text, robot="kr10-r1420")
    robot = arl2rs.Robot("kr10-r1420")
    np.testing.assert_allclose(
        robot.forward(result.trace.joints[-1], tool=(10, 20, 150, 0, 30, 0)), result.trace.tcp[-1], atol=1e-6
    )
    tools = robot.forward(result.trace.joints, tool={"x": 10, "y": 20, "z": 150, "b": 30})
    # Rows before the motion have the flange.
    moves = result.trace.motion > 0
    np.testing.assert_allclose(tools[moves], result.trace.tcp[moves], atol=1e-6)


def test_frames_are_between_pose_and_flange():
    robot = arl2rs.Robot("kr10-r1420")
    axes = np.array([0.0, -90, 90, 0, 20, 0])
    flange = robot.forward(axes)
    assert abs(robot.forward(axes, tool=[0, 0, 100, 0, 0, 0])[2] - flange[2]) > 10
    moved = robot.forward(axes, wobj=[100, 0, 0, 0, 0, 0])
    np.testing.assert_allclose(moved[:3], flange[:3] - [100, 0, 0], atol=1e-9)
    np.testing.assert_allclose(
        robot.forward(axes, base=[0, 0, 500, 0, 0, 0])[:3], flange[:3] + np.array([0, 0, 500]), atol=1e-9
    )
    frames = {"tool": [5, 6, 150, 10, 20, 30], "wobj": [400, -50, 300, 15, 0, 0], "base": [10, 20, 30, 90, 0, 0]}
    np.testing.assert_allclose(robot.inverse(robot.forward(axes, **frames), near=axes, **frames), axes, atol=1e-9)
    # The robot holds the part to a tool that stands.
    held = {"tool": [1000, 0, 500, 0, 0, 0], "wobj": [0, 0, 200, 0, 0, 0], "stationary": True, "robhold": True}
    np.testing.assert_allclose(robot.inverse(robot.forward(axes, **held), near=axes, **held), axes, atol=1e-9)
    with pytest.raises(arl2rs.RefusedError, match="holds neither"):
        robot.forward(axes, stationary=True)


def test_what_is_not_reached_is_reported():
    robot = arl2rs.Robot("kr10-r1420")
    far, near = [5000.0, 0, 0, 0, 0, 0], robot.forward([0, -90, 90, 0, 20, 0])
    with pytest.raises(arl2rs.RefusedError, match=r"does not reach \{x 5000, .*\}: the arm falls short by 3608\.6 mm"):
        robot.inverse(far)
    found = robot.inverse([far, near])
    assert np.isnan(found[0]).all() and not np.isnan(found[1]).any()
    assert list(robot.reaches([far, near])) == [False, True] and not robot.reaches(far) and robot.reaches(near)
    assert robot.why_not([far, near]) == ["the arm falls short by 3608.6 mm", None]
    assert "not a number" in robot.why_not([np.nan] * 6)[0]
    scara = arl2rs.Robot("hsr065")
    assert scara.family == "scara" and len(scara.axes) == 4
    pose = scara.forward(scara.home)
    assert "tilt" in scara.why_not(pose + np.array([0, 0, 0, 0, 20, 0]))[0]


def test_a_path_is_followed_without_jumps():
    robot = arl2rs.Robot("kr10-r1420")
    start = np.array([0, -90, 90, 170.0, 40, 0])
    path = robot.forward(start) + np.linspace(0, 1, 200)[:, None] * [0, 120, 0, 0, 0, 0]
    chained = robot.inverse(path, near=start, chained=True)
    assert np.abs(np.diff(chained, axis=0)).max() < 2
    pose = dict(zip("xyzabc", path[0], strict=True))
    np.testing.assert_allclose(robot.inverse(pose, near=start), start, atol=1e-9)


def test_wrong_shapes_are_reported():
    robot = arl2rs.Robot("kr10-r1420")
    for act, words in [
        (lambda: arl2rs.Robot("kr10-r142"), "did you mean `kr10-r1420`"),
        (lambda: robot.forward([1, 2, 3]), r"joints: expected 6 numbers, or rows of 6, found an array of shape \(3,\)"),
        (lambda: robot.forward("abc"), "joints"),
        (lambda: robot.inverse([[1, 2], [3, 4]]), r"poses: expected 6 numbers"),
        (lambda: robot.inverse(np.zeros((3, 6)), near=np.zeros((2, 6))), "near has 2 rows: expected 1, or 3"),
        (lambda: robot.inverse([0] * 6, near=[0, -90, np.nan, 0, 0, 0]), "near: expected finite numbers"),
        (lambda: robot.inverse([0] * 6, cfg=9), "no configuration 9"),
        (lambda: robot.inverse({"x": 1}), "the pose has no y"),
        (lambda: robot.forward(robot.home, tool=[1, 2, 3]), "tool: expected 6 numbers"),
        (lambda: robot.forward(robot.home, tool={"w": 1}), "not w"),
        (lambda: robot.forward(robot.home, base=[np.inf] * 6), "base: expected six numbers"),
        (lambda: robot.solutions(np.zeros((2, 6))), "expected one pose"),
    ]:
        with pytest.raises(arl2rs.RefusedError, match=words):
            act()


def test_a_robot_is_one_of_a_file(tmp_path):
    assert repr(arl2rs.Robot("KR10-R1420")) == "Robot('kr10-r1420')"
    with pytest.raises(arl2rs.RefusedError, match=r"nowhere\.toml"):
        arl2rs.Robot(tmp_path / "nowhere.toml")
    file = tmp_path / "longer.toml"
    file.write_text(
        subprocess.run(
            [sys.executable, "-m", "arl2rs", "robots", "six-10"], capture_output=True, text=True, check=True
        ).stdout
    )
    file.write_text(file.read_text().replace('name = "six-10"', 'name = "longer"'))
    longer, known = arl2rs.Robot(file), arl2rs.Robot("six-10")
    assert longer.name == "longer" and longer.axes == known.axes
    np.testing.assert_array_equal(longer.forward(known.home), known.forward(known.home))
