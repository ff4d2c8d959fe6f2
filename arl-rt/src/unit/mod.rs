//! A mechanical unit: the robot with its planned motion and its driver.

mod changes;
pub mod dynamics;
mod effort;
pub(crate) mod hold;
mod moving;
mod range;
mod refusal;
pub mod robot_driver;
mod servo;
mod supervision;

use std::collections::{HashSet, VecDeque};
use std::sync::Arc;
use std::time::Instant;

use crate::fault::{Alarm, Fault, File};
use crate::motion::{
    Command, Compensation, Cycle, Joints, MotionRecord, NoBlend, Override, Progress, Queue, Recorder, Settings, Start,
    Stop, UnblendedTarget, circle_steps,
};
use crate::unit::dynamics::{Dynamics, Load};
use crate::unit::robot_driver::{DriverError, Drives, Feedback, Power, RobotDriver, Setpoint, settled};
use crate::values::Joint;
use arl_robot::cell::Sensitivity;
use arl_robot::frames::Rig;
use arl_robot::kinematics::{Axes, Frame, frame_components};
use arl_robot::robot::{EXTERNAL_AXES, ROBOT_AXES, Robot};
use changes::{Change, Changes};
use effort::Effort;
pub(crate) use effort::{Collision, ExternalForces, SENSITIVITY};
use hold::Button;
pub(crate) use moving::Moving;
use refusal::alarm;
pub(crate) use refusal::{Inherited, Mounts};
pub use servo::Motors;
use supervision::{Supervision, is_all_finite, is_finite};

/// For how many cycles a robot that never stands quite where it shall must be near enough to count as settled.
const SETTLING: u32 = 8;

/// The speeds of a robot that stands, or of axes that are not there.
const REST: Joints = Joints { axes: [0.0; ROBOT_AXES], external: [0.0; EXTERNAL_AXES] };

/// A cycle, as a robot sees it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RobotCycle {
    /// Its length.
    pub(crate) cycle: Cycle,
    /// Whether it takes the time that it stands for.
    pub(crate) real: bool,
    /// When it ends, where time is that of the world.
    pub(crate) due: Option<Instant>,
}

/// The robot with its planned motion and its driver.
pub(crate) struct Unit {
    robot: Arc<Robot>,
    queue: Queue,
    /// What `velset` and the mode say.
    pub(crate) settings: Settings,
    speed_override: Override,
    commanded: Moving,
    reported: Moving,
    effort: Effort,
    /// What changes with motions that are planned.
    changes: Changes,
    driver: Box<dyn RobotDriver>,
    /// Nothing is asked of it any more.
    closed: bool,
    /// The running number of the motion planned last, and of the one that has ended last.
    planned: u64,
    finished: u64,
    /// The motion of the cycle before: its line and its running number.
    executing: (u32, u64),
    /// Where the motion stands that is or was last executed.
    pointer: Option<(File, u32)>,
    /// The files of the motions from a running number on, that of the motion executed last first.
    files: VecDeque<(u64, File)>,
    /// For how many cycles the robot has been near enough to where it shall stand.
    settled: u32,
    /// The TCP in the world.
    tcp: Frame,
    recorder: Option<Box<Recorder>>,
    /// The files of the recorded motions, each from a running number on.
    recorded_files: Vec<(u64, File)>,
    /// The targets that were told not to be rounded off: file and line behind, line before, why.
    unblended: HashSet<(File, u32, Option<u32>, NoBlend)>,
    /// The file of the motion planned last.
    file: File,
    /// Where the robot stands in the world.
    base: Frame,
    /// How many compensations have been started.
    compensations: u32,
    /// The file of the last `startmove`.
    start_file: File,
    motors: Motors,
    /// For how many cycles no position has come from the robot.
    silent: u32,
    supervision: Supervision,
    /// What the supervision has found, and in which motion, until it is taken.
    trouble: Option<(Fault, Option<(File, u32)>)>,
    /// Whether it is told to rest until somebody says to go on, and whether it was moved beside its path meanwhile.
    halted: bool,
    jogged: bool,
    /// The button that moves it beside its program.
    button: Button,
}

