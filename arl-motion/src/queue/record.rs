//! What motions really did: speeds reached, durations, blends, and the limit that each came nearest to.

use std::sync::Arc;

use crate::blend::zone::{self, Rounding};
use crate::command::joints::ALL;
use crate::command::{Command, MotionKind, Settings};
use crate::plan::constraints::MANUAL_SPEED_MM_S;
use crate::plan::motion::Motion;
use crate::queue::{Laid, Queue, Step};
use arl_robot::frames::Carried;
use arl_robot::kinematics::Frame;
use arl_robot::robot::{ROBOT_AXES, Robot, VelocityProfile};

/// TCP paths shorter than this, mm, have no speed: then the tool's turning is what was programmed.
const NO_DISTANCE_MM: f64 = 1e-6;

/// A figure with its unit.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Figure {
    /// How much.
    pub value: f64,
    /// `%`, `mm/s`, `deg/s` or `s`.
    pub unit: &'static str,
}

/// Which derivative of a position is limited.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Rate {
    /// Speed.
    Vel,
    /// Acceleration.
    Acc,
    /// Jerk.
    Jerk,
}

/// Whose limit it is.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Limited {
    /// The axis with this index in [`Robot::axes`].
    Axis(usize),
    /// The TCP on its path.
    Tcp,
    /// The turning of the tool.
    Turning,
}

/// The limit of the robot file that a motion came nearest to.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Closest {
    /// Whose limit.
    pub of: Limited,
    /// Which one.
    pub rate: Rate,
    /// How much of it was used: 1 is all of it.
    pub share: f64,
}

impl Closest {
    /// Whose limit, as robot files name it: `j3`, `tcp`, `tcp ori`.
    pub fn name<'a>(&self, robot: &'a Robot) -> &'a str {
        match self.of {
            Limited::Axis(at) => robot.axes.get(at).map_or("", |axis| axis.name.as_str()),
            Limited::Tcp => "tcp",
            Limited::Turning => "tcp ori",
        }
    }
}

/// The closest limits of speed, acceleration and jerk.
#[derive(Clone, Copy, PartialEq, Debug)]
struct Nearest([Closest; 3]);

impl Nearest {
    const NONE: Self = Self([
        Closest { of: Limited::Tcp, rate: Rate::Vel, share: 0.0 },
        Closest { of: Limited::Tcp, rate: Rate::Acc, share: 0.0 },
        Closest { of: Limited::Tcp, rate: Rate::Jerk, share: 0.0 },
    ]);

    /// Takes the shares that are higher, of the first `known` derivatives.
    fn raise(&mut self, of: Limited, rates: [f64; 3], limits: [f64; 3], known: usize) {
        for ((closest, value), limit) in self.0.iter_mut().zip(rates).zip(limits).take(known) {
            let share = value.abs() / limit;
            if share > closest.share {
                *closest = Closest { of, share, ..*closest };
            }
        }
    }
}

/// One executed motion. Until it has ended, the figures are those so far.
#[derive(Clone, PartialEq, Debug)]
pub struct MotionRecord {
    /// Its running number, from 1.
    pub number: u64,
    /// Its program line.
    pub line: u32,
    /// Where it goes, and how.
    pub kind: MotionKind,
    /// The programmed speed, under the override: % of the axes' limits on axis motions, else mm/s, or deg/s
    /// where only the tool turns; or the programmed duration in s.
    pub programmed: Figure,
    /// The highest speed in the same unit; for a duration, how long it took.
    pub reached: f64,
    /// When it began, in s of controller time; `None` when it has not.
    pub start: Option<f64>,
    /// How long it was executed, in s.
    pub duration: f64,
    /// The path of the TCP against the workpiece, in mm.
    pub way: f64,
    /// The zone at its end, where one was asked for.
    pub blend: Option<Rounding>,
    axes: Nearest,
    tool: Nearest,
    carried: Carried,
    along_tool: bool,
    /// The programmed speed of the tool's turning, deg/s.
    turning: f64,
    /// Whether a blend with an axis motion is a part of it, in which the TCP's limits do not hold.
    mixed: bool,
    jerks: bool,
}

