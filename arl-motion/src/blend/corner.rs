//! Blends: a curve that leaves one motion before its target and joins the next one behind its start.
//!
//! The curve meets both motions in position, direction and curvature, and depends on the geometry of the zone alone,
//! not on speeds. It is a polynomial of the fifth degree: of the TCP's position and orientation where both motions lead
//! the same TCP, else of the axes. It is timed only afterwards.

use nalgebra::{SVector, Vector3};

use crate::blend::blend_limits::{Approach, BlendLimits, find_blend_limits};
use crate::blend::mid_curvature::MidCurvature;
use crate::blend::no_blend::NoBlend;
use crate::blend::smoothing::is_smooth;
use crate::blend::zone::{asked_parts, parts};
use crate::command::LARGEST_ZONE;
use crate::command::joints::{ALL, Joints, slowness};
use crate::geometry::derivatives::{CurvePoint, by_differences};
use crate::geometry::paced_quintic::PacedQuintic;
use crate::geometry::parametrization::Parametrization;
use crate::geometry::quintic::{Knot, Quintic};
use crate::geometry::rotation;
use crate::geometry::tcp_path::TcpPath;
use crate::geometry::track::Track;
use crate::limits::constant::passing;
use crate::limits::profile::Limits;
use crate::plan::constraints::{Constraints, PathLimits};
use crate::plan::curve::{Curve, ToolCurve};
use crate::plan::motion::{CornerEnd, GivenCorner, Motion};
use crate::plan::path_check::{check_gentle_path, check_path};
use arl_robot::kinematics::Rates;
use arl_robot::robot::{Axis, ROBOT_AXES, Robot};

/// Length of the tangents at the ends of a blend, in lengths of the zone. With 2, the blend of two straight lines that
/// are left and joined at the same distance accelerates along the bisector alone.
const TANGENT_PER_ZONE: f64 = 2.0;
/// How often a zone is halved before it is given up where its blend would leave an axis's range or the reach.
const ZONE_HALVINGS: u32 = 4;
/// Number of parts of a blend between which it is checked; and the number for a gentle blend.
const PARTS_OF_BLEND: u32 = 48;
const PARTS_OF_GENTLE_BLEND: u32 = 4;
/// A blend that takes less than this share of the time of a stop with constant limits also saves time with a law, where
/// these limits say enough about the motions.
const SURELY_FASTER_SHARE: f64 = 0.95;
/// Number of smaller zones that are tried where one is slower than a stop. Few of them save time: the gain of a zone
/// falls faster with its size than its loss does.
const MOST_SLOWER_ZONES: u32 = 2;
/// The cosine of the smallest angle at which two directions count as different.
const STRAIGHT_BACK: f64 = 1.0 - 1e-9;
/// A blend is gentle where nothing changes its speed or direction by a larger share than this.
const GENTLE_CHANGE: f64 = 0.1;

/// The curve between two motions.
#[derive(Clone, PartialEq, Debug)]
pub(crate) struct Blend {
    /// The share of the first motion after which it is left.
    pub(crate) leave: f64,
    /// The share of the second motion at which it is joined.
    pub(crate) join: f64,
    pub(crate) curve: Curve,
    /// The curve's parameter over its nominal time, both from 0 to 1.
    pub(crate) parametrization: Parametrization,
    /// The nominal time in s.
    pub(crate) time: f64,
    pub(crate) blend_limits: BlendLimits,
    /// Whether it may take longer than a stop between the motions, according to constant limits.
    pub(crate) may_lose_time: bool,
    /// Whether it takes all that was requested, or halves of both motions in a dense chain, and was not reduced for
    /// lack of a path or of time.
    pub(crate) is_whole: bool,
    /// Reason why it takes less than was requested, where it does.
    pub(crate) less: Option<NoBlend>,
}

