//! Contacts compared with a computation that checks every pair in every cycle.

use arl_robot::cell::Cell;
use arl_robot::kinematics::random::Random;
use arl_robot::robot::Robot;
use serde_json::json;

use super::*;
use crate::scenery::tests::scenery_of;
use crate::scenery::tests::{BALL, Files, ROD, arm};
use arl_wire::{Cycle, Hello, Moves, State};

/// What a program reports of its robots.
fn hello(robots: &[&str]) -> Hello {
    let channels: Vec<serde_json::Value> = robots
        .iter()
        .map(|name| {
            let robot = Robot::load(name).unwrap();
            let (joints, flange) = robot.kinematics.links();
            let placed = |frame: &arl_robot::kinematics::Frame| {
                let (at, turned) = (frame.translation.vector, frame.rotation.coords);
                [at.x, at.y, at.z, turned.x, turned.y, turned.z, turned.w]
            };
            let links = joints.iter().map(|joint| {
                let axis = [joint.axis.x, joint.axis.y, joint.axis.z];
                json!({"origin": placed(&joint.origin), "axis": axis, "linear": joint.linear})
            });
            let limbs = robot.limbs();
            let limbs = limbs.iter().map(|limb| json!({"name": limb.name, "link": limb.link, "ends": limb.ends, "radius": limb.radius}));
            let axes = robot.own_axes().iter().map(|axis| {
                let unit = if axis.linear { "mm" } else { "deg" };
                json!({"name": axis.name, "unit": unit, "min": axis.min, "max": axis.max})
            });
            json!({"program": "a.arl", "robot": name, "axes": axes.collect::<Vec<_>>(), "links": links.collect::<Vec<_>>(),
                   "flange": placed(&flange), "limbs": limbs.collect::<Vec<_>>()})
        })
        .collect();
    serde_json::from_value(json!({"channels": channels, "names": {}})).unwrap()
}

const BASES: [[f64; 6]; 2] = [[0.0; 6], [900.0, 0.0, 0.0, 180.0, 0.0, 0.0]];

/// A cycle in which robots are there, on bases side by side.
fn cycle(step: u32, axes: &[Vec<f64>]) -> Cycle {
    let moves = |(axes, base): (&Vec<f64>, &[f64; 6])| Moves {
        file: "a.arl".into(),
        line: 1 + step / 500,
        base: base.to_vec(),
        axes: axes.clone(),
    };
    let channels = axes.iter().zip(&BASES).map(moves).collect();
    Cycle { time: f64::from(step) * 0.001, channels, ..Cycle::default() }
}

fn scenery(text: &str) -> Scenery {
    scenery_of(&Cell::parse("cell.toml", text).unwrap()).unwrap()
}

fn scene(scenery: &Scenery) -> Result<Scene, Failure> {
    Scene::of(scenery, &|_| {})
}

fn begun(text: &str, clearance: f64, robots: &[&str]) -> Collisions {
    let (mut collisions, _) = Collisions::new(scene(&scenery(text)).unwrap(), clearance, false);
    collisions.begin(&hello(robots));
    collisions
}

/// A smooth random motion within the ranges of a robot, as fast as robots are.
fn motion(robot: &Robot, random: &mut Random) -> impl Fn(u32) -> Vec<f64> + use<> {
    let mut axes = Vec::new();
    for axis in robot.own_axes() {
        let half = 0.45 * (axis.max - axis.min);
        let (middle, speed) = (0.5 * (axis.min + axis.max), random.between(0.2, 1.2));
        axes.push((middle, half, speed, random.between(0.0, 6.0)));
    }
    move |step| {
        let time = f64::from(step) * 0.001;
        axes.iter().map(|(middle, half, speed, phase)| middle + half * (speed * time + phase).sin()).collect()
    }
}

/// For each pair of a cell, the first cycle in which it touches, and its closest approach before that, looked for in
/// each cycle.
fn by_checking_each_cycle(collisions: &mut Collisions, cycles: &[Cycle]) -> Vec<(String, String, Option<f64>, f64)> {
    let mut found: Vec<(String, String, Option<f64>, f64)> = collisions
        .pairs
        .iter()
        .map(|pair| {
            let [one, other] = pair.items.map(|at| collisions.items[at].name.clone());
            (one, other, None, f64::INFINITY)
        })
        .collect();
    for cycle in cycles {
        collisions.go_to(cycle);
        for (pair, (.., touched, nearest)) in collisions.pairs.iter().zip(&mut found) {
            let [one, other] = pair.items.map(|at| &collisions.items[at]);
            let [here, there] = [one, other].map(|item| place(item, &collisions.arms).unwrap());
            let distance = parry3d_f64::query::distance(&here, &*one.shape, &there, &*other.shape).unwrap().distance;
            if distance <= 0.0 {
                touched.get_or_insert(cycle.time);
            } else if touched.is_none() {
                *nearest = nearest.min(distance);
            }
        }
    }
    found
}

