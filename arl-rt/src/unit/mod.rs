//! A mechanical unit: the robot with its planned motion and its driver.

mod changes;
mod cycle;
mod driver_link;
pub mod dynamics;
mod effort;
pub(crate) mod hold;
mod motion_files;
mod moving;
mod planning;
mod range;
mod refusal;
pub mod robot_driver;
mod servo;
mod supervision;

use std::collections::HashSet;
use std::sync::Arc;
use std::time::Instant;

use crate::fault::File;
use crate::motion::{
    Compensation, Cycle, Joints, MotionRecord, NoBlend, Override, Progress, Queue, Recorder, Settings, UnblendedTarget,
};
use crate::unit::dynamics::{Dynamics, Load};
use crate::unit::robot_driver::{DriverError, Power, RobotDriver};
use crate::values::Joint;
use arl_robot::cell::Sensitivity;
use arl_robot::frames::Rig;
use arl_robot::kinematics::{Axes, Frame, frame_components};
use arl_robot::robot::{EXTERNAL_AXES, ROBOT_AXES, Robot};
use changes::{Change, Changes};
use driver_link::DriverLink;
use effort::Effort;
pub(crate) use effort::{Collision, ExternalForces, SENSITIVITY};
use hold::{Button, Jogging};
use motion_files::MotionFiles;
pub(crate) use moving::Moving;
pub(crate) use refusal::{Inherited, Mounts};
pub use servo::Motors;
use servo::Servo;

/// For how many cycles a robot that never stands exactly on its set-point must be near enough to it to count as
/// settled.
const SETTLING: u32 = 8;

/// The speeds of a robot at rest, or of axes that do not exist.
const REST: Joints = Joints { axes: [0.0; ROBOT_AXES], external: [0.0; EXTERNAL_AXES] };

/// A cycle, as the robot takes part in it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RobotCycle {
    /// Its length.
    pub(crate) cycle: Cycle,
    /// Whether the cycle takes real time.
    pub(crate) real: bool,
    /// When it ends, where it takes real time.
    pub(crate) due: Option<Instant>,
}

/// The robot with its planned motion and its driver.
pub(crate) struct Unit {
    robot: Arc<Robot>,
    queue: Queue,
    /// What `velset` and the mode have set.
    pub(crate) settings: Settings,
    speed_override: Override,
    commanded: Moving,
    reported: Moving,
    effort: Effort,
    /// Changes that take effect with motions that are planned.
    changes: Changes,
    link: DriverLink,
    /// The running number of the motion planned last, and of the one that ended last.
    planned: u64,
    finished: u64,
    /// The motion of the cycle before: its line and its running number.
    executing: (u32, u64),
    files: MotionFiles,
    /// For how many cycles the robot has been near enough to its set-point at rest.
    settled: u32,
    /// For how many cycles the robot has not reported a position.
    silent: u32,
    /// The TCP in the world.
    tcp: Frame,
    /// The robot's base in the world.
    base: Frame,
    recorder: Option<Box<Recorder>>,
    /// The targets already reported as not blended: file and line of the motion behind, line of the motion before,
    /// reason.
    unblended: HashSet<(File, u32, Option<u32>, NoBlend)>,
    /// How many compensations have been started.
    compensations: u32,
    servo: Servo,
    jogging: Jogging,
}

impl Unit {
    /// A robot at rest, in cycles of `period` s.
    ///
    /// # Errors
    /// Its driver cannot start it; the error of the driver.
    pub(crate) fn new(robot: Robot, mut driver: Box<dyn RobotDriver>, period: f64) -> Result<Self, DriverError> {
        let home = Joints::home(&robot);
        let context = robot_driver::Start { home: &home, robot: &robot, period };
        let start = driver.start(&context)?;
        if let Err(why) = context.begin_at(start) {
            driver.switch(Power::Off);
            driver.close();
            return Err(why.into());
        }
        let start = own_axes_of(&robot, start, &home);
        let robot = Arc::new(robot);
        // Each cycle sets again whether it takes real time.
        let mut queue = Queue::repeatable(Arc::clone(&robot), start);
        // Drivers get the differences between successive set-points instead.
        queue.tell_rates(false);
        let tcp = queue.tcp();
        let effort = Effort::new(&robot);
        Ok(Self {
            robot,
            queue,
            settings: Settings::default(),
            speed_override: Override::FULL,
            commanded: Moving::resting(start),
            reported: Moving::resting(start),
            effort,
            changes: Changes::new(),
            link: DriverLink::new(driver),
            planned: 0,
            finished: 0,
            executing: (0, 0),
            files: MotionFiles::new(),
            settled: 0,
            silent: 0,
            tcp,
            base: Frame::identity(),
            recorder: None,
            unblended: HashSet::new(),
            compensations: 0,
            servo: Servo::default(),
            jogging: Jogging::default(),
        })
    }