/// Finds the blend that the first motion's zone requests, or one with a smaller zone where there is no path or the
/// blend `is_slower` than a stop. Otherwise returns the reason for the smallest zone that was tried.
pub(crate) fn blend(
    robot: &Robot,
    from: &Motion,
    to: &Motion,
    is_slower: impl Fn(&Blend) -> bool,
) -> Result<Blend, NoBlend> {
    let (asked, joining) = asked_parts(robot, from, to).ok_or(NoBlend::NothingToRound)?;
    let smooth = is_smooth(from, to).then_some((LARGEST_ZONE, LARGEST_ZONE));
    let smaller = (0..=ZONE_HALVINGS).map(|halvings| f64::from(1 << halvings)).map(|by| (asked / by, joining / by));
    let (mut why, mut slower) = (NoBlend::NothingToRound, 0);
    for (tried, (leaving, joining)) in smooth.into_iter().chain(smaller).enumerate() {
        match (Corner { robot, from, to, leaving, joining, curvatures: [MidCurvature::NONE; 2] }.blend()) {
            Ok(blend) if is_slower(&blend) => {
                (why, slower) = (NoBlend::Slower, slower + 1);
                if slower > MOST_SLOWER_ZONES {
                    break;
                }
            }
            Ok(blend) => {
                return Ok(Blend { is_whole: tried == 0, less: (leaving < asked).then_some(why), ..blend });
            }
            Err(other) => why = other,
        }
    }
    // Where the robot's axes stand still for a moment, the reason found may be misleading.
    Err(if why == NoBlend::Slower {
        why
    } else if turns_back(from, to) {
        NoBlend::Reversal
    } else if moves_external_axes_alone(from) != moves_external_axes_alone(to) {
        NoBlend::ExternalAlone
    } else {
        why
    })
}

/// Whether a motion moves neither the TCP nor the tool.
fn moves_external_axes_alone(motion: &Motion) -> bool {
    matches!(motion.curve, Curve::Tool(_)) && !motion.moves_tool()
}

/// Whether one motion leaves its start in the direction that the other one came from.
fn turns_back(from: &Motion, to: &Motion) -> bool {
    let [coming, going] = match (&from.curve, &to.curve) {
        (Curve::Tool(from), Curve::Tool(to)) => [(from, 1.0), (to, 0.0)].map(|(curve, at)| {
            let corner = curve.rotation(at);
            let [[_, moving, _], [_, turning, _]] = curve.place(at, &corner);
            let external = curve.external.derivative(1, at);
            moving.iter().chain(&turning).chain(&external).copied().collect::<Vec<f64>>()
        }),
        (Curve::Axes(from), Curve::Axes(to)) => {
            [(from, 1.0), (to, 0.0)].map(|(curve, at)| curve.derivative(1, at).to_vec())
        }
        _ => return false,
    };
    let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    product(&coming, &going) < -STRAIGHT_BACK * (product(&coming, &coming) * product(&going, &going)).sqrt()
}

/// The blend from one motion to another with the given curvatures in the middle of the motions. Curvature is only
/// possible where a whole half is taken.
pub(crate) fn curved_blend(robot: &Robot, from: &Motion, to: &Motion, curvatures: [MidCurvature; 2]) -> Option<Blend> {
    let (leaving, joining) = parts(robot, from, to)?;
    let [start, end] = &curvatures;
    if (*start != MidCurvature::NONE && leaving != LARGEST_ZONE)
        || (*end != MidCurvature::NONE && joining != LARGEST_ZONE)
    {
        return None;
    }
    Corner { robot, from, to, leaving, joining, curvatures }.blend().ok()
}

#[cfg(test)]
thread_local! {
    /// Number of blends that this thread has sought.
    pub(crate) static FOUND_HERE: std::cell::Cell<u32> = const { std::cell::Cell::new(0) };
}

/// Two motions and the shares of them that a blend takes.
struct Corner<'a> {
    robot: &'a Robot,
    from: &'a Motion,
    to: &'a Motion,
    leaving: f64,
    joining: f64,
    /// The curvatures of the motions at the ends of the blend.
    curvatures: [MidCurvature; 2],
}

