//! Collects what limits the parameter of a motion: every axis, the TCP, the tool's rotation, the programmed speeds.

use nalgebra::Vector3;

use crate::command::joints::{ALL, Joints};
use crate::geometry::parametrization::Parametrization;
use crate::limits::constant::Constraint;
use crate::limits::profile::Limits;
use crate::plan::curve::{Curve, ToolCurve};
use arl_robot::frames::Carried;
use arl_robot::kinematics::Axes;
use arl_robot::robot::{Axis, EXTERNAL_AXES, Robot};

/// The highest speed of the TCP in manual low-speed mode, in mm/s.
pub(crate) const MANUAL_SPEED_MM_S: f64 = 250.0;
/// Factor for derivatives, which are a little larger between the checked places of a path than at them.
const BETWEEN_SAMPLES_FACTOR: f64 = 1.005;
/// Number of places at which a curved path of the TCP is checked; and the number for each part where the pace consists
/// of parts: there the path may turn within a small part of its time.
const PLACES_OF_CURVE: u32 = 24;
const PLACES_OF_PART: u32 = 6;
/// Distance from a jump at which its other side is checked.
const BESIDE_SHARE: f64 = 1e-9;

/// The speed and the accelerations that a motion may have.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct PathLimits {
    /// Share of the own axes' speeds.
    pub(crate) axes: f64,
    /// Speed of the TCP in mm/s.
    pub(crate) tcp: f64,
    /// Rotation of the tool in deg/s.
    pub(crate) ori: f64,
    /// Rotary external axes in deg/s.
    pub(crate) turning: f64,
    /// Linear external axes in mm/s.
    pub(crate) linear: f64,
    /// Share of all accelerations.
    pub(crate) acc: f64,
    /// Share of all jerks.
    pub(crate) jerk: f64,
    /// Whether the TCP is limited to the speed of manual operation.
    pub(crate) manual: bool,
}

impl PathLimits {
    /// The robot's own limits alone.
    pub(crate) const FREE: Self = Self {
        axes: 1.0,
        tcp: f64::INFINITY,
        ori: f64::INFINITY,
        turning: f64::INFINITY,
        linear: f64::INFINITY,
        acc: 1.0,
        jerk: 1.0,
        manual: false,
    };

    /// Speed, acceleration and jerk that one of the robot's own axes may have.
    pub(crate) fn of_own(&self, axis: &Axis) -> [f64; 3] {
        [axis.vel * self.axes, axis.acc * self.acc, axis.jerk * self.jerk]
    }

    /// Speed, acceleration and jerk that an external axis may have.
    pub(crate) fn of_external(&self, axis: &Axis) -> [f64; 3] {
        let vel = axis.vel.min(if axis.linear { self.linear } else { self.turning });
        [vel, axis.acc * self.acc, axis.jerk * self.jerk]
    }
}

/// The bounds of one place, and the part of the blend that they apply to: up to the neighbouring places.
pub(crate) struct PlaceBounds<'a> {
    /// Shares of the blend's nominal time.
    pub(crate) from: f64,
    pub(crate) to: f64,
    pub(crate) rows: &'a [Constraint],
}

/// The limits found so far.
pub(crate) struct Constraints<'a> {
    robot: &'a Robot,
    pub(crate) rows: Vec<Constraint>,
    /// Whether the rows keep the signs of the derivatives.
    signed: bool,
    /// Where the rows of a place begin, with its share of the nominal time.
    places: Vec<(usize, f64)>,
}

impl<'a> Constraints<'a> {
    /// Creates constraints whose rows are magnitudes.
    pub(crate) fn new(robot: &'a Robot) -> Self {
        Self { robot, rows: Vec::with_capacity(64), signed: false, places: Vec::new() }
    }

    /// Creates constraints whose rows keep the signs of the derivatives, for one place.
    pub(crate) fn signed(robot: &'a Robot) -> Self {
        Self { signed: true, ..Self::new(robot) }
    }

    fn push(&mut self, constraint: Constraint) {
        self.rows.push(if self.signed { constraint } else { constraint.size() });
    }

