//! Six axes with a spherical wrist, described by the seven OPW lengths.
//!
//! At zero of all inner angles the arm points straight up and the flange frame is oriented like the base. Axis 1 turns
//! about z, axes 2 and 3 about y, the wrist about z, y, z. The wrist centre, seen in the plane that axis 1 turns, lies
//! `a1` in front and `c1` above the base, then `c2` along the upper arm, then `c3` along and `a2` beside the forearm;
//! the whole plane is `b` off axis 1. An axis angle is sign * (inner angle + offset).

use nalgebra::{Matrix3, Quaternion, Translation3, UnitQuaternion, Vector3};

use super::Axes;
use super::angles::{atan2, sin_cos, wrap};
use super::frame::Frame;
use super::wrist::{Hand, hand};

/// The geometry of a six-axis robot: lengths in mm, offsets in deg.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct OpwParameters {
    /// Axis 1 to axis 2, forwards.
    pub a1: f64,
    /// Axis 3 to the wrist centre, at right angles to the forearm; negative if the forearm is above axis 3.
    pub a2: f64,
    /// Sideways distance of the arm's plane from axis 1.
    pub b: f64,
    /// Base to axis 2, upwards.
    pub c1: f64,
    /// Axis 2 to axis 3.
    pub c2: f64,
    /// Axis 3 to the wrist centre, along the forearm.
    pub c3: f64,
    /// Wrist centre to flange.
    pub c4: f64,
    /// Angles of the axes at inner angles of 0, times the sign.
    pub offsets: [f64; 6],
    /// 1, or -1 if an axis turns in the opposite direction.
    pub signs: [f64; 6],
}

/// A six-axis robot's geometry, prepared for computing.
#[derive(Clone, PartialEq, Debug)]
pub struct Opw {
    parameters: OpwParameters,
    // The lengths in m.
    pub(super) a1: f64,
    pub(super) a2: f64,
    pub(super) b: f64,
    pub(super) c1: f64,
    pub(super) c2: f64,
    pub(super) c3: f64,
    pub(super) c4: f64,
    /// The straight distance from axis 3 to the wrist centre.
    k: f64,
    /// Angle between that line and the forearm, in deg.
    psi: f64,
    psi_sin_cos: (f64, f64),
    /// 1 divided by twice the product of the two arm lengths.
    by_arms: f64,
}

/// The solutions of one pose, one for each `cfg` that reaches it.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Solutions {
    axes: [Axes; 8],
    found: u8,
}

impl Solutions {
    /// The axes in deg, each within (-180, 180], in configuration `cfg` (0 to 7); `None` if it does not reach the pose.
    pub fn get(&self, cfg: u8) -> Option<&Axes> {
        if cfg < 8 && self.found & (1 << cfg) != 0 { self.axes.get(usize::from(cfg)) } else { None }
    }

    /// All solutions that reach the pose, with their `cfg`.
    pub fn iter(&self) -> impl Iterator<Item = (u8, &Axes)> {
        (0..8).filter_map(|cfg| self.get(cfg).map(|axes| (cfg, axes)))
    }
}

/// A singularity: the axes lose a direction in which they can move the flange.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Singularity {
    /// Axes 4 and 6 turn about the same line.
    Wrist,
    /// The arm is stretched, or folded upon itself.
    Elbow,
    /// The wrist centre is on axis 1.
    Shoulder,
}

/// The position of the wrist centre in the arm's plane: the two bits of `cfg` above the lowest one.
#[derive(Clone, Copy)]
struct Arm {
    front: bool,
    right: bool,
}

/// The state after axis 1 has turned the arm's plane: the wrist centre in it, relative to axis 2 (m), and sine and
/// cosine of the elbow angle, to the right, for this distance. Without meaning if it is not reached.
#[derive(Clone, Copy)]
struct Shoulder {
    reached: bool,
    sin1: f64,
    cos1: f64,
    x: f64,
    z: f64,
    /// 1 divided by the square of the distance.
    by_reach: f64,
    sine: f64,
    cosine: f64,
}

/// Sine and cosine of the inner angle of axis 2, and of the angle of the forearm that carries the wrist.
#[derive(Clone, Copy)]
struct Elbow {
    sin2: f64,
    cos2: f64,
    t23_sin_cos: (f64, f64),
}

/// The arm for `cfg / 2`, according to the table of configurations.
const ARMS: [Arm; 4] = [
    Arm { front: true, right: true },
    Arm { front: true, right: false },
    Arm { front: false, right: false },
    Arm { front: false, right: true },
];

/// A sine or length (m) below zero by at most this counts as zero.
const ZERO: f64 = 1e-9;