impl Corner<'_> {
    /// The parameters at which the motions are left and joined, and the lengths of the tangents there.
    fn ends(&self) -> [(f64, f64); 2] {
        let [leaving, joining] = self.met();
        [(1.0 - self.leaving, leaving.speed), (self.joining, joining.speed)]
    }

    /// How the motions are met: as given, scaled to the shares that are taken, or at a speed at which blends of lines
    /// accelerate only across the path.
    fn met(&self) -> [CornerEnd; 2] {
        match self.from.corner {
            Some(GivenCorner { leaving, joining }) => [leaving.taking(self.leaving), joining.taking(self.joining)],
            None => {
                [self.leaving, self.joining].map(|part| CornerEnd { part, speed: TANGENT_PER_ZONE * part, acc: 0.0 })
            }
        }
    }

    fn blend(&self) -> Result<Blend, NoBlend> {
        #[cfg(test)]
        FOUND_HERE.with(|count| count.set(count.get() + 1));
        let Self { from, to, .. } = self;
        let (vel_from, vel_to) = (from.rate, to.rate);
        let [(leave, slope_from), (join, slope_to)] = self.ends();
        // Both ends are met at the speeds that the motions have there.
        let (start_rate, end_rate) = (vel_from / slope_from, vel_to / slope_to);
        let time = 2.0 / (start_rate + end_rate);
        let even = || (Parametrization::between([[start_rate * time, 0.0], [end_rate * time, 0.0]]), time);

        let mut constraints = Constraints::new(self.robot);
        let pace = common_pace(from, to);
        let (curve, parametrization, time) = match (&from.curve, &to.curve) {
            (Curve::Tool(a), Curve::Tool(b)) if a.goes_on(leave, b, join) => {
                let curve = self.tool_curve(a, b);
                let (start, end) = (along(&a.path.track, leave, vel_from), along(&b.path.track, join, vel_to));
                let is_gentle_blend = is_gentle(&curve) && !self.swings();
                let timed = if is_gentle_blend {
                    Parametrization::gently(|order, at| curve.path.track.derivative(order, at), start, end)
                } else if self.swings() {
                    // A motion with an overlay is not even: an even parameter meets it best.
                    None
                } else {
                    Parametrization::along(|order, at| curve.path.track.derivative(order, at), start, end)
                };
                let (parametrization, time) = timed.unwrap_or_else(even);
                if !(is_gentle_blend && self.glance_at_tool(&curve, &parametrization, &mut constraints, &pace)) {
                    constraints.clear();
                    self.walk_tool(&curve, &parametrization, &mut constraints, &pace)?;
                }
                (Curve::Tool(curve), parametrization, time)
            }
            _ => {
                let [start, end] = &self.curvatures;
                let [exited, joined] = self.met();
                let met = |motion, at, slope, bend, met| {
                    let knot = axes_knot(self.robot, motion, at, slope, bend);
                    knot.map(|knot| rising(knot, met)).ok_or(NoBlend::Singular { axis: None })
                };
                let from = met(from, leave, slope_from, start, &exited)?;
                let to = met(to, join, slope_to, end, &joined)?;
                let curve = Quintic::between(&from, &to);
                let gentle = self.from.corner.is_none() && turns_gently(&curve);
                let (parametrization, time) = self.time_axes(&curve, gentle, [start_rate, end_rate]);
                self.look_at_axes(&curve, gentle, &parametrization, &mut constraints, &pace)?;
                (Curve::Axes(curve), parametrization, time)
            }
        };
        // A curve that stands still for a moment has no speed.
        let (blend_limits, may_lose_time) = self.blend_limits(&constraints, time).ok_or(NoBlend::Reversal)?;
        Ok(Blend { leave, join, curve, parametrization, time, blend_limits, may_lose_time, is_whole: true, less: None })
    }

    /// The limits within which the blend may be crossed, constant where it is gentle, and whether it may take longer
    /// than a stop.
    fn blend_limits(&self, constraints: &Constraints, time: f64) -> Option<(BlendLimits, bool)> {
        let places = constraints.by_place();
        if places.is_empty() {
            return Some((BlendLimits::even(passing(&constraints.rows, 1.0 / time)), false));
        }
        let approach = |motion: &Motion, taken: f64| {
            // From the motion's own parameter to the share of the blend, at the same speed.
            let scale = 1.0 / (motion.rate * time);
            let Limits { vel, acc, jerk } = motion.limits?;
            let limits = Limits { vel: vel * scale, acc: acc * scale, jerk: jerk * scale };
            Some(Approach { limits, length: (1.0 - 2.0 * taken).max(0.0) * scale })
        };
        let approaches = [approach(self.from, self.leaving)?, approach(self.to, self.joining)?];
        let (limits, with_blend) = find_blend_limits(&places, 1.0 / time, &approaches)?;
        let [before, behind] = &approaches;
        let more = |motion: &Motion, taken: f64| taken / (motion.rate * time);
        let with_stop = before.with_stop(more(self.from, self.leaving)) + behind.with_stop(more(self.to, self.joining));
        Some((limits, with_blend > SURELY_FASTER_SHARE * with_stop))
    }

    /// Whether a motion has an overlay.
    fn swings(&self) -> bool {
        self.from.laid.is_some() || self.to.laid.is_some()
    }

    fn tool_curve(&self, from: &ToolCurve, to: &ToolCurve) -> ToolCurve {
        let [(leave, slope_from), (join, slope_to)] = self.ends();
        let corner = from.rotation(1.0);
        let [start, end] = &self.curvatures;
        let ([moved_from, turned_from], [moved_to, turned_to]) = (from.place(leave, &corner), to.place(join, &corner));
        let knot = |[value, first, second]: [Vector3<f64>; 3], slope: f64, curvature: Vector3<f64>| Knot {
            value: value.into(),
            first: (first * slope).into(),
            second: ((second + curvature) * slope * slope).into(),
        };
        let turning = |turned: [Vector3<f64>; 3], slope: f64, curvature: &MidCurvature| {
            let [value, ..] = turned;
            let [_, second] = rotation::of_speeds(&value, &[Vector3::zeros(), curvature.turning]);
            knot(turned, slope, second)
        };
        let external = |curve: &ToolCurve, at: f64, slope: f64, curvature: &MidCurvature| {
            scaled(curve.external.knot(at), slope, &curvature.external())
        };
        ToolCurve {
            path: TcpPath {
                track: Track::Poly(
                    Quintic::between(
                        &knot(moved_from, slope_from, start.position),
                        &knot(moved_to, slope_to, end.position),
                    )
                    .into(),
                ),
                base: corner,
                turning: Quintic::between(&turning(turned_from, slope_from, start), &turning(turned_to, slope_to, end))
                    .into(),
            },
            carried: from.carried,
            external: Quintic::between(&external(from, leave, slope_from, start), &external(to, join, slope_to, end))
                .into(),
            cfg: to.cfg,
            passages: Vec::new(),
            close_places: Vec::new(),
            over: None,
        }
    }

    /// Collects the limits of a gentle path of the TCP; returns whether a few places are enough to know them.
    fn glance_at_tool(
        &self,
        curve: &ToolCurve,
        parametrization: &Parametrization,
        constraints: &mut Constraints,
        pace: &PathLimits,
    ) -> bool {
        let [(leave, _), _] = self.ends();
        let places =
            shares::<{ PARTS_OF_GENTLE_BLEND as usize + 1 }>().map(|share| CurvePoint::at(parametrization, share));
        let Some(start) = joints_at(self.robot, self.from, leave) else { return false };
        let Some(found) = check_gentle_path(self.robot, curve, &start.axes, &places.map(|place| place.at)) else {
            return false;
        };
        if !self.arrives(&found.end) {
            return false;
        }
        for (place, (_, rates)) in places.iter().zip(&found.rates) {
            let known = constraints.rows.len();
            let [first, second, third] = place.rates([rates.first, rates.second, rates.third]);
            constraints.axes(&first, &second, &third, pace);
            collect(place, curve, self.swings(), constraints, pace);
            constraints.join(known);
        }
        true
    }

    /// Collects the limits of any path of the TCP, if it can be executed.
    fn walk_tool(
        &self,
        curve: &ToolCurve,
        parametrization: &Parametrization,
        constraints: &mut Constraints,
        pace: &PathLimits,
    ) -> Result<(), NoBlend> {
        let [(leave, _), _] = self.ends();
        let start = joints_at(self.robot, self.from, leave).ok_or(NoBlend::Unreachable)?;
        let found = check_path(self.robot, curve, &start).map_err(NoBlend::from_plan_error)?;
        if !self.arrives(&found.end) {
            return Err(NoBlend::Configuration);
        }
        for (at, rates) in &found.rates {
            let share = inverse(parametrization, *at);
            let place = CurvePoint::at(parametrization, share);
            constraints.place(share);
            let [first, second, third] = place.rates([rates.first, rates.second, rates.third]);
            constraints.axes(&first, &second, &third, pace);
            constraints.external(&place.rates([1, 2, 3].map(|order| curve.external.derivative(order, place.at))), pace);
        }
        for part in 0..=PARTS_OF_BLEND {
            let share = f64::from(part) / f64::from(PARTS_OF_BLEND);
            let place = CurvePoint::at(parametrization, share);
            constraints.place(share);
            collect(&place, curve, self.swings(), constraints, pace);
        }
        Ok(())
    }

    /// Whether these are the axes where the second motion is joined.
    fn arrives(&self, end: &[f64; ROBOT_AXES]) -> bool {
        let [_, (join, _)] = self.ends();
        let there = joints_at(self.robot, self.to, join);
        there.is_some_and(|there| end.iter().zip(&there.axes).all(|(a, b)| (a - b).abs() <= 0.01))
    }

    /// Times a path of the axes from one rate of its parameter to another. Where the path is gentle, the combined speed
    /// of the axes changes smoothly: each axis counts by its speed relative to its highest speed.
    fn time_axes(&self, curve: &Quintic<ALL>, gentle: bool, rates: [f64; 2]) -> (Parametrization, f64) {
        let slowness = slowness(self.robot);
        let derivative = |order: usize, at: f64| SVector::from(curve.derivative(order, at)).component_mul(&slowness);
        let [start, end] = &self.curvatures;
        let ends = [(0.0, rates[0], start.surge), (1.0, rates[1], end.surge)];
        let [start, end] = ends.map(|(at, rate, surge)| {
            let [speed, acc] = speed_and_acc(&derivative(1, at), &derivative(2, at), rate);
            [speed, acc + surge]
        });
        let timed = if gentle { Parametrization::gently(derivative, start, end) } else { None };
        timed.unwrap_or_else(|| {
            // Where the curve is met with an acceleration, its parameter compensates for that: the motions are even.
            let [exited, joined] = self.met().map(|met| -met.acc / met.speed);
            let within = |time: f64| {
                let end = |(at, rate, surge): (f64, f64, f64), made_up: f64| {
                    let second = if surge == 0.0 { 0.0 } else { surge / derivative(1, at).norm() };
                    [rate * time, (second + made_up * rate * rate) * time * time]
                };
                let [first, last] = ends;
                (Parametrization::between([end(first, exited), end(last, joined)]), time)
            };
            let mean = within(2.0 / (rates[0] + rates[1]));
            // In less time, the parameter always increases.
            if rises(&mean.0) { mean } else { within(1.0 / rates[0].max(rates[1])) }
        })
    }

    /// Collects the limits of a path of the axes, if no axis leaves its range.
    fn look_at_axes(
        &self,
        curve: &Quintic<ALL>,
        gentle: bool,
        parametrization: &Parametrization,
        constraints: &mut Constraints,
        pace: &PathLimits,
    ) -> Result<(), NoBlend> {
        let parts = if gentle { PARTS_OF_GENTLE_BLEND } else { PARTS_OF_BLEND };
        let (kinematics, carried) = (&self.robot.kinematics, &self.to.rig.carried);
        let tcp = |share: f64| {
            let axes = Joints::of(&curve.at(parametrization.at(share))).axes;
            carried.path_frame_at(&kinematics.forward(&axes)).translation.vector
        };
        for part in 0..=parts {
            let share = f64::from(part) / f64::from(parts);
            let place = CurvePoint::at(parametrization, share);
            if !gentle {
                constraints.place(share);
            }
            let joints = Joints::of(&curve.at(place.at));
            if let Some(axis) = out_of_range(self.robot, &joints) {
                return Err(NoBlend::AxisLimit { axis: axis.name.clone() });
            }
            let known = constraints.rows.len();
            let derivatives = place.rates([1, 2, 3].map(|order| curve.derivative(order, place.at)));
            constraints.all_axes(&derivatives, pace);
            let [first, ..] = &derivatives;
            if pace.manual {
                constraints.manual_place(&joints, first, &self.to.rig.carried);
                // Half of the path belongs to what the first motion carries.
                if self.from.rig.carried != self.to.rig.carried {
                    constraints.manual_place(&joints, first, &self.from.rig.carried);
                }
            }
            // Between two motions of the same TCP, the limits of the TCP hold, although the axes are led.
            if pace.tcp.is_finite() && self.from.rig.carried == self.to.rig.carried {
                constraints.cap_place(&joints, first, &self.to.rig.carried, pace.tcp);
                constraints.moving(&by_differences(tcp, share, 1.0), pace);
            }
            if gentle {
                constraints.join(known);
            }
        }
        Ok(())
    }
}

