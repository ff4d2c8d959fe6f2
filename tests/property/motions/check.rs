//! What must hold of a trace, whatever the program.

use super::grow::{Goal, Kind, Motion, Plan, Zone};
use super::robot::Robot;
use super::trace::Row;
use super::vector::{Circle, Vector, distance, off_line, plus, turned};

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
    /// Of the target.
    tcp: Vector,
    turns: Vector,
    /// Of the target, where they are known: at taught positions, and where the robot rests.
    axes: Option<Vec<f64>>,
    rows: std::ops::Range<usize>,
}

/// All that is wrong with a trace.
pub(crate) fn check(robot: &Robot, plan: &Plan, rows: &[Row]) -> Vec<String> {
    let mut faults = Vec::new();
    let Some(legs) = legs(robot, plan, rows, &mut faults) else { return faults };
    limits(robot, &legs, rows, &mut faults);
    stands(rows, &mut faults);
    targets(&legs, rows, &mut faults);
    for at in 1..legs.len() {
        on_path(&legs, at, rows, &mut faults);
    }
    speeds(&legs, rows, &mut faults);
    faults
}

/// Finds the rows of the motions, and what the taught positions are.
fn legs<'a>(robot: &Robot, plan: &'a Plan, rows: &[Row], faults: &mut Vec<String>) -> Option<Vec<Leg<'a>>> {
    let mut ranges = Vec::new();
    let mut from = 0;
    for motion in &plan.motions {
        let Some(start) = rows[from..].iter().position(|row| row.line == motion.line).map(|at| from + at) else {
            faults.push(format!("line {}: no row of the trace is of this motion", motion.line));
            return None;
        };
        let end = rows[start..].iter().position(|row| row.line != motion.line).map_or(rows.len(), |at| start + at);
        if let Some(other) = rows[from..start].iter().find(|row| row.line != 0) {
            faults.push(format!("line {}: line {} comes before it", motion.line, other.line));
            return None;
        }
        ranges.push(start..end);
        from = end;
    }
    let taught: Vec<&Row> = ranges.iter().take(plan.taught.len()).map(|range| &rows[range.end - 1]).collect();
    let leg = |(motion, rows_of): (&'a Motion, &std::ops::Range<usize>)| {
        let last = &rows[rows_of.end - 1];
        let known = motion.rests.then(|| last.axes.clone());
        let (tcp, turns, axes) = match motion.goal {
            Goal::Taught(at) if motion.kind == Kind::Movej => {
                (taught[at].tcp, taught[at].turns, Some(plan.taught[at][..robot.axes.len()].to_vec()))
            }
            Goal::Taught(at) => (taught[at].tcp, taught[at].turns, known),
            Goal::Shifted([x, y, z, a, b, c]) => {
                (plus(taught[0].tcp, [x, y, z], 1.0), plus(taught[0].turns, [a, b, c], 1.0), known)
            }
        };
        Leg { motion, tcp, turns, axes, rows: rows_of.clone() }
    };
    Some(plan.motions.iter().zip(&ranges).map(leg).collect())
}

