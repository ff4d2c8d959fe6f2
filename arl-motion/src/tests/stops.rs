//! Stops and overrides: they change time and never the path.

use crate::tests::*;

fn start() -> Joints {
    axes([-60.0, -70.0, 90.0, 0.0, 45.0, 0.0])
}

/// A queue with a line and an axis motion.
fn two_motions(robot: &Arc<Robot>, settings: &Settings) -> Queue {
    let mut queue = Queue::repeatable(robot.clone(), start());
    let [x, y, ..] = frame_components(&robot.kinematics.forward(&start().axes));
    queue.add(&lin([x, -y, UNSET, UNSET, UNSET, UNSET]), settings).unwrap();
    queue.add(&movej([-60.0, -100.0, 110.0, 30.0, 60.0, 90.0]), settings).unwrap();
    queue
}

/// Every row's joints lie on the path that an undisturbed run takes.
fn assert_same_path(robot: &Robot, rows: &[Step], reference: &[Step]) {
    let place = |row: &Step| values(robot, &row.joints);
    let mut from = 1;
    for row in rows.iter().skip(1) {
        let here = place(row);
        let distance = |pair: &[Step]| {
            let (a, b) = (place(&pair[0]), place(&pair[1]));
            let travel: Vec<f64> = b.iter().zip(&a).map(|(b, a)| b - a).collect();
            let length: f64 = travel.iter().map(|w| w * w).sum();
            let along: f64 = here.iter().zip(&a).zip(&travel).map(|((h, a), w)| (h - a) * w).sum();
            let share = if length > 0.0 { (along / length).clamp(0.0, 1.0) } else { 0.0 };
            here.iter().zip(&a).zip(&travel).map(|((h, a), w)| (h - a - w * share).abs()).fold(0.0, f64::max)
        };
        // The trace only goes forwards, so the search goes on where the last row was.
        let near = reference[from - 1..].windows(2).enumerate().find(|(_, pair)| distance(pair) < 2e-4);
        match near {
            Some((found, _)) => from += found,
            None => panic!("{here:?} is not on the path"),
        }
    }
}

#[test]
fn the_override_changes_time_and_nothing_else() {
    // Some rounds move a slider, a little each cycle.
    change_override(&Settings::default(), 41, 30, |round| if round % 3 == 0 { 1 } else { 300 });
}

/// Runs at overrides that change after up to so many cycles, which `longest_stay` gives for each round.
pub(crate) fn change_override(settings: &Settings, seed: u64, rounds: u32, longest_stay: impl Fn(u32) -> u32) {
    let robot = robot("kr10-r1420");
    let motions = || two_motions(&robot, settings);
    let reference = run(&mut motions(), 100.0);
    // At a constant override everything takes longer in proportion.
    let half = run(&mut motions(), 50.0);
    // Before it goes off, a law may have to be found.
    let moves = |rows: &[Step]| rows.iter().filter(|row| row.motion > 0).count() as f64;
    let ratio = moves(&half) / moves(&reference);
    assert!((ratio - 2.0).abs() < 0.01, "{ratio}");
    assert_same_path(&robot, &half, &reference);

    let mut random = Random::new(seed);
    let mut slid = Vec::new();
    for round in 0..rounds {
        let mut queue = motions();
        let mut rows = vec![reference[0]];
        let (mut percent, mut remaining, mut due) = (100.0, 0, 0.0);
        while !queue.idle() {
            if remaining == 0 {
                let slides = longest_stay(round) == 1;
                percent = match random.between(0.0, 1.0) {
                    _ if slides => f64::clamp(percent + random.between(-3.0, 3.0), 1.0, 100.0),
                    0.0..0.2 => 0.0,
                    _ => random.between(1.0, 100.0),
                };
                remaining = random.between(1.0, f64::from(longest_stay(round)) + 0.5) as u32;
            }
            remaining -= 1;
            rows.push(queue.step(Cycle::MS, at(percent)));
            due += CYCLE * percent / 100.0;
            assert!(rows.len() < 500_000);
        }
        if longest_stay(round) == 1 {
            slid.push(due / (moves(&reference) * CYCLE));
        }
        assert_within_limits_of(&robot, &rows, settings.profile, "override");
        assert_same_path(&robot, &rows, &reference);
        assert_eq!(rows.last().unwrap().joints, reference.last().unwrap().joints);
    }
    // A slider that moves all the time costs little; once in a while a law for one of its places is not found.
    let mean = slid.iter().sum::<f64>() / slid.len() as f64;
    assert!(slid.is_empty() || (mean < 1.1 && slid.iter().all(|ratio| *ratio < 1.5)), "{slid:?}");
}

