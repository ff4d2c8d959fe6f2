//! Parts of motions and halves of blends, the elements of the path.

use std::ops::Range;

use nalgebra::{UnitQuaternion, Vector3};

use crate::blend::blend_limits::{self, BlendLimits};
use crate::blend::corner::{Blend, common_pace};
use crate::blend::no_blend::NoBlend;
use crate::command::joints::{ALL, Joints};
use crate::follow::timing::Cell;
use crate::geometry::derivatives::{CurvePoint, by_differences};
use crate::geometry::parametrization::Parametrization;
use crate::limits::profile::Limits;
use crate::plan::constraints::{Constraints, PathLimits};
use crate::plan::curve::Curve;
use crate::plan::motion::Motion;
use arl_robot::frames::{Carried, Rig};
use arl_robot::kinematics::Kinematics;
use arl_robot::robot::{ROBOT_AXES, Robot};

/// Number of parts of half a blend.
const PARTS_OF_HALF: usize = blend_limits::PARTS / 2;

/// Largest gap in mm or deg between two segments that meet.
const LARGEST_GAP: f64 = 1e-3;

/// Distances from a singular point at which rates are sought, as shares of the segment.
const SHARES_BESIDE_SINGULAR: [f64; 6] = [1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 0.05];

/// Three derivatives of all axes.
type Rates = [[f64; ALL]; 3];

/// A part of the path. Its parameter is the time, in s, that it takes at its full speed, so that motions and blends
/// meet at the same speed.
#[derive(Clone, PartialEq, Debug)]
pub(crate) struct Segment {
    pub(crate) number: u64,
    pub(crate) line: u32,
    pub(crate) rig: Rig,
    curve: Curve,
    /// The parameters of the curve at the start and at the end.
    pub(crate) from: f64,
    to: f64,
    /// The curve's parameter over the share of the nominal time, where the parameter does not change evenly.
    pub(crate) parametrization: Option<Parametrization>,
    /// The nominal time in s.
    pub(crate) time: f64,
    /// Limits in s of nominal time; the speed is the lowest one, acceleration and jerk are those outside the end zones.
    pub(crate) limits: Limits,
    /// Speeds of its parts, which take the same nominal time each; `None` where all are the same.
    speeds: Option<[f64; PARTS_OF_HALF]>,
    /// Where it has other limits of acceleration and jerk.
    arm: Option<Arm>,
    /// Whether the robot has to come to rest at the end.
    pub(crate) stops: bool,
    /// Whether the motion ends here.
    pub(crate) ends: bool,
    /// How long the whole motion takes, in s, where the segment is all of it, from rest to rest.
    duration: Option<f64>,
    /// Exact end of the motion, for a motion that is not blended with the next one.
    target: Joints,
    /// Shares of the motion's path that are done at the start and at the end.
    pub(crate) shares: [f64; 2],
    /// Share of the motion itself at which a blend leaves it.
    pub(crate) leave: f64,
    /// Reason why a blend takes less than was requested, where it does.
    pub(crate) less: Option<NoBlend>,
    /// The length of the motion in mm.
    pub(crate) length: f64,
    /// Programmed speeds, where it is known what limits each place of the segment.
    pub(crate) pace: Option<PathLimits>,
    /// Whether each place has limits of its own even while the robot does not stop.
    pub(crate) is_free: bool,
}

/// Parts with an acceleration and a jerk of their own.
#[derive(Clone, PartialEq, Debug)]
struct Arm {
    parts: Range<usize>,
    acc: f64,
    jerk: f64,
}

/// A tool that is led along a path.
#[derive(Clone, Copy, Debug)]
pub(crate) struct GuidedTool {
    /// Position of the TCP, in mm.
    pub(crate) at: Vector3<f64>,
    /// Orientation, where it is led, too; in passages of the wrist singularity it may deviate.
    pub(crate) rotation: Option<UnitQuaternion<f64>>,
    /// What the robot carries.
    pub(crate) carried: Carried,
}

/// Speeds along a path, in the quantities in which speeds are programmed, without overlays.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct PlainSpeed {
    /// Speed of the TCP in mm/s and of the tool's rotation in deg/s; 0 where the axes are led.
    pub(crate) tcp: f64,
    pub(crate) turning: f64,
    /// Speeds of the external axes, or of all axes where the axes are led, in deg/s (mm/s).
    pub(crate) axes: [f64; ALL],
}

