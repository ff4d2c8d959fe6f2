//! New plans from whatever state the robot is in: a stop, another override. For us that is a problem of the one path
//! parameter, solved within the cycle that leads the robot on; rsruckig leads every axis to a target.

use std::error::Error;
use std::hint::black_box;
use std::sync::Arc;

use arl_benches::random::Random;
use arl_benches::statistics::taking_turns;
use arl_rt::kinematics::Axes;
use arl_rt::motion::{Command, Cycle, Override, Queue, Settings, Stop, Zone};
use arl_rt::robot::{Robot, VelocityProfile};
use rsruckig::prelude::*;

use crate::Rows;
use crate::changes::input;
use crate::executed::{CYCLE, joints, movej};
use crate::kinematics::random_axes;
use crate::table::{Goal, Row};

/// States that are timed, and states from which there is a new plan.
const TIMED: usize = 1000;
const STATES: usize = 1_000_000;
const ROUNDS: usize = 10;
/// So many motions wait.
const AHEAD: u64 = 4;
/// What the C++ ruckig took by what rsruckig took, measured side by side.
const CPP: f64 = 1.0 / 1.10;
/// Limits are kept but for this part.
const SLACK: f64 = 1.01;

pub(crate) fn rows() -> Rows {
    let robot = Arc::new(Robot::builtin("kr10-r1420")?);
    let mut random = Random::new(7);
    let inputs: Vec<InputParameter<6>> = (0..TIMED).map(|_| any_state(&robot, &mut random)).collect();
    let singles: Vec<InputParameter<1>> = inputs.iter().map(single).collect();
    let mut walk = Walk::new(&robot, VelocityProfile::S);
    let queues: Vec<(Queue, Override)> = (0..TIMED)
        .map(|_| {
            walk.event()?;
            let percent = [0.0, 30.0, 70.0, 100.0][(walk.random.unit() * 4.0) as usize];
            Ok((walk.queue.clone(), Override::from_percent(percent)?))
        })
        .collect::<Result<_, Box<dyn Error>>>()?;
    let each = |time: f64| time * 1e6 / TIMED as f64;
    let (ours, six) = measure(&queues, &inputs);
    let (again, one) = measure(&queues, &singles);
    let ours = each(ours.min(again));
    let (six, one) = (each(six), each(one));

    let mut walk = Walk::new(&robot, VelocityProfile::S);
    while walk.events < STATES {
        walk.event()?;
    }
    let theirs = (0..STATES).filter(|_| fails(&any_state(&robot, &mut random))).count();
    println!();
    println!(
        "replans: {TIMED} states of blended movej of kr10-r1420; ours is a whole cycle; {STATES} stops, resumes and overrides \
         in {} cycles of profile S",
        walk.cycles
    );
    println!("the highest speed, acceleration and jerk of an axis by its limit: {:.4?}", walk.highest);
    Ok(vec![
        // The goal is 1.15 of the C++ ruckig.
        Row::beside("new plan from any state (a whole cycle)", "rsruckig 3.0, 6 axes", (six, ours), "us", 1.15 * CPP),
        Row { goal: Goal::None, ..Row::beside("the same", "rsruckig 3.0, 1 axis", (one, ours), "us", 0.0) },
        Row {
            goal: Goal::AtMost(0.0),
            ..Row::beside(
                "failures from 1 000 000 states",
                "rsruckig 3.0",
                (theirs as f64, walk.failures as f64),
                "",
                0.0,
            )
        },
    ])
}

fn measure<const N: usize>(queues: &[(Queue, Override)], inputs: &[InputParameter<N>]) -> (f64, f64) {
    let mut solver = Ruckig::<N, ThrowErrorHandler>::new(None, CYCLE);
    let mut trajectory = Trajectory::new(None);
    let mut least = (f64::INFINITY, f64::INFINITY);
    for _ in 0..ROUNDS {
        let mut copies = queues.to_vec();
        let ours = || {
            for (queue, speed_override) in &mut copies {
                black_box(queue.step(Cycle::MS, *speed_override));
            }
        };
        let theirs = || {
            for input in inputs {
                let _ = black_box(solver.calculate(black_box(input), &mut trajectory));
            }
        };
        let times = taking_turns(1, ours, theirs);
        least = (least.0.min(times.0), least.1.min(times.1));
    }
    least
}

