//! Chains of motions with zones, made at random: as commands, and as the program that a person would write.

use std::fmt::Write as _;
use std::sync::Arc;

use arl_benches::random::Random;
use arl_rt::kinematics::{Axes, Frame, Wanted, frame_components};
use arl_rt::motion::frames::Rig;
use arl_rt::motion::{Command, Joints, Speed, Target, UNSET, Zone};
use arl_rt::robot::{Family, Robot, RobotError};

/// Motions of a chain.
const MOTIONS: usize = 8;
/// Lengths of sides in mm, angles of corners in deg, sizes of zones in mm (percent where beyond), speeds in mm/s.
const SIDES: [f64; 8] = [9.0, 20.0, 35.0, 60.0, 90.0, 120.0, 150.0, 200.0];
const ANGLES: [f64; 8] = [10.0, 30.0, 45.0, 60.0, 90.0, 120.0, 150.0, 170.0];
const ZONES: [f64; 10] = [0.01, 0.05, 0.1, 0.5, 1.0, 2.0, 5.0, 8.0, 20.0, 50.0];
const PERCENTS: [f64; 4] = [5.0, 20.0, 50.0, 100.0];
const SPEEDS: [f64; 4] = [100.0, 300.0, 900.0, 1500.0];
/// By so much the tool turns back and forth, in deg; and so far external axes go, in deg and mm.
const TURN: f64 = 12.0;
const EXTERNAL_TRAVELS: [f64; 2] = [10.0, 40.0];
/// External axes, one that turns and one that is linear.
const EXTERNAL_AXES: &str = "
[[axis]]
name = \"ej1\"
min = -170.0
max = 170.0
vel = 90.0
acc = 450.0
jerk = 5400.0

[[axis]]
name = \"ej2\"
linear = true
min = -800.0
max = 800.0
vel = 600.0
acc = 3000.0
jerk = 36000.0
";

/// What a chain is made of.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Kind {
    /// Lines of one length with corners of one angle.
    Corners,
    /// The same where the tool turns back and forth.
    Turning,
    /// The same where external axes go back and forth.
    External,
    /// Lines, circles and splines.
    Tool,
    /// `movej` and `ptp`.
    Axes,
    /// All of them.
    Mixed,
}

/// All kinds.
pub(crate) const ALL: [Kind; 6] = [Kind::Corners, Kind::Turning, Kind::External, Kind::Tool, Kind::Axes, Kind::Mixed];

/// In which order they come: corners, and tools that turn, twice as often as the others.
const TURNS: [Kind; 8] =
    [Kind::Corners, Kind::Turning, Kind::Corners, Kind::External, Kind::Tool, Kind::Axes, Kind::Mixed, Kind::Turning];

/// Where a motion goes.
#[derive(Clone, Copy, Debug)]
enum Goal {
    Lin([f64; 6]),
    Cir([f64; 3], [f64; 6]),
    Spl([f64; 6]),
    Movej(Axes),
    Ptp([f64; 6]),
}

/// A robot, and motions of it from rest to rest.
#[derive(Clone, Debug)]
pub(crate) struct Chain {
    pub(crate) kind: Kind,
    pub(crate) robot: Arc<Robot>,
    pub(crate) start: Joints,
    /// Where motions go, with external axes.
    goals: Vec<(Goal, [f64; 2])>,
    /// mm/s, and percent of the axes' speeds.
    speed: f64,
    percent: f64,
    /// mm, or percent of the largest zone.
    pub(crate) zone: f64,
    pub(crate) is_percent: bool,
}

/// The robots that are built in, with external axes as well.
pub(crate) fn robots() -> Result<Vec<[Arc<Robot>; 2]>, RobotError> {
    let with_external = |name: &str| {
        let text = Robot::text(name).unwrap_or_default();
        let (axes, links) = text.split_once("\n[[link]]").unwrap_or((text, ""));
        let links = if links.is_empty() { String::new() } else { format!("\n[[link]]{links}") };
        Robot::parse(name, &format!("{axes}{EXTERNAL_AXES}{links}"))
    };
    Robot::builtin_names().map(|name| Ok([Arc::new(Robot::builtin(name)?), Arc::new(with_external(name)?)])).collect()
}