impl Unit {
    /// A robot at rest, in cycles of `period` s.
    ///
    /// # Errors
    /// Its driver cannot start it; why.
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
        // Each cycle says anew whether it is one in real time.
        let mut queue = Queue::repeatable(Arc::clone(&robot), start);
        // Drivers get the differences of the set-points that they get.
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
            start_file: File::new(""),
            motors: Motors::On,
            silent: 0,
            supervision: Supervision::default(),
            trouble: None,
            halted: false,
            jogged: false,
            button: Button::Free,
            driver,
            closed: false,
            planned: 0,
            finished: 0,
            executing: (0, 0),
            pointer: None,
            files: VecDeque::new(),
            settled: 0,
            tcp,
            recorder: None,
            recorded_files: Vec::new(),
            unblended: HashSet::new(),
            file: File::new(""),
            base: Frame::identity(),
            compensations: 0,
        })
    }

    /// Where the robot stands in the world.
    pub(crate) fn set_base(&mut self, base: Frame) {
        if base != self.base {
            self.base = base;
            self.tcp = self.tcp_where(&self.commanded.at);
            self.effort.set_base(&base);
        }
    }

    /// From now on keeps records of all motions.
    pub(crate) fn record(&mut self) {
        self.recorder = Some(Box::new(Recorder::new(Arc::clone(&self.robot), &mut self.queue)));
    }

    /// The records of all motions; none unless they are kept.
    pub(crate) fn records(&self) -> &[MotionRecord] {
        self.recorder.as_ref().map_or(&[], |recorder| recorder.records())
    }

    /// The file of a motion whose record is kept.
    pub(crate) fn recorded_file(&self, number: u64) -> Option<File> {
        self.recorder.as_ref().filter(|_| number <= self.planned)?;
        let behind = self.recorded_files.partition_point(|(from, _)| *from <= number);
        let (_, file) = self.recorded_files.get(behind.checked_sub(1)?)?;
        Some(*file)
    }

    /// The targets that should be rounded off but are not, each with the file of the motion behind it; between the same
    /// lines for the same reason only the first one of a run.
    pub(crate) fn take_unblended(&mut self) -> Vec<(File, UnblendedTarget)> {
        let mut new = Vec::new();
        for target in self.queue.take_unblended() {
            let file = self.file_of(target.number);
            if self.unblended.insert((file, target.line, target.corner, target.why.clone())) {
                new.push((file, target));
            }
        }
        new
    }

    /// The file of a motion that has not ended.
    fn file_of(&self, number: u64) -> File {
        let known = self.files.iter().rev().find(|(first, _)| *first <= number);
        known.map_or(self.file, |(_, file)| *file)
    }

    /// Begins to compensate the motions that are planned from now on, with these limits.
    pub(crate) fn start_compensation(&mut self, limits: [f64; 6]) {
        self.compensations += 1;
        self.settings.compensation = Some(Compensation::new(self.compensations, limits));
    }

    /// The least part of its programmed speed that a weave or a compensation has left to a motion, since this was asked
    /// last, and that motion's line.
    pub(crate) fn take_slowed(&mut self) -> (f64, u32) {
        self.queue.take_slowed()
    }

    pub(crate) fn robot(&self) -> &Robot {
        &self.robot
    }

    pub(crate) fn shared_robot(&self) -> Arc<Robot> {
        Arc::clone(&self.robot)
    }

    /// The axes as the robot reports them.
    pub(crate) fn feedback(&self) -> &Joints {
        &self.reported.at
    }

    /// The axes as they are commanded.
    pub(crate) fn setpoint(&self) -> &Joints {
        &self.commanded.at
    }

    /// How the axes move: as commanded, or as the robot reports it.
    pub(crate) fn moving(&self, commanded: bool) -> &Moving {
        if commanded { &self.commanded } else { &self.reported }
    }

    /// Where the motion ends that is being executed; without one, where the robot will stand.
    pub(crate) fn current_target(&self) -> &Joints {
        self.queue.target()
    }

    /// The file and line of the motion that is being executed, or that was last.
    pub(crate) fn motion_pointer(&self) -> Option<(File, u32)> {
        self.pointer
    }

    /// The robot's masses; `None`: its file has none.
    pub(crate) fn model(&self) -> Option<&Dynamics> {
        self.effort.model()
    }

    /// The torques (Nm, N) of the robot's axes, as the motion is commanded, or as they are measured. `None`: the robot
    /// file has no masses.
    pub(crate) fn torques(&self, commanded: bool) -> Option<Axes> {
        let mut torques = self.effort.asked(self.moving(commanded))?;
        if !commanded {
            torques.iter_mut().zip(self.surplus()?).for_each(|(torque, surplus)| *torque += surplus);
        }
        Some(torques)
    }

    /// What the axes give more than the model asks for (Nm, N). `None`: the robot file has no masses.
    pub(crate) fn surplus(&self) -> Option<Axes> {
        self.effort.surplus(&self.reported, &self.robot, &self.rig())
    }

    /// What it carries, and where it stands.
    fn rig(&self) -> Rig {
        Rig { base: self.base, ..*self.queue.rig() }
    }

    /// Where the TCP is in the world while the axes are there. The base may be another one than that of the last
    /// motion, as before the first.
    fn tcp_where(&self, joints: &Joints) -> Frame {
        self.rig().tcp_at(&self.robot.kinematics.forward(&joints.axes))
    }

    /// What pushes the robot.
    pub(crate) fn outside_mut(&mut self) -> &mut ExternalForces {
        self.effort.outside_mut()
    }

    /// Says what the flange carries during the motions that follow.
    pub(crate) fn set_load(&mut self, load: Load) {
        self.change(Change::Load(load));
    }

    /// Looks for collisions during the motions that follow, or no longer does. Returns whether it can: whether the
    /// robot file has masses.
    pub(crate) fn detect(&mut self, sensitivity: Option<&Sensitivity>) -> bool {
        let allowed = sensitivity.map(|sensitivity| self.effort.allowed(&self.robot, sensitivity));
        let able = allowed != Some(None);
        if able {
            self.change(Change::Detect(allowed.flatten()));
        }
        able
    }

    /// The collision of this cycle, if there was one. It is told once: detection is off then.
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

    /// The line and the running number of the motion executed in this cycle; 0 where there was none.
    pub(crate) fn executing(&self) -> (u32, u64) {
        self.executing
    }

    /// The file of the motion executed in this cycle, where there was one.
    pub(crate) fn executing_file(&self) -> Option<File> {
        let (_, number) = self.executing;
        (number != 0).then(|| self.file_of(number))
    }

    /// How far the motion being executed has come.
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

    /// How far a motion had come when it ended, or was left for a blend, in the last cycle.
    pub(crate) fn left(&self, motion: u64) -> Option<Progress> {
        self.queue.left(motion)
    }

    /// The commanded pose of the TCP in the world, with the tool of its motion: mm, deg.
    pub(crate) fn commanded_tcp(&self) -> [f64; 6] {
        frame_components(&self.tcp)
    }

    /// The workpiece of its motion in the world: x, y, z in mm, a, b, c in deg.
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

    /// From now on this speed override holds.
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

    /// Whether another motion can be planned by those of a level of the program.
    pub(crate) fn takes(&self, level: u32) -> bool {
        self.queue.takes(level)
    }

    /// Stops on the path and sets the motions aside: those of this level of the program, and above it, move in between.
    pub(crate) fn set_aside(&mut self, stop: Stop, level: u32) {
        self.queue.request_suspension(stop, level);
        self.changes.follow(self.queue.depth(), self.planned, &mut self.effort);
    }

    /// Goes on with what was set aside last; returns whether there is something.
    pub(crate) fn start_again(&mut self, start: Start, file: File) -> bool {
        self.start_file = file;
        let started = self.queue.start_again(start);
        self.note_start();
        started
    }

    /// Drops what is set aside, where nobody has asked to go on with it; returns whether there was something. A stop on
    /// its way goes on to rest.
    pub(crate) fn drop_aside(&mut self) -> bool {
        self.queue.drop_suspended()
    }

    /// Whether more motions were to be skipped than there were, since this was asked last.
    pub(crate) fn take_beyond(&mut self) -> bool {
        self.queue.take_beyond()
    }

    /// Takes notice of motions that go on, and of the way to them.
    fn note_start(&mut self) {
        if let Some((number, command, settings)) = self.queue.take_way_back() {
            self.planned = number;
            let file = self.start_file;
            self.note_planned(number, &command, &settings, file);
        }
        self.changes.follow(self.queue.depth(), self.planned, &mut self.effort);
    }

    /// Takes notice of a motion that was planned.
    fn note_planned(&mut self, number: u64, command: &Command, settings: &Settings, file: File) {
        if let Some(recorder) = &mut self.recorder {
            recorder.planned(&mut self.queue, number, command, settings);
            if self.recorded_files.last().is_none_or(|(_, last)| *last != file) {
                self.recorded_files.push((number, file));
            }
        }
        if self.files.back().is_none_or(|(_, last)| *last != file) {
            self.files.push_back((number, file));
        }
    }

    /// Plans a motion of a program file, under [`Unit::settings`] with the changes that it brings along; the alarm
    /// where that, or a motion before it, cannot be.
    pub(crate) fn plan(
        &mut self,
        command: &Command,
        settings: &Settings,
        mounts: Mounts,
        file: File,
    ) -> Result<(), Alarm> {
        let planned = self.queue.add(command, settings);
        let about = Some((&command.target, mounts));
        self.planned = planned.map_err(|error| alarm(error, self.file, (file, command.line), about))?;
        self.file = file;
        self.note_planned(self.planned, command, settings, file);
        Ok(())
    }

    /// The two motions of a circle that is to be planned, for single steps; `None` for everything else.
    pub(crate) fn circle_steps(&self, command: &Command, settings: &Settings) -> Option<[Command; 2]> {
        circle_steps(&self.robot, self.queue.end(), command, settings)
    }

    /// Says that the program waits: motions that waited for the next one go without it. The alarm where that cannot be.
    pub(crate) fn conclude(&mut self) -> Result<(), Alarm> {
        self.queue.conclude().map_err(|error| alarm(error, self.file, (self.file, 0), None))
    }

    /// The alarm of a motion that waited in vain for the next one.
    pub(crate) fn take_broken(&mut self) -> Option<Alarm> {
        if let Some(error) = self.queue.take_broken_start() {
            return Some(alarm(error, self.start_file, (self.start_file, 0), None));
        }
        Some(alarm(self.queue.take_broken()?, self.file, (self.file, 0), None))
    }

    /// Lets something hold from the motion on that is planned next: at once where there is none before it.
    fn change(&mut self, change: Change) {
        self.changes.push(self.planned + 1, change);
        self.change_due();
    }

    /// Makes the changes of the motion that comes after the last one that has ended.
    fn change_due(&mut self) {
        self.changes.make(self.finished + 1, &mut self.effort);
    }

    /// Whether all planned motion has ended and the robot has settled: it stands where it shall, or has been near
    /// enough for some cycles.
    #[inline]
    pub(crate) fn ended(&self) -> bool {
        self.queue.idle() && self.is_settled()
    }

    /// The same for those of a level of the program: they do not wait for what is set aside for them.
    pub(crate) fn ended_for(&self, level: u32) -> bool {
        self.queue.idle_for(level) && self.is_settled()
    }

    /// Whether motion is there that is not set aside.
    pub(crate) fn moves(&self) -> bool {
        !self.queue.idle_for(u32::MAX)
    }

    /// Whether the robot stands where it shall, or was near enough for some cycles.
    pub(crate) fn is_settled(&self) -> bool {
        // One that is asked for nothing, or does not do what it is asked for, is not waited for.
        let is_asked = self.motors != Motors::Off && !self.supervision.has_found();
        !is_asked || self.settled >= SETTLING || self.commanded.at == self.reported.at
    }

    /// Whether the robot stands still, at the end of a motion or within one.
    pub(crate) fn rests(&self) -> bool {
        self.queue.rests() && self.is_settled()
    }

    /// Whether each further cycle leaves everything as it is: it stands where it shall, and nobody keeps records of it.
    pub(crate) fn is_quiet(&self) -> bool {
        let stands = |moving: &Moving| {
            let rates = moving.rates.iter().chain(&moving.external_rates).chain(&moving.accelerations);
            moving.at == moving.before && rates.copied().all(|rate| rate == 0.0)
        };
        matches!(self.motors, Motors::On | Motors::Off)
            && (self.queue.idle() && self.queue.rests() && self.is_settled())
            && (stands(&self.commanded) && stands(&self.reported) && self.commanded.at == self.reported.at)
            && (self.recorder.is_none() && self.trouble.is_none() && !self.jogged && self.button == Button::Free)
    }

    /// How many time laws and blends came too late, on the real clock.
    pub(crate) fn found_late(&self) -> u64 {
        self.queue.found_late()
    }

    /// One interpolation step, and the exchange with the driver.
    pub(crate) fn step(&mut self, beat: RobotCycle) {
        let period = beat.cycle.period();
        self.queue.follow_real_time(beat.real);
        let step = self.queue.step(beat.cycle, self.speed_override);
        if let Some(recorder) = &mut self.recorder {
            recorder.step(&mut self.queue, &step);
        }
        self.executing = (step.line, step.motion);
        self.finished = step.finished;
        self.note_rest();
        self.note_start();
        // The first half of a blend still counts as the motion before it there; to programs a blend is the next
        // motion's.
        match self.queue.progress() {
            Some(next) if step.motion != 0 && next.motion > step.motion => self.point_at(next.motion, next.line),
            _ => self.point_at(step.motion, step.line),
        }
        if step.motion != 0 {
            self.set_base(self.queue.rig().base);
        }
        self.tcp = if self.queue.rig().base == self.base { step.tcp } else { self.tcp_where(&step.joints) };
        self.change_due();
        self.commanded.go_to(step.joints, period);
        self.exchange(beat);
        let near = self.queue.rests() && settled(&self.commanded.at, &self.reported.at, self.robot.drives.settled);
        self.settled = if near { self.settled.saturating_add(1) } else { 0 };
        self.switch_off_at_rest();
    }

    /// Tells the driver where the robot shall be, and hears where it is.
    fn exchange(&mut self, beat: RobotCycle) {
        let setpoint = self.setpoint_of(beat);
        let feedback = if self.closed { Feedback::none() } else { self.driver.exchange(&setpoint) };
        let position = feedback.position.filter(|position| is_finite(position, &self.robot));
        self.silent = self.silent.saturating_add(1);
        if let Some(position) = position {
            // It may be the first one for some cycles.
            let since = f64::from(self.silent) * beat.cycle.period();
            self.reported.go_to(own_axes_of(&self.robot, position, &self.commanded.at), since);
            if let Some(velocity) = feedback.velocity.filter(|velocity| is_finite(velocity, &self.robot)) {
                self.reported.measured(&own_axes_of(&self.robot, velocity, &REST));
            }
            self.silent = 0;
            self.effort.measured(feedback.torque.filter(is_all_finite));
        }
        self.supervise(&feedback, &setpoint);
    }

    fn setpoint_of(&self, beat: RobotCycle) -> Setpoint {
        let (period, deadline) = (beat.cycle.period(), beat.due);
        if matches!(self.motors, Motors::Off | Motors::ComingOn) {
            // They are asked for nothing but to stay.
            return Setpoint { deadline, ..Setpoint::resting(self.reported.at, period) };
        }
        let Moving { at: position, rates, external_rates, accelerations: acceleration, .. } = self.commanded;
        let velocity = Joints { axes: rates, external: external_rates };
        let torque = if self.driver.wants_torque() { self.effort.asked(&self.commanded) } else { None };
        Setpoint { position, velocity, acceleration, torque, period, deadline }
    }

    /// Sets the motion pointer to the motion of a program that was executed, if there was one.
    fn point_at(&mut self, motion: u64, line: u32) {
        let oldest = self.queue.oldest().min(motion);
        while self.files.get(1).is_some_and(|(from, _)| *from <= oldest) {
            self.files.pop_front();
        }
        let files = self.files.partition_point(|(from, _)| *from <= motion);
        if let Some((_, file)) = self.files.get(files.saturating_sub(1))
            && motion != 0
            && line != 0
        {
            self.pointer = Some((*file, line));
        }
    }

    /// Comes to rest on the path as fast as it can, and forgets what was planned.
    pub(crate) fn stop_fast(&mut self) {
        self.queue.stop_on_path(Stop::Fast);
        self.stop();
    }

    /// Comes to rest on the path, and forgets what was planned.
    pub(crate) fn stop(&mut self) {
        self.queue.stop_on_path(Stop::General);
        self.queue.clear();
        self.stop_button();
    }

    /// Whoever holds a button has to press it anew.
    fn stop_button(&mut self) {
        if self.button == Button::Held {
            self.button = Button::LetGo;
        }
    }

    /// Lets motion be planned again after [`Unit::stop`], at rest.
    pub(crate) fn reset(&mut self) {
        if std::mem::take(&mut self.jogged) {
            // Nobody goes back to what was set aside.
            self.queue.drop_suspended();
        }
        if self.has_servo() {
            self.queue.resume();
        }
        (self.halted, self.jogged) = (!self.has_servo(), false);
        self.changes.clear(&mut self.effort);
        self.files.clear();
        self.settings = Settings { manual: self.settings.manual, ..Settings::default() };
    }
}

