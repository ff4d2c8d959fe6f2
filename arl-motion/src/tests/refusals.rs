//! Numbers that are none, or out of their range, are refused before anything moves.

use super::*;

/// Something of a command or of the settings is given a value.
type Put = fn(&mut Command, &mut Settings, f64);

const NO_NUMBERS: [f64; 3] = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY];

fn weave() -> Weave {
    Weave {
        shape: WeaveShape::Simple,
        frequency: 2.0,
        amplitude: 2.0,
        dwells: [0.0; 3],
        angle: 90.0,
        radius: 1.0,
        turned: nalgebra::Vector3::zeros(),
    }
}

/// Sets something of a weave.
fn woven(settings: &mut Settings, set: impl FnOnce(&mut Weave)) {
    let mut weave = weave();
    set(&mut weave);
    settings.weave = Some(weave);
}

/// Each place that a value can be put to.
const PLACES: [Put; 22] = [
    |_, settings, value| settings.speed_percent = value,
    |_, settings, value| settings.max_tcp = value,
    |_, settings, value| settings.acc_percent = value,
    |_, settings, value| settings.jerk_percent = value,
    |_, settings, value| woven(settings, |weave| weave.frequency = value),
    |_, settings, value| woven(settings, |weave| weave.amplitude = value),
    |_, settings, value| woven(settings, |weave| weave.dwells[1] = value),
    |_, settings, value| woven(settings, |weave| weave.angle = value),
    |_, settings, value| woven(settings, |weave| weave.radius = value),
    |_, settings, value| woven(settings, |weave| weave.turned.y = value),
    |_, settings, value| settings.compensation = Some(Compensation::new(1, [100.0, value, 1e4, 90.0, 900.0, 9e3])),
    |_, settings, value| {
        let mut compensation = Compensation::new(1, [100.0, 1e3, 1e4, 90.0, 900.0, 9e3]);
        compensation.add(Reference::World, &[0.0, value, 0.0, 0.0, 0.0, 0.0]);
        settings.compensation = Some(compensation);
    },
    |command, _, value| command.speed.tcp = value,
    |command, _, value| command.speed.ori = value,
    |command, _, value| command.duration = Some(value),
    |command, _, value| command.zone.percent = value,
    |command, _, value| command.zone.tcp = value,
    |command, _, value| command.rig.base.translation.vector.x = value,
    |command, _, value| command.rig.carried = Carried::Tool(frame([0.0, value, 0.0, 0.0, 0.0, 0.0])),
    |command, _, value| command.rig.workpiece.frame = frame([0.0, 0.0, 0.0, value, 0.0, 0.0]),
    |command, _, value| {
        if let Target::Line { pose, .. } = &mut command.target {
            pose[1] = value;
        }
    },
    |command, _, value| {
        if let Target::Line { wobj, .. } = &mut command.target {
            wobj.translation.vector.z = value;
        }
    },
];

#[test]
fn what_is_no_number_is_refused_wherever_it_stands() {
    let robot = robot("kr10-r1420");
    let start = axes([0.0, -90.0, 90.0, 0.0, 45.0, 0.0]);
    let from = frame_components(&robot.kinematics.forward(&start.axes));
    for (place, put) in PLACES.iter().enumerate() {
        for value in NO_NUMBERS {
            let mut command = lin([from[0], from[1] + 50.0, from[2], from[3], from[4], from[5]]);
            let mut settings = Settings::default();
            put(&mut command, &mut settings, value);
            let mut queue = Queue::repeatable(robot.clone(), start);
            let added = queue.add(&command, &settings);
            assert_eq!(added.is_err(), plan(&robot, &start, &command, &settings).is_err(), "{place}: {value}");
            assert!(added.is_err() || !value.is_nan(), "{place}: {value} was taken");
            // What is taken, as an infinite acceleration in percent, is a motion like others.
            let mut cycles = 0;
            while !queue.idle() {
                let step = queue.step(Cycle::MS, Override::FULL);
                assert!(step.joints.is_finite() && step.velocity.is_finite(), "{place}: {value}");
                cycles += 1;
                assert!(cycles < 20_000, "{place}: {value} does not end");
            }
        }
    }
}

#[test]
fn a_robot_that_stands_nowhere_is_not_moved() {
    let robot = robot("kr10-r1420");
    let nowhere = axes([0.0, f64::NAN, 90.0, 0.0, 45.0, 0.0]);
    let mut queue = Queue::repeatable(robot.clone(), nowhere);
    assert_eq!(queue.add(&movej([0.0; 6]), &Settings::default()), Err(PlanError::NotANumber));
    let mut queue = Queue::repeatable(robot.clone(), Joints::home(&robot));
    assert!(!queue.place(nowhere));
}

#[test]
fn cycles_and_overrides_are_checked_when_they_are_made() {
    for length in [0, 99, 100_001, 60_000_000] {
        assert!(Cycle::new(std::time::Duration::from_micros(length)).is_err(), "{length}");
    }
    for length in [100, 1000, 4000, 100_000] {
        let cycle = Cycle::new(std::time::Duration::from_micros(length)).unwrap();
        assert_eq!(cycle, arl_robot::Rate::from_micros(length as u32).into(), "{length}");
    }
    for percent in [f64::NAN, -5.0, -1e-300, 100.1, 500.0, f64::INFINITY] {
        assert!(Override::from_percent(percent).is_err(), "{percent}");
    }
    assert_eq!(Override::from_percent(0.0), Ok(Override::ZERO));
}
