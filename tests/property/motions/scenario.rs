//! What happens at the pendant and at the inputs while a program runs.

use super::grow::{HANDLERS, between};
use super::robot::Robot;
use arl_tests::random::Random;
use std::fmt::Write as _;

/// What somebody does.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) enum Deed {
    /// The override is put to so much, 0 to 1; at 0 the robot stops on its path.
    Share(f64),
    /// An input goes on.
    Input(usize),
    Pause,
    Start,
    Step,
    /// An axis, from 0, is jogged by so much, in deg (mm).
    Jog(usize, f64),
}

#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct Event {
    /// s
    pub(crate) at: f64,
    pub(crate) deed: Deed,
}

/// The share of its speed that the robot may have from a time on; at 0 it stops on its path.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct Share {
    /// s
    pub(crate) at: f64,
    pub(crate) share: f64,
}

/// Events, the earliest first; the last ones let the program go on at full speed.
#[derive(Clone, Default, Debug)]
pub(crate) struct Scenario {
    pub(crate) text: String,
    pub(crate) events: Vec<Event>,
}

/// What kind of things happen.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Disturbance {
    /// Stops by the override, and other overrides.
    Overrides,
    /// Inputs at which the program stops its motion.
    Inputs,
    /// Pauses, in which axes may be jogged.
    Pauses,
    /// Single steps from the beginning, then a start.
    Steps,
}

/// For so long, in s, things happen; a program may take longer.
const LONG: f64 = 60.0;

impl Scenario {
    /// A scenario of a kind.
    pub(crate) fn grow(random: &mut Random, kind: Disturbance, robot: &Robot) -> Scenario {
        let mut text = String::from("event = [\n");
        let mut add = |at: f64, what: &str| writeln!(text, "    {{ at = {at:.3}, {what} }},").unwrap();
        match kind {
            Disturbance::Overrides => overrides(random, &mut add),
            Disturbance::Inputs => inputs(random, &mut add),
            Disturbance::Pauses => pauses(random, robot, &mut add),
            Disturbance::Steps => steps(random, &mut add),
        }
        text.push_str("]\n");
        Scenario::read(&text, robot)
    }

    /// Reads a scenario of this kind: an event a line, as `{ at = SECONDS, WHAT },`.
    pub(crate) fn read(text: &str, robot: &Robot) -> Scenario {
        let (mut events, mut at) = (Vec::new(), 0.0);
        let rows = text.lines().map(str::trim).filter(|line| !["event = [", "]", ""].contains(line));
        let rows = rows.map(|row| {
            let inner = row.strip_prefix("{ ").and_then(|row| row.strip_suffix(" },"));
            inner.unwrap_or_else(|| panic!("one event a line, as a row of `event = [`: {row}"))
        });
        for line in rows.flat_map(|event| event.split(", ")) {
            let (key, value) = line.split_once(" = ").unwrap_or_else(|| panic!("{line}"));
            let number = || value.parse::<f64>().unwrap_or_else(|_| panic!("{line}"));
            let of = |name: &str| key.strip_prefix(name).and_then(|rest| rest.parse::<usize>().ok());
            let deed = match (key, value) {
                ("at", _) => {
                    at = number();
                    continue;
                }
                ("override", _) => Deed::Share(number() / 100.0),
                ("pendant", "\"pause\"") => Deed::Pause,
                ("pendant", "\"start\"") => Deed::Start,
                ("pendant", "\"step\"") => Deed::Step,
                (_, "false") if of("di.").is_some() => continue,
                (_, "true") => Deed::Input(of("di.").unwrap_or_else(|| panic!("{line}"))),
                _ => {
                    let external = of("jog.ej").map(|axis| robot.own + axis);
                    Deed::Jog(of("jog.j").or(external).unwrap_or_else(|| panic!("{line}")) - 1, number())
                }
            };
            events.push(Event { at, deed });
        }
        Scenario { text: text.to_owned(), events }
    }

    /// The shares of the speed; a pause is like an override of 0.
    pub(crate) fn shares(&self) -> Vec<Share> {
        let shares = self.events.iter().filter_map(|event| {
            let share = match event.deed {
                Deed::Share(share) => share,
                Deed::Pause => 0.0,
                Deed::Start | Deed::Step => 1.0,
                Deed::Input(_) | Deed::Jog(..) => return None,
            };
            Some(Share { at: event.at, share })
        });
        shares.collect()
    }

