//! Motions that are planned.

use crate::command::Weave;
use crate::command::Zone;
use crate::command::joints::Joints;
use crate::limits::duration::{DURATION_TOLERANCE, slowest_within};
use crate::limits::profile::LOOK_AHEAD_MARGIN;
use crate::limits::profile::Limits;
use crate::overlay::Led;
use crate::overlay::compensation::Shift;
use crate::overlay::path_frame::PathFrame;
use crate::plan::constraints::PathLimits;
use crate::plan::curve::Curve;
use crate::plan::path_check::NearSingular;
use arl_robot::frames::Rig;
use arl_robot::robot::VelocityProfile;

/// Ways of the TCP that are shorter, in mm and deg, are none: targets that differ by so little are the same.
pub(crate) const NO_WAY_MM_OR_DEG: f64 = 1e-5;

/// A motion that is ready to run, from the target before it to its own.
#[derive(Clone, PartialEq, Debug)]
pub struct Motion {
    pub(crate) curve: Curve,
    pub(crate) start: Joints,
    pub(crate) end: Joints,
    pub(crate) rig: Rig,
    /// `None` for a motion that goes nowhere.
    pub(crate) limits: Option<Limits>,
    /// The nominal speed, as part of the motion per s, at which it meets its neighbours; at most `limits` are reached.
    pub(crate) rate: f64,
    /// Whether it goes on smoothly from the motion before it, at the same nominal speed.
    pub(crate) flows: bool,
    pub(crate) pace: PathLimits,
    pub(crate) profile: VelocityProfile,
    /// The speed that it could have, where a duration was programmed.
    pub(crate) timed: Option<f64>,
    /// The length of the TCP's path in mm, 0 for axis motions.
    pub(crate) length: f64,
    /// The angle in deg by which the tool turns on its path, 0 for axis motions.
    pub(crate) angle: f64,
    pub(crate) zone: Zone,
    /// The form of the blend with the next motion, where that is not left to the zone.
    pub(crate) corner: Option<GivenCorner>,
    /// Whether the instruction ends with it.
    pub(crate) ends: bool,
    /// From which share of the instruction to which it goes.
    pub(crate) stretch: [f64; 2],
    pub(crate) line: u32,
    /// Where it passes close to a singular point.
    pub(crate) near_singular: Option<NearSingular>,
    /// What is laid over it.
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

    /// How long it takes from rest to rest at an override of 100 %, in s: where its duration is given, as it is
    /// executed, braking a little more gently than its limits allow; else as the limits allow.
    pub fn duration(&self) -> f64 {
        self.limits.map_or(0.0, |limits| self.duration_with(&limits))
    }

    /// The same with these limits.
    pub(crate) fn duration_with(&self, limits: &Limits) -> f64 {
        if self.timed.is_some() { limits.duration_braking(1.0, LOOK_AHEAD_MARGIN) } else { limits.duration(1.0) }
    }

    /// The same where an acceleration takes `rise` s to rise: a programmed duration is kept for all that, as long as
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

    /// The share of the instruction that is done where so much of the motion is.
    pub(crate) fn of_instruction(&self, share: f64) -> f64 {
        let [from, to] = self.stretch;
        from + (to - from) * share
    }

    /// Whether the TCP goes or the tool turns.
    pub(crate) fn moves_tool(&self) -> bool {
        self.length.max(self.angle) >= NO_WAY_MM_OR_DEG
    }

    /// Whether anything moves.
    pub(crate) fn goes(&self) -> bool {
        self.limits.is_some()
    }

    /// The part of its speed that is left to it with what is laid over it.
    pub fn share_of_speed(&self) -> f64 {
        match (&self.laid, self.limits) {
            (Some(laid), Some(limits)) => limits.vel / laid.plain_speed().unwrap_or(self.rate),
            _ => 1.0,
        }
    }

    /// How fast the TCP may go with what is laid over the motion, in mm/s.
    pub(crate) fn fastest(&self) -> f64 {
        self.laid.as_ref().map_or(f64::INFINITY, |laid| laid.fastest)
    }

    /// How a compensation stands at the end, for the motion behind it.
    pub(crate) fn led(&self) -> Led {
        self.laid.as_ref().map_or_else(Led::default, |laid| laid.led())
    }

    /// The length of the TCP's path in mm; 0 for axis motions.
    pub fn length(&self) -> f64 {
        self.length
    }
}

/// A blend between two motions of the axes that is given: where it leaves the first one and where it joins the second.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct GivenCorner {
    pub(crate) leaving: CornerEnd,
    pub(crate) joining: CornerEnd,
}

/// One end of a given blend, in parts of the motion that is met there.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct CornerEnd {
    /// How much of the motion the blend takes.
    pub(crate) part: f64,
    /// How fast the motion is met, as it goes on, and how that speed rises: by the blend's own parameter, which goes
    /// from 0 to 1.
    pub(crate) speed: f64,
    pub(crate) acc: f64,
}

impl CornerEnd {
    /// The same form, smaller or larger, where it takes another part.
    pub(crate) fn taking(self, part: f64) -> Self {
        let share = part / self.part;
        Self { part, speed: self.speed * share, acc: self.acc * share }
    }

    /// The same where the motion is gone the other way.
    pub(crate) fn reversed(self) -> Self {
        Self { acc: -self.acc, ..self }
    }
}

impl GivenCorner {
    /// The parts that it takes.
    pub(crate) fn parts(&self) -> (f64, f64) {
        (self.leaving.part, self.joining.part)
    }
}

/// A motion as it was planned, and what is laid over it: enough to lay it anew when it is blended with a neighbour.
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
    /// How corners are rounded, in s.
    pub(crate) rounding: f64,
    /// How long it has been going on at the start, in s at full speed.
    pub(crate) begun: f64,
    /// Whether it goes back to the path at the end.
    pub(crate) fades: bool,
}

impl OverlaidMotion {
    /// How fast the motion may go without what is laid over it, as part of the motion per s.
    pub(crate) fn plain_speed(&self) -> Option<f64> {
        self.plain.limits.map(|limits| limits.vel)
    }

    /// How the compensation stands at the end.
    pub(crate) fn led(&self) -> Led {
        match (&self.plain.curve, &self.shift) {
            (Curve::Tool(curve), Some(shift)) => shift.led(&curve.path, curve.carried, self.frame.as_ref()),
            _ => Led::default(),
        }
    }
}
