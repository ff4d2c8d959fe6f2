//! What must hold of a trace, whatever the program.

mod apart;
mod corner;
mod excursion;
mod limits;
mod path;
mod speeds;
mod steps;
mod stops;
mod tally;

use apart::{Apart, Excursion, Parts, Section};
pub(crate) use stops::compare;
use stops::stops;
pub(crate) use tally::Tally;

use super::geometry::{Frame, distance, shifted, turned};
use super::plan::{Goal, Kind, Motion, Plan, Setting};
use super::robot::Robot;
use super::scenario::Scenario;
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

/// Before a part of a trace the robot stands: for so many rows.
const PREFIX: usize = 4;

/// A motion with what the trace says about its target.
#[derive(Clone)]
struct Leg {
    motion: Motion,
    setting: Setting,
    /// The flange at the target, in the world.
    flange: Frame,
    /// The TCP there, as the setting sees it.
    tcp: Frame,
    /// Of the target: own axes where they are known, at taught positions and where the robot rests; then external ones.
    axes: Option<Vec<f64>>,
    external: Vec<f64>,
    /// From its first row to the last; rows between, where the robot stands within it, have no line. Empty where it is
    /// not in the trace.
    rows: Range<usize>,
    /// Whether the robot stands at the target.
    rests: bool,
    /// Whether it was not stopped before.
    reached: bool,
}

/// A trace with what its program asked for.
pub(crate) struct Account<'a> {
    robot: &'a Robot,
    /// With the TCP as the setting of the row's motion sees it.
    rows: Vec<Row>,
    legs: Vec<Leg>,
    /// The share of its speed that each row may have.
    shares: Vec<f64>,
    /// How many times the acceleration and the jerk: more where the robot stops fast.
    hard: Vec<f64>,
    /// Whether somebody stopped it or changed the override.
    disturbed: bool,
    /// How far a tool that stands is from where it stands, in mm and deg.
    stray: f64,
}

/// All that is wrong with a trace; with the one of the same program undisturbed beside it.
pub(crate) fn check(
    robot: &Robot,
    plan: &Plan,
    rows: &[Row],
    scenario: &Scenario,
    undisturbed: Option<&[Row]>,
    tally: &mut Tally,
) -> Vec<String> {
    let mut legs: Vec<Leg> = plan.motions.iter().map(|motion| Leg::of(robot, plan, motion)).collect();
    if let Some(until) = scenario.stepped_until() {
        steps::keep_apart(&mut legs, rows, until);
    }
    let parts = match Apart::new(robot, plan, &legs, scenario).take(rows) {
        Ok(parts) => parts,
        Err(fault) => return vec![fault],
    };
    let mut faults = Vec::new();
    tally.note_many("programs", 1, 0.0);
    tally.note_many("motions", legs.len(), 0.0);
    tally.note_many("rows", rows.len(), 0.0);
    let windows = stops::fast_stops(plan, scenario, rows, &parts);
    for (at, section) in parts.sections.iter().enumerate() {
        match Account::of_section(robot, &legs, section) {
            Ok(mut account) => {
                account.note_fast_stops(&windows);
                let excursions: Vec<&Excursion> =
                    parts.excursions.iter().filter(|excursion| excursion.section == at).collect();
                account.check(scenario, &excursions, &mut faults, tally);
                if let Some(undisturbed) = undisturbed.filter(|_| at == 0 && scenario.stepped_until().is_none()) {
                    faults.extend(compare(undisturbed, &section.rows, tally));
                }
                if scenario.stepped_until().is_some() {
                    account.steps(scenario, &mut faults, tally);
                }
            }
            Err(fault) => faults.push(fault),
        }
    }
    for excursion in &parts.excursions {
        tally.note(if excursion.handler.is_some() { "handlers: motions in between" } else { "pauses: jogged" }, 0.0);
        let look = |stopped: usize| {
            let (mut found, mut seen) = (Vec::new(), Tally::default());
            match Account::of_excursion(robot, plan, &legs, scenario, excursion, stopped) {
                Ok(mut account) => {
                    account.note_fast_stops(&windows);
                    account.check(scenario, &[], &mut found, &mut seen);
                }
                Err(fault) => found.push(fault),
            }
            (found, seen)
        };
        // In a blend it may have been either motion that was stopped.
        let first = look(excursion.stopped);
        let other = (!first.0.is_empty() && excursion.blends).then(|| look(excursion.stopped + 1));
        let (found, seen) = other.filter(|(found, _)| found.is_empty()).unwrap_or(first);
        tally.add(&seen);
        faults.extend(found);
    }
    let parted = Parted { parts: &parts, rows, plan, legs: &legs, windows: &windows };
    faults.extend(parted.rest(robot, scenario, tally));
    let last = [undisturbed.unwrap_or(rows), rows].map(|rows| &rows[rows.len() - 1].axes);
    if parts.again.is_none() && largest(last[0].iter().zip(last[1]).map(|(a, b)| a - b)) > EXACT {
        faults.push("it ends elsewhere than undisturbed".into());
    }
    faults
}

