//! The relation between the motion of axes and tool: speeds, and the first three derivatives of the axes along a path.

use nalgebra::{Matrix6, Vector3};

use super::angles::sin_cos;
use super::opw::{Opw, Singularity};
use super::scara::Scara;
use super::{Axes, Kinematics};
use crate::robot::Axis;

/// The motion of the flange along a path parameter, with its first and second derivative.
#[derive(Clone, Copy, Debug)]
pub struct Twist {
    first: Screw,
    second: Screw,
    third: Screw,
}

/// The motion of a rigid body in the base: a turn (rad), and a translation (m) of the point at the base's origin.
#[derive(Clone, Copy, Debug)]
pub(super) struct Screw {
    pub(super) turning: Vector3<f64>,
    pub(super) moving: Vector3<f64>,
}

impl Twist {
    /// A body whose point `point` (mm) moves straight by `travel` (mm) per unit while the body turns by `turning` (rad,
    /// about a fixed axis of the base) per unit.
    pub fn straight(point: &Vector3<f64>, travel: &Vector3<f64>, turning: &Vector3<f64>) -> Self {
        let rest = Vector3::zeros();
        Self::of_point(point, &[*travel, rest, rest], &[*turning, rest, rest])
    }

    /// A body of which one point, now at `point` (mm), moves with the first three derivatives `moving` of its place (mm
    /// per unit of the path parameter, its square, its cube), while the body turns with the speed and its first two
    /// derivatives `turning` (rad per unit, its square, its cube). All in the base.
    pub fn of_point(point: &Vector3<f64>, moving: &[Vector3<f64>; 3], turning: &[Vector3<f64>; 3]) -> Self {
        let p = point / 1000.0;
        let [v, a, j] = moving.map(|derivative| derivative / 1000.0);
        let [w, w1, w2] = *turning;
        Self {
            first: Screw { turning: w, moving: v - w.cross(&p) },
            second: Screw { turning: w1, moving: a - w1.cross(&p) - w.cross(&v) },
            third: Screw { turning: w2, moving: j - w2.cross(&p) - w1.cross(&v) * 2.0 - w.cross(&a) },
        }
    }
}

impl Twist {
    /// The first three derivatives (mm per unit of the path parameter, its square, its cube) of the position of a point
    /// that is at `point` (mm) and moves with the body.
    pub fn of_place(&self, point: &Vector3<f64>) -> [Vector3<f64>; 3] {
        let p = point / 1000.0;
        let v = self.first.at(&p);
        let a = self.second.at(&p) + self.first.turning.cross(&v);
        let j = self.third.at(&p) + self.second.turning.cross(&v) * 2.0 + self.first.turning.cross(&a);
        [v * 1000.0, a * 1000.0, j * 1000.0]
    }
}

/// Derivatives of the axes along a path, in deg (mm where linear) per unit of the path parameter, its square, its cube.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Rates {
    /// First derivative.
    pub first: Axes,
    /// Second derivative.
    pub second: Axes,
    /// Third derivative.
    pub third: Axes,
}

/// The lowest speed of the TCP (mm/s) and of the tool's turning (deg/s) that is sensible along a path: a place that the
/// axes cannot pass even at this speed is singular. For a path that moves and turns the tool, it is the speed at which
/// neither is faster.
pub const LOWEST_TRAVEL_MM_S: f64 = 1.0;
/// See [`LOWEST_TRAVEL_MM_S`].
pub const LOWEST_TURNING_DEG_S: f64 = 0.1;
/// Farther from singular points than this (see [`Kinematics::clearance`]) every place can be passed at the lowest
/// sensible speed.
pub const CLEAR_OF_SINGULAR: f64 = 0.15;
/// The shortest step, as time (s) at the lowest sensible speed, in which a path is examined: an axis that jumps within
/// it would have to turn infinitely fast.
pub const SHORTEST_STEP_S: f64 = 1e-3;

