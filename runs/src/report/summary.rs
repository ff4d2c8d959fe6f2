//! A run in figures.

use serde::{Deserialize, Serialize};

use crate::playback::{Signal, Store, Track};
use crate::record::messages::{Closest, Level, Motion};
use crate::texts::file_name;

/// A run: times in s, path lengths in mm.
#[derive(Clone, PartialEq, Default, Serialize, Deserialize, Debug)]
pub(crate) struct Summary {
    /// The number of this object's form; another form has another number.
    pub(super) version: u32,
    /// How long it took.
    pub(super) time: f64,
    pub(super) channels: Vec<OfChannel>,
    /// The signals that changed.
    pub(super) signals: Vec<OfSignal>,
    pub(super) contacts: Vec<OfContact>,
    /// What was printed, each with its time, and warnings and alarms.
    pub(super) messages: Vec<TimedText>,
    pub(super) warnings: Vec<TimedText>,
    pub(super) alarms: Vec<TimedText>,
}

/// What the program of a channel took, and what its robot did.
#[derive(Clone, PartialEq, Default, Serialize, Deserialize, Debug)]
pub(super) struct OfChannel {
    pub(super) channel: usize,
    pub(super) program: String,
    /// Empty in the background.
    pub(super) robot: String,
    /// Its state at the end: `ended`, `alarm`, ...
    pub(super) state: String,
    pub(super) moving: f64,
    pub(super) standing: f64,
    pub(super) motions: usize,
    pub(super) way: f64,
    pub(super) lines: Vec<OfLine>,
}

/// What a line took: while its motions were executed, and while the robot was at rest and the program was in the line.
#[derive(Clone, PartialEq, Default, Serialize, Deserialize, Debug)]
pub(super) struct OfLine {
    pub(super) file: String,
    pub(super) line: u32,
    pub(super) moving: f64,
    pub(super) standing: f64,
    /// How often one of its motions was executed, which kinds there were, and how long their paths were.
    pub(super) motions: usize,
    pub(super) kinds: Vec<String>,
    pub(super) way: f64,
    /// The blend of which the least part was used.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) blend: Option<OfBlend>,
    /// The limit that was approached most closely.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) closest: Option<Limit>,
}

/// How much of a zone was requested and used, and why the robot stopped, if it did.
#[derive(Clone, PartialEq, Default, Serialize, Deserialize, Debug)]
pub(super) struct OfBlend {
    pub(super) asked: f64,
    pub(super) used: f64,
    pub(super) unit: String,
    pub(super) why: String,
}

/// A limit: of an axis or of the TCP, of which rate, and how much of it was used in %.
#[derive(Clone, PartialEq, Default, Serialize, Deserialize, Debug)]
pub(super) struct Limit {
    pub(super) of: String,
    pub(super) rate: String,
    pub(super) percent: f64,
}

/// A signal that changed: how often, and how long it was on (other than 0).
#[derive(Clone, PartialEq, Default, Serialize, Deserialize, Debug)]
pub(super) struct OfSignal {
    pub(super) signal: String,
    pub(super) name: String,
    pub(super) changes: usize,
    pub(super) on: f64,
}

/// Two things that came too near to each other; distance 0: they touched.
#[derive(Clone, PartialEq, Default, Serialize, Deserialize, Debug)]
pub(super) struct OfContact {
    pub(super) time: f64,
    pub(super) file: String,
    pub(super) line: u32,
    pub(super) one: String,
    pub(super) other: String,
    pub(super) distance: f64,
}

/// A text, and the time at which it came.
#[derive(Clone, PartialEq, Default, Serialize, Deserialize, Debug)]
pub(super) struct TimedText {
    pub(super) time: f64,
    pub(super) text: String,
}

/// The present form.
const VERSION: u32 = 1;

impl Summary {
    /// Sums up the messages of a run.
    pub(crate) fn of(store: &Store) -> Self {
        let texts_at = |level: fn(Level) -> bool| {
            let of_level = store.log.iter().filter(move |(_, log)| level(log.level()));
            of_level.map(|(time, log)| TimedText { time: *time, text: log.message.clone() }).collect()
        };
        let channels = (1..).zip(&store.cell.channels).map(|(channel, runs)| OfChannel {
            channel,
            program: file_name(&runs.program).to_owned(),
            robot: runs.robot.clone(),
            ..store.tracks.get(channel - 1).map(|track| of_channel(store, track, channel)).unwrap_or_default()
        });
        let contacts = store.contacts.iter().map(|contact| OfContact {
            time: contact.time,
            file: file_name(&contact.file).to_owned(),
            line: contact.line,
            one: contact.one.clone(),
            other: contact.other.clone(),
            distance: contact.distance,
        });
        Self {
            version: VERSION,
            time: store.end,
            channels: channels.collect(),
            signals: signals(store),
            contacts: contacts.collect(),
            messages: texts_at(|level| level < Level::Warning),
            warnings: texts_at(|level| level == Level::Warning),
            alarms: texts_at(|level| level > Level::Warning),
        }
    }
}

