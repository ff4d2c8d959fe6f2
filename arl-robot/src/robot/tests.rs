//! Robot files: valid and invalid ones.

use super::*;
use crate::kinematics::{Kinematics, Opw, OpwParameters};

fn error(text: &str) -> RobotError {
    Robot::parse("arm.toml", text).unwrap_err()
}

/// The example file with one piece replaced.
fn changed(from: &str, to: &str) -> String {
    let text = Robot::text("six-10").unwrap();
    assert!(text.contains(from), "{from} is not in the example");
    text.replacen(from, to, 1)
}

#[test]
fn every_builtin_robot_reads_and_says_its_own_name() {
    for name in Robot::builtin_names() {
        let robot = Robot::builtin(name).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(robot.name, name);
        assert_eq!(robot.axes.len(), own_axes(robot.family));
        for (axis, home) in robot.axes.iter().zip(&robot.home) {
            assert!((axis.min..=axis.max).contains(home));
        }
    }
    assert_eq!(Robot::builtin_names().next(), Some("kr10-r1420"));
    assert_eq!(Robot::load("KR10-R1420").unwrap(), Robot::builtin("kr10-r1420").unwrap());
}

#[test]
fn limits_of_the_default_robot_are_the_published_ones() {
    let robot = Robot::builtin("kr10-r1420").unwrap();
    let ranges: Vec<_> = robot.axes.iter().map(|axis| (axis.min, axis.max, axis.vel)).collect();
    assert_eq!(ranges[1], (-185.0, 65.0, 210.0));
    assert_eq!(ranges[5], (-350.0, 350.0, 492.0));
    assert!(robot.axes.iter().all(|axis| axis.acc == 5.0 * axis.vel && axis.jerk == 60.0 * axis.vel));
}

#[test]
fn robots_that_would_be_stretched_out_at_zeros_stand_bent_at_home() {
    for name in ["kr10-r1420", "kr6-r700", "irb2400-10", "tx2-60", "cobra600"] {
        let robot = Robot::builtin(name).unwrap();
        let home: [f64; 6] = std::array::from_fn(|axis| robot.home.get(axis).copied().unwrap_or_default());
        let flange = robot.kinematics.forward(&home);
        let down = flange.rotation * nalgebra::Vector3::z();
        let (at, arm) = (flange.translation.vector, robot.limbs());
        assert!(at.y.abs() < 100.0 && at.x > 150.0, "{name}: in front of its base, not {at}");
        // A stretched arm cannot move further along itself.
        let length =
            |limb: &Limb| (nalgebra::Vector3::from(limb.ends[1]) - nalgebra::Vector3::from(limb.ends[0])).norm();
        let reach: f64 =
            arm.iter().filter(|limb| limb.name != "the base" && limb.name != "the spindle").map(length).sum();
        let level = nalgebra::Vector3::new(at.x, at.y, 0.0).norm();
        assert!(level < 0.9 * reach, "{name}: {level} of {reach} mm");
        if robot.family == Family::SixAxis {
            assert!((down.z + 1.0).abs() < 1e-9, "{name}: the hand points down, not {down}");
            assert!(at.z > 200.0, "{name}: {at}");
        }
    }
}

#[test]
fn an_unknown_key_names_its_place_and_a_near_name() {
    let found = error(&changed("ori_vel", "ori_val"));
    assert_eq!((found.line, found.column), (23, 1), "{found}");
    assert!(found.message.contains("did you mean `ori_vel`"), "{found}");
    let found = error(&changed("profile", "speed_profile_of_the_robot"));
    assert!(found.message.contains("expected one of: name, family"), "{found}");
}

#[test]
fn wrong_values_say_what_was_expected() {
    for (from, to, line, words) in [
        ("\"six-axis\"", "\"sixaxis\"", 4, "expected \"six-axis\" or \"scara\""),
        ("acc = 8000.0", "acc = -1", 21, "from 1e-6 to 1000000000000.0"),
        ("acc = 8000.0", "acc = \"fast\"", 21, "found the text \"fast\""),
        ("min = -170.0", "min = 171.0", 29, "less than its `max`, 170"),
        ("signs = [1, 1,", "signs = [2, 1,", 17, "1 or -1"),
        ("signs = [1, 1,", "signs = [1,", 17, "found 5 of them"),
        ("\"j2\"", "\"j3\"", 36, "expected \"j2\""),
        ("c2 = 705.0", "", 8, "lacks `c2`"),
        ("c2 = 705.0", "c2 = nan", 13, "expected the length"),
        ("acc = 8000.0", "acc = inf", 21, "`acc` of [tcp]: expected an acceleration in mm/s2, found the number inf"),
        (
            "acc = 8000.0",
            "acc = 1e300",
            21,
            "`acc` of [tcp] is 1e300: expected an acceleration in mm/s2, from 1e-6 to 1000000000000.0",
        ),
        ("acc = 8000.0", "acc = 1e-300", 21, "is 1e-300: expected an acceleration in mm/s2, from 1e-6 to"),
        ("c2 = 705.0", "c2 = 2e6", 13, "expected the length of the upper arm in mm, from 1e-6 to 1000000.0"),
        ("c1 = 615.0", "c1 = -1e7", 12, "expected a length in mm, from -1000000.0 to 1000000.0"),
        ("min = -170.0", "min = -1e7", 29, "`min` of [[axis]] is -10000000.0: expected the lowest position, from"),
        ("offsets = [0,", "offsets = [1e9,", 16, "six angles in deg, from -1000000.0"),
        ("home = [0, 0, 0, 0, 90, 0]", "home = [0, 0, 200, 0, 0, 0]", 6, "`home` of j3 is 200"),
        ("home = [0, 0, 0, 0, 90, 0]", "home = [0]", 6, "expected 6 positions"),
        ("profile = \"S\"", "profile = ", 5, "not TOML"),
    ] {
        let found = error(&changed(from, to));
        assert_eq!(found.line, line, "{from} -> {to}: {found}");
        assert!(found.message.contains(words), "{from} -> {to}: {found}");
    }
}