#[test]
fn no_contact_is_missed_and_the_nearest_is_near() {
    const CLEARANCE: f64 = 60.0;
    let mut random = Random::new(19);
    let (mut touched, mut near) = (0, 0);
    for round in 0..6 {
        let robots = if round % 3 == 2 { vec!["kr10-r1420", "hsr065"] } else { vec!["kr10-r1420"] };
        let mut text = String::new();
        for body in 0..6 {
            let [x, y, z] = [0; 3].map(|_| random.between(-1200.0, 1200.0));
            let form = if body % 2 == 0 { "box = [120, 200, 300]" } else { "cylinder = [60, 250]" };
            text += &format!("[[body]]\nname = \"body {body}\"\n{form}\nat = [{x}, {y}, {}, 10, 20, 30]\n", z.abs());
        }
        text += "[[body]]\nname = \"tool\"\ncylinder = [25, 180]\nat = [0, 0, 120]\non = \"flange\"\n";
        let motions: Vec<_> = robots.iter().map(|name| motion(&Robot::load(name).unwrap(), &mut random)).collect();
        let at = |step| cycle(step, &motions.iter().map(|motion| motion(step)).collect::<Vec<_>>());
        let cycles: Vec<Cycle> = (0..1500).map(at).collect();
        let expected = by_checking_each_cycle(&mut begun(&text, CLEARANCE, &robots), &cycles);
        let mut collisions = begun(&text, CLEARANCE, &robots);
        let contacts: Vec<Contact> = cycles.iter().flat_map(|cycle| collisions.cycle(cycle)).collect();
        let own: Vec<bool> = collisions.pairs.iter().map(Pair::is_own).collect();
        let nearest = collisions.nearest();
        for ((one, other, first, least), own) in expected.into_iter().zip(own) {
            let is_it = |contact: &&Contact| (&contact.one, &contact.other) == (&one, &other);
            let found = contacts.iter().find(is_it).map(|contact| contact.time);
            assert_eq!(found, first, "{one}, {other}");
            let found = nearest.iter().find(is_it).map(|contact| contact.distance);
            match found {
                Some(found) => assert!(found - least < 0.06 && found >= least, "{one}, {other}: {found} {least}"),
                None => assert!(own || first.is_some() || least >= CLEARANCE - 0.06, "{one}, {other}: {least}"),
            }
            touched += u32::from(first.is_some());
            near += u32::from(found.is_some());
        }
    }
    assert!(touched > 5 && near > 5, "{touched} {near}");
}

/// A tilting table of the second robot with a turning disc on it, and a slide.
const TABLE: &str = "[[carrier]]\naxis = \"ej1\"\nchannel = 2\nat = [700, 0, 500, 0, 0, 90]\n\
                     [[carrier]]\naxis = \"ej2\"\nchannel = 2\non = \"ej1\"\nat = [0, 150, 0, 0, 0, -90]\n\
                     [[carrier]]\naxis = \"ej3\"\nchannel = 2\nat = [-600, -150, 300, 0, 90, 0]\n\
                     [[body]]\nname = \"frame\"\nbox = [500, 100, 40]\non = \"ej1\"\nchannel = 2\n\
                     [[body]]\nname = \"part\"\nbox = [300, 60, 120]\nat = [40, 0, 100]\non = \"ej2\"\nchannel = 2\n\
                     [[body]]\nname = \"clamp\"\nbox = [80, 80, 80]\nat = [40, 0, 100]\non = \"ej2\"\nchannel = 2\n\
                     [[body]]\nname = \"drawer\"\nbox = [200, 200, 100]\non = \"ej3\"\nchannel = 2\n\
                     [[body]]\nname = \"post\"\nbox = [60, 60, 300]\nat = [700, 0, 150]\n\
                     [[channel]]\nprogram = \"b.arl\"\n";

fn begun_with_table(clearance: f64) -> Collisions {
    let cell = Cell::parse("cell.toml", TABLE).unwrap();
    let mut scenery = scenery_of(&Cell { carriers: Vec::new(), ..cell.clone() }).unwrap();
    scenery.carriers = cell.carriers;
    let mut hello = hello(&["kr10-r1420", "kr10-r1420"]);
    for (name, unit, most) in [("ej1", "deg", 120.0), ("ej2", "deg", 360.0), ("ej3", "mm", 800.0)] {
        hello.channels[1].axes.push(arl_wire::Axis { name: name.into(), unit: unit.into(), min: -most, max: most });
    }
    let (mut collisions, _) = Collisions::new(scene(&scenery).unwrap(), clearance, false);
    collisions.begin(&hello);
    collisions
}

/// A cycle with the table; the second robot is at rest.
fn cycle_with_table(step: u32, robot: Vec<f64>, external: [f64; 3]) -> Cycle {
    let standing = [&[0.0, -90.0, 90.0, 0.0, 0.0, 0.0], &external[..]].concat();
    let mut cycle = cycle(step, &[robot, standing]);
    cycle.channels[1].base = vec![0.0, 2500.0, 0.0, 0.0, 0.0, 0.0];
    cycle.channels[1].file = "b.arl".into();
    cycle
}

#[test]
fn what_external_axes_move_counts_in_each_cycle() {
    const CLEARANCE: f64 = 60.0;
    let robot = motion(&Robot::load("kr10-r1420").unwrap(), &mut Random::new(41));
    let at = |step: u32| {
        let time = f64::from(step) * 0.001;
        let external = [100.0 * (1.3 * time).sin(), 180.0 * (0.9 * time).cos(), 700.0 * (0.7 * time).sin()];
        cycle_with_table(step, robot(step), external)
    };
    let cycles: Vec<Cycle> = (0..4000).map(at).collect();
    let expected = by_checking_each_cycle(&mut begun_with_table(CLEARANCE), &cycles);
    let mut collisions = begun_with_table(CLEARANCE);
    let contacts: Vec<Contact> = cycles.iter().flat_map(|cycle| collisions.cycle(cycle)).collect();
    let nearest = collisions.nearest();
    let of_table = |name: &String| ["frame", "part", "clamp", "drawer"].contains(&&**name);
    let expected: Vec<_> = expected.into_iter().filter(|(one, other, ..)| of_table(one) || of_table(other)).collect();
    // What is on one carrier does not count with what is on the same one; with what is on another one it does.
    let pair = |names: [&str; 2]| expected.iter().any(|(one, other, ..)| names == [&**one, &**other]);
    assert!(pair(["part", "post"]) && pair(["frame", "part"]) && pair(["frame", "drawer"]) && !pair(["part", "clamp"]));
    let (mut touched, mut near) = (0, 0);
    for (one, other, first, least) in &expected {
        let is_it = |contact: &&Contact| (&contact.one, &contact.other) == (one, other);
        let found = contacts.iter().find(is_it);
        assert_eq!(found.map(|contact| contact.time), *first, "{one}, {other}");
        // It is reported with the place in the program whose axes move the carrier, where no robot moves.
        let by_carrier = of_table(one) && (of_table(other) || other == "post");
        assert!(found.is_none_or(|contact| contact.line > 0 && (!by_carrier || contact.file == "b.arl")), "{found:?}");
        touched += u32::from(found.is_some());
        match nearest.iter().find(is_it).map(|contact| contact.distance) {
            Some(found) => {
                assert!(found - least < 0.06 && found >= *least, "{one}, {other}: {found} {least}");
                near += 1;
            }
            None => assert!(first.is_some() || *least >= CLEARANCE - 0.06, "{one}, {other}: {least}"),
        }
    }
    assert!(touched >= 2 && near >= 1, "{touched} {near}: {contacts:?}");
}