impl Segment {
    /// A part of a motion.
    pub(crate) fn part(motion: &Motion, limits: Limits, number: u64, from: f64, to: f64) -> Self {
        // 1 s of nominal time at full speed.
        let rate = motion.rate;
        let scaled = Limits { vel: limits.vel / rate, acc: limits.acc / rate, jerk: limits.jerk / rate };
        Self {
            number,
            line: motion.line,
            rig: motion.rig,
            curve: motion.curve.clone(),
            from,
            to,
            parametrization: None,
            time: (to - from) / rate,
            limits: scaled,
            speeds: None,
            arm: None,
            stops: true,
            ends: motion.ends,
            duration: (from == 0.0 && to == 1.0).then(|| motion.duration_with(&limits)),
            target: motion.end,
            leave: to,
            less: None,
            shares: [from, to].map(|share| motion.of_instruction(share)),
            length: motion.length,
            pace: is_known(motion).then_some(motion.pace),
            is_free: is_free(motion),
        }
    }

    /// Whether another segment has the same path and the same limits.
    pub(crate) fn is_like(&self, other: &Self) -> bool {
        let number = self.number;
        *self == Self { number, ..other.clone() }
    }

    /// One half of a blend: the first belongs to the motion that is left, the second to the one that is joined.
    pub(crate) fn half(blend: &Blend, before: &Motion, after: &Motion, number: u64, first: bool) -> Self {
        let motion = if first { before } else { after };

        let BlendLimits { speeds, acc, jerk, end_zones } = &blend.blend_limits;
        let time = blend.time;
        let skipped = if first { 0 } else { PARTS_OF_HALF };
        let mut own = [0.0; PARTS_OF_HALF];
        for (own, speed) in own.iter_mut().zip(speeds.iter().skip(skipped)) {
            *own = on_grid(speed * time);
        }
        let lowest = own.iter().copied().fold(f64::INFINITY, f64::min);
        let parts =
            if first { 0..end_zones.parts } else { PARTS_OF_HALF.saturating_sub(end_zones.parts)..PARTS_OF_HALF };
        let arm =
            (end_zones.parts > 0).then_some(Arm { parts, acc: end_zones.acc * time, jerk: end_zones.jerk * time });
        Self {
            number,
            line: motion.line,
            rig: motion.rig,
            curve: blend.curve.clone(),
            from: if first { 0.0 } else { 0.5 },
            to: if first { 0.5 } else { 1.0 },
            parametrization: Some(blend.parametrization.clone()),
            time: time / 2.0,
            limits: Limits { vel: lowest, acc: acc * time, jerk: jerk * time },
            speeds: (arm.is_some() || own.iter().any(|speed| *speed != lowest)).then_some(own),
            arm,
            stops: false,
            ends: first && motion.ends,
            duration: None,
            target: motion.end,
            // The whole blend counts as part of the motion that it leads into: see `PathBuffer::current`.
            leave: blend.leave,
            less: blend.less.clone(),
            shares: if first { [blend.leave; 2] } else { [blend.join / 2.0, blend.join] }
                .map(|share| motion.of_instruction(share)),
            length: motion.length,
            pace: (is_known(before) && is_known(after)).then(|| common_pace(before, after)),
            is_free: is_free(before) && is_free(after),
        }
    }

    /// The segment with an acceleration that takes at least `time` s to rise.
    pub(crate) fn rising_in(self, time: f64) -> Self {
        let rising = |arm: Arm| {
            let Limits { acc, jerk, .. } = Limits { vel: 0.0, acc: arm.acc, jerk: arm.jerk }.rising_in(time);
            Arm { acc, jerk, ..arm }
        };
        Self { limits: self.limits.rising_in(time), arm: self.arm.map(rising), ..self }
    }

    /// The segment where the robot does not begin or end it at rest.
    pub(crate) fn flowing(self) -> Self {
        Self { duration: None, ..self }
    }

    /// The parts that have a speed of their own, for the timing.
    pub(crate) fn cells(&self) -> impl Iterator<Item = Cell> {
        let count = if self.speeds.is_some() { PARTS_OF_HALF } else { 1 };
        let length = self.time / count as f64;
        let speed = |part: usize| self.speeds.as_ref().and_then(|speeds| speeds.get(part).copied());
        let arm = |part: usize| self.arm.as_ref().filter(|arm| arm.parts.contains(&part));
        (0..count).map(move |part| {
            let vel = speed(part).unwrap_or(self.limits.vel);
            let (acc, jerk) = arm(part).map_or((self.limits.acc, self.limits.jerk), |arm| (arm.acc, arm.jerk));
            Cell { length, limits: Limits { vel, acc, jerk } }
        })
    }

