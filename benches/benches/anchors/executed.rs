//! What the robot does with a row of commands, and the path that it follows, as a geometry that others can time.

use std::error::Error;
use std::sync::Arc;

use arl_rt::kinematics::{Axes, Frame, frame_components};
use arl_rt::motion::frames::Rig;
use arl_rt::motion::{Command, Cycle, Joints, Override, Queue, Settings, Speed, Target, UNSET, Zone};
use arl_rt::robot::{Axis, Robot};
use nalgebra::Vector3;

use crate::path::Path;

/// s.
pub(crate) const CYCLE: f64 = 0.001;
/// Where the robot starts.
pub(crate) const START: Axes = [0.0, -90.0, 90.0, 0.0, 45.0, 0.0];
/// So many samples give the derivatives at a place.
const STENCIL: usize = 7;

/// `lin` to points that are given in mm from where the TCP is at the start; all at one speed in mm/s.
pub(crate) fn lines<P: IntoIterator<Item = [f64; 3]>>(
    robot: &Robot,
    points: P,
    zone: Zone,
    speed: f64,
) -> impl Iterator<Item = Command> + use<P> {
    let [x, y, z, a, b, c] = frame_components(&robot.kinematics.forward(&START));
    points.into_iter().map(move |[dx, dy, dz]| {
        let pose = [x + dx, y + dy, z + dz, a, b, c];
        command(Target::Line { pose, wobj: Frame::identity(), external: [UNSET; 6] }, zone, speed, 100.0)
    })
}

/// A command at a speed in mm/s and percent of the axes' speeds.
pub(crate) fn command(target: Target, zone: Zone, tcp: f64, percent: f64) -> Command {
    let speed = Speed { percent, tcp, ori: 1e4, exj: 1e4, exl: 1e4 };
    Command { target, rig: Rig::bare(), speed, duration: None, zone, line: 1 }
}

/// `movej` to a position of the axes.
pub(crate) fn movej(axes: &Axes, zone: Zone, percent: f64) -> Command {
    command(Target::Joints(joints(axes)), zone, 1e4, percent)
}

/// The robot's own axes alone.
pub(crate) fn joints(axes: &Axes) -> Joints {
    Joints { axes: *axes, external: [UNSET; 6] }
}

/// A queue whose robot is at the start.
pub(crate) fn queue(robot: &Arc<Robot>) -> Queue {
    Queue::repeatable(robot.clone(), joints(&START))
}

/// Executes the commands, and tells the axes and the TCP at the start and after each cycle.
pub(crate) fn execute(
    robot: &Arc<Robot>,
    commands: impl IntoIterator<Item = Command>,
    settings: &Settings,
    speed_override: Override,
    mut tell: impl FnMut(&Axes, &Vector3<f64>),
) -> Result<(), Box<dyn Error>> {
    let mut queue = queue(robot);
    let mut commands = commands.into_iter().peekable();
    tell(&queue.joints().axes, &queue.tcp().translation.vector);
    while commands.peek().is_some() || !queue.idle() {
        while queue.has_room()
            && let Some(command) = commands.next()
        {
            queue.add(&command, settings)?;
        }
        let step = queue.step(Cycle::MS, speed_override);
        tell(&step.joints.axes, &step.tcp.translation.vector);
    }
    Ok(())
}

/// How long the robot takes, in s.
pub(crate) fn duration(
    robot: &Arc<Robot>,
    commands: impl IntoIterator<Item = Command>,
    settings: &Settings,
) -> Result<f64, Box<dyn Error>> {
    let mut cycles = -1.0;
    execute(robot, commands, settings, Override::FULL, |_, _| cycles += 1.0)?;
    Ok(cycles * CYCLE)
}

/// A path in space, in mm and deg: the axes over the length of the TCP's way.
pub(crate) struct Track {
    /// Samples are at least this far apart, in mm.
    closest: f64,
    along: Vec<f64>,
    axes: Vec<Axes>,
    last: Option<Vector3<f64>>,
}

impl Track {
    /// No samples yet; later ones are skipped that are closer together than so many mm.
    pub(crate) fn new(closest: f64) -> Self {
        Self { closest, along: Vec::new(), axes: Vec::new(), last: None }
    }