    /// Removes all rows.
    pub(crate) fn clear(&mut self) {
        self.rows.clear();
        self.places.clear();
    }

    /// Assigns the rows that follow to a place at this share of the nominal time.
    pub(crate) fn place(&mut self, share: f64) {
        self.places.push((self.rows.len(), share));
    }

    /// The rows of each place. Places of one kind are added in order, one kind after the other.
    pub(crate) fn by_place(&self) -> Vec<PlaceBounds<'_>> {
        let place = |index: usize, (start, share): (usize, f64)| {
            let before = index.checked_sub(1).and_then(|index| self.places.get(index));
            let behind = self.places.get(index + 1);
            let end = behind.map_or(self.rows.len(), |(end, _)| *end);
            PlaceBounds {
                from: before.map(|(_, share)| *share).filter(|before| *before <= share).unwrap_or(0.0),
                to: behind.map(|(_, share)| *share).filter(|behind| *behind >= share).unwrap_or(1.0),
                rows: self.rows.get(start..end).unwrap_or_default(),
            }
        };
        self.places.iter().enumerate().map(|(index, known)| place(index, *known)).collect()
    }

    /// Merges the rows from `known` on, which belong to one place, into the first rows, which belong to others: the
    /// result holds at all of these places.
    pub(crate) fn join(&mut self, known: usize) {
        if known == 0 {
            return;
        }
        let (joined, new) = self.rows.split_at_mut(known);
        for (constraint, new) in joined.iter_mut().zip(new) {
            constraint.first = constraint.first.max(new.first);
            constraint.second = constraint.second.max(new.second);
            constraint.third = constraint.third.max(new.third);
        }
        self.rows.truncate(known);
    }

    /// Adds the limits of all axes moving evenly from `start` to `end`.
    pub(crate) fn even_axes(&mut self, start: &Joints, end: &Joints, pace: &PathLimits) {
        for (axis, (start, end)) in self.robot.own_axes().iter().zip(start.axes.iter().zip(&end.axes)) {
            self.push(Constraint::even(end - start, axis.vel * pace.axes, axis.acc * pace.acc, axis.jerk * pace.jerk));
        }
        self.even_external(start, end, pace);
    }

    /// Adds the limits of the external axes moving evenly from `start` to `end`.
    pub(crate) fn even_external(&mut self, start: &Joints, end: &Joints, pace: &PathLimits) {
        let travels = start.external.iter().zip(&end.external).map(|(start, end)| end - start);
        for (axis, travel) in self.robot.external_axes().iter().zip(travels) {
            let programmed = if axis.linear { pace.linear } else { pace.turning };
            let vel = axis.vel.min(programmed);
            self.push(Constraint::even(travel, vel, axis.acc * pace.acc, axis.jerk * pace.jerk));
        }
    }

    /// Adds the limits of the robot's own axes at a place with these derivatives.
    pub(crate) fn axes(&mut self, first: &Axes, second: &Axes, third: &Axes, pace: &PathLimits) {
        let derivatives = first.iter().zip(second).zip(third);
        for (axis, ((first, second), third)) in self.robot.own_axes().iter().zip(derivatives) {
            self.push(row([*first, *second, *third], pace.of_own(axis)));
        }
    }

    /// Adds the limits of all axes at a place with these derivatives.
    pub(crate) fn all_axes(&mut self, derivatives: &[[f64; ALL]; 3], pace: &PathLimits) {
        let parts = derivatives.map(|all| Joints::of(&all));
        let [first, second, third] = &parts;
        self.axes(&first.axes, &second.axes, &third.axes, pace);
        self.external(&parts.map(|part| part.external), pace);
    }

    /// Lets the parameter's acceleration take at least `time` s to rise to what the rows of this place allow.
    pub(crate) fn rising_in(&mut self, time: f64) {
        let acc = self.rows.iter().map(|row| row.acc / row.first.abs()).fold(f64::INFINITY, f64::min);
        self.push(Constraint::even(1.0, f64::INFINITY, f64::INFINITY, acc / time));
    }

    /// Adds constant limits of the parameter itself.
    pub(crate) fn cell(&mut self, limits: &Limits) {
        let Limits { vel, acc, jerk } = *limits;
        self.push(Constraint::even(1.0, vel, acc, jerk));
    }

    /// Adds the limits of the TCP on its path, and of the rotation of the tool.
    pub(crate) fn tool(&mut self, curve: &ToolCurve, pace: &PathLimits) {
        for place in places(curve) {
            self.moving(&[1, 2, 3].map(|order| curve.path.track.derivative(order, place)), pace);
            self.turning(&curve.rotation_rates(place), pace);
        }
    }

    /// Adds the limits of the TCP at a place with these derivatives of its position, in mm.
    pub(crate) fn moving(&mut self, rates: &[Vector3<f64>; 3], pace: &PathLimits) {
        let tcp = &self.robot.tcp;
        self.push(along(rates, (tcp.vel.min(pace.tcp), tcp.acc * pace.acc, tcp.jerk * pace.jerk)));
    }

    /// Adds the limits of the TCP at a place with these derivatives of its position, in mm, where it swings to and fro:
    /// all of its acceleration counts, not only the part along its path.
    pub(crate) fn swinging(&mut self, rates: &[Vector3<f64>; 3], pace: &PathLimits) {
        let tcp = &self.robot.tcp;
        let limits = [tcp.vel.min(pace.tcp), tcp.acc * pace.acc, tcp.jerk * pace.jerk];
        self.rows.push(row(rates.map(|rate| rate.norm()), limits));
    }

    /// Adds the speed limit of the TCP in manual operation, at a place with these derivatives of its position.
    pub(crate) fn manual_moving(&mut self, rates: &[Vector3<f64>; 3]) {
        self.push(along(rates, (MANUAL_SPEED_MM_S, f64::INFINITY, f64::INFINITY)));
    }

    /// Adds the limits of the tool at a place with these rates of rotation, in rad.
    pub(crate) fn turning(&mut self, rates: &[Vector3<f64>; 3], pace: &PathLimits) {
        let tcp = &self.robot.tcp;
        let rates = rates.map(|rate| rate.map(f64::to_degrees));
        let limits = (tcp.ori_vel.min(pace.ori), tcp.ori_acc * pace.acc, tcp.ori_jerk * pace.jerk);
        self.push(along(&rates, limits));
    }

    /// Adds the limits of the external axes at a place with these derivatives.
    pub(crate) fn external(&mut self, rates: &[[f64; EXTERNAL_AXES]; 3], pace: &PathLimits) {
        let [first, second, third] = rates;
        let derivatives = first.iter().zip(second).zip(third);
        for (axis, ((first, second), third)) in self.robot.external_axes().iter().zip(derivatives) {
            self.push(row([*first, *second, *third], pace.of_external(axis)));
        }
    }

    /// Adds the limits of the external axes along a whole path.
    pub(crate) fn external_along(&mut self, curve: &ToolCurve, pace: &PathLimits) {
        for place in places(curve) {
            self.external(&[1, 2, 3].map(|order| curve.external.derivative(order, place)), pace);
        }
    }

    /// Adds a speed of the TCP, in mm/s, that must not be exceeded, whatever is programmed.
    pub(crate) fn cap_tool(&mut self, curve: &ToolCurve, vel: f64) {
        for place in places(curve) {
            let first = curve.path.track.derivative(1, place).norm();
            self.push(Constraint::even(first, vel, f64::INFINITY, f64::INFINITY));
        }
    }

    /// Adds the speed limit of the TCP of an axis motion in manual operation.
    pub(crate) fn manual_axes(&mut self, curve: &Curve, carried: &Carried, start: &Joints) {
        let Curve::Axes(axes) = curve else { return };
        let kinematics = &self.robot.kinematics;
        let farthest = axes.derivative(1, 0.0).iter().fold(0.0_f64, |most, rate| most.max(rate.abs()));
        let steps = 16 + (farthest / 2.0).min(1e4) as u32;
        for step in 0..=steps {
            let at = f64::from(step) / f64::from(steps);
            let joints = curve.joints(kinematics, at, start);
            self.manual_place(&joints, &axes.derivative(1, at), carried);
        }
    }

    /// Adds the speed limit of the TCP in manual operation, at a place where all axes change by `rates`; also that of
    /// the flange, where the tool is stationary.
    pub(crate) fn manual_place(&mut self, joints: &Joints, rates: &[f64; ALL], carried: &Carried) {
        self.cap_place(joints, rates, carried, MANUAL_SPEED_MM_S);
        if let Carried::Workpiece(_) = carried {
            let flange = self.robot.kinematics.forward(&joints.axes).translation.vector;
            self.cap_point(joints, rates, &flange, MANUAL_SPEED_MM_S);
        }
    }

    /// Adds a speed of the TCP in mm/s that must not be exceeded, at a place where all axes change by `rates`.
    pub(crate) fn cap_place(&mut self, joints: &Joints, rates: &[f64; ALL], carried: &Carried, vel: f64) {
        let place = match carried {
            Carried::Tool(tool) => (self.robot.kinematics.forward(&joints.axes) * tool).translation.vector,
            Carried::Workpiece(tool) => tool.translation.vector,
        };
        self.cap_point(joints, rates, &place, vel);
    }

    /// Adds a speed in mm/s that must not be exceeded by a point that the robot carries, given in the base in mm.
    fn cap_point(&mut self, joints: &Joints, rates: &[f64; ALL], place: &Vector3<f64>, vel: f64) {
        let rates = Joints::of(rates).axes;
        let speed = self.robot.kinematics.point_velocity(&joints.axes, &rates, place).norm() * BETWEEN_SAMPLES_FACTOR;
        self.push(Constraint::even(speed, vel, f64::INFINITY, f64::INFINITY));
    }

    /// Adds the speed limit of the flange in manual operation at a place of a path whose parameter changes by `rate`,
    /// where the tool is stationary; otherwise the TCP counts.
    pub(crate) fn manual_flange(&mut self, curve: &ToolCurve, at: f64, rate: f64) {
        if let Carried::Workpiece(_) = curve.carried {
            let [first, ..] = curve.twist(at).of_place(&curve.flange(at).translation.vector);
            let speed = first.norm() * rate * BETWEEN_SAMPLES_FACTOR;
            self.push(Constraint::even(speed, MANUAL_SPEED_MM_S, f64::INFINITY, f64::INFINITY));
        }
    }
}