/// The places of rows, of a trace that nothing disturbed, each of which is on its line whatever the corners are.
pub(crate) fn places_on_lines(robot: &Robot, plan: &Plan, rows: &[Row]) -> Vec<usize> {
    let legs = plan.motions.iter().map(|motion| Leg::of(robot, plan, motion)).collect::<Vec<_>>();
    let section = Section { rows: rows.to_vec(), from: None, whole: true };
    let account = Account::of_section(robot, &legs, &section).expect("a trace that has been checked");
    account.places_on_lines()
}

/// How long before the end of a trace the robot may brake fast for an alarm, in s.
const ALARMED: f64 = 0.5;

/// What is wrong with a trace that an alarm ended, beside the one of the same program without the alarm: it stops on
/// the way, within the limits. The first rows, so `many`, are on the same way.
pub(crate) fn check_stopped(
    robot: &Robot,
    plan: &Plan,
    (rows, many): (&[Row], usize),
    unstopped: &[Row],
    tally: &mut Tally,
) -> Vec<String> {
    let mut faults = compare(unstopped, &rows[..many], tally);
    // From where it goes otherwise than without the alarm on, it may brake fast.
    let brakes = rows.iter().zip(unstopped).find(|(row, other)| row.axes != other.axes).map(|(row, _)| row.t - CYCLE);
    let brakes = if many < rows.len() { Some(rows[rows.len() - 1].t - ALARMED) } else { brakes };
    let windows = brakes.map(|from| (from, f64::INFINITY));
    let legs = plan.motions.iter().map(|motion| Leg::of(robot, plan, motion)).collect();
    let mut account = Account::over(robot, rows.to_vec(), legs);
    account.note_fast_stops(windows.as_slice());
    account.limits(&mut faults, tally);
    account.stands(&mut faults);
    tally.note("alarms: an axis would leave its range", 0.0);
    faults
}

/// A trace of which a part was not looked at.
struct Parted<'a> {
    parts: &'a Parts,
    rows: &'a [Row],
    plan: &'a Plan,
    legs: &'a [Leg],
    windows: &'a [(f64, f64)],
}

impl Parted<'_> {
    /// What is wrong with what has not been looked at: the program from its beginning, or what is known of nothing but
    /// the limits.
    fn rest(&self, robot: &Robot, scenario: &Scenario, tally: &mut Tally) -> Vec<String> {
        if let Some(again) = self.parts.again {
            tally.note("handlers: the program begins again", 0.0);
            return check(robot, self.plan, &self.rows[again..], scenario, None, tally);
        }
        let mut faults = Vec::new();
        if self.parts.unknown.is_some() {
            tally.note("handlers: stopped on the way back", 0.0);
            let handlers = self.plan.handlers.iter().flat_map(|handler| &handler.motions);
            let legs = self.legs.iter().cloned().chain(handlers.map(|motion| Leg::of(robot, self.plan, motion)));
            let mut account = Account::over(robot, self.rows.to_vec(), legs.collect());
            account.note_fast_stops(self.windows);
            account.limits(&mut faults, tally);
        }
        faults
    }
}

/// A row after which nothing has been executed.
fn standing(row: Row) -> Row {
    Row { line: 0, motion: 0, ..row }
}

