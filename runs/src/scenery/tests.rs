//! Robots and bodies from URDF files.

use std::path::PathBuf;

use arl_robot::robot::Robot;

use super::*;

/// A folder for the files of a test, removed at its end.
pub(crate) struct Files(pub(crate) PathBuf);

impl Files {
    pub(crate) fn new(name: &str) -> Self {
        let folder = std::env::temp_dir().join(format!("arl2rs-scenery-{name}-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        Self(folder)
    }

    pub(crate) fn write(&self, name: &str, text: &str) -> PathBuf {
        let file = self.0.join(name);
        std::fs::create_dir_all(file.parent().unwrap()).unwrap();
        std::fs::write(&file, text).unwrap();
        file
    }
}

impl Drop for Files {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

/// The arm of the KR 10 R1420 as kuka_experimental describes its joints: name, place, turn, axis.
const ARM: [[&str; 4]; 6] = [
    ["joint_a1", "0 0 0.450", "0 0 0", "0 0 -1"],
    ["joint_a2", "0.150 0 0", "0 0 0", "0 1 0"],
    ["joint_a3", "0.610 0 0", "0 0 0", "0 1 0"],
    ["joint_a4", "0 0 0.02", "0 0 0", "-1 0 0"],
    ["joint_a5", "0.660 0 0", "0 0 0", "0 1 0"],
    ["joint_a6", "0.080 0 0", "0 0 0", "-1 0 0"],
];

/// A URDF of that arm whose links have these forms, the base first, and something bolted to the third one.
pub(crate) fn arm(forms: [&str; 7]) -> String {
    let mut links = String::new();
    let mut joints = String::new();
    for (at, form) in forms.iter().enumerate() {
        links += &format!("<link name=\"link_{at}\">{form}</link>");
    }
    for (at, [name, xyz, rpy, axis]) in ARM.iter().enumerate() {
        joints += &format!(
            "<joint name=\"{name}\" type=\"revolute\"><origin xyz=\"{xyz}\" rpy=\"{rpy}\"/><parent link=\"link_{at}\"/>\
             <child link=\"link_{}\"/><axis xyz=\"{axis}\"/><limit lower=\"-3\" upper=\"3\" effort=\"1\" velocity=\"4\"/></joint>",
            at + 1
        );
    }
    format!(
        "<robot name=\"kr10\"><material name=\"paint\"><color rgba=\"1 0.5 0 1\"/></material>{links}{joints}\
         <link name=\"valves\"><visual><geometry><box size=\"0.1 0.2 0.3\"/></geometry></visual></link>\
         <joint name=\"bolts\" type=\"fixed\"><origin xyz=\"0 0 0.1\"/><parent link=\"link_3\"/><child link=\"valves\"/></joint></robot>"
    )
}

pub(crate) const BALL: &str = "<collision><geometry><sphere radius=\"0.05\"/></geometry></collision>";
pub(crate) const ROD: &str = "<visual><origin xyz=\"0.3 0 0\" rpy=\"0 1.5707963267948966 0\"/><geometry><cylinder radius=\"0.04\" length=\"0.6\"/></geometry>\
                   <material name=\"paint\"/></visual>";

/// The scenery of a cell whose first robot is the default one.
pub(crate) fn scenery_of(cell: &Cell) -> Result<Scenery, Failure> {
    let beside = cell.programs.channels.iter().filter(|channel| !channel.background);
    let named = beside.map(|channel| Robot::load(channel.robot.as_deref().unwrap_or("kr10-r1420")).unwrap());
    let robots: Vec<Robot> = std::iter::once(kr10()).chain(named).collect();
    Scenery::of(cell, &robots, &|_| ())
}

fn kr10() -> Robot {
    Robot::builtin("kr10-r1420").unwrap()
}

fn links(shape: &Shape) -> Vec<Looks> {
    shape.links().map(|(_, looks)| looks.clone()).collect()
}

#[test]
fn links_of_a_urdf_are_where_the_robot_has_them() {
    let files = Files::new("fit");
    let file = files.write("arm.urdf", &arm(["", BALL, ROD, BALL, "", "", BALL]));
    let shape = Shape::read(&file, &kr10()).unwrap();
    let links = links(&shape);
    assert_eq!(links.iter().map(|link| link.touched.len()).collect::<Vec<_>>(), [0, 1, 1, 2, 0, 0, 1]);
    // Forms that are only seen are touched, too, and the other way round.
    assert_eq!(links[2].seen, links[2].touched);
    assert_eq!(links[1].seen.len(), 1);
    assert_eq!(links[2].seen[0].color, Some([1.0, 0.5, 0.0, 1.0]));
    assert_eq!(links[1].touched[0].solid, Solid::Sphere(50.0));
    let Solid::Cylinder { radius, length } = links[2].touched[0].solid else { panic!("a cylinder") };
    assert!((radius - 40.0).abs() < 1e-9 && (length - 600.0).abs() < 1e-9);
    // Axis 2 at 0: the upper arm lies along x, and its middle 300 mm before its joint.
    let robot = kr10();
    let place = |axes: [f64; 6], link: usize| {
        let (joints, _) = robot.kinematics.links();
        let joints = joints.iter().zip(axes).take(link);
        joints.fold(Frame::identity(), |before, (joint, axis)| before * joint.at(axis))
    };
    for (axes, wanted) in [([0.0; 6], [450.0, 0.0, 450.0]), ([0.0, -90.0, 0.0, 0.0, 0.0, 0.0], [150.0, 0.0, 750.0])] {
        let middle = (place(axes, 2) * links[2].touched[0].at).translation.vector;
        let off = (middle - nalgebra::Vector3::from(wanted)).norm();
        assert!(off < 1e-3, "{middle} {wanted:?}");
    }
}

#[test]
fn another_robot_is_refused_by_name() {
    let files = Files::new("other");
    let good = arm(["", BALL, ROD, BALL, "", "", BALL]);
    let refused = |text: &str, robot: &str| {
        let file = files.write("arm.urdf", text);
        Shape::read(&file, &Robot::load(robot).unwrap()).unwrap_err()
    };
    for (text, robot, words) in [
        (good.replace("0.610 0 0", "0.510 0 0"), "kr10", "its flange is"),
        (good.replace("\"0 0 -1\"", "\"0 0 1\""), "kr10", "its flange is"),
        (good.replace("<sphere radius=\"0.05\"/>", "<mesh filename=\"none.stl\"/>"), "kr10", "there is no file"),
        (
            good.replace("<sphere radius=\"0.05\"/>", "<mesh filename=\"file:///no%20folder/a.stl\"/>"),
            "kr10",
            "/no folder/a.stl",
        ),
        (good.clone(), "hsr065", "its arm has 6 moving joints, but hsr065 has 4 axes"),
        (good.replace("0.05", "0"), "kr10", "link `link_1`: it has a form whose size is not finite and above 0"),
        (
            good.replace("<sphere radius=\"0.05\"/>", "<mesh filename=\"package://no_such/a.stl\"/>"),
            "kr10",
            "is not found: no folder `no_such`",
        ),
        (good.replace("<sphere radius=\"0.05\"/>", "<mesh filename=\"a.dae\"/>"), "kr10", "`a.dae` is not an STL file"),
        (
            arm([""; 7]).replace("<visual><geometry><box size=\"0.1 0.2 0.3\"/></geometry></visual>", ""),
            "kr10",
            "none of its links has a form",
        ),
        ("<robot xmlns:xacro=\"\"><xacro:macro/></robot>".into(), "kr10", "this is a xacro file"),
        ("no xml".into(), "kr10", "this is not URDF"),
    ] {
        let robot = if robot == "kr10" { kr10().name.clone() } else { robot.to_owned() };
        let problem = refused(&text, &robot);
        assert!(problem.contains(words), "{problem}\n{words}");
    }
}

#[test]
fn a_scara_has_its_shape_too() {
    let files = Files::new("scara");
    let robot = Robot::load("hsr065").unwrap();
    let geometry = robot.kinematics.forward(&[0.0; 6]).translation.vector;
    // The arms are as long as the robot's; the spindle turns before it slides, or after.
    let (joints, _) = robot.kinematics.links();
    let l1 = joints[1].origin.translation.vector.x / 1000.0;
    let l2 = geometry.x / 1000.0 - l1;
    let z = geometry.z / 1000.0;
    let urdf = |third: &str, fourth: &str, form_between: &str| {
        let limits = "<limit lower=\"-1\" upper=\"1\" effort=\"1\" velocity=\"2\"/>";
        let joint = |name: &str, kind: &str, x: f64, z: f64, [parent, child]: [&str; 2]| {
            format!(
                "<joint name=\"{name}\" type=\"{kind}\"><origin xyz=\"{x} 0 {z}\"/><parent link=\"{parent}\"/><child link=\"{child}\"/>\
                 <axis xyz=\"0 0 1\"/>{limits}</joint>"
            )
        };
        let links = [("base", ""), ("one", ""), ("two", BALL), ("between", form_between), ("spindle", BALL)];
        let links: String = links.iter().map(|(name, form)| format!("<link name=\"{name}\">{form}</link>")).collect();
        format!(
            "<robot name=\"scara\">{links}{}{}{}{}</robot>",
            joint("j1", "revolute", 0.0, z, ["base", "one"]),
            joint("j2", "revolute", l1, 0.0, ["one", "two"]),
            joint("j3", third, l2, 0.0, ["two", "between"]),
            joint("j4", fourth, 0.0, 0.0, ["between", "spindle"]),
        )
    };
    let read = |text: &str| Shape::read(&files.write("scara.urdf", text), &robot);
    let forms = |shape: &Shape| links(shape).iter().map(|link| link.touched.len()).collect::<Vec<_>>();
    assert_eq!(forms(&read(&urdf("prismatic", "revolute", BALL)).unwrap()), [0, 0, 1, 1, 1]);
    assert_eq!(forms(&read(&urdf("revolute", "prismatic", "")).unwrap()), [0, 0, 1, 0, 1]);
    let problem = read(&urdf("revolute", "prismatic", BALL)).unwrap_err();
    assert!(problem.contains("its link `between` does not move like any link of"), "{problem}");
    let higher = urdf("prismatic", "revolute", BALL).replace(&format!("0 0 {z}"), "0 0 0.5");
    let problem = read(&higher).unwrap_err();
    assert!(problem.contains("its flange is") && problem.contains("mm from that of"), "{problem}");
}

#[test]
fn meshes_are_found_beside_the_file_and_in_packages() {
    let files = Files::new("meshes");
    let mesh = |name: &str| {
        format!("<collision><geometry><mesh filename=\"{name}\" scale=\"0.001 0.001 0.001\"/></geometry></collision>")
    };
    files.write("arm_support/meshes/a.stl", "");
    // A form that cannot be drawn is drawn as it is touched.
    let seen = "<visual><geometry><mesh filename=\"package://arm_support/meshes/a.dae\"/></geometry></visual>";
    let both = format!("{seen}{}", mesh("package://arm_support/meshes/a.stl"));
    let file = files.write("arm_support/urdf/arm.urdf", &arm(["", &both, &mesh("../meshes/a.stl"), "", "", "", ""]));
    let links = links(&Shape::read(&file, &kr10()).unwrap());
    assert_eq!(links[1].seen, links[1].touched);
    for link in [1, 2] {
        let Solid::Mesh { file, scale } = &links[link].touched[0].solid else { panic!("a mesh") };
        assert!(file.is_file(), "{}", file.display());
        assert_eq!(*scale, [1.0; 3]);
    }
}

#[test]
fn a_body_has_all_links_of_its_urdf() {
    let files = Files::new("body");
    let table = "<robot name=\"table\"><link name=\"top\"><visual><geometry><box size=\"1 0.5 0.04\"/></geometry></visual></link>\
                 <link name=\"leg\"><collision><origin xyz=\"0 0 -0.35\"/><geometry><capsule radius=\"0.02\" length=\"0.7\"/></geometry></collision></link>\
                 <joint name=\"screws\" type=\"fixed\"><origin xyz=\"0.4 0.2 0\"/><parent link=\"top\"/><child link=\"leg\"/></joint></robot>";
    let file = files.write("table.urdf", table);
    let cell = |file: &std::path::Path| {
        let text = format!("[[body]]\nname = \"table\"\nurdf = {:?}\nat = [800, 0, 0]\n", file.display().to_string());
        scenery_of(&Cell::parse("cell.toml", &text).unwrap())
    };
    let scenery = cell(&file).unwrap();
    let (_, looks) = &scenery.bodies[0];
    assert_eq!((looks.seen.len(), looks.touched.len()), (4, 4));
    let at = looks.touched[1].at.translation.vector;
    assert!((at - nalgebra::Vector3::new(400.0, 200.0, -350.0)).norm() < 1e-9);
    let Failure::Usage(text) = cell(&files.0.join("none.urdf")).unwrap_err() else { panic!("a usage failure") };
    assert!(text.starts_with("body `table`: ") && text.contains("cannot be read"), "{text}");
}

#[test]
fn a_carrier_has_an_axis_of_its_robot() {
    let files = Files::new("carrier");
    let axis = "[[axis]]\nname = \"ej1\"\nmin = -90\nmax = 90\nvel = 90\nacc = 400\njerk = 4000\n";
    let built = arl_robot::Robot::text("kr10-r1420").unwrap();
    let (before, links) = built.split_at(built.find("\n[[link]]").unwrap() + 1);
    let file = files.write("arm.toml", &format!("{before}{axis}\n{links}"));
    let cell = |axis: &str| Cell::parse("cell.toml", &format!("[[carrier]]\naxis = \"{axis}\"\n")).unwrap();
    let of = |axis: &str, robot: Option<&str>| {
        let robot = Robot::load(robot.unwrap_or("kr10-r1420")).unwrap();
        Scenery::of(&cell(axis), &[robot], &|_| ())
    };
    let arm = file.display().to_string();
    assert_eq!(of("ej1", Some(&arm)).unwrap().carriers.len(), 1);
    for (axis, robot, words) in [
        ("ej2", Some(&*arm), "`ej2`, but the robot kr10-r1420 of channel 1 has only ej1"),
        ("ej1", None, "`ej1`, but the robot kr10-r1420 of channel 1 has no external axes"),
    ] {
        let Failure::Usage(text) = of(axis, robot).unwrap_err() else { panic!("a usage failure") };
        assert!(text.contains(words), "{text}");
    }
}

#[test]
fn a_robot_whose_urdf_is_wrong_has_capsules() {
    let cell = Cell::parse("cell.toml", "urdf = \"/no/such/arm.urdf\"\n").unwrap();
    let scenery = scenery_of(&cell).unwrap();
    assert!(scenery.shape(0).is_none());
}