/// Whether a curve's parameter increases everywhere.
fn rises(parametrization: &Parametrization) -> bool {
    shares::<{ PARTS_OF_BLEND as usize + 1 }>().iter().all(|share| parametrization.derivative(1, *share) > 0.0)
}

/// Shares of the whole, from 0 to 1.
fn shares<const N: usize>() -> [f64; N] {
    std::array::from_fn(|index| index as f64 / (N - 1) as f64)
}

/// Whether speeds and directions hardly change along the curve.
fn is_gentle(curve: &ToolCurve) -> bool {
    let Track::Poly(track) = &curve.path.track else { return false };
    // A turn by so little counts as little, however it changes.
    const TURN: f64 = 0.01;
    is_gentle_polynomial(track, 0.0)
        && is_gentle_polynomial(&curve.path.turning, TURN)
        && is_gentle_polynomial(&curve.external, 0.0)
}

/// Whether speeds and directions hardly change along a path of the axes.
fn turns_gently(curve: &Quintic<ALL>) -> bool {
    changes_little([1, 2].map(|order| [0.0, 1.0].map(|at| curve.derivative(order, at))), 0.0)
}

/// Whether speeds and directions hardly change along one path; changes up to `little` count as little.
fn is_gentle_polynomial<const N: usize>(polynomial: &PacedQuintic<N>, little: f64) -> bool {
    changes_little([1, 2].map(|order| [0.0, 1.0].map(|at| polynomial.derivative(order, at))), little)
}