    /// Sets the robot's base in the world.
    pub(crate) fn set_base(&mut self, base: Frame) {
        if base != self.base {
            self.base = base;
            self.tcp = self.tcp_where(&self.commanded.at);
            self.effort.set_base(&base);
        }
    }

    /// Keeps records of all motions from now on.
    pub(crate) fn record(&mut self) {
        self.recorder = Some(Box::new(Recorder::new(Arc::clone(&self.robot), &mut self.queue)));
    }

    /// The records of all motions; empty unless they are kept.
    pub(crate) fn records(&self) -> &[MotionRecord] {
        self.recorder.as_ref().map_or(&[], |recorder| recorder.records())
    }

    /// The file of a motion whose record is kept.
    pub(crate) fn recorded_file(&self, number: u64) -> Option<File> {
        self.recorder.as_ref().filter(|_| number <= self.planned)?;
        self.files.of_recorded(number)
    }

    /// The targets that should be blended but are not, each with the file of the motion behind it. Of several between
    /// the same lines for the same reason only the first one of a run is returned.
    pub(crate) fn take_unblended(&mut self) -> Vec<(File, UnblendedTarget)> {
        let mut new = Vec::new();
        for target in self.queue.take_unblended() {
            let file = self.files.of(target.number);
            if self.unblended.insert((file, target.line, target.corner, target.why.clone())) {
                new.push((file, target));
            }
        }
        new
    }

    /// Compensates the motions that are planned from now on, with these limits.
    pub(crate) fn start_compensation(&mut self, limits: [f64; 6]) {
        self.compensations += 1;
        self.settings.compensation = Some(Compensation::new(self.compensations, limits));
    }

    /// The least fraction of its programmed speed that a weave or a compensation has left to a motion since the last
    /// call, and that motion's line.
    pub(crate) fn take_slowed(&mut self) -> (f64, u32) {
        self.queue.take_slowed()
    }

    pub(crate) fn robot(&self) -> &Robot {
        &self.robot
    }

    pub(crate) fn shared_robot(&self) -> Arc<Robot> {
        Arc::clone(&self.robot)
    }

    /// The axis positions that the robot reports.
    pub(crate) fn feedback(&self) -> &Joints {
        &self.reported.at
    }

    /// The commanded axis positions.
    pub(crate) fn setpoint(&self) -> &Joints {
        &self.commanded.at
    }

    /// How the axes move: as commanded, or as the robot reports.
    pub(crate) fn moving(&self, commanded: bool) -> &Moving {
        if commanded { &self.commanded } else { &self.reported }
    }

    /// The end of the motion that is being executed; without one, where the robot will stand.
    pub(crate) fn current_target(&self) -> &Joints {
        self.queue.target()
    }

    /// The file and line of the motion that is being executed, or was executed last.
    pub(crate) fn motion_pointer(&self) -> Option<(File, u32)> {
        self.files.pointer
    }

    /// The robot's masses; `None`: its file has none.
    pub(crate) fn model(&self) -> Option<&Dynamics> {
        self.effort.model()
    }

    /// The torques (Nm, N) of the robot's axes, for the commanded motion, or as they are measured. `None`: the robot
    /// file has no masses.
    pub(crate) fn torques(&self, commanded: bool) -> Option<Axes> {
        let mut torques = self.effort.asked(self.moving(commanded))?;
        if !commanded {
            torques.iter_mut().zip(self.surplus()?).for_each(|(torque, surplus)| *torque += surplus);
        }
        Some(torques)
    }

    /// The torques of the axes beyond those of the model (Nm, N). `None`: the robot file has no masses.
    pub(crate) fn surplus(&self) -> Option<Axes> {
        self.effort.surplus(&self.reported, &self.robot, &self.rig())
    }

