//! Which lengths of a robot file describe a chain of joints.

use super::chain::{Chain, Moving};
use super::place::{Transform, Vector, cross, dot, length, plus};
use std::f64::consts::{FRAC_PI_2, PI};

/// Differences that count as zero: m, and the sine of an angle.
const NEAR: f64 = 1e-6;
const PARALLEL: f64 = 1e-5;

const UP: Vector = [0.0, 0.0, 1.0];

/// The geometry of a six-axis robot: m, rad.
#[derive(Clone, Copy, Debug)]
pub(super) struct SixAxes {
    /// a1, a2, b, c1, c2, c3, c4.
    pub(super) lengths: [f64; 7],
    pub(super) offsets: [f64; 6],
    pub(super) signs: [f64; 6],
}

/// The geometry of a SCARA robot, m, and which joint of the file is which axis.
#[derive(Clone, Copy, Debug)]
pub(super) struct Scara {
    pub(super) l1: f64,
    pub(super) l2: f64,
    pub(super) z0: f64,
    pub(super) order: [usize; 4],
}

/// An axis in the base: a point of it, and its direction.
#[derive(Clone, Copy)]
struct Line {
    at: Vector,
    along: Vector,
}

fn lines(chain: &Chain) -> (Vec<Line>, Transform) {
    let mut places = chain.forward(&vec![0.0; chain.joints.len()]);
    let flange = places.pop().unwrap_or(Transform::ORIGIN);
    let line = |(place, joint): (&Transform, &Moving)| Line { at: place.at, along: place.turned(joint.axis) };
    (places.iter().zip(&chain.joints).map(line).collect(), flange)
}

fn parallel(a: Vector, b: Vector) -> bool {
    length(cross(a, b)) < PARALLEL
}

/// The angle that brings one of two directions, this one or its opposite, nearest to 0; and whether it is the opposite.
fn nearest(sine: f64, cosine: f64) -> (f64, f64) {
    let angle = libm::atan2(sine, cosine);
    if angle.abs() <= FRAC_PI_2 + PARALLEL { (angle, 1.0) } else { (libm::atan2(-sine, -cosine), -1.0) }
}

/// The distance of a point from a line.
fn distance(point: Vector, line: &Line) -> f64 {
    length(cross(plus(point, line.at, -1.0), line.along))
}

