//! How much of the limits set-points along a law use: what a trace would show.

use std::collections::VecDeque;

use nalgebra::Vector3;

use crate::follow::segment::GuidedTool;
use crate::geometry::derivatives::third_difference_along;
use crate::time_optimal::constraint_sampler::{ConstraintSampler, Point};
use crate::time_optimal::limit_check::Used;
use crate::time_optimal::solver::Law;

/// Time between two set-points, in s.
const SET_POINT_CYCLE_S: f64 = 0.001;
/// The robot may reach a law at any time within a cycle: number of phases that are checked.
const PHASES_OF_CYCLE: usize = 2;
/// Number of set-points at rest that are needed to check how a motion begins and ends.
const SET_POINTS_AT_REST: i32 = 3;

/// Limits of speed, acceleration and jerk.
type Limits = [f64; 3];

/// The share of the permitted speed, acceleration and jerk, the latter two times `stop_scale`, that set-points along a
/// law use, by their differences: for each axis, and for the TCP along its path and its rotation where the TCP is led.
pub(crate) fn used_by_set_points(sampler: &ConstraintSampler, law: &Law, stop_scale: f64, allowed: f64) -> Used {
    let mut sample_coarsely = sampler.sample_coarsely();
    let mut last: VecDeque<Point> = VecDeque::with_capacity(3 * PHASES_OF_CYCLE + 1);
    let mut used = Used::of(allowed);
    // Where the law starts or ends at rest, the set-points before or behind it are those of a robot at rest.
    let first = if law.at(0.0).vel == 0.0 { -SET_POINTS_AT_REST } else { 0 };
    let end = (law.duration() / SET_POINT_CYCLE_S) as i32 + SET_POINTS_AT_REST;
    for step in first * PHASES_OF_CYCLE as i32..=end * PHASES_OF_CYCLE as i32 {
        if last.len() > 3 * PHASES_OF_CYCLE {
            last.pop_front();
        }
        last.push_back(
            sample_coarsely.go_to(law.at(f64::from(step) * (SET_POINT_CYCLE_S / PHASES_OF_CYCLE as f64)).at),
        );
        let points = [0, 1, 2, 3].map(|cycle| last.get(cycle * PHASES_OF_CYCLE));
        if let [Some(a), Some(b), Some(c), Some(d)] = points {
            let points = [a, b, c, d];
            let share = used_by_axes(sampler, points, stop_scale).max(used_by_tool(sampler, points, stop_scale));
            used.note([a.at, d.at], share);
        }
    }
    used
}

/// The largest share of an axis's limits by four set-points. Where one motion leads into another, the higher limits
/// count.
fn used_by_axes(sampler: &ConstraintSampler, points: [&Point; 4], stop_scale: f64) -> f64 {
    let own = sampler.robot.own_axes().iter().enumerate();
    let own = own.map(|(index, axis)| {
        (points.map(|point| point.joints.axes.get(index).copied()), points.map(|point| point.pace.of_own(axis)))
    });
    let external = sampler.robot.external_axes().iter().enumerate();
    let external = external.map(|(index, axis)| {
        (
            points.map(|point| point.joints.external.get(index).copied()),
            points.map(|point| point.pace.of_external(axis)),
        )
    });
    own.chain(external).fold(0.0_f64, |most, (values, limits)| {
        let [Some(a), Some(b), Some(c), Some(d)] = values else { return most };
        most.max(used([b - a, c - b, d - c], highest(limits), stop_scale))
    })
}

