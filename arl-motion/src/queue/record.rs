//! What motions really did: speeds reached, durations, blends, and the limit that each came nearest to.

use std::sync::Arc;

use crate::blend::no_blend::NoBlend;
use crate::blend::zone::{self, Rounding};
use crate::command::joints::ALL;
use crate::command::{Command, GatePart, MotionKind, Settings, Speed, Target};
use crate::plan::constraints::MANUAL_SPEED_MM_S;
use crate::plan::motion::Motion;
use crate::queue::elapsed::Elapsed;
use crate::queue::path_speed::PathSpeed;
use crate::queue::{FAST_STOP_FACTOR, Laid, Queue, Step};
use arl_robot::frames::Carried;
use arl_robot::kinematics::Frame;
use arl_robot::robot::{ROBOT_AXES, Robot, VelocityProfile};

/// TCP paths shorter than this, mm, have no speed: then the tool's turning is what was programmed.
const NO_DISTANCE_MM: f64 = 1e-6;
/// Speed, acceleration, jerk.
const DERIVATIVES: usize = 3;

/// What a programmed speed is one of.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Measure {
    /// The robot's axes, in percent.
    Axes,
    /// The TCP, in mm/s.
    Tcp,
    /// The tool's turning, in deg/s.
    Turning,
    /// External axes that turn, in deg/s.
    TurningAxes,
    /// External axes that go straight, in mm/s.
    LinearAxes,
    /// Not a speed but how long it takes, in s.
    Duration,
}

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
    /// Its running number, from 1; the rest of a gate that was looked at from above has the next one.
    pub number: u64,
    /// Its program line.
    pub line: u32,
    /// Where it goes, and how.
    pub kind: MotionKind,
    /// The programmed speed, under the override: % of the axes' limits on axis motions, else mm/s, or deg/s
    /// where only the tool turns, and that of the external axes where they move alone; or the programmed duration in s.
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
    /// Why the robot stops at its target though a zone was asked for.
    pub unblended: Option<NoBlend>,
    axes: Nearest,
    tool: Nearest,
    carried: Carried,
    along_tool: bool,
    /// Whose speed was programmed, and the programmed speeds of what else a motion along a path may move.
    measure: Measure,
    speed: Speed,
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

    /// What of a motion along a path has the programmed speed: the TCP; where that stays, the tool's turning; where that stays, too,
    /// external axes.
    fn measured_by(&self, robot: &Robot, motion: &Motion) -> (Measure, Figure) {
        let figure = |value: f64, unit: &'static str| Figure { value, unit };
        let moves = |linear: bool| {
            let ways = motion.end.external.iter().zip(&motion.start.external);
            robot.external_axes().iter().zip(ways).any(|(axis, (end, start))| axis.linear == linear && end != start)
        };
        if motion.length() >= NO_DISTANCE_MM {
            (Measure::Tcp, self.programmed)
        } else if motion.moves_tool() || !(moves(false) || moves(true)) {
            (Measure::Turning, figure(self.speed.ori, "deg/s"))
        } else if moves(false) {
            (Measure::TurningAxes, figure(self.speed.exj, "deg/s"))
        } else {
            (Measure::LinearAxes, figure(self.speed.exl, "mm/s"))
        }
    }
}

