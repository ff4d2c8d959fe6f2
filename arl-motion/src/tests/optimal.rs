//! Time laws, most of them in the profile O.

use crate::tests::blends::run_chains;
use crate::tests::stops::{change_override, stop_and_resume};
use crate::tests::*;
use crate::time_optimal::law_solver_thread::ANSWERS;

fn optimal() -> Settings {
    Settings { profile: VelocityProfile::O, ..Settings::default() }
}

fn without_jerk_limits() -> Settings {
    Settings { profile: VelocityProfile::T, ..Settings::default() }
}

fn start() -> Joints {
    axes([0.0, -90.0, 90.0, 0.0, 45.0, 0.0])
}

/// Two lines of 300 mm at 1 m/s and a corner of 90 deg between them, with a zone in mm.
fn corner(zone: f64, settings: &Settings) -> Vec<Step> {
    let robot = robot("kr10-r1420");
    let mut queue = Queue::repeatable(robot.clone(), start());
    let origin = frame_components(&robot.kinematics.forward(&start().axes));
    for (y, z) in [(300.0, 0.0), (300.0, -300.0)] {
        let mut pose = origin;
        (pose[1], pose[2]) = (origin[1] + y, origin[2] + z);
        let (speed, zone) = (Speed { tcp: 1000.0, ..fast() }, Zone { tcp: zone, ..Zone::NONE });
        queue.add(&Command { zone, speed, ..lin(pose) }, settings).unwrap();
    }
    let rows = run(&mut queue, 100.0);
    assert_within_limits_of(&robot, &rows, settings.profile, "corner");
    rows
}

#[test]
fn s_and_o_are_the_same_and_a_zone_gains_time() {
    let stop = corner(-1.0, &optimal()).len();
    for (zone, most) in [(5.0, 0.98), (20.0, 0.93), (100.0, 0.85)] {
        let [s, o] = [Settings::default(), optimal()].map(|settings| corner(zone, &settings));
        assert!(s == o, "{zone} mm");
        assert!((o.len() as f64) < most * stop as f64, "{zone} mm: {} {stop}", o.len());
    }
}

#[test]
fn without_jerk_limits_a_corner_takes_as_long_as_the_shortest_motion_along_its_path() {
    // The shortest motion within speeds and accelerations by another solver, in s (`anchors`).
    for (zone, shortest) in [(5.0, 0.810), (20.0, 0.773), (100.0, 0.699)] {
        let took = corner(zone, &without_jerk_limits()).len() as f64 * CYCLE;
        assert!(took < 1.015 * shortest, "{zone} mm: {took}");
    }
}

/// Lines of so many mm to and fro with a corner of 150 deg, the tool turned by 12 deg at every other target; how many
/// cycles they take.
fn to_and_fro(side: f64, zone: f64) -> f64 {
    let robot = robot("kr10-r1420");
    let mut queue = Queue::repeatable(robot.clone(), start());
    let origin = frame_components(&robot.kinematics.forward(&start().axes));
    let (mut pose, mut heading) = (origin, 0.0_f64);
    for index in 0..6 {
        let (sine, cosine) = heading.sin_cos();
        (pose[1], pose[2]) = (pose[1] + side * sine, pose[2] - side * cosine);
        pose[4] = origin[4] + if index % 2 == 0 { 12.0 } else { 0.0 };
        heading += 150_f64.to_radians();
        let speed = Speed { tcp: 300.0, ..fast() };
        queue.add(&Command { zone: Zone { tcp: zone, ..Zone::NONE }, speed, ..lin(pose) }, &optimal()).unwrap();
    }
    let rows = run(&mut queue, 100.0);
    assert_within_limits(&robot, &rows, &format!("{side} {zone}"));
    rows.len() as f64
}

