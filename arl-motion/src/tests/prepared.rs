//! Blends that are found beside the cycle.

use crate::blend::corner::FOUND_HERE;
use crate::tests::*;

/// Whether the thread has everything in time, or nothing ever.
#[derive(Clone, Copy, PartialEq)]
enum Thread {
    Quick,
    Stuck,
}

/// A long way to begin with, then motions of a length, of the TCP or of the axes, with zones that meet or do not.
fn chain(robot: &Robot, random: &mut Random, length: f64, count: u32) -> (Joints, Vec<Command>) {
    let start = axes([0.0, -90.0, 90.0, 0.0, 45.0, 0.0]);
    let mut pose = frame_components(&robot.kinematics.forward(&start.axes));
    let mut commands = Vec::new();
    let mut heading = 0.0;
    for number in 0..count {
        heading += random.between(-0.5, 0.9);
        let distance = if number == 0 { 150.0 } else { length * random.between(0.5, 1.5) };
        (pose[1], pose[2]) =
            (pose[1] + distance * f64::sin(heading), pose[2] + distance * f64::cos(heading) - 0.3 * distance);
        let target = match random.between(0.0, 4.0) as u32 {
            0 => Target::Pose {
                pose,
                wobj: Frame::identity(),
                wanted: Wanted { cfg: None, turn: -1 },
                external: [UNSET; 6],
            },
            _ => Target::Line { pose, wobj: Frame::identity(), external: [UNSET; 6] },
        };
        let zone = match random.between(0.0, 6.0) as u32 {
            0 => Zone::NONE,
            1 => Zone { tcp: 0.2 * length, ..Zone::NONE },
            _ => Zone { percent: 100.0, ..Zone::NONE },
        };
        let speed = Speed { tcp: 20.0 * length, percent: 30.0, ..fast() };
        commands.push(Command { target, zone, speed, line: number + 1, ..movej([0.0; 6]) });
    }
    (start, commands)
}

/// What each cycle did, and how many blends were looked for in cycles and when motions were added.
fn ran(
    robot: &Arc<Robot>,
    (start, commands): &(Joints, Vec<Command>),
    settings: &Settings,
    thread: Thread,
) -> (Vec<Step>, [u32; 2]) {
    let mut queue = Queue::repeatable(Arc::clone(robot), *start);
    if thread == Thread::Stuck {
        queue.prepare_nothing();
    }
    let found = || FOUND_HERE.with(std::cell::Cell::get);
    let at_rest = resting(&queue);
    let (mut rows, mut found_in) = (vec![at_rest], [0; 2]);
    let mut commands = commands.iter().peekable();
    while commands.peek().is_some() || !queue.idle() {
        let before = found();
        for _ in 0..3 {
            if queue.has_room()
                && let Some(command) = commands.next()
            {
                // What is out of reach is left out, each time.
                let _ = queue.add(command, settings);
            }
        }
        if thread == Thread::Quick {
            queue.await_prepared();
        }
        let middle = found();
        rows.push(queue.step(Cycle::MS, Override::FULL));
        found_in[0] += found() - middle;
        found_in[1] += middle - before;
        assert!(rows.len() < 500_000, "it does not end");
    }
    assert!(!was_late(&mut queue));
    (rows, found_in)
}

#[test]
fn cycles_find_no_blends_and_do_not_depend_on_the_thread() {
    let robot = robot("kr10-r1420");
    let mut random = Random::new(231);
    for profile in [VelocityProfile::S, VelocityProfile::T, VelocityProfile::O] {
        let settings = Settings { profile, ..Settings::default() };
        let mut without_thread = 0;
        for (length, count) in [(40.0, 30), (4.0, 120), (0.5, 300)] {
            let chain = chain(&robot, &mut random, length, count);
            let (rows, [in_cycles, _]) = ran(&robot, &chain, &settings, Thread::Quick);
            assert_within_limits_of(&robot, &rows, profile, &format!("{profile:?} {length}"));
            assert_eq!(in_cycles, 0, "{profile:?} {length}");
            let (same, [alone, _]) = ran(&robot, &chain, &settings, Thread::Stuck);
            assert!(rows == same, "{profile:?} {length}");
            without_thread += alone;
        }
        assert!(without_thread > 100, "{profile:?}: {without_thread}");
    }
}

#[test]
fn what_comes_in_time_is_blended_whatever_the_robot_does() {
    let mut random = Random::new(232);
    for profile in [VelocityProfile::S, VelocityProfile::T, VelocityProfile::O] {
        let settings = Settings { profile, ..Settings::default() };
        for name in ["kr10-r1420", "tx2-60"] {
            let robot = with_external_axes(name);
            for round in 0..5 {
                let mut queue = random_chain(&robot, &mut random, &settings);
                run(&mut queue, 100.0);
                assert!(!was_late(&mut queue), "{profile:?} {name} {round}");
            }
        }
    }
}

#[test]
fn motions_that_come_one_by_one_join_the_path() {
    let mut late = 0;
    let mut randoms = [Random::new(233), Random::new(239)];
    // With the other seed an offer that changes the way behind a stop is taken while a law for that way is at hand.
    for (name, which) in [("kr10-r1420", 0), ("kr6-r700", 0), ("kr10-r1420", 1), ("kr6-r700", 1)] {
        let (robot, random) = (robot(name), &mut randoms[which]);
        // So many motions every so many cycles: while the robot rests, and while laws lead it.
        for (every, together) in [(1, 1), (1, 2), (2, 1), (30, 1), (60, 1), (90, 1), (120, 1)] {
            let (start, commands) = chain(&robot, random, 40.0, 40);
            let mut queue = Queue::repeatable(Arc::clone(&robot), start);
            let mut commands = commands.iter();
            let mut rows = vec![resting(&queue)];
            while commands.len() > 0 || !queue.idle() {
                let count = match rows.len() {
                    1 if every > 2 => 6,
                    cycle if cycle % every == 0 => together,
                    _ => 0,
                };
                for command in commands.by_ref().take(count) {
                    // What is out of reach is left out.
                    let _ = queue.add(command, &Settings::default());
                }
                rows.push(queue.step(Cycle::MS, Override::FULL));
                late += u32::from(was_late(&mut queue));
                assert!(rows.len() < 100_000);
            }
            assert_within_limits(&robot, &rows, &format!("{name} {which} {every} {together}"));
        }
    }
    assert!(late <= 3, "{late} came too late");
}
