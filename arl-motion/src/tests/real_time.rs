//! Cycles that wait for nothing.

use crate::blend::corner::FOUND_HERE;
use crate::junction::gain::ASKED_HERE;
use crate::tests::*;

/// How cycles come in real time, beside the threads that look ahead.
#[derive(Clone, Copy)]
enum Threads {
    /// What is looked for is there at once.
    Quick,
    /// The cycles come as fast as they can, so that next to nothing is found in time.
    Slow,
    /// Nothing is ever found.
    Stuck,
}

fn lines(robot: &Robot) -> (Joints, Vec<Command>) {
    let start = axes([0.0, -90.0, 90.0, 0.0, 45.0, 0.0]);
    let from = frame_components(&robot.kinematics.forward(&start.axes));
    let command = |number: u32| {
        let pose = [
            from[0],
            from[1] + 8.0 * f64::from(number),
            from[2] - if number.is_multiple_of(2) { 8.0 } else { 0.0 },
            from[3],
            from[4],
            from[5],
        ];
        let zone = if number.is_multiple_of(7) { Zone::NONE } else { Zone { percent: 100.0, ..Zone::NONE } };
        Command { zone, speed: Speed { tcp: 100.0, ..fast() }, line: number, ..lin(pose) }
    };
    (start, (1..=60).map(command).collect())
}

/// Goes along lines, in real time or not, for `most` cycles; returns what each of them did, and how many laws were
/// late.
fn ran(robot: &Arc<Robot>, threads: Option<Threads>, most: usize) -> (Vec<Step>, u64) {
    let (start, commands) = lines(robot);
    let robot = Arc::clone(robot);
    let mut queue = if threads.is_some() { Queue::new(robot, start) } else { Queue::repeatable(robot, start) };
    if matches!(threads, Some(Threads::Stuck)) {
        queue.find_nothing();
    }
    let mut rows = vec![resting(&queue)];
    let mut commands = commands.iter().peekable();
    while (commands.peek().is_some() || !queue.idle()) && rows.len() < most {
        while let Some(command) = commands.next_if(|_| queue.has_room()) {
            queue.add(command, &Settings::default()).unwrap();
        }
        if matches!(threads, Some(Threads::Quick)) {
            queue.await_prepared();
            queue.await_law();
        }
        rows.push(queue.step(Cycle::MS, Override::FULL));
    }
    (rows, queue.found_late())
}

#[test]
fn what_is_found_in_time_leads_as_it_does_where_cycles_wait() {
    let robot = robot("kr10-r1420");
    let (rows, late) = ran(&robot, Some(Threads::Quick), 100_000);
    let (expected, _) = ran(&robot, None, 100_000);
    assert!(rows == expected && late == 0, "{late} late");
}

#[test]
fn what_comes_too_late_is_done_without() {
    let robot = robot("kr10-r1420");
    let (rows, late) = ran(&robot, Some(Threads::Slow), 3_000_000);
    assert_within_limits(&robot, &rows, "slow threads");
    assert!(late > 0, "everything was in time");
    assert_eq!(rows.last().map(|row| row.finished), Some(60));
}

#[test]
fn a_robot_rests_on_its_path_while_nothing_is_found() {
    let robot = robot("kr10-r1420");
    let (rows, late) = ran(&robot, Some(Threads::Stuck), 2000);
    assert_within_limits(&robot, &rows, "stuck threads");
    assert!(late > 0 && rows.last().is_some_and(|row| row.rests && row.finished < 60), "{late} late");
}

#[test]
fn no_cycle_finds_a_blend() {
    let robot = robot("kr10-r1420");
    let (start, commands) = lines(&robot);
    let found_in_cycles = |in_real_time: bool| {
        let mut queue = Queue::repeatable(Arc::clone(&robot), start);
        queue.follow_real_time(in_real_time);
        queue.prepare_nothing();
        let mut commands = commands.iter().peekable();
        let mut found = 0;
        while commands.peek().is_some() || !queue.idle() {
            // Most of them come while the robot goes.
            if queue.unfinished() < 6 {
                for command in commands.by_ref().take(3) {
                    queue.add(command, &Settings::default()).unwrap();
                }
            }
            queue.await_law();
            let before = FOUND_HERE.with(std::cell::Cell::get);
            queue.step(Cycle::MS, Override::FULL);
            found += FOUND_HERE.with(std::cell::Cell::get) - before;
        }
        (found, queue.found_late())
    };
    let (found, late) = found_in_cycles(true);
    assert!(found == 0 && late > 0, "{found} found, {late} late");
    assert!(found_in_cycles(false).0 > 0);
}

#[test]
fn no_cycle_finds_out_whether_a_blend_saves_time() {
    let robot = robot("kr6-r700");
    let start = axes([0.0, -90.0, 90.0, 0.0, 45.0, 0.0]);
    let from = frame_components(&robot.kinematics.forward(&start.axes));
    let asked = |in_real_time: bool| {
        let mut queue = Queue::repeatable(Arc::clone(&robot), start);
        queue.follow_real_time(in_real_time);
        queue.prepare_nothing();
        let mut pose = from;
        for line in 0..6 {
            // The tool turns back and forth, so that small zones may lose time.
            let sign = if line % 2 == 0 { 1.0 } else { -1.0 };
            let offset = [0.0, 30.0 * sign, 25.0, 12.0 * sign, 0.0, 12.0 * sign];
            pose.iter_mut().zip(offset).for_each(|(value, by)| *value += by);
            let zone = Zone { tcp: 0.1, ..Zone::NONE };
            queue.add(&Command { zone, line, ..lin(pose) }, &Settings::default()).unwrap();
        }
        let before = ASKED_HERE.with(std::cell::Cell::get);
        let mut rows = vec![resting(&queue)];
        while !queue.idle() {
            queue.await_law();
            rows.push(queue.step(Cycle::MS, Override::FULL));
            assert!(rows.len() < 20_000, "it does not end");
        }
        assert_within_limits(&robot, &rows, "in doubt");
        let set_off = rows.iter().position(|row| !row.rests).unwrap();
        (ASKED_HERE.with(std::cell::Cell::get) - before, queue.found_late(), set_off)
    };
    let (laws, late, set_off) = asked(true);
    assert!(laws == 0 && late > 0 && set_off < 80, "{laws} laws, {late} late, {set_off} cycles at rest");
    let (laws, late, set_off) = asked(false);
    assert!(laws > 0 && late == 0 && set_off < 8, "{laws} laws, {late} late, {set_off} cycles at rest");
}
