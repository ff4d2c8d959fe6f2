//! What a recording holds, read back.

use std::collections::BTreeMap;
use std::io::Cursor;

use prost::Message as _;
use prost_types::FileDescriptorSet;
use prost_types::field_descriptor_proto::{Label, Type};

use super::message::RunMessage;
use super::messages::*;
use super::recorder::Recorder;
use super::sink::File;
use super::urdf::urdf;
use crate::scenery::Scenery;
use crate::scenery::tests::scenery_of;
use arl_wire::{Line, Place, Placing};

const HELLO: &str = r#"{"hello":{"channels":[{"program":"pick.arl","robot":"two-axes","axes":[
    {"name":"j1","unit":"deg","min":-180.0,"max":180.0},{"name":"j2","unit":"mm","min":0.0,"max":500.0}],
    "links":[{"origin":[0,0,400,0,0,0,1],"axis":[0,0,-1],"linear":false},
             {"origin":[300,0,0,0,0,0,1],"axis":[0,0,1],"linear":true}],
    "flange":[0,0,100,0,0,0,1],
    "limbs":[{"name":"arm 1","link":1,"ends":[[0,0,0],[300,0,0]],"radius":40}]}],"names":{"di.1":"part_present"}}}"#;

fn state(time: f64, j1: f64, di: &str, line: u32) -> String {
    format!(
        r#"{{"state":{{"time":{time},"mode":"AUTO","override":100,"channels":[{{"state":"running","file":"pick.arl","line":{line},
        "motion_file":"pick.arl","motion_line":{line},"motion":1,"axes":[{j1},250],"tcp":[300,0,750,0,0,0],"base":[0,0,0,0,0,0]}}],
        "di":"{di}","do":"00","ai":[1.5],"ao":[]}}}}"#
    )
}

/// The messages of a recording of these lines by their topics, each with its time in ns.
fn recorded(lines: &[String]) -> BTreeMap<String, Vec<(u64, Vec<u8>)>> {
    recorded_in(lines, &Scenery::default())
}

fn scenery(cell: &str) -> Scenery {
    scenery_of(&arl_robot::cell::Cell::parse("cell.toml", cell).unwrap()).unwrap()
}

fn recorded_in(lines: &[String], scenery: &Scenery) -> BTreeMap<String, Vec<(u64, Vec<u8>)>> {
    let mut bytes = Vec::new();
    let mut recorder = Recorder::new(File::new(Cursor::new(&mut bytes)), scenery);
    for line in lines {
        recorder.receive(&serde_json::from_str(line).unwrap()).unwrap();
    }
    recorder.finish().unwrap();
    drop(recorder);
    topics(&bytes)
}

fn topics(bytes: &[u8]) -> BTreeMap<String, Vec<(u64, Vec<u8>)>> {
    let mut topics: BTreeMap<String, Vec<(u64, Vec<u8>)>> = BTreeMap::new();
    for message in mcap::MessageStream::new(bytes).unwrap() {
        let message = message.unwrap();
        topics.entry(message.channel.topic.clone()).or_default().push((message.log_time, message.data.to_vec()));
    }
    topics
}

#[test]
fn what_stays_the_same_is_written_once() {
    let mut lines = vec![HELLO.to_owned()];
    lines.extend((0..100).map(|step| state(f64::from(step) * 0.004, f64::from(step.min(50)), "10", 7)));
    lines.push(state(0.4, 50.0, "11", 7));
    let topics = recorded(&lines);
    let count = |topic: &str| topics[topic].len();
    assert_eq!((count("/arl/cell"), count("/arl/controller"), count("/arl/io")), (1, 1, 2));
    assert_eq!(count("/arl/channel_1"), 51);
    // Every 20 ms while it moves, and once when it is at rest.
    assert_eq!((count("/tf"), count("/joint_states")), (11, 11));
    assert_eq!(topics["/arl/io"][1].0, 400_000_000);
}

