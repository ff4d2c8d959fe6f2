//! A report of the motions of a run, as a table for people and as JSON.

use std::fmt::Write;

use crate::command::json::quoted;
use crate::controller::RecordedMotions;
use crate::cycle::clock_source::Lateness;
use crate::fault::File;
use crate::motion::{Closest, MotionKind, MotionRecord, NearSingular, Rate};
use arl_robot::robot::Robot;

/// The last three columns show which limit of that kind was closest, and how much of it was used.
const HEAD: [&str; 10] =
    ["line", "motion", "runs", "programmed", "reached", "each", "blend", "closest vel", "acc", "jerk"];

/// Is printed below the table.
const WHAT_COUNTS: &str =
    "reached: along the path, outside of zones, without a weave; closest: zones included, tcp along its path only\n";

/// The table of each robot; with several robots, each has a headline.
pub(crate) fn tables(robots: &[RecordedMotions]) -> String {
    match robots {
        [robot] => table(robot),
        robots => {
            let headed = |(at, robot): (usize, &RecordedMotions)| {
                format!("channel {}, robot {}:\n{}", at + 1, robot.robot.name, table(robot))
            };
            robots.iter().enumerate().map(headed).collect()
        }
    }
}

/// The report as JSON, robot by robot.
pub(crate) fn all_json(robots: &[RecordedMotions]) -> String {
    robots.iter().enumerate().map(|(at, robot)| json(at + 1, robot)).collect()
}

/// A table with one row for each line of the program, in the order of their first motions, and the figures of the cycle
/// time.
fn table(recorded: &RecordedMotions) -> String {
    let mut lines: Vec<Line<'_>> = Vec::new();
    for (file, record) in recorded.executed() {
        match lines.iter_mut().find(|line| line.is(file, record)) {
            Some(line) => line.add(record),
            None => lines.push(Line::of(file, record)),
        }
    }
    let mut rows = vec![HEAD.map(str::to_owned)];
    rows.extend(lines.iter().map(|line| line.cells(recorded)));
    let mut text = String::new();
    if rows.len() > 1 {
        let width = |at: usize| rows.iter().filter_map(|row| row.get(at)).map(|cell| cell.chars().count()).max();
        for row in &rows {
            let mut shown = String::new();
            for (at, cell) in row.iter().enumerate() {
                let width = width(at).unwrap_or(0);
                // Words are aligned left, numbers right.
                let _ = match HEAD.get(at) {
                    Some(&"motion") => write!(shown, "{cell:width$}  "),
                    _ => write!(shown, "{cell:>width$}  "),
                };
            }
            text.push_str(shown.trim_end());
            text.push('\n');
        }
    }
    for line in &lines {
        if let Some(near) = line.slowed {
            let place = line.place(recorded.program);
            let axis = recorded.robot.axes.get(near.axis).map_or("", |axis| axis.name.as_str());
            let (along, speed, unit) = (100.0 * near.along, short(near.speed), near.unit);
            let _ = writeln!(
                text,
                "line {place}: {along:.1} % along, the path is close to a singularity: {axis} limits the speed to {speed} {unit} there"
            );
        }
        if let Some(why) = line.blend.smaller_zone() {
            let place = line.place(recorded.program);
            let what = if why.stops() { "its target is reached with a stop" } else { "its zone is reduced" };
            let _ = writeln!(text, "line {place}: {what}: {why}");
        }
    }
    if !lines.is_empty() {
        text.push_str(WHAT_COUNTS);
    }
    text + &summary(recorded)
}

fn summary(recorded: &RecordedMotions) -> String {
    let time = recorded.ended;
    let moving = recorded.sum(|record| record.duration);
    let metres = recorded.sum(|record| record.path_length) / 1000.0;
    let count = recorded.executed().count();
    let motions = if count == 1 { "1 motion".to_owned() } else { format!("{count} motions") };
    let percent = if time > 0.0 { 100.0 * moving / time } else { 0.0 };
    let standing = (time - moving).max(0.0);
    format!(
        "cycle time {time:.3} s: {moving:.3} s moving ({percent:.0} %), {standing:.3} s at rest; {motions}, {metres:.3} m\n"
    )
}

