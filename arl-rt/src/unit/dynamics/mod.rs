//! Inverse dynamics: the torques that the axes need for a motion, by recursive Newton-Euler over the masses of the
//! robot file and the load on the flange.
//!
//! The frames of the links. Six axes: at zero of all inner angles (see [`arl_robot::kinematics::Opw`]) every frame
//! points as the base; link 1 has its origin on axis 1 at the height of axis 2, link 2 on axis 2 in the arm's plane,
//! link 3 on axis 3, links 4 to 6 in the wrist centre. SCARA: x points along the arm; link 1 has its origin on axis 1
//! at the height of the base, link 2 on axis 2 at that height, links 3 and 4 in the flange, and link 4 points as the
//! flange.

mod load;
#[cfg(test)]
mod tests;

use nalgebra::{Matrix3, Matrix6, Vector3, Vector6};

use arl_robot::kinematics::{Axes, Frame, Kinematics, Opw, Scara, sin_cos};
use arl_robot::robot::{Link, Robot};

pub use load::Load;

/// The acceleration of free fall, m/s2.
pub const GRAVITY: f64 = 9.81;

/// A force and a torque on the robot from outside, in the base.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
pub struct Wrench {
    /// The force in N.
    pub force: Vector3<f64>,
    /// The torque in Nm about the point where the force acts.
    pub torque: Vector3<f64>,
}

impl Wrench {
    /// Torque, then force.
    fn of([tx, ty, tz, x, y, z]: [f64; 6]) -> Self {
        Self { force: Vector3::new(x, y, z), torque: Vector3::new(tx, ty, tz) }
    }
}

/// The motion of a joint.
#[derive(Clone, Copy, PartialEq, Debug)]
enum Moves {
    AboutZ,
    AboutY,
    AlongZ,
}

/// A joint, and the body that it moves.
#[derive(Clone, Copy, PartialEq, Debug)]
struct Part {
    moves: Moves,
    /// The origin in the frame of the link before, m.
    place: Vector3<f64>,
    /// kg.
    mass: f64,
    /// Mass times centre of mass, kg m.
    moment: Vector3<f64>,
    /// About the frame's origin, kg m2.
    inertia: Matrix3<f64>,
}

/// A robot's masses, prepared for computing.
#[derive(Clone, PartialEq, Debug)]
pub struct Dynamics {
    kinematics: Kinematics,
    parts: [Part; 6],
    count: usize,
    /// The last link without load.
    bare: Part,
    /// From the last link's origin to the flange, in that link's frame, m.
    flange: Vector3<f64>,
    /// The torque of the motor per torque of the axis, divided by the torque of the motor per ampere.
    amperes: [f64; 6],
    /// Minus the acceleration of free fall, in the base.
    up: Vector3<f64>,
}

/// One link in motion, all in its own frame.
#[derive(Clone, Copy)]
struct Moving {
    turning: Vector3<f64>,
    turning1: Vector3<f64>,
    acceleration: Vector3<f64>,
    /// The matrix that gives the acceleration of a point, relative to the origin, from its position.
    spread: Matrix3<f64>,
}

impl Moving {
    #[inline(always)]
    fn new(turning: Vector3<f64>, turning1: Vector3<f64>, acceleration: Vector3<f64>) -> Self {
        let (w, d) = (&turning, &turning1);
        let (xx, yy, zz) = (w.x * w.x, w.y * w.y, w.z * w.z);
        let (xy, xz, yz) = (w.x * w.y, w.x * w.z, w.y * w.z);
        #[rustfmt::skip]
        let spread = Matrix3::new(
            -yy - zz, xy - d.z, xz + d.y,
            xy + d.z, -xx - zz, yz - d.x,
            xz - d.y, yz + d.x, -xx - yy,
        );
        Self { turning, turning1, acceleration, spread }
    }
}