    /// What the robot carries, and where it stands.
    fn rig(&self) -> Rig {
        Rig { base: self.base, ..*self.queue.rig() }
    }

    /// The TCP in the world for these axis positions. The base may differ from that of the last motion, as before the
    /// first.
    fn tcp_where(&self, joints: &Joints) -> Frame {
        self.rig().tcp_at(&self.robot.kinematics.forward(&joints.axes))
    }

    /// The external forces on the robot.
    pub(crate) fn outside_mut(&mut self) -> &mut ExternalForces {
        self.effort.outside_mut()
    }

    /// Sets the load on the flange during the following motions.
    pub(crate) fn set_load(&mut self, load: Load) {
        self.change(Change::Load(load));
    }

    /// Switches collision detection during the following motions on or off. Returns whether it is possible: whether the
    /// robot file has masses.
    pub(crate) fn detect(&mut self, sensitivity: Option<&Sensitivity>) -> bool {
        let allowed = sensitivity.map(|sensitivity| self.effort.allowed(&self.robot, sensitivity));
        let able = allowed != Some(None);
        if able {
            self.change(Change::Detect(allowed.flatten()));
        }
        able
    }

    /// The collision of this cycle, if any. It is reported once: detection is off afterwards.
    pub(crate) fn take_collision(&mut self) -> Option<Collision> {
        let found = self.effort.collision(&self.reported, &self.robot, &self.rig())?;
        self.effort.detect(None);
        self.changes.detected();
        Some(found)
    }

    /// Where the robot will stand when all planned motion has ended.
    pub(crate) fn target(&self) -> &Joints {
        self.queue.end()
    }

    /// The running numbers of the motion planned last and of the one that ended last.
    pub(crate) fn motions(&self) -> (u64, u64) {
        (self.planned, self.finished)
    }

    /// The line and the running number of the motion executed in this cycle; 0 where there was no motion.
    pub(crate) fn executing(&self) -> (u32, u64) {
        self.executing
    }

    /// The file of the motion executed in this cycle, if any.
    pub(crate) fn executing_file(&self) -> Option<File> {
        let (_, number) = self.executing;
        (number != 0).then(|| self.files.of(number))
    }

    /// The progress of the motion being executed.
    pub(crate) fn progress(&self) -> Option<Progress> {
        self.queue.progress()
    }

    /// Whether a motion is not executed any more: it has ended, or a blend leads away from it.
    pub(crate) fn is_over(&self, motion: u64) -> bool {
        self.queue.is_over(motion)
    }

    /// Whether a motion has ended.
    pub(crate) fn has_ended(&self, motion: u64) -> bool {
        self.queue.has_ended(motion)
    }

    /// Whether motions are set aside, or about to be.
    pub(crate) fn is_aside(&self) -> bool {
        self.queue.is_suspended()
    }

    /// The progress of a motion when it ended, or was left for a blend, in the last cycle.
    pub(crate) fn left(&self, motion: u64) -> Option<Progress> {
        self.queue.exited(motion)
    }

    /// The commanded pose of the TCP in the world, with the tool of its motion: mm, deg.
    pub(crate) fn commanded_tcp(&self) -> [f64; 6] {
        frame_components(&self.tcp)
    }

    /// The workpiece frame of its motion in the world: x, y, z in mm, a, b, c in deg.
    pub(crate) fn workpiece_in_world(&self) -> [f64; 6] {
        frame_components(&self.rig().workpiece_at(&self.robot.kinematics.forward(&self.setpoint().axes)))
    }

    /// The robot's base in the world: x, y, z in mm, a, b, c in deg.
    pub(crate) fn base_in_world(&self) -> [f64; 6] {
        frame_components(&self.base)
    }

    /// Whether the robot stands at these positions.
    pub(crate) fn is_at(&self, positions: &[f64], tolerance: f64) -> bool {
        let (own, external) = (self.robot.own_axes().len(), self.robot.external_axes().len());
        let axes = self.reported.at.axes.iter().take(own).chain(self.reported.at.external.iter().take(external));
        axes.zip(positions).all(|(axis, position)| (axis - position).abs() <= tolerance)
    }

    /// Sets the speed override from now on.
    pub(crate) fn set_override(&mut self, speed: Override) {
        self.speed_override = speed;
    }