/// The time of a path at the lowest sensible speed (see [`LOWEST_TRAVEL_MM_S`]), in s per unit of its parameter, at a
/// place where the TCP moves by `travel` (mm) and the tool turns by `turning` (rad) per unit. However a path is divided
/// into segments, the time of the same piece is the same.
pub fn lowest_pace(travel: &Vector3<f64>, turning: &Vector3<f64>) -> f64 {
    (travel.norm() / LOWEST_TRAVEL_MM_S).max(turning.norm().to_degrees() / LOWEST_TURNING_DEG_S)
}

impl Rates {
    /// The part of the path over which the motion of `axes`, the robot's, changes substantially: infinity if it does
    /// not.
    pub fn scale(&self, axes: &[Axis]) -> f64 {
        let size = |rates: &Axes| {
            let by_speed = rates.iter().zip(axes).map(|(rate, axis)| rate.abs() / axis.vel);
            by_speed.fold(0.0, f64::max)
        };
        let (first, second, third) = (size(&self.first), size(&self.second), size(&self.third));
        let scale = (first / second).min((first / third).sqrt());
        if scale.is_nan() { f64::INFINITY } else { scale }
    }

    /// How many times faster than the lowest sensible speed `axes`, the robot's, can follow according to their speeds
    /// and accelerations, if these are the rates of a straight path with this [`lowest_pace`]: below 1 the place is
    /// singular in that direction. Also returns the axis with the least margin.
    pub fn speed_margin(&self, axes: &[Axis], pace: f64) -> (f64, usize) {
        let rates = self.first.iter().zip(&self.second).zip(axes);
        let margin = |(rates, axis): ((&f64, &f64), &Axis)| {
            let (vel, acc) = (rates.0.abs() / pace, rates.1.abs() / (pace * pace));
            (axis.vel / vel).min((axis.acc / acc).sqrt())
        };
        let margins = rates.map(margin).enumerate().map(|(index, margin)| (margin, index));
        margins.fold((f64::INFINITY, 0), |least, next| if next.0 < least.0 { next } else { least })
    }
}

/// Whether one of `axes`, the robot's, would have to exceed its speed to move from `from` to `to` (deg or mm) in
/// `seconds`.
pub fn outruns(axes: &[Axis], from: &Axes, to: &Axes, seconds: f64) -> bool {
    axes.iter().zip(from.iter().zip(to)).any(|(axis, (from, to))| (to - from).abs() > axis.vel * seconds)
}

impl Screw {
    const REST: Screw = Screw { turning: Vector3::new(0.0, 0.0, 0.0), moving: Vector3::new(0.0, 0.0, 0.0) };

    /// A turn about the line through `point` (m) along `axis`.
    fn about(axis: Vector3<f64>, point: &Vector3<f64>) -> Self {
        Self { turning: axis, moving: point.cross(&axis) }
    }

    fn plus(&self, other: &Screw, times: f64) -> Self {
        Self { turning: self.turning + other.turning * times, moving: self.moving + other.moving * times }
    }

    /// The change of this screw when it is carried by a body that moves with `by`: the Lie bracket of two twists.
    fn carried(&self, by: &Screw) -> Self {
        Self {
            turning: by.turning.cross(&self.turning),
            moving: by.turning.cross(&self.moving) + by.moving.cross(&self.turning),
        }
    }

    /// The velocity (m) of the point at `point` (m).
    fn at(&self, point: &Vector3<f64>) -> Vector3<f64> {
        self.moving + self.turning.cross(point)
    }
}

