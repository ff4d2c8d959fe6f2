//! Contacts against a computation that looks at every pair in every cycle.

use arl_robot::cell::Cell;
use arl_robot::kinematics::random::Random;
use arl_robot::robot::Robot;
use serde_json::json;

use super::super::said::{Cycle, Hello, Moves};
use super::*;

/// What a program says of its robots.
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

/// A cycle in which robots are there, on bases beside each other.
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

fn begun(text: &str, clearance: f64, robots: &[&str]) -> Collisions {
    let (mut collisions, _) = Collisions::new(&Cell::parse("cell.toml", text).unwrap(), clearance, false).unwrap();
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

/// Of each pair of a cell, the first cycle in which it touches, and the nearest that it comes before that, looked for in each cycle.
fn by_looking_always(collisions: &mut Collisions, cycles: &[Cycle]) -> Vec<(String, String, Option<f64>, f64)> {
    let mut found: Vec<(String, String, Option<f64>, f64)> = collisions
        .pairs
        .iter()
        .map(|pair| {
            let [one, other] = pair.items.map(|at| collisions.items[at].name.clone());
            (one, other, None, f64::INFINITY)
        })
        .collect();
    for cycle in cycles {
        for (arm, moves) in collisions.arms.iter_mut().zip(&cycle.channels) {
            arm.as_mut().unwrap().go_to(moves);
        }
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
        let expected = by_looking_always(&mut begun(&text, CLEARANCE, &robots), &cycles);
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
    // Neither has moved, and both seem to stand in the same place.
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
    // Where the lift is 0.02 mm above its lowest place, the finger is as far in the plate.
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
fn what_is_wrong_with_bodies_is_said() {
    let folder = std::env::temp_dir().join(format!("arl2rs-bodies-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let file = folder.join("a.stl");
    let refused = |bytes: Option<&[u8]>| {
        let _ = std::fs::remove_file(&file);
        bytes.iter().for_each(|bytes| std::fs::write(&file, bytes).unwrap());
        let text = format!("[[body]]\nname = \"a\"\nmesh = {:?}\n", file.display().to_string());
        let cell = Cell::parse("cell.toml", &text).unwrap();
        match Collisions::new(&cell, 0.0, false) {
            Err(Failure::Usage(text)) => text,
            _ => panic!("it was taken"),
        }
    };
    assert!(refused(None).contains("body `a`: cannot read"));
    assert!(
        refused(Some(b"solid nothing")).contains("no triangles") || refused(Some(b"solid")).contains("no STL file")
    );
    assert!(refused(Some(&[0; 90])).contains("no triangles"));
    let triangle = "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid a\n";
    std::fs::write(&file, triangle).unwrap();
    assert!(mesh::load(&file).is_ok_and(|(mesh, farthest)| mesh.indices().len() == 1 && farthest == 1.0));
    std::fs::remove_dir_all(&folder).unwrap();
}

/// A solid as the script of the peers takes it.
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