impl Dynamics {
    /// Takes the masses of a robot file. The robot stands upright and carries nothing. `None`: the file has no
    /// `[[link]]`.
    pub fn new(robot: &Robot) -> Option<Self> {
        let chain = chain(&robot.kinematics);
        let count = robot.links.len();
        if count == 0 {
            return None;
        }
        let nothing = Part {
            moves: Moves::AboutZ,
            place: Vector3::zeros(),
            mass: 0.0,
            moment: Vector3::zeros(),
            inertia: Matrix3::zeros(),
        };
        let (mut parts, mut amperes) = ([nothing; 6], [0.0; 6]);
        let mut bare = nothing;
        for (((part, link), (moves, place)), ampere) in parts.iter_mut().zip(&robot.links).zip(chain).zip(&mut amperes)
        {
            *part = Part { moves, place, ..nothing }.with(&Load::of_link(link), &Vector3::zeros());
            *ampere = 1.0 / (link.gear * link.torque_constant);
            bare = *part;
        }
        let flange = match &robot.kinematics {
            Kinematics::SixAxis(opw) => Vector3::new(0.0, 0.0, opw.parameters().c4 / 1000.0),
            Kinematics::Scara(_) => Vector3::zeros(),
        };
        let up = Vector3::new(0.0, 0.0, GRAVITY);
        Some(Self { kinematics: robot.kinematics.clone(), parts, count, bare, flange, amperes, up })
    }

    /// Sets the load that the flange carries from now on, in place of the one before.
    pub fn set_load(&mut self, load: &Load) {
        let loaded = self.bare.with(load, &self.flange);
        if let Some(last) = self.count.checked_sub(1).and_then(|last| self.parts.get_mut(last)) {
            *last = loaded;
        }
    }

    /// Sets the orientation of the robot's base in the world, whose z points up.
    pub fn set_base(&mut self, base: &Frame) {
        self.up = base.rotation.inverse() * Vector3::new(0.0, 0.0, GRAVITY);
    }

    /// The torques (Nm; N of a linear axis) that the motors give, at the axes, when these are at `axes` (deg, mm), move
    /// with `rates` (deg/s, mm/s) and `accelerations` (deg/s2, mm/s2), while `outside` acts on the flange, at its
    /// origin. Zero for axes that a SCARA does not have.
    pub fn torques(&self, axes: &Axes, rates: &Axes, accelerations: &Axes, outside: &Wrench) -> Axes {
        let (inner, signs) = self.inner(axes);
        let mut angles = inner;
        let mut slides = [0.0; 6];
        for (((angle, slide), part), at) in angles.iter_mut().zip(&mut slides).zip(&self.parts).zip(inner) {
            if part.moves == Moves::AlongZ {
                (*angle, *slide) = (0.0, at / 1000.0);
            }
        }
        let (sines, cosines) = sin_cos(angles);

        let rest = Vector3::zeros();
        let mut body = Moving::new(rest, rest, self.up);
        let mut turned_force = outside.force;
        let mut turned_torque = outside.torque;
        let mut forces = [(rest, rest); 6];
        let mut joints = [(0.0, 0.0); 6];
        let speeds = rates.iter().zip(accelerations).zip(signs);
        let steps = self.parts.iter().zip(sines.into_iter().zip(cosines)).zip(speeds).zip(slides).take(self.count);
        for ((((part, turn), ((rate, acceleration), sign)), slide), (force, joint)) in
            steps.zip(forces.iter_mut().zip(&mut joints))
        {
            let unit = if part.moves == Moves::AlongZ { 1e-3 } else { DEGREE };
            body = part.carry(&body, turn, rate * sign * unit, acceleration * sign * unit, slide);
            turned_force = part.moves.into_link(turn, &turned_force);
            turned_torque = part.moves.into_link(turn, &turned_torque);
            *force = part.force(&body);
            *joint = turn;
        }

        let mut torques = [0.0; 6];
        // What the last link has to hold against, and then, from link to link, what the next one needs from it.
        let (mut force, mut torque) = (-turned_force, -turned_torque - self.flange.cross(&turned_force));
        let back = self.parts.iter().zip(forces).zip(joints).zip(slides).zip(signs).zip(&mut torques).take(self.count);
        for (((((part, (own, own_torque)), turn), slide), sign), result) in back.rev() {
            force += own;
            torque += own_torque;
            *result = sign
                * match part.moves {
                    Moves::AboutZ => torque.z,
                    Moves::AboutY => torque.y,
                    Moves::AlongZ => force.z,
                };
            force = part.moves.out_of_link(turn, &force);
            torque = part.moves.out_of_link(turn, &torque) + part.place_at(slide).cross(&force);
        }
        torques
    }

