//! Every row of a motion is on its path, or no farther from a blended corner than its zone.

use super::corner::Corner;
use super::{Account, EXACT, Leg, PATH, Tally, largest};
use crate::motions::geometry::{Circle, distance, share_of_line, turned};
use crate::motions::plan::Kind;
use crate::motions::trace::Row;

/// deg (mm) that the tool's turning and external axes may be off what belongs to the place of the TCP on its line.
const ALONG: f64 = 1e-4;

/// How far a row is off a path.
type Path<'a> = Box<dyn Fn(&Row) -> f64 + 'a>;

/// The corners of a motion: where it is entered, and where it is left for the next one.
struct Corners<'a> {
    entered: Corner<'a>,
    exited: Option<Corner<'a>>,
}

impl<'a> Corners<'a> {
    fn of(account: &'a Account<'_>, at: usize) -> Self {
        let exited = (at + 1 < account.legs.len()).then(|| Corner::new(account, at));
        Self { entered: Corner::new(account, at - 1), exited }
    }

    /// Whether a row of the motion may be off its path for one of them.
    fn allow_deviation(&self, row: &Row, of: &Leg) -> bool {
        self.entered.allows_deviation(row, of)
            || self.exited.as_ref().is_some_and(|corner| corner.allows_deviation(row, of))
    }
}

