//! What the page is told of a run: JSON for what there is little of, columns of numbers for where the robots were.

use std::collections::BTreeMap;

use serde_json::{Map, Value, json};

use crate::playback::{Signal, Store, TOLD_AGAIN, Took, Track};
use crate::record::messages::{
    Blend, Closest, Color, Level, Link, Log, Motion, Pose, Quaternion, SceneUpdate, Solid, Vector3,
};

/// How much of a run the page knows already, by the numbers of what it has.
#[derive(Clone, Copy, Default, Debug)]
pub(super) struct Known {
    pub(super) scene: usize,
    pub(super) controller: usize,
    pub(super) log: usize,
    pub(super) contacts: usize,
    pub(super) motions: usize,
    pub(super) states: usize,
    pub(super) bases: usize,
    /// Changes of signals.
    pub(super) signals: usize,
}

/// What the page is told besides.
#[derive(Clone, Copy, Debug)]
pub(super) struct About<'a> {
    /// The file that is shown.
    pub(super) name: &'a str,
    /// Whether points of the program may be written.
    pub(super) teaches: bool,
}

/// All of a run but where the robots were.
pub(super) fn run(store: &Store, about: About<'_>) -> Value {
    let mut answer = news(store, &Known::default());
    let channels = store.cell.channels.iter().map(|runs| {
        let axes = runs.axes.iter();
        let axes = axes.map(|axis| json!({"name": axis.name, "unit": axis.unit, "min": axis.min, "max": axis.max}));
        let link = |link: &Link| {
            json!({"frame": link.frame, "parent": link.parent, "origin": link.origin, "axis": link.axis, "linear": link.linear,
                   "moved_by": link.moved_by})
        };
        json!({
            "program": runs.program, "robot": runs.robot, "tcp": runs.tcp,
            "axes": axes.collect::<Value>(), "links": runs.links.iter().map(link).collect::<Value>(),
            "carriers": runs.carriers.iter().map(link).collect::<Value>(),
        })
    });
    let names = store.cell.names.iter().map(|name| (name.signal.clone(), Value::from(name.name.clone())));
    let sources = store.sources.iter().map(|source| json!({"name": source.name, "text": source.text}));
    let more = [
        ("name", Value::from(about.name)),
        ("channels", channels.collect()),
        ("names", names.collect::<Map<_, _>>().into()),
        ("sources", sources.collect()),
        ("keywords", arl_lang::language_words().collect()),
        ("teaches", about.teaches.into()),
        ("trouble", store.trouble.clone().into()),
    ];
    if let Value::Object(fields) = &mut answer {
        fields.extend(more.map(|(name, value)| (name.to_owned(), value)));
    }
    answer
}

/// What happened since.
pub(super) fn news(store: &Store, known: &Known) -> Value {
    let mut models = store.scene.iter().take(known.scene).map(|(_, update)| models_of(update)).sum::<usize>();
    let scene = store.scene.iter().skip(known.scene).map(|(time, update)| scene(store, *time, update, &mut models));
    let scene: Value = scene.collect();
    let controller = store.controller.iter().skip(known.controller);
    let controller = controller.map(|one| json!({"time": one.time, "mode": one.mode, "override": one.speed_override}));
    let contacts = store.contacts.iter().skip(known.contacts).map(|one| {
        json!({
            "time": one.time, "file": one.file, "line": one.line, "one": one.one, "other": one.other,
            "distance": one.distance,
        })
    });
    let tracks = store.tracks.iter().map(|track| {
        let states = track.states.iter().skip(known.states).map(|(time, state)| json!([time, state]));
        let bases = track.bases.iter().skip(known.bases).map(|(time, base)| json!([time, base]));
        json!({
            "files": track.files, "rows": track.times.len(),
            "states": states.collect::<Value>(), "bases": bases.collect::<Value>(), "lines": lines(track),
        })
    });
    json!({
        "end": store.end,
        "version": store.version,
        "live": store.goes_on,
        "scene": scene,
        "controller": controller.collect::<Value>(),
        "log": store.log.iter().skip(known.log).map(|(time, log)| logged(*time, log)).collect::<Value>(),
        "contacts": contacts.collect::<Value>(),
        "motions": store.motions.iter().skip(known.motions.saturating_sub(TOLD_AGAIN)).map(motion).collect::<Value>(),
        "tracks": tracks.collect::<Value>(),
        "signals": signals(store, known.signals),
        "levels": levels(store),
    })
}

/// What each line took.
fn lines(track: &Track) -> Value {
    let line = |(&(file, line), took): (&(u16, u32), &Took)| json!({"file": file, "line": line, "moving": took.moving, "standing": took.standing});
    track.lines.iter().map(line).collect()
}

fn models_of(update: &SceneUpdate) -> usize {
    update.entities.iter().map(|entity| entity.models.len()).sum()
}

fn scene(store: &Store, time: f64, update: &SceneUpdate, models: &mut usize) -> Value {
    let entities = update.entities.iter().map(|entity| {
        let solid = |one: &Solid| json!({"pose": pose(one.pose), "size": vector(one.size), "color": color(one.color)});
        let cylinders = entity.cylinders.iter();
        let cylinders =
            cylinders.map(|one| json!({"pose": pose(one.pose), "size": vector(one.size), "color": color(one.color)}));
        let drawn = entity.models.iter().map(|one| {
            let mesh = store.models.get(*models);
            *models += 1;
            json!({"pose": pose(one.pose), "scale": vector(one.scale), "color": color(one.color), "model": mesh})
        });
        json!({
            "id": entity.id, "frame": entity.frame_id,
            "cubes": entity.cubes.iter().map(solid).collect::<Value>(),
            "spheres": entity.spheres.iter().map(solid).collect::<Value>(),
            "cylinders": cylinders.collect::<Value>(),
            "models": drawn.collect::<Value>(),
        })
    });
    let entities: Value = entities.collect();
    let gone: Value = update.deletions.iter().map(|gone| gone.id.clone()).collect();
    json!({"time": time, "entities": entities, "gone": gone})
}

