//! A mechanical unit: the robot with its planned motion and its driver.

use std::sync::Arc;

use crate::fault::{Alarm, Fault, File};
use crate::kinematics::{Frame, frame_components};
use crate::motion::{Command, Joints, MotionRecord, PlanError, Progress, Queue, Recorder, Settings, Stop};
use crate::robot::Robot;
use crate::robot_driver::{RobotDriver, settled};
use crate::values::Joint;

/// The robot with its planned motion and its driver.
pub(crate) struct Unit {
    robot: Arc<Robot>,
    queue: Queue,
    /// What `velset` and the mode say.
    pub(crate) settings: Settings,
    override_percent: f64,
    setpoint: Joints,
    feedback: Joints,
    driver: Box<dyn RobotDriver>,
    /// The running number of the motion planned last, and of the one that has ended last.
    planned: u64,
    finished: u64,
    /// The motion of the cycle before: its line and its running number.
    executing: (u32, u64),
    /// The TCP in the world.
    tcp: Frame,
    recorder: Option<Box<Recorder>>,
    /// The file of the motion planned last.
    file: File,
}

impl Unit {
    pub(crate) fn new(robot: Robot, mut driver: Box<dyn RobotDriver>) -> Self {
        let start = driver.start(&Joints::home(&robot));
        let robot = Arc::new(robot);
        let queue = Queue::new(Arc::clone(&robot), start);
        let tcp = queue.tcp();
        Self {
            robot,
            queue,
            settings: Settings::default(),
            override_percent: 100.0,
            setpoint: start,
            feedback: start,
            driver,
            planned: 0,
            finished: 0,
            executing: (0, 0),
            tcp,
            recorder: None,
            file: File::new(""),
        }
    }

    /// From now on keeps records of all motions.
    pub(crate) fn record(&mut self) {
        self.recorder = Some(Box::new(Recorder::new(Arc::clone(&self.robot), &self.setpoint)));
    }

    /// The records of all motions; none unless they are kept.
    pub(crate) fn records(&self) -> &[MotionRecord] {
        self.recorder.as_ref().map_or(&[], |recorder| recorder.records())
    }

    /// Whether a motion came too late to be blended with the one before it, since this was asked last.
    pub(crate) fn take_late(&mut self) -> bool {
        self.queue.take_late()
    }

    pub(crate) fn robot(&self) -> &Robot {
        &self.robot
    }

    pub(crate) fn shared_robot(&self) -> Arc<Robot> {
        Arc::clone(&self.robot)
    }

    /// The axes as the robot reports them.
    pub(crate) fn feedback(&self) -> &Joints {
        &self.feedback
    }

    /// The axes as they are commanded.
    pub(crate) fn setpoint(&self) -> &Joints {
        &self.setpoint
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

    /// How far the motion being executed has come.
    pub(crate) fn progress(&self) -> Option<Progress> {
        self.queue.progress()
    }

    /// The commanded pose of the TCP in the world, with the tool of its motion: mm, deg.
    pub(crate) fn commanded_tcp(&self) -> [f64; 6] {
        frame_components(&self.tcp)
    }

    /// Whether the robot stands at these positions.
    pub(crate) fn is_at(&self, positions: &[f64], tolerance: f64) -> bool {
        let (own, external) = (self.robot.own_axes().len(), self.robot.external_axes().len());
        let axes = self.feedback.axes.iter().take(own).chain(self.feedback.external.iter().take(external));
        axes.zip(positions).all(|(axis, position)| (axis - position).abs() <= tolerance)
    }

    /// The speed override in %.
    pub(crate) fn set_override(&mut self, percent: f64) {
        self.override_percent = percent;
    }

    /// Whether another motion can be planned.
    pub(crate) fn has_room(&self) -> bool {
        self.queue.has_room()
    }

    /// Plans a motion of a program file, under [`Unit::settings`] with the changes that it brings along; the alarm where
    /// that, or a motion before it, cannot be.
    pub(crate) fn plan(&mut self, command: &Command, settings: &Settings, file: File) -> Result<(), Alarm> {
        let planned = self.queue.add(command, settings);
        self.planned = planned.map_err(|error| alarm(error, self.file, (file, command.line)))?;
        self.file = file;
        if let Some(recorder) = &mut self.recorder {
            recorder.planned(&self.queue, self.planned, command, settings);
        }
        Ok(())
    }

    /// Says that the program waits: motions that waited for the next one go without it. The alarm where that cannot be.
    pub(crate) fn conclude(&mut self) -> Result<(), Alarm> {
        self.queue.conclude().map_err(|error| alarm(error, self.file, (self.file, 0)))
    }

    /// The alarm of a motion that waited in vain for the next one.
    pub(crate) fn take_broken(&mut self) -> Option<Alarm> {
        Some(alarm(self.queue.take_broken()?, self.file, (self.file, 0)))
    }

    /// Whether all planned motion has ended and the robot has settled.
    #[inline]
    pub(crate) fn ended(&self) -> bool {
        self.queue.idle() && settled(&self.setpoint, &self.feedback)
    }

    /// One interpolation step, and the exchange with the driver.
    pub(crate) fn step(&mut self, period: f64) {
        let step = self.queue.step(period, self.override_percent);
        if let Some(recorder) = &mut self.recorder {
            recorder.step(&step, period);
        }
        self.setpoint = step.joints;
        self.tcp = step.tcp;
        self.executing = (step.line, step.motion);
        self.finished = step.finished;
        self.feedback = self.driver.exchange(&self.setpoint, period);
    }

    /// Comes to rest on the path, and forgets what was planned.
    pub(crate) fn stop(&mut self) {
        self.queue.stop_on_path(Stop::General);
        self.queue.clear();
    }

    /// Lets motion be planned again after [`Unit::stop`], at rest.
    pub(crate) fn reset(&mut self) {
        self.queue.resume();
        self.settings = Settings { manual: self.settings.manual, ..Settings::default() };
    }
}

/// The alarm of a motion, here or in an earlier line of another file.
fn alarm(error: PlanError, earlier: File, (file, line): (File, u32)) -> Alarm {
    match error {
        PlanError::Earlier { line, error } => alarm(*error, earlier, (earlier, line)),
        PlanError::NoCircle | PlanError::LoneCircle => {
            Alarm { fault: Fault::Other { number: 12002, text: error.to_string().into() }, file, line }
        }
        error => Alarm { fault: Fault::Motion(error.to_string().into()), file, line },
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