impl Chain {
    /// The chain of an index.
    pub(crate) fn new(robots: &[[Arc<Robot>; 2]], index: usize, seed: u64) -> Self {
        let mut random = Random::new(seed.wrapping_mul(1_000_003).wrapping_add(index as u64));
        // The first numbers of neighbouring seeds are as good as any.
        let kind = TURNS[index % TURNS.len()];
        let [bare, external] = &robots[index / TURNS.len() % robots.len()];
        let robot = if kind == Kind::External { external } else { bare };
        let axes = start(robot);
        let mut grower =
            Grower { robot, random: &mut random, pose: frame_components(&robot.kinematics.forward(&axes)) };
        let goals = grower.goals(kind, &axes);
        let is_percent = grower.random.unit() < 0.25;
        let zone = if is_percent { grower.of(&PERCENTS) } else { grower.of(&ZONES) };
        let (speed, percent) = (grower.of(&SPEEDS), grower.random.between(20.0, 100.0).round());
        let start = Joints { axes, external: if kind == Kind::External { [0.0; 6] } else { [UNSET; 6] } };
        Self { kind, robot: Arc::clone(robot), start, goals, speed, percent, zone, is_percent }
    }

    /// Its motions, with their zones or with exact stops.
    pub(crate) fn commands(&self, zones: bool) -> impl Iterator<Item = Command> + use<'_> {
        let zone = match (zones, self.is_percent) {
            (false, _) => Zone::NONE,
            (true, true) => Zone { percent: self.zone, ..Zone::NONE },
            (true, false) => Zone::within(self.zone),
        };
        let speed = Speed { percent: self.percent, tcp: self.speed, ori: 360.0, exj: 90.0, exl: 600.0 };
        self.goals.iter().enumerate().map(move |(index, (goal, [first, second]))| {
            let external = match self.kind {
                Kind::External => [*first, *second, UNSET, UNSET, UNSET, UNSET],
                _ => [UNSET; 6],
            };
            let wobj = Frame::identity();
            let target = match *goal {
                Goal::Lin(pose) => Target::Line { pose, wobj, external },
                Goal::Cir(via, pose) => Target::Arc { via, pose, wobj, angle: None, follow: false, external },
                Goal::Spl(pose) => Target::Spline { pose, wobj, external },
                Goal::Movej(axes) => Target::Joints(Joints { axes, external }),
                Goal::Ptp(pose) => Target::Pose { pose, wobj, wanted: Wanted { cfg: None, turn: -1 }, external },
            };
            let line = u32::try_from(index + 1).unwrap_or(0);
            Command { target, rig: Rig::bare(), speed, duration: None, zone, line }
        })
    }

    /// It as a program.
    pub(crate) fn program(&self) -> String {
        let own = self.robot.own_axes().len();
        let joints =
            |axes: &Axes| axes.iter().take(own).map(|value| format!("{value:.3}")).collect::<Vec<String>>().join(", ");
        let with = if self.kind == Kind::External { ", with ej1 in deg and ej2 in mm" } else { "" };
        let mut text = format!("// robot {}{with}\nfunc void main()\n", self.robot.name);
        let _ = writeln!(text, "  movej j:{{{}}}\n  waittime 0", joints(&self.start.axes));
        let zone = format!("{}:{}", if self.is_percent { "sp" } else { "sl" }, self.zone);
        for (goal, external) in &self.goals {
            let [first, second] = external;
            let more =
                if self.kind == Kind::External { format!(", ej1 {first:.3}, ej2 {second:.3}") } else { String::new() };
            let pose = |[x, y, z, a, b, c]: &[f64; 6]| {
                format!("p:{{x {x:.3}, y {y:.3}, z {z:.3}, a {a:.3}, b {b:.3}, c {c:.3}{more}}}")
            };
            let (along, percent) = (format!("vl:{}", self.speed), format!("vp:{}", self.percent));
            let _ = match goal {
                Goal::Lin(to) => writeln!(text, "  lin {}, {along}, {zone}", pose(to)),
                Goal::Cir([x, y, z], to) => {
                    writeln!(text, "  cir m:{{x {x:.3}, y {y:.3}, z {z:.3}}}, {}, {along}, {zone}", pose(to))
                }
                Goal::Spl(to) => writeln!(text, "  spl {}, {along}, {zone}", pose(to)),
                Goal::Movej(axes) => writeln!(text, "  movej j:{{{}}}, {percent}, {zone}", joints(axes)),
                Goal::Ptp(to) => writeln!(text, "  ptp {}, {percent}, {zone}", pose(to)),
            };
        }
        text.push_str("endfunc\n");
        text
    }
}

