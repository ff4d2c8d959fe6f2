//! The torques of the motors: the load on the flange, external forces, and collision detection.

use nalgebra::Vector3;

use super::Moving;
use crate::unit::dynamics::{Dynamics, Load, Wrench};
use arl_robot::cell::Sensitivity;
use arl_robot::frames::Rig;
use arl_robot::kinematics::{Axes, Frame};
use arl_robot::robot::{ROBOT_AXES, Robot};

/// By how much an axis may differ by default, in % of the greatest torque that it needs.
pub(crate) const SENSITIVITY: f64 = 20.0;

/// The load that the flange is assumed to carry, as a fraction of the weight of all links: about what makers of robots
/// rate. Without a load the last axes would need next to nothing, and every touch would be a collision.
const PAYLOAD: f64 = 0.08;
/// Its centre of mass relative to the flange, in mm, and how far it reaches from there.
const PAYLOAD_AT: [f64; 3] = [50.0, 0.0, 100.0];
const PAYLOAD_RADIUS: f64 = 50.0;

/// A torque counts as equal to a limit up to this much above it, in Nm (N).
const ROUNDING: f64 = 1e-6;

/// The forces and torques of a scenario on the robot.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
pub(crate) struct ExternalForces {
    /// A force at the TCP, in the world, N.
    pub(crate) force: [f64; 3],
    /// Torques on the axes, Nm (N).
    pub(crate) torques: [f64; ROBOT_AXES],
}

/// An axis that gives more or less torque than it should.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct Collision {
    /// The axis, from 0.
    pub(crate) axis: usize,
    /// The torque beyond that of the model, in Nm (N).
    pub(crate) surplus: f64,
    /// The allowed difference, in Nm (N).
    pub(crate) allowed: f64,
}

/// The robot's masses, its load and the external forces.
pub(super) struct Effort {
    /// `None`: the robot file has no masses.
    model: Option<Dynamics>,
    outside: ExternalForces,
    /// The torques that the driver measured in the last cycle.
    measured: Option<Axes>,
    /// By how much the axes may differ from the model while collision detection is on.
    allowed: Option<Axes>,
    /// The greatest torques that the axes need, computed at the first use.
    greatest: Option<Axes>,
}

impl Effort {
    pub(super) fn new(robot: &Robot) -> Self {
        let model = Dynamics::new(robot);
        Self { model, outside: ExternalForces::default(), measured: None, allowed: None, greatest: None }
    }

    pub(super) fn model(&self) -> Option<&Dynamics> {
        self.model.as_ref()
    }

    pub(super) fn set_base(&mut self, base: &Frame) {
        if let Some(model) = &mut self.model {
            model.set_base(base);
        }
    }

    pub(super) fn set_load(&mut self, load: &Load) {
        if let Some(model) = &mut self.model {
            model.set_load(load);
        }
    }

    pub(super) fn outside_mut(&mut self) -> &mut ExternalForces {
        &mut self.outside
    }

    pub(super) fn measured(&mut self, torques: Option<Axes>) {
        self.measured = torques;
    }

    pub(super) fn detect(&mut self, allowed: Option<Axes>) {
        self.allowed = allowed;
    }

    /// The torques that the motion needs by the model, without external forces.
    pub(super) fn asked(&self, moving: &Moving) -> Option<Axes> {
        let model = self.model.as_ref()?;
        Some(model.torques(&moving.at.axes, &moving.rates, &moving.accelerations, &Wrench::default()))
    }

    /// The torques of the axes beyond those of the model. `rig` is what the robot carries and where it stands.
    pub(super) fn surplus(&self, moving: &Moving, robot: &Robot, rig: &Rig) -> Option<Axes> {
        let model = self.model.as_ref()?;
        let mut surplus;
        match (self.measured, self.asked(moving)) {
            (Some(measured), Some(asked)) => {
                surplus = measured;
                surplus.iter_mut().zip(asked).for_each(|(surplus, asked)| *surplus -= asked);
            }
            _ if self.outside == ExternalForces::default() => surplus = [0.0; ROBOT_AXES],
            _ => {
                let force = rig.base.rotation.inverse() * Vector3::from(self.outside.force);
                let tcp = rig.tcp_at(&robot.kinematics.forward(&moving.at.axes));
                let point = (rig.base.inverse() * tcp).translation.vector;
                surplus = model.holding(&moving.at.axes, &Wrench { force, torque: Vector3::zeros() }, &point);
                surplus.iter_mut().zip(self.outside.torques).for_each(|(surplus, torque)| *surplus -= torque);
            }
        }
        Some(surplus)
    }

    /// The axis that differs most from the model, where collision detection is on and an axis differs too much.
    pub(super) fn collision(&self, moving: &Moving, robot: &Robot, rig: &Rig) -> Option<Collision> {
        let allowed = self.allowed?;
        let surplus = self.surplus(moving, robot, rig)?;
        let axes = surplus.into_iter().zip(allowed).enumerate();
        axes.map(|(axis, (surplus, allowed))| Collision { axis, surplus, allowed })
            .filter(|found| found.surplus.abs() > found.allowed + ROUNDING)
            .max_by(|a, b| (a.surplus.abs() / a.allowed).total_cmp(&(b.surplus.abs() / b.allowed)))
    }

    /// By how much the axes may differ from the model at this sensitivity.
    pub(super) fn allowed(&mut self, robot: &Robot, sensitivity: &Sensitivity) -> Option<Axes> {
        if self.greatest.is_none() {
            self.greatest = Dynamics::new(robot).map(|mut model| {
                model.set_load(&payload(robot));
                greatest(&model, robot)
            });
        }
        let most = self.greatest?;
        let mut allowed = [f64::INFINITY; ROBOT_AXES];
        match sensitivity {
            Sensitivity::Percent(percent) => {
                allowed.iter_mut().zip(most).for_each(|(allowed, most)| *allowed = most * percent / 100.0);
            }
            Sensitivity::Torques(torques) => {
                allowed.iter_mut().zip(torques).for_each(|(allowed, torque)| *allowed = *torque);
            }
        }
        Some(allowed)
    }
}

/// The load that the flange of a robot is assumed to carry.
fn payload(robot: &Robot) -> Load {
    let mass = PAYLOAD * robot.links.iter().map(|link| link.mass).sum::<f64>();
    let about = mass * PAYLOAD_RADIUS * PAYLOAD_RADIUS;
    Load::new(mass, PAYLOAD_AT, [about, 0.0, 0.0, about, 0.0, about])
}

/// The greatest torque that each axis needs while all axes accelerate as much as they may: in the middle and at the
/// ends of their ranges.
fn greatest(model: &Dynamics, robot: &Robot) -> Axes {
    let own = robot.own_axes();
    let mut accelerations = [0.0; ROBOT_AXES];
    accelerations.iter_mut().zip(own).for_each(|(acceleration, axis)| *acceleration = axis.acc);
    let mut most = [0.0_f64; ROBOT_AXES];
    for place in 0..3_usize.pow(own.len() as u32) {
        let (mut axes, mut digits) = ([0.0; ROBOT_AXES], place);
        for (at, axis) in axes.iter_mut().zip(own) {
            *at = axis.min + (axis.max - axis.min) * 0.5 * (digits % 3) as f64;
            digits /= 3;
        }
        for sign in [1.0, -1.0] {
            let accelerations = accelerations.map(|acceleration| acceleration * sign);
            let torques = model.torques(&axes, &[0.0; ROBOT_AXES], &accelerations, &Wrench::default());
            most.iter_mut().zip(torques).for_each(|(most, torque)| *most = most.max(torque.abs()));
        }
    }
    most
}
