//! A trace in parts: the program's own motions, and what came in between, after a `stopmove` or while somebody jogged.

use super::{Leg, PATH};
use crate::motions::geometry::distance;
use crate::motions::plan::{Handler, Plan, Zone};
use crate::motions::robot::Robot;
use crate::motions::scenario::Scenario;
use crate::motions::trace::Row;

/// Motions of the program, one behind the other; what came in between is left out.
#[derive(Default)]
pub(super) struct Section {
    pub(super) rows: Vec<Row>,
    /// It begins at the target of this motion. `None`: it is the first one.
    pub(super) from: Option<usize>,
    /// Whether it goes to the end of the program.
    pub(super) whole: bool,
}

/// What came in between.
pub(super) struct Excursion {
    /// The row before.
    pub(super) stop: Row,
    pub(super) rows: Vec<Row>,
    /// Which handler moved; `None`: somebody jogged.
    pub(super) handler: Option<usize>,
    /// The motion that had been stopped, or the last one.
    pub(super) stopped: usize,
    /// Whether it may have been the next one, which a blend had led to already.
    pub(super) blends: bool,
    /// The motion to whose target it leads, where motions were dropped.
    pub(super) target: Option<usize>,
    /// Whether it leads to where the robot was stopped.
    pub(super) returns: bool,
    /// When the input went on, in s.
    pub(super) input_at: Option<f64>,
    /// The part of the program that it interrupted.
    pub(super) section: usize,
}

/// A trace in parts.
#[derive(Default)]
pub(super) struct Parts {
    pub(super) sections: Vec<Section>,
    pub(super) excursions: Vec<Excursion>,
    /// From this row on the program runs again, as more motions were to be dropped than there were.
    pub(super) again: Option<usize>,
    /// From this row on nothing is said: something was stopped while it went back already.
    pub(super) unknown: Option<usize>,
}

/// What belongs to a row.
#[derive(Clone, Copy, PartialEq, Debug)]
enum Of {
    /// It stands.
    Nothing,
    Motion(usize),
    Handler(usize),
    Jogging,
}

pub(super) struct Apart<'a> {
    robot: &'a Robot,
    plan: &'a Plan,
    legs: &'a [Leg],
    scenario: &'a Scenario,
    parts: Parts,
    /// The motion executed last.
    current: Option<usize>,
    open: Option<Excursion>,
    /// The running numbers of ways back after jogging.
    back: Vec<u64>,
}

