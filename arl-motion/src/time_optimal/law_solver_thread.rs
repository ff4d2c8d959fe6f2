//! Finds laws for the profile O beside the cycle: on a thread of its own, from a copy of what there is to know.
//!
//! A law is asked for in one cycle and taken over a fixed number of cycles later, whenever it was really found: so a run is the
//! same at every clock, and on every machine. If it is not found by then, that cycle waits for it.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Sender, channel};
use std::sync::{Arc, OnceLock};
use std::thread;

use crate::time_optimal::constraint_sampler::{Prospect, Scout};
use crate::time_optimal::limit_check::{MOST_USED, Plot, law_keeps, used_by_law};
use crate::time_optimal::set_points::used_by_set_points;
use crate::time_optimal::solver::{Edge, Law, Way, fastest};
use crate::time_optimal::stop_prediction::Foresight;

/// How long finding a law may take, in s of controller time.
const TIME: f64 = 0.02;
/// How many s of nominal time are looked ahead at first.
pub(crate) const WINDOW: f64 = 2.0;
/// A law takes so many s at least, if there is so much course.
const AHEAD: f64 = 1.5;
/// Parts of the way, and how many times as many places on it, with which a law is looked for until one keeps the limits: where
/// they change much between the places, closer ones are needed.
const TRIES: [(f64, f64); 5] = [(1.0, 1.0), (1.0, 2.0), (0.4, 2.0), (0.15, 3.0), (0.15, 6.0)];
/// How often the limits are lowered where a law uses too much of them; by how much more than it takes; and up to which share.
const TEMPERINGS: usize = 4;
const TEMPERED: f64 = 0.998;
const TOO_MUCH: f64 = 1.1;
/// A stop has a little more acceleration and jerk to go by than a law, so that there is one from any state of a law; it is looked
/// for at so many places at most, so much farther ahead each time, until one is known to be so near the shortest.
const STOPPING: f64 = 1.004;
const STOPS: usize = 12;
const FARTHER: f64 = 1.4;
const SHORTEST: f64 = 0.96;
const STOP_DENSITIES: [f64; 2] = [1.0, 2.0];
/// With so many places on all the ways that were tried, it has to do what was found.
const STOP_PLACES: usize = 1500;
/// A stop that the governor does within so many s is short; another one has to take less than this part of its time, and is looked
/// for at this part of its way first.
const SHORT_STOP: f64 = 0.1;
const MUCH_SOONER: f64 = 0.8;
const NEARER: f64 = 0.5;

/// A law that keeps all limits, and what it was found from.
#[derive(Clone, Debug)]
pub(crate) struct Found {
    pub(crate) law: Arc<Law>,
    pub(crate) plot: Arc<Plot>,
    /// Where it ends, in s of nominal time, and whether the robot has to stop there.
    pub(crate) end: f64,
    pub(crate) stops: bool,
}

/// A law that is being looked for.
#[derive(Clone, Debug)]
pub(crate) struct Search {
    result: Arc<Outcome>,
    /// How many cycles are left.
    left: u32,
}

#[derive(Debug, Default)]
struct Outcome {
    found: OnceLock<Option<Found>>,
    forsaken: AtomicBool,
}

struct Task {
    scout: Scout,
    quest: Quest,
    result: Arc<Outcome>,
}

/// What is looked for.
pub(crate) enum Quest {
    /// The fastest law from a state to rest at the end of what the scout sees or as far as is looked ahead.
    Fastest(Edge),
    /// The shortest one from a state to rest, about so far ahead, with acceleration and jerk `harder` times as high.
    Shortest { start: Edge, about: f64, harder: f64 },
    /// The shortest one to rest, from the state that the robot has so many cycles from now, if that is much sooner than the
    /// governor would rest.
    Sooner(Box<Foresight>, u32),
}

/// The thread that finds laws; it begins with the first one that is asked for.
#[derive(Debug, Default)]
pub(crate) struct Finder {
    tasks: Option<Sender<Task>>,
}