impl Opw {
    /// Prepares a geometry; `c2` and `c3` must be above 0, the signs 1 or -1.
    pub fn new(parameters: OpwParameters) -> Self {
        let p = &parameters;
        let m = |mm: f64| mm / 1000.0;
        let (a2, c3) = (m(p.a2), m(p.c3));
        Self {
            a1: m(p.a1),
            a2,
            b: m(p.b),
            c1: m(p.c1),
            c2: m(p.c2),
            c3,
            c4: m(p.c4),
            k: libm::hypot(a2, c3),
            psi: libm::atan2(a2, c3).to_degrees(),
            psi_sin_cos: libm::sincos(libm::atan2(a2, c3)),
            by_arms: 0.5 / (m(p.c2) * libm::hypot(a2, c3)),
            parameters,
        }
    }

    /// The geometry as given.
    pub fn parameters(&self) -> &OpwParameters {
        &self.parameters
    }

    /// Inner angles in deg.
    #[inline]
    pub fn inner(&self, axes: &Axes) -> [f64; 6] {
        let mut inner = [0.0; 6];
        let parameters = self.parameters.signs.iter().zip(&self.parameters.offsets);
        for ((inner, axis), (sign, offset)) in inner.iter_mut().zip(axes).zip(parameters) {
            *inner = axis * sign - offset;
        }
        inner
    }

    #[inline]
    fn outer(&self, inner: [f64; 6]) -> Axes {
        let mut axes = [0.0; 6];
        let parameters = self.parameters.signs.iter().zip(&self.parameters.offsets);
        for ((axis, inner), (sign, offset)) in axes.iter_mut().zip(inner).zip(parameters) {
            *axis = (inner + offset) * sign;
        }
        wrap(axes)
    }

    /// The flange's frame in the base, translation in mm.
    pub fn forward(&self, axes: &Axes) -> Frame {
        let [t1, t2, t3, t4, t5, t6] = self.inner(axes);
        // Half angles give the rotation as a quaternion; the full angles follow from them.
        let halves = [0.5 * t1, 0.5 * (t2 + t3), 0.5 * t5, 0.5 * (t4 + t6), 0.5 * (t6 - t4), t2];
        let ([h1, h23, h5, h46, h64, s2], [g1, g23, g5, g46, g64, c2]) = sin_cos(halves);
        let (s1, c1) = (2.0 * h1 * g1, 1.0 - 2.0 * h1 * h1);
        let (s23, c23) = (2.0 * h23 * g23, 1.0 - 2.0 * h23 * h23);

        let arm = Quaternion::new(g1 * g23, -h1 * h23, g1 * h23, h1 * g23);
        let wrist = Quaternion::new(g5 * g46, h5 * h64, h5 * g64, g5 * h46);
        let q = arm * wrist;
        let x = self.a1 + self.c2 * s2 + self.c3 * s23 + self.a2 * c23;
        let z = self.c1 + self.c2 * c2 + self.c3 * c23 - self.a2 * s23;
        let (reach, width) = (2.0 * self.c4, self.b);
        let position = Vector3::new(
            c1 * x - s1 * width + reach * (q.i * q.k + q.w * q.j),
            s1 * x + c1 * width + reach * (q.j * q.k - q.w * q.i),
            z + reach * (0.5 - q.i * q.i - q.j * q.j),
        );
        Frame::from_parts(Translation3::from(position * 1000.0), UnitQuaternion::new_unchecked(q))
    }

    /// The wrist centre in m.
    fn wrist_centre(&self, flange: &Frame, rotation: &Matrix3<f64>) -> Vector3<f64> {
        flange.translation.vector / 1000.0 - rotation.column(2) * self.c4
    }

    /// The angle of axis 1 that brings the wrist centre into the arm's plane, in front of or behind the axis.
    #[inline]
    fn shoulder(&self, centre: &Vector3<f64>, front: bool, near1: f64) -> Shoulder {
        let square = centre.x * centre.x + centre.y * centre.y;
        let (depth, beside) = square_root(square - self.b * self.b);
        let x = if front { depth } else { -depth };
        // If it is on axis 1, any angle of the axis is possible.
        let (sin1, cos1) = if square < 1e-20 {
            let ([sine], [cosine]) = sin_cos([near1]);
            (sine, cosine)
        } else {
            let by_square = 1.0 / square;
            ((x * centre.y - self.b * centre.x) * by_square, (x * centre.x + self.b * centre.y) * by_square)
        };
        let (x, z) = (x - self.a1, centre.z - self.c1);
        let reach = x * x + z * z;
        let cosine = (reach - self.c2 * self.c2 - self.k * self.k) * self.by_arms;
        let (sine, within) = square_root(1.0 - cosine * cosine);
        Shoulder { reached: beside && within, sin1, cos1, x, z, by_reach: 1.0 / reach, sine, cosine }
    }