    /// Limits that hold on the whole segment.
    fn lowest_limits(&self) -> Limits {
        let lowest = |arm: &Arm| Limits {
            acc: self.limits.acc.min(arm.acc),
            jerk: self.limits.jerk.min(arm.jerk),
            ..self.limits
        };
        self.arm.as_ref().map_or(self.limits, lowest)
    }

    /// How long it takes, in s, from `at` s of nominal time on, at its full speed.
    pub(crate) fn time_from(&self, at: f64) -> f64 {
        let mut end = 0.0;
        let remaining = |cell: Cell| {
            end += cell.length;
            (end - at).clamp(0.0, cell.length) / cell.limits.vel
        };
        self.cells().map(remaining).sum()
    }

    /// The joints after `at` s of nominal time.
    pub(crate) fn joints(&self, kinematics: &Kinematics, at: f64, near: &Joints) -> Joints {
        if self.stops && at >= self.time { self.target } else { self.joints_on(kinematics, at, near) }
    }

    /// The joints after `at` s of nominal time, with the end of a motion as its curve has it.
    pub(crate) fn joints_on(&self, kinematics: &Kinematics, at: f64, near: &Joints) -> Joints {
        self.curve.joints(kinematics, self.place(at), near)
    }

    /// Whether all axes move in proportion, with the same limits everywhere.
    pub(crate) fn is_even(&self) -> bool {
        self.parametrization.is_none() && matches!(self.curve, Curve::Axes(_))
    }

    /// The tool whose path is limited, after `at` s of nominal time, where the joints are `joints`. `None` where the
    /// axes are led, except for blends between motions that lead the TCP, and where it is not known what limits it.
    pub(crate) fn tool(&self, kinematics: &Kinematics, at: f64, joints: &Joints) -> Option<GuidedTool> {
        let pace = self.pace?;
        match &self.curve {
            Curve::Tool(curve) => {
                let tcp = curve.tcp(self.place(at));
                Some(GuidedTool { at: tcp.translation.vector, rotation: Some(tcp.rotation), carried: curve.carried })
            }
            Curve::Axes(_) if pace.tcp.is_finite() => {
                Some(GuidedTool { at: self.tcp_by_axes(kinematics, joints), rotation: None, carried: self.rig.carried })
            }
            Curve::Axes(_) => None,
        }
    }

    /// The position of the TCP, in mm, where the axes are led.
    fn tcp_by_axes(&self, kinematics: &Kinematics, joints: &Joints) -> Vector3<f64> {
        self.rig.carried.path_frame_at(&kinematics.forward(&joints.axes)).translation.vector
    }

    /// The first three derivatives of the TCP's position in mm, where the axes are led, after `at` s of nominal time,
    /// by differences.
    fn moving_by_axes(&self, kinematics: &Kinematics, at: f64, near: &Joints) -> [Vector3<f64>; 3] {
        let tcp = |at: f64| self.tcp_by_axes(kinematics, &self.joints_on(kinematics, at, near));
        by_differences(tcp, at, self.time)
    }

    /// Whether the next segment begins where this one ends: compares the flange's position where both lead the tool,
    /// all axes where both lead the axes.
    pub(crate) fn meets(&self, next: &Self) -> bool {
        let (end, start) = (self.place(self.time), next.place(0.0));
        match (&self.curve, &next.curve) {
            (Curve::Tool(a), Curve::Tool(b)) => {
                (a.flange(end).translation.vector - b.flange(start).translation.vector).norm() < LARGEST_GAP
            }
            (Curve::Axes(a), Curve::Axes(b)) => {
                a.at(end).iter().zip(&b.at(start)).all(|(end, start)| (end - start).abs() < LARGEST_GAP)
            }
            _ => true,
        }
    }

    /// The parameter of the curve after `at` s of nominal time.
    fn place(&self, at: f64) -> f64 {
        let place = self.from + (self.to - self.from) * (at / self.time);
        self.parametrization.as_ref().map_or(place, |parametrization| parametrization.at(place))
    }