#[test]
fn frames_lead_from_the_world_to_the_flange_in_metres() {
    let topics = recorded(&[HELLO.to_owned(), state(0.0, 90.0, "10", 7)]);
    let transforms = FrameTransforms::decode(&topics["/tf"][0].1[..]).unwrap().transforms;
    let names: Vec<_> =
        transforms.iter().map(|one| (one.parent_frame_id.as_str(), one.child_frame_id.as_str())).collect();
    assert_eq!(
        names,
        [
            ("world", "base_link"),
            ("base_link", "link_1"),
            ("link_1", "link_2"),
            ("link_2", "flange"),
            ("world", "tcp"),
            ("world", "workpiece"),
        ]
    );
    let (first, second) = (transforms[1].rotation.unwrap(), transforms[2].translation.unwrap());
    // Axis 1 turns the other way.
    assert!((first.z + 0.5_f64.sqrt()).abs() < 1e-9 && (first.w - 0.5_f64.sqrt()).abs() < 1e-9);
    assert_eq!((second.x, second.z), (0.3, 0.25));
    let joints = JointStates::decode(&topics["/joint_states"][0].1[..]).unwrap().joints;
    let joints: Vec<_> = joints.iter().map(|joint| (joint.name.as_str(), joint.position.unwrap())).collect();
    assert_eq!(joints, [("j1", 90.0_f64.to_radians()), ("j2", 0.25)]);
}

#[test]
fn messages_and_what_motions_did_are_there() {
    let lines = [
        HELLO,
        &state(1.5, 0.0, "10", 7),
        r#"{"message":{"time":1.25,"channel":"channel 1","hmi":true,"console":false,"text":"part 1\n"}}"#,
        r#"{"warning":"slow"}"#,
        r#"{"alarm":{"number":20003,"text":"alarm 20003: no","file":"pick.arl","line":9}}"#,
        r#"{"report":{"channel":1,"motion":2,"file":"parts.arl","line":7,"kind":"lin","unit":"mm/s","programmed":500,"reached":480,"start":0.5,
            "duration":0.7,"way":300,"blend":{"unit":"mm","asked":5,"used":4},"closest":{"acc":{"of":"j2","percent":99}}}}"#,
        r#"{"report":{"channel":1,"cycle_time":1.5,"moving":1.2,"standing":0.3,"motions":1}}"#,
    ];
    let topics = recorded(&lines.map(str::to_owned));
    let logs: Vec<Log> = topics["/log"].iter().map(|(_, data)| Log::decode(&data[..]).unwrap()).collect();
    let logged: Vec<_> = logs.iter().map(|log| (log.level(), log.message.as_str(), log.line)).collect();
    assert_eq!(logged, [(Level::Info, "part 1", 0), (Level::Warning, "slow", 0), (Level::Error, "alarm 20003: no", 9)]);
    assert_eq!(logs[0].timestamp.unwrap(), Timestamp { seconds: 1, nanos: 250_000_000 });
    let [(time, motion)] = &topics["/arl/motions"][..] else { panic!("one motion") };
    let motion = Motion::decode(&motion[..]).unwrap();
    assert_eq!((*time, motion.kind.as_str(), motion.closest_acc.unwrap().of.as_str()), (500_000_000, "lin", "j2"));
    assert_eq!((motion.blend.unwrap().used, motion.closest_jerk), (4.0, None));
    assert_eq!((&*motion.file, motion.line), ("parts.arl", 7));
}

/// The frame of this name in the last message that has it: its parent, and where it is in m.
fn last_frame(topics: &BTreeMap<String, Vec<(u64, Vec<u8>)>>, name: &str) -> Option<(String, [f64; 3])> {
    let frames = |(_, data): &(u64, Vec<u8>)| FrameTransforms::decode(&data[..]).unwrap().transforms;
    let found = topics["/tf"].iter().flat_map(frames).rfind(|one| one.child_frame_id == name)?;
    let at = found.translation.unwrap();
    Some((found.parent_frame_id, [at.x, at.y, at.z].map(|value| (value * 1e6).round() / 1e6)))
}