#[test]
fn what_lies_on_carriers_touches_rightly_until_it_comes_apart() {
    let mut collisions = begun_with_table(0.0);
    let mut found = Vec::new();
    // Before anything moves, the frame reaches into the post; it leaves it, and comes back.
    for step in 0..3000_u32 {
        let time = f64::from(step) * 0.001;
        let mut here =
            cycle_with_table(step, vec![0.0, -90.0, 90.0, 0.0, 0.0, 0.0], [90.0 * (2.0 * time).cos(), 0.0, 0.0]);
        if step < 10 {
            here.channels.iter_mut().for_each(|moves| (moves.line, moves.file) = (0, String::new()));
        }
        found.extend(collisions.cycle(&here));
    }
    let post: Vec<_> = found.iter().filter(|contact| contact.other == "post" && contact.one == "frame").collect();
    // It is reported each time that it comes back, and not for how it was at first.
    assert_eq!(post.len(), 2, "{post:?}");
    assert!(post.iter().all(|contact| contact.time > 1.0 && contact.line > 0), "{post:?}");
}

#[test]
fn a_pair_is_looked_at_in_few_cycles() {
    let wall = "[[body]]\nname = \"wall\"\nbox = [10, 2000, 2000]\nat = [2500, 0, 0]\n";
    let mut collisions = begun(wall, 0.0, &["kr10-r1420"]);
    let motion = motion(&Robot::load("kr10-r1420").unwrap(), &mut Random::new(3));
    let mut looked = 0;
    for step in 0..2000 {
        let cycle = cycle(step, &[motion(step)]);
        collisions.arms[0].as_mut().unwrap().go_to(&cycle.channels[0]);
        looked += collisions.pairs.iter().filter(|pair| pair.is_due(&collisions.arms)).count();
        collisions.cycle(&cycle);
    }
    let all = 2000 * collisions.pairs.len();
    assert!(looked * 20 < all, "{looked} of {all}");
}

#[test]
fn what_is_carried_counts_while_its_signal_says_so() {
    let text = "[[body]]\nname = \"part\"\nbox = [50, 50, 200]\nat = [0, 0, 110]\non = \"flange\"\nwhen = \"do.2\"\n\
                [[body]]\nname = \"post\"\ncylinder = [30, 3000]\nat = [1150, 0, 0]\n";
    // Stretched out, the part reaches the post and the flange does not.
    let reached = |text: &str, dout: &str| {
        let mut collisions = begun(text, 0.0, &["kr10-r1420"]);
        let mut found = Vec::new();
        for step in 0..900 {
            let away = f64::from(900 - step) * 0.1;
            let here = cycle(step, &[vec![0.0, -60.0, 90.0 - 0.2 * away, 0.0, -30.0, 0.0]]);
            found.extend(collisions.cycle(&Cycle { dout: dout.into(), ..here }));
        }
        found.iter().any(|contact| (&*contact.one, &*contact.other) == ("part", "post"))
    };
    assert!(reached(text, "01") && !reached(text, "00"));
    let off = text.replace("do.2", "!do.2");
    assert!(reached(&off, "00") && !reached(&off, "01"));
    assert!(!reached(&text.replace("\"post\"", "\"post\"\nmay_touch = [\"part\"]"), "01"));
}

#[test]
fn the_robot_that_moves_is_blamed_and_bases_count_once_they_are_known() {
    let mut collisions = begun("", 0.0, &["kr10-r1420", "kr10-r1420"]);
    // Neither has moved, and both seem to be in the same place.
    let home = [0.0, -90.0, 90.0, 0.0, 0.0, 0.0];
    let standing = || Moves { axes: home.to_vec(), ..Moves::default() };
    assert_eq!(collisions.cycle(&Cycle { channels: vec![standing(), standing()], ..Cycle::default() }), []);
    let mut found = Vec::new();
    for step in 0..2000 {
        let at = f64::from(step);
        let moves = |line: u32, base: [f64; 6], axes: Vec<f64>| Moves {
            file: format!("{line}.arl"),
            line,
            base: base.to_vec(),
            axes,
        };
        let reaching = vec![0.0, -90.0 + 0.04 * at, 90.0 - 0.04 * at, 0.0, 0.0, 0.0];
        let there = moves(8, [1950.0, 0.0, 0.0, 180.0, 0.0, 0.0], reaching);
        let channels = vec![moves(3, [0.0; 6], home.to_vec()), there];
        found.extend(collisions.cycle(&Cycle { time: at * 0.001, channels, ..Cycle::default() }));
    }
    let first = found.first().expect("they touch");
    assert_eq!((&*first.file, first.line), ("8.arl", 8), "{first:?}");
}

#[test]
fn what_comes_to_rest_in_contact_touches_with_a_clearance_too() {
    let robot = Robot::load("hsr065").unwrap();
    let lift = &robot.axes[2];
    let flange = robot.kinematics.forward(&[10.0, 20.0, lift.min, 0.0, 0.0, 0.0]).translation.vector;
    // With the lift 0.02 mm above its lowest place, the finger is as far in the plate.
    let top = flange.z - 100.0 + 0.04;
    let text = format!(
        "[[body]]\nname = \"plate\"\nbox = [2000, 2000, 10]\nat = [0, 0, {}]\n\
         [[body]]\nname = \"finger\"\nbox = [10, 10, 100]\nat = [0, 0, -50]\non = \"flange\"\n",
        top - 5.0
    );
    let mut collisions = begun(&text, 20.0, &["hsr065"]);
    let mut found = Vec::new();
    for step in 0..4000 {
        let height = lift.min + 0.02 + 100.0 * (-0.004 * f64::from(step)).exp();
        found.extend(collisions.cycle(&cycle(step, &[vec![10.0, 20.0, height, 0.0]])));
    }
    assert!(found.iter().any(|contact| contact.one == "plate" && contact.other == "finger"), "{found:?}");
}

