//! The data that the page gets, as types: answers are made of them, and `page/api.d.ts` is written from them.

use std::collections::BTreeMap;

use serde::Serialize;

use crate::record::messages::{self, Closest, Color, Level, Pose, Quaternion, Vector3};

/// x, y, z in m (of a base: mm), and a quaternion x, y, z, w.
type Placed = [f64; 7];

/// All of a run except the positions of the robots.
#[derive(Serialize)]
#[cfg_attr(test, derive(ts_rs::TS))]
pub(super) struct RunAnswer {
    /// The file that is shown.
    pub(super) name: String,
    pub(super) channels: Vec<PageChannel>,
    /// The cell's names of signals, by their names in files: `di.1`.
    pub(super) names: BTreeMap<String, String>,
    pub(super) sources: Vec<SourceText>,
    /// The words of the language.
    pub(super) keywords: Vec<&'static str>,
    /// Whether points of the program may be written.
    pub(super) teaches: bool,
    /// What of the recording could not be read, and the reason.
    pub(super) trouble: Option<String>,
    #[serde(flatten)]
    pub(super) news: News,
}

/// What happened since the page's last request.
#[derive(Serialize)]
#[cfg_attr(test, derive(ts_rs::TS))]
pub(super) struct News {
    /// The time of the last message in s.
    pub(super) end: f64,
    /// Counts the messages that were added.
    pub(super) version: u64,
    /// Whether a running program adds to it.
    pub(super) live: bool,
    pub(super) scene: Vec<PageSceneUpdate>,
    pub(super) controller: Vec<Mode>,
    pub(super) log: Vec<Logged>,
    pub(super) contacts: Vec<PageContact>,
    pub(super) motions: Vec<PageMotion>,
    pub(super) tracks: Vec<PageTrack>,
    pub(super) signals: Vec<SignalChanges>,
    pub(super) levels: Levels,
}

/// A channel: what it runs, and its robot; a background channel has none.
#[derive(Serialize)]
#[cfg_attr(test, derive(ts_rs::TS))]
pub(super) struct PageChannel {
    program: String,
    robot: String,
    /// The frame of its TCP.
    tcp: String,
    axes: Vec<PageAxis>,
    /// From the base on, with the flange last.
    links: Vec<PageLink>,
    /// What its external axes move.
    carriers: Vec<PageLink>,
}

/// An axis: its range, and its unit, `deg` or `mm`.
#[derive(Serialize)]
#[cfg_attr(test, derive(ts_rs::TS))]
struct PageAxis {
    name: String,
    unit: String,
    min: f64,
    max: f64,
}

/// A frame of a robot, relative to the frame that it is fixed to or moves against.
#[derive(Serialize)]
#[cfg_attr(test, derive(ts_rs::TS))]
struct PageLink {
    frame: String,
    parent: String,
    /// x, y, z in mm, and a quaternion x, y, z, w, while its axis is at 0.
    origin: Vec<f64>,
    /// The axis that it turns about, or moves along; empty: it does not move.
    axis: Vec<f64>,
    linear: bool,
    /// The name of the axis that moves it; empty: none.
    moved_by: String,
}

/// A file of the program.
#[derive(Serialize)]
#[cfg_attr(test, derive(ts_rs::TS))]
pub(super) struct SourceText {
    pub(super) name: String,
    pub(super) text: String,
}

/// A change of bodies: those that appear or change, and the names of those that disappear.
#[derive(Serialize)]
#[cfg_attr(test, derive(ts_rs::TS))]
pub(super) struct PageSceneUpdate {
    pub(super) time: f64,
    pub(super) entities: Vec<Entity>,
    pub(super) gone: Vec<String>,
}

/// A body, or a limb of a robot.
#[derive(Serialize)]
#[cfg_attr(test, derive(ts_rs::TS))]
pub(super) struct Entity {
    pub(super) id: String,
    pub(super) frame: String,
    pub(super) cubes: Vec<PageSolid>,
    pub(super) spheres: Vec<PageSolid>,
    /// Along z.
    pub(super) cylinders: Vec<PageSolid>,
    pub(super) models: Vec<PageModel>,
}

/// A form of a body: its lengths along x, y and z in m.
#[derive(Serialize)]
#[cfg_attr(test, derive(ts_rs::TS))]
pub(super) struct PageSolid {
    pose: Placed,
    size: [f64; 3],
    color: [f64; 4],
}

/// A mesh of the recording, by its number.
#[derive(Serialize)]
#[cfg_attr(test, derive(ts_rs::TS))]
pub(super) struct PageModel {
    pose: Placed,
    scale: [f64; 3],
    color: [f64; 4],
    model: Option<usize>,
}

