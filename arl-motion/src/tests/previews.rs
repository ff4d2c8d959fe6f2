//! Motion that is looked at before it is done.

use super::*;

#[test]
fn what_is_seen_ahead_is_what_is_done() {
    let robot = with_external_axes("kr10-r1420");
    let mut random = Random::new(5);
    for _ in 0..3 {
        let mut queue = random_chain(&robot, &mut random, &Settings::default());
        // Under way, too.
        for cycles in [0, 400] {
            for _ in 0..cycles {
                queue.step(Cycle::MS, at(80.0));
            }
            let ahead = queue.preview(Cycle::MS, at(80.0)).unwrap();
            let mut done = queue.clone();
            done.conclude().unwrap();
            let rows: Vec<Step> =
                std::iter::from_fn(|| (!done.idle()).then(|| done.step(Cycle::MS, at(80.0)))).collect();
            assert!(rows == ahead.steps()[1..], "{} rows, {} seen", rows.len(), ahead.steps().len() - 1);
            assert_eq!(ahead.duration(), std::time::Duration::from_millis(rows.len() as u64));
            assert_eq!(ahead.at(2 * ahead.duration()), *rows.last().unwrap());
            assert_eq!(ahead.steps()[0].joints, *queue.joints());
        }
    }
}

#[test]
fn between_cycles_the_motion_goes_on_smoothly() {
    let robot = robot("kr10-r1420");
    let mut queue = Queue::repeatable(robot.clone(), axes([0.0, -90.0, 90.0, 0.0, 30.0, 0.0]));
    queue.add(&movej([40.0, -80.0, 95.0, 10.0, 50.0, 30.0]), &Settings::default()).unwrap();
    let coarse = Cycle::new(std::time::Duration::from_millis(4)).unwrap();
    let [coarse, fine] = [coarse, Cycle::MS].map(|cycle| queue.preview(cycle, Override::FULL).unwrap());
    for (number, row) in (0_u32..).zip(fine.steps()) {
        let seen = coarse.at(std::time::Duration::from_millis(1) * number);
        let off = |a: &Joints, b: &Joints| a.axes.iter().zip(&b.axes).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        // A law or a ramp that is found for another cycle goes a little otherwise.
        assert!(off(&seen.joints, &row.joints) < 0.2, "{number}: {seen:?} {row:?}");
        let here = coarse.at(std::time::Duration::from_micros(1) + std::time::Duration::from_millis(1) * number);
        let travel = off(&here.joints, &seen.joints);
        assert!((travel / 1e-6 - off(&seen.velocity, &Joints::ZERO)).abs() < 1.0, "{number}: {travel}");
    }
}

#[test]
fn a_preview_ends_where_the_robot_cannot_go_on() {
    let robot = robot("kr10-r1420");
    let mut queue = Queue::repeatable(robot.clone(), axes([0.0, -90.0, 90.0, 0.0, 30.0, 0.0]));
    assert_eq!(queue.preview(Cycle::MS, Override::FULL).unwrap().steps().len(), 1);
    queue.add(&movej([40.0, -90.0, 90.0, 0.0, 30.0, 0.0]), &Settings::default()).unwrap();
    assert_eq!(queue.preview(Cycle::MS, Override::ZERO).unwrap().duration(), std::time::Duration::ZERO);
    for _ in 0..80 {
        queue.step(Cycle::MS, Override::FULL);
    }
    queue.stop_on_path(Stop::General);
    let ahead = queue.preview(Cycle::MS, Override::FULL).unwrap();
    let last = ahead.steps().last().unwrap();
    assert!(last.rests && last.joints.axes[0] > 0.0 && last.joints.axes[0] < 40.0, "{last:?}");
}

#[test]
fn at_the_end_of_a_cycle_it_is_over() {
    let robot = robot("kr10-r1420");
    let mut queue = Queue::repeatable(robot, axes([0.0, -90.0, 90.0, 0.0, 30.0, 0.0]));
    queue.add(&movej([20.0, -90.0, 90.0, 0.0, 30.0, 0.0]), &Settings::default()).unwrap();
    let ahead = queue.preview(Cycle::MS, Override::FULL).unwrap();
    for (number, step) in (0_u32..).zip(ahead.steps()) {
        assert_eq!(ahead.at(Cycle::MS.length() * number), *step, "{number}");
    }
    let most = ahead.steps().len() - 1;
    assert_eq!(queue.preview_up_to(Cycle::MS, Override::FULL, most).unwrap().steps().len(), most + 1);
    let long = queue.preview_up_to(Cycle::MS, Override::FULL, most - 1);
    assert_eq!(long.unwrap_err(), PlanError::TooLong { most: most - 1 });
}

#[test]
fn who_asks_for_no_rates_gets_the_same_positions() {
    let robot = robot("kr10-r1420");
    let mut queue = Queue::repeatable(robot, axes([0.0, -90.0, 90.0, 0.0, 30.0, 0.0]));
    queue.add(&movej([20.0, -90.0, 90.0, 0.0, 30.0, 0.0]), &Settings::default()).unwrap();
    let mut quiet = queue.clone();
    quiet.tell_rates(false);
    for _ in 0..200 {
        let (with_rates, silent) = (queue.step(Cycle::MS, Override::FULL), quiet.step(Cycle::MS, Override::FULL));
        assert_eq!(silent.joints, with_rates.joints);
        assert_eq!((silent.velocity, silent.acceleration, silent.tcp_speed), (Joints::ZERO, Joints::ZERO, 0.0));
    }
    assert!(queue.step(Cycle::MS, Override::FULL).tcp_speed > 0.0);
}
