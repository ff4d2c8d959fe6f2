//! Stepping back: another run from the start, to an earlier statement. On the virtual clock a run repeats itself; what
//! was set by hand in between is set again at the same statements.

use super::{Answer, Session};
use arl_project::options::Clock;
use serde_json::Value;
use std::collections::VecDeque;

/// How far a run has gone.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub(super) struct Point {
    /// How many statements have begun, or are about to.
    pub(super) statement: u64,
    /// The cycle that is about to begin, where no statement is.
    pub(super) cycle: Option<u64>,
}

impl Point {
    /// Before a statement.
    fn before(statement: u64) -> Self {
        Self { statement, cycle: None }
    }

    /// The values that make a program run up to here.
    fn values(self) -> [String; 2] {
        let statement = if self.cycle.is_some() { u64::MAX } else { self.statement };
        [statement, self.cycle.unwrap_or(u64::MAX)].map(|number| number.to_string())
    }
}

/// What was done by hand: where, the request, and its values.
type Edit = (Point, String, Vec<String>);

/// What a run needs to repeat another one.
#[derive(Default, Debug)]
pub(super) struct Record {
    /// What was set by hand.
    edits: Vec<Edit>,
    /// How many lines of each output were shown, and how many the present run has printed.
    shown: [usize; 2],
    come: [usize; 2],
}

impl Record {
    /// Begins another run.
    pub(super) fn begin(&mut self) {
        self.come = [0; 2];
    }

    /// Forgets everything: nothing of an earlier run counts.
    pub(super) fn forget(&mut self) {
        *self = Self::default();
    }

    /// Whether a line is new, that is, was not shown before the run went back.
    pub(super) fn is_new(&mut self, category: &str) -> bool {
        let at = usize::from(category == "stderr");
        let (Some(shown), Some(come)) = (self.shown.get_mut(at), self.come.get_mut(at)) else { return true };
        *come += 1;
        let new = *come > *shown;
        *shown = (*shown).max(*come);
        new
    }

    /// Notes what was set by hand. What is printed from here on may differ from what was shown.
    pub(super) fn edited(&mut self, point: Point, word: &str, values: &[&str]) {
        self.edits.retain(|(at, ..)| *at <= point);
        self.edits.push((point, word.to_owned(), values.iter().map(ToString::to_string).collect()));
        self.shown = self.come;
    }
}

impl Session {
    /// Goes back by one statement.
    pub(super) fn step_back(&mut self) -> Answer {
        let halt = self.standing()?.clone();
        if halt.why == "goto" {
            // Back to before the program pointer was set, and without what was set by hand since.
            self.check_repeats()?;
            while self.replay.edits.pop().is_some_and(|(_, word, _)| word != super::pointer::REQUEST) {}
            return self.go_to(halt.point);
        }
        let Point { statement, cycle } = halt.point;
        let target = if cycle.is_some() { statement } else { statement.saturating_sub(1) };
        if target == 0 {
            return Err("this is the first statement".into());
        }
        self.go_to(Point::before(target))
    }

    /// Goes back to the breakpoint that was passed last, or to the beginning.
    pub(super) fn reverse_continue(&mut self) -> Answer {
        let halt = self.standing()?.clone();
        self.check_repeats()?;
        self.searches = true;
        // Between two cycles the statement has begun: a breakpoint on it was met.
        let last = self.last_breakpoint_before(halt.point);
        self.searches = false;
        self.go_to(Point::before(last?))
    }

    /// The last breakpoint that another run meets before a statement, or the first statement.
    fn last_breakpoint_before(&mut self, end: Point) -> Result<u64, String> {
        self.breakpoints.go_back_to(0);
        self.begin()?;
        let mut edits: VecDeque<_> = self.replay.edits.iter().cloned().collect();
        let (mut last, mut passed) = (1, Point::before(0));
        while passed < end {
            let bound = edits.front().map_or(end, |(at, ..)| end.min(*at));
            if bound > passed {
                let [statement, cycle] = bound.values();
                self.go("search", &[&statement, &cycle])?;
                loop {
                    // A program that has ended is past all breakpoints.
                    let Ok(stopped) = self.wait_for("stopped") else { return Ok(last) };
                    if self.arrive(&stopped) {
                        break;
                    }
                }
            }
            let Some(halt) = self.halt.clone() else { break };
            passed = passed.max(halt.point);
            if halt.why == "breakpoint" && passed < end {
                last = passed.statement;
            }
            while let Some((_, word, values)) = edits.front().filter(|(at, ..)| *at <= passed).cloned() {
                edits.pop_front();
                let values: Vec<&str> = values.iter().map(String::as_str).collect();
                self.change(&word, &values)?;
            }
        }
        Ok(last)
    }

    /// Runs again up to a point.
    fn go_to(&mut self, point: Point) -> Answer {
        self.check_repeats()?;
        self.begin()?;
        // What was set after it is undone.
        self.replay.edits.retain(|(at, ..)| *at <= point);
        self.breakpoints.go_back_to(point.statement);
        let edits = self.replay.edits.clone();
        for (at, word, values) in edits {
            self.run_to(at)?;
            let values: Vec<&str> = values.iter().map(String::as_str).collect();
            self.change(&word, &values)?;
            if let Some(halt) = self.halt.as_mut().filter(|_| word == super::pointer::REQUEST) {
                halt.why = "goto".into();
            }
        }
        self.run_to(point)?;
        Ok(Value::Null)
    }

    fn run_to(&mut self, point: Point) -> Result<(), String> {
        if self.halt.as_ref().is_some_and(|halt| halt.point == point) {
            return Ok(());
        }
        let [statement, cycle] = point.values();
        self.go("until", &[&statement, &cycle])?;
        let stopped = self.wait_for("stopped")?;
        self.arrive(&stopped);
        Ok(())
    }

    fn check_repeats(&self) -> Result<(), String> {
        let real = self.launched.as_ref().is_some_and(|it| matches!(it.options.clock, Some(Clock::Real)));
        if real {
            Err("a run in real time cannot be repeated, so stepping back is not possible".into())
        } else {
            Ok(())
        }
    }
}