#[test]
fn a_tool_that_turns_back_and_forth_hardly_slows_a_blend_down() {
    // The tool's speed has a kink where it turns back: its jerk would be without bounds there.
    for (side, zone, most) in [(35.0, 0.1, 1.1), (35.0, 2.0, 1.0), (60.0, 8.0, 0.95)] {
        let (blended, stopped) = (to_and_fro(side, zone), to_and_fro(side, -1.0));
        assert!(blended <= most * stopped, "{side} mm, zone {zone}: {blended} cycles, {stopped} with stops");
    }
}

#[test]
fn a_chain_that_never_stops_goes_on_from_law_to_law() {
    let robot = robot("kr10-r1420");
    let mut queue = Queue::repeatable(robot.clone(), start());
    let targets = [
        [880.0, 0.0, 966.0, 180.0, 45.0, 180.0],
        [880.0, 150.0, 866.0, 180.0, 45.0, 180.0],
        [780.0, 200.0, 866.0, 192.0, 45.0, 180.0],
        [780.0, 200.0, 966.0, 180.0, 45.0, 180.0],
        [880.0, 50.0, 966.0, 192.0, 57.0, 180.0],
        [880.0, 0.0, 900.0, 180.0, 45.0, 180.0],
    ];
    let (zone, speed) = (Zone { tcp: 50.0, ..Zone::NONE }, Speed { tcp: 900.0, ..fast() });
    let mut lines = targets.iter().cycle().take(10 * targets.len()).map(|pose| Command { zone, speed, ..lin(*pose) });
    let mut rows = run(&mut queue, 100.0);
    loop {
        while queue.has_room()
            && let Some(line) = lines.next()
        {
            queue.add(&line, &optimal()).unwrap();
        }
        if queue.idle() {
            break;
        }
        rows.push(queue.step(Cycle::MS, Override::FULL));
        assert!(rows.len() < 100_000, "it does not end");
    }
    assert_within_limits(&robot, &rows, "rounds");
    let [asked, not_found] = ANSWERS.get();
    assert!(asked > 8 && not_found == 0, "{not_found} of {asked} laws were not found");
}