/// The operating mode and the override from a time on.
#[derive(Serialize)]
#[cfg_attr(test, derive(ts_rs::TS))]
pub(super) struct Mode {
    time: f64,
    mode: String,
    /// %
    r#override: f64,
}

/// A message, a warning or an alarm.
#[derive(Serialize)]
#[cfg_attr(test, derive(ts_rs::TS))]
pub(super) struct Logged {
    time: f64,
    level: LogLevel,
    text: String,
    name: String,
    file: String,
    line: u32,
}

#[derive(Serialize)]
#[cfg_attr(test, derive(ts_rs::TS))]
#[serde(rename_all = "lowercase")]
enum LogLevel {
    Alarm,
    Warning,
    Message,
}

/// Two bodies begin to touch, or come nearer than the clearance: `distance` in mm, 0 where they touch.
#[derive(Serialize)]
#[cfg_attr(test, derive(ts_rs::TS))]
pub(super) struct PageContact {
    time: f64,
    file: String,
    line: u32,
    one: String,
    other: String,
    distance: f64,
}

/// What a motion did: times in s, the path in mm, speeds in `unit`.
#[derive(Serialize)]
#[cfg_attr(test, derive(ts_rs::TS))]
pub(super) struct PageMotion {
    channel: u32,
    motion: u64,
    file: String,
    line: u32,
    kind: String,
    start: f64,
    duration: f64,
    way: f64,
    programmed: f64,
    reached: f64,
    unit: String,
    blend: Option<PageBlend>,
    vel: Option<(String, f64)>,
    acc: Option<(String, f64)>,
    jerk: Option<(String, f64)>,
}

/// How much of a zone was requested and used, in its unit, and why the robot stopped, if it did.
#[derive(Serialize)]
#[cfg_attr(test, derive(ts_rs::TS))]
struct PageBlend {
    asked: f64,
    used: f64,
    unit: String,
    why: String,
}

/// What a channel did.
#[derive(Serialize)]
#[cfg_attr(test, derive(ts_rs::TS))]
pub(super) struct PageTrack {
    /// The file names to which rows and lines refer by number.
    pub(super) files: Vec<String>,
    pub(super) rows: usize,
    pub(super) states: Vec<(f64, String)>,
    pub(super) bases: Vec<(f64, Placed)>,
    pub(super) lines: Vec<PageLine>,
}

/// How long the robot moved for a line, and was at rest in it, in s.
#[derive(Serialize)]
#[cfg_attr(test, derive(ts_rs::TS))]
pub(super) struct PageLine {
    pub(super) file: u16,
    pub(super) line: u32,
    pub(super) moving: f64,
    pub(super) standing: f64,
}

/// Changes of a signal: times and values in turn.
#[derive(Serialize)]
#[cfg_attr(test, derive(ts_rs::TS))]
pub(super) struct SignalChanges {
    pub(super) signal: String,
    pub(super) changes: Vec<f64>,
}

/// The present inputs and outputs: a digit for each digital one.
#[derive(Serialize)]
#[cfg_attr(test, derive(ts_rs::TS))]
pub(super) struct Levels {
    di: String,
    r#do: String,
    ai: Vec<f64>,
    ao: Vec<f64>,
}

impl From<&messages::Runs> for PageChannel {
    fn from(runs: &messages::Runs) -> Self {
        let axis = |axis: &messages::Axis| {
            let messages::Axis { name, unit, min, max } = axis.clone();
            PageAxis { name, unit, min, max }
        };
        let link = |link: &messages::Link| {
            let messages::Link { frame, parent, origin, axis, linear, moved_by } = link.clone();
            PageLink { frame, parent, origin, axis, linear, moved_by }
        };
        Self {
            program: runs.program.clone(),
            robot: runs.robot.clone(),
            tcp: runs.tcp.clone(),
            axes: runs.axes.iter().map(axis).collect(),
            links: runs.links.iter().map(link).collect(),
            carriers: runs.carriers.iter().map(link).collect(),
        }
    }
}

impl From<&messages::Solid> for PageSolid {
    fn from(one: &messages::Solid) -> Self {
        Self { pose: pose(one.pose), size: vector(one.size), color: color(one.color) }
    }
}

impl From<&messages::Cylinder> for PageSolid {
    fn from(one: &messages::Cylinder) -> Self {
        Self { pose: pose(one.pose), size: vector(one.size), color: color(one.color) }
    }
}

impl PageModel {
    pub(super) fn new(one: &messages::Model, model: Option<usize>) -> Self {
        Self { pose: pose(one.pose), scale: vector(one.scale), color: color(one.color), model }
    }
}