    /// When inputs went on.
    pub(crate) fn inputs(&self) -> impl Iterator<Item = (f64, usize)> {
        self.events.iter().filter_map(|event| match event.deed {
            Deed::Input(input) => Some((event.at, input)),
            _ => None,
        })
    }

    /// When somebody first jogs from a time on; never, if nobody does.
    pub(crate) fn jogged_from(&self, at: f64) -> f64 {
        let jogs = self.events.iter().filter(|event| matches!(event.deed, Deed::Jog(..)) && event.at >= at);
        jogs.map(|event| event.at).next().unwrap_or(f64::INFINITY)
    }

    /// When the program was single-stepped: at its beginning, up to the start. Nothing where it was not.
    pub(crate) fn stepped_until(&self) -> Option<f64> {
        let steps = self.events.first().is_some_and(|first| first.deed == Deed::Step && first.at == 0.0);
        let start = || self.events.iter().find(|event| event.deed == Deed::Start);
        steps.then(|| start().map_or(f64::INFINITY, |event| event.at))
    }
}

fn overrides(random: &mut Random, add: &mut impl FnMut(f64, &str)) {
    let mut t = 0.0;
    let mut put = |at: f64, percent: usize| add(at, &format!("override = {percent}"));
    let eager = random.chance(30);
    while t < LONG {
        t += between(random, 0.05, if eager { 0.4 } else { 2.0 });
        match random.below(5) {
            0 | 1 => {
                put(t, 0);
                let longest = if random.chance(40) { 0.1 } else { 0.6 };
                t += between(random, 0.002, longest);
                put(t, if random.chance(70) { 100 } else { 1 + random.below(100) });
            }
            2 => {
                // One after the other, while the robot still minds the last.
                for _ in 0..2 + random.below(6) {
                    put(t, 1 + random.below(100));
                    t += between(random, 0.001, 0.05);
                }
            }
            3 => {
                put(t, 1 + random.below(8));
                t += between(random, 0.05, 0.5);
                put(t, 100);
            }
            _ => put(t, 30 + random.below(71)),
        }
    }
    put(t + 1.0, 100);
}

fn inputs(random: &mut Random, add: &mut impl FnMut(f64, &str)) {
    let mut t = 0.0;
    while t < LONG {
        t += between(random, 1.0, 7.0);
        let input = 1 + random.below(HANDLERS);
        add(t, &format!("di.{input} = true"));
        t += 0.05;
        add(t, &format!("di.{input} = false"));
    }
}

fn pauses(random: &mut Random, robot: &Robot, add: &mut impl FnMut(f64, &str)) {
    let mut t = 0.0;
    while t < LONG {
        t += between(random, 0.1, 4.0);
        add(t, "pendant = \"pause\"");
        if random.chance(60) {
            for _ in 0..1 + random.below(3) {
                t += between(random, 1.0, 2.0);
                let axis = random.below(robot.axes.len());
                let most = if robot.axes[axis].linear { 20.0 } else { 5.0 };
                let by = (between(random, -most, most) * 100.0).round() / 100.0;
                // By nothing nobody jogs.
                let by = if by == 0.0 { 0.01 } else { by };
                let name =
                    if axis < robot.own { format!("j{}", axis + 1) } else { format!("ej{}", axis + 1 - robot.own) };
                add(t, &format!("jog.{name} = {by:?}"));
            }
            // Sometimes while it still moves.
            t += if random.chance(20) { 0.1 } else { 2.0 };
        } else {
            t += between(random, 0.002, 0.6);
        }
        add(t, "pendant = \"start\"");
    }
}

fn steps(random: &mut Random, add: &mut impl FnMut(f64, &str)) {
    let (mut t, until) = (0.0, between(random, 5.0, LONG));
    let longest = between(random, 0.4, 2.0);
    while t < until {
        add(t, "pendant = \"step\"");
        t += between(random, 0.3, longest);
    }
    add(t, "pendant = \"start\"");
}
