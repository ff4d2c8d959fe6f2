//! Derivatives of axes and TCP from differences of set-points, as a trace shows them.

use nalgebra::Vector3;

use crate::command::joints::{ALL, Joints};
use crate::queue::path_speed::PathSpeed;
use arl_robot::frames::Carried;
use arl_robot::kinematics::Frame;
use arl_robot::robot::Robot;

/// Number of derivatives: speed, acceleration, jerk.
pub(super) const DERIVATIVES: usize = 3;

/// State of the last cycles.
#[derive(Clone, Debug)]
pub(super) struct Derivatives {
    joints: Joints,
    /// Velocities and accelerations of the axes.
    rates: [[f64; ALL]; 2],
    /// What was last moved along a path; `None` where nothing was.
    guided: Option<Carried>,
    carried: Option<Carried>,
    tcp: Frame,
    /// The TCP along its path, and the rotation of the tool in deg.
    moving: PathSpeed,
    turning: PathSpeed,
    /// Number of derivatives of the TCP that are known.
    known: usize,
}

/// How a TCP moved in a cycle.
#[derive(Clone, Copy, Debug)]
pub(super) struct OfTool {
    /// Distance covered, in mm.
    pub(super) distance: f64,
    /// Speed of the TCP along its path with two derivatives, in mm/s and so on.
    pub(super) moving: [f64; DERIVATIVES],
    /// Speed of the tool's rotation with two derivatives, in deg/s and so on.
    pub(super) turning: [f64; DERIVATIVES],
    /// Number of known derivatives: at most the number of cycles in which this TCP was moved along its path.
    pub(super) known: usize,
}

impl Derivatives {
    /// The derivatives of a robot at rest at `joints`.
    pub(super) fn resting(joints: Joints) -> Self {
        Self {
            joints,
            rates: [[0.0; ALL]; 2],
            guided: None,
            carried: None,
            tcp: Frame::identity(),
            moving: PathSpeed::default(),
            turning: PathSpeed::default(),
            known: DERIVATIVES,
        }
    }

    /// The velocities, accelerations and jerks of the axes in a cycle of `period` s that ends at these positions.
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

    /// Handles a cycle in which no TCP is asked for: the TCP's derivatives start again afterwards.
    pub(super) fn without_tool(&mut self, joints: &Joints, period: f64) {
        self.carried = None;
        self.axes(joints, period);
    }

    /// Finds how a TCP moves in the same cycle; called before `axes`. `guided`: what is moved along a path.
    pub(super) fn tool(
        &mut self,
        carried: Carried,
        guided: Option<Carried>,
        robot: &Robot,
        joints: &Joints,
        period: f64,
    ) -> OfTool {
        if self.carried != Some(carried) || self.guided != guided {
            self.tcp = carried.path_frame_at(&robot.kinematics.forward(&self.joints.axes));
            let rests = self.rates.iter().flatten().all(|rate| *rate == 0.0);
            self.known = if rests { DERIVATIVES } else { 0 };
            (self.moving, self.turning) = (PathSpeed::default(), PathSpeed::default());
            (self.carried, self.guided) = (Some(carried), guided);
        }
        let tcp = carried.path_frame_at(&robot.kinematics.forward(&joints.axes));
        let moved = tcp.translation.vector - self.tcp.translation.vector;
        let turned: Vector3<f64> = (tcp.rotation * self.tcp.rotation.inverse()).scaled_axis().map(f64::to_degrees);
        self.tcp = tcp;
        self.known = (self.known + 1).min(DERIVATIVES);
        let (moving, turning) = (self.moving.derivatives(moved, period), self.turning.derivatives(turned, period));
        OfTool { distance: moved.norm(), moving, turning, known: self.known }
    }
}
