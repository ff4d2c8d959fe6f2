//! How axes and TCP move, by the differences of set-points: what a trace shows.

use nalgebra::Vector3;

use crate::command::joints::{ALL, Joints};
use crate::queue::path_speed::PathSpeed;
use arl_robot::frames::Carried;
use arl_robot::kinematics::Frame;
use arl_robot::robot::Robot;

/// Speed, acceleration, jerk.
pub(super) const DERIVATIVES: usize = 3;

/// The last cycles.
#[derive(Clone, Debug)]
pub(super) struct Derivatives {
    joints: Joints,
    /// Speeds and accelerations of the axes.
    rates: [[f64; ALL]; 2],
    /// What was led last along a path; `None`: nothing was.
    led: Option<Carried>,
    carried: Option<Carried>,
    way: Frame,
    /// The TCP along its path, and the tool's turning in deg.
    moving: PathSpeed,
    turning: PathSpeed,
    /// How many of the TCP's derivatives are known.
    known: usize,
}

/// How a TCP moved in a cycle.
#[derive(Clone, Copy, Debug)]
pub(super) struct OfTool {
    /// mm
    pub(super) way: f64,
    /// Its speed along its path with two derivatives, in mm/s and so on.
    pub(super) moving: [f64; DERIVATIVES],
    /// The same of the tool's turning, in deg/s and so on.
    pub(super) turning: [f64; DERIVATIVES],
    /// How many of them are known: no more than there were cycles in which this TCP was led along its path.
    pub(super) known: usize,
}

impl Derivatives {
    /// Of a robot that stands there.
    pub(super) fn resting(joints: Joints) -> Self {
        Self {
            joints,
            rates: [[0.0; ALL]; 2],
            led: None,
            carried: None,
            way: Frame::identity(),
            moving: PathSpeed::default(),
            turning: PathSpeed::default(),
            known: DERIVATIVES,
        }
    }

    /// The speeds, accelerations and jerks of the axes in a cycle of `period` s that ends at these positions.
    pub(super) fn axes(&mut self, joints: &Joints, period: f64) -> [[f64; ALL]; DERIVATIVES] {
        let difference = |now: &[f64; ALL], before: &[f64; ALL]| -> [f64; ALL] {
            let mut rates = *now;
            rates.iter_mut().zip(before).for_each(|(now, before)| *now = (*now - before) / period);
            rates
        };
        let vel = difference(&joints.all(), &self.joints.all());
        let acc = difference(&vel, &self.rates[0]);
        let jerk = difference(&acc, &self.rates[1]);
        (self.joints, self.rates) = (*joints, [vel, acc]);
        [vel, acc, jerk]
    }

    /// A cycle in which nobody asks for a TCP: what comes next begins anew.
    pub(super) fn without_tool(&mut self, joints: &Joints, period: f64) {
        self.carried = None;
        self.axes(joints, period);
    }

    /// How a TCP moves in the same cycle, before its axes are looked at. `led`: what is led along a path.
    pub(super) fn tool(
        &mut self,
        carried: Carried,
        led: Option<Carried>,
        robot: &Robot,
        joints: &Joints,
        period: f64,
    ) -> OfTool {
        if self.carried != Some(carried) || self.led != led {
            self.way = carried.way_at(&robot.kinematics.forward(&self.joints.axes));
            let rests = self.rates.iter().flatten().all(|rate| *rate == 0.0);
            self.known = if rests { DERIVATIVES } else { 0 };
            (self.moving, self.turning) = (PathSpeed::default(), PathSpeed::default());
            (self.carried, self.led) = (Some(carried), led);
        }
        let way = carried.way_at(&robot.kinematics.forward(&joints.axes));
        let moved = way.translation.vector - self.way.translation.vector;
        let turned: Vector3<f64> = (way.rotation * self.way.rotation.inverse()).scaled_axis().map(f64::to_degrees);
        self.way = way;
        self.known = (self.known + 1).min(DERIVATIVES);
        let (moving, turning) = (self.moving.derivatives(moved, period), self.turning.derivatives(turned, period));
        OfTool { way: moved.norm(), moving, turning, known: self.known }
    }
}