impl MotionRecord {
    /// The limits of speed, acceleration and jerk that it came nearest to. Where a blend with an axis motion is a part of it,
    /// those of the TCP do not hold and are left out; so is the jerk with the profile T.
    pub fn closest(&self) -> [Option<Closest>; 3] {
        let with_tool = self.along_tool && !self.mixed;
        let mut found = [None; 3];
        for ((found, axes), tool) in found.iter_mut().zip(self.axes.0).zip(self.tool.0) {
            let best = if with_tool && tool.share > axes.share { tool } else { axes };
            *found = (best.share > 0.0).then_some(best);
        }
        found
    }
}

/// Watches planning and interpolation. Memory is taken when a motion is planned, never in a cycle.
#[derive(Clone, Debug)]
pub struct Recorder {
    robot: Arc<Robot>,
    records: Vec<MotionRecord>,
    /// The last motion that goes somewhere.
    last: Option<Arc<Motion>>,
    time: f64,
    /// The number of the motion executed last.
    executed: u64,
    joints: [f64; ALL],
    /// Speeds, accelerations of the axes.
    rates: [[f64; ALL]; 2],
    way: Frame,
    /// Speed and acceleration of the TCP along its path, then of the tool's turning.
    moving: [f64; 2],
    turning: [f64; 2],
    /// How many of the TCP's derivatives are known: after a change of what is carried none is.
    known: usize,
}

impl Recorder {
    /// A recorder of what this queue does from now on.
    pub fn new(robot: Arc<Robot>, queue: &mut Queue) -> Self {
        queue.watch();
        Self {
            robot,
            records: Vec::new(),
            last: None,
            time: 0.0,
            executed: 0,
            joints: queue.joints().all(),
            rates: [[0.0; ALL]; 2],
            way: Frame::identity(),
            moving: [0.0; 2],
            turning: [0.0; 2],
            known: 0,
        }
    }

    /// The motions that were planned, in order.
    pub fn records(&self) -> &[MotionRecord] {
        &self.records
    }

    /// Notes a motion that the queue has taken. Its way may become known only with the next one.
    pub fn planned(&mut self, queue: &mut Queue, number: u64, command: &Command, settings: &Settings) {
        let kind = command.target.kind();
        let along_tool = kind.leads_tcp();
        self.records.push(MotionRecord {
            number,
            line: command.line,
            kind,
            programmed: programmed(command, settings, along_tool),
            reached: 0.0,
            start: None,
            duration: 0.0,
            way: 0.0,
            blend: None,
            axes: Nearest::NONE,
            tool: Nearest::NONE,
            carried: command.rig.carried,
            along_tool,
            turning: command.speed.ori * settings.speed_percent / 100.0,
            mixed: false,
            jerks: settings.profile != VelocityProfile::T,
        });
        self.laid(queue);
    }

    /// Notes what the queue has laid on the way.
    fn laid(&mut self, queue: &mut Queue) {
        for Laid { number, motion, left } in queue.take_laid() {
            let rounding = zone::rounding(&self.robot, &motion, 1.0);
            let Some(record) = at(&mut self.records, number) else { continue };
            record.blend = rounding;
            let along_tool = record.along_tool;
            if record.programmed.unit == "mm/s" && motion.length() < NO_DISTANCE_MM {
                record.programmed = Figure { value: record.turning, unit: "deg/s" };
            }
            if let (Some((before, leave)), Some(last)) = (left, &self.last) {
                let rounding = zone::rounding(&self.robot, last, leave);
                let mixed = at(&mut self.records, before).is_some_and(|record| {
                    record.blend = rounding;
                    record.mixed |= record.along_tool != along_tool;
                    record.along_tool != along_tool
                });
                if let Some(record) = at(&mut self.records, number) {
                    record.mixed |= mixed;
                }
            }
            if motion.goes() {
                self.last = Some(motion);
            }
        }
    }

