//! What differs between two runs.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt;

use serde::Serialize;

use super::summary::{OfChannel, OfLine, Summary, TimedText};

/// Times and path lengths that differ by less are the same, in s and mm: they were written with a limited number of
/// digits.
const SAME: f64 = 2e-6;

/// The differences: lines that took another time or path length, and the rest in words.
#[derive(Clone, PartialEq, Default, Serialize, Debug)]
#[cfg_attr(test, derive(ts_rs::TS))]
pub(crate) struct Differences {
    /// How long both took, in s.
    time: [f64; 2],
    said: Vec<String>,
    lines: Vec<LineDifference>,
}

/// A line in both runs; a time is absent where the line did not run.
#[derive(Clone, PartialEq, Serialize, Debug)]
#[cfg_attr(test, derive(ts_rs::TS))]
pub(crate) struct LineDifference {
    channel: usize,
    file: String,
    line: u32,
    /// s
    one: Option<f64>,
    other: Option<f64>,
    /// The lengths of the path of the TCP, in mm.
    way: [f64; 2],
}

impl Differences {
    /// The differences between two runs.
    pub(crate) fn between(one: &Summary, other: &Summary) -> Self {
        let mut differences = Self { time: [one.time, other.time], ..Self::default() };
        let mut say = |text: String| differences.said.push(text);
        if one.channels.len() != other.channels.len() {
            say(format!("{} channels became {}", one.channels.len(), other.channels.len()));
        }
        for (before, after) in one.channels.iter().zip(&other.channels) {
            let of = format!("channel {}", before.channel);
            for (what, before, after) in [
                ("program", &before.program, &after.program),
                ("robot", &before.robot, &after.robot),
                ("state at the end", &before.state, &after.state),
            ] {
                if before != after {
                    say(format!("{what} of {of}: `{before}` became `{after}`"));
                }
            }
        }
        texts("message", &one.messages, &other.messages).into_iter().for_each(&mut say);
        texts("warning", &one.warnings, &other.warnings).into_iter().for_each(&mut say);
        texts("alarm", &one.alarms, &other.alarms).into_iter().for_each(&mut say);
        signals(one, other).into_iter().chain(contacts(one, other)).for_each(&mut say);
        let lines = one.channels.iter().zip(&other.channels).flat_map(|(before, after)| rows(before, after));
        differences.lines = lines.collect();
        differences
    }

    /// Whether there are none.
    pub(super) fn is_empty(&self) -> bool {
        let [one, other] = self.time;
        self.said.is_empty() && self.lines.is_empty() && (one - other).abs() < SAME
    }
}

/// The lines that took another time or path length.
fn rows(before: &OfChannel, after: &OfChannel) -> Vec<LineDifference> {
    let key = |line: &OfLine| (line.file.clone(), line.line);
    let keys: BTreeSet<(String, u32)> = before.lines.iter().chain(&after.lines).map(key).collect();
    let row = |(file, line): (String, u32)| {
        let find = |of: &OfChannel| of.lines.iter().find(|one| one.line == line && one.file == file).cloned();
        let (one, other) = (find(before), find(after));
        let way = [&one, &other].map(|line| line.as_ref().map_or(0.0, |line| line.way));
        let [one, other] = [one, other].map(|line| line.map(|line| line.time()));
        let same = matches!((one, other), (Some(one), Some(other)) if (one - other).abs() < SAME);
        let row = LineDifference { channel: before.channel, file, line, one, other, way };
        (!same || (way[0] - way[1]).abs() >= SAME).then_some(row)
    };
    keys.into_iter().filter_map(row).collect()
}

/// The first text that differs.
fn texts(what: &str, one: &[TimedText], other: &[TimedText]) -> Option<String> {
    let differs = |(one, other): (&TimedText, &TimedText)| one.text != other.text;
    let at = one.iter().zip(other).position(differs).unwrap_or(one.len().min(other.len()));
    let number = at + 1;
    match (one.get(at), other.get(at)) {
        (Some(one), Some(other)) => Some(format!("{what} {number}: `{}` became `{}`", one.text, other.text)),
        (Some(one), None) => Some(format!("{what} {number} is gone: `{}`", one.text)),
        (None, Some(other)) => Some(format!("{what} {number} is new: `{}`", other.text)),
        (None, None) => None,
    }
}

fn signals(one: &Summary, other: &Summary) -> Vec<String> {
    let names: BTreeSet<&String> = one.signals.iter().chain(&other.signals).map(|signal| &signal.signal).collect();
    let changes = |of: &Summary, name: &String| {
        of.signals.iter().find(|signal| signal.signal == *name).map_or(0, |signal| signal.changes)
    };
    let differ = |name: &String| {
        let (before, after) = (changes(one, name), changes(other, name));
        (before != after).then(|| format!("{name} changed {}, now {}", times(before), times(after)))
    };
    names.into_iter().filter_map(differ).collect()
}

fn contacts(one: &Summary, other: &Summary) -> Vec<String> {
    let pairs = |of: &Summary| {
        let mut pairs: BTreeMap<(String, String), usize> = BTreeMap::new();
        for contact in &of.contacts {
            *pairs.entry((contact.one.clone(), contact.other.clone())).or_default() += 1;
        }
        pairs
    };
    let (before, after) = (pairs(one), pairs(other));
    let gone = before.keys().filter(|pair| !after.contains_key(pair));
    let gone = gone.map(|(one, other)| format!("{one} no longer comes near {other}"));
    let new = after.iter().filter_map(|(pair, now)| {
        let (one, other) = pair;
        match before.get(pair) {
            None => Some(format!("{one} now comes near {other}")),
            Some(was) if was != now => Some(format!("{one} came near {other} {}, now {}", times(*was), times(*now))),
            Some(_) => None,
        }
    });
    gone.chain(new).collect()
}

/// `once`, `3 times`
fn times(count: usize) -> String {
    if count == 1 { "once".to_owned() } else { format!("{count} times") }
}

impl fmt::Display for Differences {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.is_empty() {
            return writeln!(f, "nothing differs: {:.3} s", self.time[0]);
        }
        let [one, other] = self.time;
        let percent = if one > 0.0 { format!(", {:+.1} %", 100.0 * (other - one) / one) } else { String::new() };
        writeln!(f, "the run took {one:.3} s, now {other:.3} s ({:+.3} s{percent})", other - one)?;
        for text in &self.said {
            writeln!(f, "{text}")?;
        }
        let several = self.lines.iter().any(|row| row.channel > 1);
        let place = |row: &LineDifference| {
            let place = format!("{}:{}", row.file, row.line);
            if several { format!("{place} (channel {})", row.channel) } else { place }
        };
        let width = self.lines.iter().map(|row| place(row).chars().count()).max().unwrap_or(0).max(4);
        if !self.lines.is_empty() {
            writeln!(f, "{:width$}  {:>10}  {:>10}  {:>10}  {:>12}", "line", "before s", "now s", "by s", "way by mm")?;
        }
        for row in &self.lines {
            let cell = |time: Option<f64>| time.map_or_else(|| "-".to_owned(), |time| format!("{time:.3}"));
            let by = row.other.unwrap_or(0.0) - row.one.unwrap_or(0.0);
            let distance = row.way[1] - row.way[0];
            let distance = if distance.abs() < SAME { String::new() } else { format!("{distance:+.3}") };
            let text = format!(
                "{:width$}  {:>10}  {:>10}  {by:>+10.3}  {distance:>12}",
                place(row),
                cell(row.one),
                cell(row.other)
            );
            writeln!(f, "{}", text.trim_end())?;
        }
        Ok(())
    }
}