/// Whether the first derivatives at the two ends hardly differ, and the second ones are small compared with them or
/// with `little`.
fn changes_little<const N: usize>([[start, end], seconds]: [[[f64; N]; 2]; 2], little: f64) -> bool {
    let size = |values: [f64; N]| values.iter().map(|value| value * value).sum::<f64>().sqrt();
    let mut change = end;
    for (change, start) in change.iter_mut().zip(start) {
        *change -= start;
    }
    let most = (size(start).min(size(end)) * GENTLE_CHANGE).max(little);
    size(change) <= most && seconds.into_iter().all(|second| size(second) <= most)
}

/// The speed and the acceleration along a track in mm/s and mm/s2, at a rate of its parameter.
fn along(track: &Track, at: f64, rate: f64) -> [f64; 2] {
    speed_and_acc(&track.derivative(1, at), &track.derivative(2, at), rate)
}

/// The speed and the acceleration along a path, from its derivatives by a parameter that changes at a rate.
fn speed_and_acc<const N: usize>(first: &SVector<f64, N>, second: &SVector<f64, N>, rate: f64) -> [f64; 2] {
    let length = first.norm();
    [length * rate, if length > 0.0 { first.dot(second) / length * rate * rate } else { 0.0 }]
}

/// The faster of the two motions' speeds, the gentler of their accelerations.
pub(crate) fn common_pace(from: &Motion, to: &Motion) -> PathLimits {
    let faster = |of: fn(&PathLimits) -> f64| of(&from.pace).max(of(&to.pace));
    let reached = |of: fn(&Motion) -> f64| {
        let speed = |motion: &Motion| match motion.curve {
            // With an overlay the TCP is faster than along the path alone.
            Curve::Tool(_) if motion.laid.is_some() => motion.fastest(),
            Curve::Tool(_) => of(motion) * motion.rate,
            Curve::Axes(_) => f64::INFINITY,
        };
        speed(from).max(speed(to))
    };
    PathLimits {
        axes: faster(|pace| pace.axes),
        tcp: reached(|motion| motion.length),
        ori: reached(|motion| motion.angle).max(1.0),
        turning: faster(|pace| pace.turning),
        linear: faster(|pace| pace.linear),
        acc: from.pace.acc.min(to.pace.acc),
        jerk: from.pace.jerk.min(to.pace.jerk),
        manual: from.pace.manual || to.pace.manual,
    }
}