impl<'a> Account<'a> {
    /// Finds the rows of a part of the program.
    ///
    /// # Errors
    /// They are not there, or in another order.
    fn of_section(robot: &'a Robot, program: &[Leg], section: &Section) -> Result<Self, String> {
        let mut legs = program.to_vec();
        let begins = section.from.map(|_| standing(section.rows[0].clone()));
        let prefix = begins.iter().cycle().take(if begins.is_some() { PREFIX - 1 } else { 0 }).cloned();
        let mut rows: Vec<Row> = prefix.chain(section.rows.iter().cloned()).collect();
        let mut from = 0;
        if let (Some(at), Some(begins)) = (section.from, begins) {
            rows[PREFIX - 1] = begins.clone();
            (legs[at].rests, legs[at].rows) = (true, 0..PREFIX);
            legs[at].axes.get_or_insert(begins.axes);
            from = PREFIX;
        }
        for leg in legs.iter_mut().skip(section.from.map_or(0, |at| at + 1)) {
            let line = leg.motion.line;
            let start = rows[from..].iter().position(|row| row.line == line).map(|at| from + at);
            if let Some(other) = rows[from..start.unwrap_or(rows.len())].iter().find(|row| row.line != 0) {
                return Err(format!("line {line}: line {} comes before it", other.line));
            }
            let Some(start) = start else {
                if section.whole {
                    return Err(format!("line {line}: no row of the trace is of this motion"));
                }
                break;
            };
            let others = rows[start..].iter().position(|row| row.line != line && row.line != 0);
            let beyond = others.map_or(rows.len(), |at| start + at);
            let own = rows[start..beyond].iter().rposition(|row| row.line == line);
            from = start + own.map_or(0, |at| at + 1);
            leg.rows = start..from;
        }
        let mut account = Self::over(robot, rows, legs);
        account.find_ends(section.whole);
        Ok(account)
    }

    /// A trace of these motions, in whose rows the robot is.
    fn over(robot: &'a Robot, mut rows: Vec<Row>, legs: Vec<Leg>) -> Self {
        let mut stray: f64 = 0.0;
        for leg in legs.iter().filter(|leg| leg.setting.held) {
            let tool = &leg.setting.tool;
            for row in &mut rows[leg.rows.clone()] {
                if row.motion != 0 {
                    stray = stray.max(distance(&row.tcp, tool)).max(turned(&row.tcp, tool));
                }
                row.tcp = leg.setting.tcp(&robot.flange(&row.axes));
            }
        }
        let (shares, hard) = (vec![1.0; rows.len()], vec![1.0; rows.len()]);
        Self { robot, rows, legs, shares, hard, disturbed: false, stray }
    }

    /// Says which targets are reached, and what is known of them then.
    fn find_ends(&mut self, whole: bool) {
        let (rows, legs) = (&self.rows, &mut self.legs);
        if let Some(last) = legs.iter().rposition(|leg| !leg.rows.is_empty()).filter(|_| !whole) {
            legs[last].reached = legs[last].is_near(&rows[legs[last].rows.end - 1]);
        }
        for at in 0..legs.len() {
            let back = at > 0 && at + 1 < legs.len() && !legs[at].rests && turns_back(&legs[at - 1..=at + 1]);
            legs[at].rests |= back;
            let leg = &mut legs[at];
            if leg.rests && leg.reached && !leg.rows.is_empty() {
                let row = &rows[leg.rows.end - 1];
                leg.axes.get_or_insert_with(|| row.axes.clone());
            }
        }
    }

    /// Looks at everything.
    fn check(&mut self, scenario: &Scenario, excursions: &[&Excursion], faults: &mut Vec<String>, tally: &mut Tally) {
        if !scenario.events.is_empty() {
            let shares = scenario.shares();
            self.disturb(&shares);
            if scenario.stepped_until().is_none() {
                faults.extend(stops(self, scenario, tally));
            }
            self.stopmoves(excursions, faults, tally);
        }
        if self.stray > EXACT {
            faults.push(format!("a tool that stands is {} mm, deg elsewhere", self.stray));
        }
        self.limits(faults, tally);
        self.stands(faults);
        self.targets(faults, tally);
        self.paths(faults, tally);
        self.speeds(faults, tally);
        self.manual_speed(faults, tally);
    }

