//! Where a program halts next.

use std::collections::HashSet;
use std::path::Path;

use super::link::DebugRequest;

/// How far a program goes until it halts.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum RunMode {
    /// Until a reason that always halts it.
    Continue,
    /// To the next statement or cycle.
    Pause,
    /// To the channel's next statement, in whichever function.
    Into(usize),
    /// To the channel's next statement that is at most this deep in functions.
    Over(usize, usize),
    /// To the next motion of the channel's robot: another one than that with this number.
    Motion(usize, u64),
    /// To a point, whatever comes before.
    Until(Point),
    /// To a point, or to an earlier reason that always halts it.
    Search(Point),
}

/// The end of a run: a statement or a cycle, whichever comes first.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Point {
    /// The number of the statement.
    pub(super) statement: u64,
    /// The number of the cycle that is about to begin.
    pub(super) cycle: u64,
}

/// A statement that is about to run.
#[derive(Clone, Copy, Debug)]
pub(super) struct Statement<'a> {
    /// How many statements were about to run so far, this one included.
    pub(super) number: u64,
    /// The index of its channel.
    pub(super) channel: usize,
    /// How deep it is in functions.
    pub(super) depth: usize,
    /// The folder and the main file of its program: others may have files of the same names.
    pub(super) folder: &'a Path,
    pub(super) program: &'a str,
    pub(super) file: &'a str,
    pub(super) line: u32,
    /// Whether the action of an event begins with it.
    pub(super) begins_action: bool,
    /// Whether it belongs to the condition of an event.
    pub(super) is_condition: bool,
}

/// The reason why a program halts.
pub(super) type Why = &'static str;

/// The lines of a program's file at which it halts.
#[derive(Debug)]
struct Lines {
    folder: String,
    program: String,
    file: String,
    lines: HashSet<u32>,
}

impl Lines {
    fn has(&self, statement: &Statement<'_>) -> bool {
        self.lines.contains(&statement.line)
            && self.file == statement.file
            && self.program == statement.program
            && Path::new(&self.folder) == statement.folder
    }
}

/// Where a program halts.
#[derive(Default, Debug)]
pub(super) struct HaltPlan {
    lines: Vec<Lines>,
    events: bool,
    /// Whether it halts at alarms.
    pub(super) alarms: bool,
    /// How far it goes; `None`: until a reason that always halts it.
    run_mode: Option<RunMode>,
}

impl HaltPlan {
    /// Sets the lines of a file to halt at, and no others of it. The request has the folder and the main file of the
    /// program, the name of the file, and the lines.
    pub(super) fn set_lines(&mut self, request: &DebugRequest) {
        let lines = request.values.iter().skip(3).filter_map(|line| line.parse().ok()).collect();
        let [folder, program, file] = [0, 1, 2].map(|at| request.value(at).to_owned());
        self.lines.retain(|known| (&known.folder, &known.program, &known.file) != (&folder, &program, &file));
        self.lines.push(Lines { folder, program, file, lines });
    }

    /// Sets which of `alarms` and `events` it halts at.
    pub(super) fn set_kinds(&mut self, request: &DebugRequest) {
        let has = |word: &str| request.values.iter().any(|value| value == word);
        (self.alarms, self.events) = (has("alarms"), has("events"));
    }

    pub(super) fn go(&mut self, run_mode: RunMode) {
        self.run_mode = Some(run_mode).filter(|run_mode| *run_mode != RunMode::Continue);
    }

    /// How far it goes.
    pub(super) fn run_mode(&self) -> RunMode {
        self.run_mode.unwrap_or(RunMode::Continue)
    }

    /// Whether it halts before a statement, and the reason. A debugger may let it pass a breakpoint: then the second
    /// reason counts.
    pub(super) fn halts_at(&self, statement: &Statement<'_>) -> Option<(Why, Option<Why>)> {
        let Statement { number, channel, depth, .. } = *statement;
        let arrived = match self.run_mode() {
            RunMode::Until(end) => return (number >= end.statement).then_some(("step", None)),
            RunMode::Continue | RunMode::Motion(..) => None,
            RunMode::Pause => Some("pause"),
            RunMode::Search(end) => (number >= end.statement).then_some("step"),
            RunMode::Into(stepped) => (channel == stepped && !statement.is_condition).then_some("step"),
            RunMode::Over(stepped, deepest) => (channel == stepped && depth <= deepest).then_some("step"),
        };
        let breaks = || self.lines.iter().any(|known| known.has(statement));
        let begins = || (self.events && statement.begins_action).then_some("event");
        let other = begins().or(arrived);
        if breaks() { Some(("breakpoint", other)) } else { other.map(|why| (why, None)) }
    }

