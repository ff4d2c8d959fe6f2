//! A program of very many very short motions: it reaches its speed, and memory does not grow with its length.

#![allow(clippy::disallowed_methods)]

mod common;

use std::cell::RefCell;
use std::f64::consts::TAU;
use std::rc::Rc;

use arl_rt::Controller;
use arl_rt::emit::*;
use arl_rt::kinematics::Kinematics;
use arl_rt::motion::Joints;
use arl_rt::robot::Robot;
use arl_rt::robot_driver::{DriverError, Drives, Feedback, Power, RobotDriver, Setpoint, SimulatedRobot, Start};
use common::*;
use nalgebra::Vector3;

/// Where the robot stands at first.
const START: [f64; 6] = [0.0, -90.0, 90.0, 0.0, 45.0, 0.0];
/// mm, mm/s; the way is a circle.
const STEP: f64 = 0.1;
const SPEED: f64 = 1000.0;
const RADIUS: f64 = 150.0;
/// The parts of the way at both ends that the ramps may take, in mm.
const RAMP: f64 = 250.0;

/// The path of the TCP so far.
#[derive(Default)]
struct TcpPath {
    last: Option<Vector3<f64>>,
    length: f64,
    cycle: u64,
    /// The first and the last length outside the ramps, and the cycles then.
    from: Option<(f64, u64)>,
    to: Option<(f64, u64)>,
}

/// A robot that watches where it is led.
struct Watched {
    robot: SimulatedRobot,
    kinematics: Kinematics,
    whole: f64,
    path: Rc<RefCell<TcpPath>>,
}

impl RobotDriver for Watched {
    fn start(&mut self, start: &Start<'_>) -> Result<Joints, DriverError> {
        self.robot.moved_by_hand(&Joints { axes: START, ..*start.home });
        self.robot.start(start)
    }

    fn switch(&mut self, power: Power) -> Drives {
        self.robot.switch(power)
    }

    fn exchange(&mut self, setpoint: &Setpoint) -> Feedback {
        let at = self.kinematics.forward(&setpoint.position.axes).translation.vector;
        let mut path = self.path.borrow_mut();
        let step = path.last.map_or(0.0, |last| (at - last).norm());
        path.last = Some(at);
        path.cycle += 1;
        path.length += step;
        let here = (path.length, path.cycle);
        if path.length > RAMP && path.length < self.whole - RAMP {
            path.from.get_or_insert(here);
            path.to = Some(here);
        }
        self.robot.exchange(setpoint)
    }
}

/// The mean speed outside the ramps in mm/s, and the bytes that the controller held at most while the program ran.
fn run(robot: &Robot, motions: u32) -> (f64, u64) {
    let path = Rc::new(RefCell::new(TcpPath::default()));
    let watched = Watched {
        robot: SimulatedRobot::new(),
        kinematics: robot.kinematics.clone(),
        whole: f64::from(motions) * STEP,
        path: path.clone(),
    };
    let builder = Controller::builder().robot(robot.clone()).robot_driver(watched);
    let (mut controller, _) = controller(builder, move |cx| {
        Box::pin(async move {
            // The first motion has to be one of the axes.
            motion::movej(bent(0.0)).vp(100.0).run(cx).await.at(FILE, 1)?;
            let start = pose::getpose(cx, bent(0.0), Tool::default(), &cx.system().world.get()).at(FILE, 2)?;
            for index in 1..=motions {
                let (sine, cosine) = (f64::from(index) * STEP / RADIUS % TAU).sin_cos();
                let (dy, dz) = (RADIUS * sine, RADIUS * (1.0 - cosine));
                let target = pose::offset(start, 0.0, dy, dz, 0.0, 0.0, 0.0);
                motion::lin(target).vl(SPEED).sp(100.0).run(cx).await.at(FILE, 3)?;
            }
            flow::waittime(0.0).run(cx).await.at(FILE, 4)
        })
    });
    let memory = allocation_counter::measure(|| {
        assert_eq!(controller.run(), arl_rt::Outcome::Ended);
    });
    let path = path.borrow();
    let speed = path.from.zip(path.to).map(|(from, to)| (to.0 - from.0) / ((to.1 - from.1) as f64 * 0.001));
    (speed.unwrap_or(f64::NAN), memory.bytes_max)
}

/// Neither slower nor faster than programmed, and no more memory than a shorter program.
#[allow(clippy::unwrap_used, reason = "it is a test, too")]
fn check(motions: u32) {
    let robot = Robot::builtin("kr10-r1420").unwrap();
    let (_, short) = run(&robot, 10_000);
    let (speed, long) = run(&robot, motions);
    assert!((0.99 * SPEED..=1.0001 * SPEED).contains(&speed), "{speed} mm/s");
    assert!(long <= short + short / 50, "{short} bytes became {long}");
}

#[test]
fn dense_motions_reach_their_speed_in_bounded_memory() {
    check(20_000);
}

/// `cargo test --release -p arl-rt --test dense_program -- --ignored`
#[test]
#[ignore = "takes a minute without optimisation"]
fn so_do_a_hundred_thousand() {
    check(100_000);
}
