//! Motion that is suspended, and goes on.

use crate::tests::*;

const PLAIN: Start = Start { skip: 0, manual: false, line: 99 };

fn settings(round: u32) -> Settings {
    let profile = if round % 3 == 2 { VelocityProfile::O } else { VelocityProfile::S };
    Settings { profile, ..Settings::default() }
}

/// Steps until the robot rests with its motions set aside.
fn come_to_rest(queue: &mut Queue, rows: &mut Vec<Step>) {
    let from = rows.len();
    while !queue.takes(1) {
        rows.push(queue.step(Cycle::MS, Override::FULL));
        assert!(rows.len() < from + 4000, "it does not come to rest");
    }
}

/// Whether every row that belongs to these motions is a place of the undisturbed run.
fn assert_on_path(robot: &Robot, rows: &[Step], reference: &[Step], own: impl Fn(u64) -> bool) {
    let place = |row: &Step| values(robot, &row.joints);
    let places: Vec<Vec<f64>> = reference.iter().map(place).collect();
    for row in rows.iter().filter(|row| own(row.motion)).step_by(40) {
        let here = place(row);
        let distance = |pair: &[Vec<f64>]| {
            let travel: Vec<f64> = pair[1].iter().zip(&pair[0]).map(|(b, a)| b - a).collect();
            let length: f64 = travel.iter().map(|w| w * w).sum();
            let along: f64 = here.iter().zip(&pair[0]).zip(&travel).map(|((h, a), w)| (h - a) * w).sum();
            let share = if length > 0.0 { (along / length).clamp(0.0, 1.0) } else { 0.0 };
            here.iter().zip(&pair[0]).zip(&travel).map(|((h, a), w)| (h - a - w * share).abs()).fold(0.0, f64::max)
        };
        let nearest = places.windows(2).map(distance).fold(f64::INFINITY, f64::min);
        assert!(nearest < 2e-3, "{nearest} beside the path at {here:?}");
    }
}

#[test]
fn a_stop_brakes_at_once_also_before_a_blend() {
    let robot = robot("kr10-r1420");
    let mut random = Random::new(501);
    for round in 0..30 {
        let mut queue = random_chain(&robot, &mut random, &settings(round));
        let mut rows = vec![queue.step(Cycle::MS, Override::FULL)];
        let until = random.between(50.0, 3000.0) as usize;
        while !queue.idle() && rows.len() < until {
            rows.push(queue.step(Cycle::MS, Override::FULL));
        }
        queue.stop_on_path(Stop::General);
        let mut remaining = 1500;
        while !queue.rests() {
            rows.push(queue.step(Cycle::MS, Override::FULL));
            remaining -= 1;
            assert!(remaining > 0, "round {round}: it does not stop");
        }
    }
}

#[test]
fn what_is_set_aside_goes_on_where_it_was_stopped() {
    let robot = robot("kr10-r1420");
    let mut random = Random::new(502);
    for round in 0..12 {
        let queue = random_chain(&robot, &mut random, &settings(round));
        let reference = run(&mut queue.clone(), 100.0);
        let mut queue = queue;
        let planned = 10;
        let mut rows = vec![reference[0]];
        for _ in 0..(random.between(0.1, 0.9) * reference.len() as f64) as usize {
            rows.push(queue.step(Cycle::MS, Override::FULL));
        }
        let fast = round % 4 == 3;
        queue.request_suspension(if fast { Stop::Fast } else { Stop::General }, 1);
        come_to_rest(&mut queue, &mut rows);
        let stopped = *queue.joints();
        assert!(!queue.takes(0) && !queue.idle() && queue.idle_for(1));
        // Somewhere near, so that there is a straight way back.
        let mut near = stopped;
        near.axes.iter_mut().for_each(|axis| *axis += random.between(-2.0, 2.0));
        let moved = queue.add(&command(Target::Joints(near)), &settings(round)).is_ok();
        assert!(queue.start_again(PLAIN));
        assert!(!queue.start_again(PLAIN), "there is one start for each stop");
        while !queue.idle() {
            rows.push(queue.step(Cycle::MS, Override::FULL));
            assert!(rows.len() < 500_000);
            if queue.take_broken_start().is_some() {
                break;
            }
        }
        // What holds from the next motion on is told by what has ended: never more than goes on behind it.
        let is_reported_late = |pair: &&[Step]| pair[1].motion != 0 && pair[0].finished >= pair[1].motion;
        assert_eq!(rows.windows(2).find(is_reported_late), None, "round {round}");
        if !fast {
            assert_within_limits(&robot, &rows, &format!("round {round}"));
        }
        if queue.idle() {
            assert_on_path(&robot, &rows, &reference, |motion| (1..=planned).contains(&motion));
            assert!(!moved || rows.iter().any(|row| row.joints == stopped && row.motion > planned));
            assert_eq!(rows.last().unwrap().joints, reference.last().unwrap().joints, "round {round}");
        }
    }
}