/// A knot with added curvature, by a parameter that is scaled by `slope`.
fn scaled<const N: usize>(mut knot: Knot<N>, slope: f64, curvature: &[f64; N]) -> Knot<N> {
    for value in &mut knot.first {
        *value *= slope;
    }
    for (value, curvature) in knot.second.iter_mut().zip(curvature) {
        *value = (*value + curvature) * slope * slope;
    }
    knot
}

/// The axes within a motion with their derivatives.
fn axes_knot(robot: &Robot, motion: &Motion, at: f64, slope: f64, curvature: &MidCurvature) -> Option<Knot<ALL>> {
    let knot = match &motion.curve {
        Curve::Axes(axes) => axes.knot(at),
        Curve::Tool(tool) => {
            let joints = joints_at(robot, motion, at)?;
            let Rates { first, second, .. } = tool.rates(&robot.kinematics, at, &joints.axes)?;
            let external = tool.external.knot(at);
            let all = |axes: [f64; ROBOT_AXES], external| Joints { axes, external }.all();
            Knot { value: joints.all(), first: all(first, external.first), second: all(second, external.second) }
        }
    };
    Some(scaled(knot, slope, &curvature.axes))
}

/// A knot that is met with an acceleration along its motion.
fn rising<const N: usize>(mut knot: Knot<N>, met: &CornerEnd) -> Knot<N> {
    for (second, first) in knot.second.iter_mut().zip(&knot.first) {
        *second += first * met.acc / met.speed;
    }
    knot
}

