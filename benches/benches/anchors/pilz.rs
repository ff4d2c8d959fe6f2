//! A corner as MoveIt's Pilz planner passes it: two motions with trapezoids of speed, each from rest to rest, of which
//! the end of one and the start of the other are blended into each other over time, by a polynomial of the fifth
//! degree.

use std::error::Error;

use arl_rt::kinematics::{Axes, frame_components};
use arl_rt::robot::Robot;
use nalgebra::Vector3;

use crate::corners::{SIDE, SPEED, corner_places, points};
use crate::executed::{START, Track};

/// The motion is looked at every so many s.
const STEP: f64 = 1e-4;
/// Its path is sampled every so many mm.
const SAMPLING: f64 = 0.05;

/// How much longer such a motion takes than the optimum on its path, both without jerk limits, when it is slowed as a
/// whole until neither an axis nor the TCP is beyond its speed or acceleration.
pub(crate) fn excess(robot: &Robot, angle: f64, zone: f64) -> Result<f64, Box<dyn Error>> {
    let motion = Blended::new(robot, angle, zone);
    let count = (motion.duration / STEP).ceil() as usize;
    let step = motion.duration / count as f64;
    let mut track = Track::new(SAMPLING);
    let mut axes = START;
    let mut all: Vec<Axes> = Vec::with_capacity(count + 1);
    let first = frame_components(&robot.kinematics.forward(&START));
    for index in 0..=count {
        let travel = motion.at(index as f64 * step);
        let mut pose = first;
        pose.iter_mut().zip(travel.iter()).for_each(|(value, by)| *value += by);
        let frame = arl_rt::kinematics::frame(pose);
        axes = robot.kinematics.inverse(&frame, robot.kinematics.cfg(&START), &axes).ok_or("out of reach")?;
        all.push(axes);
        track.push(&axes, &travel);
    }
    let mut slower = motion.slower(count, step);
    for around in all.windows(3) {
        for (index, axis) in robot.own_axes().iter().enumerate() {
            let [before, here, after] = [0, 1, 2].map(|place| around[place][index]);
            let speed = (after - before).abs() / (2.0 * step);
            let acceleration = (after - 2.0 * here + before).abs() / (step * step);
            slower = slower.max(speed / axis.vel).max((acceleration / axis.acc).sqrt());
        }
    }
    let places = corner_places(track.length(), zone);
    Ok(motion.duration * slower / track.path(robot, &places, SPEED).topp2()?.duration)
}

struct Blended {
    corner: Vector3<f64>,
    /// The directions of both sides.
    sides: [Vector3<f64>; 2],
    acc: f64,
    /// When the first motion enters the zone, when the second one starts, and when it leaves the zone.
    enters: f64,
    starts: f64,
    leaves: f64,
    duration: f64,
}

impl Blended {
    fn new(robot: &Robot, angle: f64, zone: f64) -> Self {
        let [corner, end] = points(angle).map(Vector3::from);
        let acc = robot.tcp.acc;
        let single = trapezoid_duration(acc);
        // Both are the same motion, so that the way to the zone's border takes as long from the start as to the end.
        let inside = time_of(zone, acc);
        let enters = single - inside;
        Self {
            corner,
            sides: [corner.normalize(), (end - corner).normalize()],
            acc,
            enters,
            starts: enters,
            leaves: enters + inside,
            duration: enters + single,
        }
    }

    /// How much slower the TCP has to go for its speed and its acceleration along the way, which is looked at `count`
    /// times.
    fn slower(&self, count: usize, step: f64) -> f64 {
        let distance = |index: usize| (self.at((index + 1) as f64 * step) - self.at(index as f64 * step)).norm();
        let distances: Vec<f64> = (0..count).map(distance).collect();
        let fastest = distances.iter().copied().fold(0.0, f64::max) / step;
        let change = distances.windows(2).map(|pair| (pair[1] - pair[0]).abs()).fold(0.0, f64::max) / (step * step);
        (fastest / SPEED).max((change / self.acc).sqrt()).max(1.0)
    }

    /// Where the TCP is, in mm from the start.
    fn at(&self, time: f64) -> Vector3<f64> {
        let [first, second] = self.sides;
        let before = first * distance_after(time, self.acc);
        let after = self.corner + second * distance_after(time - self.starts, self.acc);
        let share = ((time - self.enters) / (self.leaves - self.enters)).clamp(0.0, 1.0);
        let blend = share * share * share * (10.0 + share * (6.0 * share - 15.0));
        before + (after - before) * blend
    }
}

/// How long one side takes from rest to rest.
fn trapezoid_duration(acc: f64) -> f64 {
    let ramp = SPEED * SPEED / acc;
    if ramp <= SIDE { SIDE / SPEED + SPEED / acc } else { 2.0 * (SIDE / acc).sqrt() }
}

/// The way on one side, in mm, after a time.
fn distance_after(time: f64, acc: f64) -> f64 {
    let whole = trapezoid_duration(acc);
    let time = time.clamp(0.0, whole);
    let ramp = (SPEED / acc).min(whole / 2.0);
    let rise = |time: f64| {
        let rising = time.min(ramp);
        0.5 * acc * rising * rising + acc * ramp * (time - rising)
    };
    if time <= whole / 2.0 { rise(time) } else { SIDE - rise(whole - time) }
}

/// How long it takes from rest to get on by a way of at most half of the side.
fn time_of(distance: f64, acc: f64) -> f64 {
    let ramp = 0.5 * SPEED * SPEED / acc;
    if distance <= ramp { (2.0 * distance / acc).sqrt() } else { SPEED / acc + (distance - ramp) / SPEED }
}
