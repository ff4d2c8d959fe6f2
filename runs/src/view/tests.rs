//! What a view knows of a run, and what it sends of it.

use prost::Message as _;

use super::answer::{self, Known};
use crate::playback::{Signal, Store, Took};
use crate::record::messages::{Cell, Channel, Io, Link, Motion, Runs};

fn channel(time: f64, line: u32, motion: u64, x: f64) -> Channel {
    Channel {
        time,
        state: "running".into(),
        file: "a.arl".into(),
        line,
        motion_file: "a.arl".into(),
        motion_line: 3,
        motion,
        axes: vec![x, 2.0],
        tcp: vec![x, 0.0, 0.0, 0.0, 0.0, 0.0],
        base: Vec::new(),
    }
}

/// A store that has received these messages of channel 1.
fn store(messages: &[Channel]) -> Store {
    let mut store = Store::default();
    for message in messages {
        let time = (message.time * 1e9).round() as u64;
        store.take("/arl/channel_1", time, &message.encode_to_vec()).unwrap();
    }
    store
}

/// A robot that goes 4 mm in each 4 ms, but is at rest in line 4 from 0.4 s to 1.4 s.
fn run() -> Store {
    let moves = |at: u32, later: f64| channel(f64::from(at) * 0.004 + later, 5, 1, f64::from(at) * 4.0);
    let mut messages: Vec<Channel> = (0..=100).map(|at| moves(at, 0.0)).collect();
    messages.push(channel(0.404, 4, 0, 400.0));
    messages.extend((102..=200).map(|at| moves(at, 1.0)));
    store(&messages)
}

/// What `samples` returns: how many rows, and their times, first axes and speeds.
fn decoded(bytes: &[u8]) -> (u32, Vec<f64>, Vec<f32>, Vec<f32>) {
    let u32_at = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap());
    let (rows, width) = (u32_at(0) as usize, u32_at(4) as usize);
    let f64s = |at: usize| (0..rows).map(move |row| f64::from_le_bytes(bytes[at + row * 8..][..8].try_into().unwrap()));
    let f32s = |at: usize, count: usize, step: usize| {
        (0..count).map(move |row| f32::from_le_bytes(bytes[at + row * step * 4..][..4].try_into().unwrap()))
    };
    let axes = 8 + rows * 8;
    let tcp = axes + rows * width * 4;
    let speed = tcp + rows * 7 * 4;
    assert_eq!(bytes.len(), speed + rows * 4 + rows * 17, "nothing is left over");
    (rows as u32, f64s(8).collect(), f32s(axes, rows, width).collect(), f32s(speed, rows, 1).collect())
}

#[test]
fn a_stretch_of_time_has_the_row_before_it() {
    let store = run();
    let (rows, times, axes, speed) = decoded(&answer::samples(&store.tracks[0], [0.101, 0.11], 1000));
    assert_eq!(rows, 3);
    assert_eq!((times[0], times[2], axes[0]), (0.1, 0.108, 100.0));
    assert!(speed.iter().all(|speed| (speed - 1000.0).abs() < 1.0), "{speed:?}");
    // Beyond the end there is the last row.
    assert_eq!(decoded(&answer::samples(&store.tracks[0], [9.0, 10.0], 10)).0, 1);
    assert_eq!(decoded(&answer::samples(&Store::default().tracks.pop().unwrap_or_default(), [0.0, 1.0], 10)).0, 0);
}

/// A robot of one axis that turns, and its flange 500 mm above it.
fn turning() -> Cell {
    let link =
        |origin: [f64; 7], axis: &[f64]| Link { origin: origin.to_vec(), axis: axis.to_vec(), ..Link::default() };
    let up = |z| [0.0, 0.0, z, 0.0, 0.0, 0.0, 1.0];
    let links = vec![link(up(100.0), &[0.0, 0.0, 1.0]), link(up(400.0), &[])];
    Cell { channels: vec![Runs { links, ..Runs::default() }], ..Cell::default() }
}

#[test]
fn another_tool_is_no_motion() {
    // It is at rest in motion 1; motion 2 has a tool that is 45 mm longer, or a hundredth of that.
    for (longer, cell) in [(45.0, turning()), (0.45, turning()), (45.0, Cell::default())] {
        let message = |at: u32, motion, z| Channel {
            axes: vec![f64::from(at) * 0.01],
            tcp: vec![0.0, 0.0, z, 0.0, 0.0, 0.0],
            base: vec![0.0; 6],
            ..channel(f64::from(at) * 0.004, 5, motion, 0.0)
        };
        let mut store = Store { cell, ..Store::default() };
        for at in 0..100 {
            let (motion, z) = if at < 50 { (1, 500.0) } else { (2, 500.0 + longer) };
            store.take("/arl/channel_1", 0, &message(at, motion, z).encode_to_vec()).unwrap();
        }
        let track = &store.tracks[0];
        assert!(track.speed.iter().all(|speed| *speed == 0.0), "{longer}: {:?}", track.speed);
        assert!(track.jumps.iter().enumerate().all(|(row, jumps)| *jumps == (row == 50)));
        for most in [1000, 9] {
            let bytes = answer::samples(track, [0.0, 9.0], most);
            let rows = decoded(&bytes).0 as usize;
            assert_eq!(bytes[bytes.len() - rows..].iter().map(|jumps| u32::from(*jumps)).sum::<u32>(), 1);
        }
    }
}