#[test]
fn what_external_axes_move_is_a_frame_with_its_bodies() {
    let text = "[[carrier]]\naxis = \"ej1\"\nat = [1000, 0, 500, 0, 0, 0]\n\
                [[carrier]]\naxis = \"ej2\"\non = \"ej1\"\nat = [200, 0, 0, 0, 0, 0]\n\
                [[body]]\nname = \"disc\"\ncylinder = [100, 10]\nat = [0, 0, 5]\non = \"ej2\"\n";
    let cell = arl_robot::cell::Cell::parse("cell.toml", text).unwrap();
    let mut scenery = scenery_of(&arl_robot::cell::Cell { carriers: Vec::new(), ..cell.clone() }).unwrap();
    scenery.carriers = cell.carriers;
    let more = ",{\"name\":\"ej1\",\"unit\":\"deg\",\"min\":-90,\"max\":90},\
                {\"name\":\"ej2\",\"unit\":\"mm\",\"min\":0,\"max\":300}],\n    \"links\"";
    let hello = HELLO.replace("],\n    \"links\"", more);
    let moved = state(0.0, 90.0, "10", 7).replace("\"axes\":[90,250]", "\"axes\":[90,250,90,30]");
    let topics = recorded_in(&[hello.clone(), moved], &scenery);
    assert_eq!(last_frame(&topics, "ej1"), Some(("world".into(), [1.0, 0.0, 0.5])));
    // It slides along its z.
    assert_eq!(last_frame(&topics, "ej2"), Some(("ej1".into(), [0.2, 0.0, 0.03])));
    let bodies = SceneUpdate::decode(&topics["/scene"][1].1[..]).unwrap();
    assert_eq!((bodies.entities[0].id.as_str(), bodies.entities[0].frame_id.as_str()), ("body/disc", "ej2"));
    let runs = Cell::decode(&topics["/arl/cell"][0].1[..]).unwrap().channels.remove(0);
    let carriers = runs.carriers.iter().map(|link| (link.frame.as_str(), link.moved_by.as_str(), link.linear));
    assert_eq!(carriers.collect::<Vec<_>>(), [("ej1", "ej1", false), ("ej2", "ej2", true)]);
    assert_eq!(runs.links.iter().map(|link| &*link.moved_by).collect::<Vec<_>>(), ["j1", "j2", ""]);
    let mut bytes = Vec::new();
    let mut recorder = Recorder::new(File::new(Cursor::new(&mut bytes)), &scenery);
    recorder.receive(&serde_json::from_str(&hello).unwrap()).unwrap();
    let description = urdf_rs::read_from_string(&urdf(recorder.arms(), &scenery)).unwrap();
    let joint = |child: &str| description.joints.iter().find(|joint| joint.child.link == child).unwrap();
    assert_eq!((joint("ej1").name.as_str(), joint("ej1").parent.link.as_str()), ("ej1", "world"));
    assert_eq!(
        (&joint("ej2").joint_type, joint("body/disc").parent.link.as_str()),
        (&urdf_rs::JointType::Prismatic, "ej2")
    );
}

