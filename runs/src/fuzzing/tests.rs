//! The same entry points without a fuzzer: valid files, changed at random places, with fixed seeds.
//! `ARL_FILES_ROUNDS=N` tries N of each kind, `ARL_FILES_SEED=N` moves on to others.

use std::collections::BTreeMap;
use std::io::Cursor;

use prost::Message as _;

use super::*;
use crate::record::messages::{Axis, Cell, Channel, Contact, Io, Log, Motion, Name, Runs, SceneEntity, SceneUpdate};
use crate::scenery::tests::{BALL, ROD, arm};

/// Numbers by steps whose quality is enough here.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0
    }

    fn below(&mut self, end: usize) -> usize {
        (self.next() % end.max(1) as u64) as usize
    }
}

/// Texts in the place of what a file should contain.
const WORDS: [&[u8]; 16] = [
    b"nan",
    b"inf",
    b"-1e300",
    b"1e39",
    b"0",
    b"-0.0",
    b"99999999999999999999",
    b"\xff\xff\xff\xff",
    b"\xff",
    b"\0",
    b"<",
    b"\"",
    b"/>",
    b"\r",
    b"solid\n",
    b"end",
];

/// A file with up to eight changes: bytes that are changed, removed, doubled or moved, or words.
fn changed(good: &[u8], random: &mut Random) -> Vec<u8> {
    let mut bytes = good.to_vec();
    for _ in 0..=random.below(8) {
        let at = random.below(bytes.len());
        let most = 1 + random.below(64);
        let length = random.below(most);
        let end = (at + length).min(bytes.len());
        match random.below(6) {
            0 => bytes[at..end].iter_mut().for_each(|byte| *byte = random.next() as u8),
            1 => drop(bytes.drain(at..end)),
            2 => {
                let piece = bytes[at..end].to_vec();
                let to = random.below(bytes.len());
                bytes.splice(to..to, piece);
            }
            3 => {
                let word = WORDS[random.below(WORDS.len())];
                let end = (at + random.below(4)).min(bytes.len());
                bytes.splice(at..end, word.iter().copied());
            }
            4 => bytes[at..end.min(at + 1)].iter_mut().for_each(|byte| *byte ^= 1 << random.below(8)),
            _ => bytes.truncate(bytes.len() - random.below(1 + bytes.len() / 8)),
        }
        if bytes.is_empty() {
            bytes.push(0);
        }
    }
    bytes
}

/// Gives an entry point valid files, then changed ones.
fn rounds(goods: &[Vec<u8>], door: fn(&[u8])) {
    let number = |name: &str| std::env::var(name).ok().and_then(|text| text.parse::<u64>().ok());
    let mut random = Random(0x9E37_79B9_7F4A_7C15 ^ number("ARL_FILES_SEED").unwrap_or(1));
    goods.iter().for_each(|good| door(good));
    for round in 0..number("ARL_FILES_ROUNDS").unwrap_or(3000) {
        let bytes = changed(&goods[random.below(goods.len())], &mut random);
        if std::panic::catch_unwind(|| door(&bytes)).is_err() {
            let file = std::env::temp_dir().join(format!("arl2rs-file-{round}-{}", std::process::id()));
            std::fs::write(&file, &bytes).unwrap();
            panic!("round {round}: {}", file.display());
        }
    }
}

#[test]
fn changed_stl_files() {
    let text = "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid a\n";
    let text = text.repeat(3).into_bytes();
    let bytes = stl::for_viewers(text.clone()).unwrap();
    rounds(&[text, bytes], stl);
}

#[test]
fn changed_urdf_files() {
    let mesh = "<visual><geometry><mesh filename=\"a.stl\" scale=\"1 1 1\"/></geometry></visual>";
    let bodies = arm([BALL, BALL, ROD, BALL, "", "", BALL]);
    let robot = arm(["", BALL, ROD, mesh, "", "", BALL]);
    assert!(urdf::robot_file(&robot, "arm.urdf").is_ok());
    rounds(&[bodies.into_bytes(), robot.into_bytes()], |bytes| urdf(&String::from_utf8_lossy(bytes)));
}

