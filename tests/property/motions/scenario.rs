//! Stops and other overrides at the pendant while a program runs.

use super::grow::between;
use arl_tests::random::Random;
use std::fmt::Write as _;

/// The override is put to so much.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct Event {
    /// s
    pub(crate) at: f64,
    /// 0 to 1; at 0 the robot stops on its path.
    pub(crate) share: f64,
}

/// Events, the earliest first; the last ones let the program go on at full speed.
#[derive(Clone, Debug)]
pub(crate) struct Scenario {
    pub(crate) text: String,
    pub(crate) events: Vec<Event>,
}

impl Scenario {
    /// Stops and other overrides, for as long as a program may run.
    pub(crate) fn grow(random: &mut Random) -> Scenario {
        let (mut t, mut text) = (0.0, String::new());
        let mut add = |at: f64, percent: usize| {
            writeln!(text, "[[event]]\nat = {at:.3}\noverride = {percent}\n").unwrap();
        };
        let eager = random.chance(30);
        while t < 60.0 {
            t += between(random, 0.05, if eager { 0.4 } else { 2.0 });
            match random.below(5) {
                0 | 1 => {
                    add(t, 0);
                    let longest = if random.chance(40) { 0.1 } else { 0.6 };
                    t += between(random, 0.002, longest);
                    add(t, if random.chance(70) { 100 } else { 1 + random.below(100) });
                }
                2 => {
                    // One after the other, while the robot still minds the last.
                    for _ in 0..2 + random.below(6) {
                        add(t, 1 + random.below(100));
                        t += between(random, 0.001, 0.05);
                    }
                }
                3 => {
                    add(t, 1 + random.below(8));
                    t += between(random, 0.05, 0.5);
                    add(t, 100);
                }
                _ => add(t, 30 + random.below(71)),
            }
        }
        add(t + 1.0, 100);
        Scenario::read(&text)
    }

    /// Reads a scenario of this kind.
    pub(crate) fn read(text: &str) -> Scenario {
        let (mut events, mut at) = (Vec::new(), 0.0);
        for line in text.lines() {
            let Some((key, value)) = line.split_once(" = ") else { continue };
            match key {
                "at" => at = value.parse().expect("a time"),
                "override" => events.push(Event { at, share: value.parse::<f64>().expect("a number") / 100.0 }),
                _ => panic!("{line}"),
            }
        }
        Scenario { text: text.to_owned(), events }
    }
}
