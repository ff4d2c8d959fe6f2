//! Robots from URDF files.

use super::*;

/// A joint: name, type, xyz, rpy, axis.
type Joint<'a> = (&'a str, &'a str, &'a str, &'a str, &'a str);

/// A URDF of a chain of joints.
fn urdf(joints: &[Joint<'_>]) -> String {
    let mut out = String::from("<robot name=\"arm\"><link name=\"base_link\"/>");
    let mut parent = "base_link".to_owned();
    for (name, kind, xyz, rpy, axis) in joints {
        let child = if *kind == "fixed" { (*name).to_owned() } else { format!("{name}_link") };
        let _ = write!(
            out,
            "<link name=\"{child}\"/><joint name=\"{name}\" type=\"{kind}\"><origin xyz=\"{xyz}\" rpy=\"{rpy}\"/>\
             <parent link=\"{parent}\"/><child link=\"{child}\"/><axis xyz=\"{axis}\"/>\
             <limit lower=\"-2\" upper=\"3\" effort=\"0\" velocity=\"4\"/></joint>"
        );
        parent = child;
    }
    out + "</robot>"
}

/// As kuka_experimental describes the KR 10 R1420.
const KR10: [Joint<'_>; 7] = [
    ("joint_a1", "revolute", "0 0 0.450", "0 0 0", "0 0 -1"),
    ("joint_a2", "revolute", "0.150 0 0", "0 0 0", "0 1 0"),
    ("joint_a3", "revolute", "0.610 0 0", "0 0 0", "0 1 0"),
    ("joint_a4", "revolute", "0 0 0.02", "0 0 0", "-1 0 0"),
    ("joint_a5", "revolute", "0.660 0 0", "0 0 0", "0 1 0"),
    ("joint_a6", "revolute", "0.080 0 0", "0 0 0", "-1 0 0"),
    ("tool0", "fixed", "0 0 0", "0 1.57079632679 0", "1 0 0"),
];

const SCARA: [Joint<'_>; 4] = [
    ("a", "revolute", "0 0 0.1", "0 0 0", "0 0 1"),
    ("b", "revolute", "0.375 0 0.1", "0 0 0", "0 0 1"),
    ("c", "prismatic", "0.275 0 0", "0 0 0", "0 0 1"),
    ("d", "continuous", "0 0 0.05", "0 0 0", "0 0 1"),
];

fn changed<const N: usize>(mut joints: [Joint<'static>; N], at: usize, joint: Joint<'static>) -> String {
    joints[at] = joint;
    urdf(&joints)
}

/// A key of the robot file.
fn value(file: &str, key: &str) -> toml::Value {
    let table: toml::Table = toml::from_str(file).unwrap_or_else(|error| panic!("{error}\n{file}"));
    table["geometry"][key].clone()
}

fn list(file: &str, key: &str) -> Vec<f64> {
    let value = value(file, key);
    let number = |value: &toml::Value| value.as_float().or(value.as_integer().map(|integer| integer as f64));
    value.as_array().map(|all| all.iter().filter_map(number).collect()).unwrap_or_default()
}

#[test]
fn a_known_arm_gets_the_geometry_of_the_built_in_one() {
    let file = robot_file(&urdf(&KR10), "kr10.urdf").unwrap();
    let known = arl_robot::Robot::text("kr10-r1420").unwrap_or_default();
    for key in ["a1", "a2", "b", "c1", "c2", "c3", "c4"] {
        assert_eq!(value(&file, key), value(known, key), "{key}\n{file}");
    }
    assert_eq!(list(&file, "signs"), list(known, "signs"));
    let same = list(&file, "offsets").iter().zip(list(known, "offsets")).all(|(a, b)| (a - b).abs() < 1e-5);
    assert!(same, "{file}");
    assert!(
        file.contains("[[axis]]  # deg; `joint_a3` in the URDF\nname = \"j3\"\nmin = -114.591559\nmax = 171.887339\n")
    );
    assert!(file.contains("vel = 229.183118\nacc = 1145.91559\n"), "{file}");
}

#[test]
fn frames_may_be_turned_any_way() {
    // The same arm, each joint's frame turned so that its axis is its z, and a base plate under it.
    let joints: [Joint<'_>; 8] = [
        ("plate", "fixed", "0 0 0.050", "0 0 0.5", "1 0 0"),
        ("j1", "revolute", "0 0 0.400", "0 0 0", "0 0 1"),
        ("j2", "revolute", "0.150 0.020 0", "-1.5707963267948966 0 0", "0 0 1"),
        ("j3", "revolute", "0 -0.610 0", "0 0 0", "0 0 1"),
        ("j4", "revolute", "0.020 -0.300 0", "1.5707963267948966 0 0", "0 0 1"),
        ("j5", "revolute", "0 0 0.360", "-1.5707963267948966 0 0", "0 0 -1"),
        ("j6", "revolute", "0 -0.080 0", "1.5707963267948966 0 0", "0 0 1"),
        ("arm_tool0", "fixed", "0 0 0.010", "0 0 0", "1 0 0"),
    ];
    let file = robot_file(&urdf(&joints), "arm.urdf").unwrap();
    for (key, expected) in
        [("a1", 150.0), ("a2", 20.0), ("b", 20.0), ("c1", 450.0), ("c2", 610.0), ("c3", 660.0), ("c4", 90.0)]
    {
        let found = value(&file, key).as_float().unwrap_or(f64::NAN);
        assert!((found - expected).abs() < 1e-6, "{key} {found}\n{file}");
    }
    assert_eq!(list(&file, "signs"), [1.0, 1.0, 1.0, 1.0, -1.0, 1.0]);
    assert!((list(&file, "offsets")[0] + 0.5_f64.to_degrees()).abs() < 1e-5, "{file}");
}

#[test]
fn scara_robots_fit_too() {
    let file = robot_file(&urdf(&SCARA), "scara.urdf").unwrap();
    assert!(file.contains("l1 = 375.0\nl2 = 275.0\nz0 = 250.0\n"), "{file}");
    assert!(
        file.contains("[[axis]]  # mm; `c` in the URDF\nname = \"j3\"\nmin = -2000.0\nmax = 3000.0\nvel = 4000.0\n")
    );
    assert!(file.contains("name = \"j4\"\nmin = -360.0\nmax = 360.0\n"));
    // Turning first, then sliding.
    let [a, b, mut c, mut d] = SCARA;
    (c.1, d.1) = ("revolute", "prismatic");
    let file = robot_file(&urdf(&[a, b, c, d]), "scara.urdf").unwrap();
    assert!(
        file.contains("`d` in the URDF\nname = \"j3\"") && file.contains("`c` in the URDF\nname = \"j4\""),
        "{file}"
    );
}

#[test]
fn what_does_not_fit_is_reported() {
    let refused = |text: &str, words: &str| {
        let problem = robot_file(text, "x.urdf").expect_err(words);
        assert!(problem.contains(words), "{problem}\ninstead of {words}");
    };
    refused("<robot name='a'>", "this is not URDF");
    refused("<robot xmlns:xacro='x'><xacro:macro/></robot>", "make a URDF from it first");
    refused(&urdf(&KR10[..5]), "has 5 moving joints (joint_a1, joint_a2, joint_a3, joint_a4, joint_a5)");
    refused("<robot name=\"a\"><link name=\"x\"/></robot>", "has 0 moving joints;");
    let kr10 = |at, joint| changed(KR10, at, joint);
    refused(&kr10(0, ("joint_a1", "revolute", "0 0 0.450", "0 0 0", "0 1 0")), "axis 1 (`joint_a1`) is not vertical");
    refused(&kr10(0, ("joint_a1", "revolute", "0.1 0 0.450", "0 0 0", "0 0 1")), "base's origin");
    refused(&kr10(2, ("joint_a3", "revolute", "0.610 0 0", "0 0 0", "0 0 1")), "not level and parallel");
    refused(&kr10(2, ("joint_a3", "revolute", "0 0.610 0", "0 0 0", "0 1 0")), "are the same line");
    refused(&kr10(4, ("joint_a5", "revolute", "0.660 0 0.03", "0 0 0", "0 1 0")), "by 30.000 mm: no spherical wrist");
    refused(&kr10(5, ("joint_a6", "revolute", "0.080 0 0.01", "0 0 0", "-1 0 0")), "do not meet at a right angle");
    refused(&kr10(6, ("tool0", "fixed", "0 0.05 0", "0 0 0", "1 0 0")), "mm off");
    refused(&kr10(3, ("joint_a4", "prismatic", "0 0 0.02", "0 0 0", "-1 0 0")), "`joint_a4` slides");
    refused(&kr10(3, ("joint_a4", "planar", "0 0 0.02", "0 0 0", "-1 0 0")), "neither turns about a line");
    refused(&urdf(&KR10).replacen("upper=\"3\"", "upper=\"-3\"", 1), "`joint_a1` has no range");
    refused(&urdf(&KR10).replacen("velocity=\"4\"", "velocity=\"0\"", 1), "`joint_a1` has no speed");
    let limits = "lower=\"-2\" upper=\"3\"";
    refused(&urdf(&KR10).replacen(limits, "", 1), "`joint_a1` has no range");
    let slow = urdf(&KR10).replacen("velocity=\"4\"", "velocity=\"1e-9\"", 1);
    refused(&slow, "no robot file can describe it: `vel`");
    let scara = |at, joint| changed(SCARA, at, joint);
    refused(&scara(1, ("b", "revolute", "0.375 0 0.1", "0 0 0", "0 0 -1")), "does not point upwards");
    refused(&scara(1, ("b", "revolute", "0.3 0.1 0.1", "0 0 0", "0 0 1")), "not stretched along x");
    refused(&scara(2, ("c", "revolute", "0.275 0 0", "0 0 0", "0 0 1")), "one must slide");
    let fork = urdf(&KR10).replace(
        "</robot>",
        "<link name=\"finger\"/><joint name=\"grip\" type=\"prismatic\"><parent link=\"joint_a3_link\"/>\
         <child link=\"finger\"/><limit lower=\"0\" upper=\"1\" effort=\"0\" velocity=\"1\"/></joint></robot>",
    );
    refused(&fork, "moving joints branch into `joint_a4` and `grip`");
    refused(&urdf(&KR10).replace("</robot>", "<link name=\"loose\"/></robot>"), "`base_link` and `loose`");
}