/// A robot on its way between random positions, whom something happens to every few cycles.
struct Walk {
    robot: Arc<Robot>,
    queue: Queue,
    random: Random,
    settings: Settings,
    speed_override: Override,
    /// The axes in the last cycles, the latest last.
    axes: [Axes; 4],
    added: u64,
    finished: u64,
    events: usize,
    cycles: usize,
    failures: usize,
    /// The highest speed, acceleration and jerk by their limits.
    highest: [f64; 3],
}

impl Walk {
    fn new(robot: &Arc<Robot>, profile: VelocityProfile) -> Self {
        let mut random = Random::new(11);
        let axes = random_axes(robot, &mut random);
        Self {
            robot: robot.clone(),
            queue: Queue::repeatable(robot.clone(), joints(&axes)),
            random,
            settings: Settings { profile, ..Settings::default() },
            speed_override: Override::FULL,
            axes: [axes; 4],
            added: 0,
            finished: 0,
            events: 0,
            cycles: 0,
            failures: 0,
            highest: [0.0; 3],
        }
    }

    /// Something happens, and then the robot goes on for some cycles.
    fn event(&mut self) -> Result<(), Box<dyn Error>> {
        self.events += 1;
        match (self.random.unit() * 10.0) as u32 {
            0..2 => self.queue.stop_on_path(Stop::General),
            2..7 => self.queue.resume(),
            7 => self.speed_override = Override::ZERO,
            8 => self.speed_override = Override::FULL,
            _ => self.speed_override = Override::from_percent(self.random.between(1.0, 100.0)).unwrap_or_default(),
        }
        let cycles = 1 + (self.random.unit() * self.random.unit() * 20.0) as usize;
        for _ in 0..cycles {
            self.cycle()?;
        }
        Ok(())
    }

    fn cycle(&mut self) -> Result<(), Box<dyn Error>> {
        while self.added < self.finished + AHEAD {
            let command = self.command();
            self.added = self.queue.add(&command, &self.settings)?;
        }
        let step = self.queue.step(Cycle::MS, self.speed_override);
        self.finished = step.finished;
        self.cycles += 1;
        self.axes.rotate_left(1);
        self.axes[3] = step.joints.axes;
        let mut broken = false;
        for (index, axis) in self.robot.own_axes().iter().enumerate() {
            let [a, b, c, d] = self.axes.map(|axes| axes[index]);
            let rates = [d - c, d - 2.0 * c + b, d - 3.0 * c + 3.0 * b - a];
            let mut unit = 1.0;
            for ((rate, limit), highest) in
                rates.into_iter().zip([axis.vel, axis.acc, axis.jerk]).zip(&mut self.highest)
            {
                unit *= CYCLE;
                let share = rate.abs() / unit / limit;
                broken |= share > SLACK || share.is_nan();
                *highest = highest.max(share);
            }
        }
        self.failures += usize::from(broken);
        Ok(())
    }

    fn command(&mut self) -> Command {
        let to = random_axes(&self.robot, &mut self.random);
        let percent = self.random.between(-50.0, 100.0);
        movej(&to, Zone { percent, ..Zone::NONE }, self.random.between(5.0, 100.0))
    }
}

/// Any position, speed and acceleration of all axes that can be kept within the limits, and a target.
fn any_state(robot: &Robot, random: &mut Random) -> InputParameter<6> {
    let (from, to) = (random_axes(robot, random), random_axes(robot, random));
    let mut input = input(robot, &from, &to);
    for index in 0..6 {
        let (vel, acc, jerk) = (input.max_velocity[index], input.max_acceleration[index], input.max_jerk[index]);
        let now = random.between(-1.0, 1.0) * acc;
        // The acceleration must fade before the speed is too high.
        let allowed = vel - 0.5 * now * now / jerk;
        input.current_acceleration[index] = now;
        input.current_velocity[index] = random.between(-1.0, 1.0) * allowed;
    }
    input
}

/// The first axis alone.
fn single(six: &InputParameter<6>) -> InputParameter<1> {
    let mut one = InputParameter::new(None);
    one.current_position[0] = six.current_position[0];
    one.current_velocity[0] = six.current_velocity[0];
    one.current_acceleration[0] = six.current_acceleration[0];
    one.target_position[0] = six.target_position[0];
    one.max_velocity[0] = six.max_velocity[0];
    one.max_acceleration[0] = six.max_acceleration[0];
    one.max_jerk[0] = six.max_jerk[0];
    one
}

fn fails(input: &InputParameter<6>) -> bool {
    let mut trajectory = Trajectory::new(None);
    let mut solver = Ruckig::<6, ThrowErrorHandler>::new(None, CYCLE);
    solver.calculate(input, &mut trajectory).is_err()
}
