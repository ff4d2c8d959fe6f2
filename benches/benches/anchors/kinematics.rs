//! How fast the closed forms of six-axis robots are, beside rs-opw-kinematics, and how exact; and how fast the inverse
//! dynamics is.

use std::hint::black_box;

use arl_benches::random::Random;
use arl_benches::statistics::taking_turns;
use arl_rt::dynamics::{Dynamics, Wrench};
use arl_rt::kinematics::{Axes, Frame, Kinematics, Opw, OpwParameters, Twist, Wanted};
use arl_rt::robot::Robot;
use nalgebra::{Quaternion, Translation3, UnitQuaternion, Vector3};
use rs_opw_kinematics::kinematic_traits::{Joints, Kinematics as _, Pose};
use rs_opw_kinematics::kinematics_impl::OPWKinematics;
use rs_opw_kinematics::parameters::opw_kinematics::Parameters;

use crate::Rows;
use crate::table::{Goal, Row};

pub(crate) const ROBOTS: [&str; 4] = ["kr10-r1420", "kr6-r700", "irb2400-10", "tx2-60"];
/// Poses of each robot that are timed, and that are checked.
const TIMED: usize = 2_000;
const CHECKED: usize = 25_000;
/// The least time of so many rounds counts.
const ROUNDS: usize = 40;
/// What the C++ opw_kinematics took for all solutions by what rs-opw-kinematics took, measured side by side.
const CPP_INVERSE: f64 = 511.0 / 3993.0;
/// What Pinocchio's rnea took, likewise.
const PINOCCHIO: f64 = 1120.0 / 3993.0;
const OPW: &str = "rs-opw-kinematics 3.0";

pub(crate) fn rows() -> Rows {
    let mut times = [Pair::default(); 4];
    let mut exact = Exactness::default();
    let (mut rates, mut torques) = (0.0, 0.0);
    for (seed, name) in ROBOTS.into_iter().enumerate() {
        let robot = Robot::builtin(name)?;
        let Kinematics::SixAxis(opw) = &robot.kinematics else { return Err(format!("{name} has not six axes").into()) };
        let other = reference(opw.parameters());
        let mut random = Random::new(seed as u64 + 1);
        let axes: Vec<Axes> = (0..CHECKED).map(|_| random_axes(&robot, &mut random)).collect();
        for axes in &axes {
            exact.check(opw, &other, axes)?;
        }
        let timed = axes.get(..TIMED).unwrap_or_default();
        let round = measure(&robot, opw, &other, timed);
        for (sum, pair) in times.iter_mut().zip(round) {
            sum.ours += pair.ours / ROBOTS.len() as f64;
            sum.other += pair.other / ROBOTS.len() as f64;
        }
        let [x, y, z] = [Vector3::x(), Vector3::y(), Vector3::z()];
        let twist = Twist::of_point(&x, &[x, y, z], &[y, z, x]);
        let solve = || each(timed, |axes| robot.kinematics.rates(axes, &twist));
        rates += best(timed.len(), solve, || ()).ours / ROBOTS.len() as f64;
        let dynamics = Dynamics::new(&robot).ok_or("no masses")?;
        let solve = || each(timed, |axes| dynamics.torques(axes, axes, axes, &Wrench::default()));
        torques += best(timed.len(), solve, || ()).ours / ROBOTS.len() as f64;
    }
    println!(
        "kinematics: the mean of {} robots, each the least of {ROUNDS} rounds of {TIMED} poses; {} poses checked, with {} \
         solutions, {} more than rs-opw finds, worst rotation {:.1e} rad",
        ROBOTS.len(),
        exact.poses,
        exact.solutions,
        exact.more,
        exact.worst_angle
    );
    let [forward, all, one, chosen] = times.map(|Pair { ours, other }| (other, ours));
    Ok(vec![
        Row::beside("forward kinematics", OPW, forward, "ns", 0.35),
        // The goal is 1.05 of the C++ opw_kinematics.
        Row::beside("inverse kinematics, all solutions", OPW, all, "ns", 1.05 * CPP_INVERSE),
        Row::beside("inverse near the last, singularity handled", OPW, one, "ns", 0.06),
        Row::beside("the same with turns and axis limits", OPW, chosen, "ns", 0.06),
        Row {
            goal: Goal::AtMost(1e-10),
            ..Row::beside("worst solution of 100 000 poses", OPW, (exact.worst_other, exact.worst), "m", 0.0)
        },
        Row::alone("solutions missing that rs-opw has", exact.missing as f64, "", Goal::AtMost(0.0)),
        Row::alone("three derivatives of the axes", rates, "ns", Goal::None),
        Row::beside("inverse dynamics", "Pinocchio, by its ratio", (all.0 * PINOCCHIO, torques), "ns", 0.5),
    ])
}

/// Times in ns.
#[derive(Clone, Copy, Default)]
struct Pair {
    ours: f64,
    other: f64,
}