impl From<&messages::Controller> for Mode {
    fn from(one: &messages::Controller) -> Self {
        Self { time: one.time, mode: one.mode.clone(), r#override: one.speed_override }
    }
}

impl Logged {
    pub(super) fn new(time: f64, log: &messages::Log) -> Self {
        let level = match log.level() {
            Level::Error | Level::Fatal => LogLevel::Alarm,
            Level::Warning => LogLevel::Warning,
            _ => LogLevel::Message,
        };
        let messages::Log { message: text, name, file, line, .. } = log.clone();
        Self { time, level, text, name, file, line }
    }
}

impl From<&messages::Contact> for PageContact {
    fn from(one: &messages::Contact) -> Self {
        let messages::Contact { time, file, line, one, other, distance } = one.clone();
        Self { time, file, line, one, other, distance }
    }
}

impl From<&messages::Motion> for PageMotion {
    fn from(motion: &messages::Motion) -> Self {
        let closest = |closest: Option<Closest>| closest.map(|one| (one.of, one.percent));
        let blend = |one: messages::Blend| PageBlend { asked: one.asked, used: one.used, unit: one.unit, why: one.why };
        let motion = motion.clone();
        Self {
            channel: motion.channel,
            motion: motion.motion,
            file: motion.file,
            line: motion.line,
            kind: motion.kind,
            start: motion.start,
            duration: motion.duration,
            way: motion.way,
            programmed: motion.programmed,
            reached: motion.reached,
            unit: motion.unit,
            blend: motion.blend.map(blend),
            vel: closest(motion.closest_vel),
            acc: closest(motion.closest_acc),
            jerk: closest(motion.closest_jerk),
        }
    }
}

impl From<&messages::Io> for Levels {
    fn from(io: &messages::Io) -> Self {
        let row = |levels: &[bool]| levels.iter().map(|on| if *on { '1' } else { '0' }).collect();
        Self { di: row(&io.di), r#do: row(&io.r#do), ai: io.ai.clone(), ao: io.ao.clone() }
    }
}

fn vector(vector: Option<Vector3>) -> [f64; 3] {
    vector.map_or([0.0; 3], |Vector3 { x, y, z }| [x, y, z])
}

fn pose(pose: Option<Pose>) -> Placed {
    let Some(Pose { position, orientation }) = pose else { return [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0] };
    let [at_x, at_y, at_z] = vector(position);
    let Quaternion { x, y, z, w } = orientation.unwrap_or(Quaternion { x: 0.0, y: 0.0, z: 0.0, w: 1.0 });
    [at_x, at_y, at_z, x, y, z, w]
}

fn color(color: Option<Color>) -> [f64; 4] {
    color.map_or([0.5, 0.5, 0.5, 1.0], |Color { r, g, b, a }| [r, g, b, a])
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use ts_rs::{Config, TS};

    use super::*;
    use crate::report::compare::{Differences, LineDifference};
    use crate::view::teach::place::{Mapped, Solution, TaughtPose};
    use crate::view::teach::points::{Mounted, Point, Points};

    fn declared<T: TS>(config: &Config) -> String {
        let docs = T::docs().unwrap_or_default();
        format!("{docs}export {}\n", T::decl(config))
    }

    #[test]
    fn types_of_the_page_are_current() {
        let config = Config::default().with_large_int("number");
        macro_rules! all {
            ($($ty:ty),*) => { [$(declared::<$ty>(&config)),*] };
        }
        let types = all![
            RunAnswer,
            News,
            PageChannel,
            PageAxis,
            PageLink,
            SourceText,
            PageSceneUpdate,
            Entity,
            PageSolid,
            PageModel,
            Mode,
            Logged,
            LogLevel,
            PageContact,
            PageMotion,
            PageBlend,
            PageTrack,
            PageLine,
            SignalChanges,
            Levels,
            Differences,
            LineDifference,
            Points,
            Point,
            Mounted,
            TaughtPose,
            Solution,
            Mapped
        ];
        let text = format!(
            "// What the server of the view says, made from its types in Rust (runs/src/view/api.rs); `scripts/renew.sh`\n// writes it anew.\n\n{}",
            types.join("\n")
        );
        let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("page/api.d.ts");
        if std::env::var_os("UPDATE_PAGE_TYPES").is_some() {
            std::fs::write(&file, &text).unwrap();
        }
        assert_eq!(std::fs::read_to_string(&file).unwrap(), text, "UPDATE_PAGE_TYPES=1 writes it");
    }
}
