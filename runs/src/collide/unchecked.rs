//! Robots that are checked against themselves alone, as nothing says where they stand.

use std::collections::BTreeMap;
use std::fmt;

use super::arm::Arm;

/// How long something else may have moved, in s, before a robot counts as unchecked: programs begin together, but not
/// in the same cycle. From rest a robot gets some millimetres far in this time.
const TOGETHER_S: f64 = 0.02;

/// A robot that was checked only against itself for a time while something else moved, or for the whole run.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Unchecked {
    /// From 1.
    channel: usize,
    /// The time of its first motion, in s; `None` if it did not move.
    until: Option<f64>,
}

impl Unchecked {
    /// The same without the time, which differs from run to run.
    pub fn in_any_run(self) -> String {
        format!(
            "the robot of channel {} is checked only against itself until it moves: {}",
            self.channel,
            self.advice()
        )
    }

    fn advice(self) -> &'static str {
        match self.channel {
            1 => "with `base` in the cell file it is known from the start where it stands",
            _ => "with `base` in its [[channel]] of the cell file it is known from the start where it stands",
        }
    }
}

impl fmt::Display for Unchecked {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "the robot of channel {} was checked only against itself", self.channel)?;
        match self.until {
            Some(time) => write!(f, " until its first motion, after {time:.3} s")?,
            None => f.write_str(", as its program did not move it")?,
        }
        write!(f, ": {}", self.advice())
    }
}

/// The robots whose place is not known yet.
#[derive(Default)]
pub(super) struct Waiting {
    /// By their indices among the arms; when something else has first moved, in s, if it has.
    robots: BTreeMap<usize, Option<f64>>,
    /// The arms that have moved in this cycle, by their indices.
    moved: Vec<usize>,
    /// Whether the arms are where the run begins.
    begun: bool,
}

impl Waiting {
    /// At the start of a run; `robots`: those with something to be checked against, by their indices among the arms.
    pub(super) fn new(robots: impl Iterator<Item = usize>) -> Self {
        Self { robots: robots.map(|robot| (robot, None)).collect(), moved: Vec::new(), begun: false }
    }

    /// Notes that an arm has moved in this cycle, by its index.
    pub(super) fn moved(&mut self, arm: usize) {
        if !self.robots.is_empty() {
            self.moved.push(arm);
        }
    }

    /// Takes a cycle at this time, in s, whose arms have moved; returns the robots whose place is known now, and that
    /// may have touched something before.
    pub(super) fn cycle(&mut self, arms: &[Option<Arm>], time: f64) -> Vec<Unchecked> {
        let begun = std::mem::replace(&mut self.begun, true);
        let mut unchecked = Vec::new();
        let moved = &self.moved;
        self.robots.retain(|robot, first_moved| {
            let Some(arm) = arms.get(*robot).and_then(Option::as_ref) else { return false };
            if arm.is_based() {
                if first_moved.is_some_and(|first| time - first > TOGETHER_S) {
                    unchecked.push(Unchecked { channel: arm.channel() + 1, until: Some(time) });
                }
                return false;
            }
            if begun && moved.iter().any(|other| other != robot) {
                first_moved.get_or_insert(time);
            }
            true
        });
        self.moved.clear();
        unchecked
    }

    /// The robots whose place never became known.
    pub(super) fn ended(&mut self, arms: &[Option<Arm>]) -> Vec<Unchecked> {
        let waiting = std::mem::take(&mut self.robots);
        let robots = waiting.into_keys().filter_map(|robot| arms.get(robot)?.as_ref());
        robots.map(|arm| Unchecked { channel: arm.channel() + 1, until: None }).collect()
    }
}
