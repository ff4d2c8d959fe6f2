//! What motions really did: speeds reached, durations, blends, and the limit that each motion came nearest to.

mod derivatives;
mod reached;
mod smaller_zone;

use std::sync::Arc;

use crate::blend::no_blend::NoBlend;
use crate::blend::zone::{self, Rounding};
use crate::command::joints::ALL;
use crate::command::{Command, GatePart, MotionKind, Settings, Speed, Target};
use crate::follow::segment::PlainSpeed;
use crate::plan::constraints::MANUAL_SPEED_MM_S;
use crate::plan::motion::{Motion, NO_MOTION_MM_OR_DEG};
use crate::plan::path_check::NearSingular;
use crate::queue::elapsed::Elapsed;
use crate::queue::path_buffer::Leaving;
use crate::queue::{FAST_STOP_FACTOR, LaidMotion, Queue, Step};
use arl_robot::frames::Carried;
use arl_robot::robot::{ROBOT_AXES, Robot, VelocityProfile};
use derivatives::{DERIVATIVES, Derivatives};
use reached::Reached;
pub use smaller_zone::SmallerZone;

/// A motion that has to be slower than this share of the programmed speed somewhere near a singular point is reported.
const SLOWED_SHARE: f64 = 0.5;
/// Where a smaller part of a zone than this is left out, the zone counts as used as requested.
const NO_PART: f64 = 1e-6;

/// What a programmed speed refers to.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Measure {
    /// The robot's axes, in percent.
    Axes,
    /// The TCP, in mm/s.
    Tcp,
    /// The rotation of the tool, in deg/s.
    Turning,
    /// Rotary external axes, in deg/s.
    TurningAxes,
    /// Linear external axes, in mm/s.
    LinearAxes,
    /// No speed but a duration, in s.
    Duration,
}

/// A value with its unit.
#[derive(Clone, Copy, PartialEq, Debug)]
#[non_exhaustive]
pub struct Figure {
    /// The value.
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

/// What the limit applies to.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[non_exhaustive]
pub enum Limited {
    /// The axis with this index in [`Robot::axes`](arl_robot::robot::Description::axes).
    Axis(usize),
    /// The TCP along its path.
    Tcp,
    /// The rotation of the tool.
    Turning,
}

/// The limit of the robot file that a motion came nearest to.
#[derive(Clone, Copy, PartialEq, Debug)]
#[non_exhaustive]
pub struct Closest {
    /// What the limit applies to.
    pub of: Limited,
    /// Which derivative is limited.
    pub rate: Rate,
    /// Share of the limit that was used: 1 is all of it.
    pub share: f64,
}

impl Closest {
    /// The name of what the limit applies to, as in robot files: `j3`, `tcp`, `tcp ori`.
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

    /// Takes over the shares that are higher, of the first `known` derivatives.
    fn raise(&mut self, of: Limited, rates: [f64; 3], limits: [f64; 3], known: usize) {
        for ((closest, value), limit) in self.0.iter_mut().zip(rates).zip(limits).take(known) {
            let share = value.abs() / limit;
            if share > closest.share {
                *closest = Closest { of, share, ..*closest };
            }
        }
    }
}

/// One executed motion. Until it has ended, the values are those so far.
#[derive(Clone, PartialEq, Debug)]
#[non_exhaustive]
pub struct MotionRecord {
    /// Running number, from 1; the rest of a gate that was looked at from above has the next one.
    pub number: u64,
    /// Program line.
    pub line: u32,
    /// The kind of motion.
    pub kind: MotionKind,
    /// The programmed speed, under the override: in % of the axes' limits for axis motions, else in mm/s, or in deg/s
    /// where only the tool turns, or the speed of the external axes where they move alone; or the programmed duration
    /// in s.
    pub programmed: Figure,
    /// The highest speed, in the same unit, outside the zones at both ends and without overlays; where the zones take
    /// all of the motion, the speed between them. For a motion with a duration, the time that it took.
    pub reached: f64,
    /// When it began, in s of controller time; `None` where it has not begun.
    pub start: Option<f64>,
    /// How long it was executed, in s.
    pub duration: f64,
    /// Length of the path of the TCP relative to the workpiece, in mm.
    pub path_length: f64,
    /// The zone at its end as planned, where one was requested.
    blend: Option<Rounding>,
    /// Reason why the robot stops at its target although a zone was requested.
    pub unblended: Option<NoBlend>,
    /// Where it passes so close to a singular point that it is slowed down to less than half of the programmed speed.
    pub slowed: Option<NearSingular>,
    /// Reason why a smaller zone than requested is used.
    less: Option<NoBlend>,
    /// Whether it continues into the next motion without a corner, and whether it was completed.
    flows: bool,
    arrived: bool,
    speeds: Reached,
    axes: Nearest,
    tool: Nearest,
    carried: Carried,
    along_tool: bool,
    /// What the programmed speed refers to, and the programmed speeds of everything else that a motion along a path may
    /// move.
    measure: Measure,
    speed: Speed,
    /// Whether a blend with an axis motion is a part of it, in which the limits of the TCP do not hold.
    mixed: bool,
    jerks: bool,
}

impl MotionRecord {
    /// The limits of speed, acceleration and jerk that the motion came nearest to. Where a blend with an axis motion is
    /// a part of it, the limits of the TCP do not hold and are left out, as is the jerk with the profile T.
    pub fn closest(&self) -> [Option<Closest>; 3] {
        let with_tool = self.along_tool && !self.mixed;
        let mut found = [None; 3];
        for ((found, axes), tool) in found.iter_mut().zip(self.axes.0).zip(self.tool.0) {
            let best = if with_tool && tool.share > axes.share { tool } else { axes };
            *found = (best.share > 0.0).then_some(best);
        }
        found
    }