    /// The speed override.
    pub(crate) fn speed_override(&self) -> Override {
        self.speed_override
    }

    /// Whether its override is 0: then it does not move on.
    pub(crate) fn is_at_zero_override(&self) -> bool {
        self.speed_override == Override::ZERO
    }

    /// Whether all planned motion has ended and the robot has settled: it stands on its set-point, or has been near
    /// enough to it for some cycles.
    #[inline]
    pub(crate) fn ended(&self) -> bool {
        self.queue.idle() && self.is_settled()
    }

    /// As `ended`, for a level of the program: motions that are set aside for it are not waited for.
    pub(crate) fn ended_for(&self, level: u32) -> bool {
        self.queue.idle_for(level) && self.is_settled()
    }

    /// Whether there is motion that is not set aside.
    pub(crate) fn moves(&self) -> bool {
        !self.queue.idle_for(u32::MAX)
    }

    /// Whether the robot stands on its set-point, or has been near enough to it for some cycles.
    pub(crate) fn is_settled(&self) -> bool {
        // A robot that has no command to follow, or does not follow it, is not waited for.
        let is_asked = self.servo.motors != Motors::Off && !self.servo.supervision.has_found();
        !is_asked || self.settled >= SETTLING || self.commanded.at == self.reported.at
    }

    /// Whether the robot is at rest, at the end of a motion or within one.
    pub(crate) fn rests(&self) -> bool {
        self.queue.rests() && self.is_settled()
    }

    /// Whether further cycles change nothing: the robot stands on its set-point, and no records of it are kept.
    pub(crate) fn is_quiet(&self) -> bool {
        let stands = |moving: &Moving| {
            let rates = moving.rates.iter().chain(&moving.external_rates).chain(&moving.accelerations);
            moving.at == moving.before && rates.copied().all(|rate| rate == 0.0)
        };
        matches!(self.servo.motors, Motors::On | Motors::Off)
            && (self.queue.idle() && self.queue.rests() && self.is_settled())
            && (stands(&self.commanded) && stands(&self.reported) && self.commanded.at == self.reported.at)
            && (self.recorder.is_none()
                && self.servo.found_fault.is_none()
                && !self.jogging.jogged
                && self.jogging.button == Button::Free)
    }

    /// How many time laws and blends were computed too late, on the real clock.
    pub(crate) fn found_late(&self) -> u64 {
        self.queue.found_late()
    }
}

/// `joints`, with the positions of `others` for axes that the robot does not have.
fn own_axes_of(robot: &Robot, mut joints: Joints, others: &Joints) -> Joints {
    keep_to(robot.own_axes().len(), &mut joints.axes, &others.axes);
    keep_to(robot.external_axes().len(), &mut joints.external, &others.external);
    joints
}

/// Replaces the values behind the first `many` by those of `others`.
fn keep_to<const N: usize>(many: usize, axes: &mut [f64; N], others: &[f64; N]) {
    if let (Some(axes), Some(others)) = (axes.get_mut(many..), others.get(many..)) {
        axes.copy_from_slice(others);
    }
}

impl Unit {
    /// A warning of its driver, once.
    pub(crate) fn take_driver_warning(&mut self) -> Option<String> {
        self.link.take_warning()
    }

    /// Releases the robot, once, with its motors off: one that moves is cut off. The driver is not called any more.
    pub(crate) fn close(&mut self) {
        let power = if self.queue.rests() { Power::Off } else { Power::Cut };
        self.link.close((self.servo.motors != Motors::Off).then_some(power));
    }
}

impl Drop for Unit {
    fn drop(&mut self) {
        self.close();
    }
}

/// Positions as a program sees them. Axes that do not exist are unset; rounding errors around zero are removed.
pub(crate) fn joint(joints: &Joints) -> Joint {
    let [j1, j2, j3, j4, j5, j6] = joints.axes.map(tidy);
    let [ej1, ej2, ej3, ej4, ej5, ej6] = joints.external.map(tidy);
    Joint { j1, j2, j3, j4, j5, j6, ej1, ej2, ej3, ej4, ej5, ej6 }
}

/// A length or an angle without the rounding error where it should be zero.
pub(crate) fn tidy(value: f64) -> f64 {
    if value.abs() < 1e-9 { 0.0 } else { value }
}