    /// The currents (A) of the motors that give these torques (Nm, N) at the axes.
    pub fn currents(&self, torques: &Axes) -> Axes {
        let mut currents = *torques;
        currents.iter_mut().zip(self.amperes).for_each(|(current, amperes)| *current *= amperes);
        currents
    }

    /// The torques (Nm, N) at the axes that hold the robot against `outside`, which acts at `point` (mm, in the base).
    pub fn holding(&self, axes: &Axes, outside: &Wrench, point: &Vector3<f64>) -> Axes {
        let jacobian = self.kinematics.jacobian(axes, point);
        let metres = self.metres(jacobian);
        let Wrench { force: f, torque: t } = outside;
        (-(metres.transpose() * Vector6::new(t.x, t.y, t.z, f.x, f.y, f.z))).into()
    }

    /// The force and torque at `point` (mm, in the base) with which the robot presses on its surroundings when its axes
    /// give `surplus` (Nm, N) beyond the result of [`Dynamics::torques`] without external forces. `None` at a singular
    /// point, where they cannot be determined. Of a SCARA, which cannot turn about x and y, the torques about these
    /// axes are zero.
    pub fn pressing(&self, axes: &Axes, surplus: &Axes, point: &Vector3<f64>) -> Option<Wrench> {
        if self.kinematics.clearance(axes) < SINGULAR {
            return None;
        }
        let matrix = self.levers(axes, point);
        let found: [f64; 6] = matrix.transpose().lu().solve(&Vector6::from(*surplus))?.into();
        Some(Wrench::of(found))
    }

    /// As [`Dynamics::pressing`], but also at singular points: the smallest force and torque that would act on the axes
    /// in this way. Components that do not act on the axes there are zero.
    pub fn felt(&self, axes: &Axes, surplus: &Axes, point: &Vector3<f64>) -> Wrench {
        let matrix = self.levers(axes, point);
        let squares = matrix.transpose() * matrix + Matrix6::identity() * DAMPING;
        let solved = squares.cholesky().map(|squares| squares.solve(&Vector6::from(*surplus)));
        solved.map_or_else(Wrench::default, |solved| Wrench::of((matrix * solved).into()))
    }

    /// How far the point turns and moves (rad, m) per axis motion (rad, m).
    fn levers(&self, axes: &Axes, point: &Vector3<f64>) -> Matrix6<f64> {
        let mut matrix = self.metres(self.kinematics.jacobian(axes, point));
        if let Kinematics::Scara(_) = self.kinematics {
            // Two axes that do not exist would turn about x and y.
            (matrix[(0, 4)], matrix[(1, 5)]) = (1.0, 1.0);
        }
        matrix
    }

    /// Converts a Jacobian to velocities of the point in m; for linear axes per m.
    fn metres(&self, mut jacobian: Matrix6<f64>) -> Matrix6<f64> {
        jacobian.fixed_view_mut::<3, 6>(3, 0).scale_mut(1e-3);
        for (column, part) in self.parts.iter().enumerate() {
            if part.moves == Moves::AlongZ {
                jacobian.column_mut(column).scale_mut(1e3);
            }
        }
        jacobian
    }

    /// The joints' own angles in deg (mm), and the signs of the axes.
    fn inner(&self, axes: &Axes) -> (Axes, [f64; 6]) {
        match &self.kinematics {
            Kinematics::SixAxis(opw) => (opw.inner(axes), opw.parameters().signs),
            Kinematics::Scara(_) => (*axes, [1.0; 6]),
        }
    }
}

const DEGREE: f64 = std::f64::consts::PI / 180.0;
/// Nearer to a singular point than this (see [`Kinematics::clearance`]) forces cannot be determined from torques.
const SINGULAR: f64 = 1e-6;
/// Keeps forces finite that hardly act on the axes, in squares of levers (m).
const DAMPING: f64 = 1e-9;

impl Moves {
    /// Transforms a vector from the link before into the frame of the link that is turned by `turn`, sine and cosine.
    #[inline(always)]
    fn into_link(self, (sin, cos): (f64, f64), v: &Vector3<f64>) -> Vector3<f64> {
        self.out_of_link((-sin, cos), v)
    }