#[test]
fn robots_do_not_touch_themselves_where_they_stand_at_home() {
    for name in Robot::builtin_names() {
        let robot = Robot::load(name).unwrap();
        let mut collisions = begun("", 0.0, &[name]);
        let home = robot.home.get(..robot.own_axes().len()).unwrap().to_vec();
        assert_eq!(collisions.cycle(&cycle(0, &[home])), [], "{name}");
        assert!(!collisions.pairs.is_empty(), "{name}");
    }
}

#[test]
fn what_is_wrong_with_bodies_is_reported() {
    let folder = std::env::temp_dir().join(format!("arl2rs-bodies-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let file = folder.join("a.stl");
    let refused = |bytes: Option<&[u8]>| {
        let _ = std::fs::remove_file(&file);
        bytes.iter().for_each(|bytes| std::fs::write(&file, bytes).unwrap());
        let text = format!("[[body]]\nname = \"a\"\nmesh = {:?}\n", file.display().to_string());
        match scene(&scenery(&text)) {
            Err(Failure::Usage(text)) => text,
            _ => panic!("it was taken"),
        }
    };
    assert!(refused(None).contains("body `a`: cannot read"));
    assert!(refused(Some(b"solid nothing")).contains("no triangles"));
    assert!(refused(Some(b"no solid")).contains("it is not an STL file: text would begin with `solid`"));
    assert!(refused(Some(b"solid\nfacet\nouter loop\nvertex 1 2 inf")).contains("line 4: expected a finite number"));
    assert!(refused(Some(&[0; 90])).contains("no triangles"));
    let triangle = "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid a\n";
    std::fs::write(&file, triangle).unwrap();
    let triangle = mesh::Mesh::load(&file, [1000.0, 1.0, 1.0]).unwrap();
    assert_eq!(triangle.farthest(), 1000.0);
    assert!(triangle.hull(&file).is_ok());
    let far = mesh::Mesh::load(&file, [1e7, 1.0, 1.0]).err().unwrap_or_default();
    assert!(far.contains("the limit is 1000000 mm: is its `scale` right?"), "{far}");
    std::fs::remove_dir_all(&folder).unwrap();
}

/// A solid in the form that the script of the peers takes.
fn described(item: &Item, arms: &[Option<Arm>]) -> serde_json::Value {
    use parry3d_f64::math::{Rotation, Vector};
    let pose = place(item, arms).unwrap();
    let (kind, figures, at, turned) = if let Some(capsule) = item.shape.as_capsule() {
        let [from, to] = [capsule.segment.a, capsule.segment.b];
        let along = to - from;
        let turned = pose.rotation * Rotation::from_rotation_arc(Vector::Z, along.normalize_or(Vector::Z));
        ("capsule", vec![capsule.radius, along.length()], pose * (0.5 * (from + to)), turned)
    } else if let Some(edges) = item.shape.as_cuboid() {
        ("box", (2.0 * edges.half_extents).to_array().to_vec(), pose.translation, pose.rotation)
    } else {
        // Theirs is along z.
        let cylinder = item.shape.as_cylinder().unwrap();
        let turned = pose.rotation * Rotation::from_rotation_x(-std::f64::consts::FRAC_PI_2);
        ("cylinder", vec![cylinder.radius, 2.0 * cylinder.half_height], pose.translation, turned)
    };
    json!([kind, figures, at.x, at.y, at.z, turned.x, turned.y, turned.z, turned.w])
}

#[test]
fn peers_distances_are_those_of_another_library() {
    use std::io::Write;
    let python = std::env::var_os("ARL_PEERS_PYTHON").unwrap_or_else(|| "python3".into());
    let there = std::process::Command::new(&python).args(["-c", "import coal"]).output();
    if !there.is_ok_and(|there| there.status.success()) {
        assert!(std::env::var("ARL_PEERS").as_deref() != Ok("required"), "Python with coal is not installed");
        eprintln!("skipped: Python with coal is not installed");
        return;
    }
    let mut random = Random::new(31);
    let (mut pairs, mut ours) = (Vec::new(), Vec::new());
    for name in ["kr10-r1420", "hsr065", "irb2400-10"] {
        let text = "[[body]]\nname = \"box\"\nbox = [300, 200, 500]\nat = [600, 200, 500, 20, 40, 60]\n\
                    [[body]]\nname = \"post\"\ncylinder = [50, 900]\nat = [-300, 500, 400, 0, 30, 0]\n\
                    [[body]]\nname = \"tool\"\ncylinder = [30, 200]\nat = [20, 0, 110, 0, 20, 0]\non = \"flange\"\n";
        let mut collisions = begun(text, 0.0, &[name]);
        let robot = Robot::load(name).unwrap();
        for _ in 0..60 {
            let axes = robot.own_axes().iter().map(|axis| random.between(axis.min, axis.max)).collect::<Vec<_>>();
            collisions.arms[0].as_mut().unwrap().go_to(&cycle(0, &[axes]).channels[0]);
            for pair in &collisions.pairs {
                let [one, other] = pair.items.map(|at| &collisions.items[at]);
                let [here, there] = [one, other].map(|item| place(item, &collisions.arms).unwrap());
                ours.push(parry3d_f64::query::distance(&here, &*one.shape, &there, &*other.shape).unwrap().distance);
                pairs.push([one, other].map(|item| described(item, &collisions.arms)));
            }
        }
    }
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/peers/scripts/distances.py");
    let mut command = std::process::Command::new(&python);
    let streams = [std::process::Stdio::piped(), std::process::Stdio::piped()];
    let [input, output] = streams;
    let mut peer = command.arg(script).stdin(input).stdout(output).spawn().unwrap();
    peer.stdin.take().unwrap().write_all(json!(pairs).to_string().as_bytes()).unwrap();
    let answer = peer.wait_with_output().unwrap();
    let theirs: Vec<f64> = serde_json::from_slice(&answer.stdout).unwrap();
    assert_eq!(theirs.len(), ours.len());
    let mut touching = 0;
    for (at, (ours, theirs)) in ours.iter().zip(&theirs).enumerate() {
        assert!((ours - theirs.max(0.0)).abs() < 0.01, "{ours} {theirs} {:?}", pairs[at]);
        touching += u32::from(*ours == 0.0);
    }
    assert!(touching > 50 && ours.len() > 2000, "{touching} of {}", ours.len());
}

/// A state in which a robot is there, with its TCP in the flange.
fn state(axes: [f64; 6], dout: &str) -> State {
    let robot = Robot::load("kr10-r1420").unwrap();
    let at = robot.kinematics.forward(&axes).translation.vector;
    let (axes, tcp) = (axes.to_vec(), vec![at.x, at.y, at.z, 0.0, 0.0, 0.0]);
    let channel = arl_wire::Channel { axes, tcp, base: vec![0.0; 6], ..arl_wire::Channel::default() };
    State { channels: vec![channel], dout: dout.into(), ..State::default() }
}

fn received(parts: &mut Parts, state: State) -> Vec<Placing> {
    let lines = parts.receive(&Line::State(state)).unwrap();
    lines.into_iter().filter_map(|line| if let Line::Placing(placing) = line { Some(placing) } else { None }).collect()
}

#[test]
fn parts_go_along_with_the_robot_and_stay_where_they_are_put() {
    let robot = Robot::load("kr10-r1420").unwrap();
    let [here, there] = [[0.0, -70.0, 100.0, 0.0, 60.0, 0.0], [60.0, -70.0, 100.0, 0.0, 60.0, 0.0]];
    let at = robot.kinematics.forward(&here).translation.vector;
    let part = |name: &str, away: f64| {
        format!(
            "[[body]]\nname = \"{name}\"\nbox = [20, 20, 20]\nat = [{}, {}, {}]\ngripped_by = \"do.1\"\nwithin = 8\n",
            at.x,
            at.y,
            at.z - away
        )
    };
    let scenery = scenery(&format!("{}{}{}", part("far", 30.0), part("near", 12.0), part("farther", 17.0)));
    let mut parts = Parts::of(&scenery).unwrap().unwrap();
    parts.receive(&Line::Hello(hello(&["kr10-r1420"]))).unwrap();
    let holders = |placings: Vec<Placing>| -> Vec<(usize, Option<Option<usize>>)> {
        placings.iter().map(|placing| (placing.body, placing.place.map(|place| place.held_by))).collect()
    };
    assert_eq!(holders(received(&mut parts, state(here, "0"))), [(0, Some(None)), (1, Some(None)), (2, Some(None))]);
    // The nearest one alone: 12 mm away in the middle, 2 mm at its side.
    assert_eq!(holders(received(&mut parts, state(here, "1"))), [(1, Some(Some(0)))]);
    assert_eq!(holders(received(&mut parts, state(here, "1"))), []);
    assert_eq!(holders(received(&mut parts, state(there, "1"))), []);
    let put = received(&mut parts, state(there, "0"));
    assert_eq!(holders(put.clone()), [(1, Some(None))]);
    let wanted = robot.kinematics.forward(&there) * robot.kinematics.forward(&here).inverse() * scenery.bodies[1].0.at;
    assert!((put[0].place.unwrap().at.translation.vector - wanted.translation.vector).norm() < 1e-9);
    // On again where nothing is near: nothing; it is taken once it is near enough, not when the gripper goes on.
    assert_eq!(holders(received(&mut parts, state([120.0, -70.0, 100.0, 0.0, 60.0, 0.0], "1"))), []);
    assert_eq!(holders(received(&mut parts, state(there, "1"))), [(1, Some(Some(0)))]);
}

#[test]
fn parts_of_a_kind_come_after_each_other_with_their_signal() {
    let robot = Robot::load("kr10-r1420").unwrap();
    let [here, there] = [[0.0, -70.0, 100.0, 0.0, 60.0, 0.0], [60.0, -70.0, 100.0, 0.0, 60.0, 0.0]];
    let at = robot.kinematics.forward(&here).translation.vector;
    let text = format!(
        "[[body]]\nname = \"part\"\nsphere = 20\nat = [{}, {}, {}]\ngripped_by = \"do.1\"\nwhen = \"do.2\"\ncount = 2\n",
        at.x, at.y, at.z
    );
    let mut parts = Parts::of(&scenery(&text)).unwrap().unwrap();
    parts.receive(&Line::Hello(hello(&["kr10-r1420"]))).unwrap();
    let mut there_are = |axes, dout| {
        received(&mut parts, state(axes, dout));
        let places = parts.parts.iter().map(|part| part.reported.as_ref().unwrap().place.map(|place| place.held_by));
        places.collect::<Vec<_>>()
    };
    assert_eq!(there_are(here, "00"), [None, None]);
    assert_eq!(there_are(here, "01"), [Some(None), None]);
    assert_eq!(there_are(here, "00"), [None, None]);
    assert_eq!(there_are(here, "10"), [None, None]);
    // The next one is there as soon as the first one is taken, if the signal says so.
    assert_eq!(there_are(here, "11"), [Some(Some(0)), Some(None)]);
    assert_eq!(there_are(there, "10"), [Some(Some(0)), None]);
    assert_eq!(there_are(there, "00"), [Some(None), None]);
    assert_eq!(there_are(here, "11"), [Some(None), Some(Some(0))]);
}

#[test]
fn a_part_that_is_held_runs_into_what_it_did_not_touch_where_it_stood() {
    let robot = Robot::load("kr10-r1420").unwrap();
    let here = [0.0, -70.0, 100.0, 0.0, 60.0, 0.0];
    let at = robot.kinematics.forward(&here).translation.vector;
    // The finger touches the part, as it is meant to.
    let text = format!(
        "[[body]]\nname = \"part\"\nbox = [20, 20, 300]\nat = [{}, {}, {}]\ngripped_by = \"do.1\"\n\
         [[body]]\nname = \"finger\"\nbox = [10, 10, 20]\nat = [0, 0, 10]\non = \"flange\"\n\
         [[body]]\nname = \"wall\"\nbox = [2000, 10, 2000]\nat = [0, -400, 0]\n",
        at.x,
        at.y,
        at.z - 160.0
    );
    let run = |grips: bool| {
        let mut collisions = begun(&text, 0.0, &["kr10-r1420"]);
        let mut parts = Parts::of(&scenery(&text)).unwrap().unwrap();
        parts.receive(&Line::Hello(hello(&["kr10-r1420"]))).unwrap();
        let mut found = Vec::new();
        for step in 0..400 {
            let axes = [0.1 * f64::from(step), here[1], here[2], here[3], here[4], here[5]];
            let dout = if grips { "1" } else { "0" };
            let mut state = state(axes, dout);
            state.channels[0].tcp[2] -= 10.0;
            for placing in received(&mut parts, state) {
                collisions.place(&placing);
            }
            found.extend(collisions.cycle(&Cycle { dout: dout.into(), ..cycle(step, &[axes.to_vec()]) }));
        }
        found.into_iter().map(|contact| (contact.one, contact.other)).collect::<Vec<_>>()
    };
    assert!(run(true).contains(&("part".into(), "wall".into())), "{:?}", run(true));
    assert!(!run(false).iter().any(|(one, other)| one == "part" || other == "part"), "{:?}", run(false));
}

#[test]
fn a_robot_with_a_shape_of_its_own_touches_by_its_links() {
    let files = Files::new("collide");
    let corners = [[-60, -60, -60], [60, -60, -60], [0, 60, -60], [0, 0, 60]];
    let mut solid = String::from("solid a\n");
    for face in [[0, 1, 2], [0, 1, 3], [1, 2, 3], [2, 0, 3]] {
        let [one, two, three] = face.map(|at: usize| corners[at].map(|value| value.to_string()).join(" "));
        solid +=
            &format!("facet normal 0 0 0\nouter loop\nvertex {one}\nvertex {two}\nvertex {three}\nendloop\nendfacet\n");
    }
    files.write("hand.stl", &(solid + "endsolid a\n"));
    let hand = "<collision><geometry><mesh filename=\"hand.stl\" scale=\"0.001 0.001 0.001\"/></geometry></collision>";
    let urdf = files.write("arm.urdf", &arm([BALL, BALL, ROD, BALL, "", "", hand]));
    let text = |body: &str| format!("urdf = {:?}\n{body}", urdf.display().to_string());
    let touched = |body: &str, to: [f64; 6]| {
        let mut collisions = begun(&text(body), 0.0, &["kr10-r1420"]);
        let mut found = Vec::new();
        for step in 0..=500 {
            let axes = [0.0, -90.0, 90.0, 0.0, 0.0, 0.0]
                .iter()
                .zip(to)
                .map(|(from, to)| from + (to - from) * f64::from(step) / 500.0);
            found.extend(collisions.cycle(&cycle(step, &[axes.collect()])));
        }
        found.into_iter().map(|contact| (contact.one, contact.other)).collect::<Vec<_>>()
    };
    // The upper arm comes down on a bar beside the shoulder, and the hand, by its hull, on a block in front of the
    // robot.
    let bar = "[[body]]\nname = \"bar\"\nbox = [20, 2000, 20]\nat = [500, 0, 600]\n";
    assert_eq!(touched(bar, [0.0, -20.0, 90.0, 0.0, 0.0, 0.0]), [("the upper arm".to_owned(), "bar".to_owned())]);
    let block = "[[body]]\nname = \"block\"\nbox = [50, 50, 50]\nat = [985, 0, 880]\n";
    assert_eq!(touched(block, [0.0, -80.0, 90.0, 0.0, 0.0, 0.0]), [("the hand".to_owned(), "block".to_owned())]);
    // Links that are neighbours are not checked with each other; the hand, turned back on the upper arm, touches it.
    assert_eq!(touched("", [0.0, -60.0, 60.0, 0.0, 0.0, 0.0]), []);
    let long = "<collision><origin xyz=\"0.25 0 0\"/><geometry><box size=\"0.5 0.04 0.04\"/></geometry></collision>";
    files.write("arm.urdf", &arm(["", "", ROD, "", "", "", long]));
    let folded = touched("", [0.0, -90.0, 150.0, 0.0, 110.0, 0.0]);
    assert_eq!(folded, [("the upper arm".to_owned(), "the hand".to_owned())]);
    files.write("arm.urdf", &arm(["", "", "", "", ROD, "", long]));
    assert_eq!(touched("", [0.0, -90.0, 150.0, 0.0, 110.0, 0.0]), []);
}

#[test]
fn a_held_part_touches_others_but_not_where_it_is_taken() {
    let robot = Robot::load("kr10-r1420").unwrap();
    let here = [0.0, -70.0, 100.0, 0.0, 60.0, 0.0];
    let [at, other] = [0.0, 30.0]
        .map(|j1| robot.kinematics.forward(&[j1, here[1], here[2], here[3], here[4], here[5]]).translation.vector);
    // Three parts of a kind at one place, one beside them, and one on the way.
    let part = |name: &str, at: nalgebra::Vector3<f64>, more: &str| {
        let at = [at.x, at.y, at.z - 25.0];
        format!("[[body]]\nname = \"{name}\"\nbox = [60, 60, 40]\nat = {at:?}\ngripped_by = \"do.1\"\n{more}")
    };
    let beside = at + nalgebra::Vector3::new(0.0, 60.0, 0.0);
    let text = [part("part", at, "count = 3\n"), part("neighbour", beside, ""), part("other", other, "")].concat();
    let mut collisions = begun(&text, 0.0, &["kr10-r1420"]);
    let mut parts = Parts::of(&scenery(&text)).unwrap().unwrap();
    parts.receive(&Line::Hello(hello(&["kr10-r1420"]))).unwrap();
    let mut found = Vec::new();
    for step in 0..600 {
        let on = if step < 100 { "0" } else { "1" };
        let turned = f64::from(step.max(200) - 200) * 0.1;
        let axes = [turned, here[1], here[2], here[3], here[4], here[5]];
        for placing in received(&mut parts, state(axes, on)) {
            collisions.place(&placing);
        }
        found.extend(collisions.cycle(&Cycle { dout: on.into(), ..cycle(step, &[axes.to_vec()]) }));
    }
    let found: Vec<_> = found.into_iter().map(|contact| (contact.one, contact.other, contact.time > 0.3)).collect();
    assert_eq!(found, [("part 1".into(), "other".into(), true)]);
}

#[test]
fn a_part_may_be_near_what_it_lay_on_until_it_has_left_it() {
    let robot = Robot::load("kr10-r1420").unwrap();
    let here = [0.0, -70.0, 100.0, 0.0, 60.0, 0.0];
    let at = robot.kinematics.forward(&here).translation.vector;
    let text = format!(
        "[[body]]\nname = \"part\"\nbox = [60, 60, 40]\nat = [{x}, {y}, {}]\ngripped_by = \"do.1\"\n\
         [[body]]\nname = \"table\"\nbox = [100, 100, 40]\nat = [{x}, {y}, {}]\n",
        at.z - 24.0,
        at.z - 64.0,
        x = at.x,
        y = at.y
    );
    // Up by 10 deg, and down again onto the table where that is asked for.
    let distances = |comes_back: bool| {
        let mut collisions = begun(&text, 20.0, &["kr10-r1420"]);
        let mut parts = Parts::of(&scenery(&text)).unwrap().unwrap();
        parts.receive(&Line::Hello(hello(&["kr10-r1420"]))).unwrap();
        let mut found = Vec::new();
        for step in 0..=400 {
            let lifted = f64::from(if comes_back { step.min(400 - step) } else { step.min(200) }) * -0.05;
            let axes = [here[0], here[1] + lifted, here[2], here[3], here[4], here[5]];
            for placing in received(&mut parts, state(axes, "1")) {
                collisions.place(&placing);
            }
            found.extend(collisions.cycle(&Cycle { dout: "1".into(), ..cycle(step, &[axes.to_vec()]) }));
        }
        found.extend(collisions.nearest());
        let of_part = found.into_iter().filter(|contact| contact.one == "part" || contact.other == "part");
        of_part.map(|contact| contact.distance).collect::<Vec<_>>()
    };
    assert_eq!(distances(false), [0.0; 0]);
    assert!(matches!(distances(true)[..], [distance] if distance < 0.1), "{:?}", distances(true));
}

#[test]
fn what_has_parted_and_touches_again_is_reported_again() {
    let text = "[[body]]\nname = \"post\"\nbox = [60, 60, 60]\nat = [900, 0, 1080]\n";
    let touched = |swing: &dyn Fn(f64) -> f64| {
        let mut collisions = begun(text, 50.0, &["kr10-r1420"]);
        let mut found = Vec::new();
        for step in 0..=2000 {
            let axes = vec![swing(f64::from(step) / 500.0), -90.0, 90.0, 0.0, 0.0, 0.0];
            found.extend(collisions.cycle(&cycle(step, &[axes])));
        }
        let nearest = collisions.nearest();
        assert!(!nearest.iter().any(|contact| contact.one == "the hand"), "it touched: {nearest:?}");
        let of_hand = found.iter().filter(|contact| (&*contact.one, &*contact.other) == ("the hand", "post"));
        of_hand.map(|contact| contact.time).collect::<Vec<_>>()
    };
    // Past it and back, twice a turn.
    let times = touched(&|turns| 30.0 * (turns * std::f64::consts::TAU).cos());
    assert_eq!(times.len(), 8, "{times:?}");
    assert!(times.windows(2).all(|two| (two[1] - two[0] - 0.25).abs() < 0.02), "{times:?}");
    // What grinds along it, a fraction of a mm to and fro, touches once.
    let edge = 30.0 * (times[0] * std::f64::consts::TAU * 2.0).cos();
    let grinding = touched(&|turns| if turns < 0.2 { edge + 5.0 } else { edge + 0.03 * (turns * 300.0).sin() - 0.02 });
    assert_eq!(grinding.len(), 1, "{grinding:?}");
}

#[test]
fn the_name_of_several_bodies_means_all_of_them() {
    let part = "[[body]]\nname = \"part\"\nbox = [50, 50, 50]\ngripped_by = \"do.1\"\ncount = 3\n";
    let post = "[[body]]\nname = \"post\"\nbox = [50, 50, 50]\nat = [900, 0, 0]\n";
    let pairs = |text: &str, robots: &[&str]| {
        let collisions = begun(text, 0.0, robots);
        let name = |at: usize| collisions.items[at].name.clone();
        let both = |pair: &Pair| pair.items.map(name);
        collisions.pairs.iter().map(both).collect::<Vec<_>>()
    };
    let has = |all: &[[String; 2]], one: &str, other: &str| all.iter().any(|pair| pair[0] == one && pair[1] == other);
    let all = pairs(&format!("{part}{post}"), &["kr10-r1420"]);
    assert!((1..=3).all(|number| has(&all, &format!("part {number}"), "post")), "{all:?}");
    for text in [format!("{part}{post}may_touch = [\"part\"]\n"), format!("{part}may_touch = [\"post\"]\n{post}")] {
        let all = pairs(&text, &["kr10-r1420"]);
        assert!(!all.iter().any(|pair| pair[0].starts_with("part") && pair[1] == "post"), "{all:?}");
    }
    let one = pairs(&format!("{part}{post}may_touch = [\"part 2\"]\n"), &["kr10-r1420"]);
    assert!(has(&one, "part 1", "post") && !has(&one, "part 2", "post"), "{one:?}");
    // The same for a limb of all robots.
    let two = |may: &str| {
        let text = format!("{post}may_touch = [\"{may}\"]\n[[channel]]\nprogram = \"b.arl\"\n");
        let all = pairs(&text, &["kr10-r1420", "kr10-r1420"]);
        [1, 2].map(|channel| has(&all, &format!("the hand of channel {channel}"), "post"))
    };
    assert_eq!(
        (two("the hand"), two("the hand of channel 2"), two("the elbow")),
        ([false; 2], [true, false], [true; 2])
    );
}

#[test]
fn many_bodies_cost_by_their_number() {
    const BODIES: usize = 20_000;
    let body = |at: usize| {
        let (x, y) = (at % 200 * 50, at / 200 * 50);
        format!("[[body]]\nname = \"b{at}\"\nbox = [10, 10, 10]\nat = [{x}, {y}, -5000]\n")
    };
    let text: String = (0..BODIES).map(body).collect();
    let mut collisions = begun(&text, 0.0, &["kr10-r1420"]);
    // Each with all limbs except the base, which is fixed as they are.
    let own = collisions.pairs.iter().filter(|pair| pair.is_own()).count();
    assert_eq!(collisions.pairs.len() - own, 5 * BODIES);
    assert!(collisions.pairs.is_sorted_by_key(|pair| pair.items));
    assert_eq!(collisions.cycle(&cycle(0, &[vec![0.0, -90.0, 90.0, 0.0, 90.0, 0.0]])), []);
}

/// Two robots in one place, of which the second one moves from its 500th cycle on; what was found, where the cell has
/// this text.
fn found_beside_a_robot_that_waits(text: &str, cycles: u32) -> Found {
    let home = [0.0, -90.0, 90.0, 0.0, 0.0, 0.0];
    let (collisions, found) = Collisions::new(scene(&scenery_of_two(text)).unwrap(), 0.0, false);
    let mut watcher: Box<dyn Subscriber> = Box::new(collisions);
    watcher.receive(&Line::Hello(hello(&["kr10-r1420", "kr10-r1420"]))).unwrap();
    for step in 0..cycles {
        let turned = f64::from(step.saturating_sub(500)) * 0.1;
        let first = Moves {
            file: "a.arl".into(),
            line: 1,
            base: vec![0.0; 6],
            axes: vec![f64::from(step) * 0.05, -90.0, 90.0, 0.0, 0.0, 0.0],
        };
        let waits = Moves { base: vec![0.0; 6], axes: home.to_vec(), ..Moves::default() };
        let moves =
            Moves { file: "b.arl".into(), line: 7, axes: vec![turned, -90.0, 90.0, 0.0, 0.0, 0.0], ..waits.clone() };
        let second = if step < 500 { waits } else { moves };
        let here = Cycle { time: f64::from(step) * 0.001, channels: vec![first, second], ..Cycle::default() };
        watcher.receive(&Line::Cycle(here)).unwrap();
    }
    watcher.receive(&Line::Ended(0)).unwrap();
    found.take()
}

fn scenery_of_two(text: &str) -> Scenery {
    let robots = ["kr10-r1420"; 2].map(|name| Robot::load(name).unwrap());
    Scenery::of(&Cell::parse("cell.toml", text).unwrap(), &robots, &|_| {}).unwrap()
}

#[test]
fn a_robot_whose_place_is_given_is_checked_from_the_start() {
    let placed = "base = [0, 0, 0]\n[[channel]]\nprogram = \"b.arl\"\nbase = [0, 0, 0]\n";
    let found = found_beside_a_robot_that_waits(placed, 400);
    assert!(found.contacts.iter().any(|contact| contact.time == 0.0), "{found:?}");
    assert!(found.unchecked.is_empty(), "{found:?}");
}

#[test]
fn a_robot_whose_place_is_not_known_is_named() {
    let text = "[[channel]]\nprogram = \"b.arl\"\n";
    let found = found_beside_a_robot_that_waits(text, 400);
    assert!(found.contacts.is_empty(), "{found:?}");
    let [unchecked] = &found.unchecked[..] else { panic!("{found:?}") };
    let said = unchecked.to_string();
    assert!(said.contains("channel 2") && said.contains("did not move it"), "{said}");
    let found = found_beside_a_robot_that_waits(text, 600);
    assert!(found.contacts.iter().all(|contact| contact.time >= 0.5) && !found.contacts.is_empty(), "{found:?}");
    let [unchecked] = &found.unchecked[..] else { panic!("{found:?}") };
    let said = unchecked.to_string();
    assert!(said.contains("channel 2") && said.contains("after 0.500 s"), "{said}");
}

#[test]
fn programs_that_begin_together_are_checked_together() {
    let mut collisions = begun("", 0.0, &["kr10-r1420", "kr10-r1420"]);
    for step in 0..100_u32 {
        let line = |from: u32| u32::from(step >= from);
        let axes = |from: u32| vec![f64::from(step.saturating_sub(from)) * 0.001, -90.0, 90.0, 0.0, 0.0, 0.0];
        let moves = |from: u32, x: f64| Moves {
            file: "a.arl".into(),
            line: line(from),
            base: vec![x, 0.0, 0.0, 0.0, 0.0, 0.0],
            axes: axes(from),
        };
        let channels = vec![moves(3, 0.0), moves(20, 5000.0)];
        collisions.cycle(&Cycle { time: f64::from(step) * 0.001, channels, ..Cycle::default() });
    }
    assert_eq!(collisions.found.borrow().unchecked, []);
}