    /// Whether it halts before a cycle, after this many statements, where the robot of the channel executes this
    /// motion. A pause before the first statement halts at that statement: before it there is no place to show.
    pub(super) fn halts_between(&self, cycle: u64, statements: u64, motion_of: impl Fn(usize) -> u64) -> Option<Why> {
        match self.run_mode() {
            RunMode::Pause => (statements > 0).then_some("pause"),
            RunMode::Until(end) | RunMode::Search(end) if cycle >= end.cycle => Some("step"),
            RunMode::Motion(channel, from) => {
                let motion = motion_of(channel);
                (motion != from && motion != 0).then_some("step")
            }
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn here() -> Statement<'static> {
        Statement {
            number: 5,
            channel: 0,
            depth: 2,
            folder: Path::new("one"),
            program: "main.arl",
            file: "a.arl",
            line: 7,
            begins_action: false,
            is_condition: false,
        }
    }

    fn going(run_mode: RunMode) -> HaltPlan {
        let mut plan = HaltPlan::default();
        plan.go(run_mode);
        plan
    }

    fn to(statement: u64) -> Point {
        Point { statement, cycle: u64::MAX }
    }

    fn request(values: &[&str]) -> DebugRequest {
        DebugRequest { number: 1, word: String::new(), values: values.iter().map(ToString::to_string).collect() }
    }

    #[test]
    fn lines_halt_in_their_file_until_they_are_set_anew() {
        let mut plan = HaltPlan::default();
        plan.set_lines(&request(&["one", "main.arl", "a.arl", "7", "9"]));
        assert_eq!(plan.halts_at(&here()), Some(("breakpoint", None)));
        assert_eq!(plan.halts_at(&Statement { file: "b.arl", ..here() }), None);
        assert_eq!(plan.halts_at(&Statement { folder: Path::new("two"), ..here() }), None);
        plan.go(RunMode::Into(0));
        assert_eq!(plan.halts_at(&here()), Some(("breakpoint", Some("step"))));
        plan.go(RunMode::Continue);
        plan.set_lines(&request(&["one", "main.arl", "a.arl"]));
        assert_eq!(plan.halts_at(&here()), None);
    }

    #[test]
    fn steps_end_where_they_should() {
        assert_eq!(going(RunMode::Into(0)).halts_at(&Statement { depth: 9, ..here() }), Some(("step", None)));
        assert_eq!(going(RunMode::Into(1)).halts_at(&here()), None);
        assert_eq!(going(RunMode::Into(0)).halts_at(&Statement { is_condition: true, ..here() }), None);
        assert_eq!(going(RunMode::Over(0, 1)).halts_at(&here()), None);
        assert_eq!(going(RunMode::Over(0, 2)).halts_at(&here()), Some(("step", None)));
        assert_eq!(going(RunMode::Until(to(6))).halts_at(&here()), None);
        assert_eq!(going(RunMode::Until(to(5))).halts_at(&here()), Some(("step", None)));
        assert_eq!(going(RunMode::Motion(0, 3)).halts_between(9, 5, |_| 3), None);
        assert_eq!(going(RunMode::Motion(0, 3)).halts_between(9, 5, |_| 4), Some("step"));
        assert_eq!(going(RunMode::Motion(0, 3)).halts_between(9, 5, |_| 0), None, "no motion begins");
        assert_eq!(going(RunMode::Search(Point { cycle: 9, ..to(6) })).halts_between(8, 5, |_| 3), None);
        assert_eq!(going(RunMode::Search(Point { cycle: 9, ..to(6) })).halts_between(9, 5, |_| 3), Some("step"));
    }

    #[test]
    fn a_pause_halts_where_there_is_something_to_show() {
        let plan = going(RunMode::Pause);
        assert_eq!(plan.halts_between(0, 0, |_| 0), None, "nothing has begun");
        assert_eq!(plan.halts_at(&here()), Some(("pause", None)));
        assert_eq!(plan.halts_between(9, 5, |_| 0), Some("pause"));
    }

    #[test]
    fn a_run_back_to_a_point_passes_breakpoints() {
        let mut plan = going(RunMode::Until(to(6)));
        plan.set_lines(&request(&["one", "main.arl", "a.arl", "7"]));
        assert_eq!(plan.halts_at(&here()), None);
    }

    #[test]
    fn actions_halt_where_they_begin() {
        let mut plan = HaltPlan::default();
        plan.set_kinds(&request(&["events"]));
        assert_eq!(plan.halts_at(&here()), None);
        assert_eq!(plan.halts_at(&Statement { begins_action: true, ..here() }), Some(("event", None)));
    }
}
