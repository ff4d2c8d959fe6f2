//! Compensation: shifting and turning paths gradually, in frames that a program chooses.

use nalgebra::{UnitQuaternion, Vector3};

use crate::command::{Compensation, Reference, Settings};
use crate::geometry::tcp_path::TcpPath;
use crate::limits::constant::Constraint;
use crate::overlay::path_frame::{PathFrame, Rates, carried};
use crate::overlay::{easing, paced, times};
use arl_robot::frames::{Carried, Rig};
use arl_robot::kinematics::frame;

/// The shift of the TCP from its path, in mm, and its rotation, as a rotation vector in rad: along and about the axes
/// of what the path is relative to, unless stated otherwise.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
pub(crate) struct Lead {
    shift: Vector3<f64>,
    turn: Vector3<f64>,
}

impl Lead {
    fn of([x, y, z, a, b, c]: [f64; 6]) -> Self {
        Self { shift: Vector3::new(x, y, z), turn: frame([0.0, 0.0, 0.0, a, b, c]).rotation.scaled_axis() }
    }

    fn rotated(&self, by: &UnitQuaternion<f64>) -> Self {
        Self { shift: by * self.shift, turn: by * self.turn }
    }

    fn plus(&self, other: &Lead) -> Self {
        Self { shift: self.shift + other.shift, turn: self.turn + other.turn }
    }

    /// The frame that is led to `at`, without the lead.
    pub(crate) fn undone(&self, at: &arl_robot::kinematics::Frame) -> arl_robot::kinematics::Frame {
        let rotation = UnitQuaternion::from_scaled_axis(-self.turn) * at.rotation;
        arl_robot::kinematics::Frame::from_parts((at.translation.vector - self.shift).into(), rotation)
    }
}

/// The state of a compensation at the end of a motion, for the next one.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
pub(crate) struct CompensationState {
    pub(crate) lead: Lead,
    /// Number of the compensation; 0 for none.
    pub(crate) number: u32,
    /// y of [`Reference::ModifyPath`], along the axes of the path.
    across: Option<Vector3<f64>>,
    /// What the robot carries.
    carried: Option<Carried>,
}

impl CompensationState {
    /// The part that the next motion takes over: nothing under another compensation or none, or where its path is
    /// relative to something else.
    pub(crate) fn for_next(&self, settings: &Settings, rig: &Rig) -> Self {
        let goes_on = settings.compensation.is_some_and(|compensation| compensation.number == self.number);
        let alike = match (self.carried, rig.carried) {
            (Some(Carried::Tool(_)), Carried::Tool(_)) => true,
            (before, now) => before == Some(now),
        };
        if goes_on && alike { *self } else { Self::default() }
    }
}

/// A compensation along one motion: from the lead of the motion before to the requested one.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct Shift {
    from: Lead,
    /// In axes of what the path is relative to.
    fixed: Lead,
    /// In axes of the tool.
    tool: Lead,
    /// In axes of the path's frame.
    path: Lead,
    /// Share of the motion over which it grows; 0 where it is complete from the start.
    within: f64,
    /// Limits of its growth.
    limits: [f64; 6],
    /// Amount of growth, in mm and deg.
    by: [f64; 2],
    number: u32,
    /// 1, or -1 where y of the path's frame is reversed for [`Reference::ModifyPath`].
    side: f64,
}

/// The peaks of an easing of length 1: its highest speed, acceleration and jerk.
const EASING_PEAKS: [f64; 3] = [1.875, 5.773_502_691_896_258, 60.0];
/// Margin for the motion's own changes of speed: growth takes longer than necessary by this factor.
const GROWTH_TIME_FACTOR: f64 = 1.3;
/// Growth below this, in mm and deg, is ignored.
const NO_GROWTH: f64 = 1e-9;
/// The least share of a motion over which it grows.
const LEAST_GROWTH_SHARE: f64 = 1.0 / 16.0;

impl Shift {
    /// Creates the compensation of a motion along `curve` that takes `seconds` at its full speed. `workpiece` and
    /// `world` are the orientations of the workpiece frame and of the world, relative to what the path is relative to.
    pub(crate) fn new(
        compensation: &Compensation,
        before: &CompensationState,
        curve: &TcpPath,
        path: Option<&PathFrame>,
        [workpiece, world]: [&UnitQuaternion<f64>; 2],
        seconds: f64,
    ) -> Self {
        let total = |reference| Lead::of(compensation.total(reference));
        let world = total(Reference::World).rotated(world);
        let fixed = total(Reference::Wobj).rotated(workpiece).plus(&world);
        let across = path.map(|path| path.rotation(0.0) * Vector3::y());
        let back = across.zip(before.across).is_some_and(|(here, before)| here.dot(&before) < -1e-6);
        let side = if back { -1.0 } else { 1.0 };
        let mut modified = total(Reference::ModifyPath);
        modified.shift.y *= side;
        modified.turn = Vector3::zeros();
        let mut shift = Self {
            from: before.lead,
            fixed,
            tool: total(Reference::Tool),
            path: total(Reference::ToolPath).plus(&modified),
            within: 0.0,
            limits: compensation.limits,
            by: [0.0; 2],
            number: compensation.number,
            side,
        };
        if path.is_none() && compensation.follows_path() {
            // A motion without a direction keeps the current lead.
            (shift.fixed, shift.tool, shift.path) = (before.lead, Lead::default(), Lead::default());
        }
        let target = shift.target(curve, path, 0.0);
        let by = [(target.shift - shift.from.shift).norm(), (target.turn - shift.from.turn).norm().to_degrees()];
        if by.iter().any(|by| *by > NO_GROWTH) {
            let needed = by.iter().zip(shift.limits.chunks(3)).map(|(by, limits)| least_time(*by, limits));
            let part = GROWTH_TIME_FACTOR * needed.fold(0.0, f64::max) / seconds;
            shift.within = if part.is_nan() { 1.0 } else { part.clamp(LEAST_GROWTH_SHARE, 1.0) };
            shift.by = by;
        }
        shift
    }