/// The derivatives of `N` axes (rad or m) whose screws, from the base on, are `screws`, when the last body moves with
/// `twist`. `solve` returns the speeds of the axes when that body moves with a screw.
fn derivatives<const N: usize>(
    screws: &[Screw; N],
    twist: &Twist,
    solve: impl Fn(&Screw) -> Option<[f64; N]>,
) -> Option<[[f64; N]; 3]> {
    let first = solve(&twist.first)?;
    // Each axis is carried by the ones below it, which changes its screw along the path.
    let mut screws1 = [Screw::REST; N];
    let (mut below, mut rest) = (Screw::REST, twist.second);
    for ((screw, screw1), first) in screws.iter().zip(&mut screws1).zip(first) {
        *screw1 = screw.carried(&below);
        below = below.plus(screw, first);
        rest = rest.plus(screw1, -first);
    }
    let second = solve(&rest)?;

    let (mut below, mut below1, mut rest) = (Screw::REST, Screw::REST, twist.third);
    for (((screw, screw1), first), second) in screws.iter().zip(&screws1).zip(first).zip(second) {
        let screw2 = screw.carried(&below1).plus(&screw1.carried(&below), 1.0);
        below = below.plus(screw, first);
        below1 = below1.plus(screw1, first).plus(screw, second);
        rest = rest.plus(screw1, -2.0 * second).plus(&screw2, -first);
    }
    Some([first, second, solve(&rest)?])
}

/// The axes of an arm at one moment.
struct Stance {
    screws: [Screw; 6],
    sin_cos: ([f64; 6], [f64; 6]),
    centre: Vector3<f64>,
    /// The wrist centre relative to axes 1, 2 and 3 in the arm's plane: in front and above.
    from1: f64,
    from2: (f64, f64),
    from3: (f64, f64),
}

impl Opw {
    fn stance_at(&self, axes: &Axes) -> Stance {
        let [t1, t2, t3, t4, t5, _] = self.inner(axes);
        let sin_cos = sin_cos([t1, t2, t2 + t3, t4, t5, 0.0]);
        let ([s1, s2, s23, s4, s5, _], [c1, c2, c23, c4, c5, _]) = sin_cos;
        let turned = |x: f64, y: f64, z: f64| Vector3::new(c1 * x - s1 * y, s1 * x + c1 * y, z);
        let from3 = (self.c3 * s23 + self.a2 * c23, self.c3 * c23 - self.a2 * s23);
        let from2 = (self.c2 * s2 + from3.0, self.c2 * c2 + from3.1);
        let across = turned(0.0, 1.0, 0.0);
        let shoulder = turned(self.a1, self.b, self.c1);
        let elbow = shoulder + turned(self.c2 * s2, 0.0, self.c2 * c2);
        let centre = shoulder + turned(from2.0, 0.0, from2.1);
        // In the forearm's frame axis 5 is y and axis 6 is z, turned by axis 4 (and 5).
        let forearm = |x: f64, y: f64, z: f64| turned(c23 * x + s23 * z, y, c23 * z - s23 * x);
        let screws = [
            Screw { turning: Vector3::z(), moving: Vector3::zeros() },
            Screw::about(across, &shoulder),
            Screw::about(across, &elbow),
            Screw::about(forearm(0.0, 0.0, 1.0), &centre),
            Screw::about(forearm(-s4, c4, 0.0), &centre),
            Screw::about(forearm(c4 * s5, s4 * s5, c5), &centre),
        ];
        Stance { screws, sin_cos, centre, from1: self.a1 + from2.0, from2, from3 }
    }