/// The places at which to check a path: a single one where it is even.
fn places(curve: &ToolCurve) -> impl Iterator<Item = f64> + use<> {
    let paced = curve.is_paced();
    let count = if paced { PLACES_OF_PART * Parametrization::PARTS as u32 } else { PLACES_OF_CURVE };
    let even = (0..=if curve.is_even() { 0 } else { count }).map(move |place| f64::from(place) / f64::from(count));
    // Where derivatives jump, both sides count.
    let before = (1..if paced { Parametrization::PARTS } else { 0 })
        .map(|part| part as f64 / Parametrization::PARTS as f64 - BESIDE_SHARE);
    even.chain(before)
}

/// The constraint of a value with these derivatives, with a margin for the changes between places.
fn row([first, second, third]: [f64; 3], [vel, acc, jerk]: [f64; 3]) -> Constraint {
    let more = |value: f64| value * BETWEEN_SAMPLES_FACTOR;
    Constraint { first: more(first), second: more(second), third: more(third), vel, acc, jerk }
}

/// The constraint of a speed along a path with these derivatives, with its changes along the path.
///
/// Where a path all but turns back, its speed falls and rises at once, with hardly any jerk. There the component of the
/// jerk along the path counts, which is the smaller one.
fn along(rates: &[Vector3<f64>; 3], (vel, acc, jerk): (f64, f64, f64)) -> Constraint {
    let [p1, p2, p3] = rates;
    let first = p1.norm();
    if first < 1e-12 {
        return Constraint { first: 0.0, second: p2.norm(), third: p3.norm(), vel, acc, jerk };
    }
    let second = p1.dot(p2) / first;
    let along = p1.dot(p3) / first;
    let of_speed = along + (p2.norm_squared() - second * second) / first;
    let third = if of_speed.abs() < along.abs() { of_speed } else { along };
    Constraint { first, second, third, vel, acc, jerk }
}
