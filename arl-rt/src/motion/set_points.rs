//! What the set-points along a law use of the axes' limits: what a trace would show.

use super::bounds::Pace;
use super::joints::Joints;
use super::optimal::Law;
use super::plot::Used;
use super::scout::Scout;

/// s between two set-points.
const CYCLE: f64 = 0.001;
/// So many of them at rest tell how a motion begins and ends.
const STANDING: i32 = 3;

/// The share of what motions may have of an axis's speed, acceleration and jerk, the latter two `harder` times as high, that
/// set-points along a law use, by their differences.
pub(super) fn used_by_set_points(scout: &Scout, law: &Law, harder: f64) -> Used {
    let mut stroll = scout.stroll();
    let mut last: Vec<(f64, (Joints, Pace))> = Vec::with_capacity(4);
    let mut used = Used::default();
    // Where it stands before or behind, set-points are those of a robot at rest.
    let first = if law.at(0.0).vel == 0.0 { -STANDING } else { 0 };
    for cycle in first..=(law.duration() / CYCLE) as i32 + STANDING {
        if last.len() == 4 {
            last.remove(0);
        }
        let at = law.at(f64::from(cycle) * CYCLE).at;
        last.push((at, stroll.go_to(at)));
        if let [(from, a), (_, b), (_, c), (to, d)] = last.as_slice() {
            used.note([*from, *to], used_by(scout, [a, b, c, d], harder));
        }
    }
    used
}

/// The largest share by four set-points. Where one motion leads into another, the higher limits count.
fn used_by(scout: &Scout, points: [&(Joints, Pace); 4], harder: f64) -> f64 {
    let own = scout.robot.own_axes().iter().enumerate();
    let own = own.map(|(index, axis)| {
        (points.map(|(joints, _)| joints.axes.get(index).copied()), points.map(|(_, pace)| pace.of_own(axis)))
    });
    let external = scout.robot.external_axes().iter().enumerate();
    let external = external.map(|(index, axis)| {
        (points.map(|(joints, _)| joints.external.get(index).copied()), points.map(|(_, pace)| pace.of_external(axis)))
    });
    own.chain(external).fold(0.0_f64, |used, (values, limits)| {
        let [Some(a), Some(b), Some(c), Some(d)] = values else { return used };
        let [vel, acc, jerk] = [0, 1, 2].map(|order| limits.iter().map(|limits| limits[order]).fold(0.0, f64::max));
        let by_vel = (d - c) / CYCLE / vel;
        let by_acc = (d - 2.0 * c + b) / (CYCLE * CYCLE) / (harder * acc);
        let by_jerk = (d - 3.0 * (c - b) - a) / (CYCLE * CYCLE * CYCLE) / (harder * jerk);
        used.max(by_vel.abs()).max(by_acc.abs()).max(by_jerk.abs())
    })
}