impl Clone for Finder {
    /// Another one, with a thread of its own.
    fn clone(&self) -> Self {
        Self::default()
    }
}

impl Finder {
    /// After how many cycles of `cycle` s a law can be taken over at the earliest.
    pub(crate) fn cycles(cycle: f64) -> u32 {
        (TIME / cycle - 1e-6).ceil().max(1.0) as u32
    }

    /// Begins to look for a law; it will be taken over after so many cycles.
    pub(crate) fn search(&mut self, scout: Scout, quest: Quest, cycles: u32) -> Search {
        let result = Arc::new(Outcome::default());
        let task = Task { scout, quest, result: Arc::clone(&result) };
        if self.tasks.is_none() {
            self.tasks = begin();
        }
        let refused = match &self.tasks {
            Some(tasks) => tasks.send(task).err().map(|refused| refused.0),
            None => Some(task),
        };
        // Without a thread the law has to be found at once.
        if let Some(task) = refused {
            self.tasks = None;
            task.run();
        }
        Search { result, left: cycles }
    }
}

impl Search {
    /// Counts a cycle; when it was the last one, what was found.
    pub(crate) fn next(&mut self) -> Option<Option<Found>> {
        self.left = self.left.saturating_sub(1);
        (self.left == 0).then(|| self.result.found.wait().clone())
    }

    /// Says that the law is not needed any more.
    pub(crate) fn forsake(&self) {
        self.result.forsaken.store(true, Ordering::Relaxed);
    }
}

/// Starts the thread; it ends when nobody can ask it any more.
fn begin() -> Option<Sender<Task>> {
    let (tasks, asked) = channel::<Task>();
    let work = move || asked.iter().for_each(Task::run);
    thread::Builder::new().name("laws".into()).spawn(work).ok().map(|_| tasks)
}

impl Task {
    fn run(self) {
        let Self { scout, quest, result } = self;
        let wanted = || !result.forsaken.load(Ordering::Relaxed);
        let find = || match quest {
            Quest::Fastest(start) => find(&scout, start, wanted),
            Quest::Shortest { start, about, harder } => find_stop(&scout, start, (about, harder), wanted),
            Quest::Sooner(foresight, cycles) => find_sooner(scout, *foresight, cycles, wanted),
        };
        // Whoever waits has to get an answer in any case.
        let found = catch_unwind(AssertUnwindSafe(find)).unwrap_or(None);
        // Nobody else sets it.
        let _ = result.found.set(found);
    }
}

#[cfg(test)]
thread_local! {
    /// How many laws this thread has looked for.
    pub(crate) static FOUND_HERE: std::cell::Cell<u32> = const { std::cell::Cell::new(0) };
}

/// The fastest law from a state on.
fn find(scout: &Scout, start: Edge, wanted: impl Fn() -> bool) -> Option<Found> {
    #[cfg(test)]
    FOUND_HERE.with(|count| count.set(count.get() + 1));
    let stop = scout.end;
    let mut window = WINDOW;
    let mut found = None;
    while wanted() {
        let to = if scout.at + 1.2 * window < stop { scout.at + window } else { stop };
        let attempt = |(share, density): &(f64, f64)| {
            let Prospect { way, end } = scout.look(scout.at + share * (to - scout.at), *density, start, Edge::REST)?;
            let (law, used) = temperate(scout, &way, start, &wanted)?;
            Some((way, end, law, used))
        };
        // Between the places a law may ask for more than there is; better so than none.
        let mut best: Option<(Way, f64, Law, f64)> = None;
        for attempt in TRIES.iter().take_while(|_| wanted()).filter_map(attempt) {
            if best.as_ref().is_none_or(|(.., least)| attempt.3 < *least) {
                best = Some(attempt);
            }
            if best.as_ref().is_some_and(|(.., used)| *used <= MOST_USED) {
                break;
            }
        }
        let Some((way, end, law, _)) = best else { return found };
        let ahead = law.duration();
        let stops = scout.stops && end >= stop;
        found = Some(Found { law: Arc::new(law), plot: Arc::new(Plot::new(way)), end, stops });
        if end < to || to >= stop || ahead >= AHEAD {
            return found;
        }
        // Nominal times are short where constant limits are low: far enough, and not much farther.
        window *= (1.5 * AHEAD / ahead).clamp(1.5, 8.0);
    }
    None
}

