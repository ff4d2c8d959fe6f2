//! What a set-point tells of how the robot moves.

use super::*;

/// How far the rates of a trace are from its differences, as shares of the limits: speed, acceleration, and the TCP's
/// speed in mm/s.
fn off(robot: &Robot, rows: &[Step]) -> [f64; 3] {
    let period = Cycle::MS.period();
    let mut off = [0.0_f64; 3];
    for rows in rows.windows(3) {
        let [before, here, next] = rows else { continue };
        let [p, q, r] = [before, here, next].map(|row| values(robot, &row.joints));
        let (vel, acc) = (values(robot, &here.velocity), values(robot, &here.acceleration));
        for (index, axis) in robot.axes.iter().enumerate() {
            let speed = (r[index] - p[index]) / (2.0 * period);
            let change = (r[index] - 2.0 * q[index] + p[index]) / (period * period);
            off[0] = off[0].max((vel[index] - speed).abs() / axis.vel);
            off[1] = off[1].max((acc[index] - change).abs() / axis.acc);
        }
        let travel = next.tcp.translation.vector - before.tcp.translation.vector;
        off[2] = off[2].max((here.tcp_speed - travel.norm() / (2.0 * period)).abs());
    }
    off
}

#[test]
fn speeds_and_accelerations_are_those_of_the_trace() {
    let mut random = Random::new(77);
    for name in ["kr10-r1420", "hsr065"] {
        let robot = with_external_axes(name);
        for round in 0..6 {
            let mut queue = random_chain(&robot, &mut random, &Settings::default());
            let rows = run(&mut queue, [100.0, 40.0][round % 2]);
            let [vel, acc, tcp] = off(&robot, &rows);
            assert!(vel < 2e-3 && acc < 0.06 && tcp < 3.0, "{name} {round}: {vel} {acc} {tcp}");
            let last = rows.last().unwrap();
            assert!(last.rests && last.tcp_speed == 0.0);
            assert_eq!([last.velocity, last.acceleration], [Joints::ZERO; 2]);
            let most = rows.iter().map(|row| row.tcp_speed).fold(0.0, f64::max);
            assert!(most > 10.0, "{most}");
        }
    }
}

#[test]
fn a_stop_on_the_path_and_a_robot_put_elsewhere_have_the_rates_of_what_they_do() {
    let robot = robot("kr10-r1420");
    let mut queue = Queue::repeatable(robot.clone(), axes([0.0, -90.0, 90.0, 0.0, 30.0, 0.0]));
    queue.add(&movej([60.0, -70.0, 100.0, 20.0, 60.0, 50.0]), &Settings::default()).unwrap();
    let mut rows: Vec<Step> = (0..300).map(|_| queue.step(Cycle::MS, Override::FULL)).collect();
    assert!(rows.last().unwrap().velocity.axes[0] > 30.0);
    queue.stop_on_path(Stop::General);
    while !queue.rests() {
        rows.push(queue.step(Cycle::MS, Override::FULL));
    }
    rows.push(queue.step(Cycle::MS, Override::FULL));
    let [vel, acc, _] = off(&robot, &rows);
    assert!(vel < 2e-3 && acc < 0.06, "{vel} {acc}");
    queue.clear();
    assert!(queue.place(axes([0.0, -90.0, 90.0, 0.0, 30.0, 0.0])));
    assert_eq!(queue.step(Cycle::MS, Override::FULL).velocity, Joints::ZERO);
}