#[test]
fn fewer_rows_keep_the_last_one_and_the_highest_speed() {
    let mut messages: Vec<Channel> = (0..1000).map(|at| channel(f64::from(at) * 0.004, 5, 1, 0.0)).collect();
    messages[501].tcp[0] = 8.0;
    messages[502].tcp[0] = 8.0;
    let (rows, times, _, speed) = decoded(&answer::samples(&store(&messages).tracks[0], [0.0, 9.0], 50));
    assert!(rows <= 51, "{rows}");
    assert_eq!(times.last(), Some(&3.996));
    assert!(speed.iter().any(|speed| (speed - 2000.0).abs() < 1.0), "{speed:?}");
}

#[test]
fn time_is_counted_by_the_line_that_moves_or_waits() {
    let store = run();
    let lines = &store.tracks[0].lines;
    let of = |line| lines.get(&(0, line)).copied().unwrap_or_default();
    let Took { moving, standing } = of(3);
    assert!((moving - 0.796).abs() < 1e-6 && standing == 0.0, "{moving} {standing}");
    // The program had come to line 5 when the robot stopped, and waited in line 4.
    assert!((of(4).standing - 1.0).abs() < 1e-6 && (of(5).standing - 0.004).abs() < 1e-6, "{lines:?}");
    let all: f64 = lines.values().map(|took| took.moving + took.standing).sum();
    assert!((all - 1.8).abs() < 1e-6, "{all}");
}

#[test]
fn signals_are_reported_from_where_they_changed() {
    let mut store = Store::default();
    for (time, on) in [(0, false), (1, true), (2, true), (3, false)] {
        let io = Io { time: f64::from(time), di: vec![false, on], ai: vec![f64::from(time)], ..Io::default() };
        store.take("/arl/io", u64::from(time as u32) * 1_000_000_000, &io.encode_to_vec()).unwrap();
    }
    assert_eq!(store.signals[&Signal { kind: "di", number: 2 }], [(1.0, 1.0), (3.0, 0.0)]);
    assert!(!store.signals.contains_key(&Signal { kind: "di", number: 1 }));
    // The first two changes are known: those of both signals after 1 s.
    let news = serde_json::json!(answer::news(&store, &Known { signals: 2, ..Known::default() }));
    let analog = serde_json::json!({"signal": "ai.1", "changes": [2.0, 2.0, 3.0, 3.0]});
    let digital = serde_json::json!({"signal": "di.2", "changes": [3.0, 0.0]});
    let signals = news["signals"].as_array().unwrap();
    assert!(signals.contains(&analog) && signals.contains(&digital), "{signals:?}");
}

#[test]
fn what_is_no_number_is_none_of_the_page() {
    let none = f64::NAN;
    let mut store = Store::default();
    let io = Io { ai: vec![none], ..Io::default() };
    assert!(store.take("/arl/io", 0, &io.encode_to_vec()).is_err());
    let motion = Motion { channel: 1, motion: 1, way: none, ..Motion::default() };
    assert!(store.take("/arl/motions", 0, &motion.encode_to_vec()).is_err());
    let news = serde_json::json!(answer::news(&store, &Known::default()));
    assert_eq!((&news["motions"], &news["signals"]), (&serde_json::json!([]), &serde_json::json!([])));
}

#[test]
fn a_motion_that_goes_on_is_reported_again() {
    let mut store = Store::default();
    for (motion, duration) in [(1, 0.5), (2, 0.2), (2, 0.7)] {
        let motion = Motion { channel: 1, motion, duration, ..Motion::default() };
        store.take("/arl/motions", 0, &motion.encode_to_vec()).unwrap();
    }
    assert_eq!(store.motions.iter().map(|motion| motion.duration).collect::<Vec<_>>(), [0.5, 0.7]);
}

#[test]
fn other_peoples_topics_are_passed_over() {
    let mut store = Store::default();
    store.take("/camera", 5_000_000_000, b"\xff\xff").unwrap();
    store.take("/arl/channel_0", 0, b"\xff").unwrap();
    store.take("/arl/channel_999", 0, b"\xff").unwrap();
    assert_eq!((store.version, store.tracks.len()), (0, 0));
    assert!(store.take("/arl/io", 0, b"\xff").is_err());
}

#[test]
fn the_page_has_all_that_its_files_ask_for() {
    let (kind, html) = super::page::file("/").unwrap();
    assert!(kind.starts_with("text/html"));
    let asked = |text: &str, before: &str| {
        let found = text.split(before).skip(1).filter_map(|rest| rest.split(['\'', '"']).next().map(str::to_owned));
        found.collect::<Vec<_>>()
    };
    let html = String::from_utf8_lossy(html);
    let mut files = [asked(&html, "src=\""), asked(&html, "stylesheet\" href=\"")].concat();
    let mut at = 0;
    while let Some(file) = files.get(at).cloned() {
        let (_, bytes) = super::page::file(&format!("/{file}")).unwrap_or_else(|| panic!("there is no {file}"));
        // What was made smaller asks for nothing.
        let text = if file == "three.js" { "".into() } else { String::from_utf8_lossy(bytes) };
        let folder = file.rsplit_once('/').map_or("", |(folder, _)| folder);
        let beside = asked(&text, "from \"./").into_iter().map(|name| [folder, &name].join("/"));
        let above = asked(&text, "from \"../");
        for more in beside.chain(above).map(|name| name.trim_start_matches('/').to_owned()) {
            if !files.contains(&more) {
                files.push(more);
            }
        }
        at += 1;
    }
    assert_eq!(files.len() + 1, super::page::count(), "{files:?}");
    assert!(super::page::file("/../Cargo.toml").is_none() && super::page::file("/package.json").is_none());
}