    /// Notes what one cycle of `period` s did.
    pub fn step(&mut self, queue: &mut Queue, step: &Step, period: f64) {
        self.laid(queue);
        let began = self.time;
        self.time += period;
        let all = step.joints.all();
        let mut rates = [[0.0; ALL]; 3];
        let [vel, acc, jerk] = &mut rates;
        for (at, ((vel, acc), jerk)) in vel.iter_mut().zip(acc).zip(jerk).enumerate() {
            let before = |values: &[f64; ALL]| values.get(at).copied().unwrap_or_default();
            *vel = (before(&all) - before(&self.joints)) / period;
            *acc = (*vel - before(&self.rates[0])) / period;
            *jerk = (*acc - before(&self.rates[1])) / period;
        }
        self.joints = all;
        self.rates = [rates[0], rates[1]];
        let number = if step.motion == 0 { self.executed } else { step.motion };
        let Some(record) = at(&mut self.records, number) else { return };
        if self.executed != number {
            self.executed = number;
            self.known = 0;
        }
        if step.motion != 0 {
            record.start.get_or_insert(began);
            record.duration += period;
        }
        let derivatives = if record.jerks { 3 } else { 2 };
        let mut percent = 0.0_f64;
        let own = self.robot.own_axes().len();
        for (at, axis) in self.robot.axes.iter().enumerate() {
            let column = if at < own { at } else { at - own + ROBOT_AXES };
            let rates = [0, 1, 2]
                .map(|order: usize| rates.get(order).and_then(|all| all.get(column)).copied().unwrap_or_default());
            record.axes.raise(Limited::Axis(at), rates, [axis.vel, axis.acc, axis.jerk], derivatives);
            if at < own {
                percent = percent.max(100.0 * rates[0].abs() / axis.vel);
            }
        }

        let way = record.carried.way_at(&self.robot.kinematics.forward(&step.joints.axes));
        let far = (way.translation.vector - self.way.translation.vector).norm();
        let angle = way.rotation.angle_to(&self.way.rotation).to_degrees();
        self.way = way;
        let mut speed = [0.0; 2];
        if self.known > 0 {
            let moving = derivatives_of(far / period, &mut self.moving, period);
            let turning = derivatives_of(angle / period, &mut self.turning, period);
            speed = [moving[0], turning[0]];
            record.way += far;
            if record.along_tool {
                let (tcp, known) = (&self.robot.tcp, self.known.min(derivatives));
                record.tool.raise(Limited::Tcp, moving, [tcp.vel, tcp.acc, tcp.jerk], known);
                record.tool.raise(Limited::Turning, turning, [tcp.ori_vel, tcp.ori_acc, tcp.ori_jerk], known);
            }
        }
        self.known = (self.known + 1).min(3);
        record.reached = match record.programmed.unit {
            "%" => record.reached.max(percent),
            "mm/s" => record.reached.max(speed[0]),
            "deg/s" => record.reached.max(speed[1]),
            _ => record.duration,
        };
    }
}

/// The speed with its first two derivatives, from the speed and acceleration of the cycle before.
fn derivatives_of(speed: f64, before: &mut [f64; 2], period: f64) -> [f64; 3] {
    let acc = (speed - before[0]) / period;
    let jerk = (acc - before[1]) / period;
    *before = [speed, acc];
    [speed, acc, jerk]
}

/// The record of the motion with this number; numbers are without gaps.
fn at(records: &mut [MotionRecord], number: u64) -> Option<&mut MotionRecord> {
    let first = records.first()?.number;
    records.get_mut(usize::try_from(number.checked_sub(first)?).ok()?)
}

fn programmed(command: &Command, settings: &Settings, along_tool: bool) -> Figure {
    let (speed, share) = (&command.speed, settings.speed_percent / 100.0);
    if let Some(duration) = command.duration {
        return Figure { value: duration, unit: "s" };
    }
    if along_tool {
        let most = if settings.manual { settings.max_tcp.min(MANUAL_SPEED_MM_S) } else { settings.max_tcp };
        Figure { value: (speed.tcp * share).min(most), unit: "mm/s" }
    } else {
        Figure { value: speed.percent.min(100.0) * share, unit: "%" }
    }
}