fn of_channel(store: &Store, track: &Track, channel: usize) -> OfChannel {
    let own = |motion: &&Motion| motion.channel as usize == channel;
    let file = |number: u16| track.files.get(usize::from(number)).map_or("", |name| file_name(name)).to_owned();
    let mut lines: Vec<OfLine> = Vec::new();
    // What each motion took is known once it has ended; if none has, the time in which the robot was seen moving
    // counts.
    let are_known = store.motions.iter().any(|motion| own(&motion));
    for (&(number, line), took) in track.lines.iter().filter(|((_, line), _)| *line > 0) {
        let (moving, standing) = (if are_known { 0.0 } else { rounded(took.moving) }, rounded(took.standing));
        lines.push(OfLine { file: file(number), line, moving, standing, ..OfLine::default() });
    }
    let main = file(track.pointers.iter().find(|at| at.motion_line > 0).map_or(0, |at| at.motion_file));
    for motion in store.motions.iter().filter(own) {
        let file = match &*motion.file {
            // An old recording has the file beside the motion; a motion shorter than the step between two messages was
            // not seen.
            "" => {
                let number = u32::try_from(motion.motion).ok().and_then(|number| track.motion_files.get(&number));
                number.map_or_else(|| main.clone(), |number| file(*number))
            }
            file => file_name(file).to_owned(),
        };
        match lines.iter_mut().find(|known| known.line == motion.line && known.file == file) {
            Some(known) => known.add(motion),
            None => {
                let mut new = OfLine { file, line: motion.line, ..OfLine::default() };
                new.add(motion);
                lines.push(new);
            }
        }
    }
    lines.retain(|line| line.motions > 0 || line.moving + line.standing > 0.0);
    lines.sort_by(|one, other| (&one.file, one.line).cmp(&(&other.file, other.line)));
    let sum = |of: fn(&OfLine) -> f64| rounded(lines.iter().map(of).sum());
    OfChannel {
        state: track.states.last().map(|(_, state)| state.clone()).unwrap_or_default(),
        moving: sum(|line| line.moving),
        standing: sum(|line| line.standing),
        motions: lines.iter().map(|line| line.motions).sum(),
        way: sum(|line| line.way),
        lines,
        ..OfChannel::default()
    }
}

/// Sums have digits without meaning.
fn rounded(value: f64) -> f64 {
    (value * 1e6).round() / 1e6
}

impl OfLine {
    fn add(&mut self, motion: &Motion) {
        self.motions += 1;
        self.moving = rounded(self.moving + motion.duration);
        self.way = rounded(self.way + motion.way);
        if !self.kinds.contains(&motion.kind) {
            self.kinds.push(motion.kind.clone());
        }
        let share = |used: f64, asked: f64| if asked > 0.0 { used / asked } else { 1.0 };
        if let Some(blend) = &motion.blend
            && self.blend.as_ref().is_none_or(|least| share(blend.used, blend.asked) < share(least.used, least.asked))
        {
            let (unit, why) = (blend.unit.clone(), blend.why.clone());
            self.blend = Some(OfBlend { asked: blend.asked, used: blend.used, unit, why });
        }
        let rates =
            [("speed", &motion.closest_vel), ("acceleration", &motion.closest_acc), ("jerk", &motion.closest_jerk)];
        for (rate, Closest { of, percent }) in rates.into_iter().filter_map(|(rate, of)| Some((rate, of.as_ref()?))) {
            if self.closest.as_ref().is_none_or(|nearest| *percent > nearest.percent) {
                self.closest = Some(Limit { of: of.clone(), rate: rate.to_owned(), percent: *percent });
            }
        }
    }

    /// The time that it took in all.
    pub(super) fn time(&self) -> f64 {
        self.moving + self.standing
    }
}

fn signals(store: &Store) -> Vec<OfSignal> {
    let of = |(signal, changes): (&Signal, &Vec<(f64, f64)>)| {
        let ends = changes.iter().skip(1).map(|(time, _)| *time).chain([store.end]);
        let on = changes.iter().zip(ends).filter(|((_, value), _)| *value != 0.0).map(|((begin, _), end)| end - begin);
        let name = store.name_of(*signal).unwrap_or_default().to_owned();
        OfSignal { signal: signal.to_string(), name, changes: changes.len(), on: rounded(on.sum()) }
    };
    store.signals.iter().map(of).collect()
}