    /// The speeds of a part of a motion after `at` s of nominal time, where `vel` s of nominal time pass per s. `None`
    /// for half of a blend.
    pub(crate) fn plain_speed(&self, at: f64, vel: f64) -> Option<PlainSpeed> {
        if self.parametrization.is_some() {
            return None;
        }
        let (place, rate) = (self.place(at), vel * (self.to - self.from) / self.time);
        Some(match &self.curve {
            Curve::Axes(curve) => {
                PlainSpeed { tcp: 0.0, turning: 0.0, axes: curve.derivative(1, place).map(|axis| (rate * axis).abs()) }
            }
            Curve::Tool(curve) => {
                let [turning, ..] = curve.path.rotation_rates(place);
                let mut axes = [0.0; ALL];
                for (axis, moving) in axes.iter_mut().skip(ROBOT_AXES).zip(curve.external.derivative(1, place)) {
                    *axis = (rate * moving).abs();
                }
                let tcp = curve.path.track.derivative(1, place).norm();
                PlainSpeed { tcp: rate * tcp, turning: rate * turning.norm().to_degrees(), axes }
            }
        })
    }

    /// Whether this is the half of a blend that leaves its motion.
    pub(crate) fn leaves(&self) -> bool {
        self.parametrization.is_some() && self.ends
    }

    /// How long the whole motion takes, in s, where the segment is all of it, from rest to rest.
    pub(crate) fn duration(&self) -> Option<f64> {
        self.duration
    }

    /// Where the motion ends.
    pub(crate) fn target(&self) -> &Joints {
        &self.target
    }

    /// The number of parts between which the derivatives of its curve jump; 1 where they do not.
    pub(crate) fn parts(&self) -> u32 {
        let jumps = self.parametrization.as_ref().is_some_and(Parametrization::has_parts) || self.curve.is_paced();
        if jumps { self.bends() } else { 1 }
    }

    /// The number of parts over which its curve may change its direction or its pace; 1 where it changes neither.
    pub(crate) fn bends(&self) -> u32 {
        let bends = self.parametrization.is_some() || self.curve.is_paced();
        if bends { ((self.to - self.from) * Parametrization::PARTS as f64).ceil() as u32 } else { 1 }
    }

    /// Where derivatives jump, within it and at its end, in s of nominal time from its start.
    pub(crate) fn jumps(&self) -> impl Iterator<Item = f64> {
        let all = if self.parts() > 1 { Parametrization::PARTS } else { 0 };
        let shares = (0..all).map(|part| part as f64 / Parametrization::PARTS as f64);
        let inside = shares.chain(self.borders()).filter(|share| *share > self.from && *share < self.to);
        inside.map(|share| (share - self.from) / (self.to - self.from) * self.time).chain([self.time])
    }

    /// Places near singular points that a check along the segment must not miss, in s of nominal time from its start. A
    /// segment with a parametrization of its own has none.
    pub(crate) fn close_places(&self) -> impl Iterator<Item = f64> {
        let curve = if let Curve::Tool(curve) = &self.curve { Some(curve) } else { None };
        let places = curve.filter(|_| self.parametrization.is_none()).into_iter().flat_map(|curve| &curve.close_places);
        let inside = places.filter(|share| **share > self.from && **share < self.to);
        inside.map(|share| (share - self.from) / (self.to - self.from) * self.time)
    }

    /// Whether derivatives of its curve jump within `near` s of nominal time of a place.
    pub(crate) fn jumps_beside(&self, at: f64, near: f64) -> bool {
        let width = (self.to - self.from) / self.time;
        let share = self.from + at * width;
        let is_near = |border: f64| (border - share).abs() <= near * width;
        let parts = Parametrization::PARTS as f64;
        (self.parts() > 1 && is_near((share * parts).round() / parts)) || self.borders().any(is_near)
    }

    /// Where passages through a singularity begin and end. A segment with a parametrization of its own has none.
    fn borders(&self) -> impl Iterator<Item = f64> {
        let curve = if let Curve::Tool(curve) = &self.curve { Some(curve) } else { None };
        curve.into_iter().flat_map(|curve| curve.borders())
    }

