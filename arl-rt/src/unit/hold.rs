//! Moving a robot beside its program as long as a button is held.

use nalgebra::{Translation3, Unit as UnitVector, UnitQuaternion, Vector3};

use super::Unit;
use super::servo::{BESIDE, JOGGING};
use crate::motion::{Joints, Speed, Stop, Target};
use arl_robot::frames::Carried;
use arl_robot::kinematics::{Frame, frame_components};

/// The speeds of the TCP while it is jogged, in mm/s and deg/s.
const TCP_MM_S: f64 = 100.0;
const TCP_DEG_S: f64 = 20.0;
/// The distance to plan at most, in mm and deg: the first of these that the robot can move. While the button is held
/// the robot goes on from there.
const DISTANCES_MM: [f64; 9] = [500.0, 200.0, 100.0, 50.0, 20.0, 10.0, 5.0, 2.0, 1.0];
const ANGLES_DEG: [f64; 7] = [90.0, 45.0, 20.0, 10.0, 5.0, 2.0, 1.0];
/// An axis this near to its target has reached it, in deg (mm).
const THERE: f64 = 1e-6;

/// What moves while the button is held.
#[derive(Clone, PartialEq, Debug)]
pub(crate) enum HeldButton {
    /// An axis, from 1, towards the end of its range.
    Axis {
        /// The number from 1; external axes follow the robot's own.
        axis: usize,
        /// Whether its value grows.
        up: bool,
    },
    /// The TCP along an axis of a frame, or about it.
    Tcp {
        /// x, y or z of the frame, and its direction.
        along: Vector3<f64>,
        /// Whether the TCP turns about it.
        turns: bool,
        /// The frame: that of the tool, or one in the world, of which only the orientation counts.
        of: Seen,
    },
    /// All axes to these values in deg (mm), as many as are given.
    To(Vec<f64>),
}

/// The frame of reference for directions.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) enum Seen {
    Tool,
    Frame(UnitQuaternion<f64>),
}

/// The state of the button that moves the robot.
#[derive(Clone, Copy, PartialEq, Eq, Default, Debug)]
pub(super) enum Button {
    /// No button moves the robot.
    #[default]
    Free,
    /// It moves the robot: with motions above what was set aside, or with motions of no program.
    Held,
    /// It was released; the robot comes to rest.
    LetGo,
}

/// The state of moving the robot beside its program.
#[derive(Default, Debug)]
pub(super) struct Jogging {
    /// Whether the robot has to rest until `Unit::go_on` is called.
    pub(super) halted: bool,
    /// Whether it was moved beside its path meanwhile.
    pub(super) jogged: bool,
    /// The button that moves it.
    pub(super) button: Button,
}

/// The result of pressing a button.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum PressOutcome {
    /// The robot moves, or nothing was to be done.
    Begun,
    /// The robot comes to rest first.
    Waits,
}

impl Unit {
    /// Whether a button moves the robot, or did and the robot has not come to rest yet: then no program goes on.
    pub(crate) fn is_held(&self) -> bool {
        self.jogging.button != Button::Free
    }

    /// Presses a button. `paused`: the robot's program is paused.
    pub(crate) fn press(&mut self, held: &HeldButton, paused: bool) -> Result<PressOutcome, String> {
        if self.jogging.button != Button::Free {
            return Ok(PressOutcome::Waits);
        }
        if paused {
            self.pause();
        }
        self.may_be_jogged()?;
        self.begin(held)?;
        Ok(PressOutcome::Begun)
    }

    /// Keeps the button pressed: where the planned distance has been covered, the robot goes on.
    ///
    /// # Errors
    /// Something else has stopped the robot, or it cannot move farther: the button has to be pressed again.
    pub(crate) fn keep_on(&mut self, held: &HeldButton) -> Result<(), String> {
        if self.jogging.button != Button::Held {
            return Err("the robot was stopped".into());
        }
        if self.queue.rests() && self.queue.idle_for(BESIDE) { self.begin(held) } else { Ok(()) }
    }

    /// Releases the button: stops on the path; the rest of the motion is dropped. Motions that the button has not added
    /// stay.
    pub(crate) fn let_go(&mut self) {
        if self.jogging.button == Button::Held {
            self.jogging.button = Button::LetGo;
            self.queue.stop_on_path(Stop::General);
            self.queue.drop_added();
        }
    }

    /// Whether its set-points are at rest.
    pub(crate) fn stands(&self) -> bool {
        self.queue.rests()
    }

    /// Frees a released button once the robot is at rest; called at the end of a cycle.
    pub(super) fn note_rest(&mut self) {
        if self.jogging.button == Button::LetGo && self.queue.rests() {
            self.jogging.button = Button::Free;
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
                self.move_to(target)
            }
            HeldButton::To(axes) => {
                let mut target = *self.setpoint();
                for (axis, value) in (1..).zip(axes) {
                    *self.axis_of(&mut target, axis)? = *value;
                }
                self.move_to(target)
            }
            HeldButton::Tcp { along, turns, of } => self.move_tcp(along, *turns, *of),
        }
    }

    /// Plans a motion to the target; from then on the button moves the robot.
    fn go_held(&mut self, target: Target, speed: Speed) -> Result<(), String> {
        self.go_beside(target, speed)?;
        self.jogging.button = Button::Held;
        Ok(())
    }

    fn move_to(&mut self, target: Joints) -> Result<(), String> {
        if self.setpoint().is_at(&target, THERE) {
            return Ok(());
        }
        // External axes have absolute speeds in place of a percentage.
        let slowest = self.robot.external_axes().iter().map(|axis| axis.vel * JOGGING / 100.0).fold(f64::MAX, f64::min);
        let own = if slowest < f64::MAX { slowest } else { 1.0 };
        let speed = Speed { percent: JOGGING, tcp: TCP_MM_S, ori: TCP_DEG_S, exj: own, exl: own };
        self.go_held(Target::Joints(target), speed)
    }

    fn move_tcp(&mut self, along: &Vector3<f64>, turns: bool, of: Seen) -> Result<(), String> {
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
        let distances: &[f64] = if turns { &ANGLES_DEG } else { &DISTANCES_MM };
        for distance in distances {
            let target = if turns {
                let turned = UnitQuaternion::from_axis_angle(&UnitVector::new_normalize(along), distance.to_radians());
                Frame::from_parts(tcp.translation, turned * tcp.rotation)
            } else {
                Frame::from_parts(Translation3::from(tcp.translation.vector + along * *distance), tcp.rotation)
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