/// The fastest law along a way that keeps the limits by its places, with the share of them that its set-points use. Where that
/// is a little too much, the limits are lowered.
fn temperate(scout: &Scout, way: &Way, start: Edge, wanted: &impl Fn() -> bool) -> Option<(Law, f64)> {
    let mut limits = way.clone();
    let mut best: Option<(Law, f64)> = None;
    for _ in 0..=TEMPERINGS {
        let Some(law) = fastest(&limits, start, Edge::REST).ok().filter(|_| wanted()) else { break };
        let mut used = used_by_law(way, &law)?;
        // Close to rest, from a state that moves, the limits between the places are not certain.
        if used.beyond.is_none() {
            used = used_by_set_points(scout, &law, 1.0);
            if best.as_ref().is_none_or(|(_, least)| used.most < *least) {
                best = Some((law, used.most));
            }
        }
        match used.beyond {
            Some(beyond) if used.most < TOO_MUCH => limits.lower(beyond, TEMPERED * MOST_USED / used.most),
            _ => break,
        }
    }
    best
}

/// The shortest law from a state on to rest, which is about so far ahead, with acceleration and jerk times `harder`.
///
/// Whether there is a law to rest at a place is what the solver tells; nearer than the shortest stop there is none.
fn find_stop(scout: &Scout, start: Edge, (about, harder): (f64, f64), wanted: impl Fn() -> bool) -> Option<Found> {
    let farthest = scout.end - scout.at;
    let mut looked_at = 0;
    let mut attempt = |far: f64| {
        let to = if far < farthest { scout.at + far } else { scout.end };
        // Where there is a law that does not keep the limits, closer places are needed.
        for density in STOP_DENSITIES {
            if looked_at > STOP_PLACES {
                return None;
            }
            let Prospect { way, end } = scout.look(to, density, start, Edge::REST)?;
            looked_at += way.places().len();
            let law = fastest(&way.hardened(STOPPING * harder), start, Edge::REST).ok().filter(|_| end >= to)?;
            let is_smooth = || used_by_set_points(scout, &law, harder).beyond.is_none();
            if law_keeps(&way, &law, harder) && is_smooth() {
                let stops = scout.stops && end >= scout.end;
                return Some(Found { law: Arc::new(law), plot: Arc::new(Plot::new(way)), end, stops });
            }
        }
        None
    };
    let (mut short, mut far) = (0.0, about.min(farthest));
    let mut found = None;
    for _ in 0..STOPS {
        if !wanted() {
            return None;
        }
        match attempt(far) {
            Some(law) => {
                (found, far) = (Some((law, far)), if short > 0.0 { (short * far).sqrt() } else { far / FARTHER });
            }
            None if far >= farthest => return None,
            None => {
                short = far;
                let long = found.as_ref().map(|(_, far)| *far);
                far = long.map_or(far * FARTHER, |long| (short * long).sqrt()).min(farthest);
            }
        }
        if found.as_ref().is_some_and(|(_, long)| short >= SHORTEST * long) {
            break;
        }
    }
    found.map(|(law, _)| law)
}

/// The same from the state that the governor's stop leads to within so many cycles, if it rests much sooner than that.
fn find_sooner(scout: Scout, mut foresight: Foresight, cycles: u32, wanted: impl Fn() -> bool) -> Option<Found> {
    let harder = foresight.harder();
    let at = scout.at + foresight.brake(cycles)?;
    let start = foresight.edge();
    let [way, time] = foresight.rest(&wanted)?;
    if time < SHORT_STOP {
        return None;
    }
    let scout = scout.behind(at).up_to(at + way);
    let found = find_stop(&scout, start, (NEARER * way, harder), wanted)?;
    (found.law.duration() < MUCH_SOONER * time).then_some(found)
}
