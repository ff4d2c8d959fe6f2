//! What the page gets of a run: JSON for small data, columns of numbers for the positions of the robots.

use std::collections::BTreeMap;

use super::api::{
    Entity, Levels, Logged, Mode, News, PageChannel, PageContact, PageLine, PageModel, PageMotion, PageSceneUpdate,
    PageSolid, PageTrack, RunAnswer, SignalChanges, SourceText,
};
use crate::playback::{REPORTED_AGAIN, Signal, Store, Track};
use crate::record::messages;

/// How much of a run the page knows already, by the counts of what it has.
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

/// What else the page gets.
#[derive(Clone, Copy, Debug)]
pub(super) struct About<'a> {
    /// The file that is shown.
    pub(super) name: &'a str,
    /// Whether points of the program may be written.
    pub(super) teaches: bool,
}

/// All of a run except the positions of the robots.
pub(super) fn run(store: &Store, about: About<'_>) -> RunAnswer {
    let source = |text: &crate::texts::Text| SourceText { name: text.name.clone(), text: text.text.clone() };
    RunAnswer {
        name: about.name.to_owned(),
        channels: store.cell.channels.iter().map(PageChannel::from).collect(),
        names: store.cell.names.iter().map(|name| (name.signal.clone(), name.name.clone())).collect(),
        sources: store.sources.iter().map(source).collect(),
        keywords: arl_lang::language_words().collect(),
        teaches: about.teaches,
        trouble: store.problem.clone(),
        news: news(store, &Known::default()),
    }
}

/// What happened since then.
pub(super) fn news(store: &Store, known: &Known) -> News {
    let mut models = store.scene.iter().take(known.scene).map(|(_, update)| models_of(update)).sum::<usize>();
    let scene = store.scene.iter().skip(known.scene).map(|(time, update)| scene(store, *time, update, &mut models));
    News {
        end: store.end,
        version: store.version,
        live: store.goes_on,
        scene: scene.collect(),
        controller: store.controller.iter().skip(known.controller).map(Mode::from).collect(),
        log: store.log.iter().skip(known.log).map(|(time, log)| Logged::new(*time, log)).collect(),
        contacts: store.contacts.iter().skip(known.contacts).map(PageContact::from).collect(),
        motions: store
            .motions
            .iter()
            .skip(known.motions.saturating_sub(REPORTED_AGAIN))
            .map(PageMotion::from)
            .collect(),
        tracks: store.tracks.iter().map(|track| track_news(track, known)).collect(),
        signals: signals(store, known.signals),
        levels: Levels::from(&store.io),
    }
}

fn track_news(track: &Track, known: &Known) -> PageTrack {
    let base = |(time, base): &(f64, [f32; 7])| (*time, base.map(f64::from));
    let line = |(&(file, line), took): (&(u16, u32), &crate::playback::Took)| PageLine {
        file,
        line,
        moving: took.moving,
        standing: took.standing,
    };
    PageTrack {
        files: track.files.clone(),
        rows: track.times.len(),
        states: track.states.iter().skip(known.states).cloned().collect(),
        bases: track.bases.iter().skip(known.bases).map(base).collect(),
        lines: track.lines.iter().map(line).collect(),
    }
}

fn models_of(update: &messages::SceneUpdate) -> usize {
    update.entities.iter().map(|entity| entity.models.len()).sum()
}

fn scene(store: &Store, time: f64, update: &messages::SceneUpdate, models: &mut usize) -> PageSceneUpdate {
    let entities = update.entities.iter().map(|entity| {
        let drawn = entity.models.iter().map(|one| {
            let mesh = store.models.get(*models).copied();
            *models += 1;
            PageModel::new(one, mesh)
        });
        Entity {
            id: entity.id.clone(),
            frame: entity.frame_id.clone(),
            cubes: entity.cubes.iter().map(PageSolid::from).collect(),
            spheres: entity.spheres.iter().map(PageSolid::from).collect(),
            cylinders: entity.cylinders.iter().map(PageSolid::from).collect(),
            models: drawn.collect(),
        }
    });
    let entities = entities.collect();
    PageSceneUpdate { time, entities, gone: update.deletions.iter().map(|gone| gone.id.clone()).collect() }
}

/// Changes of signals: each one's times and values in turn.
fn signals(store: &Store, known: usize) -> Vec<SignalChanges> {
    let mut of: BTreeMap<Signal, Vec<f64>> = BTreeMap::new();
    for (signal, time, value) in store.changes.iter().skip(known) {
        of.entry(*signal).or_default().extend([*time, *value]);
    }
    of.into_iter().map(|(signal, changes)| SignalChanges { signal: signal.to_string(), changes }).collect()
}

/// The positions of a channel's robot from one time to another, in at most `most` rows, and the row before the first.
/// Numbers are little-endian: the counts of rows and axes (u32), times (f64), then row by row axes, TCP and speed
/// (f32), then for each row the lines of program and motion, the number of the motion, and the numbers of the files,
/// that of the motion above 16 bits (u32), and for each row whether another tool took over since the row before (u8).
pub(super) fn samples(track: &Track, [from, to]: [f64; 2], most: usize) -> Vec<u8> {
    let first = track.times.partition_point(|time| *time < from).saturating_sub(1);
    let end = track.times.partition_point(|time| *time <= to).max(first);
    let step = (end - first).div_ceil(most.max(2)).max(1);
    // Columns have the same length, and rows are within it. The last row is there whatever the step.
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
    // The highest speed between rows is kept.
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