/// These positions, and those of `others` for axes that the robot does not have.
fn own_axes_of(robot: &Robot, mut joints: Joints, others: &Joints) -> Joints {
    keep_to(robot.own_axes().len(), &mut joints.axes, &others.axes);
    keep_to(robot.external_axes().len(), &mut joints.external, &others.external);
    joints
}

/// Puts others behind the first ones, so `many`.
fn keep_to<const N: usize>(many: usize, axes: &mut [f64; N], others: &[f64; N]) {
    if let (Some(axes), Some(others)) = (axes.get_mut(many..), others.get(many..)) {
        axes.copy_from_slice(others);
    }
}

impl Unit {
    /// Switches the motors of a robot that is not let go yet; how its drives are now.
    fn switch(&mut self, power: Power) -> Drives {
        if self.closed { Drives::Off } else { self.driver.switch(power) }
    }

    /// What the user should know of its driver, once.
    pub(crate) fn take_driver_warning(&mut self) -> Option<String> {
        if self.closed { None } else { self.driver.take_warning() }
    }

    /// Lets go of the robot, once, with its motors off: one that moves is cut off. Nothing is called of its driver any
    /// more.
    pub(crate) fn close(&mut self) {
        if std::mem::replace(&mut self.closed, true) {
            return;
        }
        if self.motors != Motors::Off {
            let power = if self.queue.rests() { Power::Off } else { Power::Cut };
            self.driver.switch(power);
        }
        self.driver.close();
    }
}

impl Drop for Unit {
    fn drop(&mut self) {
        self.close();
    }
}

/// Positions as a program sees them. Axes that are not there are unset; what is left of rounding is zero.
pub(crate) fn joint(joints: &Joints) -> Joint {
    let [j1, j2, j3, j4, j5, j6] = joints.axes.map(tidy);
    let [ej1, ej2, ej3, ej4, ej5, ej6] = joints.external.map(tidy);
    Joint { j1, j2, j3, j4, j5, j6, ej1, ej2, ej3, ej4, ej5, ej6 }
}

/// A length or an angle without the noise that computing leaves where it should be zero.
pub(crate) fn tidy(value: f64) -> f64 {
    if value.abs() < 1e-9 { 0.0 } else { value }
}