#[test]
fn workpieces_and_parts_have_frames_in_the_world() {
    let scenery = scenery("[[body]]\nname = \"part\"\nbox = [10, 10, 10]\nat = [500, 0, 100]\ngripped_by = \"do.1\"\n");
    let mut bytes = Vec::new();
    let mut recorder = Recorder::new(File::new(Cursor::new(&mut bytes)), &scenery);
    let standing = Place { held_by: None, at: arl_robot::kinematics::frame([500.0, 0.0, 100.0, 0.0, 0.0, 0.0]) };
    let held = Place { held_by: Some(0), at: arl_robot::kinematics::frame([0.0, 0.0, 50.0, 0.0, 0.0, 0.0]) };
    let with_workpiece =
        |j1: f64, time: f64| state(time, j1, "10", 7).replace("\"base\"", "\"workpiece\":[800,100,0,0,0,0],\"base\"");
    let mut receive = |line: Line| recorder.receive(&line).unwrap();
    receive(serde_json::from_str(HELLO).unwrap());
    receive(serde_json::from_str(&with_workpiece(0.0, 0.0)).unwrap());
    receive(Line::Placing(Placing { body: 0, place: Some(standing) }));
    receive(serde_json::from_str(&with_workpiece(0.0, 0.004)).unwrap());
    receive(Line::Placing(Placing { body: 0, place: Some(held) }));
    receive(serde_json::from_str(&with_workpiece(90.0, 0.1)).unwrap());
    recorder.finish().unwrap();
    drop(recorder);
    let topics = topics(&bytes);
    assert_eq!(last_frame(&topics, "workpiece"), Some(("world".into(), [0.8, 0.1, 0.0])));
    // Axis 1 turns the other way; the flange is 300 mm from it and 750 mm high.
    assert_eq!(last_frame(&topics, "part/part"), Some(("world".into(), [0.0, -0.3, 0.8])));
    let frames = |(_, data): &(u64, Vec<u8>)| FrameTransforms::decode(&data[..]).unwrap().transforms;
    let parts: Vec<_> = topics["/tf"].iter().flat_map(frames).filter(|one| one.child_frame_id == "part/part").collect();
    let places = parts.iter().map(|one| one.translation.unwrap().x);
    assert_eq!(places.map(|x| (x * 1e6).round() / 1e6).collect::<Vec<_>>(), [0.5, 0.3, 0.0]);
}

#[test]
fn an_empty_run_is_a_whole_file() {
    assert!(recorded(&[]).is_empty());
}

#[test]
fn the_description_has_the_frames_and_joints_of_the_recording() {
    let mut bytes = Vec::new();
    let mut recorder = Recorder::new(File::new(Cursor::new(&mut bytes)), &Scenery::default());
    recorder.receive(&serde_json::from_str(HELLO).unwrap()).unwrap();
    let bodies = "[[body]]\nname = \"table <1>\"\nbox = [800, 600, 40]\nat = [900, 0, -20]\n\
                  [[body]]\nname = \"tool\"\ncylinder = [20, 100]\non = \"flange\"\n[[body]]\nname = \"jig\"\nmesh = \"jig.stl\"\n";
    let text = urdf(recorder.arms(), &scenery(bodies));
    let description = urdf_rs::read_from_string(&text).unwrap();
    let links: Vec<_> = description.links.iter().map(|link| link.name.as_str()).collect();
    assert_eq!(links, ["world", "base_link", "link_1", "link_2", "flange", "body/table <1>", "body/tool", "body/jig"]);
    assert_eq!(description.links[2].visual.len(), 3, "a tube with round ends");
    let table = description.joints.iter().find(|joint| joint.child.link == "body/table <1>").unwrap();
    assert_eq!((table.parent.link.as_str(), table.origin.xyz.0), ("world", [0.9, 0.0, -0.02]));
    let tool = description.joints.iter().find(|joint| joint.child.link == "body/tool").unwrap();
    assert_eq!(tool.parent.link, "flange");
    let joint = &description.joints[1];
    assert_eq!((joint.name.as_str(), joint.axis.xyz.0, joint.origin.xyz.0), ("j1", [0.0, 0.0, -1.0], [0.0, 0.0, 0.4]));
    assert!((joint.limit.upper - std::f64::consts::PI).abs() < 1e-9);
}