    /// Where no motion is executed the robot stands.
    fn stands(&self, faults: &mut Vec<String>) {
        for pair in self.rows.windows(2) {
            if pair[1].motion == 0 && pair[1].axes != pair[0].axes {
                faults.push(format!("{} s: the robot moves without a motion", pair[1].t));
                return;
            }
        }
    }

    /// Where the robot rests, it is at the target.
    fn targets(&self, faults: &mut Vec<String>, tally: &mut Tally) {
        for leg in self.legs.iter().filter(|leg| leg.rests && leg.reached && !leg.rows.is_empty()) {
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

impl Leg {
    /// A motion of a program.
    fn of(robot: &Robot, plan: &Plan, motion: &Motion) -> Leg {
        let own = robot.own;
        let first = robot.flange(&plan.taught[0]);
        let mut setting = plan.settings[motion.setting];
        if setting.held {
            setting.tool = first * setting.tool;
        }
        let mut axes = None;
        let (flange, external) = match &motion.goal {
            Goal::Taught(at) => {
                let taught = &plan.taught[*at];
                axes = (motion.kind == Kind::Movej).then(|| taught.clone());
                (robot.flange(taught), taught[own..].to_vec())
            }
            Goal::Shifted(shift, external) => {
                let tcp = setting.wobj * shifted(&(setting.wobj.inverse() * setting.tcp(&first)), shift);
                let external = plan.taught[0][own..].iter().zip(external).map(|(first, shift)| first + shift);
                (setting.flange(&tcp), external.collect())
            }
        };
        let (tcp, rests, motion) = (setting.tcp(&flange), motion.rests, motion.clone());
        Leg { motion, setting, flange, tcp, axes, external, rows: 0..0, rests, reached: true }
    }

    /// A motion of the flange that leads nowhere yet.
    fn bare(robot: &Robot, motion: Motion) -> Leg {
        let setting = Setting { tool: Frame::identity(), wobj: Frame::identity(), held: false };
        let (flange, external) = (Frame::identity(), vec![0.0; robot.axes.len() - robot.own]);
        Leg { motion, setting, flange, tcp: flange, axes: None, external, rows: 0..0, rests: true, reached: true }
    }

    /// A motion like another, to where the axes are so.
    fn at(robot: &Robot, axes: &[f64], like: &Leg) -> Leg {
        let flange = robot.flange(axes);
        Leg {
            flange,
            tcp: like.setting.tcp(&flange),
            axes: Some(axes.to_vec()),
            external: axes[robot.own..].to_vec(),
            rests: true,
            ..like.clone()
        }
    }

    /// Whether the robot is at the target, by a row that sees the TCP as this motion does.
    fn is_near(&self, row: &Row) -> bool {
        let own = row.axes.len() - self.external.len();
        let external = largest(self.external.iter().zip(&row.axes[own..]).map(|(target, is)| is - target));
        distance(&row.tcp, &self.tcp).max(turned(&row.tcp, &self.tcp)).max(external) < EXACT
    }

    /// The same by any row.
    fn is_reached(&self, robot: &Robot, row: &Row) -> bool {
        self.is_near(&Row { tcp: self.setting.tcp(&robot.flange(&row.axes)), ..row.clone() })
    }

    /// Whether the TCP is led.
    fn leads_tool(&self) -> bool {
        self.motion.kind.leads_tool()
    }

    /// The target of another motion as the TCP of this one.
    fn own_tcp(&self, of: &Leg) -> Frame {
        self.setting.tcp(&of.flange)
    }
}

/// Whether a spline turns back at the second of three targets.
fn turns_back(legs: &[Leg]) -> bool {
    let [before, here, after] = legs else { return false };
    let spline = |leg: &Leg| leg.motion.kind == Kind::Spl && leg.motion.setting == here.motion.setting;
    let displacement =
        |from: &Leg, to: &Leg| here.own_tcp(to).translation.vector - here.own_tcp(from).translation.vector;
    spline(here) && spline(after) && displacement(before, here).angle(&displacement(here, after)).to_degrees() > 150.0
}

fn largest(values: impl Iterator<Item = f64>) -> f64 {
    values.map(f64::abs).fold(0.0, f64::max)
}
