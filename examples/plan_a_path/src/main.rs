//! A path planned in Rust alone, without any ARL: a square with rounded corners, stopped once on its path. Prints a row
//! a cycle: time in s, the axes in deg, the place of the TCP in mm.
//!
//! ```sh
//! cargo run -p example-plan-a-path > path.csv
//! ```

use arl_motion::kinematics::frame_components;
use arl_motion::robot::Robot;
use arl_motion::{
    Command, Cycle, Joints, MotionRecord, Override, PlanError, Queue, Recorder, Settings, Speed, Step, Stop, Target,
    Zone,
};
use std::sync::Arc;

/// How long a cycle is.
const CYCLE: Cycle = Cycle::MS;
/// The side of the square, in mm.
const SIDE: f64 = 200.0;
/// The cycle of the square in which the robot is told to stop.
const STOPPED_IN: usize = 700;

fn main() -> Result<(), String> {
    let robot = Arc::new(Robot::builtin("kr10-r1420").map_err(|error| error.to_string())?);
    let (rows, records) = square(&robot).map_err(|error| error.to_string())?;
    for (cycle, row) in rows.iter().enumerate() {
        let [j1, j2, j3, j4, j5, j6] = row.joints.axes;
        let [x, y, z, ..] = frame_components(&row.tcp);
        let t = CYCLE.period() * cycle as f64;
        println!("{t:.3},{j1:.4},{j2:.4},{j3:.4},{j4:.4},{j5:.4},{j6:.4},{x:.3},{y:.3},{z:.3}");
    }
    for record in &records {
        eprintln!(
            "motion {}: {:.3} s, at most {:.0} {}",
            record.number, record.duration, record.reached, record.programmed.unit
        );
    }
    Ok(())
}

/// The set-points of the whole path, and what each motion did.
fn square(robot: &Arc<Robot>) -> Result<(Vec<Step>, Vec<MotionRecord>), PlanError> {
    let mut queue = Queue::repeatable(Arc::clone(robot), Joints::home(robot));
    let mut recorder = Recorder::new(Arc::clone(robot), &mut queue);
    let mut rows = Vec::new();
    let settings = Settings::default();
    let add = |queue: &mut Queue, recorder: &mut Recorder, command: &Command| {
        let number = queue.add(command, &settings)?;
        recorder.planned(queue, number, command, &settings);
        Ok(())
    };

    // To where the square begins, by the axes.
    add(&mut queue, &mut recorder, &Command::new(Target::axes([0.0, -90.0, 90.0, 0.0, 30.0, 0.0])))?;
    while !queue.idle() {
        rows.push(step(&mut queue, &mut recorder));
    }

    let [x, y, z, a, b, c] = frame_components(&queue.tcp());
    let speed = Speed { tcp: 300.0, ..Speed::FULL };
    for (line, [dx, dy]) in (1..).zip([[SIDE, 0.0], [SIDE, SIDE], [0.0, SIDE], [0.0, 0.0]]) {
        let target = Target::line([x + dx, y + dy, z, a, b, c]);
        add(&mut queue, &mut recorder, &Command { speed, zone: Zone::within(20.0), line, ..Command::new(target) })?;
    }
    for cycle in 0.. {
        if queue.idle() {
            break;
        }
        let row = step(&mut queue, &mut recorder);
        rows.push(row);
        if cycle == STOPPED_IN {
            queue.stop_on_path(Stop::General);
        } else if queue.stopped() && row.rests {
            queue.resume();
        }
    }
    Ok((rows, recorder.records().to_vec()))
}

/// Moves on by a cycle at an override of 100 %.
fn step(queue: &mut Queue, recorder: &mut Recorder) -> Step {
    let step = queue.step(CYCLE, Override::FULL);
    recorder.step(queue, &step);
    step
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_square_keeps_its_corners_speed_and_limits_and_stops_on_its_path() {
        let robot = Arc::new(Robot::builtin("kr10-r1420").unwrap());
        let (rows, records) = square(&robot).unwrap();
        let places: Vec<[f64; 3]> = rows.iter().map(|row| row.tcp.translation.vector.into()).collect();
        let start = rows.iter().position(|row| row.line == 1).unwrap();
        let [x0, y0, z0] = places[start - 1];
        for [x, y, z] in &places[start..] {
            // How far it is from the square's sides; its corners are rounded by less than the zone.
            let (dx, dy) = (x - x0, y - y0);
            let off =
                [dx.abs(), (dx - SIDE).abs(), dy.abs(), (dy - SIDE).abs()].into_iter().fold(f64::INFINITY, f64::min);
            assert!(off < 20.0 && (z - z0).abs() < 0.001, "{dx} {dy} {z}");
        }
        let last = places[places.len() - 1];
        assert!(last.iter().zip([x0, y0, z0]).all(|(end, start)| (end - start).abs() < 0.001), "{last:?}");
        assert!(records.iter().skip(1).all(|record| record.reached <= 301.0 && record.reached > 100.0), "{records:?}");
        // It rests on the way once, and at the end.
        let stops = rows[start..].windows(2).filter(|pair| !pair[0].rests && pair[1].rests).count();
        assert_eq!(stops, 2);
        for (index, axis) in robot.own_axes().iter().enumerate() {
            for pair in rows.windows(2) {
                let speed = (pair[1].joints.axes[index] - pair[0].joints.axes[index]).abs() / CYCLE.period();
                assert!(speed <= 1.001 * axis.vel, "{}: {speed}", axis.name);
            }
        }
    }
}
