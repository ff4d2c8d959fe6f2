//! Planned motions.

use crate::command::Weave;
use crate::command::Zone;
use crate::command::joints::Joints;
use crate::limits::duration::{DURATION_TOLERANCE, slowest_within};
use crate::limits::profile::LOOK_AHEAD_MARGIN;
use crate::limits::profile::Limits;
use crate::overlay::CompensationState;
use crate::overlay::compensation::Shift;
use crate::overlay::path_frame::PathFrame;
use crate::plan::constraints::PathLimits;
use crate::plan::curve::Curve;
use crate::plan::path_check::NearSingular;
use arl_robot::frames::Rig;
use arl_robot::robot::VelocityProfile;

/// Paths of the TCP that are shorter than this, in mm and deg, do not count: such close targets are the same.
pub(crate) const NO_MOTION_MM_OR_DEG: f64 = 1e-5;

/// A motion that is ready to run, from the previous target to its own.
#[derive(Clone, PartialEq, Debug)]
pub struct Motion {
    pub(crate) curve: Curve,
    pub(crate) start: Joints,
    pub(crate) end: Joints,
    pub(crate) rig: Rig,
    /// `None` for a motion that goes nowhere.
    pub(crate) limits: Option<Limits>,
    /// The nominal speed, in shares of the motion per s, at which it meets its neighbours; at most `limits` are
    /// reached.
    pub(crate) rate: f64,
    /// Whether it continues smoothly from the motion before it, at the same nominal speed.
    pub(crate) flows: bool,
    pub(crate) pace: PathLimits,
    pub(crate) profile: VelocityProfile,
    /// The speed that it could have, where a duration was programmed.
    pub(crate) timed: Option<f64>,
    /// The length of the TCP's path in mm; 0 for axis motions.
    pub(crate) length: f64,
    /// The angle in deg by which the tool turns on its path; 0 for axis motions.
    pub(crate) angle: f64,
    pub(crate) zone: Zone,
    /// The form of the blend with the next motion, where it is not determined by the zone.
    pub(crate) corner: Option<GivenCorner>,
    /// Whether the instruction ends with it.
    pub(crate) ends: bool,
    /// The share of the instruction at its start, and that at its end.
    pub(crate) stretch: [f64; 2],
    pub(crate) line: u32,
    /// Where it passes close to a singular point.
    pub(crate) near_singular: Option<NearSingular>,
    /// The overlays on it.
    pub(crate) laid: Option<Box<OverlaidMotion>>,
}

impl Motion {
    /// Where it starts.
    pub fn start(&self) -> &Joints {
        &self.start
    }

    /// Where it ends.
    pub fn end(&self) -> &Joints {
        &self.end
    }

    /// The duration from rest to rest at an override of 100 %, in s: where a duration is given, as executed, braking a
    /// little more gently than the limits allow; else as the limits allow.
    pub fn duration(&self) -> f64 {
        self.limits.map_or(0.0, |limits| self.duration_with(&limits))
    }

    /// The duration with these limits.
    pub(crate) fn duration_with(&self, limits: &Limits) -> f64 {
        if self.timed.is_some() { limits.duration_braking(1.0, LOOK_AHEAD_MARGIN) } else { limits.duration(1.0) }
    }

    /// The motion with accelerations that take `rise` s to rise: a programmed duration is kept nevertheless, as long as
    /// the robot can go a little faster.
    pub(crate) fn rising_in(mut self, rise: f64) -> Self {
        if let (Some(highest), Some(limits)) = (self.timed, self.limits) {
            let wanted = limits.duration_braking(1.0, LOOK_AHEAD_MARGIN);
            let rising = |vel: f64| Limits { vel, ..limits }.rising_in(rise);
            if rising(limits.vel).duration_braking(1.0, LOOK_AHEAD_MARGIN) > wanted + DURATION_TOLERANCE.excess {
                let vel = slowest_within(wanted, [limits.vel, highest], rising);
                self.limits = Some(Limits { vel, ..limits });
            }
        }
        self
    }