    /// The derivatives of the axes when the flange moves with `twist`; see [`Kinematics::rates`].
    pub fn rates(&self, axes: &Axes, twist: &Twist) -> Option<Rates> {
        let Stance { screws, sin_cos, centre, from1, from2, from3 } = self.stance_at(axes);
        let ([s1, _, s23, s4, s5, _], [c1, _, c23, c4, c5, _]) = sin_cos;
        // Only axes 1 to 3 move the wrist centre, two of them in the arm's plane; the other three produce the remaining
        // turn.
        let (by_from1, by_s5) = (1.0 / from1, 1.0 / s5);
        let by_plane = 1.0 / (from2.1 * from3.0 - from2.0 * from3.1);
        let solve = |body: &Screw| {
            let v = body.at(&centre);
            let q1 = (c1 * v.y - s1 * v.x) * by_from1;
            let (x, z) = (c1 * v.x + s1 * v.y + self.b * q1, v.z);
            // (x, z) = q2 (from2.z, -from2.x) + q3 (from3.z, -from3.x)
            let q2 = (x * from3.0 + z * from3.1) * by_plane;
            let q3 = -(x * from2.0 + z * from2.1) * by_plane;
            let w = &body.turning;
            let (along, y) = (c1 * w.x + s1 * w.y, c1 * w.y - s1 * w.x - q2 - q3);
            let z = w.z - q1;
            let (x, z) = (c23 * along - s23 * z, s23 * along + c23 * z);
            let q5 = c4 * y - s4 * x;
            let q6 = (c4 * x + s4 * y) * by_s5;
            Some([q1, q2, q3, z - c5 * q6, q5, q6])
        };
        let signs = &self.parameters().signs;
        let degrees = |mut rates: Axes| {
            rates.iter_mut().zip(signs).for_each(|(rate, sign)| *rate = rate.to_degrees() * sign);
            rates.iter().all(|rate| rate.is_finite()).then_some(rates)
        };
        let [first, second, third] = derivatives(&screws, twist, solve)?.map(degrees);
        Some(Rates { first: first?, second: second?, third: third? })
    }
}

/// A flange that tilts faster than this (rad per unit), as part of its whole motion, is not that of a SCARA.
const UPRIGHT: f64 = 1e-6;

impl Scara {
    /// The screws of the four axes, and elbow and flange relative to axis 1 (m).
    fn screws(&self, axes: &Axes) -> ([Screw; 4], Vector3<f64>, Vector3<f64>) {
        let [j1, j2, ..] = *axes;
        let ([s1, s12], [c1, c12]) = sin_cos([j1, j1 + j2]);
        let (l1, l2) = (self.l1 / 1000.0, self.l2 / 1000.0);
        let elbow = Vector3::new(l1 * c1, l1 * s1, 0.0);
        let flange = elbow + Vector3::new(l2 * c12, l2 * s12, 0.0);
        let screws = [
            Screw::about(Vector3::z(), &Vector3::zeros()),
            Screw::about(Vector3::z(), &elbow),
            Screw { turning: Vector3::zeros(), moving: Vector3::z() },
            Screw::about(Vector3::z(), &flange),
        ];
        (screws, elbow, flange)
    }

    /// The derivatives of the axes when the flange moves with `twist`; see [`Kinematics::rates`].
    pub fn rates(&self, axes: &Axes, twist: &Twist) -> Option<Rates> {
        let (screws, elbow, flange) = self.screws(axes);
        let reach = flange - elbow;
        let by_area = 1.0 / (elbow.x * reach.y - elbow.y * reach.x);
        let solve = |body: &Screw| {
            let w = &body.turning;
            if w.xy().norm() > UPRIGHT * (1.0 + w.norm()) {
                return None;
            }
            // z x flange * q1 + z x reach * q2 = v, which is z x elbow * q1 + z x reach * (q1 + q2).
            let v = body.at(&flange);
            let q1 = (v.x * reach.x + v.y * reach.y) * by_area;
            let both = -(v.x * elbow.x + v.y * elbow.y) * by_area;
            Some([q1, both - q1, v.z, w.z - both])
        };
        let outer = |[q1, q2, q3, q4]: [f64; 4]| {
            let rates = [q1.to_degrees(), q2.to_degrees(), q3 * 1000.0, q4.to_degrees(), 0.0, 0.0];
            rates.iter().all(|rate| rate.is_finite()).then_some(rates)
        };
        let [first, second, third] = derivatives(&screws, twist, solve)?.map(outer);
        Some(Rates { first: first?, second: second?, third: third? })
    }
}