/// The geometry of six turning axes with a spherical wrist.
pub(super) fn six_axes(chain: &Chain) -> Result<SixAxes, String> {
    let names: Vec<&str> = chain.joints.iter().map(|joint| joint.name.as_str()).collect();
    let ([n1, n2, n3, n4, n5, n6], (all, flange)) = (names.as_slice(), lines(chain)) else {
        return Err(format!("{} joints: expected six", names.len()));
    };
    let [l1, l2, l3, l4, l5, l6] = all.as_slice() else { return Err("six axes are needed".to_owned()) };
    let (t1, sign2) = shoulder([n1, n2, n3], [l1, l2, l3])?;
    // From here on in the arm's plane: x in front, y along axis 2, z up.
    let back = Transform::about(UP, -t1);
    let into = |line: &Line| Line { at: back.turned(line.at), along: back.turned(line.along) };
    let [l2, l3, l4, l5, l6] = [l2, l3, l4, l5, l6].map(into);
    let flange = back.then(&flange);
    let ([a1, _, c1], [x3, _, z3]) = (l2.at, l3.at);
    let c2 = libm::hypot(x3 - a1, z3 - c1);
    if c2 < NEAR {
        return Err(format!("axes 2 and 3 (`{n2}`, `{n3}`) are the same line: this arm does not fit"));
    }
    let t2 = libm::atan2(x3 - a1, z3 - c1);

    let centre = wrist_centre([n4, n5, n6], [&l4, &l5, &l6])?;
    let [fx, _, fz] = l4.along;
    let [wx, b, wz] = centre;
    let (mut sign4, mut t23) = (1.0, libm::atan2(fx, fz));
    let along = |t: f64| (wx - x3) * libm::sin(t) + (wz - z3) * libm::cos(t);
    if along(t23) < 0.0 {
        (sign4, t23) = (-1.0, libm::atan2(-fx, -fz));
    }
    let (sine, cosine) = libm::sincos(t23);
    let (c3, a2) = (along(t23), (wx - x3) * cosine - (wz - z3) * sine);
    if c3 < NEAR {
        return Err(format!("the wrist is not beyond axis 3 (`{n3}`) along axis 4 (`{n4}`): this arm does not fit"));
    }
    // In the forearm's frame.
    let forearm = |v: Vector| {
        let [x, y, z] = v;
        [x * cosine - z * sine, y, x * sine + z * cosine]
    };
    let [x5, y5, z5] = forearm(l5.along);
    if z5.abs() > PARALLEL {
        return Err(format!("axes 4 and 5 (`{n4}`, `{n5}`) are not at right angles: no spherical wrist"));
    }
    let (t4, sign5) = nearest(-x5, y5);
    let out = dot(plus(flange.at, centre, -1.0), l6.along);
    let faces = dot(flange.column(2), l6.along);
    let sign6 = if out.abs() > NEAR {
        out.signum()
    } else if faces < -0.5 {
        -1.0
    } else {
        1.0
    };
    let hand = |v: Vector| Transform::about(UP, -t4).turned(forearm(v));
    let [hx, _, hz] = hand(l6.along.map(|component| component * sign6));
    let t5 = libm::atan2(hx, hz);
    // Where the flange's z does not point outwards along axis 6, its x has no meaning.
    let [px, py, _] = Transform::about([0.0, 1.0, 0.0], -t5).turned(hand(flange.column(0)));
    let t6 = if faces * sign6 > 1.0 - PARALLEL { libm::atan2(py, px) } else { 0.0 };
    let side = |v: Vector| {
        let [_, y, _] = v;
        y.signum()
    };
    let signs = [dot(l1.along, UP).signum(), sign2, side(l3.along), sign4, sign5, sign6];
    let t3 = wrapped(t23 - t2);
    let fit = SixAxes {
        lengths: [a1, a2, b, c1, c2, c3, out.abs()],
        offsets: [t1, t2, t3, t4, t5, t6].map(|angle| -angle),
        signs,
    };
    proven(chain, &fit, faces * sign6 > 1.0 - PARALLEL)?;
    Ok(fit)
}

/// The position of axis 1 that brings the arm's plane to that of x and z, and the sign of axis 2. Axes 1 to 3 have
/// these names.
fn shoulder([n1, n2, n3]: [&str; 3], [l1, l2, l3]: [&Line; 3]) -> Result<(f64, f64), String> {
    if !parallel(l1.along, UP) {
        return Err(format!("axis 1 (`{n1}`) is not vertical in the base; a robot file cannot describe that"));
    }
    if distance([0.0; 3], l1) > NEAR {
        return Err(format!("axis 1 (`{n1}`) does not go through the base's origin; move the base's frame onto it"));
    }
    if !parallel(l2.along, l3.along) || dot(l2.along, UP).abs() > PARALLEL {
        return Err(format!("axes 2 and 3 (`{n2}`, `{n3}`) are not level and parallel: this arm does not fit"));
    }
    let [x, y, _] = l2.along;
    Ok(nearest(-x, y))
}

/// The point where axes 4 to 6, which have these names, meet.
fn wrist_centre([n4, n5, n6]: [&str; 3], [l4, l5, l6]: [&Line; 3]) -> Result<Vector, String> {
    let Some(centre) = intersection(l5, l6) else {
        return Err(format!("axes 5 and 6 (`{n5}`, `{n6}`) do not meet at a right angle: no spherical wrist"));
    };
    if distance(centre, l4) > NEAR {
        return Err(format!(
            "axis 4 (`{n4}`) misses the point where axes 5 and 6 meet by {:.3} mm: no spherical wrist",
            1e3 * distance(centre, l4)
        ));
    }
    let [_, fy, _] = l4.along;
    if fy.abs() > PARALLEL {
        return Err(format!("axis 4 (`{n4}`) does not lie in the plane of the arm"));
    }
    Ok(centre)
}