impl<'a> Apart<'a> {
    pub(super) fn new(robot: &'a Robot, plan: &'a Plan, legs: &'a [Leg], scenario: &'a Scenario) -> Apart<'a> {
        let parts = Parts { sections: vec![Section::default()], ..Parts::default() };
        Apart { robot, plan, legs, scenario, parts, current: None, open: None, back: Vec::new() }
    }

    /// Takes a trace apart.
    ///
    /// # Errors
    /// What cannot be.
    pub(super) fn take(mut self, rows: &[Row]) -> Result<Parts, String> {
        for (at, row) in rows.iter().enumerate() {
            let of = self.of(row)?;
            let aside = matches!(of, Of::Handler(_) | Of::Jogging);
            if aside && self.open.is_none() {
                self.begin(&rows[at.saturating_sub(1)], of, row.t);
            }
            if let (Of::Motion(_), Some(open)) = (of, self.open.take_if(|_| matches!(of, Of::Motion(_)))) {
                if self.is_nested(&open, row.t) {
                    self.parts.unknown = Some(at);
                    return Ok(self.parts);
                }
                if self.end(open, of)? {
                    self.parts.again = Some(at);
                    return Ok(self.parts);
                }
            }
            if let Of::Motion(motion) = of {
                if motion == 0 && self.current.is_some_and(|current| current > 0) {
                    // There was nothing between the stop and the beginning.
                    self.assert_may_begin_again(row)?;
                    self.parts.again = Some(at);
                    return Ok(self.parts);
                }
                self.current = Some(motion);
            }
            match &mut self.open {
                Some(open) => open.rows.push(row.clone()),
                None => self.section().rows.push(row.clone()),
            }
        }
        if let Some(open) = self.open.take() {
            let over = open.rows.last().map_or(0.0, |row| row.t);
            if self.is_nested(&open, over) {
                self.parts.unknown = Some(rows.len());
                return Ok(self.parts);
            }
            self.end(open, Of::Nothing)?;
        }
        self.section().whole = true;
        Ok(self.parts)
    }

    fn section(&mut self) -> &mut Section {
        self.parts.sections.last_mut().expect("a section")
    }

    fn of(&mut self, row: &Row) -> Result<Of, String> {
        if row.motion == 0 {
            return Ok(Of::Nothing);
        }
        if row.line == 0 {
            self.back.retain(|back| *back != row.motion);
            if !self.back.contains(&(row.motion + 1)) {
                self.back.push(row.motion + 1);
            }
            return Ok(Of::Jogging);
        }
        if self.back.contains(&row.motion) {
            return Ok(Of::Jogging);
        }
        if let Some(motion) = self.plan.motions.iter().position(|motion| motion.line == row.line) {
            return Ok(Of::Motion(motion));
        }
        let has = |handler: &Handler| {
            handler.start == row.line || handler.motions.iter().any(|motion| motion.line == row.line)
        };
        let handler = self.plan.handlers.iter().position(has);
        handler.map(Of::Handler).ok_or_else(|| format!("{} s: nothing moves in line {}", row.t, row.line))
    }

    /// Begins an excursion behind a row.
    fn begin(&mut self, stop: &Row, of: Of, t: f64) {
        let handler = if let Of::Handler(handler) = of { Some(handler) } else { None };
        let input = handler.and_then(|_| self.scenario.inputs().filter(|(at, _)| *at < t).last());
        self.open = Some(Excursion {
            stop: stop.clone(),
            rows: Vec::new(),
            handler,
            stopped: self.current.unwrap_or(0),
            blends: self.current.is_some_and(|current| self.may_blend(current, stop)),
            target: None,
            returns: true,
            input_at: input.map(|(at, _)| at),
            section: self.parts.sections.len() - 1,
        });
    }

    /// Whether another input went on while an excursion was under way.
    fn is_nested(&self, open: &Excursion, end: f64) -> bool {
        let Some(input_at) = open.input_at else { return false };
        self.scenario.inputs().any(|(at, _)| at > input_at && at < end)
    }

    /// Ends an excursion before `then`; whether the program begins again behind it.
    fn end(&mut self, mut open: Excursion, then: Of) -> Result<bool, String> {
        let begins = then == Of::Motion(0) && self.current.is_some_and(|current| current > 0);
        let again = match open.handler {
            Some(handler) => self.skip(&mut open, handler, begins)?,
            None if begins => return Err(format!("{} s: the program begins again", open.stop.t)),
            None => {
                // A motion that has ended is not the stopped one any more: that is the next one, where one is planned.
                let next = self.next_at(&open.stop).unwrap_or(open.stopped);
                (open.blends, open.stopped) = (open.blends && next == open.stopped, next);
                false
            }
        };
        if let (false, Some(target)) = (again, open.target) {
            let end = open.rows.last().expect("a row").clone();
            self.parts.sections.push(Section { rows: vec![end], from: Some(target), whole: false });
            self.current = Some(target);
        }
        self.parts.excursions.push(open);
        Ok(again)
    }

    /// Whether the robot may be in the blend of a motion with the next one at a row.
    fn may_blend(&self, motion: usize, row: &Row) -> bool {
        let leg = &self.legs[motion];
        let in_zone = match leg.motion.zone {
            Zone::Distance(size) => distance(&leg.setting.tcp(&self.robot.flange(&row.axes)), &leg.tcp) <= size + PATH,
            _ => true,
        };
        !leg.rests && motion + 1 < self.legs.len() && in_zone
    }

    /// Says where an excursion of a handler leads to, behind which the program begins again or does not.
    fn skip(&self, open: &mut Excursion, handler: usize, begins: bool) -> Result<bool, String> {
        let handler = &self.plan.handlers[handler];
        let input = self.scenario.inputs().find(|(at, _)| Some(*at) == open.input_at).map(|(_, input)| input);
        if input != Some(handler.input) {
            return Err(format!("{} s: handler {} moves, but input {input:?} went on", open.stop.t, handler.input));
        }
        let next = self.next_at(&open.stop);
        if handler.skip > 0 && next.is_some() {
            open.returns = false;
        }
        let wrong = |what: &str| Err(format!("{} s: {what} after startmove {}", open.stop.t, handler.skip));
        let Some(next) = next.filter(|_| handler.skip > 0) else {
            open.stopped = next.unwrap_or(open.stopped);
            return if begins { wrong("the program begins again") } else { Ok(false) };
        };
        let stopped = self.stopped_at(&open.stop, next);
        let targets = || {
            let stopped = stopped.iter().flatten();
            stopped.filter(|at| handler.skip <= self.plan.ahead(**at)).map(|at| at + handler.skip - 1)
        };
        if begins {
            let all = stopped.iter().flatten().count();
            return if targets().count() < all { Ok(true) } else { wrong("the program begins again") };
        }
        let end = open.rows.last().expect("a row");
        let reached = targets().find(|target| self.legs[*target].is_reached(self.robot, end));
        if reached.is_none() {
            return wrong("no target is reached that was to be");
        }
        open.target = reached;
        Ok(false)
    }

    /// The motion that is executed where the robot stands at a row, or comes next; none where all that is planned is
    /// done.
    fn next_at(&self, row: &Row) -> Option<usize> {
        let Some(current) = self.current else { return Some(0) };
        let leg = &self.legs[current];
        if !leg.is_reached(self.robot, row) {
            return Some(current);
        }
        (!leg.motion.waits && current + 1 < self.legs.len()).then_some(current + 1)
    }

    /// The motions that may count as the stopped one at a row: the next one to be executed there, or, in a blend, the
    /// one that it leads to, while the trace still names the one before.
    fn stopped_at(&self, row: &Row, next: usize) -> [Option<usize>; 2] {
        let blends = self.current == Some(next) && self.may_blend(next, row);
        [Some(next), blends.then_some(next + 1)]
    }

    /// A handler that only drops motions leaves no trace where the program begins again.
    fn assert_may_begin_again(&self, row: &Row) -> Result<(), String> {
        let stand = self.parts.sections.last().and_then(|section| section.rows.last()).expect("a row");
        let stopped = self.next_at(stand).map_or([None; 2], |next| self.stopped_at(stand, next));
        // There is always one to drop where a motion was under way.
        let drops_all = |skip: usize| stopped.iter().flatten().any(|at| skip > self.plan.ahead(*at));
        let input = self.scenario.inputs().filter(|(at, _)| *at < row.t).last();
        let handler = self.plan.handlers.iter().find(|handler| input.is_some_and(|(_, input)| input == handler.input));
        match handler {
            Some(handler) if drops_all(handler.skip) => Ok(()),
            _ => Err(format!("{} s: the program begins again", row.t)),
        }
    }
}