    /// The state in which the motion behind this one begins.
    pub(crate) fn compensation_state(
        &self,
        curve: &TcpPath,
        carried: Carried,
        path: Option<&PathFrame>,
    ) -> CompensationState {
        let across = path.map(|path| path.rotation(1.0) * Vector3::y() * self.side);
        CompensationState { lead: self.target(curve, path, 1.0), number: self.number, across, carried: Some(carried) }
    }

    /// The lead that it grows to, as of `at`.
    fn target(&self, curve: &TcpPath, path: Option<&PathFrame>, at: f64) -> Lead {
        let along = path.map_or_else(Lead::default, |path| self.path.rotated(&path.rotation(at)));
        self.fixed.plus(&self.tool.rotated(&curve.rotation(at))).plus(&along)
    }

    fn growth(&self, at: f64) -> [f64; 4] {
        if self.within > 0.0 { paced(easing(at / self.within), 1.0 / self.within) } else { [1.0, 0.0, 0.0, 0.0] }
    }

    /// What is added to the position of the TCP, with its derivatives.
    pub(crate) fn offset(&self, curve: &TcpPath, path: Option<&PathFrame>, at: f64) -> Rates {
        let still = |vector: Vector3<f64>| [vector, Vector3::zeros(), Vector3::zeros(), Vector3::zeros()];
        let tool = carried(&curve.rotation(at), &curve.rotation_rates(at), &still(self.tool.shift));
        let along = path.map_or(still(Vector3::zeros()), |path| {
            carried(&path.rotation(at), &path.turning(at), &still(self.path.shift))
        });
        let fixed = still(self.fixed.shift - self.from.shift);
        let mut rates: Rates = std::array::from_fn(|order| {
            [fixed, tool, along].iter().filter_map(|rates| rates.get(order)).sum::<Vector3<f64>>()
        });
        rates = times(self.growth(at), rates);
        let [place, ..] = &mut rates;
        *place += self.from.shift;
        rates
    }

    /// The rotation vector by which the TCP is turned.
    pub(crate) fn turned(&self, curve: &TcpPath, path: Option<&PathFrame>, at: f64) -> Vector3<f64> {
        let [growth, ..] = self.growth(at);
        self.from.turn.lerp(&self.target(curve, path, at).turn, growth)
    }

    /// Whether it turns the tool at all.
    pub(crate) fn turns(&self) -> bool {
        [self.from, self.fixed, self.tool, self.path].iter().any(|lead| lead.turn != Vector3::zeros())
    }

    /// Whether it leads the TCP anywhere.
    pub(crate) fn leads(&self) -> bool {
        [self.from, self.fixed, self.tool, self.path].iter().any(|lead| *lead != Lead::default())
    }

    /// Whether it is incomplete at the start and grows.
    pub(crate) fn grows(&self) -> bool {
        self.within > 0.0
    }

    /// The share of the motion over which it does not change much.
    pub(crate) fn grain(&self) -> f64 {
        if self.grows() { self.within / 32.0 } else { 1.0 }
    }

    /// The constraints that keep its growth within its limits.
    pub(crate) fn constraints(&self) -> Vec<Constraint> {
        const PLACES: u32 = 24;
        let mut rows = Vec::new();
        for place in 0..=if self.grows() { PLACES } else { 0 } {
            let [_, first, second, third] = self.growth(self.within * f64::from(place) / f64::from(PLACES));
            for (by, limits) in self.by.iter().zip(self.limits.chunks(3)) {
                if let (&[vel, acc, jerk], true) = (limits, *by > NO_GROWTH) {
                    let [first, second, third] = [first, second, third].map(|rate| rate.abs() * by);
                    rows.push(Constraint { first, second, third, vel, acc, jerk });
                }
            }
        }
        rows
    }
}

/// The shortest time in s in which an easing over `by` keeps the limits of speed, acceleration and jerk.
fn least_time(by: f64, limits: &[f64]) -> f64 {
    let [vel, acc, jerk] = EASING_PEAKS;
    match limits {
        [most_vel, most_acc, most_jerk] => {
            (vel * by / most_vel).max((acc * by / most_acc).sqrt()).max(libm::cbrt(jerk * by / most_jerk))
        }
        _ => 0.0,
    }
}