fn wrapped(angle: f64) -> f64 {
    angle - 2.0 * PI * (angle / (2.0 * PI)).round()
}

/// Where two lines at right angles meet.
fn intersection(a: &Line, b: &Line) -> Option<Vector> {
    if dot(a.along, b.along).abs() > PARALLEL {
        return None;
    }
    let apart = plus(b.at, a.at, -1.0);
    let place = plus(a.at, a.along, dot(apart, a.along));
    (distance(place, b) < NEAR).then_some(place)
}

/// The pose of the flange that the geometry gives.
fn forward(fit: &SixAxes, at: &[f64]) -> Transform {
    let [a1, a2, b, c1, c2, c3, c4] = fit.lengths;
    let (y, z) = ([0.0, 1.0, 0.0], [0.0, 0.0, 1.0]);
    let steps =
        [(z, [a1, b, c1]), (y, [0.0, 0.0, c2]), (y, [a2, 0.0, c3]), (z, [0.0; 3]), (y, [0.0; 3]), (z, [0.0, 0.0, c4])];
    let mut place = Transform::ORIGIN;
    for (((axis, shift), at), (sign, offset)) in steps.iter().zip(at).zip(fit.signs.iter().zip(&fit.offsets)) {
        place = place.then(&Transform::about(*axis, at * sign - offset)).then(&Transform::shift(*shift));
    }
    place
}

/// The geometry must lead to the same flange as the file, wherever the axes are.
fn proven(chain: &Chain, fit: &SixAxes, turned: bool) -> Result<(), String> {
    for round in 0..20 {
        let at: Vec<f64> = (0..6).map(|axis| f64::from((round * 37 + axis * 101) % 60) / 10.0 - 3.0).collect();
        let Some(expected) = chain.forward(&at).pop() else { return Ok(()) };
        let found = forward(fit, &at);
        let off = length(plus(found.at, expected.at, -1.0));
        let apart = (0..3).map(|column| length(plus(found.column(column), expected.column(column), -1.0)));
        if off > 1e-4 || (turned && apart.fold(0.0, f64::max) > 1e-3) {
            return Err(format!(
                "no geometry of a six-axis robot file gives the flange of this robot: it is {:.3} mm off",
                off * 1e3
            ));
        }
    }
    Ok(())
}

/// The geometry of two arms, a lift and a turning flange.
pub(super) fn scara(chain: &Chain) -> Result<Scara, String> {
    let (all, flange) = lines(chain);
    let order = match chain.joints.iter().map(|joint| joint.slides).collect::<Vec<_>>().as_slice() {
        [false, false, true, false] => [0, 1, 2, 3],
        [false, false, false, true] => [0, 1, 3, 2],
        _ => {
            return Err(
                "of the four joints of a SCARA robot the first two must turn; of the others, one must slide and \
                        one turn"
                    .to_owned(),
            );
        }
    };
    let [l1, l2, ..] = all.as_slice() else { return Err("four axes are needed".to_owned()) };
    for (line, joint) in all.iter().zip(&chain.joints) {
        let [_, _, z] = line.along;
        if z < 1.0 - PARALLEL {
            return Err(format!(
                "the axis of `{}` does not point upwards; a SCARA's robot file has no signs, so turn the joint's axis (and \
                 change the sense of its range)",
                joint.name
            ));
        }
    }
    if distance([0.0; 3], l1) > NEAR {
        return Err("axis 1 does not go through the base's origin; move the base's frame onto it".to_owned());
    }
    let ([x, y, _], [fx, fy, z0]) = (l2.at, flange.at);
    if y.abs() > NEAR || fy.abs() > NEAR || x < NEAR || fx - x < NEAR {
        return Err(
            "with all joints at zero the arm is not stretched along x; a SCARA's robot file has no offsets".to_owned()
        );
    }
    let [.., turning] = order;
    let off = all.get(turning).map_or(0.0, |line| distance(flange.at, line));
    if off > NEAR {
        return Err(format!("the flange is {:.3} mm off the axis that turns it", off * 1e3));
    }
    Ok(Scara { l1: x, l2: fx - x, z0, order })
}