#[test]
fn home_and_external_axes_are_read() {
    let text = changed("home = [0, 0, 0, 0, 90, 0]", "home = [1, 2, 3, 4, 5, 6, 700]")
        + "[[axis]]\nname = \"ej1\"\nlinear = true\nmin = 500\nmax = 1000\nvel = 1\nacc = 1\njerk = 1\n";
    let robot = Robot::parse("arm.toml", &text).unwrap();
    assert_eq!(robot.home, [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 700.0]);
    assert_eq!(robot.external_axes().len(), 1);
    assert!(robot.external_axes()[0].linear);
    let text = text.replacen("home = [1, 2, 3, 4, 5, 6, 700]", "", 1);
    assert_eq!(Robot::parse("arm.toml", &text).unwrap().home[6], 500.0, "0 is brought into the range");
}

#[test]
fn links_are_all_or_none() {
    let link =
        "[[link]]\nmass = 10\ncom = [0, 0, 100]\ninertia = [1, 0, 0, 1, 0, 1]\ngear = 100\ntorque_constant = 0.5\n";
    let text = Robot::text("six-10").unwrap().split("\n[[link]]").next().unwrap().to_owned() + "\n";
    assert_eq!(Robot::parse("arm.toml", &text).unwrap().links.len(), 0);
    assert_eq!(Robot::parse("arm.toml", &(text.clone() + &link.repeat(6))).unwrap().links.len(), 6);
    assert!(error(&(text + link)).message.contains("expected 6 [[link]]"));
}

#[test]
fn unknown_robots_and_missing_files_are_distinguished() {
    assert!(Robot::load("kr10-r1240").unwrap_err().message.contains("did you mean `kr10-r1420`"));
    assert!(Robot::load("no/such/robot.toml").unwrap_err().message.contains("cannot read"));
}

#[test]
fn any_text_is_refused_without_a_panic() {
    for text in ["", "[", "axis = 3", "[[axis]]", "geometry = 1\nname=\"a\"\nfamily=\"scara\"", "\u{feff}", "a\u{0}b"] {
        error(text);
    }
}

/// Sets a value of a description.
type Put = fn(&mut Description, f64);

#[test]
fn what_is_changed_is_checked_as_a_file_is() {
    let limits: [Put; 14] = [
        |robot, value| robot.axes[0].vel = value,
        |robot, value| robot.axes[5].acc = value,
        |robot, value| robot.axes[2].jerk = value,
        |robot, value| robot.tcp.vel = value,
        |robot, value| robot.tcp.acc = value,
        |robot, value| robot.tcp.jerk = value,
        |robot, value| robot.tcp.ori_vel = value,
        |robot, value| robot.tcp.ori_acc = value,
        |robot, value| robot.tcp.ori_jerk = value,
        |robot, value| robot.drives.following[3] = value,
        |robot, value| robot.drives.feedback = value,
        |robot, value| robot.drives.settled = value,
        |robot, value| robot.links[1].mass = value,
        |robot, value| robot.kinematics = lengths(robot, |p| p.c2 = value),
    ];
    for (place, put) in limits.iter().enumerate() {
        for value in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e-300, 1e300] {
            let mut described = Robot::builtin("kr10-r1420").unwrap().into_description();
            put(&mut described, value);
            let error = Robot::new(described).unwrap_err();
            assert!(error.message.contains(&format!("{value:?}")), "{place}: {value}: {error}");
            assert_eq!((error.file.as_str(), error.line), ("kr10-r1420", 0));
        }
    }
    let others: [(Put, &str); 9] = [
        (|robot, _| robot.axes[0].min = 171.0, "`min` of j1 is 171"),
        (|robot, none| robot.axes[0].max = none, "`max` of j1 is NaN"),
        (|robot, _| robot.axes[1].name = "j3".into(), "expected \"j2\""),
        (|robot, _| robot.axes[1].linear = true, "`linear` of j2 is true"),
        (|robot, _| robot.axes.truncate(5), "there are 5 axes"),
        (|robot, none| robot.home[4] = none, "`home` of j5 is NaN"),
        (|robot, _| robot.home.push(0.0), "`home` has 7 positions"),
        (|robot, _| robot.family = Family::Scara, "another family"),
        (|robot, none| robot.kinematics = lengths(robot, |p| p.a1 = none), "`a1` of the geometry is NaN"),
    ];
    for (put, words) in others {
        let mut described = Robot::builtin("kr10-r1420").unwrap().into_description();
        put(&mut described, f64::NAN);
        let error = Robot::new(described).unwrap_err().to_string();
        assert!(error.contains(words), "{error}");
    }
    for name in Robot::builtin_names() {
        let robot = Robot::builtin(name).unwrap();
        assert_eq!(Robot::new(robot.clone().into_description()).unwrap(), robot);
    }
}

/// The changed geometry of a six-axis robot.
fn lengths(robot: &Description, change: impl FnOnce(&mut OpwParameters)) -> Kinematics {
    let Kinematics::SixAxis(opw) = &robot.kinematics else { panic!("{} has other axes", robot.name) };
    let mut parameters = *opw.parameters();
    change(&mut parameters);
    Kinematics::SixAxis(Opw::new(parameters))
}
