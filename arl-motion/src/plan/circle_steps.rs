//! A circle in two motions, as single steps execute it: to the via point, and on to the target.

use crate::command::UNSET;
use crate::command::joints::{Joints, is_unset};
use crate::command::{Command, Target};
use crate::geometry::arc::{arc_through, circle_through};
use crate::plan::planner::Planner;
use arl_robot::robot::Robot;

/// The two motions of a circle that starts at `start`; `None` for what is not a circle, or does not reach the via
/// point.
pub fn circle_steps(
    robot: &Robot,
    start: &Joints,
    command: &Command,
    settings: &crate::command::Settings,
) -> Option<[Command; 2]> {
    let Target::Arc { via, pose, wobj, angle, follow, external } = &command.target else { return None };
    let planner = Planner { robot, start, command, settings };
    let [x, y, z] = *via;
    let through = planner.target_frame(&[x, y, z, UNSET, UNSET, UNSET], wobj).ok()?;
    let end = planner.target_frame(pose, wobj).ok()?;
    let points = [planner.start_frame(), through, end].map(|frame| frame.translation.vector);
    let whole = arc_through(&points)?;
    let first = circle_through(&points)?.arc(&points[0], &points[1]).sweep;
    let all = angle.map_or(whole.sweep, f64::to_radians);
    if all <= first {
        return None;
    }
    // A point on the rest of the circle.
    let between = 0.5 * (first + whole.sweep);
    let seen = whole.centre + whole.across * libm::cos(between) + whole.along * libm::sin(between);
    let seen = wobj.inverse() * nalgebra::Point3::from(seen);
    let mut halfway = *external;
    for (there, from) in halfway.iter_mut().zip(&start.external) {
        if !is_unset(*there) && !is_unset(*from) {
            *there = from + (*there - from) * first / all;
        }
    }
    let arc = |via: [f64; 3], angle: Option<f64>, external: [f64; 6]| {
        let target = Target::Arc { via, pose: *pose, wobj: *wobj, angle, follow: *follow, external };
        Command { target, duration: None, ..command.clone() }
    };
    let rest = angle.map(|_| (all - first).to_degrees());
    Some([arc(*via, Some(first.to_degrees()), halfway), arc([seen.x, seen.y, seen.z], rest, *external)])
}