    /// The angles of axes 2 and 3 that bring the wrist centre to its position in the arm's plane.
    #[inline]
    fn elbow(&self, shoulder: &Shoulder, right: bool) -> Elbow {
        let Shoulder { x, z, by_reach, sine, cosine, .. } = *shoulder;
        let sine = if right { sine } else { -sine };
        let (along, beside) = (self.c2 + self.k * cosine, self.k * sine);
        // An arm that is folded upon itself may point anywhere; upwards is chosen.
        let (sin2, cos2) = if by_reach > 1e20 {
            (0.0, 1.0)
        } else {
            ((along * x - beside * z) * by_reach, (beside * x + along * z) * by_reach)
        };
        let (sin, cos) = (sin2 * cosine + cos2 * sine, cos2 * cosine - sin2 * sine);
        let (sin_psi, cos_psi) = self.psi_sin_cos;
        Elbow { sin2, cos2, t23_sin_cos: (sin * cos_psi - cos * sin_psi, cos * cos_psi + sin * sin_psi) }
    }

    /// The lowest bit of `cfg` of the solution with a positive inner angle 5.
    fn wrist_bit(&self) -> u8 {
        let [_, _, _, _, sign5, _] = self.parameters.signs;
        u8::from(sign5 < 0.0)
    }

    /// All solutions of a pose, up to eight; axes that the pose leaves open at a singular point stay as in `near`.
    pub fn solutions(&self, flange: &Frame, near: &Axes) -> Solutions {
        let rotation = flange.rotation.to_rotation_matrix().into_inner();
        let centre = self.wrist_centre(flange, &rotation);
        let [near1, _, _, near4, _, _] = self.inner(near);
        let [front, back] = [true, false].map(|front| self.shoulder(&centre, front, near1));
        let arms = ARMS.map(|arm| {
            let shoulder = if arm.front { front } else { back };
            let elbow = self.elbow(&shoulder, arm.right);
            (shoulder, elbow, hand(&rotation, (shoulder.sin1, shoulder.cos1), elbow.t23_sin_cos, near4))
        });
        let [t1_front, t1_back, bend_front, bend_back] =
            atan2([front.sin1, back.sin1, front.sine, back.sine], [front.cos1, back.cos1, front.cosine, back.cosine]);
        let t2 = atan2(arms.map(|(_, elbow, _)| elbow.sin2), arms.map(|(_, elbow, _)| elbow.cos2));
        let t4 = atan2(arms.map(|(.., hand)| hand.t4.0), arms.map(|(.., hand)| hand.t4.1));
        let t5 = atan2(arms.map(|(.., hand)| hand.t5.0), arms.map(|(.., hand)| hand.t5.1));
        let t6 = atan2(arms.map(|(.., hand)| hand.t6.0), arms.map(|(.., hand)| hand.t6.1));

        let mut solutions = Solutions { axes: [[0.0; 6]; 8], found: 0 };
        let (pairs, _) = solutions.axes.as_chunks_mut::<2>();
        let angles = arms.iter().zip(t2).zip(t4).zip(t5).zip(t6);
        for ((arm, pair), (((((shoulder, _, hand), t2), t4), t5), t6)) in ARMS.iter().zip(pairs).zip(angles) {
            let (t1, bend) = if arm.front { (t1_front, bend_front) } else { (t1_back, bend_back) };
            let t3 = if arm.right { bend } else { -bend } - self.psi;
            let t4 = if hand.open { near4 } else { t4 };
            let positive = self.outer([t1, t2, t3, t4, t5, t6]);
            let negative = self.outer([t1, t2, t3, t4 + 180.0, -t5, t6 + 180.0]);
            *pair = if self.wrist_bit() == 0 { [positive, negative] } else { [negative, positive] };
            solutions.found = (solutions.found >> 2) | if shoulder.reached { 0b1100_0000 } else { 0 };
        }
        solutions
    }

