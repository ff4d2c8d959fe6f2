//! What must hold of a trace, whatever the program.

mod corner;
mod limits;
mod path;
mod speeds;
mod stops;
mod tally;

pub(crate) use stops::compare;
use stops::stops;
pub(crate) use tally::Tally;

use super::geometry::{Frame, distance, shifted, turned};
use super::plan::{Goal, Kind, Motion, Plan, Setting};
use super::robot::Robot;
use super::scenario::Event;
use super::trace::Row;
use std::ops::Range;

/// s
const CYCLE: f64 = 0.001;

/// How much more than a limit is let pass.
const SLACK: f64 = 1.01;

/// What the nine digits of a trace may be off, in deg or mm: half of the last one.
const ROUNDING: f64 = 0.5e-9;

/// mm that a TCP may be off its path.
const PATH: f64 = 1e-3;

/// deg (mm) that an axis may be off its path, and mm and deg that a target may be missed: what the digits and the
/// trigonometry of kinematics leave.
const EXACT: f64 = 1e-6;

/// A motion with what the trace says about its target.
struct Leg<'a> {
    motion: &'a Motion,
    setting: &'a Setting,
    /// The flange at the target, in the world.
    flange: Frame,
    /// The TCP there.
    tcp: Frame,
    /// Of the target: own axes where they are known, at taught positions and where the robot rests; then external ones.
    axes: Option<Vec<f64>>,
    external: Vec<f64>,
    /// From its first row to the last; rows between, where the robot stands within it, have no line.
    rows: Range<usize>,
    /// Whether the robot stands at the target.
    rests: bool,
}

/// A trace with what its program asked for.
pub(crate) struct Account<'a> {
    robot: &'a Robot,
    rows: &'a [Row],
    legs: Vec<Leg<'a>>,
    /// The share of its speed that each row may have.
    shares: Vec<f64>,
    /// Whether somebody stopped it or changed the override.
    disturbed: bool,
}

/// All that is wrong with a trace.
pub(crate) fn check(robot: &Robot, plan: &Plan, rows: &[Row], events: &[Event], tally: &mut Tally) -> Vec<String> {
    let mut account = match Account::new(robot, plan, rows) {
        Ok(account) => account,
        Err(fault) => return vec![fault],
    };
    let mut faults = Vec::new();
    if !events.is_empty() {
        account.disturb(events);
        faults.extend(stops(&account, events, tally));
    }
    tally.note_many("programs", 1, 0.0);
    tally.note_many("motions", account.legs.len(), 0.0);
    tally.note_many("rows", rows.len(), 0.0);
    account.limits(&mut faults, tally);
    account.stands(&mut faults);
    account.targets(&mut faults, tally);
    account.paths(&mut faults, tally);
    account.speeds(&mut faults, tally);
    faults
}