fn vector(vector: Option<Vector3>) -> [f64; 3] {
    vector.map_or([0.0; 3], |Vector3 { x, y, z }| [x, y, z])
}

/// x, y, z, and a quaternion x, y, z, w.
fn pose(pose: Option<Pose>) -> [f64; 7] {
    let Some(Pose { position, orientation }) = pose else { return [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0] };
    let [at_x, at_y, at_z] = vector(position);
    let Quaternion { x, y, z, w } = orientation.unwrap_or(Quaternion { x: 0.0, y: 0.0, z: 0.0, w: 1.0 });
    [at_x, at_y, at_z, x, y, z, w]
}

fn color(color: Option<Color>) -> [f64; 4] {
    color.map_or([0.5, 0.5, 0.5, 1.0], |Color { r, g, b, a }| [r, g, b, a])
}

fn logged(time: f64, log: &Log) -> Value {
    let level = match log.level() {
        Level::Error | Level::Fatal => "alarm",
        Level::Warning => "warning",
        _ => "message",
    };
    json!({"time": time, "level": level, "text": log.message, "name": log.name, "file": log.file, "line": log.line})
}

fn motion(motion: &Motion) -> Value {
    let closest = |closest: &Option<Closest>| closest.as_ref().map(|one| json!([one.of, one.percent]));
    let blend = |one: &Blend| json!({"asked": one.asked, "used": one.used, "unit": one.unit, "why": one.why});
    json!({
        "channel": motion.channel, "motion": motion.motion, "file": motion.file, "line": motion.line, "kind": motion.kind,
        "start": motion.start, "duration": motion.duration, "way": motion.way,
        "programmed": motion.programmed, "reached": motion.reached, "unit": motion.unit,
        "blend": motion.blend.as_ref().map(blend),
        "vel": closest(&motion.closest_vel), "acc": closest(&motion.closest_acc), "jerk": closest(&motion.closest_jerk),
    })
}

/// All inputs and outputs as they are now.
fn levels(store: &Store) -> Value {
    let row = |levels: &[bool]| levels.iter().map(|on| if *on { '1' } else { '0' }).collect::<String>();
    let io = &store.io;
    json!({"di": row(&io.di), "do": row(&io.r#do), "ai": io.ai, "ao": io.ao})
}

/// Changes of signals: each one's times and values in turn.
fn signals(store: &Store, known: usize) -> Value {
    let mut of: BTreeMap<Signal, Vec<f64>> = BTreeMap::new();
    for (signal, time, value) in store.changes.iter().skip(known) {
        of.entry(*signal).or_default().extend([*time, *value]);
    }
    let told = |(signal, changes): (Signal, Vec<f64>)| json!({"signal": signal.to_string(), "changes": changes});
    of.into_iter().map(told).collect()
}

/// Where the robot of a channel was from one time to another, in at most so many rows, and the row before the first.
/// Numbers are little-endian: how many rows and axes there are (u32), times (f64), then row by row axes, TCP and speed
/// (f32), then for each row the lines of program and motion, the number of the motion, and the numbers of the files,
/// that of the motion above 16 bits (u32), and for each row whether another tool took over since the row before (u8).
pub(super) fn samples(track: &Track, [from, to]: [f64; 2], most: usize) -> Vec<u8> {
    let first = track.times.partition_point(|time| *time < from).saturating_sub(1);
    let end = track.times.partition_point(|time| *time <= to).max(first);
    let step = (end - first).div_ceil(most.max(2)).max(1);
    // Columns are as long as each other, and rows within them. The last row is there whatever the step.
    let last = (end > first).then(|| end - 1);
    let rows = || (first..end).step_by(step).chain(last.filter(|last| (last - first) % step != 0));
    let mut out = Vec::new();
    let count = rows().count();
    out.extend(u32::try_from(count).unwrap_or(0).to_le_bytes());
    out.extend(u32::try_from(track.width).unwrap_or(0).to_le_bytes());
    rows().for_each(|row| out.extend(track.times[row].to_le_bytes()));
    let mut float = |value: f32| out.extend(value.to_le_bytes());
    for row in rows() {
        track.axes[row * track.width..(row + 1) * track.width].iter().for_each(|value| float(*value));
    }
    rows().for_each(|row| track.tcp[row].iter().for_each(|value| float(*value)));
    // Nothing fast is lost between rows.
    for row in rows() {
        let until = (row + step).min(end);
        float(track.speed[row..until].iter().copied().fold(0.0, f32::max));
    }
    for row in rows() {
        let at = track.pointers[row];
        let files = u32::from(at.file) | u32::from(at.motion_file) << 16;
        [at.line, at.motion_line, at.motion, files].iter().for_each(|value| out.extend(value.to_le_bytes()));
    }
    let mut next = first;
    for row in rows() {
        out.push(u8::from(track.jumps[next..=row].contains(&true)));
        next = row + 1;
    }
    out
}