impl Kinematics {
    /// The derivatives of the axes when the flange moves with `twist`; the unused axes of a SCARA stay at rest. `None`
    /// at a singular point (near one the rates are large: see [`Kinematics::clearance`]), and if a SCARA would have to
    /// tilt its flange.
    pub fn rates(&self, axes: &Axes, twist: &Twist) -> Option<Rates> {
        match self {
            Kinematics::SixAxis(opw) => opw.rates(axes, twist),
            Kinematics::Scara(scara) => scara.rates(axes, twist),
        }
    }

    /// The motion of a body on the flange when each axis moves alone: column i is for axis i + 1 at a speed of 1 rad (1
    /// mm for a linear axis). The first three rows are the turning (rad) in the base, the last three the velocity (mm)
    /// of `point` (mm, given in the base, fixed to the flange). The columns of axes that a SCARA does not have are
    /// zero.
    pub fn jacobian(&self, axes: &Axes, point: &Vector3<f64>) -> Matrix6<f64> {
        let mut jacobian = Matrix6::zeros();
        let point = point / 1000.0;
        self.each_screw(axes, |column, screw, linear| {
            jacobian.fixed_view_mut::<3, 1>(0, column).copy_from(&screw.turning);
            let millimetres = if linear { 1.0 } else { 1000.0 };
            jacobian.fixed_view_mut::<3, 1>(3, column).copy_from(&(screw.at(&point) * millimetres));
        });
        jacobian
    }

    /// The velocity of `point` (mm, fixed to the flange, given in the base) in mm per unit, when the axes move by
    /// `rates` (deg or mm per unit).
    pub fn point_velocity(&self, axes: &Axes, rates: &Axes, point: &Vector3<f64>) -> Vector3<f64> {
        let (turning, moving) = self.velocity(axes, rates);
        moving + turning.cross(point)
    }

    /// The motion of a body on the flange when the axes move by `rates` (deg or mm per unit): its turning (rad per
    /// unit) in the base, and the velocity (mm per unit) of the point at the base's origin.
    pub fn velocity(&self, axes: &Axes, rates: &Axes) -> (Vector3<f64>, Vector3<f64>) {
        let mut sum = Screw::REST;
        self.each_screw(axes, |column, screw, linear| {
            let rate = rates.get(column).copied().unwrap_or(0.0);
            sum = sum.plus(screw, if linear { rate / 1000.0 } else { rate.to_radians() });
        });
        (sum.turning, sum.moving * 1000.0)
    }

    /// Passes the screw (rad, m) of every axis, with the sign of the axis's own direction, and whether it is linear, to
    /// `take`.
    fn each_screw(&self, axes: &Axes, mut take: impl FnMut(usize, &Screw, bool)) {
        match self {
            Kinematics::SixAxis(opw) => {
                let screws = opw.stance_at(axes).screws;
                for (column, (screw, sign)) in screws.iter().zip(&opw.parameters().signs).enumerate() {
                    take(column, &Screw::REST.plus(screw, *sign), false);
                }
            }
            Kinematics::Scara(scara) => {
                let (screws, ..) = scara.screws(axes);
                screws.iter().enumerate().for_each(|(column, screw)| take(column, screw, column == 2));
            }
        }
    }

    /// How clear the axes are of a singular point, 0 to 1: for six axes the least of the sines of the wrist's middle
    /// angle and of the angle at the elbow, and of the wrist centre's distance from axis 1 as part of the arm's length;
    /// for a SCARA the sine of the angle at the elbow.
    pub fn clearance(&self, axes: &Axes) -> f64 {
        match self {
            Kinematics::SixAxis(opw) => opw.clearance(axes),
            Kinematics::Scara(scara) => scara.clearance(axes),
        }
    }

    /// The singularity that the axes are nearest to, by the measure of [`Kinematics::clearance`].
    pub fn nearest_singularity(&self, axes: &Axes) -> Singularity {
        match self {
            Kinematics::SixAxis(opw) => opw.nearest_singularity(axes),
            Kinematics::Scara(_) => Singularity::Elbow,
        }
    }
}
