//! What comes in between motions of the program: the motions of a handler, or jogging, and the way to where the
//! program's motions go on.

use super::apart::Excursion;
use super::{Account, EXACT, Leg, PREFIX, largest};
use crate::motions::plan::{Goal, Kind, MANUAL, Motion, Plan, Profile, Speeds, Zone};
use crate::motions::robot::Robot;
use crate::motions::scenario::{Deed, Scenario};
use crate::motions::trace::Row;
use std::ops::Range;

/// The share of the axes' speeds with which somebody jogs.
const JOGGING: f64 = 0.1;

impl Account<'_> {
    /// What an excursion has to keep, behind a motion that was stopped.
    ///
    /// # Errors
    /// Something else moves than what was to, or it does not lead to where it should.
    pub(super) fn of_excursion<'a>(
        robot: &'a Robot,
        plan: &Plan,
        program: &[Leg],
        scenario: &Scenario,
        excursion: &Excursion,
        stopped: usize,
    ) -> Result<Account<'a>, String> {
        let mut begin = Leg::at(robot, &excursion.stop.axes, &program[stopped]);
        begin.rows = 0..PREFIX;
        // Before, the trace may have seen the tool of another motion.
        let stand = super::standing(Row { tcp: begin.tcp, ..excursion.stop.clone() });
        let rows: Vec<_> = vec![stand; PREFIX].into_iter().chain(excursion.rows.iter().cloned()).collect();
        let mut legs = vec![begin];
        let handler = excursion.handler.map(|handler| &plan.handlers[handler]);
        // Somebody jogged on the way back: nobody knows that way in parts.
        let ranges = motions(&rows);
        let returns = |range: &Range<usize>| handler.is_none() && rows[range.start].line != 0;
        let torn = ranges.iter().filter(|range| returns(range)).count() > 1;
        let mut own = handler.map_or(&[][..], |handler| &handler.motions).iter();
        // The row up to which its own motions have led.
        let mut moved = PREFIX - 1;
        for range in ranges {
            let row = &rows[range.end - 1];
            let mut leg = if row.line == 0 {
                let mut leg = Leg::at(robot, &row.axes, &jogging(robot, &program[excursion.stopped]));
                let jogged = scenario.events.iter().filter_map(|event| match event.deed {
                    Deed::Jog(axis, by) => Some((axis, by)),
                    _ => None,
                });
                let before = &rows[range.start - 1].axes;
                let is = |(axis, by): (usize, f64)| {
                    let changes = row.axes.iter().zip(before).enumerate();
                    largest(changes.map(|(i, (to, from))| to - from - if i == axis { by } else { 0.0 })) < EXACT
                };
                let jogged = jogged.into_iter().find(|jogged| is(*jogged));
                if let Some((axis, _)) = jogged.filter(|(axis, _)| *axis >= robot.own) {
                    let own = robot.axes[axis].vel * JOGGING;
                    (leg.motion.speeds.exj, leg.motion.speeds.exl) = (own, own);
                }
                if jogged.is_none() {
                    return Err(format!("{} s: nobody jogged the robot to {:?}", row.t, row.axes));
                }
                leg
            } else if handler.is_none_or(|handler| handler.start == row.line) {
                return_leg(robot, program, excursion, (stopped, row.line))
            } else {
                let mut next = || own.next().map(|motion| Leg::of(robot, plan, motion));
                let more = || format!("{} s: line {} moves once more", row.t, row.line);
                let mut leg = next().ok_or_else(more)?;
                while leg.motion.line != row.line {
                    if !leg.goes_nowhere(robot, &rows[moved]) {
                        return Err(format!("line {}: line {} comes before it", leg.motion.line, row.line));
                    }
                    leg = next().ok_or_else(more)?;
                }
                leg.axes.get_or_insert_with(|| row.axes.clone());
                moved = range.end - 1;
                leg
            };
            if torn && row.line != 0 {
                let kind = if leg.motion.kind.leads_tool() { Kind::Spl } else { leg.motion.kind };
                (leg.motion.kind, leg.rests, leg.axes) = (kind, range.end == rows.len(), None);
            }
            leg.rows = range;
            legs.push(leg);
        }
        if let Some(motion) = own.find(|motion| !Leg::of(robot, plan, motion).goes_nowhere(robot, &rows[moved])) {
            return Err(format!("line {}: no row of the trace is of this motion", motion.line));
        }
        if excursion.returns {
            let end = &rows[rows.len() - 1];
            let off = largest(end.axes.iter().zip(&excursion.stop.axes).map(|(is, was)| is - was));
            if off > EXACT {
                return Err(format!("{} s: it goes on {off} deg (mm) off where it was stopped", end.t));
            }
        }
        Ok(Account::over(robot, rows, legs))
    }
}

impl Leg {
    /// Whether the robot is at its target before it begins, so that no row of the trace is of it.
    fn goes_nowhere(&self, robot: &Robot, row: &Row) -> bool {
        let own = self.axes.iter().flat_map(|axes| axes.iter().zip(&row.axes));
        self.is_reached(robot, row) && largest(own.map(|(target, is)| is - target)) < EXACT
    }
}

/// The rows of the motions, one after the other.
fn motions(rows: &[Row]) -> Vec<Range<usize>> {
    let mut ranges: Vec<(u64, Range<usize>)> = Vec::new();
    for (at, row) in rows.iter().enumerate().filter(|(_, row)| row.motion != 0) {
        match ranges.last_mut() {
            Some((motion, range)) if *motion == row.motion => range.end = at + 1,
            _ => ranges.push((row.motion, at..at + 1)),
        }
    }
    ranges.into_iter().map(|(_, range)| range).collect()
}

/// The way to the place of the stop, or to a later target: straight for motions of the TCP.
fn return_leg(robot: &Robot, program: &[Leg], excursion: &Excursion, (stopped, line): (usize, usize)) -> Leg {
    let like = &program[excursion.target.unwrap_or(stopped)];
    let mut leg = match excursion.target {
        Some(_) => like.clone(),
        None => Leg::at(robot, &excursion.stop.axes, like),
    };
    let motion = &mut leg.motion;
    motion.kind = match motion.kind {
        Kind::Jump(gate) if excursion.target.is_some() => Kind::Jump(gate),
        kind if kind.leads_tool() => Kind::Lin,
        _ => Kind::Movej,
    };
    (motion.line, motion.zone, motion.dura, motion.rests) = (line, Zone::None, None, true);
    if excursion.handler.is_none() {
        (motion.manual, motion.speeds.tcp) = (true, motion.speeds.tcp.min(MANUAL));
    }
    leg.rests = true;
    leg.axes.get_or_insert_with(|| excursion.rows[excursion.rows.len() - 1].axes.clone());
    leg
}

/// Somebody moves the robot by its buttons, with what it carries in the motion that was stopped.
fn jogging(robot: &Robot, stopped: &Leg) -> Leg {
    let motion = Motion {
        line: 0,
        kind: Kind::Movej,
        goal: Goal::Taught(0),
        setting: 0,
        zone: Zone::None,
        speeds: Speeds { axes: JOGGING, tcp: MANUAL, ori: f64::INFINITY, exj: f64::INFINITY, exl: f64::INFINITY },
        dura: None,
        accset: [1.0; 2],
        profile: Profile::S,
        wrist: false,
        rests: true,
        waits: true,
        manual: true,
    };
    Leg { setting: stopped.setting, ..Leg::bare(robot, motion) }
}