#[test]
fn the_return_motion_has_its_own_tool_to_its_last_row() {
    let robot = robot("kr10-r1420");
    let [first, second] = [[0.0, 0.0, 100.0, 0.0, 0.0, 0.0], [50.0, 0.0, 150.0, 0.0, 30.0, 0.0]]
        .map(|tool| Rig { carried: Carried::Tool(frame(tool)), ..Rig::bare() });
    let mut queue = Queue::repeatable(robot.clone(), axes([0.0, -90.0, 90.0, 0.0, 45.0, 0.0]));
    let turn =
        Command { rig: first, zone: Zone { tcp: 150.0, ..Zone::NONE }, ..movej([30.0, -90.0, 90.0, 0.0, 45.0, 0.0]) };
    let lean = Command { rig: second, ..movej([30.0, -60.0, 90.0, 0.0, 45.0, 0.0]) };
    queue.add(&turn, &Settings::default()).unwrap();
    queue.add(&lean, &Settings::default()).unwrap();
    let mut rows = vec![queue.step(Cycle::MS, at(10.0))];
    // A blend belongs to the motion that it leads into; in its first half the rows still name the one before.
    while queue.progress().is_none_or(|progress| progress.motion == 1) {
        rows.push(queue.step(Cycle::MS, at(10.0)));
        assert!(rows.len() < 50_000, "there is no blend");
    }
    queue.request_suspension(Stop::General, 1);
    come_to_rest(&mut queue, &mut rows);
    assert_eq!(rows.iter().rfind(|row| row.motion != 0).map(|row| row.motion), Some(1));
    let mut near = *queue.joints();
    near.axes[5] += 5.0;
    queue.add(&command(Target::Joints(near)), &Settings::default()).unwrap();
    assert!(queue.start_again(PLAIN));
    rows.extend(run(&mut queue, 100.0));
    let back: Vec<&Step> = rows.iter().filter(|row| row.line == PLAIN.line).collect();
    assert!(back.len() > 10);
    for row in back {
        let tcp = second.tcp_at(&robot.kinematics.forward(&row.joints.axes));
        assert!((row.tcp.translation.vector - tcp.translation.vector).norm() < 1e-9, "{row:?}");
    }
}

#[test]
fn skipped_motions_are_not_gone_and_those_behind_them_are() {
    let robot = robot("kr10-r1420");
    let mut random = Random::new(503);
    let mut gone = 0;
    for round in 0..24 {
        let mut queue = random_chain(&robot, &mut random, &settings(round));
        let end = *queue.end();
        let mut rows = vec![queue.step(Cycle::MS, Override::ZERO)];
        for _ in 0..random.between(10.0, 900.0) as usize {
            rows.push(queue.step(Cycle::MS, Override::FULL));
        }
        queue.request_suspension(Stop::General, 1);
        come_to_rest(&mut queue, &mut rows);
        let (stopped, skip) = (rows.last().unwrap().motion, random.between(1.0, 4.0) as u32);
        assert!(queue.start_again(Start { skip, ..PLAIN }));
        let from = rows.len();
        while !queue.idle() && queue.take_broken_start().is_none() && queue.take_broken().is_none() {
            rows.push(queue.step(Cycle::MS, Override::FULL));
            assert!(rows.len() < 500_000);
        }
        assert_within_limits(&robot, &rows, &format!("round {round}"));
        if queue.idle() && stopped > 0 && stopped + u64::from(skip) <= 10 {
            gone += 1;
            let skipped = stopped + 1..stopped + u64::from(skip);
            assert!(rows[from..].iter().all(|row| !skipped.contains(&row.motion)), "round {round}");
            assert_eq!(rows.last().unwrap().joints, end, "round {round}");
            assert!((1..=11).all(|motion| queue.has_ended(motion)));
        }
    }
    assert!(gone > 10, "{gone}");
}

#[test]
fn stops_nest() {
    let robot = robot("kr10-r1420");
    let mut random = Random::new(504);
    let mut queue = random_chain(&robot, &mut random, &Settings::default());
    let end = *queue.end();
    let mut rows = vec![queue.step(Cycle::MS, Override::ZERO)];
    rows.extend((0..400).map(|_| queue.step(Cycle::MS, Override::FULL)));
    queue.request_suspension(Stop::General, 1);
    come_to_rest(&mut queue, &mut rows);
    let first = *queue.joints();
    let mut near = first;
    near.axes[0] += 3.0;
    let own = queue.add(&command(Target::Joints(near)), &Settings::default()).unwrap();
    rows.extend((0..20).map(|_| queue.step(Cycle::MS, Override::FULL)));
    queue.request_suspension(Stop::General, 2);
    while !queue.takes(2) {
        rows.push(queue.step(Cycle::MS, Override::FULL));
    }
    assert!(!queue.takes(1) && !queue.has_ended(own) && !queue.has_ended(own - 1));
    let inner = queue.add(&command(Target::Joints(first)), &Settings::default()).unwrap();
    assert!(queue.start_again(PLAIN) && queue.start_again(PLAIN) && !queue.start_again(PLAIN));
    while !queue.has_ended(own) {
        rows.push(queue.step(Cycle::MS, Override::FULL));
        assert!(rows.len() < 100_000);
    }
    assert!(queue.has_ended(inner) && !queue.has_ended(10));
    while !queue.idle() {
        rows.push(queue.step(Cycle::MS, Override::FULL));
        assert!(rows.len() < 500_000);
        assert_eq!(queue.take_broken_start(), None);
    }
    assert_within_limits(&robot, &rows, "nested");
    assert_eq!(*queue.joints(), end);
}

#[test]
fn dropping_leaves_the_robot_where_it_stopped() {
    let robot = robot("kr10-r1420");
    let mut random = Random::new(505);
    let mut queue = random_chain(&robot, &mut random, &Settings::default());
    for _ in 0..400 {
        queue.step(Cycle::MS, Override::FULL);
    }
    assert!(!queue.drop_suspended());
    queue.request_suspension(Stop::General, 1);
    assert!(queue.drop_suspended());
    let mut rows = Vec::new();
    while !queue.idle() {
        rows.push(queue.step(Cycle::MS, Override::FULL));
        assert!(rows.len() < 4000);
    }
    let here = *queue.joints();
    assert!(queue.takes(0) && queue.has_ended(10));
    queue.add(&command(Target::Joints(here)), &Settings::default()).unwrap();
    run(&mut queue, 100.0);
    assert_eq!(*queue.joints(), here);
}