    /// The solution of configuration `cfg`; see [`super::Kinematics::inverse`].
    pub fn inverse(&self, flange: &Frame, cfg: u8, near: &Axes) -> Option<Axes> {
        let arm = ARMS.get(usize::from(cfg >> 1))?;
        let rotation = flange.rotation.to_rotation_matrix().into_inner();
        let centre = self.wrist_centre(flange, &rotation);
        let [near1, _, _, near4, _, _] = self.inner(near);
        let flipped = cfg & 1 != self.wrist_bit();
        // Axis 4 of the flipped solution is half a turn further.
        let near4 = if flipped { near4 - 180.0 } else { near4 };
        let shoulder = self.shoulder(&centre, arm.front, near1);
        if !shoulder.reached {
            return None;
        }
        let Elbow { sin2, cos2, t23_sin_cos } = self.elbow(&shoulder, arm.right);
        let Hand { t4, t5, t6, open } = hand(&rotation, (shoulder.sin1, shoulder.cos1), t23_sin_cos, near4);
        let [t1, t2, bend, found4, t5, t6] = atan2(
            [shoulder.sin1, sin2, shoulder.sine, t4.0, t5.0, t6.0],
            [shoulder.cos1, cos2, shoulder.cosine, t4.1, t5.1, t6.1],
        );
        let t3 = if arm.right { bend } else { -bend } - self.psi;
        let t4 = if open { near4 } else { found4 };
        Some(self.outer(if flipped { [t1, t2, t3, t4 + 180.0, -t5, t6 + 180.0] } else { [t1, t2, t3, t4, t5, t6] }))
    }

    /// The configuration of a joint vector: 0 to 7.
    pub fn cfg(&self, axes: &Axes) -> u8 {
        let Stance { depth, bend, wrist } = self.stance(axes);
        let (front, right) = (depth >= -ZERO, bend >= -ZERO);
        let [_, _, _, _, sign5, _] = self.parameters.signs;
        let negative = sign5 * wrist < -ZERO;
        let pair = (0_u8..).zip(&ARMS).find(|(_, arm)| arm.front == front && arm.right == right);
        2 * pair.map_or(0, |(pair, _)| pair) + u8::from(negative)
    }

    /// How clear the axes are of a singular point, 0 to 1: the least of the sines of the wrist's middle angle and of
    /// the angle at the elbow, and of the wrist centre's distance from axis 1 as part of the arm's length.
    pub fn clearance(&self, axes: &Axes) -> f64 {
        let [wrist, elbow, shoulder] = self.clearances(axes);
        wrist.min(elbow).min(shoulder)
    }

    /// The clearances of wrist, elbow and shoulder.
    fn clearances(&self, axes: &Axes) -> [f64; 3] {
        let Stance { depth, bend, wrist } = self.stance(axes);
        [wrist.abs(), bend.abs(), depth.abs() / (self.c2 + self.k)]
    }

    /// The singularity that the axes are nearest to, by the measure of [`Opw::clearance`].
    pub fn nearest_singularity(&self, axes: &Axes) -> Singularity {
        let [wrist, elbow, shoulder] = self.clearances(axes);
        if wrist <= elbow.min(shoulder) {
            Singularity::Wrist
        } else if elbow <= shoulder {
            Singularity::Elbow
        } else {
            Singularity::Shoulder
        }
    }

    fn stance(&self, axes: &Axes) -> Stance {
        let [_, t2, t3, _, t5, _] = self.inner(axes);
        let ([s2, s23, bend, wrist], [_, c23, _, _]) = sin_cos([t2, t2 + t3, t3 + self.psi, t5]);
        Stance { depth: self.a1 + self.c2 * s2 + self.c3 * s23 + self.a2 * c23, bend, wrist }
    }

    /// The distance, in mm, of the wrist centre from the reach of the arm in any configuration.
    pub fn beyond_reach(&self, flange: &Frame) -> f64 {
        let rotation = flange.rotation.to_rotation_matrix().into_inner();
        let centre = self.wrist_centre(flange, &rotation);
        let across = libm::hypot(centre.x, centre.y);
        let beside = self.b.abs() - across;
        if beside > 0.0 {
            return beside * 1000.0;
        }
        let depth = (across * across - self.b * self.b).max(0.0).sqrt();
        let miss = |x: f64| {
            let distance = libm::hypot(x - self.a1, centre.z - self.c1);
            (distance - (self.c2 + self.k)).max((self.c2 - self.k).abs() - distance).max(0.0)
        };
        miss(depth).min(miss(-depth)) * 1000.0
    }
}

/// The distance (m) of the wrist centre in front of axis 1, the sine of the elbow angle, to the right, and the sine of
/// the wrist's middle angle.
struct Stance {
    depth: f64,
    bend: f64,
    wrist: f64,
}

/// The square root, and whether it exists; a value below zero by rounding counts as zero.
#[inline]
fn square_root(value: f64) -> (f64, bool) {
    (value.max(0.0).sqrt(), value > -1e-13)
}