fn measure(robot: &Robot, opw: &Opw, other: &OPWKinematics, axes: &[Axes]) -> [Pair; 4] {
    let frames: Vec<Frame> = axes.iter().map(|axes| opw.forward(axes)).collect();
    let cfgs: Vec<u8> = axes.iter().map(|axes| opw.cfg(axes)).collect();
    let joints: Vec<Joints> = axes.iter().map(|axes| axes.map(f64::to_radians)).collect();
    let poses: Vec<Pose> = joints.iter().map(|joints| other.forward(joints)).collect();
    let asked = || frames.iter().zip(&cfgs).zip(axes);
    let one = || {
        for ((frame, cfg), near) in asked() {
            black_box(opw.inverse(black_box(frame), *cfg, near));
        }
    };
    let chosen = || {
        for ((frame, cfg), near) in asked() {
            let wanted = Wanted { cfg: Some(*cfg), turn: -1 };
            let _ = black_box(robot.kinematics.choose(black_box(frame), wanted, robot.own_axes(), near));
        }
    };
    let continuing = || {
        for (pose, near) in poses.iter().zip(&joints) {
            black_box(other.inverse_continuing(black_box(pose), near));
        }
    };
    [
        best(axes.len(), || each(axes, |axes| opw.forward(axes)), || each(&joints, |joints| other.forward(joints))),
        best(
            axes.len(),
            || each(&frames, |frame| opw.solutions(frame, &[0.0; 6])),
            || each(&poses, |pose| other.inverse(pose)),
        ),
        best(axes.len(), one, continuing),
        best(axes.len(), chosen, continuing),
    ]
}

/// Does the work on every item, and lets the compiler leave nothing out.
fn each<T, R>(items: &[T], work: impl Fn(&T) -> R) {
    for item in items {
        black_box(work(black_box(item)));
    }
}

/// The least times a call, in ns, of both, in turns.
fn best(calls: usize, ours: impl Fn(), other: impl Fn()) -> Pair {
    let (ours, other) = taking_turns(ROUNDS, ours, other);
    let each = |time: f64| time * 1e9 / calls as f64;
    Pair { ours: each(ours), other: each(other) }
}

/// How exact the solutions are and which are missing.
#[derive(Default)]
struct Exactness {
    poses: usize,
    solutions: usize,
    worst: f64,
    worst_angle: f64,
    worst_other: f64,
    missing: usize,
    more: usize,
}

impl Exactness {
    /// Every solution of the pose at `axes` must lead back to it, and every one that the reference finds must be there.
    fn check(&mut self, opw: &Opw, other: &OPWKinematics, axes: &Axes) -> Result<(), String> {
        let pose = opw.forward(axes);
        let solutions = opw.solutions(&pose, &[0.0; 6]);
        self.poses += 1;
        for (_, found) in solutions.iter() {
            let back = opw.forward(found);
            self.worst = self.worst.max((back.translation.vector - pose.translation.vector).norm() / 1e3);
            self.worst_angle = self.worst_angle.max(back.rotation.angle_to(&pose.rotation));
            self.solutions += 1;
        }
        let reference = other.forward(&axes.map(f64::to_radians));
        let same = frame_of(&reference);
        if (same.translation.vector - pose.translation.vector).norm() > 1e-6 {
            return Err(format!("the two disagree on where {axes:?} is"));
        }
        let theirs = other.inverse(&reference);
        for found in &theirs {
            let back = frame_of(&other.forward(found));
            self.worst_other = self.worst_other.max((back.translation.vector - same.translation.vector).norm() / 1e3);
            let near = |ours: &Axes| {
                ours.iter().zip(found).all(|(ours, theirs)| {
                    let apart = (ours - theirs.to_degrees()).rem_euclid(360.0);
                    apart.min(360.0 - apart) < 1e-3
                })
            };
            self.missing += usize::from(!solutions.iter().any(|(_, ours)| near(ours)));
        }
        self.more += solutions.iter().count().saturating_sub(theirs.len());
        Ok(())
    }
}

fn frame_of(pose: &Pose) -> Frame {
    let (t, r) = (pose.translation * 1e3, pose.rotation);
    let rotation = UnitQuaternion::new_normalize(Quaternion::new(r.w, r.x, r.y, r.z));
    Frame::from_parts(Translation3::new(t.x, t.y, t.z), rotation)
}

fn reference(p: &OpwParameters) -> OPWKinematics {
    let m = |mm: f64| mm / 1e3;
    OPWKinematics::new(Parameters {
        a1: m(p.a1),
        a2: m(p.a2),
        b: m(p.b),
        c1: m(p.c1),
        c2: m(p.c2),
        c3: m(p.c3),
        c4: m(p.c4),
        offsets: p.offsets.map(f64::to_radians),
        sign_corrections: p.signs.map(|sign| sign as i8),
        dof: 6,
    })
}

pub(crate) fn random_axes(robot: &Robot, random: &mut Random) -> Axes {
    let mut axes = [0.0; 6];
    for (value, axis) in axes.iter_mut().zip(&robot.axes) {
        *value = random.between(axis.min, axis.max);
    }
    axes
}
