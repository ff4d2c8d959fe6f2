//! Entry points for `fuzz/`: the files of unknown origin, other than programs, that this crate reads. Each panics where
//! something is wrong.

use std::path::Path;

use arl_robot::Robot;
use serde_json::Value;

use crate::playback::{self, Store};
use crate::report::Summary;
use crate::scenery::{self, stl};
use crate::urdf;

/// The names of our own topics; those of the channels end in a number.
const TOPICS: [&str; 8] =
    ["/arl/cell", "/scene", "/arl/controller", "/arl/io", "/arl/motions", "/arl/contacts", "/log", "/arl/channel_1"];

/// A recording: whatever can be read of it can be summed up.
pub fn recording(bytes: &[u8]) {
    match playback::of(&mut &*bytes, bytes.len() as u64) {
        Ok(store) => sum_up(&store),
        Err(why) => assert!(!why.is_empty()),
    }
}

/// Messages of a recording: each has a byte for its topic, a byte for its length, and that many bytes of data.
pub fn messages(mut bytes: &[u8]) {
    let mut store = Store::default();
    let mut time = 0;
    while let [topic, length, rest @ ..] = bytes {
        let (message, behind) = rest.split_at_checked(usize::from(*length)).unwrap_or((rest, &[]));
        bytes = behind;
        time += 4_000_000;
        let topic = TOPICS.get(usize::from(*topic) % TOPICS.len()).copied().unwrap_or_default();
        if let Err(why) = store.take(topic, time, message) {
            assert!(!why.is_empty());
        }
    }
    sum_up(&store);
}

fn sum_up(store: &Store) {
    let summary = Summary::of(store);
    // Pages are sent numbers only: a value that is not a number becomes null.
    assert!(!has_null(&serde_json::to_value(&summary).unwrap_or_default()), "{summary:?}");
    for track in &store.tracks {
        assert_eq!(track.axes.len(), track.width * track.times.len());
        assert!(track.axes.iter().chain(track.tcp.as_flattened()).all(|value| value.is_finite()));
    }
}

fn has_null(value: &Value) -> bool {
    match value {
        Value::Null => true,
        Value::Array(all) => all.iter().any(has_null),
        Value::Object(all) => all.values().any(has_null),
        _ => false,
    }
}

/// A URDF: the robot file made from it is valid, and the places of its shapes are finite.
pub fn urdf(text: &str) {
    match urdf::robot_file(text, "arm.urdf") {
        Ok(made) => assert!(Robot::parse("arm.toml", &made).is_ok(), "{made}"),
        Err(why) => assert!(!why.is_empty()),
    }
    if let Ok(looks) = scenery::of_text(text, Path::new("/nowhere/arm.urdf")) {
        for piece in looks.seen.iter().chain(&looks.touched) {
            let at = piece.at.translation.vector;
            assert!(at.iter().chain(piece.at.rotation.coords.iter()).all(|value| value.is_finite()), "{piece:?}");
        }
    }
}

/// An STL file: its corners are finite, its triangles refer to its corners, and viewers get the same triangles.
pub fn stl(bytes: &[u8]) {
    match stl::read(bytes) {
        Ok(read) => {
            assert!(!read.triangles.is_empty());
            assert!(read.corners.as_flattened().iter().all(|value| value.is_finite()));
            assert!(read.triangles.as_flattened().iter().all(|corner| (*corner as usize) < read.corners.len()));
            let viewed = stl::for_viewers(bytes.to_vec()).and_then(|bytes| stl::read(&bytes));
            assert!(viewed.is_ok_and(|viewed| viewed.triangles.len() == read.triangles.len()));
        }
        Err(why) => assert!(!why.is_empty()),
    }
}

#[cfg(test)]
mod tests;
