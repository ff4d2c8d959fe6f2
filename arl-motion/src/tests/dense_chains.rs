//! Dense chains of lines stand for a smooth path, whatever their zones.

use crate::tests::*;

/// The length of each line in mm, how many there are, and their speed in mm/s.
const STEP: f64 = 0.2;
const LINES: u32 = 5000;
const SPEED: f64 = 500.0;
/// Where the path starts, in deg.
const START: [f64; 6] = [35.0, -90.0, 90.0, 0.0, 45.0, 0.0];

/// The targets of a winding path, of 130 mm radius at least, in mm from its start.
fn winding() -> Vec<[f64; 2]> {
    let mut at = [0.0, 0.0];
    let next = |index: u32| {
        let heading = 0.6 * (f64::from(index) * STEP * std::f64::consts::TAU / 500.0).sin();
        at = [at[0] + STEP * heading.sin(), at[1] + STEP * heading.cos()];
        at
    };
    (0..LINES).map(next).collect()
}

/// Runs the winding path with a zone in mm.
fn wind(robot: &Arc<Robot>, zone: f64, profile: VelocityProfile) -> Vec<Step> {
    go_through(robot, &winding(), SPEED, zone, profile)
}

/// Runs lines to targets, at a speed in mm/s and with a zone in mm.
fn go_through(robot: &Arc<Robot>, targets: &[[f64; 2]], speed: f64, zone: f64, profile: VelocityProfile) -> Vec<Step> {
    let start = axes(START);
    let mut queue = Queue::repeatable(robot.clone(), start);
    let settings = Settings { profile, ..Settings::default() };
    let origin = frame_components(&robot.kinematics.forward(&START));
    let mut targets = targets.iter().peekable();
    let mut rows = vec![resting(&queue)];
    while targets.peek().is_some() || !queue.idle() {
        while queue.has_room()
            && let Some([across, along]) = targets.next()
        {
            let pose = [origin[0] + across, origin[1] + along, origin[2], origin[3], origin[4], origin[5]];
            let zone = Zone { tcp: zone, ..Zone::NONE };
            queue.add(&Command { zone, speed: Speed { tcp: speed, ..fast() }, ..lin(pose) }, &settings).unwrap();
        }
        rows.push(queue.step(Cycle::MS, Override::FULL));
        assert!(rows.len() < 100_000);
    }
    rows
}

#[test]
fn dense_lines_keep_their_speed_whatever_their_zone() {
    let robot = robot("kr10-r1420");
    for profile in [VelocityProfile::T, VelocityProfile::S] {
        let with_halves = wind(&robot, 0.1, profile);
        let [vel, acc, jerk] = usage(&robot, &with_halves);
        assert!(vel <= 1.01 && acc <= 1.01 && (jerk <= 1.01 || profile == VelocityProfile::T), "{vel} {acc} {jerk}");
        let travels =
            with_halves.windows(2).map(|pair| pair[1].tcp.translation.vector - pair[0].tcp.translation.vector);
        let speeds: Vec<f64> = travels.map(|travel| travel.norm() / CYCLE).collect();
        let keeps = |speed: &f64| *speed >= 0.99 * SPEED;
        let (first, last) = (speeds.iter().position(keeps).unwrap(), speeds.iter().rposition(keeps).unwrap());
        assert!(speeds[first..=last].iter().all(keeps), "{profile:?}");
        // The ramps.
        assert!(first < 200 && speeds.len() - last < 250, "{profile:?}: {first}, {}", speeds.len() - last);
        for zone in [0.099_999_9, 0.100_000_1, 0.08, 0.02, 0.002] {
            let rows = wind(&robot, zone, profile);
            let same =
                rows.len() == with_halves.len() && rows.iter().zip(&with_halves).all(|(a, b)| a.joints == b.joints);
            assert!(same, "{profile:?}: a zone of {zone} mm, {} cycles, {} with halves", rows.len(), with_halves.len());
        }
    }
}

#[test]
fn very_dense_lines_that_come_while_the_robot_goes_keep_their_speed() {
    // More of them than are ahead at once, ten a cycle: each time that laws led to the last one, those behind it would
    // wait for another.
    let robot = robot("kr10-r1420");
    let (step, speed) = (0.06, 600.0);
    let at = |index: u32| {
        let angle = f64::from(index) * step / 100.0;
        [100.0 * (1.0 - angle.cos()), 100.0 * angle.sin()]
    };
    let circle: Vec<[f64; 2]> = (1..=12_000).map(at).collect();
    for profile in [VelocityProfile::T, VelocityProfile::S] {
        let rows = go_through(&robot, &circle, speed, 0.01, profile);
        let travels = rows.windows(2).map(|pair| pair[1].tcp.translation.vector - pair[0].tcp.translation.vector);
        let speeds: Vec<f64> = travels.map(|travel| travel.norm() / CYCLE).collect();
        let keeps = |now: &f64| *now >= 0.99 * speed;
        let (first, last) = (speeds.iter().position(keeps).unwrap(), speeds.iter().rposition(keeps).unwrap());
        assert!(speeds[first..=last].iter().all(keeps), "{profile:?}");
        // It stands while the first ones are planned, some each cycle.
        let begin = speeds.iter().position(|now| *now > 0.0).unwrap();
        let ramps = [first - begin, speeds.len() - last];
        assert!(begin < 500 && ramps.iter().all(|ramp| *ramp < 350), "{profile:?}: {begin}, {ramps:?}");
    }
}