#[test]
#[expect(clippy::too_many_lines, reason = "a list of chains")]
fn chains_that_laws_made_slower_than_stops_are_no_longer() {
    // The first crept behind a law that was found with lower limits; the others have laws that were found at too few
    // places.
    let chains = [
        (
            "kr10-r1420",
            [0.0, -90.0, 90.0, 0.0, 45.0, 0.0],
            300.0,
            Zone { percent: 20.0, ..Zone::NONE },
            [
                [867.919, -1.538, 1014.564, 192.0, 45.0, 180.0],
                [866.569, 6.911, 1017.666, 180.0, 45.0, 180.0],
                [867.919, 0.0, 1023.431, 180.0, 57.0, 180.0],
                [866.569, -1.538, 1014.564, 180.0, 45.0, 180.0],
                [867.919, 6.911, 1017.666, 180.0, 45.0, 192.0],
                [866.569, 0.0, 1023.431, 180.0, 45.0, 180.0],
                [867.919, -1.538, 1014.564, 192.0, 45.0, 180.0],
                [866.569, 6.911, 1017.666, 180.0, 45.0, 180.0],
            ],
        ),
        (
            "hsr065",
            [20.0, 85.0, 50.0, 10.0, 0.0, 0.0],
            900.0,
            Zone { tcp: 0.01, ..Zone::NONE },
            [
                [281.365, 402.886, 351.35, 127.0, 0.0, 0.0],
                [279.649, 394.051, 350.0, 115.0, 0.0, 0.0],
                [282.874, 402.454, 351.35, 127.0, 0.0, 0.0],
                [278.239, 394.739, 350.0, 115.0, 0.0, 0.0],
                [284.143, 401.532, 351.35, 127.0, 0.0, 0.0],
                [277.149, 395.867, 350.0, 115.0, 0.0, 0.0],
                [285.02, 400.231, 351.35, 127.0, 0.0, 0.0],
                [276.511, 397.3, 350.0, 115.0, 0.0, 0.0],
            ],
        ),
        (
            "hsr065",
            [20.0, 85.0, 50.0, 10.0, 0.0, 0.0],
            300.0,
            Zone { tcp: 0.1, ..Zone::NONE },
            [
                [290.537, 411.579, 350.0, 127.0, 0.0, 0.0],
                [273.613, 400.921, 350.0, 115.0, 0.0, 0.0],
                [282.941, 418.613, 350.0, 127.0, 0.0, 0.0],
                [266.017, 407.955, 350.0, 115.0, 0.0, 0.0],
                [275.344, 425.647, 350.0, 127.0, 0.0, 0.0],
                [258.421, 414.989, 350.0, 115.0, 0.0, 0.0],
                [267.748, 432.681, 350.0, 127.0, 0.0, 0.0],
                [250.824, 422.023, 350.0, 115.0, 0.0, 0.0],
            ],
        ),
        (
            "irb2400-10",
            [0.0, 0.0, 0.0, 0.0, 45.0, 0.0],
            900.0,
            Zone { tcp: 0.05, ..Zone::NONE },
            [
                [920.354, -27.03, 1372.661, 180.0, 45.0, 180.0],
                [915.104, 3.45, 1389.864, 180.0, 45.0, 180.0],
                [920.354, -29.554, 1378.216, 180.0, 45.0, 180.0],
                [915.104, 4.972, 1383.956, 180.0, 45.0, 180.0],
                [920.354, -30.027, 1384.298, 180.0, 45.0, 180.0],
                [915.104, 4.381, 1377.884, 180.0, 45.0, 180.0],
                [920.354, -28.39, 1390.175, 180.0, 45.0, 180.0],
                [915.104, 1.748, 1372.38, 180.0, 45.0, 180.0],
            ],
        ),
        (
            "irb2400-10",
            [0.0, 0.0, 0.0, 0.0, 45.0, 0.0],
            300.0,
            Zone { tcp: 0.1, ..Zone::NONE },
            [
                [915.104, 15.042, 1381.715, 180.0, 45.0, 180.0],
                [915.104, 8.606, 1400.651, 180.0, 45.0, 180.0],
                [915.104, 4.711, 1381.034, 180.0, 45.0, 180.0],
                [915.104, 17.893, 1396.075, 180.0, 45.0, 180.0],
                [915.104, -1.043, 1389.64, 180.0, 45.0, 180.0],
                [915.104, 18.574, 1385.745, 180.0, 45.0, 180.0],
                [915.104, 3.532, 1398.926, 180.0, 45.0, 180.0],
                [915.104, 9.968, 1379.99, 180.0, 45.0, 180.0],
            ],
        ),
    ];
    for (name, from, tcp, zone, targets) in chains {
        let robot = robot(name);
        let took = |zone: Zone| {
            let mut queue = Queue::repeatable(robot.clone(), axes(from));
            for pose in targets {
                queue.add(&Command { zone, speed: Speed { tcp, ..fast() }, ..lin(pose) }, &optimal()).unwrap();
            }
            let rows = run(&mut queue, 100.0);
            assert_within_limits(&robot, &rows, name);
            rows.len() as f64
        };
        let (blended, stopped) = (took(zone), took(Zone::NONE));
        assert!(blended <= 1.003 * stopped + 2.0, "{name} {zone:?}: {blended} cycles, {stopped} with stops");
    }
}

#[test]
fn an_even_motion_alone_has_its_closed_form() {
    let robot = robot("kr10-r1420");
    let took = |settings: &Settings| {
        let mut queue = Queue::repeatable(robot.clone(), start());
        queue.add(&movej([30.0, -80.0, 70.0, 10.0, 40.0, 20.0]), settings).unwrap();
        run(&mut queue, 100.0)
    };
    assert!(took(&optimal()) == took(&Settings::default()));
}

