//! Stops in the profile O: how long they take at most.

use super::*;
use crate::robot::VelocityProfile;

/// How much longer a stop may take than one of the axes would alone.
const LONGER: f64 = 3.0;

#[test]
fn a_stop_takes_little_longer_than_its_axes_need() {
    let settings = Settings { profile: VelocityProfile::O, ..Settings::default() };
    // In each chain there is a place where nothing but looking for the shortest way to rest finds a short one.
    for (name, seed) in [("kr10-r1420", 13), ("kr10-r1420", 20), ("tx2-60", 16), ("irb2400-10", 16)] {
        let robot = with_external_axes(name);
        let mut random = Random::new(seed);
        let queue = random_chain(&robot, &mut random, &settings);
        let length = run(&mut queue.clone(), 100.0).len() as f64;
        for shot in 0..8 {
            let mut queue = queue.clone();
            queue.stop_on_path(Stop::General);
            let mut rows = vec![queue.step(CYCLE, 100.0)];
            queue.resume();
            rows.extend((0..random.between(2.0, 0.95 * length) as usize).map(|_| queue.step(CYCLE, 100.0)));
            let from = rows.len();
            queue.stop_on_path(Stop::General);
            while !queue.rests() {
                rows.push(queue.step(CYCLE, 100.0));
                assert!(rows.len() < 200_000, "it does not stop");
            }
            let took = (rows.len() - from) as f64 * CYCLE;
            let least = least_stop(&robot, &rows[from - 2..from]).max(0.05);
            assert!(took <= LONGER * least, "{name} {shot}: {took} s, {least} s alone");
            queue.resume();
            while !queue.idle() {
                rows.push(queue.step(CYCLE, 100.0));
                assert!(rows.len() < 200_000, "it does not end");
            }
            assert_within_limits(&robot, &rows, name);
            assert_eq!(values(&robot, &rows.last().unwrap().joints), values(&robot, queue.end()));
        }
    }
}

/// How long the slowest axis needs to come to rest by itself, in s.
fn least_stop(robot: &Robot, last: &[Step]) -> f64 {
    let [before, now] = [0, 1].map(|index| values(robot, &last[index].joints));
    let each = robot.axes.iter().zip(before.iter().zip(&now)).map(|(axis, (before, now))| {
        let speed = (now - before).abs() / CYCLE;
        if speed * axis.jerk > axis.acc * axis.acc {
            speed / axis.acc + axis.acc / axis.jerk
        } else {
            2.0 * (speed / axis.jerk).sqrt()
        }
    });
    each.fold(0.0, f64::max)
}
