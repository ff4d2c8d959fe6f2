//! What planning accepts, what it refuses, and what it makes of a command.

use crate::tests::*;

fn start() -> Joints {
    axes([0.0, -90.0, 90.0, 0.0, 45.0, 0.0])
}

fn plan_one(command: &Command, settings: &Settings) -> Result<Motion, PlanError> {
    plan(&robot("kr10-r1420"), &start(), command, settings)
}

fn here() -> [f64; 6] {
    frame_components(&robot("kr10-r1420").kinematics.forward(&start().axes))
}

#[test]
fn unset_components_stay() {
    let motion = plan_one(&movej([10.0, UNSET, UNSET, 5.0, UNSET, UNSET]), &Settings::default()).unwrap();
    assert_eq!(motion.end().axes, [10.0, -90.0, 90.0, 5.0, 45.0, 0.0]);
    assert_eq!(motion.end().external, [UNSET; 6]);

    let robot = robot("kr10-r1420");
    let wobj = frame([100.0, 50.0, 0.0, 90.0, 0.0, 0.0]);
    let pose = [UNSET, UNSET, UNSET, UNSET, UNSET, UNSET];
    let target =
        Target::Line { pose: [250.0, pose[1], pose[2], pose[3], pose[4], pose[5]], wobj, external: [UNSET; 6] };
    let motion = plan_one(&command(target), &Settings::default()).unwrap();
    let [x, y, z, ..] = here();
    // x of the workpiece frame is y of the base.
    let [end_x, end_y, end_z, ..] = frame_components(&robot.kinematics.forward(&motion.end().axes));
    assert!(
        (end_x - x).abs() < 1e-6 && (end_y - 300.0).abs() < 1e-6 && (end_z - z).abs() < 1e-6,
        "{end_x} {end_y} {y}"
    );
}

#[test]
fn ptp_takes_configuration_and_turn() {
    let robot = robot("kr10-r1420");
    let goal = [20.0, -80.0, 70.0, 30.0, -40.0, 100.0];
    let pose = frame_components(&robot.kinematics.forward(&goal));
    let motion = plan_one(&ptp(pose, 1), &Settings::default()).unwrap();
    assert!(motion.end().axes.iter().zip(goal).all(|(a, b)| (a - b).abs() < 1e-6), "{:?}", motion.end());
    let wanted = Wanted { cfg: Some(1), turn: 0b10_0000 };
    let target = Target::Pose { pose, wobj: Frame::identity(), wanted, external: [UNSET; 6] };
    let motion = plan_one(&command(target), &Settings::default()).unwrap();
    assert!((motion.end().axes[5] + 260.0).abs() < 1e-6, "{:?}", motion.end());
    assert_eq!(plan_one(&ptp(pose, 9), &Settings::default()), Err(PlanError::NoSuchCfg { cfg: 9 }));
}

#[test]
fn what_is_out_of_reach_or_range_says_so() {
    match plan_one(&movej([0.0, 70.0, 90.0, 0.0, 0.0, 0.0]), &Settings::default()) {
        Err(PlanError::AxisLimit { axis, value, min, max, along }) => {
            assert_eq!((axis.as_str(), value, min, max, along), ("j2", 70.0, -185.0, 65.0, 1.0));
        }
        other => panic!("{other:?}"),
    }
    let far = [3000.0, 0.0, 500.0, 0.0, 90.0, 0.0];
    for command in [ptp(far, 0), lin(far)] {
        match plan_one(&command, &Settings::default()) {
            Err(PlanError::Unreachable { beyond, along }) => assert!(beyond > 1000.0 && along == 1.0),
            other => panic!("{other:?}"),
        }
    }
    let words = plan_one(&lin(far), &Settings::default()).unwrap_err().to_string();
    assert!(words.contains("mm out of reach; at the target"), "{words}");
    assert_eq!(plan_one(&lin([f64::NAN; 6]), &Settings::default()), Err(PlanError::NotANumber));
}

#[test]
fn a_target_that_tilts_the_flange_of_a_scara_says_so() {
    let robot = robot("hsr065");
    let from = axes([10.0, 40.0, 50.0, 30.0, 0.0, 0.0]);
    let [x, y, z, a, ..] = frame_components(&robot.kinematics.forward(&from.axes));
    let tilted = [x, y, z, a, 20.0, 0.0];
    let spline = |pose: [f64; 6]| command(Target::Spline { pose, wobj: Frame::identity(), external: [UNSET; 6] });
    let refused = |command: &Command| match Queue::repeatable(robot.clone(), from).add(command, &Settings::default()) {
        Err(PlanError::Tilted { by, along }) => (by, along),
        other => panic!("{other:?}"),
    };
    for command in [ptp(tilted, 0), lin(tilted), spline(tilted)] {
        let (by, along) = refused(&command);
        assert!((by - 20.0).abs() < 1e-9 && along == 1.0, "{by} {along}");
    }
    // A circle that stands upright, with the tool turning along: only its ends are upright.
    let (via, pose) = ([x + 10.0, y, z - 10.0], [x, y, z - 20.0, a, 0.0, 0.0]);
    let circle =
        Target::Arc { via, pose, wobj: Frame::identity(), angle: Some(360.0), follow: true, external: [UNSET; 6] };
    let (by, along) = refused(&command(circle));
    assert!(by > 170.0 && along < 0.1, "{by} {along}");
    let words = PlanError::Tilted { by: 20.0, along: 1.0 }.to_string();
    assert!(words.contains("20.000 deg"), "{words}");
}

