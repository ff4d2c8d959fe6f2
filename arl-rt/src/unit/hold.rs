//! Moving a robot beside its program as long as somebody holds a button.

use nalgebra::{Translation3, Unit as UnitVector, UnitQuaternion, Vector3};

use super::Unit;
use super::servo::{BESIDE, JOGGING};
use crate::motion::{Joints, Speed, Stop, Target};
use arl_robot::frames::Carried;
use arl_robot::kinematics::{Frame, frame_components};

/// The speeds of the TCP while it is jogged, in mm/s and deg/s.
const TCP_MM_S: f64 = 100.0;
const TCP_DEG_S: f64 = 20.0;
/// How far it is to go at most, in mm and deg: the first of these to which there is a way. Who still holds the button
/// goes on from there.
const WAYS_MM: [f64; 9] = [500.0, 200.0, 100.0, 50.0, 20.0, 10.0, 5.0, 2.0, 1.0];
const WAYS_DEG: [f64; 7] = [90.0, 45.0, 20.0, 10.0, 5.0, 2.0, 1.0];
/// An axis this near to where it is to go is there, in deg (mm).
const THERE: f64 = 1e-6;

/// What is moved while somebody holds it.
#[derive(Clone, PartialEq, Debug)]
pub(crate) enum HeldButton {
    /// An axis, from 1, towards the end of its range.
    Axis {
        /// From 1; external ones come behind the robot's own.
        axis: usize,
        /// Whether its value grows.
        up: bool,
    },
    /// The TCP along an axis of a frame, or about it.
    Tcp {
        /// x, y or z of the frame, and its direction.
        along: Vector3<f64>,
        /// Whether it turns.
        turns: bool,
        /// The frame: that of the tool, or one in the world of which the orientation counts.
        of: Seen,
    },
    /// All axes to these values in deg (mm), as many as there are.
    To(Vec<f64>),
}

/// What directions are seen in.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) enum Seen {
    Tool,
    Frame(UnitQuaternion<f64>),
}

/// What has become of the last button that moved the robot.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Button {
    /// There is none.
    Free,
    /// It moves the robot: motions above what was set aside, or those of no program at all.
    Held,
    /// The robot comes to rest.
    LetGo,
}

/// What pressing a button has led to.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum PressOutcome {
    /// The robot moves, or there was nothing to do.
    Begun,
    /// The robot comes to rest first.
    Waits,
}

impl Unit {
    /// Whether a button moves the robot, or did and it has not come to rest yet: then no program goes on.
    pub(crate) fn is_held(&self) -> bool {
        self.button != Button::Free
    }

    /// A button is pressed. `paused`: the robot's program is.
    pub(crate) fn press(&mut self, held: &HeldButton, paused: bool) -> Result<PressOutcome, String> {
        if self.button != Button::Free {
            return Ok(PressOutcome::Waits);
        }
        if paused {
            self.pause();
        }
        self.may_be_jogged()?;
        self.begin(held)?;
        Ok(PressOutcome::Begun)
    }

    /// The button is still pressed: where an end was reached the robot goes on.
    ///
    /// # Errors
    /// Something else has stopped the robot, or there is no way farther: it takes another press.
    pub(crate) fn keep_on(&mut self, held: &HeldButton) -> Result<(), String> {
        if self.button != Button::Held {
            return Err("the robot was stopped".into());
        }
        if self.queue.rests() && self.queue.idle_for(BESIDE) { self.begin(held) } else { Ok(()) }
    }

    /// Stops on the path; what is left of the way is dropped. What the button has not added stays.
    pub(crate) fn let_go(&mut self) {
        if self.button == Button::Held {
            self.button = Button::LetGo;
            self.queue.stop_on_path(Stop::General);
            self.queue.drop_added();
        }
    }

    /// Whether its set-points stand still.
    pub(crate) fn stands(&self) -> bool {
        self.queue.rests()
    }

    /// A cycle has ended.
    pub(super) fn note_rest(&mut self) {
        if self.button == Button::LetGo && self.queue.rests() {
            self.button = Button::Free;
        }
    }

    fn begin(&mut self, held: &HeldButton) -> Result<(), String> {
        match held {
            HeldButton::Axis { axis, up } => {
                let mut target = *self.setpoint();
                let range = self.robot.axes.get(axis.wrapping_sub(1)).map(|axis| [axis.min, axis.max]);
                let place = self.axis_of(&mut target, *axis)?;
                let [low, high] = range.unwrap_or([*place; 2]);
                *place = if *up { high } else { low };
                self.hold_to(target)
            }
            HeldButton::To(axes) => {
                let mut target = *self.setpoint();
                for (axis, value) in (1..).zip(axes) {
                    *self.axis_of(&mut target, axis)? = *value;
                }
                self.hold_to(target)
            }
            HeldButton::Tcp { along, turns, of } => self.hold_tcp(along, *turns, *of),
        }
    }

    /// Goes somewhere; from then on the button moves the robot.
    fn go_held(&mut self, target: Target, speed: Speed) -> Result<(), String> {
        self.go_beside(target, speed)?;
        self.button = Button::Held;
        Ok(())
    }

    fn hold_to(&mut self, target: Joints) -> Result<(), String> {
        if self.setpoint().is_at(&target, THERE) {
            return Ok(());
        }
        // External axes have speeds of their own in place of a share.
        let slowest = self.robot.external_axes().iter().map(|axis| axis.vel * JOGGING / 100.0).fold(f64::MAX, f64::min);
        let own = if slowest < f64::MAX { slowest } else { 1.0 };
        let speed = Speed { percent: JOGGING, tcp: TCP_MM_S, ori: TCP_DEG_S, exj: own, exl: own };
        self.go_held(Target::Joints(target), speed)
    }

    fn hold_tcp(&mut self, along: &Vector3<f64>, turns: bool, of: Seen) -> Result<(), String> {
        let rig = self.rig();
        if let Carried::Workpiece(_) = rig.carried {
            return Err(
                "the robot holds the workpiece and the tool is stationary: move the robot's axes instead".into()
            );
        }
        let here = *self.setpoint();
        let tcp = rig.tcp_at(&self.robot.kinematics.forward(&here.axes));
        let seen = match of {
            Seen::Tool => tcp.rotation,
            Seen::Frame(orientation) => orientation,
        };
        let along = seen * along;
        let speed = Speed { percent: JOGGING, tcp: TCP_MM_S, ori: TCP_DEG_S, exj: 1.0, exl: 1.0 };
        let ways: &[f64] = if turns { &WAYS_DEG } else { &WAYS_MM };
        for way in ways {
            let target = if turns {
                let turned = UnitQuaternion::from_axis_angle(&UnitVector::new_normalize(along), way.to_radians());
                Frame::from_parts(tcp.translation, turned * tcp.rotation)
            } else {
                Frame::from_parts(Translation3::from(tcp.translation.vector + along * *way), tcp.rotation)
            };
            let pose = frame_components(&target);
            let line = Target::Line { pose, wobj: Frame::identity(), external: here.external };
            if self.go_held(line, speed).is_ok() {
                return Ok(());
            }
        }
        Err("the robot cannot move farther in this direction".into())
    }
}
