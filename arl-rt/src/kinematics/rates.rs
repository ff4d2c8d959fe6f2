//! How axes and tool move together: speeds, and along a path the first three derivatives of the axes.

use nalgebra::{Matrix6, Vector3, Vector6};

use super::Axes;
use super::angles::sin_cos;
use super::opw::Opw;

/// The motion of a rigid body along a path parameter, seen at the base's origin: turning (rad) over moving (m), with its
/// first and second derivative.
#[derive(Clone, Copy, Debug)]
pub struct Twist {
    /// Per unit of the parameter.
    pub first: Vector6<f64>,
    /// First derivative.
    pub second: Vector6<f64>,
    /// Second derivative.
    pub third: Vector6<f64>,
}

impl Twist {
    /// A body whose point `point` (mm) moves straight by `travel` (mm) per unit while the body turns by `turning` (rad,
    /// about a fixed axis of the base) per unit.
    pub fn straight(point: &Vector3<f64>, travel: &Vector3<f64>, turning: &Vector3<f64>) -> Self {
        let (point, travel) = (point / 1000.0, travel / 1000.0);
        Self {
            first: stack(turning, &(travel - turning.cross(&point))),
            second: stack(&Vector3::zeros(), &-turning.cross(&travel)),
            third: Vector6::zeros(),
        }
    }
}

/// Derivatives of the axes along a path, in deg per unit of the path parameter, its square, its cube.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Rates {
    /// First derivative.
    pub first: Axes,
    /// Second derivative.
    pub second: Axes,
    /// Third derivative.
    pub third: Axes,
}

fn stack(turning: &Vector3<f64>, moving: &Vector3<f64>) -> Vector6<f64> {
    Vector6::new(turning.x, turning.y, turning.z, moving.x, moving.y, moving.z)
}

fn turning(twist: &Vector6<f64>) -> Vector3<f64> {
    twist.fixed_rows::<3>(0).into_owned()
}

fn moving(twist: &Vector6<f64>) -> Vector3<f64> {
    twist.fixed_rows::<3>(3).into_owned()
}

/// How `of` changes when it is carried by a body that moves with `by`: the Lie bracket of two twists.
fn carried(by: &Vector6<f64>, of: &Vector6<f64>) -> Vector6<f64> {
    let (w1, v1, w2, v2) = (turning(by), moving(by), turning(of), moving(of));
    stack(&w1.cross(&w2), &(w1.cross(&v2) + v1.cross(&w2)))
}

impl Opw {
    /// The axes as screws in the base (rad, m): column i is the twist of the flange when axis i + 1 turns 1 rad.
    pub fn jacobian(&self, axes: &Axes) -> Matrix6<f64> {
        let [t1, t2, t3, t4, t5, _] = self.inner(axes);
        let ([s1, s2, s23, s4, s5, _], [c1, c2, c23, c4, c5, _]) = sin_cos([t1, t2, t2 + t3, t4, t5, 0.0]);
        let turned = |x: f64, y: f64, z: f64| Vector3::new(c1 * x - s1 * y, s1 * x + c1 * y, z);
        let across = turned(0.0, 1.0, 0.0);
        let shoulder = turned(self.a1, self.b, self.c1);
        let elbow = shoulder + turned(self.c2 * s2, 0.0, self.c2 * c2);
        let centre = elbow + turned(self.c3 * s23 + self.a2 * c23, 0.0, self.c3 * c23 - self.a2 * s23);
        // In the forearm's frame axis 5 is y and axis 6 is z, turned by axis 4 (and 5).
        let forearm = |x: f64, y: f64, z: f64| turned(c23 * x + s23 * z, y, c23 * z - s23 * x);
        let screws = [
            (Vector3::z(), Vector3::zeros()),
            (across, shoulder),
            (across, elbow),
            (forearm(0.0, 0.0, 1.0), centre),
            (forearm(-s4, c4, 0.0), centre),
            (forearm(c4 * s5, s4 * s5, c5), centre),
        ];
        let mut jacobian = Matrix6::zeros();
        for (column, ((axis, point), sign)) in screws.iter().zip(&self.parameters().signs).enumerate() {
            jacobian.set_column(column, &(stack(axis, &point.cross(axis)) * *sign));
        }
        jacobian
    }

    /// The velocity of `point` (mm, fixed to the flange, given in the base) when the axes move by `rates` (deg per unit):
    /// mm per unit.
    pub fn point_velocity(&self, axes: &Axes, rates: &Axes, point: &Vector3<f64>) -> Vector3<f64> {
        let twist = self.jacobian(axes) * Vector6::from(*rates).map(f64::to_radians);
        moving(&twist) * 1000.0 + turning(&twist).cross(point)
    }

    /// The derivatives of the axes when the flange moves with `twist`. `None` at a singular point.
    pub fn rates(&self, axes: &Axes, twist: &Twist) -> Option<Rates> {
        let screws = self.jacobian(axes);
        let solver = screws.lu();
        let column = |matrix: &Matrix6<f64>, index: usize| matrix.column(index).into_owned();
        let first = solver.solve(&twist.first)?;

        // Each axis is carried by the ones below it: that is how its screw changes along the path.
        let mut screws1 = Matrix6::zeros();
        let mut below = Vector6::zeros();
        for index in 0..6 {
            let screw = column(&screws, index);
            screws1.set_column(index, &carried(&below, &screw));
            below += screw * first[index];
        }
        let second = solver.solve(&(twist.second - screws1 * first))?;

        let mut screws2 = Matrix6::zeros();
        let mut below = Vector6::zeros();
        let mut below1 = Vector6::zeros();
        for index in 0..6 {
            let (screw, screw1) = (column(&screws, index), column(&screws1, index));
            screws2.set_column(index, &(carried(&below1, &screw) + carried(&below, &screw1)));
            below += screw * first[index];
            below1 += screw1 * first[index] + screw * second[index];
        }
        let third = solver.solve(&(twist.third - screws1 * second * 2.0 - screws2 * first))?;

        let degrees = |vector: Vector6<f64>| -> Option<Axes> {
            let axes: Axes = vector.map(f64::to_degrees).into();
            axes.iter().all(|value| value.is_finite()).then_some(axes)
        };
        Some(Rates { first: degrees(first)?, second: degrees(second)?, third: degrees(third)? })
    }
}