    /// The zone at the end of the motion, where one was requested. None of it counts as used until the motion is
    /// completed.
    pub fn zone(&self) -> Option<Rounding> {
        self.blend.map(|blend| Rounding { used: if self.arrived { blend.used } else { 0.0 }, ..blend })
    }

    /// The reason why the zone at its end was not used as requested: not at all, or only in part. `None` where it was,
    /// or where none was requested.
    pub fn smaller_zone(&self) -> Option<SmallerZone> {
        let blend = self.zone().filter(|blend| blend.used < blend.asked * (1.0 - NO_PART))?;
        Some(match (&self.unblended, &self.less) {
            _ if !self.arrived => SmallerZone::Unfinished,
            (Some(why), _) => SmallerZone::Stop(why.clone()),
            (None, _) if self.flows => SmallerZone::Flows,
            (None, Some(why)) => SmallerZone::Part(why.clone()),
            (None, None) if blend.used > 0.0 => SmallerZone::Half,
            (None, None) => SmallerZone::NothingBehind,
        })
    }

    /// What the programmed speed of a motion refers to: the robot's axes, or the TCP along a path; where the TCP does
    /// not move, the tool's rotation; where that does not change either, external axes.
    fn measured_by(&self, robot: &Robot, motion: &Motion) -> (Measure, Figure) {
        let figure = |value: f64, unit: &'static str| Figure { value, unit };
        let moves = |linear: bool| {
            let ends = motion.end.external.iter().zip(&motion.start.external);
            robot.external_axes().iter().zip(ends).any(|(axis, (end, start))| axis.linear == linear && end != start)
        };
        let (of_path, moves_external) = (self.measure == Measure::Tcp, moves(false) || moves(true));
        if of_path && motion.length() >= NO_MOTION_MM_OR_DEG {
            (Measure::Tcp, self.programmed)
        } else if of_path && (motion.moves_tool() || !moves_external) {
            (Measure::Turning, figure(self.speed.ori, "deg/s"))
        } else if !of_path && (motion.end.axes != motion.start.axes || !moves_external) {
            (Measure::Axes, self.programmed)
        } else if moves(false) {
            (Measure::TurningAxes, figure(self.speed.exj, "deg/s"))
        } else {
            (Measure::LinearAxes, figure(self.speed.exl, "mm/s"))
        }
    }
}

/// Records planning and interpolation. Memory is allocated when a motion is planned, never in a cycle.
#[derive(Clone, Debug)]
pub struct Recorder {
    robot: Arc<Robot>,
    records: Vec<MotionRecord>,
    /// Index of the record of each motion, by the motion's number, from the first one on.
    places: Vec<usize>,
    /// The last motion that goes somewhere, with its number.
    last: Option<(u64, Arc<Motion>)>,
    time: Elapsed,
    /// Number of the motion executed last.
    executed: u64,
    /// How axes and TCP move.
    derivatives: Derivatives,
    /// For how many cycles jerks have been limited, and for how many the limits have been those of the robot file.
    smooth: usize,
    plain: usize,
    /// For how many cycles no motion has been executed.
    still: usize,
}

impl Recorder {
    /// Creates a recorder of what this queue does from now on.
    pub fn new(robot: Arc<Robot>, queue: &mut Queue) -> Self {
        queue.watch();
        Self {
            robot,
            records: Vec::new(),
            places: Vec::new(),
            last: None,
            time: Elapsed::default(),
            executed: 0,
            derivatives: Derivatives::resting(*queue.joints()),
            smooth: DERIVATIVES,
            plain: DERIVATIVES,
            still: 0,
        }
    }