#[test]
fn a_line_that_leaves_the_reach_between_its_ends_says_where_and_how_far() {
    let robot = robot("kr10-r1420");
    // The hand turns from one side to the other over the side that faces the robot: there the wrist is too far out.
    let tool = frame([0.0, 0.0, 150.0, 0.0, 0.0, 0.0]);
    let facing = |a: f64| frame([1150.0, 0.0, 1080.0, a, 90.0, 0.0]) * tool.inverse();
    let wanted = Wanted { cfg: None, turn: -1 };
    let axes = robot.kinematics.choose(&facing(95.0), wanted, &robot.axes, &start().axes).unwrap();
    let from = Joints { axes, ..start() };
    let command = Command { rig: Rig::with_tool(tool), ..lin([1150.0, 0.0, 1080.0, -95.0, 90.0, 0.0]) };
    match plan(&robot, &from, &command, &Settings::default()) {
        Err(PlanError::Unreachable { beyond, along }) => {
            // 230 mm behind the tool's tip: 1380 - 150 before and 630 above axis 2, for which the arm is 1270.303 long.
            let expected = (1380.0_f64 - 150.0).hypot(630.0) - 610.0 - 660.0_f64.hypot(20.0);
            assert!((beyond - expected).abs() < 1.0, "{beyond} {expected}");
            assert!(along > 0.05 && along < 0.5, "{along}");
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_line_through_the_robot_is_refused_where_it_fails() {
    let robot = robot("kr10-r1420");
    let front = axes([60.0, -90.0, 90.0, 0.0, 45.0, 0.0]);
    let [x, y, z, ..] = frame_components(&robot.kinematics.forward(&front.axes));
    // To the other side of the base, past axis 1.
    match plan(&robot, &front, &lin([-x, -y, z, UNSET, UNSET, UNSET]), &Settings::default()) {
        Err(
            PlanError::Unreachable { along, .. }
            | PlanError::Singular { along, .. }
            | PlanError::Wrist { along, .. }
            | PlanError::AxisLimit { along, .. },
        ) => {
            assert!(along > 0.0, "{along}");
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn an_axis_range_is_watched_along_the_whole_line() {
    // Axis 6 narrowed so that both ends are inside and the middle is not.
    let robot = robot("kr10-r1420");
    let from = axes([-40.0, -60.0, 80.0, 0.0, 40.0, 0.0]);
    let [x, y, z, ..] = frame_components(&robot.kinematics.forward(&from.axes));
    let command = lin([x, -y, z, UNSET, UNSET, UNSET]);
    let motion = plan(&robot, &from, &command, &Settings::default()).unwrap();
    let mut queue = Queue::repeatable(robot.clone(), from);
    queue.add(&command, &Settings::default()).unwrap();
    let farthest = run(&mut queue, 100.0).iter().map(|row| row.joints.axes[2]).fold(f64::MIN, f64::max);
    let ends = from.axes[2].max(motion.end().axes[2]);
    assert!(farthest > ends + 5.0, "axis 3 goes to {farthest} between {ends}");
    let mut narrow = Robot::clone(&robot).into_description();
    narrow.axes[2].max = ends + 4.0;
    narrow.home = from.axes.to_vec();
    let narrow = Robot::new(narrow).unwrap();
    match plan(&narrow, &from, &command, &Settings::default()) {
        Err(PlanError::AxisLimit { axis, value, along, .. }) => {
            assert_eq!(axis, "j3");
            assert!((value - farthest).abs() < 0.05, "{value} {farthest}");
            assert!(along > 0.0 && along < 0.5, "{along}");
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn lines_through_the_wrist_singularity_are_refused_and_beside_it_slowed() {
    let robot = robot("kr10-r1420");
    let through = |sideways: f64| {
        let from = axes([0.0, -90.0, 90.0, 0.0, 20.0, 0.0]);
        let pose = frame_components(&robot.kinematics.forward(&from.axes));
        // Straight down with a constant hand: axis 5 passes 0.
        let to = axes([0.0, -80.0, 110.0, 0.0, -30.0, 0.0]);
        let [x, y, z, ..] = frame_components(&robot.kinematics.forward(&to.axes));
        let command = lin([x, y, z, pose[3] + sideways, pose[4], pose[5]]);
        plan(&robot, &from, &command, &Settings::default())
    };
    assert!(matches!(through(0.0), Err(PlanError::Wrist { .. })), "{:?}", through(0.0));
    let beside = through(40.0).unwrap();
    assert!(beside.duration() > 0.0);
}

#[test]
fn a_line_leaves_and_ends_at_a_singular_point_where_the_axes_go_on_evenly() {
    for name in ["kr10-r1420", "irb2400-10"] {
        let robot = robot(name);
        // Upper arm and forearm bent, wrist straight.
        let singular = if name == "kr10-r1420" { axes([0.0, -90.0, 90.0, 0.0, 0.0, 0.0]) } else { axes([0.0; 6]) };
        for down in [-120.0, 120.0] {
            let mut queue = Queue::repeatable(robot.clone(), singular);
            let [x, _, z, ..] = frame_components(&robot.kinematics.forward(&singular.axes));
            queue.add(&lin([UNSET, UNSET, z + down, UNSET, UNSET, UNSET]), &Settings::default()).unwrap();
            queue.add(&lin([x, UNSET, z, UNSET, UNSET, UNSET]), &Settings::default()).unwrap();
            let rows = run(&mut queue, 100.0);
            assert_within_limits(&robot, &rows, name);
            let last = rows.last().unwrap();
            assert!(last.joints.axes.iter().zip(singular.axes).all(|(a, b)| (a - b).abs() < 1e-6), "{last:?}");
        }
        // Sideways the wrist would have to turn infinitely fast.
        let refused = plan(&robot, &singular, &lin([UNSET, 100.0, UNSET, UNSET, UNSET, UNSET]), &Settings::default());
        assert!(matches!(refused, Err(PlanError::Wrist { .. })), "{refused:?}");
    }
}

#[test]
fn durations_are_kept_or_refused() {
    let goal = [30.0, -80.0, 80.0, 10.0, 50.0, 60.0];
    let command = Command { duration: Some(3.0), ..movej(goal) };
    let motion = plan_one(&command, &Settings { speed_percent: 10.0, ..Settings::default() }).unwrap();
    assert!((motion.duration() - 3.0).abs() < 1e-9);
    for profile in [VelocityProfile::T, VelocityProfile::S, VelocityProfile::O] {
        let mut queue = Queue::repeatable(robot("kr10-r1420"), start());
        queue.add(&command, &Settings { profile, ..Settings::default() }).unwrap();
        // Whole cycles cost a little, accelerations that rise in some of them do not.
        let cycles = run(&mut queue, 100.0).len() - 1;
        assert!((3000..=3002).contains(&cycles), "{profile:?} {cycles}");
    }

    let least = plan_one(&movej(goal), &Settings::default()).unwrap().duration();
    match plan_one(&Command { duration: Some(least * 0.9), ..movej(goal) }, &Settings::default()) {
        Err(PlanError::Duration { wanted, least: reported }) => {
            // A duration counts on braking a little more gently.
            assert!(reported >= least && reported < 1.001 * least && wanted < reported);
        }
        other => panic!("{other:?}"),
    }
    let [x, y, z, a, b, c] = here();
    let line = Command { duration: Some(5.0), ..lin([x, y + 200.0, z, a, b, c]) };
    assert!((plan_one(&line, &Settings::default()).unwrap().duration() - 5.0).abs() < 1e-9);
    // Manual mode slows a programmed duration down instead of refusing it.
    let line = Command { duration: Some(0.6), ..line };
    assert!((plan_one(&line, &Settings::default()).unwrap().duration() - 0.6).abs() < 1e-9);
    assert!(plan_one(&line, &Settings { manual: true, ..Settings::default() }).unwrap().duration() > 200.0 / 250.0);
}

#[test]
fn velset_and_accset_slow_down() {
    let [x, y, z, a, b, c] = here();
    let line = Command { speed: Speed { tcp: 200.0, ..fast() }, ..lin([x, y + 200.0, z, a, b, c]) };
    let duration = |command: &Command, settings: &Settings| plan_one(command, settings).unwrap().duration();
    let plain = duration(&line, &Settings::default());
    let half = duration(&line, &Settings { speed_percent: 50.0, ..Settings::default() });
    assert!((half - plain) > 0.9, "200 mm at 200 and at 100 mm/s: {plain} {half}");
    let capped = duration(&line, &Settings { max_tcp: 50.0, ..Settings::default() });
    assert!(capped > 4.0, "{capped}");
    let movej = movej([30.0, -80.0, 80.0, 10.0, 50.0, 60.0]);
    let plain = duration(&movej, &Settings::default());
    assert_eq!(plain, duration(&movej, &Settings { max_tcp: 1.0, ..Settings::default() }), "max is for lines");
    assert!(duration(&movej, &Settings { acc_percent: 50.0, ..Settings::default() }) > plain);
    assert!(duration(&movej, &Settings { jerk_percent: 50.0, ..Settings::default() }) > plain);
    let most = Settings { acc_percent: 300.0, jerk_percent: 300.0, ..Settings::default() };
    assert_eq!(plain, duration(&movej, &most), "the robot's limits are the most there is");
    let least = |percent| duration(&movej, &Settings { acc_percent: percent, ..Settings::default() });
    assert_eq!(least(1.0), least(20.0));
    let none = plan_one(&movej, &Settings { speed_percent: 0.0, ..Settings::default() });
    assert!(matches!(none, Err(PlanError::NoOverride { percent: 0.0 })));
    let none = plan_one(&line, &Settings { max_tcp: 0.0, ..Settings::default() });
    assert!(matches!(none, Err(PlanError::NoHighestSpeed { value: 0.0 })));
    assert!(plan_one(&Command { speed: Speed { percent: 0.0, ..fast() }, ..movej }, &Settings::default()).is_err());
}

#[test]
fn external_axes_move_along_at_their_own_speed() {
    let robot = with_external_axes("kr10-r1420");
    let mut from = start();
    from.external[..2].copy_from_slice(&[0.0, 0.0]);
    let mut target = Joints { axes: [UNSET; 6], external: [UNSET; 6] };
    target.external[0] = 90.0;
    let slow = Command { speed: Speed { exj: 10.0, ..fast() }, ..command(Target::Joints(target)) };
    let motion = plan(&robot, &from, &slow, &Settings::default()).unwrap();
    assert!(motion.duration() > 9.0 && motion.duration() < 9.5, "{}", motion.duration());
    assert_eq!(motion.end().external[..2], [90.0, 0.0]);
    // A linear one has the other speed, and a line waits for it.
    let pose = [UNSET, 100.0, UNSET, UNSET, UNSET, UNSET];
    let external = [UNSET, 200.0, UNSET, UNSET, UNSET, UNSET];
    let line = command(Target::Line { pose, wobj: Frame::identity(), external });
    let line = Command { speed: Speed { exl: 20.0, ..fast() }, ..line };
    let motion = plan(&robot, &from, &line, &Settings::default()).unwrap();
    assert!(motion.duration() > 10.0 && motion.duration() < 10.5, "{}", motion.duration());
    // External axes that the robot does not have are left alone.
    let motion = plan_one(&slow, &Settings::default()).unwrap();
    assert_eq!(motion.duration(), 0.0);
    assert_eq!(motion.end().external, [UNSET; 6]);
}

#[test]
fn motions_that_go_nowhere_end_at_once() {
    let mut queue = Queue::repeatable(robot("kr10-r1420"), start());
    for _ in 0..5 {
        queue.add(&movej(start().axes), &Settings::default()).unwrap();
        queue.add(&lin([UNSET; 6]), &Settings::default()).unwrap();
    }
    let step = queue.step(Cycle::MS, Override::FULL);
    assert_eq!((step.finished, step.motion), (10, 0));
    assert!(queue.idle() && step.joints == start());
}

#[test]
fn scara_moves_its_axes_and_along_lines() {
    let robot = robot("hsr065");
    let home = Joints::home(&robot);
    let mut queue = Queue::repeatable(robot.clone(), home);
    queue.add(&movej([30.0, 40.0, 50.0, 60.0, UNSET, UNSET]), &Settings::default()).unwrap();
    assert_eq!(queue.end().axes, [30.0, 40.0, 50.0, 60.0, 0.0, 0.0]);
    let from = robot.kinematics.forward(&queue.end().axes);
    let [x, y, z, ..] = frame_components(&from);
    queue.add(&lin([x - 50.0, y + 40.0, z - 30.0, UNSET, UNSET, UNSET]), &Settings::default()).unwrap();
    let rows = run(&mut queue, 100.0);
    assert_within_limits(&robot, &rows, "SCARA");
    let to = rows.last().unwrap().tcp;
    assert!(
        (to.translation.vector - from.translation.vector - nalgebra::Vector3::new(-50.0, 40.0, -30.0)).norm() < 1e-6
    );
    for row in rows.iter().filter(|row| row.motion == 2) {
        let (off, turned) = off_line(&from, &to, &row.tcp);
        assert!(off < 1e-6 && turned < 1e-8, "{off} mm, {turned} rad off the line");
    }
    // What tilts the flange cannot be reached.
    let tilted = plan(&robot, &home, &lin([x, y, z, 0.0, 20.0, 0.0]), &Settings::default());
    assert!(tilted.is_err());
}