/// A position in the middle of what a robot reaches, away from singular points.
fn start(robot: &Robot) -> Axes {
    match (robot.family, robot.name.as_str()) {
        (Family::Scara, "cobra600") => [10.0, 60.0, 100.0, 10.0, 0.0, 0.0],
        (Family::Scara, _) => [20.0, 85.0, 50.0, 10.0, 0.0, 0.0],
        (_, "irb2400-10") => [0.0, 0.0, 0.0, 0.0, 45.0, 0.0],
        (_, "tx2-60") => [0.0, 20.0, 90.0, 0.0, 45.0, 0.0],
        _ => [0.0, -90.0, 90.0, 0.0, 45.0, 0.0],
    }
}

struct Grower<'a> {
    robot: &'a Robot,
    random: &'a mut Random,
    pose: [f64; 6],
}

impl Grower<'_> {
    fn of(&mut self, values: &[f64]) -> f64 {
        values[(self.random.unit() * values.len() as f64) as usize]
    }

    fn is_scara(&self) -> bool {
        self.robot.family == Family::Scara
    }

    fn goals(&mut self, kind: Kind, start: &Axes) -> Vec<(Goal, [f64; 2])> {
        match kind {
            Kind::Corners | Kind::Turning | Kind::External => self.corners(kind),
            Kind::Tool | Kind::Axes | Kind::Mixed => {
                let side = self.of(&SIDES);
                (0..MOTIONS).map(|_| (self.random_goal(kind, start, side), [0.0; 2])).collect()
            }
        }
    }

    /// Lines of one length in a plane, with corners of one angle to one side or in turns to both, flat or rising and
    /// sinking.
    fn corners(&mut self, kind: Kind) -> Vec<(Goal, [f64; 2])> {
        let (side, angle) = (self.of(&SIDES), self.of(&ANGLES));
        let (zigzag, slope) = (self.random.unit() < 0.5, self.of(&[0.0, 0.0, 0.15]));
        let mut heading = self.random.between(0.0, 360.0);
        let mut at = self.pose;
        (0..MOTIONS)
            .map(|index| {
                let back = if index % 2 == 0 { 1.0 } else { -1.0 };
                let (sine, cosine) = heading.to_radians().sin_cos();
                let step = if self.is_scara() {
                    [side * cosine, side * sine, slope * side * back]
                } else {
                    [slope * side * back, side * cosine, side * sine]
                };
                at.iter_mut().zip(step).for_each(|(value, step)| *value += step);
                heading += if zigzag { angle * back } else { angle };
                if kind == Kind::Turning {
                    let component = if self.is_scara() { 3 } else { 3 + index / 2 % 3 };
                    at[component] = self.pose[component] + if index % 2 == 0 { TURN } else { 0.0 };
                }
                let external = EXTERNAL_TRAVELS.map(|travel| if index % 2 == 0 { travel } else { 0.0 });
                (Goal::Lin(at), external)
            })
            .collect()
    }

    fn random_goal(&mut self, kind: Kind, start: &Axes, side: f64) -> Goal {
        let choice = match kind {
            Kind::Tool => self.random.between(0.0, 3.0),
            Kind::Axes => self.random.between(3.0, 5.0),
            _ => self.random.between(0.0, 5.0),
        };
        match choice as usize {
            0 => Goal::Lin(self.place(side)),
            1 => {
                let [x, y, z, ..] = self.place(side);
                Goal::Cir([x, y, z], self.place(side))
            }
            2 => Goal::Spl(self.place(side)),
            3 => {
                let mut axes = *start;
                let range = 0.3 * side;
                let own = self.robot.own_axes().len();
                axes.iter_mut().take(own).for_each(|axis| *axis += self.random.between(-range, range));
                Goal::Movej(axes)
            }
            _ => Goal::Ptp(self.place(side)),
        }
    }

    /// A pose near the start.
    fn place(&mut self, side: f64) -> [f64; 6] {
        let mut pose = self.pose;
        for value in pose.iter_mut().take(3) {
            *value += self.random.between(-side, side);
        }
        let angles = if self.is_scara() { 3..4 } else { 3..6 };
        for value in pose.get_mut(angles).into_iter().flatten() {
            *value += self.random.between(-TURN, TURN);
        }
        pose
    }
}
