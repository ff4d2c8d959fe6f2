//! Programs of interrupts and timers, as data, and as ARL.

use arl_tests::random::Random;
use std::fmt::Write as _;

/// How many inputs and flags conditions look at.
pub(super) const SIGNALS: usize = 4;
/// How many locals each script has, which conditions and actions that it declares may use.
pub(super) const LOCALS: usize = 2;
/// The names that interrupts may have: few, so that they are given again.
const NAMES: usize = 40;

/// What a condition looks at: an input, a flag of the program, a local of the script that runs.
#[derive(Clone, Copy, Debug)]
pub(super) enum Signal {
    Input(usize),
    Flag(usize),
    Local(usize),
}

#[derive(Clone, Copy, Debug)]
pub(super) enum Condition {
    Is(Signal),
    Not(Signal),
    Both(Signal, Signal),
    Either(Signal, Signal),
}

#[derive(Clone, Copy, Debug)]
pub(super) enum Cause {
    Condition(Condition),
    /// After so many ms, again and again or once.
    Time {
        interval: u64,
        repeats: bool,
    },
}

#[derive(Clone, Copy, Debug)]
pub(super) enum Action {
    /// Runs the script with this number.
    Run(usize),
    /// Turns a flag over.
    Turn(usize),
    /// Turns a local of the declaring script over.
    TurnLocal(usize),
}

#[derive(Clone, Copy, Debug)]
pub(super) struct Declaration {
    pub(super) name: Option<usize>,
    pub(super) priority: i32,
    pub(super) cause: Cause,
    pub(super) action: Action,
}

#[derive(Clone, Copy, Debug)]
pub(super) enum Switch {
    Enable,
    Disable,
    Delete,
}

#[derive(Clone, Copy, Debug)]
pub(super) enum Step {
    /// Prints a number and the time.
    Note(usize),
    /// Waits so many ms.
    Wait(u64),
    /// Waits for a condition, so many ms at most.
    Await(Condition, u64),
    Set(usize, bool),
    SetLocal(usize, bool),
    Declare(Declaration),
    Switch {
        what: Switch,
        name: Option<usize>,
        priority: Option<i32>,
    },
    Exit,
}

/// A program: `main`, the first script, and what actions run; and how inputs change.
#[derive(Clone, Debug)]
pub(super) struct Plan {
    pub(super) scripts: Vec<Vec<Step>>,
    /// At which ms which input gets which level, in order.
    pub(super) inputs: Vec<(u64, usize, bool)>,
}

impl Plan {
    pub(super) fn grow(random: &mut Random) -> Self {
        let count = 2 + random.below(5);
        let main = main(random, count);
        let known: Vec<Declaration> = main.iter().filter_map(declared).collect();
        let mut scripts = vec![main];
        scripts.extend((1..count).map(|own| handler(random, own, count, &known)));
        let mut at = 0;
        let inputs = (0..60).map(|_| {
            at += random.below(25) as u64;
            (at, random.below(SIGNALS), random.chance(60))
        });
        let inputs = inputs.collect();
        Self { scripts, inputs }
    }

    /// The program, and the line of each step of each script.
    pub(super) fn text(&self) -> (String, Vec<Vec<u32>>) {
        let mut lines: Vec<String> = vec!["clock c".into(), "int over = 1".into()];
        lines.extend((0..SIGNALS).map(|flag| format!("bool f{flag}")));
        lines.push("func void note(int n)".into());
        lines.push("  print n,\" \",trunc(clkread(c) * 1000,0,true)".into());
        lines.push("endfunc".into());
        let mut places = vec![Vec::new(); self.scripts.len()];
        for (number, script) in self.scripts.iter().enumerate().rev() {
            lines.push(if number == 0 { "func void main()".into() } else { format!("func void h{number}()") });
            if number == 0 {
                lines.push("  clkstart(c)".into());
            }
            lines.extend((0..LOCALS).map(|local| format!("  bool l{local}")));
            for step in script {
                lines.push(format!("  {}", written(step)));
                places[number].push(lines.len() as u32);
            }
            lines.push("endfunc".into());
        }
        (lines.join("\n") + "\n", places)
    }

    /// The scenario of the inputs.
    pub(super) fn scenario(&self) -> String {
        let mut text = String::new();
        for (at, input, level) in &self.inputs {
            let _ = writeln!(text, "[[event]]\nat = {}\ndi.{} = {level}", *at as f64 / 1000.0, input + 1);
        }
        text
    }
}

fn declared(step: &Step) -> Option<Declaration> {
    match step {
        Step::Declare(declaration) => Some(*declaration),
        _ => None,
    }
}

fn main(random: &mut Random, count: usize) -> Vec<Step> {
    let mut steps = Vec::new();
    for number in 0..6 + random.below(16) {
        let known: Vec<Declaration> = steps.iter().filter_map(declared).collect();
        steps.push(match random.below(10) {
            0..5 => Step::Declare(declaration(random, 1, count)),
            5 => Step::Wait(1 + random.below(60) as u64),
            6 => Step::Await(condition(random), 1 + random.below(60) as u64),
            7 => Step::Note(number),
            8 => set(random),
            _ => switch(random, &known),
        });
    }
    for _ in 0..4 {
        steps.push(Step::Wait(50 + random.below(100) as u64));
        steps.push(set(random));
    }
    steps.push(Step::Note(99));
    steps
}