/// The messages of a short run by their topics.
fn run() -> Vec<(&'static str, Vec<u8>)> {
    let axes = vec![Axis { name: "j1".into(), unit: "deg".into(), min: -180.0, max: 180.0 }; 6];
    let runs = Runs { program: "a.arl".into(), robot: "kr10-r1420".into(), axes, ..Runs::default() };
    let names = vec![Name { signal: "di.1".into(), name: "part".into() }];
    let mut all = vec![("/arl/cell", Cell { channels: vec![runs], names }.encode_to_vec())];
    let entity = SceneEntity { id: "body/a".into(), ..SceneEntity::default() };
    all.push(("/scene", SceneUpdate { entities: vec![entity], ..SceneUpdate::default() }.encode_to_vec()));
    for step in 0..6 {
        let time = f64::from(step) * 0.004;
        let channel = Channel {
            time,
            state: "running".into(),
            file: "a.arl".into(),
            line: 3,
            motion_file: "a.arl".into(),
            motion_line: 3,
            motion: 1,
            axes: vec![time; 6],
            tcp: vec![1.0; 6],
            base: vec![0.0; 6],
        };
        all.push(("/arl/channel_1", channel.encode_to_vec()));
        let io = Io { time, di: vec![step % 2 == 0; 8], ai: vec![time; 2], ..Io::default() };
        all.push(("/arl/io", io.encode_to_vec()));
    }
    let motion = Motion { channel: 1, motion: 1, line: 3, kind: "lin".into(), way: 3.0, ..Motion::default() };
    all.push(("/arl/motions", motion.encode_to_vec()));
    all.push(("/arl/contacts", Contact { one: "a".into(), other: "b".into(), ..Contact::default() }.encode_to_vec()));
    all.push(("/log", Log { message: "hello".into(), ..Log::default() }.encode_to_vec()));
    all
}

#[test]
fn changed_recordings() {
    let mut bytes = Vec::new();
    let options = mcap::WriteOptions::new().compression(None).chunk_size(Some(512));
    let mut writer = options.create(Cursor::new(&mut bytes)).unwrap();
    let schema = writer.add_schema("any", "protobuf", &[]).unwrap();
    for (sequence, (topic, message)) in run().into_iter().enumerate() {
        let channel_id = writer.add_channel(schema, topic, "protobuf", &BTreeMap::new()).unwrap();
        let time = sequence as u64 * 4_000_000;
        let header =
            mcap::records::MessageHeader { channel_id, sequence: sequence as u32, log_time: time, publish_time: time };
        writer.write_to_known_channel(&header, &message).unwrap();
    }
    writer.finish().unwrap();
    drop(writer);
    let store = playback::of(&mut &*bytes, bytes.len() as u64).unwrap();
    assert_eq!((store.tracks.len(), store.motions.len(), store.problem), (1, 1, None));
    rounds(&[bytes], recording);
}

/// Found by a fuzzer: the head of an attachment takes all its bytes but three.
#[test]
fn an_attachment_without_room_for_its_checksum_is_refused() {
    let mut bytes = b"\x89MCAP0\r\n".to_vec();
    let attachment = [&[0; 16][..], &[1, 0, 0, 0, b'a'], &[1, 0, 0, 0, b'b'], &[0; 8], &[0; 3]].concat();
    bytes.push(mcap::records::op::ATTACHMENT);
    bytes.extend((attachment.len() as u64).to_le_bytes());
    bytes.extend(attachment);
    let refused = playback::of(&mut &*bytes, bytes.len() as u64).map(|_| ()).unwrap_err();
    assert_eq!(refused, "an attachment is shorter than it says");
    recording(&bytes);
}

#[test]
fn changed_messages() {
    let mut bytes = Vec::new();
    for (topic, message) in run() {
        let number = TOPICS.iter().position(|known| *known == topic).unwrap();
        bytes.extend([number as u8, u8::try_from(message.len()).unwrap_or(u8::MAX)]);
        bytes.extend(&message[..message.len().min(usize::from(u8::MAX))]);
    }
    rounds(&[bytes], messages);
}