impl Account<'_> {
    pub(super) fn paths(&self, faults: &mut Vec<String>, tally: &mut Tally) {
        for at in 1..self.legs.len() {
            self.on_path(at, faults, tally);
        }
    }

    /// For each line that is long enough, a row that is on it whatever its corners are: the middle one of these.
    pub(super) fn places_on_lines(&self) -> Vec<usize> {
        let lines = (1..self.legs.len()).filter(|at| self.legs[*at].motion.kind == Kind::Lin);
        let place = |at: usize| {
            let leg = &self.legs[at];
            let corners = Corners::of(self, at);
            let is_on = |row: &Row| row.line == leg.motion.line && !corners.allow_deviation(row, leg);
            let own: Vec<usize> = leg.rows.clone().filter(|at| is_on(&self.rows[*at])).collect();
            own.get(own.len() / 2).copied()
        };
        lines.filter_map(place).collect()
    }

    fn on_path(&self, at: usize, faults: &mut Vec<String>, tally: &mut Tally) {
        let leg = &self.legs[at];
        let line = leg.motion.line;
        if leg.rows.is_empty() {
            return;
        }
        let Some((note, off)) = self.path(at) else { return };
        let tolerance = if leg.leads_tool() { PATH } else { EXACT };
        let corners = Corners::of(self, at);
        let mut beside = None;
        let (mut on, mut worst): (usize, f64) = (0, 0.0);
        let mut fault: Option<(f64, &Row)> = None;
        for row in self.rows[leg.rows.clone()].iter().filter(|row| row.line == line) {
            let far = off(row);
            if far <= tolerance {
                (on, worst) = (on + 1, worst.max(far));
                beside = None;
                continue;
            }
            if !corners.allow_deviation(row, leg) && fault.is_none_or(|(most, _)| far > most) {
                fault = Some((far, row));
            }
            beside = beside.or(Some(row));
        }
        tally.note_many(note, on, worst);
        if let Some((far, row)) = fault {
            let corners = [Some(&corners.entered), corners.exited.as_ref()].into_iter().flatten();
            let corners: Vec<String> = corners.map(|corner| corner.tell(row, leg)).collect();
            faults.push(format!("line {line}, {} s: {far} off the path; {}", row.t, corners.join("; ")));
        }
        // Where the path is left for good, all that the zone asks for must be met.
        if let (Some(row), Some(corner)) = (beside.filter(|_| leg.reached), &corners.exited)
            && let Some(fault) = corner.exited_too_early(row, leg, tally)
        {
            faults.push(format!("line {line}, {} s: {fault}", row.t));
        }
    }

    /// How far a row is off the path of a motion, in mm or, where the axes are led, in deg; nothing where the path is
    /// not known.
    fn path<'a>(&'a self, at: usize) -> Option<(&'static str, Path<'a>)> {
        let legs = &self.legs;
        let (before, leg) = (&legs[at - 1], &legs[at]);
        let (start, end) = (leg.own_tcp(before), leg.tcp);
        let (from, to) = (start.translation.vector, end.translation.vector);
        let circle = |circle: Circle| -> Option<(&'static str, Path<'a>)> {
            // Three points that are nearly on a line say too little about their circle.
            let path = move |row: &Row| circle.off(&row.tcp.translation.vector);
            (circle.radius < 3000.0).then(|| ("path: circles, mm", Box::new(path) as Box<_>))
        };
        match leg.motion.kind {
            Kind::Lin => {
                let path = move |row: &Row| {
                    let share = match ((to - from).norm() > ALONG, turned(&start, &end)) {
                        (true, _) => share_of_line(&from, &to, &row.tcp.translation.vector),
                        // A way on the spot.
                        (false, turn) if turn > ALONG => (turned(&start, &row.tcp) / turn).min(1.0),
                        _ => {
                            let travels = before.external.iter().zip(&leg.external).map(|(from, to)| to - from);
                            let done =
                                row.axes[self.robot.own..].iter().zip(&before.external).map(|(is, from)| is - from);
                            let all = travels.zip(done).max_by(|a, b| a.0.abs().total_cmp(&b.0.abs()));
                            all.map_or(
                                0.0,
                                |(travel, done)| if travel == 0.0 { 0.0 } else { (done / travel).clamp(0.0, 1.0) },
                            )
                        }
                    };
                    let mut place = start.lerp_slerp(&end, share);
                    if leg.motion.wrist {
                        place.rotation = row.tcp.rotation;
                    }
                    let external = before.external.iter().zip(&leg.external).zip(&row.axes[self.robot.own..]);
                    let external = external.map(|((from, to), is)| is - from - (to - from) * share);
                    let along = largest(external).max(turned(&row.tcp, &place));
                    distance(&row.tcp, &place).max(along * (PATH / ALONG))
                };
                Some(("path: lines, mm", Box::new(path)))
            }
            Kind::Cir(_) => circle(self.circle(at)?),
            Kind::CcirVia | Kind::Ccir => circle(self.circle(at)?),
            Kind::Spl => None,
            Kind::Jump([rise, sink]) => {
                let path = move |row: &Row| {
                    let here = row.tcp.translation.vector;
                    let beside = |column: &nalgebra::Vector3<f64>, height: f64| {
                        if here.z >= column.z + height { 0.0 } else { (here - column).xy().norm() }
                    };
                    let low = (from.z.min(to.z) - here.z).max(0.0);
                    low.max(beside(&from, rise).min(beside(&to, sink)))
                };
                Some(("path: gates, mm", Box::new(path)))
            }
            Kind::Movej | Kind::Ptp => {
                let (from, to) = (before.axes.as_ref()?, leg.axes.as_ref()?);
                Some(("path: axes, deg (mm)", Box::new(move |row| off_joint_line(from, to, &row.axes))))
            }
        }
    }

    /// The circle of a motion.
    fn circle(&self, at: usize) -> Option<Circle> {
        let legs = &self.legs;
        let leg = &legs[at];
        let place = |at: usize| legs.get(at).map(|other| leg.own_tcp(other).translation.vector);
        match leg.motion.kind {
            Kind::Cir([x, y, z]) => {
                let first = leg.setting.wobj.inverse() * leg.own_tcp(&legs[0]);
                let via = leg.setting.wobj
                    * nalgebra::Point3::from(first.translation.vector + nalgebra::Vector3::new(x, y, z));
                Some(Circle::through(place(at - 1)?, via.coords, place(at)?))
            }
            Kind::CcirVia => Some(Circle::through(place(at - 1)?, place(at)?, place(at + 1)?)),
            Kind::Ccir => Some(Circle::through(place(at - 2)?, place(at - 1)?, place(at)?)),
            _ => None,
        }
    }

    /// The length of the TCP's way in a motion, where it is known.
    pub(super) fn length(&self, at: usize) -> Option<f64> {
        let leg = &self.legs[at];
        let from = leg.own_tcp(&self.legs[at.checked_sub(1)?]).translation.vector;
        let to = leg.tcp.translation.vector;
        match leg.motion.kind {
            Kind::Lin => Some((to - from).norm()),
            // A ccir is a part of its circle.
            Kind::Cir(_) | Kind::CcirVia => self.circle(at).map(|circle| circle.length(&to)),
            Kind::Ccir => self.circle(at).map(|circle| circle.length(&to) - circle.length(&from)),
            _ => None,
        }
    }
}

/// How far an axis is off the straight line between two positions of the axes.
fn off_joint_line(from: &[f64], to: &[f64], at: &[f64]) -> f64 {
    let delta: Vec<f64> = to.iter().zip(from).map(|(to, from)| to - from).collect();
    let square: f64 = delta.iter().map(|delta| delta * delta).sum();
    let done: f64 = at.iter().zip(from).zip(&delta).map(|((at, from), delta)| (at - from) * delta).sum();
    let share = if square > 0.0 { (done / square).clamp(0.0, 1.0) } else { 0.0 };
    largest(at.iter().zip(from).zip(&delta).map(|((at, from), delta)| at - from - delta * share))
}

impl Leg {
    /// How far this motion's axes are from the target of another, in deg (mm).
    pub(super) fn axes_from(&self, row: &Row, own: usize) -> Option<f64> {
        let axes = self.axes.as_ref()?;
        Some(largest(axes[..own].iter().zip(&row.axes).map(|(target, is)| is - target)))
    }
}