/// Watches planning and interpolation. Memory is taken when a motion is planned, never in a cycle.
#[derive(Clone, Debug)]
pub struct Recorder {
    robot: Arc<Robot>,
    records: Vec<MotionRecord>,
    /// The place of the record of each motion, by its number, from the first one on.
    places: Vec<usize>,
    /// The last motion that goes somewhere, and its number.
    last: Option<(u64, Arc<Motion>)>,
    time: Elapsed,
    /// The number of the motion executed last.
    executed: u64,
    joints: [f64; ALL],
    /// Speeds, accelerations of the axes.
    rates: [[f64; ALL]; 2],
    way: Frame,
    /// The TCP along its path, and the tool's turning in deg.
    moving: PathSpeed,
    turning: PathSpeed,
    /// For how many cycles jerks have been limited, and limits have been those of the robot file.
    smooth: usize,
    plain: usize,
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
            places: Vec::new(),
            last: None,
            time: Elapsed::default(),
            executed: 0,
            joints: queue.joints().all(),
            rates: [[0.0; ALL]; 2],
            way: Frame::identity(),
            moving: PathSpeed::default(),
            turning: PathSpeed::default(),
            smooth: DERIVATIVES,
            plain: DERIVATIVES,
            known: 0,
        }
    }

    /// The motions that were planned, in order.
    pub fn records(&self) -> &[MotionRecord] {
        &self.records
    }

    /// Notes a motion that the queue has taken. Its way may become known only with the next one. The rest of a gate belongs to the record
    /// of the gate.
    pub fn planned(&mut self, queue: &mut Queue, number: u64, command: &Command, settings: &Settings) {
        let is_rest = matches!(&command.target, Target::Gate { gate, .. } if gate.part == GatePart::Rest);
        let is_of_last = is_rest
            && self.records.last().is_some_and(|last| (last.kind, last.line) == (MotionKind::Gate, command.line));
        self.places.push(if is_of_last { self.records.len() - 1 } else { self.records.len() });
        if is_of_last {
            return self.laid(queue);
        }
        let kind = command.target.kind();
        let along_tool = kind.leads_tcp();
        let (measure, programmed) = programmed(command, settings, along_tool);
        let share = settings.speed_percent / 100.0;
        let Speed { percent, tcp, ori, exj, exl } = command.speed;
        self.records.push(MotionRecord {
            number,
            line: command.line,
            kind,
            programmed,
            reached: 0.0,
            start: None,
            duration: 0.0,
            way: 0.0,
            blend: None,
            unblended: None,
            axes: Nearest::NONE,
            tool: Nearest::NONE,
            carried: command.rig.carried,
            along_tool,
            measure,
            speed: Speed { percent, tcp, ori: ori * share, exj: exj * share, exl: exl * share },
            mixed: false,
            jerks: settings.profile != VelocityProfile::T,
        });
        self.laid(queue);
    }

    /// Notes what the queue has laid on the way.
    fn laid(&mut self, queue: &mut Queue) {
        for Laid { number, motion, left, unblended } in queue.take_laid() {
            let rounding = zone::rounding(&self.robot, &motion, 1.0);
            let Some(record) = record_of(&mut self.records, &self.places, number) else { continue };
            record.blend = rounding;
            let along_tool = record.along_tool;
            if record.measure == Measure::Tcp {
                (record.measure, record.programmed) = record.measured_by(&self.robot, &motion);
            }
            if let (Some((before, leave)), Some((_, last))) = (left, &self.last) {
                let rounding = zone::rounding(&self.robot, last, leave);
                let mixed = record_of(&mut self.records, &self.places, before).is_some_and(|record| {
                    (record.blend, record.unblended) = (rounding, None);
                    record.mixed |= record.along_tool != along_tool;
                    record.along_tool != along_tool
                });
                if let Some(record) = record_of(&mut self.records, &self.places, number) {
                    record.mixed |= mixed;
                }
            }
            if let (Some(why), Some((before, _))) = (unblended, &self.last)
                && let Some(record) = record_of(&mut self.records, &self.places, *before)
            {
                record.unblended = Some(why);
            }
            if motion.goes() {
                self.last = Some((number, motion));
            }
        }
    }

    /// Notes what one cycle of `period` s did.
    pub fn step(&mut self, queue: &mut Queue, step: &Step, period: f64) {
        self.laid(queue);
        let began = self.time.seconds();
        self.time.add(period);
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
        let Some(record) = record_of(&mut self.records, &self.places, number) else { return };
        if self.executed != number {
            self.executed = number;
            self.known = 0;
        }
        if step.motion != 0 {
            record.start.get_or_insert(began);
            record.duration += period;
        }
        // Differences reach back two cycles: what was allowed there counts, too.
        self.smooth = if record.jerks { self.smooth + 1 } else { 0 };
        self.plain = if queue.hardness() > 1.0 { 0 } else { self.plain + 1 };
        let derivatives = if self.smooth >= DERIVATIVES { DERIVATIVES } else { DERIVATIVES - 1 };
        let harder = if self.plain >= DERIVATIVES { 1.0 } else { FAST_STOP_FACTOR };
        let mut percent = 0.0_f64;
        let mut external = [0.0_f64; 2];
        let own = self.robot.own_axes().len();
        for (at, axis) in self.robot.axes.iter().enumerate() {
            let column = if at < own { at } else { at - own + ROBOT_AXES };
            let rates = [0, 1, 2]
                .map(|order: usize| rates.get(order).and_then(|all| all.get(column)).copied().unwrap_or_default());
            record.axes.raise(Limited::Axis(at), rates, [axis.vel, axis.acc * harder, axis.jerk * harder], derivatives);
            if at < own {
                percent = percent.max(100.0 * rates[0].abs() / axis.vel);
            } else {
                let [turning, linear] = &mut external;
                let kind = if axis.linear { linear } else { turning };
                *kind = kind.max(rates[0].abs());
            }
        }

        let way = record.carried.way_at(&self.robot.kinematics.forward(&step.joints.axes));
        let moved = way.translation.vector - self.way.translation.vector;
        let turned = (way.rotation * self.way.rotation.inverse()).scaled_axis().map(f64::to_degrees);
        self.way = way;
        let mut speed = [0.0; 2];
        if self.known > 0 {
            let moving = self.moving.derivatives(moved, period);
            let turning = self.turning.derivatives(turned, period);
            speed = [moving[0].abs(), turning[0].abs()];
            record.way += moved.norm();
            if record.along_tool {
                let (tcp, known) = (&self.robot.tcp, self.known.min(derivatives));
                record.tool.raise(Limited::Tcp, moving, [tcp.vel, tcp.acc * harder, tcp.jerk * harder], known);
                let limits = [tcp.ori_vel, tcp.ori_acc * harder, tcp.ori_jerk * harder];
                record.tool.raise(Limited::Turning, turning, limits, known);
            }
        }
        self.known = (self.known + 1).min(DERIVATIVES);
        record.reached = match record.measure {
            Measure::Axes => record.reached.max(percent),
            Measure::Tcp => record.reached.max(speed[0]),
            Measure::Turning => record.reached.max(speed[1]),
            Measure::TurningAxes => record.reached.max(external[0]),
            Measure::LinearAxes => record.reached.max(external[1]),
            Measure::Duration => record.duration,
        };
    }
}

/// The record of the motion with this number; numbers are without gaps.
fn record_of<'a>(records: &'a mut [MotionRecord], places: &[usize], number: u64) -> Option<&'a mut MotionRecord> {
    let first = records.first()?.number;
    let place = places.get(usize::try_from(number.checked_sub(first)?).ok()?)?;
    records.get_mut(*place)
}

/// What the programmed speed is measured by, and how much it is, as long as nothing is known of the way.
fn programmed(command: &Command, settings: &Settings, along_tool: bool) -> (Measure, Figure) {
    let (speed, share) = (&command.speed, settings.speed_percent / 100.0);
    if let Some(duration) = command.duration {
        return (Measure::Duration, Figure { value: duration, unit: "s" });
    }
    if along_tool {
        let most = if settings.manual { settings.max_tcp.min(MANUAL_SPEED_MM_S) } else { settings.max_tcp };
        (Measure::Tcp, Figure { value: (speed.tcp * share).min(most), unit: "mm/s" })
    } else {
        (Measure::Axes, Figure { value: speed.percent.min(100.0) * share, unit: "%" })
    }
}