/// How far the path leaves the lines from the first target to the others at most, in mm, and how many of them it came
/// by.
fn farthest_off(rows: &[Step], targets: &[[f64; 2]]) -> (f64, usize) {
    let start = rows[0].tcp.translation.vector;
    let (mut line, mut farthest) = (0, 0.0_f64);
    for row in rows {
        let travel = row.tcp.translation.vector - start;
        assert!(travel.z.abs() < 1e-6);
        let off = |index: usize| {
            let [from, to] = [targets[index], targets[index + 1]].map(|[x, y]| nalgebra::Vector3::new(x, y, 0.0));
            super::blends::off(&travel, &from, &to)
        };
        while line + 2 < targets.len() && off(line + 1) < off(line) {
            line += 1;
        }
        farthest = farthest.max(off(line));
    }
    (farthest, line + 1)
}

#[test]
fn dense_lines_are_left_by_a_thousandth_of_a_millimetre_at_most() {
    let robot = robot("kr10-r1420");
    let targets: Vec<_> = [[0.0; 2]].into_iter().chain(winding()).collect();
    let (farthest, lines) = farthest_off(&wind(&robot, 0.02, VelocityProfile::S), &targets);
    assert!(farthest <= 0.001 && lines == targets.len() - 1, "{farthest} mm off, {lines} lines");
    // Lines that turn as much as a chain may, now this way, now that, of lengths that differ as much as they may.
    let mut random = Random::new(34);
    let mut most = 0.0_f64;
    for round in 0..60 {
        let (mut targets, mut lengths, mut heading) = (vec![[0.0; 2]], vec![1.0], 0.0_f64);
        for index in 0..60 {
            let length = random.between(0.5, 2.0);
            let turn = 0.99 * 0.001 / (0.4 * 0.5 * f64::min(length, *lengths.last().unwrap()));
            heading += match round % 3 {
                0 => turn,
                1 => turn * if index % 2 == 0 { 1.0 } else { -1.0 },
                _ => turn * random.between(-1.0, 1.0),
            };
            let [x, y]: [f64; 2] = *targets.last().unwrap();
            targets.push([x + length * heading.sin(), y + length * heading.cos()]);
            lengths.push(length);
        }
        let (farthest, lines) =
            farthest_off(&go_through(&robot, &targets[1..], 20.0, 0.01, VelocityProfile::S), &targets);
        assert!(farthest <= 0.001 && lines == targets.len() - 1, "{round}: {farthest} mm off, {lines} lines");
        most = most.max(farthest);
    }
    assert!(most > 0.0003, "{most} mm: they are no test");
}

#[test]
fn lines_that_turn_sharply_or_change_their_speed_keep_their_zones() {
    let robot = with_external_axes("kr10-r1420");
    let start = Joints { external: [0.0, 0.0, UNSET, UNSET, UNSET, UNSET], ..axes(START) };
    let [x, y, z, a, b, c] = frame_components(&robot.kinematics.forward(&START));
    // How far the lines turn in deg, how long they are in mm, their speeds in mm/s, how far the second one turns the
    // tool and leads the linear external axis, in deg and mm, and what is used of a zone of a tenth.
    let cases = [
        (0.01, [0.2, 0.2], [500.0, 500.0], [0.0, 0.0], 0.5),
        (1.0, [0.2, 0.2], [500.0, 500.0], [0.0, 0.0], 0.5),
        (5.0, [0.2, 0.2], [500.0, 500.0], [0.0, 0.0], 0.1),
        (0.01, [0.2, 1.0], [500.0, 500.0], [0.0, 0.0], 0.1),
        (0.01, [0.2, 0.2], [500.0, 400.0], [0.0, 0.0], 0.1),
        (0.0, [80.0, 80.0], [500.0, 500.0], [0.0, 0.0], 0.5),
        (0.05, [80.0, 80.0], [500.0, 500.0], [0.0, 0.0], 0.1),
        (0.01, [0.2, 0.2], [500.0, 500.0], [0.001, 0.001], 0.5),
        (0.01, [0.2, 0.2], [500.0, 500.0], [0.1, 0.0], 0.1),
        (0.01, [0.2, 0.2], [500.0, 500.0], [0.0, 0.1], 0.1),
    ];
    for (angle, [first, second], speeds, [turned, external_travel], used) in cases {
        let (sine, cosine) = f64::to_radians(angle).sin_cos();
        let corner = [x, y + first, z, a, b, c];
        let end = [x, y + first + second * cosine, z + second * sine, a, b, c + turned];
        let mut queue = Queue::repeatable(robot.clone(), start);
        for ((pose, external_travel), speed) in [(corner, 0.0), (end, external_travel)].into_iter().zip(speeds) {
            let external = [0.0, external_travel, UNSET, UNSET, UNSET, UNSET];
            let command = Command {
                zone: Zone { tcp: 0.1 * first, ..Zone::NONE },
                speed: Speed { tcp: speed, ..fast() },
                ..command(Target::Line { pose, wobj: Frame::identity(), external })
            };
            queue.add(&command, &Settings::default()).unwrap();
        }
        let mut exit = 1.0;
        while !queue.idle() {
            queue.step(Cycle::MS, Override::FULL);
            if let Some(progress) = queue.progress().filter(|progress| progress.motion == 1) {
                exit = progress.share;
            }
        }
        let share_of_cycle = 500.0 * CYCLE / first;
        assert!(
            exit <= 1.0 - used + 1e-9 && exit > 1.0 - used - share_of_cycle.min(0.2) - 1e-9,
            "{angle} deg: left at {exit}"
        );
    }
}