    /// The path that the robot follows, looked at about every `closest` mm; `speed` in mm/s is what is programmed.
    pub(crate) fn followed(
        robot: &Arc<Robot>,
        commands: impl IntoIterator<Item = Command>,
        settings: &Settings,
        (closest, speed): (f64, f64),
    ) -> Result<Self, Box<dyn Error>> {
        let mut track = Self::new(closest);
        let speed_override = Override::from_percent((100.0 * closest / (speed * CYCLE)).min(100.0))?;
        execute(robot, commands, settings, speed_override, |axes, tcp| track.push(axes, tcp))?;
        Ok(track)
    }

    /// Goes on to where the TCP is at `tcp`.
    pub(crate) fn push(&mut self, axes: &Axes, tcp: &Vector3<f64>) {
        let step = self.last.map_or(0.0, |last| (tcp - last).norm());
        if self.last.is_none() || step >= 0.8 * self.closest {
            self.along.push(self.length() + step);
            self.axes.push(*axes);
            self.last = Some(*tcp);
        }
    }

    /// mm.
    pub(crate) fn length(&self) -> f64 {
        self.along.last().copied().unwrap_or(0.0)
    }

    /// The axes at `at` mm and their first three derivatives, through the nearest samples.
    pub(crate) fn jet(&self, at: f64) -> [Axes; 4] {
        let behind = self.along.partition_point(|along| *along < at);
        let first = behind.saturating_sub(STENCIL / 2 + 1).min(self.along.len().saturating_sub(STENCIL));
        let samples = first..(first + STENCIL).min(self.along.len());
        let mut jet = [[0.0; 6]; 4];
        for (weights, axes) in weights(at, &self.along[samples.clone()]).iter().zip(&self.axes[samples]) {
            for (order, weight) in jet.iter_mut().zip(weights) {
                order.iter_mut().zip(axes).for_each(|(sum, axis)| *sum += weight * axis);
            }
        }
        jet
    }

    /// The same as a problem for solvers, in m and rad, with the limits of lines: those of the axes, and those of the
    /// TCP along its way, whose programmed speed is in mm/s.
    pub(crate) fn path(&self, robot: &Robot, places: &[f64], speed: f64) -> Path {
        let mut path = self.axes_path(robot, places, 100.0);
        for (jet, at) in path.jets.iter_mut().zip(&path.places) {
            jet.push([*at, 1.0, 0.0, 0.0]);
        }
        let tcp = &robot.tcp;
        path.limits.push([tcp.vel.min(speed), tcp.acc, tcp.jerk].map(|limit| limit / 1e3));
        path
    }

    /// The same with the limits of motions of the axes at a programmed speed in percent.
    pub(crate) fn axes_path(&self, robot: &Robot, places: &[f64], percent: f64) -> Path {
        let mut path = Path { places: places.iter().map(|at| at / 1e3).collect(), ..Path::default() };
        for at in places {
            let jet = self.jet(*at);
            let scaled = |axis: usize| {
                let mut scale = 1.0;
                jet.map(|order| {
                    let value = order[axis].to_radians() * scale;
                    scale *= 1e3;
                    value
                })
            };
            path.jets.push((0..6).map(scaled).collect());
        }
        let limits = |axis: &Axis| [axis.vel * percent / 100.0, axis.acc, axis.jerk].map(f64::to_radians);
        path.limits = robot.own_axes().iter().map(limits).collect();
        path
    }
}

/// What each sample at `places` counts in the value at `at` and its first three derivatives (Fornberg 1988, Generation
/// of finite difference formulas on arbitrarily spaced grids).
fn weights(at: f64, places: &[f64]) -> [[f64; 4]; STENCIL] {
    let mut weights = [[0.0; 4]; STENCIL];
    weights[0][0] = 1.0;
    let mut before = 1.0;
    for (index, place) in places.iter().enumerate().skip(1) {
        let mut product = 1.0;
        for other in 0..index {
            let apart = place - places[other];
            product *= apart;
            if other == index - 1 {
                let last = weights[other];
                for order in (0..4).rev() {
                    let lower = if order > 0 { order as f64 * last[order - 1] } else { 0.0 };
                    weights[index][order] = before / product * (lower - (places[index - 1] - at) * last[order]);
                }
            }
            for order in (0..4).rev() {
                let lower = if order > 0 { order as f64 * weights[other][order - 1] } else { 0.0 };
                weights[other][order] = ((place - at) * weights[other][order] - lower) / apart;
            }
        }
        before = product;
    }
    weights
}
