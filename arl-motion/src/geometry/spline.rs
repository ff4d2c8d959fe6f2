//! Smooth paths through points.
//!
//! At each inner point the path has the direction and the curvature of the parabola through the point and its
//! neighbours, over the lengths of the chords. Between two points it is a polynomial of the fifth degree; towards an
//! end of the spline, one that continues like a parabola. So a segment depends on at most two points before it and one
//! behind it, points on a line make a line, and what is planned already never changes. The tool's rotation and the
//! external axes follow the same rule.

use std::sync::Arc;

use nalgebra::{SVector, Vector3};

use crate::geometry::paced_quintic::PacedQuintic;
use crate::geometry::parametrization::Parametrization;
use crate::geometry::quintic::{Knot, Quintic};
use crate::geometry::rotation;
use crate::geometry::tcp_path::TcpPath;
use crate::geometry::track::Track;
use arl_robot::kinematics::Frame;
use arl_robot::robot::EXTERNAL_AXES;

/// The TCP and the external axes at a point of the path.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct SplinePoint {
    /// In the base, translation in mm.
    pub(crate) tcp: Frame,
    /// In deg (mm).
    pub(crate) external: [f64; EXTERNAL_AXES],
}

/// How the path passes an inner point: derivatives by the length of the chords, in mm.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct Passing {
    moved: [Vector3<f64>; 2],
    /// Speed of rotation in rad per mm, and its derivative.
    turned: [Vector3<f64>; 2],
    external: [SVector<f64, EXTERNAL_AXES>; 2],
    /// The nominal speed of the TCP in mm/s.
    pub(crate) speed: f64,
}

/// The cosine of the angle, 150 deg, from which chords count as turning back: a path through such a point would almost
/// stop there, and its tangent would be shorter than `LEAST_SHARE_OF_CHORD`.
const TURN_BACK_COSINE: f64 = -0.866_025_404;

/// Where the path is nearly reversed, its parameter slows down to this share of the length of the chords, not to zero.
const LEAST_SHARE_OF_CHORD: f64 = 0.25;

impl SplinePoint {
    /// The length of the chord to another point in mm.
    pub(crate) fn chord(&self, to: &SplinePoint) -> f64 {
        (to.tcp.translation.vector - self.tcp.translation.vector).norm()
    }

    /// Whether the path from here over a point to another one turns back at that point.
    pub(crate) fn turns_back(&self, over: &SplinePoint, to: &SplinePoint) -> bool {
        let place = |place: &SplinePoint| place.tcp.translation.vector;
        let (first, second) = (place(over) - place(self), place(to) - place(over));
        first.dot(&second) < TURN_BACK_COSINE * first.norm() * second.norm()
    }

    fn turning(&self, to: &SplinePoint) -> Vector3<f64> {
        (to.tcp.rotation * self.tcp.rotation.inverse()).scaled_axis()
    }

    fn external(&self) -> SVector<f64, EXTERNAL_AXES> {
        self.external.into()
    }
}

impl Passing {
    /// The passing of `here`, from `before` to `after`; all three are at different places.
    pub(crate) fn through([before, here, after]: [&SplinePoint; 3], speed: f64) -> Self {
        let (h0, h1) = (before.chord(here), here.chord(after));
        let moved = |from: &SplinePoint, to: &SplinePoint| to.tcp.translation.vector - from.tcp.translation.vector;
        Self {
            moved: parabola(h0, moved(before, here), h1, moved(here, after)),
            turned: parabola(h0, -here.turning(before), h1, here.turning(after)),
            external: parabola(h0, here.external() - before.external(), h1, after.external() - here.external()),
            speed,
        }
    }
}

/// The first and second derivative in the middle of three points, which are `chord0` and `chord1` apart over the
/// lengths `h0` and `h1`.
fn parabola<const N: usize>(
    h0: f64,
    chord0: SVector<f64, N>,
    h1: f64,
    chord1: SVector<f64, N>,
) -> [SVector<f64, N>; 2] {
    let (slope0, slope1) = (chord0 / h0, chord1 / h1);
    [(slope0 * h1 + slope1 * h0) / (h0 + h1), (slope1 - slope0) * (2.0 / (h0 + h1))]
}

/// The curve from one point to the next, with the given passing at its ends, or none where the spline ends there; with
/// the external axes along it, and the nominal time in s that it takes at `speed` mm/s.
pub(crate) fn segment(
    [from, to]: [&SplinePoint; 2],
    [start, end]: [Option<&Passing>; 2],
    speed: f64,
) -> (TcpPath, PacedQuintic<EXTERNAL_AXES>, f64) {
    let chord = from.chord(to);
    let scaled = |[first, second]: [Vector3<f64>; 2]| [first * chord, second * (chord * chord)];
    let turning = from.turning(to);
    let moved = polynomial(
        from.tcp.translation.vector,
        to.tcp.translation.vector - from.tcp.translation.vector,
        start.map(|passing| scaled(passing.moved)),
        end.map(|passing| scaled(passing.moved)),
    );
    let turned = polynomial(
        Vector3::zeros(),
        turning,
        start.map(|passing| scaled(passing.turned)),
        end.map(|passing| rotation::of_speeds(&turning, &scaled(passing.turned))),
    );
    let external = |passing: &Passing| {
        let [first, second] = passing.external;
        [first * chord, second * (chord * chord)]
    };
    let external = polynomial(from.external(), to.external() - from.external(), start.map(external), end.map(external));
    let [start, end] = [start, end].map(|passing| passing.map_or(speed, |passing| passing.speed));
    let (parametrization, time) = Parametrization::eased(|at| gait(&moved, chord, at), [start, speed, end]);
    let pace = Arc::new(parametrization);
    let path = TcpPath {
        track: Track::Poly(PacedQuintic::paced(moved, pace.clone())),
        base: from.tcp.rotation,
        turning: PacedQuintic::paced(turned, pace.clone()),
    };
    (path, PacedQuintic::paced(external, pace), time)
}

/// A polynomial from `start` by `chord`; where the derivatives at an end are not given, it continues as a parabola
/// there.
fn polynomial<const N: usize>(
    start: SVector<f64, N>,
    chord: SVector<f64, N>,
    from: Option<[SVector<f64, N>; 2]>,
    to: Option<[SVector<f64, N>; 2]>,
) -> Quintic<N> {
    let free = |first: &SVector<f64, N>, towards: f64| [chord * 2.0 - first, (first - chord) * (2.0 * towards)];
    let (from, to) = match (from, to) {
        (None, None) => return Quintic::even(start.into(), chord.into()),
        (Some(from), Some(to)) => (from, to),
        (None, Some(to)) => (free(&to[0], 1.0), to),
        (Some(from), None) => (from, free(&from[0], -1.0)),
    };
    let knot = |value: SVector<f64, N>, [first, second]: [SVector<f64, N>; 2]| Knot {
        value: value.into(),
        first: first.into(),
        second: second.into(),
    };
    Quintic::between(&knot(start, from), &knot(start + chord, to))
}

/// The length of the path per unit of the parameter, in mm, and its derivative; never much shorter than
/// `LEAST_SHARE_OF_CHORD` of the chord.
fn gait(moved: &Quintic<3>, chord: f64, at: f64) -> [f64; 2] {
    let (first, second) = (Vector3::from(moved.derivative(1, at)), Vector3::from(moved.derivative(2, at)));
    let least = LEAST_SHARE_OF_CHORD * chord;
    let length = (first.norm_squared() * first.norm_squared() + least * least * least * least).sqrt().sqrt();
    [length, first.norm_squared() * first.dot(&second) / (length * length * length)]
}