#[test]
fn a_zone_that_no_motion_comes_behind_costs_nothing() {
    let robot = robot("kr10-r1420");
    let took = |zone: Zone| {
        let mut queue = Queue::repeatable(robot.clone(), start());
        let motion = Command { zone, ..movej([30.0, -80.0, 70.0, 10.0, 40.0, 20.0]) };
        queue.add(&motion, &optimal()).unwrap();
        queue.conclude().unwrap();
        run(&mut queue, 100.0)
    };
    assert!(took(Zone { percent: 25.0, ..Zone::NONE }) == took(Zone::NONE));
}

#[test]
fn chains_of_all_kinds_keep_every_limit() {
    run_chains(&optimal(), 92, 3);
}

#[test]
fn stops_stay_on_the_path_and_resume() {
    stop_and_resume(&optimal(), 93, 8);
    stop_and_resume(&without_jerk_limits(), 97, 8);
}

#[test]
fn the_override_changes_time_alone() {
    change_override(&optimal(), 94, 5, |_| 300);
    change_override(&without_jerk_limits(), 98, 5, |_| 300);
}

#[test]
fn splines_flow_within_every_limit() {
    let mut random = Random::new(95);
    let robot = robot("kr10-r1420");
    for settings in [optimal(), Settings::default(), without_jerk_limits()] {
        let mut queue = Queue::repeatable(robot.clone(), start());
        let origin = frame_components(&robot.kinematics.forward(&start().axes));
        for index in 0..12 {
            let mut pose = origin;
            pose[0] += random.between(-60.0, 60.0);
            pose[1] += 40.0 * f64::from(index + 1);
            pose[2] += random.between(-60.0, 60.0);
            let target = Target::Spline { pose, wobj: Frame::identity(), external: [UNSET; 6] };
            let speed = Speed { tcp: 1000.0, ..fast() };
            queue.add(&Command { speed, ..command(target) }, &settings).unwrap();
        }
        let rows = run(&mut queue, 100.0);
        assert_within_limits_of(&robot, &rows, settings.profile, "spline");
        assert_eq!(rows.last().unwrap().finished, 12);
    }
}

/// What comes up beside motions.
#[derive(Clone, Copy, PartialEq, Debug)]
enum Event {
    Nothing,
    Stop(Stop),
    Override(f64),
}

/// A line, another one that is added while the robot is on it, and an event so many cycles later.
fn late(delay: usize, event: Event) -> (Vec<Step>, bool) {
    let robot = robot("kr10-r1420");
    let mut queue = Queue::repeatable(robot.clone(), start());
    let mut rows = vec![resting(&queue)];
    let origin = frame_components(&robot.kinematics.forward(&start().axes));
    let to = |queue: &mut Queue, y: f64, z: f64| {
        let mut pose = origin;
        (pose[1], pose[2]) = (origin[1] + y, origin[2] + z);
        let (speed, zone) = (Speed { tcp: 1000.0, ..fast() }, Zone { tcp: 50.0, ..Zone::NONE });
        queue.add(&Command { zone, speed, ..lin(pose) }, &optimal()).unwrap();
    };
    to(&mut queue, 300.0, 0.0);
    let mut percent = 100.0;
    while !queue.idle() {
        match rows.len() {
            180 => to(&mut queue, 300.0, -300.0),
            cycle if cycle == 180 + delay => match event {
                Event::Nothing => {}
                Event::Stop(stop) => queue.stop_on_path(stop),
                Event::Override(share) => percent = share,
            },
            // In the middle of a stop, or after it.
            cycle if cycle == 180 + 40 * delay => queue.resume(),
            900 => percent = 100.0,
            _ => {}
        }
        rows.push(queue.step(Cycle::MS, at(percent)));
        assert!(rows.len() < 20_000, "it does not end");
    }
    (rows, was_late(&mut queue))
}

#[test]
fn a_motion_that_comes_while_the_robot_moves_is_blended_still() {
    let (rows, late) = late(0, Event::Nothing);
    assert!(!late);
    assert_within_limits(&robot("kr10-r1420"), &rows, "late");
    let rests = rows.iter().skip_while(|row| row.motion == 0).filter(|row| row.rests).count();
    assert_eq!(rests, 1, "it rests at the end alone");
}

