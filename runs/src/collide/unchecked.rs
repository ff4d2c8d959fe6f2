//! Robots that are checked against themselves alone, as nothing says where they stand.

use std::collections::BTreeMap;

use super::arm::Arm;

/// The robots whose place is not known yet.
#[derive(Default)]
pub(super) struct Unchecked {
    /// By their indices among the arms; whether something else has moved in the meantime.
    waiting: BTreeMap<usize, bool>,
    /// Whether the arms are where the run begins.
    begun: bool,
}

impl Unchecked {
    /// At the start of a run; `robots`: those with something to be checked against, by their indices among the arms.
    pub(super) fn new(robots: impl Iterator<Item = usize>) -> Self {
        Self { waiting: robots.map(|robot| (robot, false)).collect(), begun: false }
    }

    /// Notes which arms have moved in a cycle, by their indices; returns the robots whose place is known from this time
    /// on, in s, and that may have touched something before, in words.
    pub(super) fn cycle(&mut self, arms: &[Option<Arm>], moved: &[usize], time: f64) -> Vec<String> {
        let begun = std::mem::replace(&mut self.begun, true);
        let mut texts = Vec::new();
        self.waiting.retain(|robot, missed| {
            let Some(arm) = arms.get(*robot).and_then(Option::as_ref) else { return false };
            if arm.is_based() {
                if *missed {
                    texts.push(format!(
                        "the robot of channel {} was checked only against itself until its first motion, after \
                         {time:.3} s: {}",
                        arm.channel() + 1,
                        advice(arm.channel())
                    ));
                }
                return false;
            }
            *missed |= begun && moved.iter().any(|other| other != robot);
            true
        });
        texts
    }

    /// The robots whose place never became known, in words.
    pub(super) fn ended(&mut self, arms: &[Option<Arm>]) -> Vec<String> {
        let waiting = std::mem::take(&mut self.waiting);
        let robots = waiting.into_keys().filter_map(|robot| arms.get(robot)?.as_ref());
        let text = |arm: &Arm| {
            let channel = arm.channel();
            format!(
                "the robot of channel {} was checked only against itself, as it did not move: {}",
                channel + 1,
                advice(channel)
            )
        };
        robots.map(text).collect()
    }
}

/// How the place of a channel's robot, from 0, is known from the start.
fn advice(channel: usize) -> &'static str {
    match channel {
        0 => "with `base` in the cell file it is known from the start where it stands",
        _ => "with `base` in its [[channel]] of the cell file it is known from the start where it stands",
    }
}