    /// The share of the instruction that is done at this share of the motion.
    pub(crate) fn of_instruction(&self, share: f64) -> f64 {
        let [from, to] = self.stretch;
        from + (to - from) * share
    }

    /// Whether the TCP moves or the tool turns.
    pub(crate) fn moves_tool(&self) -> bool {
        self.length.max(self.angle) >= NO_MOTION_MM_OR_DEG
    }

    /// Whether anything moves.
    pub(crate) fn goes(&self) -> bool {
        self.limits.is_some()
    }

    /// The share of its speed that is left to it with its overlays.
    pub fn share_of_speed(&self) -> f64 {
        match (&self.laid, self.limits) {
            (Some(laid), Some(limits)) => limits.vel / laid.plain_speed().unwrap_or(self.rate),
            _ => 1.0,
        }
    }

    /// The highest speed of the TCP with the overlays on the motion, in mm/s.
    pub(crate) fn fastest(&self) -> f64 {
        self.laid.as_ref().map_or(f64::INFINITY, |laid| laid.fastest)
    }

    /// The state of a compensation at the end, for the motion behind it.
    pub(crate) fn compensation_state(&self) -> CompensationState {
        self.laid.as_ref().map_or_else(CompensationState::default, |laid| laid.compensation_state())
    }

    /// The length of the TCP's path in mm; 0 for axis motions.
    pub fn length(&self) -> f64 {
        self.length
    }
}

/// A given blend between two motions of the axes: where it leaves the first one and where it joins the second.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct GivenCorner {
    pub(crate) leaving: CornerEnd,
    pub(crate) joining: CornerEnd,
}

/// One end of a given blend, in shares of the motion that is met there.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct CornerEnd {
    /// Share of the motion that the blend takes.
    pub(crate) part: f64,
    /// The speed of the motion where it is met, along its direction, and the rise of that speed: by the blend's own
    /// parameter, which goes from 0 to 1.
    pub(crate) speed: f64,
    pub(crate) acc: f64,
}

impl CornerEnd {
    /// The same form, scaled to take another share.
    pub(crate) fn taking(self, part: f64) -> Self {
        let share = part / self.part;
        Self { part, speed: self.speed * share, acc: self.acc * share }
    }

    /// The same end where the motion runs in the opposite direction.
    pub(crate) fn reversed(self) -> Self {
        Self { acc: -self.acc, ..self }
    }
}

impl GivenCorner {
    /// The shares that it takes of both motions.
    pub(crate) fn parts(&self) -> (f64, f64) {
        (self.leaving.part, self.joining.part)
    }
}

/// A motion as it was planned, with its overlays: enough to lay them again when it is blended with a neighbour.
#[derive(Clone, PartialEq, Debug)]
pub(crate) struct OverlaidMotion {
    pub(crate) plain: Motion,
    /// Where it really starts.
    pub(crate) start: Joints,
    pub(crate) frame: Option<PathFrame>,
    pub(crate) weave: Option<Weaving>,
    pub(crate) shift: Option<Shift>,
    /// The highest speed of the TCP in mm/s.
    pub(crate) fastest: f64,
}

/// A weave over one motion.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct Weaving {
    pub(crate) weave: Weave,
    /// Duration of the rounding of corners, in s.
    pub(crate) rounding: f64,
    /// How long the weave has been running at the start, in s at full speed.
    pub(crate) begun: f64,
    /// Whether it returns to the path at the end.
    pub(crate) fades: bool,
}

impl OverlaidMotion {
    /// The speed that the motion may have without its overlays, in shares of the motion per s.
    pub(crate) fn plain_speed(&self) -> Option<f64> {
        self.plain.limits.map(|limits| limits.vel)
    }

    /// The state of the compensation at the end.
    pub(crate) fn compensation_state(&self) -> CompensationState {
        match (&self.plain.curve, &self.shift) {
            (Curve::Tool(curve), Some(shift)) => {
                shift.compensation_state(&curve.path, curve.carried, self.frame.as_ref())
            }
            _ => CompensationState::default(),
        }
    }
}
