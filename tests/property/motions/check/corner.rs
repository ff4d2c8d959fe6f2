//! The corner between a motion and the next.

use super::{Account, EXACT, Leg, PATH, Tally};
use crate::motions::geometry::{distance, turned};
use crate::motions::plan::{Kind, Slip, Zone};
use crate::motions::robot::Robot;
use crate::motions::trace::Row;

pub(super) struct Corner<'a> {
    leg: &'a Leg,
    robot: &'a Robot,
    /// How far a blend may be from it.
    reach: Reach,
}

enum Reach {
    /// There is no blend.
    None,
    /// mm of the TCP
    Tcp(f64),
    /// deg (mm) of each axis
    Axes(Vec<f64>),
    /// One of these.
    OneOf(Slip),
    /// Only kinematics would tell.
    Unknown,
}

/// How far a row is from a corner, in the measures of a zone.
type Measured = [(&'static str, Option<f64>, f64); 5];

impl<'a> Corner<'a> {
    pub(super) fn new(account: &'a Account<'_>, at: usize) -> Corner<'a> {
        let legs = &account.legs;
        let (leg, next) = (&legs[at], &legs[at + 1]);
        let is_gate = |leg: &Leg| matches!(leg.motion.kind, Kind::Jump(_));
        let reach = match leg.motion.zone {
            _ if leg.rests => Reach::None,
            Zone::None => Reach::None,
            Zone::Distance(size) => Reach::Tcp(size),
            Zone::Measures(slip) => Reach::OneOf(slip),
            Zone::Percent(_) if is_gate(leg) || is_gate(next) => Reach::Unknown,
            Zone::Percent(part) => {
                let half = part / 200.0;
                match (leg.leads_tool(), next.leads_tool()) {
                    (true, true) if leg.setting == next.setting => match account.length(at).zip(account.length(at + 1))
                    {
                        Some((here, there)) => Reach::Tcp(half * f64::max(here, there)),
                        None => Reach::Unknown,
                    },
                    (false, false) => {
                        let ends = [at.checked_sub(1), Some(at), Some(at + 1)];
                        let ends: Option<Vec<&Vec<f64>>> = ends.into_iter().map(|at| legs[at?].axes.as_ref()).collect();
                        let half_distance = |a: &[f64], b: &[f64], i: usize| (a[i] - b[i]).abs() * half;
                        match ends.as_deref() {
                            Some([a, b, c]) => Reach::Axes(
                                (0..b.len())
                                    .map(|i| half_distance(a, b, i).max(half_distance(b, c, i)) + EXACT)
                                    .collect(),
                            ),
                            _ => Reach::Unknown,
                        }
                    }
                    _ => Reach::Unknown,
                }
            }
        };
        Corner { leg, robot: account.robot, reach }
    }

    /// Whether a row of a motion may be off its path for this corner.
    pub(super) fn allows_deviation(&self, row: &Row, of: &Leg) -> bool {
        match &self.reach {
            Reach::None => false,
            Reach::Tcp(size) => distance(&row.tcp, &of.own_tcp(self.leg)) <= size + PATH,
            Reach::Axes(sizes) => self.leg.axes.as_ref().is_none_or(|corner| {
                corner.iter().zip(&row.axes).zip(sizes).all(|((corner, axis), size)| (axis - corner).abs() <= *size)
            }),
            // Of the motion that is joined, what does not move in the measure is entered for as long as the other is
            // left.
            Reach::OneOf(_) if !std::ptr::eq(self.leg, of) => true,
            Reach::OneOf(slip) => {
                let measured = self.measured(slip, row, of);
                measured.iter().any(|(_, is, size)| *size > 0.0 && is.is_none_or(|is| is <= size + PATH))
            }
            Reach::Unknown => true,
        }
    }

    /// What is wrong with a row at which the path is left: the zone is the nearest of what was asked for.
    pub(super) fn exited_too_early(&self, row: &Row, of: &Leg, tally: &mut Tally) -> Option<String> {
        let slip = match &self.reach {
            Reach::Tcp(size) => Slip { pdis: *size, ..Slip::default() },
            Reach::OneOf(slip) => *slip,
            _ => return None,
        };
        let mut fault = None;
        for (what, is, size) in self.measured(&slip, row, of) {
            if let Some(is) = is.filter(|_| size > 0.0) {
                tally.note("zones: distance from the corner / zone", is / size);
                if is > size + PATH {
                    fault = Some(format!("the path is left {is} from the target, {what} is {size}"));
                }
            }
        }
        fault
    }

    fn measured(&self, slip: &Slip, row: &Row, of: &Leg) -> Measured {
        let corner = of.own_tcp(self.leg);
        let own = self.robot.own;
        let external = |linear: bool| {
            let axes = self.robot.axes[own..].iter().zip(&row.axes[own..]).zip(&self.leg.external);
            axes.filter(|((axis, _), _)| axis.linear == linear).map(|((_, is), target)| (is - target).abs()).next()
        };
        // The tool's turning counts on ways of the TCP alone.
        let turning = of.leads_tool() && !of.motion.wrist;
        [
            ("pdis", Some(distance(&row.tcp, &corner)), slip.pdis),
            ("odis", turning.then(|| turned(&row.tcp, &corner)), slip.odis),
            ("ejdis", external(false), slip.ejdis),
            ("eldis", external(true), slip.eldis),
            ("jdis", self.leg.axes_from(row, own), slip.jdis),
        ]
    }

    pub(super) fn tell(&self, row: &Row, of: &Leg) -> String {
        let far = distance(&row.tcp, &of.own_tcp(self.leg));
        let line = self.leg.motion.line;
        match &self.reach {
            Reach::None => format!("line {line} has no zone"),
            Reach::Tcp(size) => format!("{far} mm from the corner of line {line}, whose zone is {size} mm"),
            Reach::Axes(sizes) => {
                format!("axes {:?} about the corner of line {line}, whose zone is {sizes:?}", row.axes)
            }
            Reach::OneOf(slip) => format!("{:?} of the corner of line {line}", self.measured(slip, row, of)),
            Reach::Unknown => String::new(),
        }
    }
}