/// What an action runs: functions are defined above their calls, so it declares actions of its own and later numbers
/// only.
fn handler(random: &mut Random, own: usize, count: usize, known: &[Declaration]) -> Vec<Step> {
    let mut steps = vec![Step::Note(own * 100)];
    for number in 1..1 + random.below(5) {
        steps.push(match random.below(20) {
            0..7 => Step::Wait(random.below(20) as u64),
            7..9 => Step::Await(condition(random), random.below(20) as u64),
            9..12 => set(random),
            12..15 => switch(random, known),
            15 if random.chance(45) => Step::Declare(declaration(random, own, count)),
            16 if random.chance(20) => Step::Exit,
            _ => Step::Note(own * 100 + number),
        });
    }
    steps.push(Step::Note(own * 100 + 99));
    steps
}

fn set(random: &mut Random) -> Step {
    let level = random.chance(50);
    if random.chance(60) {
        Step::Set(random.below(SIGNALS), level)
    } else {
        Step::SetLocal(random.below(LOCALS), level)
    }
}

fn condition(random: &mut Random) -> Condition {
    let mut signal = || match random.below(8) {
        0..5 => Signal::Input(random.below(SIGNALS)),
        5..7 => Signal::Flag(random.below(SIGNALS)),
        _ => Signal::Local(random.below(LOCALS)),
    };
    let (a, b) = (signal(), signal());
    match random.below(5) {
        0..2 => Condition::Is(a),
        2 => Condition::Not(a),
        3 => Condition::Both(a, b),
        _ => Condition::Either(a, b),
    }
}

fn declaration(random: &mut Random, from: usize, count: usize) -> Declaration {
    let cause = if random.chance(70) {
        Cause::Condition(condition(random))
    } else {
        let repeats = random.chance(50);
        Cause::Time { interval: if repeats { 30 + random.below(90) as u64 } else { random.below(150) as u64 }, repeats }
    };
    let action = match random.below(10) {
        0..8 => Action::Run(from + random.below(count - from)),
        8 => Action::Turn(random.below(SIGNALS)),
        _ => Action::TurnLocal(random.below(LOCALS)),
    };
    let name = random.chance(35).then(|| random.below(NAMES));
    Declaration { name, priority: priority(random), cause, action }
}

/// Mostly few priorities, so that there are equal ones; now and then one that is none.
fn priority(random: &mut Random) -> i32 {
    match random.below(300) {
        0 => 256,
        1..80 => random.below(256) as i32,
        _ => *random.pick(&[0, 1, 1, 2, 7, 255]),
    }
}

/// Mostly of what is there.
fn switch(random: &mut Random, known: &[Declaration]) -> Step {
    let what = *random.pick(&[
        Switch::Enable,
        Switch::Enable,
        Switch::Enable,
        Switch::Disable,
        Switch::Disable,
        Switch::Delete,
    ]);
    let mut one = || match known {
        [] => None,
        _ => Some(*random.pick(known)),
    };
    let (first, second) = (one(), one());
    let of_second = second.map(|second| second.priority.min(255));
    let (name, priority) = match random.below(10) {
        0..3 => (None, None),
        3 if random.chance(10) => (Some(random.below(NAMES)), None),
        4 if random.chance(10) => (None, Some(priority(random).min(255))),
        5..8 => (None, of_second),
        _ => (first.and_then(|first| first.name), of_second.filter(|_| random.chance(30))),
    };
    Step::Switch { what, name, priority }
}

fn written(step: &Step) -> String {
    match step {
        Step::Note(number) => format!("note({number})"),
        Step::Wait(ms) => format!("waittime {}", *ms as f64 / 1000.0),
        Step::Await(condition, ms) => {
            format!("waituntil {},maxtime:{}", condition_text(condition), *ms as f64 / 1000.0)
        }
        Step::Set(flag, level) => format!("f{flag} = {level}"),
        Step::SetLocal(local, level) => format!("l{local} = {level}"),
        Step::Exit => "exit".into(),
        Step::Switch { what, name, priority } => {
            let word = match what {
                Switch::Enable => "enableint",
                Switch::Disable => "disableint",
                Switch::Delete => "delint",
            };
            let name = name.map(|name| format!("\"n{name}\""));
            let parts: Vec<String> = name.into_iter().chain(priority.map(|priority| priority.to_string())).collect();
            format!("{word} {}", parts.join(",")).trim_end().into()
        }
        Step::Declare(Declaration { name, priority, cause, action }) => {
            let name = name.map(|name| format!("\"n{name}\",")).unwrap_or_default();
            let action = match action {
                Action::Run(script) => format!("h{script}()"),
                Action::Turn(flag) => format!("f{flag} = !f{flag}"),
                Action::TurnLocal(local) => format!("l{local} = !l{local}"),
            };
            // A constant beyond the range would be refused.
            let priority = if *priority > 255 { "255 + over".into() } else { priority.to_string() };
            match cause {
                Cause::Condition(condition) => {
                    format!("interrupt {name}priority:{priority},when:{},do:{action}", condition_text(condition))
                }
                Cause::Time { interval, repeats } => {
                    let interval = *interval as f64 / 1000.0;
                    format!("timer {name}priority:{priority},interval:{interval},rmode:{repeats},do:{action}")
                }
            }
        }
    }
}

fn condition_text(condition: &Condition) -> String {
    let text = |signal: &Signal| match signal {
        Signal::Input(input) => format!("getdi({})", input + 1),
        Signal::Flag(flag) => format!("f{flag}"),
        Signal::Local(local) => format!("l{local}"),
    };
    match condition {
        Condition::Is(a) => text(a),
        Condition::Not(a) => format!("!{}", text(a)),
        Condition::Both(a, b) => format!("{} && {}", text(a), text(b)),
        Condition::Either(a, b) => format!("{} || {}", text(a), text(b)),
    }
}