/// One JSON object per line: each motion of a channel that began, then the figures of its cycle time.
fn json(channel: usize, recorded: &RecordedMotions) -> String {
    let time = recorded.ended;
    let of_motion = |(file, record)| motion_json(channel, file, record, &recorded.robot);
    let mut text: String = recorded.executed().map(of_motion).collect();
    let moving = recorded.sum(|record| record.duration);
    let _ = writeln!(
        text,
        "{{\"channel\":{channel},\"cycle_time\":{time:.6},\"moving\":{moving:.6},\"standing\":{:.6},\"motions\":{}}}",
        (time - moving).max(0.0),
        recorded.executed().count()
    );
    text
}

/// How late cycles began, as a JSON object in a line; times are in s.
pub(crate) fn clock_json(lateness: &Lateness) -> String {
    let mut steps = String::new();
    for (within, count) in lateness.histogram() {
        let comma = if steps.is_empty() { "" } else { "," };
        let _ = write!(steps, "{comma}[{:.6},{count}]", within.as_secs_f64());
    }
    let (cycles, late, lost) = (lateness.cycles(), lateness.late(), lateness.lost());
    let missing = lateness.missing();
    let longest = lateness.longest().as_secs_f64();
    format!(
        "{{\"clock\":{{\"cycles\":{cycles},\"late\":{late},\"lost\":{lost},\"missing\":{missing},\"longest\":{longest:.6},\"histogram\":[{steps}]}}}}\n"
    )
}

/// A motion of a file as a JSON object, with a newline.
pub(super) fn motion_json(channel: usize, file: File, record: &MotionRecord, robot: &Robot) -> String {
    let mut text = String::new();
    let MotionRecord { number, line, kind, programmed, reached, duration, path_length, .. } = record;
    let (kind, file) = (instruction(*kind), quoted(file.name()));
    let start = record.start.unwrap_or_default();
    let _ = write!(
        text,
        "{{\"channel\":{channel},\"motion\":{number},\"file\":{file},\"line\":{line},\"kind\":\"{kind}\",\"unit\":\"{}\",\"programmed\":{:.6},\
         \"reached\":{reached:.6},\"start\":{start:.6},\"duration\":{duration:.6},\"way\":{path_length:.6}",
        programmed.unit, programmed.value
    );
    if let Some(blend) = record.zone() {
        let (unit, asked, used) = (blend.unit, blend.asked, blend.used);
        let why = record.smaller_zone().map(|why| format!(",\"why\":{}", quoted(&why.to_string())));
        let why = why.unwrap_or_default();
        let _ = write!(text, ",\"blend\":{{\"unit\":\"{unit}\",\"asked\":{asked:.6},\"used\":{used:.6}{why}}}");
    }
    if let Some(near) = record.slowed {
        let axis = quoted(robot.axes.get(near.axis).map_or("", |axis| axis.name.as_str()));
        let (along, speed, unit) = (near.along, near.speed, near.unit);
        let _ = write!(
            text,
            ",\"slowed\":{{\"axis\":{axis},\"along\":{along:.6},\"speed\":{speed:.6},\"unit\":\"{unit}\"}}"
        );
    }
    text.push_str(",\"closest\":{");
    for (at, closest) in record.closest().into_iter().flatten().enumerate() {
        let (comma, rate) = (if at > 0 { "," } else { "" }, rate(&closest));
        let (of, percent) = (quoted(closest.name(robot)), 100.0 * closest.share);
        let _ = write!(text, "{comma}\"{rate}\":{{\"of\":{of},\"percent\":{percent:.3}}}");
    }
    text.push('}');
    text.push_str("}\n");
    text
}

fn rate(closest: &Closest) -> &'static str {
    match closest.rate {
        Rate::Vel => "vel",
        Rate::Acc => "acc",
        Rate::Jerk => "jerk",
    }
}

impl RecordedMotions {
    /// The motions that began.
    fn executed(&self) -> impl Iterator<Item = (File, &MotionRecord)> {
        self.motions.iter().filter(|(_, record)| record.start.is_some()).map(|(file, record)| (*file, record))
    }

    fn sum(&self, of: impl Fn(&MotionRecord) -> f64) -> f64 {
        sum(self.motions.iter().map(|(_, record)| record), of)
    }
}

/// Sums over the motions that began; without any the result is 0, not the -0 of an empty sum.
pub(crate) fn sum<'a>(records: impl IntoIterator<Item = &'a MotionRecord>, of: impl Fn(&MotionRecord) -> f64) -> f64 {
    executed(records).map(of).fold(0.0, |sum, value| sum + value)
}