/// Every axis keeps its range, and its limits of speed, acceleration and jerk.
fn limits(robot: &Robot, legs: &[Leg<'_>], rows: &[Row], faults: &mut Vec<String>) {
    let scales = scales(legs, rows.len());
    for (index, axis) in robot.axes.iter().enumerate() {
        let name = index + 1;
        let mut series: Vec<f64> = rows.iter().map(|row| row.axes[index]).collect();
        for (value, row) in series.iter().zip(rows) {
            if *value < axis.min - EXACT || *value > axis.max + EXACT {
                faults.push(format!("line {}, {} s: j{name} at {value}", row.line, row.t));
                break;
            }
        }
        // It stands after the trace. (Where it stood before is not in the trace.)
        series.extend([series[series.len() - 1]; 3]);
        let limits = [("speed", axis.vel), ("acceleration", axis.acc), ("jerk", axis.jerk)];
        for (order, (what, most)) in limits.into_iter().enumerate() {
            series = series.windows(2).map(|pair| (pair[1] - pair[0]) / CYCLE).collect();
            let noise = ROUNDING * f64::from(2 << order) / CYCLE.powi(order as i32 + 1);
            let share = |at: usize| {
                let end = (at + order + 1).min(rows.len() - 1);
                let near = &scales[at.min(end)..=end];
                let scale = near.iter().map(|scale| scale[order]).fold(0.0, f64::max);
                ((series[at].abs() - noise) / (most * scale), end)
            };
            let worst = (0..series.len()).map(share).max_by(|a, b| a.0.total_cmp(&b.0));
            if let Some((share, end)) = worst.filter(|(share, _)| *share > SLACK) {
                let row = &rows[end];
                faults.push(format!("line {}, {} s: {share:.4} of the {what} of j{name}", row.line, row.t));
            }
        }
    }
}

/// Which part of the axes' speed, acceleration and jerk holds in each row: the most that the motion, and those that it
/// is blended with, may use.
fn scales(legs: &[Leg<'_>], count: usize) -> Vec<[f64; 3]> {
    let mut scales = vec![[0.0; 3]; count];
    let own = |leg: &Leg<'_>| {
        let axes = matches!(leg.motion.kind, Kind::Movej | Kind::Ptp);
        [if axes { leg.motion.speed / 100.0 } else { 1.0 }, leg.motion.accset[0], leg.motion.accset[1]]
    };
    for (at, leg) in legs.iter().enumerate() {
        let mut scale = own(leg);
        let before = at.checked_sub(1).map(|at| &legs[at]).filter(|leg| !leg.motion.rests);
        let behind = legs.get(at + 1).filter(|_| !leg.motion.rests);
        for other in before.into_iter().chain(behind) {
            scale = std::array::from_fn(|i| scale[i].max(own(other)[i]));
        }
        scales[leg.rows.clone()].fill(scale);
    }
    // Where nothing is executed, nothing moves: what is beside it counts.
    for at in 1..count {
        if scales[at][0] == 0.0 {
            scales[at] = scales[at - 1];
        }
    }
    for at in (1..count).rev() {
        if scales[at - 1][0] == 0.0 {
            scales[at - 1] = scales[at];
        }
    }
    scales
}

/// Where no motion is executed the robot stands.
fn stands(rows: &[Row], faults: &mut Vec<String>) {
    for pair in rows.windows(2) {
        if pair[1].line == 0 && pair[1].axes != pair[0].axes {
            faults.push(format!("{} s: the robot moves without a motion", pair[1].t));
            return;
        }
    }
}

/// Where the robot rests, it is at the target.
fn targets(legs: &[Leg<'_>], rows: &[Row], faults: &mut Vec<String>) {
    for leg in legs.iter().filter(|leg| leg.motion.rests) {
        let last = &rows[leg.rows.end - 1];
        let (missed, turn) = (distance(last.tcp, leg.tcp), turned(last.turns, leg.turns));
        if missed > EXACT || turn > EXACT {
            faults.push(format!("line {}: the target is missed by {missed} mm, {turn} deg", leg.motion.line));
        }
        let Some(axes) = &leg.axes else { continue };
        let off = largest(last.axes.iter().zip(axes).map(|(is, wanted)| is - wanted));
        if off > 2.0 * ROUNDING {
            faults.push(format!("line {}: an axis misses its target by {off} deg", leg.motion.line));
        }
    }
}

fn largest(values: impl Iterator<Item = f64>) -> f64 {
    values.map(f64::abs).fold(0.0, f64::max)
}

/// Every row of a motion is on its path, or no farther from a blended corner than its zone.
fn on_path(legs: &[Leg<'_>], at: usize, rows: &[Row], faults: &mut Vec<String>) {
    let leg = &legs[at];
    let Some(off) = path(legs, at) else { return };
    let tolerance = if leg.motion.kind == Kind::Movej || leg.motion.kind == Kind::Ptp { EXACT } else { PATH };
    let corners: Vec<Corner<'_>> = [Some(at - 1), Some(at)]
        .into_iter()
        .flatten()
        .filter(|at| at + 1 < legs.len())
        .map(|at| Corner::new(legs, at))
        .collect();
    let worst = rows[leg.rows.clone()]
        .iter()
        .filter(|row| off(row) > tolerance && !corners.iter().any(|corner| corner.holds(row)))
        .max_by(|a, b| off(a).total_cmp(&off(b)));
    if let Some(row) = worst {
        let corners: Vec<String> = corners.iter().map(|corner| corner.tell(row)).collect();
        let corners = corners.join("; ");
        faults.push(format!("line {}, {} s: {} off the path; {corners}", leg.motion.line, row.t, off(row)));
    }
}

/// How far a row is off a path.
type Path<'a> = Box<dyn Fn(&Row) -> f64 + 'a>;

/// How far a row is off the path of a motion, in mm or, where the axes are led, in deg; nothing where the path is not
/// known.
fn path<'a>(legs: &'a [Leg<'_>], at: usize) -> Option<Path<'a>> {
    let (before, leg) = (&legs[at - 1], &legs[at]);
    let (from, to) = (before.tcp, leg.tcp);
    let circle = |circle: Circle| -> Option<Path<'a>> {
        // Three points that are nearly on a line say too little about their circle.
        (circle.radius() < 3000.0).then(|| Box::new(move |row: &Row| circle.off(row.tcp)) as Box<_>)
    };
    match leg.motion.kind {
        Kind::Lin => Some(Box::new(move |row| off_line(from, to, row.tcp))),
        Kind::Cir(shift) => circle(Circle::through(from, plus(legs[0].tcp, shift, 1.0), to)),
        Kind::CcirVia => circle(Circle::through(from, to, legs[at + 1].tcp)),
        Kind::Ccir => circle(Circle::through(legs[at - 2].tcp, from, to)),
        Kind::Spl => None,
        Kind::Movej | Kind::Ptp => {
            let (from, to) = (before.axes.as_ref()?, leg.axes.as_ref()?);
            Some(Box::new(move |row| off_joint_line(from, to, &row.axes)))
        }
    }
}

/// How far an axis is off the straight line between two positions of the axes.
fn off_joint_line(from: &[f64], to: &[f64], at: &[f64]) -> f64 {
    let way: Vec<f64> = to.iter().zip(from).map(|(to, from)| to - from).collect();
    let square: f64 = way.iter().map(|way| way * way).sum();
    let done: f64 = at.iter().zip(from).zip(&way).map(|((at, from), way)| (at - from) * way).sum();
    let share = if square > 0.0 { (done / square).clamp(0.0, 1.0) } else { 0.0 };
    largest(at.iter().zip(from).zip(&way).map(|((at, from), way)| at - from - way * share))
}

/// The corner between a motion and the next.
struct Corner<'a> {
    leg: &'a Leg<'a>,
    /// How far a blend may be from it, for the TCP in mm and for each axis.
    reach: Reach,
}

enum Reach {
    /// There is no blend.
    None,
    Tcp(f64),
    Axes(Vec<f64>),
    /// Only kinematics would tell.
    Unknown,
}

impl<'a> Corner<'a> {
    fn new(legs: &'a [Leg<'a>], at: usize) -> Corner<'a> {
        let (leg, next) = (&legs[at], &legs[at + 1]);
        let is_tool = |kind: Kind| !matches!(kind, Kind::Movej | Kind::Ptp);
        let reach = match leg.motion.zone {
            _ if leg.motion.rests => Reach::None,
            Zone::None => Reach::None,
            Zone::Distance(size) => Reach::Tcp(size),
            Zone::Percent(part) => {
                let half = part / 200.0;
                match (is_tool(leg.motion.kind), is_tool(next.motion.kind)) {
                    (true, true) => match length(legs, at).zip(length(legs, at + 1)) {
                        Some((here, there)) => Reach::Tcp(half * f64::max(here, there)),
                        None => Reach::Unknown,
                    },
                    (false, false) => {
                        let ends = [at.checked_sub(1), Some(at), Some(at + 1)];
                        let ends: Option<Vec<&Vec<f64>>> = ends.into_iter().map(|at| legs[at?].axes.as_ref()).collect();
                        let way = |a: &[f64], b: &[f64], i: usize| (a[i] - b[i]).abs() * half;
                        match ends.as_deref() {
                            Some([a, b, c]) => {
                                Reach::Axes((0..b.len()).map(|i| way(a, b, i).max(way(b, c, i)) + EXACT).collect())
                            }
                            _ => Reach::Unknown,
                        }
                    }
                    _ => Reach::Unknown,
                }
            }
        };
        Corner { leg, reach }
    }

    /// Whether a row may be off its path for this corner.
    fn holds(&self, row: &Row) -> bool {
        match &self.reach {
            Reach::None => false,
            Reach::Tcp(size) => distance(row.tcp, self.leg.tcp) <= size + PATH,
            Reach::Axes(sizes) => self.leg.axes.as_ref().is_none_or(|corner| {
                corner.iter().zip(&row.axes).zip(sizes).all(|((corner, axis), size)| (axis - corner).abs() <= *size)
            }),
            Reach::Unknown => true,
        }
    }

    fn tell(&self, row: &Row) -> String {
        let far = distance(row.tcp, self.leg.tcp);
        let line = self.leg.motion.line;
        match &self.reach {
            Reach::None => format!("line {line} has no zone"),
            Reach::Tcp(size) => format!("{far} mm from the corner of line {line}, whose zone is {size} mm"),
            Reach::Axes(sizes) => {
                format!("axes {:?} about the corner of line {line}, whose zone is {sizes:?}", row.axes)
            }
            Reach::Unknown => String::new(),
        }
    }
}

