//! How long stops take at most, in all profiles.

use crate::tests::*;

/// How many times as long a stop may take as one of the axes would alone, with limited jerk.
fn longest(profile: VelocityProfile) -> f64 {
    if profile == VelocityProfile::T { 2.0 } else { 4.2 }
}

/// Chains of which most have a place where nothing but looking for the shortest way to rest finds a short one.
const CHAINS: [(VelocityProfile, [(&str, u64); 4]); 3] = [
    (VelocityProfile::O, [("kr10-r1420", 13), ("kr10-r1420", 20), ("tx2-60", 16), ("irb2400-10", 16)]),
    (VelocityProfile::S, [("kr10-r1420", 13), ("kr10-r1420", 4), ("tx2-60", 1), ("irb2400-10", 2)]),
    (VelocityProfile::T, [("kr10-r1420", 10), ("kr10-r1420", 12), ("irb2400-10", 2), ("irb2400-10", 13)]),
];

#[test]
fn a_stop_takes_little_longer_than_its_axes_need() {
    for Chain { profile, robot, queue, length, mut random } in chains() {
        for shot in 0..8 {
            let mut queue = queue.clone();
            let mut rows = go_on(&mut queue, random.between(2.0, 0.95 * length));
            let from = rows.len();
            queue.stop_on_path(Stop::General);
            while !queue.rests() {
                rows.push(queue.step(Cycle::MS, Override::FULL));
                assert!(rows.len() < 200_000, "it does not stop");
            }
            let took = (rows.len() - from) as f64 * CYCLE;
            let least = least_stop(&robot, &rows[from - 2..from]).max(0.05);
            assert!(took <= longest(profile) * least, "{profile:?} {} {shot}: {took} s, {least} s alone", robot.name);
            ends_well(&robot, &mut queue, rows, profile, 1.0);
        }
    }
}

#[test]
fn a_robot_that_goes_on_amid_a_stop_keeps_to_its_path_and_limits() {
    for Chain { profile, robot, queue, length, mut random } in chains() {
        for shot in 0..8 {
            let mut queue = queue.clone();
            let mut rows = go_on(&mut queue, random.between(2.0, 0.9 * length));
            // Before a shorter stop is there and while it is under way; and harder ones in its middle.
            let stops = if shot % 2 == 0 { [Stop::General; 2] } else { [Stop::General, Stop::Fast] };
            for stop in stops {
                queue.stop_on_path(stop);
                rows.extend((0..random.between(1.0, 120.0) as usize).map(|_| queue.step(Cycle::MS, Override::FULL)));
                if shot % 4 == 0 {
                    queue.resume();
                    rows.extend(
                        (0..random.between(1.0, 200.0) as usize).map(|_| queue.step(Cycle::MS, Override::FULL)),
                    );
                }
            }
            ends_well(&robot, &mut queue, rows, profile, if shot % 2 == 0 { 1.0 } else { 5.0 });
        }
    }
}

/// Prints the table of docs/speed.md.
#[test]
#[ignore = "a measurement"]
fn stops_beside_the_slowest_axis_alone() {
    for profile in [VelocityProfile::T, VelocityProfile::S, VelocityProfile::O] {
        let mut ratios = Vec::new();
        for seed in 0..48 {
            let (mut random, robot) =
                (Random::new(seed), with_external_axes(["kr10-r1420", "tx2-60"][seed as usize % 2]));
            let queue = random_chain(&robot, &mut random, &Settings { profile, ..Settings::default() });
            let length = run(&mut queue.clone(), 100.0).len() as f64;
            for _ in 0..8 {
                let mut queue = queue.clone();
                let rows = go_on(&mut queue, random.between(2.0, 0.95 * length));
                queue.stop_on_path(Stop::General);
                let mut cycles = 0;
                while !queue.rests() {
                    queue.step(Cycle::MS, Override::FULL);
                    cycles += 1;
                }
                ratios.push(f64::from(cycles) * CYCLE / least_stop(&robot, &rows[rows.len() - 2..]).max(0.05));
            }
        }
        ratios.sort_by(f64::total_cmp);
        let slow = ratios.iter().filter(|ratio| **ratio > 2.0).count();
        let (half, worst) = (ratios[ratios.len() / 2], ratios[ratios.len() - 1]);
        println!("{profile:?}: {} stops, half {half:.2}, more than twice {slow}, worst {worst:.1}", ratios.len());
    }
}

/// Motions that have been planned, and how many cycles they take.
struct Chain {
    profile: VelocityProfile,
    robot: Arc<Robot>,
    queue: Queue,
    length: f64,
    random: Random,
}

fn chains() -> impl Iterator<Item = Chain> {
    CHAINS.into_iter().flat_map(|(profile, chains)| {
        chains.into_iter().map(move |(name, seed)| {
            let (mut random, robot) = (Random::new(seed), with_external_axes(name));
            let queue = random_chain(&robot, &mut random, &Settings { profile, ..Settings::default() });
            let length = run(&mut queue.clone(), 100.0).len() as f64;
            Chain { profile, robot, queue, length, random }
        })
    })
}

/// Sets off, and goes on for so many cycles.
fn go_on(queue: &mut Queue, cycles: f64) -> Vec<Step> {
    queue.stop_on_path(Stop::General);
    let mut rows = vec![queue.step(Cycle::MS, Override::FULL)];
    queue.resume();
    rows.extend((0..cycles as usize).map(|_| queue.step(Cycle::MS, Override::FULL)));
    rows
}

/// Goes on to the end, which is where it should be, within all limits, those of acceleration and jerk times
/// `stop_scale`.
fn ends_well(robot: &Robot, queue: &mut Queue, mut rows: Vec<Step>, profile: VelocityProfile, stop_scale: f64) {
    queue.resume();
    let count = rows.len();
    while !queue.idle() {
        rows.push(queue.step(Cycle::MS, Override::FULL));
        assert!(rows.len() < count + 200_000, "it does not end");
    }
    let used = usage(robot, &rows);
    let [vel, acc, jerk] = [used[0], used[1] / stop_scale, used[2] / stop_scale];
    let smooth = jerk <= 1.01 || profile == VelocityProfile::T;
    assert!(vel <= 1.01 && acc <= 1.01 && smooth, "{profile:?}: speed, acceleration, jerk used {used:?}");
    assert_eq!(values(robot, &rows.last().unwrap().joints), values(robot, queue.end()));
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