/// The motions that began.
pub(crate) fn executed<'a>(
    records: impl IntoIterator<Item = &'a MotionRecord>,
) -> impl Iterator<Item = &'a MotionRecord> {
    records.into_iter().filter(|record| record.start.is_some())
}

/// The motions of one line of the program, and of one kind.
struct Line<'a> {
    file: File,
    first: &'a MotionRecord,
    runs: u32,
    duration: f64,
    /// The lowest and highest of the programmed values, and of the reached values.
    programmed: [f64; 2],
    reached: [f64; 2],
    /// The motion whose zone was used least.
    blend: &'a MotionRecord,
    /// The slowest place near a singularity.
    slowed: Option<NearSingular>,
    /// The closest approach to a limit of speed, acceleration and jerk.
    closest: [Option<Closest>; 3],
}

/// The instruction for this kind of motion.
fn instruction(kind: MotionKind) -> &'static str {
    match kind {
        MotionKind::Joints => "movej",
        MotionKind::Pose => "ptp",
        MotionKind::Gate => "jump",
        MotionKind::Line => "lin",
        MotionKind::Arc => "cir",
        MotionKind::Circle => "ccir",
        MotionKind::Spline => "spl",
        _ => "motion",
    }
}

impl<'a> Line<'a> {
    fn of(file: File, record: &'a MotionRecord) -> Self {
        Self {
            file,
            first: record,
            runs: 1,
            duration: record.duration,
            programmed: [record.programmed.value; 2],
            reached: [record.reached; 2],
            blend: record,
            slowed: record.slowed,
            closest: record.closest(),
        }
    }

    fn is(&self, file: File, record: &MotionRecord) -> bool {
        let key = |file: File, record: &MotionRecord| (file, record.line, record.kind, record.programmed.unit);
        key(self.file, self.first) == key(file, record)
    }

    /// `12`, or `grips.arl:12` where it is not in the program's main file.
    fn place(&self, program: File) -> String {
        let line = self.first.line;
        if self.file == program { line.to_string() } else { format!("{}:{line}", self.file.name()) }
    }

    fn add(&mut self, record: &'a MotionRecord) {
        self.runs += 1;
        self.duration += record.duration;
        let widened = |[low, high]: [f64; 2], value: f64| [low.min(value), high.max(value)];
        self.programmed = widened(self.programmed, record.programmed.value);
        self.reached = widened(self.reached, record.reached);
        self.slowed = NearSingular::slower(self.slowed, record.slowed);
        let used = |record: &MotionRecord| record.zone().map_or(f64::INFINITY, |blend| blend.used / blend.asked);
        if used(record) < used(self.blend) {
            self.blend = record;
        }
        let share = |closest: &Option<Closest>| closest.map_or(0.0, |closest| closest.share);
        for (best, closest) in self.closest.iter_mut().zip(record.closest()) {
            if share(&closest) > share(best) {
                *best = closest;
            }
        }
    }

    fn cells(&self, recorded: &RecordedMotions) -> [String; 10] {
        let robot = &recorded.robot;
        let unit = self.first.programmed.unit;
        let blend = self.blend.zone().map_or_else(String::new, |blend| {
            format!("{} of {} {}", short(blend.used), short(blend.asked), blend.unit)
        });
        let [vel, acc, jerk] = self.closest.map(|closest| {
            closest.map_or_else(String::new, |it| format!("{} {} %", it.name(robot), percent(it.share)))
        });
        [
            self.place(recorded.program),
            instruction(self.first.kind).to_owned(),
            self.runs.to_string(),
            range(self.programmed, unit),
            range(self.reached, unit),
            format!("{:.3} s", self.duration / f64::from(self.runs)),
            blend,
            vel,
            acc,
            jerk,
        ]
    }
}

/// How much of a limit was used. Above 100 % with a decimal: up to 101 % is within the limits.
fn percent(share: f64) -> String {
    let percent = 100.0 * share;
    if percent < 100.05 { format!("{percent:.0}") } else { format!("{percent:.1}") }
}

/// `200 mm/s`, or `180..200 mm/s`.
fn range([low, high]: [f64; 2], unit: &str) -> String {
    let (low, high) = (short(low), short(high));
    if low == high { format!("{low} {unit}") } else { format!("{low}..{high} {unit}") }
}

/// Rounds to one decimal, small numbers to two.
fn short(value: f64) -> String {
    let text = if value.abs() < 9.95 { format!("{value:.2}") } else { format!("{value:.1}") };
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}