#[test]
fn bodies_come_and_go_with_their_signal() {
    let cell = "[[body]]\nname = \"table\"\nbox = [800, 600, 40]\nat = [900, 0, -20]\n\
                [[body]]\nname = \"part\"\ncylinder = [20, 100]\non = \"flange\"\nwhen = \"di.2\"\n";
    let scenery = scenery(cell);
    let lines = [HELLO.to_owned(), state(0.0, 0.0, "10", 7), state(1.0, 0.0, "11", 7), state(2.0, 0.0, "00", 7)];
    let topics = recorded_in(&lines, &scenery);
    let updates: Vec<SceneUpdate> =
        topics["/scene"].iter().map(|(_, data)| SceneUpdate::decode(&data[..]).unwrap()).collect();
    let changes = |update: &SceneUpdate| {
        let there: Vec<_> = update.entities.iter().map(|one| (one.id.clone(), one.frame_id.clone())).collect();
        (there, update.deletions.iter().map(|gone| gone.id.clone()).collect::<Vec<_>>())
    };
    let entity = |id: &str, frame: &str| vec![(id.to_owned(), frame.to_owned())];
    assert_eq!(changes(&updates[0]), (entity("arm 1", "link_1"), Vec::new()));
    assert_eq!(changes(&updates[1]), (entity("body/table", "world"), Vec::new()));
    assert_eq!(changes(&updates[2]), (entity("body/part", "flange"), Vec::new()));
    assert_eq!(changes(&updates[3]), (Vec::new(), vec!["body/part".to_owned()]));
    let size = updates[1].entities[0].cubes[0].size.unwrap();
    assert_eq!((size.x, size.y, size.z), (0.8, 0.6, 0.04));
}