impl<'a> Account<'a> {
    /// Finds the rows of the motions, and what the taught positions are.
    pub(crate) fn new(robot: &'a Robot, plan: &'a Plan, rows: &'a [Row]) -> Result<Self, String> {
        let mut ranges = Vec::new();
        let mut from = 0;
        for motion in &plan.motions {
            let Some(start) = rows[from..].iter().position(|row| row.line == motion.line).map(|at| from + at) else {
                return Err(format!("line {}: no row of the trace is of this motion", motion.line));
            };
            if let Some(other) = rows[from..start].iter().find(|row| row.line != 0) {
                return Err(format!("line {}: line {} comes before it", motion.line, other.line));
            }
            let others = rows[start..].iter().position(|row| row.line != motion.line && row.line != 0);
            let beyond = others.map_or(rows.len(), |at| start + at);
            let own = rows[start..beyond].iter().rposition(|row| row.line == motion.line);
            from = start + own.map_or(0, |at| at + 1);
            ranges.push(start..from);
        }
        let taught: Vec<&Row> = ranges.iter().take(plan.taught.len()).map(|range| &rows[range.end - 1]).collect();
        let own = robot.own;
        let leg = |(motion, rows_of): (&'a Motion, &Range<usize>)| {
            let setting = plan.setting(motion);
            let (flange, external) = match &motion.goal {
                Goal::Taught(at) => (taught[*at].tcp, plan.taught[*at][own..].to_vec()),
                Goal::Shifted(shift, external) => {
                    let first = setting.wobj.inverse() * taught[0].tcp * setting.tool;
                    let tcp = setting.wobj * shifted(&first, shift);
                    let external = plan.taught[0][own..].iter().zip(external).map(|(first, shift)| first + shift);
                    (tcp * setting.tool.inverse(), external.collect())
                }
            };
            let axes = match motion.goal {
                Goal::Taught(at) if motion.kind == Kind::Movej => Some(plan.taught[at].clone()),
                _ => motion.rests.then(|| rows[rows_of.end - 1].axes.clone()),
            };
            let (tcp, rests) = (flange * setting.tool, motion.rests);
            Leg { motion, setting, flange, tcp, axes, external, rows: rows_of.clone(), rests }
        };
        let mut legs: Vec<Leg<'a>> = plan.motions.iter().zip(&ranges).map(leg).collect();
        for at in 1..legs.len().saturating_sub(1) {
            if !legs[at].rests && turns_back(&legs[at - 1..=at + 1]) {
                legs[at].rests = true;
                legs[at].axes = Some(rows[ranges[at].end - 1].axes.clone());
            }
        }
        let shares = vec![1.0; rows.len()];
        Ok(Self { robot, rows, legs, shares, disturbed: false })
    }

    /// Where no motion is executed the robot stands.
    fn stands(&self, faults: &mut Vec<String>) {
        for pair in self.rows.windows(2) {
            if pair[1].line == 0 && pair[1].axes != pair[0].axes {
                faults.push(format!("{} s: the robot moves without a motion", pair[1].t));
                return;
            }
        }
    }

    /// Where the robot rests, it is at the target.
    fn targets(&self, faults: &mut Vec<String>, tally: &mut Tally) {
        for leg in self.legs.iter().filter(|leg| leg.rests) {
            let line = leg.motion.line;
            let last = &self.rows[leg.rows.end - 1];
            let (missed, turn) = (distance(&last.tcp, &leg.tcp), turned(&last.tcp, &leg.tcp));
            tally.note("exact targets: mm", missed);
            tally.note("exact targets: deg", turn);
            if missed > EXACT || turn > EXACT {
                faults.push(format!("line {line}: the target is missed by {missed} mm, {turn} deg"));
            }
            let own = leg.axes.iter().flat_map(|axes| axes[..self.robot.own].iter().zip(&last.axes));
            let external = leg.external.iter().zip(&last.axes[self.robot.own..]);
            let off = largest(own.chain(external).map(|(wanted, is)| is - wanted));
            tally.note("exact targets: an axis in deg (mm)", off);
            if off > 4.0 * ROUNDING {
                faults.push(format!("line {line}: an axis misses its target by {off} deg"));
            }
        }
    }
}

impl Leg<'_> {
    /// Whether the TCP is led.
    fn leads_tool(&self) -> bool {
        self.motion.kind.leads_tool()
    }

    /// The target of another motion as the TCP of this one.
    fn own_tcp(&self, of: &Leg<'_>) -> Frame {
        of.flange * self.setting.tool
    }
}

/// Whether a spline turns back at the second of three targets.
fn turns_back(legs: &[Leg<'_>]) -> bool {
    let [before, here, after] = legs else { return false };
    let spline = |leg: &Leg<'_>| leg.motion.kind == Kind::Spl && leg.motion.setting == here.motion.setting;
    let way =
        |from: &Leg<'_>, to: &Leg<'_>| here.own_tcp(to).translation.vector - here.own_tcp(from).translation.vector;
    spline(here) && spline(after) && way(before, here).angle(&way(here, after)).to_degrees() > 150.0
}

fn largest(values: impl Iterator<Item = f64>) -> f64 {
    values.map(f64::abs).fold(0.0, f64::max)
}