#[test]
fn an_override_that_jumps_each_cycle_breaks_no_limit() {
    let robot = robot("kr10-r1420");
    let reference = run(&mut two_motions(&robot, &Settings::default()), 100.0);
    let mut random = Random::new(43);
    for round in 0..4 {
        let mut queue = two_motions(&robot, &Settings::default());
        let mut rows = vec![reference[0]];
        while !queue.idle() {
            let jumps = (500 * round..500 * round + 3000).contains(&rows.len());
            let percent = match random.between(0.0, 1.0) {
                _ if !jumps => 100.0,
                0.0..0.2 => 0.0,
                _ => random.between(1.0, 100.0),
            };
            rows.push(queue.step(Cycle::MS, at(percent)));
            assert!(rows.len() < 100_000);
        }
        assert_within_limits(&robot, &rows, "a jumping override");
        assert_same_path(&robot, &rows, &reference);
    }
}

#[test]
fn a_lower_override_is_reached_soon() {
    let robot = robot("kr10-r1420");
    let mut queue = two_motions(&robot, &Settings::default());
    let speed = |a: &Step, b: &Step| (b.tcp.translation.vector - a.tcp.translation.vector).norm() / CYCLE;
    let mut full = queue.clone();
    let mut at_full: Vec<Step> = Vec::new();
    while !full.rests() || at_full.len() < 400 {
        at_full.push(full.step(Cycle::MS, Override::FULL));
    }
    let mut rows: Vec<Step> = Vec::new();
    for cycle in 0..1100 {
        rows.push(queue.step(Cycle::MS, at(if cycle < 400 { 100.0 } else { 10.0 })));
    }
    let [before, now] = [&rows[398], &rows[399]];
    assert!(speed(before, now) > 500.0);
    // A tenth of the speed that it has there at full speed.
    let [before, now] = [&rows[1098], &rows[1099]];
    let there = |row: &Step| (row.tcp.translation.vector - now.tcp.translation.vector).norm();
    let nearest = (1..at_full.len()).min_by(|a, b| there(&at_full[*a]).total_cmp(&there(&at_full[*b]))).unwrap();
    let (speed, full) = (speed(before, now), speed(&at_full[nearest - 1], &at_full[nearest]));
    // It comes to that from below, as slowly as the override has it.
    assert!(speed > 0.075 * full && speed < 0.1001 * full && full > 500.0, "{speed} of {full} mm/s");
}

#[test]
fn a_stop_stays_on_the_path_within_limits_and_resumes() {
    stop_and_resume(&Settings::default(), 42, 40);
}

/// Stops at random places and goes on, three times a run.
pub(crate) fn stop_and_resume(settings: &Settings, seed: u64, rounds: u32) {
    let robot = robot("kr10-r1420");
    let reference = run(&mut two_motions(&robot, settings), 100.0);
    assert_within_limits_of(&robot, &reference, settings.profile, "undisturbed");
    let mut random = Random::new(seed);
    for _ in 0..rounds {
        let mut queue = two_motions(&robot, settings);
        let mut rows = vec![reference[0]];
        for _ in 0..3 {
            for _ in 0..random.between(1.0, 0.4 * reference.len() as f64) as usize {
                rows.push(queue.step(Cycle::MS, Override::FULL));
            }
            queue.stop_on_path(Stop::General);
            let mut cycles = 0;
            while !queue.rests() {
                rows.push(queue.step(Cycle::MS, Override::FULL));
                cycles += 1;
                // The axes need 0.3 s from their full speeds.
                assert!(cycles < 600);
            }
            let at = *queue.joints();
            for _ in 0..20 {
                rows.push(queue.step(Cycle::MS, Override::FULL));
                assert_eq!(*queue.joints(), at, "it stands still");
            }
            assert!(queue.stopped());
            queue.resume();
        }
        while !queue.idle() {
            rows.push(queue.step(Cycle::MS, Override::FULL));
        }
        assert_within_limits_of(&robot, &rows, settings.profile, "stop");
        assert_same_path(&robot, &rows, &reference);
        assert_eq!(rows.last().unwrap().joints, reference.last().unwrap().joints);
    }
}