/// The length of a motion of the TCP, where it is known: at least that of a line.
fn length(legs: &[Leg<'_>], at: usize) -> Option<f64> {
    let from = at.checked_sub(1)?;
    (legs[at].motion.kind == Kind::Lin).then(|| distance(legs[from].tcp, legs[at].tcp))
}

/// The TCP is never faster than programmed.
fn speeds(legs: &[Leg<'_>], rows: &[Row], faults: &mut Vec<String>) {
    for (at, leg) in legs.iter().enumerate().skip(1) {
        let neighbours = legs[at - 1..legs.len().min(at + 2)].iter();
        let is_tool = |leg: &Leg<'_>| !matches!(leg.motion.kind, Kind::Movej | Kind::Ptp);
        // Blends with motions of the axes have no speed of the TCP.
        let blended = |other: usize| legs.get(other).is_some_and(|leg| !leg.motion.rests);
        let alone = |other: usize| legs.get(other).is_none_or(&is_tool);
        if !is_tool(leg) || blended(at - 1) && !alone(at - 1) || blended(at) && !alone(at + 1) {
            continue;
        }
        let most = neighbours.map(|leg| leg.motion.speed).fold(0.0, f64::max);
        let most = if blended(at - 1) || blended(at) { most } else { leg.motion.speed };
        let within = &rows[leg.rows.clone()];
        let speed = within.windows(2).map(|pair| distance(pair[0].tcp, pair[1].tcp) / CYCLE).fold(0.0, f64::max);
        if speed > SLACK * most {
            faults.push(format!("line {}: the TCP goes at {speed} mm/s, {most} are programmed", leg.motion.line));
        }
    }
}