#[test]
fn what_comes_up_while_a_law_is_found_is_within_limits_and_the_same_each_time() {
    let robot = robot("kr10-r1420");
    let (reference, _) = late(0, Event::Nothing);
    for delay in [1, 2, 10, 18, 19, 20, 21] {
        for event in [Event::Stop(Stop::General), Event::Stop(Stop::Fast), Event::Override(20.0)] {
            let (rows, _) = late(delay, event);
            let (again, _) = late(delay, event);
            assert!(rows == again, "{delay} {event:?}: two runs differ");
            assert_eq!(rows.last().unwrap().joints, reference.last().unwrap().joints);
            if event != Event::Stop(Stop::Fast) {
                assert_within_limits(&robot, &rows, &format!("{delay} {event:?}"));
            }
        }
    }
}

#[test]
fn a_stop_and_an_override_work_at_once() {
    let speed = |rows: &[Step], cycle: usize| {
        (rows[cycle].tcp.translation.vector - rows[cycle - 1].tcp.translation.vector).norm() / CYCLE
    };
    let (reference, _) = late(0, Event::Nothing);
    // An override that changes while a law is found waits for that.
    for (event, soon) in [(Event::Stop(Stop::General), 205), (Event::Override(20.0), 255)] {
        let (rows, _) = late(5, event);
        let slower = (185..).find(|cycle| speed(&rows, *cycle) < speed(&reference, *cycle) - 1.0).unwrap();
        assert!(slower < soon, "{event:?}: slower in cycle {slower}");
    }
}

#[test]
fn a_robot_at_rest_sets_off_at_once() {
    let robot = robot("kr10-r1420");
    for percent in [100.0, 30.0] {
        for degrees in [0.001, 0.01, 0.1, 0.5, 2.0, 10.0, 60.0] {
            // Where all limits are constant, no profile is quicker than S.
            let [constant, optimal] = [Settings::default(), optimal()].map(|settings| {
                let mut queue = Queue::repeatable(robot.clone(), start());
                queue.add(&movej([degrees, -90.0, 90.0, 0.0, 45.0, 0.0]), &settings).unwrap();
                let rows = run(&mut queue, percent);
                assert_within_limits(&robot, &rows, "set off");
                rows.len()
            });
            assert!(optimal as f64 <= 1.01 * constant as f64 + 3.0, "{degrees} deg: {constant} {optimal}");
        }
    }
}

#[test]
fn a_stop_works_while_the_robot_sets_off() {
    let robot = robot("kr10-r1420");
    let motion = movej([60.0, -90.0, 90.0, 0.0, 45.0, 0.0]);
    for cycles in [1, 5, 12, 19, 20, 21] {
        for stop in [Stop::General, Stop::Fast] {
            let mut queue = Queue::repeatable(robot.clone(), start());
            queue.add(&motion, &optimal()).unwrap();
            let mut rows = vec![resting(&queue)];
            rows.extend((0..cycles).map(|_| queue.step(Cycle::MS, Override::FULL)));
            queue.stop_on_path(stop);
            while !queue.rests() {
                rows.push(queue.step(Cycle::MS, Override::FULL));
                assert!(rows.len() < 120, "{cycles} {stop:?}: it does not stop");
            }
            queue.resume();
            rows.extend(run(&mut queue, 100.0));
            if stop == Stop::General {
                assert_within_limits(&robot, &rows, "stop while setting off");
            }
            assert_eq!(rows.last().unwrap().joints, axes([60.0, -90.0, 90.0, 0.0, 45.0, 0.0]));
        }
    }
}

#[test]
fn no_law_is_found_within_a_cycle() {
    use crate::time_optimal::law_solver_thread::FOUND_HERE;
    let before = FOUND_HERE.with(std::cell::Cell::get);
    let (rows, _) = late(3, Event::Override(40.0));
    corner(20.0, &optimal());
    assert!(rows.len() > 500);
    assert_eq!(FOUND_HERE.with(std::cell::Cell::get), before);
}