/// The joints within a motion, followed from its nearer end.
fn joints_at(robot: &Robot, motion: &Motion, at: f64) -> Option<Joints> {
    /// Largest distance in deg (mm) that an axis moves in a step.
    const STEP: f64 = 5.0;
    const MOST: f64 = 63.0;
    let Curve::Tool(tool) = &motion.curve else { return Some(motion.curve.joints(&robot.kinematics, at, &motion.end)) };
    let (from, near) = if at > 0.5 { (1.0, &motion.end) } else { (0.0, &motion.start) };
    let mut axes = near.axes;
    let distances = motion.end.axes.iter().zip(&motion.start.axes).map(|(end, start)| (end - start).abs());
    let steps =
        1 + if tool.passages.is_empty() { (distances.fold(0.0, f64::max) / STEP).min(MOST) } else { MOST } as u32;
    for step in 1..=steps {
        axes = tool.axes(&robot.kinematics, from + (at - from) * f64::from(step) / f64::from(steps), &axes)?;
    }
    Some(Joints { axes, external: tool.external.at(at) })
}

/// The first axis that is not within its range.
fn out_of_range<'a>(robot: &'a Robot, joints: &Joints) -> Option<&'a Axis> {
    let own = robot.own_axes().len();
    let values = joints.axes.iter().take(own).chain(&joints.external);
    robot.axes.iter().zip(values).find(|(axis, value)| !(axis.min..=axis.max).contains(value)).map(|(axis, _)| axis)
}

/// The share of the nominal time at which the curve's parameter is `at`: by Newton's method, with bisection where that
/// leads away.
fn inverse(parametrization: &Parametrization, at: f64) -> f64 {
    let (mut low, mut high) = (0.0, 1.0);
    let mut share = at;
    for _ in 0..60 {
        let off = parametrization.at(share) - at;
        if off < 0.0 {
            low = share
        } else {
            high = share
        }
        let next = share - off / parametrization.derivative(1, share);
        let next = if next > low && next < high { next } else { f64::midpoint(low, high) };
        if (next - share).abs() < 1e-12 {
            return next;
        }
        share = next;
    }
    share
}

/// Collects the limits of the TCP, the tool's rotation and the external axes at a place; for a TCP that is `swinging`,
/// those of its whole acceleration.
fn collect(place: &CurvePoint, curve: &ToolCurve, swinging: bool, constraints: &mut Constraints, pace: &PathLimits) {
    let moving = place.vectors([1, 2, 3].map(|order| curve.path.track.derivative(order, place.at)));
    if swinging {
        constraints.swinging(&moving, pace);
    } else {
        constraints.moving(&moving, pace);
    }
    if pace.manual {
        constraints.manual_moving(&moving);
        constraints.manual_flange(curve, place.at, place.first);
    }
    constraints.turning(&place.vectors(curve.rotation_rates(place.at)), pace);
    constraints.external(&place.rates([1, 2, 3].map(|order| curve.external.derivative(order, place.at))), pace);
}