    /// Adds what limits the nominal time after `at` s of it, where the joints are `joints`, for a robot that goes on,
    /// or for one that stops and whose acceleration takes at least `rise` s to rise. Returns the first three
    /// derivatives of the joints by the nominal time; `None` where only constant limits hold, and at a singular point.
    pub(crate) fn limit(
        &self,
        robot: &Robot,
        at: f64,
        joints: &Joints,
        rise: Option<f64>,
        constraints: &mut Constraints,
    ) -> Option<Rates> {
        let Some(pace) = self.pace.as_ref().filter(|_| rise.is_some() || self.is_free) else {
            constraints.cell(&self.lowest_limits());
            return None;
        };
        let (at, place, joints, rates) = self.regular(&robot.kinematics, at, joints)?;
        let joints = &joints;
        constraints.all_axes(&rates, pace);
        match &self.curve {
            Curve::Axes(_) => {
                if pace.manual {
                    constraints.manual_place(joints, &rates[0], &self.rig.carried);
                }
                if pace.tcp.is_finite() {
                    constraints.moving(&self.moving_by_axes(&robot.kinematics, at, joints), pace);
                }
            }
            Curve::Tool(curve) => {
                let moving = place.vectors([1, 2, 3].map(|order| curve.path.track.derivative(order, place.at)));
                constraints.moving(&moving, pace);
                constraints.turning(&place.vectors(curve.rotation_rates(place.at)), pace);
                if pace.manual {
                    constraints.manual_moving(&moving);
                    constraints.manual_flange(curve, place.at, place.first);
                }
            }
        }
        if let Some(rise) = rise.filter(|_| !self.is_free) {
            constraints.rising_in(rise);
        }
        Some(rates)
    }

    /// The place after `at` s of nominal time with the rates there; `None` at a singular point.
    fn place_with_rates(&self, kinematics: &Kinematics, at: f64, joints: &Joints) -> Option<(CurvePoint, Rates)> {
        let width = (self.to - self.from) / self.time;
        let share = self.from + at * width;
        let even = CurvePoint { at: share, first: 1.0, second: 0.0, third: 0.0 };
        let place = self
            .parametrization
            .as_ref()
            .map_or(even, |parametrization| CurvePoint::at(parametrization, share))
            .scaled(width);
        Some((place, place.rates(self.curve.rates(kinematics, place.at, joints)?)))
    }

    /// The place after `at` s of nominal time with the rates there; at a singular point, those of a place beside it,
    /// towards the middle, as if the axes continued evenly. `None` where all places beside it are singular, too.
    fn regular(&self, kinematics: &Kinematics, at: f64, joints: &Joints) -> Option<(f64, CurvePoint, Joints, Rates)> {
        let look = |at: f64, joints: Joints| {
            let (place, rates) = self.place_with_rates(kinematics, at, &joints)?;
            Some((at, place, joints, rates))
        };
        let beside = |share: &f64| {
            let away = share * self.time;
            let at = if at < 0.5 * self.time { at + away } else { at - away };
            look(at, self.joints_on(kinematics, at, joints))
        };
        look(at, *joints).or_else(|| SHARES_BESIDE_SINGULAR.iter().find_map(beside))
    }

    /// The first two derivatives of all axes by the nominal time, after `at` s of it, where the axes are at `joints`.
    /// `None` at a singular point.
    pub(crate) fn rates(&self, kinematics: &Kinematics, at: f64, joints: &Joints) -> Option<[[f64; ALL]; 2]> {
        let (.., [first, second, _]) = self.place_with_rates(kinematics, at, joints)?;
        Some([first, second])
    }

    /// The share of the motion that is done at its end.
    pub(crate) fn share_at_end(&self) -> f64 {
        self.shares[1]
    }

    /// The share of the motion that is done after `at` s of nominal time.
    pub(crate) fn share(&self, at: f64) -> f64 {
        let [from, to] = self.shares;
        from + (to - from) * (at / self.time).clamp(0.0, 1.0)
    }
}

/// Whether it is known what limits each place of a motion: not where it has an overlay.
fn is_known(motion: &Motion) -> bool {
    motion.laid.is_none()
}

/// Whether every place of a motion has limits of its own: not where its duration is given or it has an overlay, which
/// requires an even speed.
pub(crate) fn is_free(motion: &Motion) -> bool {
    motion.timed.is_none() && is_known(motion)
}

/// The next lower speed of a fine grid that contains the full speed, so that stretches of almost the same speed can be
/// merged.
fn on_grid(vel: f64) -> f64 {
    const STEP: f64 = 1.003;
    // A speed must not lose a step due to rounding.
    let steps = (libm::log(vel) / libm::log(STEP) + 1e-6).floor();
    if steps.is_finite() { libm::pow(STEP, steps) } else { vel }
}