/// A message with a value in each of its fields.
#[expect(clippy::too_many_lines, reason = "a message of each kind")]
fn filled() -> Vec<RunMessage> {
    let timestamp = Some(Timestamp { seconds: 1, nanos: 2 });
    let (vector, quaternion) = (Vector3 { x: 1.0, y: 2.0, z: 3.0 }, Quaternion { x: 1.0, y: 2.0, z: 3.0, w: 4.0 });
    let text = || "text".to_owned();
    let transform = FrameTransform {
        timestamp,
        parent_frame_id: text(),
        child_frame_id: text(),
        translation: Some(vector),
        rotation: Some(quaternion),
    };
    let closest = || Some(Closest { of: text(), percent: 1.0 });
    let joints = vec![JointState { name: text(), position: Some(0.0) }];
    let axes = vec![Axis { name: text(), unit: text(), min: 1.0, max: 2.0 }];
    let names = vec![Name { signal: text(), name: text() }];
    let channel = Channel {
        time: 1.0,
        state: text(),
        file: text(),
        line: 1,
        motion_file: text(),
        motion_line: 1,
        motion: 1,
        axes: vec![1.0],
        tcp: vec![1.0],
        base: vec![1.0],
    };
    let moved_by = text();
    let links =
        vec![Link { frame: text(), parent: text(), origin: vec![1.0], axis: vec![1.0], linear: true, moved_by }];
    let carriers = links.clone();
    let runs = Runs { program: text(), robot: text(), axes, links, tcp: text(), carriers };
    let pose = Some(Pose { position: Some(vector), orientation: Some(quaternion) });
    let color = Some(Color { r: 1.0, g: 1.0, b: 1.0, a: 1.0 });
    let (size, scale) = (Some(vector), Some(vector));
    let solid = Solid { pose, size, color };
    let cylinder = Cylinder { pose, size, bottom_scale: 1.0, top_scale: 1.0, color };
    let model = Model { pose, scale, color, override_color: true, media_type: text(), data: vec![1] };
    let entity = SceneEntity {
        timestamp,
        frame_id: text(),
        id: text(),
        frame_locked: true,
        cubes: vec![solid],
        spheres: vec![solid],
        cylinders: vec![cylinder],
        models: vec![model],
    };
    let deletions = vec![SceneEntityDeletion { timestamp, id: text() }];
    let scene = SceneUpdate { deletions, entities: vec![entity] };
    let motion = Motion {
        channel: 1,
        motion: 1,
        line: 1,
        kind: text(),
        start: 1.0,
        duration: 1.0,
        way: 1.0,
        programmed: 1.0,
        reached: 1.0,
        unit: text(),
        blend: Some(Blend { asked: 1.0, used: 1.0, unit: text(), why: text() }),
        closest_vel: closest(),
        closest_acc: closest(),
        closest_jerk: closest(),
        file: text(),
    };
    let log = Log { timestamp, level: Level::Info.into(), message: text(), name: text(), file: text(), line: 1 };
    let io = Io { time: 1.0, di: vec![true], r#do: vec![true], ai: vec![1.0], ao: vec![1.0] };
    let contact = Contact { time: 1.0, file: text(), line: 1, one: text(), other: text(), distance: 1.0 };
    vec![
        RunMessage::Frames(FrameTransforms { transforms: vec![transform] }),
        RunMessage::Joints(JointStates { timestamp, joints }),
        RunMessage::Log(log),
        RunMessage::Cell(Cell { channels: vec![runs], names }),
        RunMessage::Scene(scene),
        RunMessage::Channel(7, channel),
        RunMessage::Controller(Controller { time: 1.0, mode: text(), speed_override: 1.0 }),
        RunMessage::Io(io),
        RunMessage::Motion(motion),
        RunMessage::Contact(contact),
    ]
}

/// Reads bytes by the descriptor of a message: that each field is there, as its descriptor says.
fn read(files: &FileDescriptorSet, name: &str, mut bytes: &[u8]) {
    let message = files.file.iter().find_map(|file| {
        let own = |message: &&prost_types::DescriptorProto| format!(".{}.{}", file.package(), message.name()) == name;
        file.message_type.iter().find(own)
    });
    let message = message.unwrap_or_else(|| panic!("{name} is not described"));
    let mut found = Vec::new();
    while !bytes.is_empty() {
        let key = prost::encoding::decode_varint(&mut bytes).unwrap();
        let field = message.field.iter().find(|field| field.number() == (key >> 3) as i32);
        let field = field.unwrap_or_else(|| panic!("{name} has no field {}", key >> 3));
        let packed = field.label() == Label::Repeated && field.r#type() != Type::Message;
        let wire = match field.r#type() {
            _ if packed => 2,
            Type::Double => 1,
            Type::Fixed32 => 5,
            Type::String | Type::Bytes | Type::Message => 2,
            _ => 0,
        };
        assert_eq!(key & 7, wire, "{name}: {}", field.name());
        let length = match wire {
            0 => {
                prost::encoding::decode_varint(&mut bytes).unwrap();
                0
            }
            1 => 8,
            5 => 4,
            _ => prost::encoding::decode_varint(&mut bytes).unwrap() as usize,
        };
        let (content, rest) = bytes.split_at(length);
        if field.r#type() == Type::Message {
            read(files, field.type_name(), content);
        }
        bytes = rest;
        found.push(field.number());
    }
    assert_eq!(found, message.field.iter().map(|field| field.number()).collect::<Vec<_>>(), "{name}");
}

#[test]
fn messages_are_as_their_schemas_say() {
    for message in filled() {
        let schema = message.schema();
        let files = FileDescriptorSet::decode(&schema.descriptors()[..]).unwrap();
        read(&files, &format!(".{}", schema.full_name()), &message.encoded());
    }
}

#[test]
fn what_is_written_to_a_topic_is_read_from_it() {
    for message in filled() {
        let read = RunMessage::decoded(&message.topic(), &message.encoded()).unwrap();
        let follows = matches!(message, RunMessage::Frames(_) | RunMessage::Joints(_));
        assert_eq!(read, (!follows).then_some(message));
    }
}