#[test]
fn a_fast_stop_is_shorter_and_at_most_five_times_as_hard() {
    let robot = robot("kr10-r1420");
    let stop_from = |stop: Stop, cycles: usize| {
        let mut queue = two_motions(&robot, &Settings::default());
        let mut rows = vec![*run(&mut Queue::repeatable(robot.clone(), start()), 100.0).first().unwrap()];
        for _ in 0..cycles {
            rows.push(queue.step(Cycle::MS, Override::FULL));
        }
        queue.stop_on_path(stop);
        let mut count = 0;
        while !queue.rests() {
            rows.push(queue.step(Cycle::MS, Override::FULL));
            count += 1;
            // Resuming while it brakes hard must not soften it.
            if count == 3 {
                queue.resume();
            }
            if count == 5 {
                queue.stop_on_path(stop);
            }
        }
        (rows, count)
    };
    for cycles in [100, 300, 500] {
        let (_, general) = stop_from(Stop::General, cycles);
        let (rows, fast) = stop_from(Stop::Fast, cycles);
        assert!(fast * 2 < general + 10, "{fast} {general}");
        let [vel, acc, jerk] = usage(&robot, &rows);
        assert!(vel <= 1.01 && acc <= 5.05 && jerk <= 5.05, "{vel} {acc} {jerk}");
    }
}

#[test]
fn stopping_between_motions_holds_the_next_one_back() {
    let robot = robot("kr10-r1420");
    let mut queue = two_motions(&robot, &Settings::default());
    queue.stop_on_path(Stop::General);
    for _ in 0..10 {
        let step = queue.step(Cycle::MS, Override::FULL);
        assert!(step.motion == 0 && step.rests && step.joints == start());
    }
    queue.resume();
    assert_eq!(queue.step(Cycle::MS, Override::FULL).motion, 1);
}

#[test]
fn a_stop_just_before_the_end_ends_at_the_target_and_there_it_stays() {
    let robot = robot("kr10-r1420");
    let reference = run(&mut two_motions(&robot, &Settings::default()), 100.0);
    let end_of_first = reference.iter().position(|row| row.finished == 1).unwrap();
    let mut queue = two_motions(&robot, &Settings::default());
    for _ in 0..end_of_first - 20 {
        queue.step(Cycle::MS, Override::FULL);
    }
    queue.stop_on_path(Stop::General);
    for _ in 0..100 {
        queue.step(Cycle::MS, Override::FULL);
    }
    assert_eq!(*queue.joints(), reference[end_of_first].joints);
    assert!(queue.rests() && !queue.idle());
}

#[test]
fn clearing_drops_motions_when_the_robot_rests() {
    let robot = robot("kr10-r1420");
    let mut queue = two_motions(&robot, &Settings::default());
    for _ in 0..300 {
        queue.step(Cycle::MS, Override::FULL);
    }
    queue.stop_on_path(Stop::General);
    queue.clear();
    assert!(!queue.idle());
    assert_eq!(queue.add(&movej(start().axes), &Settings::default()), Err(PlanError::Stopping));
    while !queue.idle() {
        let step = queue.step(Cycle::MS, Override::FULL);
        assert_eq!(step.motion, 1);
        assert_eq!(step.finished, if queue.idle() { 2 } else { 0 });
    }
    assert_eq!(queue.end(), queue.joints());
    queue.resume();
    assert_eq!(queue.add(&movej(start().axes), &Settings::default()), Ok(3));
    let rows = run(&mut queue, 100.0);
    assert_eq!(rows.last().unwrap().joints, start());
    assert_eq!(rows.last().unwrap().finished, 3);
    assert!(queue.place(axes([1.0; 6])) && queue.end() == &axes([1.0; 6]));
}

#[test]
fn progress_counts_time_at_full_override_and_mm_of_lines() {
    let robot = robot("kr10-r1420");
    let mut queue = two_motions(&robot, &Settings::default());
    assert!(queue.progress().is_none());
    let mut at_full = Vec::new();
    for _ in 0..400 {
        queue.step(Cycle::MS, Override::FULL);
        at_full.push(queue.progress().unwrap());
    }
    let now = at_full.last().unwrap();
    assert!((now.elapsed_time - 0.4).abs() < 1e-6 && now.motion == 1 && now.line == 7);
    let [_, y, ..] = frame_components(&robot.kinematics.forward(&start().axes));
    assert!((now.elapsed_distance + now.remaining_distance - 2.0 * y.abs()).abs() < 1e-6);
    let mut slow = two_motions(&robot, &Settings::default());
    for _ in 0..800 {
        slow.step(Cycle::MS, at(50.0));
    }
    let slow = slow.progress().unwrap();
    assert!((slow.elapsed_time - 0.4).abs() < 1e-6, "{slow:?}");
    // The same motion but for what setting off makes of it until there is a law.
    assert!((slow.elapsed_distance - now.elapsed_distance).abs() < 2.0, "{slow:?} {now:?}");
}