    #[inline(always)]
    fn out_of_link(self, (sin, cos): (f64, f64), v: &Vector3<f64>) -> Vector3<f64> {
        match self {
            Moves::AboutZ => Vector3::new(cos * v.x - sin * v.y, sin * v.x + cos * v.y, v.z),
            Moves::AboutY => Vector3::new(cos * v.x + sin * v.z, v.y, cos * v.z - sin * v.x),
            Moves::AlongZ => *v,
        }
    }
}

impl Part {
    /// The part with another mass fixed to it; `at` is the origin of that mass's frame, m.
    fn with(self, load: &Load, at: &Vector3<f64>) -> Self {
        let centre = at + load.centre;
        let squares = Matrix3::identity() * centre.norm_squared() - centre * centre.transpose();
        Self {
            mass: self.mass + load.mass,
            moment: self.moment + centre * load.mass,
            inertia: self.inertia + load.inertia + squares * load.mass,
            ..self
        }
    }

    fn place_at(&self, slide: f64) -> Vector3<f64> {
        self.place + Vector3::new(0.0, 0.0, slide)
    }

    /// The motion of the link whose joint is carried by `by`.
    #[inline(always)]
    fn carry(&self, by: &Moving, turn: (f64, f64), rate: f64, acceleration: f64, slide: f64) -> Moving {
        let moved = by.acceleration + by.spread * self.place_at(slide);
        let [w, w1, moved] = [by.turning, by.turning1, moved].map(|vector| self.moves.into_link(turn, &vector));
        match self.moves {
            Moves::AboutZ => {
                let carried = Vector3::new(w1.x + w.y * rate, w1.y - w.x * rate, w1.z + acceleration);
                Moving::new(Vector3::new(w.x, w.y, w.z + rate), carried, moved)
            }
            Moves::AboutY => {
                let carried = Vector3::new(w1.x - w.z * rate, w1.y + acceleration, w1.z + w.x * rate);
                Moving::new(Vector3::new(w.x, w.y + rate, w.z), carried, moved)
            }
            Moves::AlongZ => {
                let sliding = Vector3::new(2.0 * w.y * rate, -2.0 * w.x * rate, acceleration);
                Moving::new(w, w1, moved + sliding)
            }
        }
    }

    /// The force, and the torque about the frame's origin, that cause this motion of the link.
    #[inline(always)]
    fn force(&self, body: &Moving) -> (Vector3<f64>, Vector3<f64>) {
        let Moving { turning: w, turning1: w1, acceleration: a, spread } = body;
        let force = a * self.mass + spread * self.moment;
        let torque = self.inertia * w1 + w.cross(&(self.inertia * w)) + self.moment.cross(a);
        (force, torque)
    }
}

/// The motions of the joints, and the origin of each link's frame in that of the link before, m.
fn chain(kinematics: &Kinematics) -> [(Moves, Vector3<f64>); 6] {
    let at = |x: f64, y: f64, z: f64| Vector3::new(x, y, z) / 1000.0;
    match kinematics {
        Kinematics::SixAxis(opw) => six_axes(opw, at),
        Kinematics::Scara(scara) => four_axes(scara, at),
    }
}

fn six_axes(opw: &Opw, at: impl Fn(f64, f64, f64) -> Vector3<f64>) -> [(Moves, Vector3<f64>); 6] {
    let p = opw.parameters();
    [
        (Moves::AboutZ, at(0.0, 0.0, p.c1)),
        (Moves::AboutY, at(p.a1, p.b, 0.0)),
        (Moves::AboutY, at(0.0, 0.0, p.c2)),
        (Moves::AboutZ, at(p.a2, 0.0, p.c3)),
        (Moves::AboutY, at(0.0, 0.0, 0.0)),
        (Moves::AboutZ, at(0.0, 0.0, 0.0)),
    ]
}

fn four_axes(scara: &Scara, at: impl Fn(f64, f64, f64) -> Vector3<f64>) -> [(Moves, Vector3<f64>); 6] {
    let none = (Moves::AboutZ, Vector3::zeros());
    [
        (Moves::AboutZ, at(0.0, 0.0, 0.0)),
        (Moves::AboutZ, at(scara.l1, 0.0, 0.0)),
        (Moves::AlongZ, at(scara.l2, 0.0, scara.z0)),
        none,
        none,
        none,
    ]
}

impl Load {
    fn of_link(link: &Link) -> Self {
        Load::new(link.mass, link.com, link.inertia)
    }
}