    /// The motions that were planned, in order.
    pub fn records(&self) -> &[MotionRecord] {
        &self.records
    }

    /// Notes a motion that the queue has accepted. Its path may become known only with the next motion. The rest of a
    /// gate belongs to the record of the gate.
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
            path_length: 0.0,
            blend: None,
            unblended: None,
            slowed: None,
            less: None,
            flows: false,
            arrived: false,
            speeds: Reached::default(),
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

    /// Notes what the queue has laid on the path.
    fn laid(&mut self, queue: &mut Queue) {
        for LaidMotion { number, motion, leaving, unblended } in queue.take_laid() {
            let rounding = zone::rounding(&self.robot, &motion, 1.0);
            let Some(record) = record_of(&mut self.records, &self.places, number) else { continue };
            record.blend = rounding;
            let along_tool = record.along_tool;
            if matches!(record.measure, Measure::Tcp | Measure::Axes) {
                (record.measure, record.programmed) = record.measured_by(&self.robot, &motion);
            }
            let Figure { value, unit } = record.programmed;
            record.slowed = motion.near_singular.filter(|near| near.unit == unit && near.speed < SLOWED_SHARE * value);
            if let (Some(Leaving { number: before, share, less }), Some((_, last))) = (leaving, &self.last) {
                let rounding = zone::rounding(&self.robot, last, share);
                let mixed = record_of(&mut self.records, &self.places, before).is_some_and(|record| {
                    (record.blend, record.unblended, record.less) = (rounding, None, less);
                    record.mixed |= record.along_tool != along_tool;
                    record.along_tool != along_tool
                });
                if let Some(record) = record_of(&mut self.records, &self.places, number) {
                    record.mixed |= mixed;
                }
            }
            if let Some((before, _)) = self.last.as_ref().filter(|_| motion.flows)
                && let Some(record) = record_of(&mut self.records, &self.places, *before)
            {
                record.flows = true;
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

    /// Notes which motions were completed in this cycle, or were left for a blend: several where they are short.
    fn note_arrived(&mut self, queue: &Queue) {
        let here = queue.progress().filter(|progress| progress.share >= 1.0);
        // What leads into a motion, or is its first part, is left behind before the motion is.
        let over = queue.exited_motions().iter().filter(|exited| queue.is_over(exited.motion));
        for ended in over.chain(&here) {
            if let Some(record) = record_of(&mut self.records, &self.places, ended.motion) {
                record.arrived = true;
            }
        }
    }

    /// Notes what the cycle did that the queue has just executed.
    pub fn step(&mut self, queue: &mut Queue, step: &Step) {
        let period = queue.cycle();
        self.laid(queue);
        let began = self.time.seconds();
        self.time.add(period);
        self.still = if step.motion == 0 { self.still + 1 } else { 0 };
        self.note_arrived(queue);
        let number = if step.motion == 0 { self.executed } else { step.motion };
        // A robot at rest may be moved by something other than a motion.
        let is_still = self.still >= DERIVATIVES;
        let Some(record) = record_of(&mut self.records, &self.places, number).filter(|_| !is_still) else {
            self.derivatives.without_tool(&step.joints, period);
            return;
        };
        let guided = record.along_tool.then_some(record.carried);
        let tool = self.derivatives.tool(record.carried, guided, &self.robot, &step.joints, period);
        let axes = self.derivatives.axes(&step.joints, period);
        self.executed = number;
        if step.motion != 0 {
            record.start.get_or_insert(began);
            record.duration += period;
        }
        record.path_length += tool.distance;
        // Differences reach back two cycles: the limits that held there count, too.
        self.smooth = if record.jerks { self.smooth + 1 } else { 0 };
        self.plain = if queue.hardness() > 1.0 { 0 } else { self.plain + 1 };
        let derivatives = if self.smooth >= DERIVATIVES { DERIVATIVES } else { DERIVATIVES - 1 };
        let stop_scale = if self.plain >= DERIVATIVES { 1.0 } else { FAST_STOP_FACTOR };
        for (at, axis) in self.robot.axes.iter().enumerate() {
            let column = column_of(&self.robot, at);
            let rates = axes.map(|rates| rates.get(column).copied().unwrap_or_default());
            record.axes.raise(
                Limited::Axis(at),
                rates,
                [axis.vel, axis.acc * stop_scale, axis.jerk * stop_scale],
                derivatives,
            );
        }
        if record.along_tool {
            let (tcp, known) = (&self.robot.tcp, tool.known.min(derivatives));
            record.tool.raise(Limited::Tcp, tool.moving, [tcp.vel, tcp.acc * stop_scale, tcp.jerk * stop_scale], known);
            let limits = [tcp.ori_vel, tcp.ori_acc * stop_scale, tcp.ori_jerk * stop_scale];
            record.tool.raise(Limited::Turning, tool.turning, limits, known);
        }
        let within = Speeds { tcp: tool.moving[0].abs(), turning: tool.turning[0].abs(), axes: axes[0] };
        record.note_speed(&self.robot, queue, number, &within);
    }
}

/// The column of an axis of [`Robot::axes`] among all possible axes.
fn column_of(robot: &Robot, at: usize) -> usize {
    let own = robot.own_axes().len();
    if at < own { at } else { at - own + ROBOT_AXES }
}

/// Speeds of everything that a programmed speed can refer to.
struct Speeds {
    /// mm/s
    tcp: f64,
    /// deg/s
    turning: f64,
    /// deg/s (mm/s)
    axes: [f64; ALL],
}

impl Speeds {
    /// The speed of what a motion is measured by, in its unit.
    fn of(&self, measure: Measure, robot: &Robot) -> f64 {
        let axes = robot.axes.iter().enumerate().map(|(at, axis)| {
            let speed = self.axes.get(column_of(robot, at)).copied().unwrap_or_default();
            (at < robot.own_axes().len(), axis, speed.abs())
        });
        let external = |linear: bool| {
            let own_kind = axes.clone().filter(|(own, axis, _)| !own && axis.linear == linear);
            own_kind.map(|(_, _, speed)| speed).fold(0.0, f64::max)
        };
        match measure {
            Measure::Axes => {
                let shares = axes.clone().filter(|(own, ..)| *own).map(|(_, axis, speed)| 100.0 * speed / axis.vel);
                shares.fold(0.0, f64::max)
            }
            Measure::Tcp => self.tcp,
            Measure::Turning => self.turning,
            Measure::TurningAxes => external(false),
            Measure::LinearAxes => external(true),
            Measure::Duration => 0.0,
        }
    }
}

impl MotionRecord {
    /// Notes the speed in this cycle: outside a zone as planned without overlays, within a zone as it moves.
    fn note_speed(&mut self, robot: &Robot, queue: &Queue, number: u64, within: &Speeds) {
        if self.measure == Measure::Duration {
            self.reached = self.duration;
            return;
        }
        // Once the target is reached, the path continues with the next motion.
        let Some((segment, plain)) = queue.plain_speed().filter(|(segment, _)| segment.number == number) else {
            return;
        };
        match plain {
            Some(PlainSpeed { tcp, turning, axes }) => {
                self.speeds.outside(Speeds { tcp, turning, axes }.of(self.measure, robot));
            }
            None => self.speeds.within(within.of(self.measure, robot), segment.leaves()),
        }
        self.reached = self.speeds.highest();
    }
}

/// The record of the motion with this number; numbers have no gaps.
fn record_of<'a>(records: &'a mut [MotionRecord], places: &[usize], number: u64) -> Option<&'a mut MotionRecord> {
    let first = records.first()?.number;
    let place = places.get(usize::try_from(number.checked_sub(first)?).ok()?)?;
    records.get_mut(*place)
}

/// What the programmed speed refers to, and its value, as long as nothing is known about the path.
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