/// The largest share of the TCP's limits; 0 where the TCP is not led at all four points, or another one is.
fn used_by_tool(sampler: &ConstraintSampler, points: [&Point; 4], stop_scale: f64) -> f64 {
    let [Some(a), Some(b), Some(c), Some(d)] = points.map(|point| point.tool) else { return 0.0 };
    if [b, c, d].iter().any(|other| other.carried != a.carried) {
        return 0.0;
    }
    let pairs = [(a, b), (b, c), (c, d)];
    let tcp = &sampler.robot.tcp;
    let limits = points.map(|Point { pace, .. }| [tcp.vel.min(pace.tcp), tcp.acc * pace.acc, tcp.jerk * pace.jerk]);
    let by_travel = used_along(pairs.map(|(from, to)| to.at - from.at), highest(limits), stop_scale);
    let turn = |(from, to): (GuidedTool, GuidedTool)| Some((to.rotation? * from.rotation?.inverse()).scaled_axis());
    let [Some(first), Some(second), Some(third)] = pairs.map(turn) else { return by_travel };
    let turns = [first, second, third].map(|turn| turn.map(f64::to_degrees));
    let limits =
        points.map(|Point { pace, .. }| [tcp.ori_vel.min(pace.ori), tcp.ori_acc * pace.acc, tcp.ori_jerk * pace.jerk]);
    by_travel.max(used_along(turns, highest(limits), stop_scale))
}

/// The share of limits along a path that three consecutive steps use. Where a path all but turns back, its speed falls
/// and rises at once, with hardly any jerk: the component of the jerk along the path counts where it is smaller, as in
/// [`Constraints`].
///
/// [`Constraints`]: crate::plan::constraints::Constraints
fn used_along(displacements: [Vector3<f64>; 3], limits: Limits, stop_scale: f64) -> f64 {
    let along = third_difference_along(displacements.each_ref());
    let steps = displacements.map(|displacement| displacement.norm());
    let of_speed = jerk_of(steps);
    used_with(steps, if along.abs() < of_speed.abs() { along } else { of_speed }, limits, stop_scale)
}

/// The share of limits that three consecutive steps use.
fn used(steps: [f64; 3], limits: Limits, stop_scale: f64) -> f64 {
    used_with(steps, jerk_of(steps), limits, stop_scale)
}

/// The third difference of three consecutive steps.
fn jerk_of([first, second, third]: [f64; 3]) -> f64 {
    third - 2.0 * second + first
}

/// The share of limits that three consecutive steps with this jerk use.
fn used_with([_, second, third]: [f64; 3], jerk: f64, [most_vel, most_acc, most_jerk]: Limits, stop_scale: f64) -> f64 {
    const S: f64 = SET_POINT_CYCLE_S;
    let by_vel = third / S / most_vel;
    let by_acc = (third - second) / (S * S) / (stop_scale * most_acc);
    let by_jerk = jerk / (S * S * S) / (stop_scale * most_jerk);
    by_vel.abs().max(by_acc.abs()).max(by_jerk.abs())
}

fn highest(limits: [Limits; 4]) -> Limits {
    limits.into_iter().fold([0.0; 3], |most, limits| [0, 1, 2].map(|order: usize| most[order].max(limits[order])))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_circle_at_an_even_speed_has_no_jerk_along_its_path() {
        let at = |angle: f64| Vector3::new(angle.cos(), angle.sin(), 0.0) * 10.0;
        let displacements = [0.0, 0.05, 0.1].map(|angle| at(angle + 0.05) - at(angle));
        assert!(used_along(displacements, [1e9, 1e9, 1e6], 1.0) < 1e-3);
    }

    #[test]
    fn what_turns_back_has_no_jerk_along_its_path() {
        let limits = [1e3, 1e3, 1e4];
        let along = |displacements: [f64; 3]| {
            used_along(displacements.map(|displacement| Vector3::new(0.0, displacement, 0.0)), limits, 1.0)
        };
        // Slowing down evenly, through rest and back: the speed along the path falls and rises.
        let turned = along([1.5e-4, 0.5e-4, -0.5e-4]);
        assert!(turned < 1e-3, "{turned}");
        // The same values without turning back.
        let jolted = along([1.5e-4, 0.5e-4, 0.5e-4]);
        assert!((jolted - 10.0).abs() < 1e-9, "{jolted}");
    }
}
