//! Finds laws in parallel with the cycle: on a thread of its own, from a copy of the data it needs.
//!
//! A law is requested in one cycle and taken over a fixed number of cycles later, no matter when it was really found:
//! so a run is the same with every clock, and on every machine. If the law is not found by then, that cycle waits for
//! it; but not in real time, where the robot does without it, and the next laws are requested earlier.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Sender, channel};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};
use std::thread;

use crate::beside;
use crate::time_optimal::constraint_sampler::{ConstraintSampler, SampledPath};
use crate::time_optimal::law_memory::{LawMemory, RequestMemory, key};
use crate::time_optimal::limit_check::{LimitCheck, MOST_USED_SHARE, law_keeps, used_by_law};
use crate::time_optimal::set_points::used_by_set_points;
use crate::time_optimal::solver::{
    BoundaryState, CREEPING, ConstrainedPath, Law, Pace, fastest, fastest_behind, fastest_near,
};
use crate::time_optimal::stop_prediction::StopPrediction;

/// The time for finding a law, in s of controller time; and the time along very many motions.
const SOLVING_TIME_S: f64 = 0.02;
const SOLVING_TIME_ON_DENSE_CHAIN_S: f64 = 0.06;
/// After a law that came too late, the time grows by this factor, up to this many s; the excess decays by the last
/// factor with each law that comes in time.
const LATE_FACTOR: f64 = 2.0;
const LONGEST_SOLVING_TIME_S: f64 = 0.3;
const SLOWNESS_DECAY: f64 = 0.97;
/// The initial look-ahead in s of nominal time.
pub(crate) const FIRST_LOOK_AHEAD_S: f64 = 2.0;
/// The least duration of a law in s, if there is enough path; and the intended duration where the law before allows an
/// estimate.
const LEAST_LAW_S: f64 = 1.5;
const AIMED_LAW_S: f64 = 2.0;
/// Behind another law, the look-ahead as a multiple of how far that law leads.
const BEHIND_LAW_FACTOR: f64 = 1.2;
/// Shares of the path, and factors on the number of places, with which a law is sought until one keeps the limits:
/// where the limits change much between the places, closer places are needed.
const SHARES_AND_DENSITIES: [(f64, f64); 5] = [(1.0, 1.0), (1.0, 2.0), (0.4, 2.0), (0.15, 3.0), (0.15, 6.0)];
/// The same factors for the whole path, after a first attempt.
const DENSITIES: [f64; 3] = [2.0, 3.0, 6.0];
/// Maximum number of times that the limits are lowered where a law uses too much of them.
const MOST_TEMPERINGS: i32 = 6;
/// The share of the limits that a law may use; a stop may use a little more, so that a stop exists from any state of a
/// law, and what uses more than that is not a law.
const TEMPERED_USE: f64 = 1.006;
/// The limits are lowered by more than necessary, each time by the square of this factor more, unless more than the
/// second value of them is used.
const TEMPERED_SHARE: f64 = 0.998;
const MOST_TEMPERED_USE: f64 = 4.0;
/// A stop has a little more acceleration and jerk available than a law, so that a stop exists from any state of a law.
/// It is sought at no more than this many places, at first farther ahead or nearer by this factor each time, until the
/// shortest stop is known to be at least this share of the one found.
const STOP_LIMIT_FACTOR: f64 = 1.004;
const MOST_STOP_PLACES_TRIED: usize = 12;
const STOP_STEP_FACTOR: f64 = 1.4;
const SHORTEST_STOP_SHARE: f64 = 0.96;
const STOP_DENSITIES: [f64; 2] = [1.0, 2.0];
/// With this many places on all the paths that were tried, the search ends with what was found.
const MOST_STOP_SAMPLES: usize = 1500;
/// A stop of the governor within this many s is short; for a longer one, a shorter stop has to take less than this
/// share of its time, and is first sought at this share of its distance.
const SHORT_STOP_S: f64 = 0.1;
const SHORTER_STOP_SHARE_OF_TIME: f64 = 0.8;
const SHORTER_STOP_SHARE_OF_DISTANCE: f64 = 0.5;

/// A law that keeps all limits, and what it was found from.
#[derive(Clone, Debug)]
pub(crate) struct Found {
    pub(crate) law: Arc<Law>,
    pub(crate) check: Arc<LimitCheck>,
    /// Where it ends, in s of nominal time, and whether the robot has to stop there.
    pub(crate) end: f64,
    pub(crate) stops: bool,
}

/// A law that is being sought.
#[derive(Clone, Debug)]
pub(crate) struct Search {
    result: Arc<Outcome>,
    /// Number of cycles left.
    remaining_cycles: u32,
    /// Whether it has been counted as too late.
    is_late: bool,
}

#[derive(Debug, Default)]
struct Outcome {
    found: OnceLock<Option<Found>>,
    abandoned: AtomicBool,
}

/// The state of a search.
pub(crate) enum Status {
    /// Not due yet.
    Running,
    Done(Option<Found>),
    /// Due, but the law is not there; only in real time.
    Late,
}

struct Task {
    sampler: ConstraintSampler,
    request: LawRequest,
    result: Arc<Outcome>,
}

/// What is sought.
pub(crate) enum LawRequest {
    /// The fastest law from a state to rest, at the end of what the sampler covers or of the look-ahead, with the law
    /// that leads to that state.
    Fastest(BoundaryState, Option<Arc<Law>>),
    /// The shortest law from a state to rest, at a distance of about `about`, with acceleration and jerk times
    /// `stop_scale`.
    Shortest { start: BoundaryState, about: f64, stop_scale: f64 },
    /// The shortest law to rest, from the state that the robot will have after this number of cycles, if it comes to
    /// rest much sooner than the governor would.
    ShorterStop(Box<StopPrediction>, u32),
}

/// The thread that finds laws; it starts with the first request.
#[derive(Debug, Default)]
pub(crate) struct LawSolver {
    tasks: Option<Sender<Task>>,
    /// Whether cycles run in real time.
    in_real_time: bool,
    /// Relative excess of the time for finding a law; 0 as long as no law has come too late.
    slowness: f64,
    /// Number of laws that came too late.
    late: u64,
}

impl Clone for LawSolver {
    /// Creates another solver, with a thread of its own.
    fn clone(&self) -> Self {
        Self { in_real_time: self.in_real_time, ..Self::default() }
    }
}

impl LawSolver {
    /// Sets whether cycles run in real time: then none waits for a law.
    pub(crate) fn follow_real_time(&mut self, in_real_time: bool) {
        self.in_real_time = in_real_time;
        if !in_real_time {
            self.slowness = 0.0;
        }
    }

    /// The number of laws that came too late.
    pub(crate) fn late(&self) -> u64 {
        self.late
    }

    /// The number of cycles of `cycle` s after which a law can be taken over at the earliest, along a dense chain or
    /// not.
    pub(crate) fn cycles(&self, cycle: f64, is_dense: bool) -> u32 {
        let time = if is_dense { SOLVING_TIME_ON_DENSE_CHAIN_S } else { SOLVING_TIME_S };
        let time = (time * (1.0 + self.slowness)).min(LONGEST_SOLVING_TIME_S);
        (time / cycle - 1e-6).ceil().max(1.0) as u32
    }

    /// Counts a cycle of a search, and returns its state.
    pub(crate) fn look(&mut self, search: &mut Search) -> Status {
        search.remaining_cycles = search.remaining_cycles.saturating_sub(1);
        if search.remaining_cycles > 0 {
            return Status::Running;
        }
        if !self.in_real_time {
            let found = search.result.found.wait().clone();
            #[cfg(test)]
            ANSWERS.with(|count| {
                let [all, nothing] = count.get();
                count.set([all + 1, nothing + u32::from(found.is_none())]);
            });
            return Status::Done(found);
        }
        match search.result.found.get() {
            Some(found) => {
                if !search.is_late {
                    self.slowness *= SLOWNESS_DECAY;
                }
                Status::Done(found.clone())
            }
            None => Status::Late,
        }
    }

    /// Counts a law as too late, once: the robot has to do without it, or has to wait for it at rest.
    pub(crate) fn note_late(&mut self, search: &mut Search) {
        if !std::mem::replace(&mut search.is_late, true) {
            self.late += 1;
            let most = LONGEST_SOLVING_TIME_S / SOLVING_TIME_S - 1.0;
            self.slowness = (LATE_FACTOR * (1.0 + self.slowness) - 1.0).min(most);
        }
    }

    /// Starts the search for a law, which will be taken over after `cycles` cycles.
    pub(crate) fn search(&mut self, sampler: ConstraintSampler, request: LawRequest, cycles: u32) -> Search {
        let result = Arc::new(Outcome::default());
        let task = Task { sampler, request, result: Arc::clone(&result) };
        if self.tasks.is_none() {
            self.tasks = begin();
        }
        let refused = match &self.tasks {
            Some(tasks) => tasks.send(task).err().map(|refused| refused.0),
            None => Some(task),
        };
        // Without a thread, the law has to be found at once.
        if let Some(task) = refused {
            self.tasks = None;
            task.run(&mut Memory::default());
        }
        Search { result, remaining_cycles: cycles, is_late: false }
    }
}

impl Search {
    /// Marks the law as no longer needed.
    pub(crate) fn cancel(&self) {
        self.result.abandoned.store(true, Ordering::Relaxed);
    }
}

/// Starts the thread; it ends when no more tasks can be sent to it.
fn begin() -> Option<Sender<Task>> {
    let (tasks, asked) = channel::<Task>();
    let work = move || {
        let mut memory = Memory::begun(&KEPT);
        asked.iter().for_each(|task| task.run(&mut memory));
        memory.leave(&KEPT);
    };
    beside::spawn(thread::Builder::new().name("laws".into()), work).ok().map(|_| tasks)
}

/// The memory of the thread.
#[derive(Default)]
struct Memory {
    laws: LawMemory,
    requests: RequestMemory<Option<Found>>,
}

/// What threads that have ended remembered: the next run of this process may request the same. A request is recognised
/// by everything that may be seen of the path, so that results do not depend on what came before.
static KEPT: KeptMemory = Mutex::new(Vec::new());
type KeptMemory = Mutex<Vec<RequestMemory<Option<Found>>>>;
/// Maximum number that is kept.
const MOST_KEPT: usize = 4;

impl Memory {
    /// Starts with the memory of the thread that ended last.
    fn begun(kept: &KeptMemory) -> Self {
        let mut kept = kept.lock().unwrap_or_else(PoisonError::into_inner);
        Self { laws: LawMemory::default(), requests: kept.pop().unwrap_or_default() }
    }

    /// Leaves the memory to the next thread.
    fn leave(self, kept: &KeptMemory) {
        let mut kept = kept.lock().unwrap_or_else(PoisonError::into_inner);
        if kept.len() < MOST_KEPT {
            kept.push(self.requests);
        }
    }
}

impl Task {
    fn run(self, memory: &mut Memory) {
        let Self { sampler, request, result } = self;
        let wanted = || !result.abandoned.load(Ordering::Relaxed);
        let find = || match request {
            LawRequest::Fastest(start, law) => recall_or_find(sampler, start, law, memory, wanted),
            LawRequest::Shortest { start, about, stop_scale } => find_stop(&sampler, start, about, stop_scale, wanted),
            LawRequest::ShorterStop(prediction, cycles) => find_shorter_stop(sampler, *prediction, cycles, wanted),
        };
        // A waiting cycle has to get a result in any case.
        let found = catch_unwind(AssertUnwindSafe(find)).unwrap_or(None);
        // Nothing else sets it.
        let _ = result.found.set(found);
    }
}

#[cfg(test)]
impl LawSolver {
    /// Makes the thread never find anything.
    pub(crate) fn find_nothing(&mut self) {
        let (tasks, asked) = channel();
        std::mem::forget(asked);
        self.tasks = Some(tasks);
    }
}

#[cfg(test)]
impl Search {
    /// Waits until the thread is done.
    pub(crate) fn wait(&self) {
        self.result.found.wait();
    }
}

#[cfg(test)]
thread_local! {
    /// Number of laws that this thread has sought.
    pub(crate) static FOUND_HERE: std::cell::Cell<u32> = const { std::cell::Cell::new(0) };
    /// Number of results that this thread has waited for, and how many of them were that there is no law.
    pub(crate) static ANSWERS: std::cell::Cell<[u32; 2]> = const { std::cell::Cell::new([0, 0]) };
}

/// The fastest law from a state on, remembered or found now.
fn recall_or_find(
    sampler: ConstraintSampler,
    start: BoundaryState,
    before: Option<Arc<Law>>,
    memory: &mut Memory,
    wanted: impl Fn() -> bool,
) -> Option<Found> {
    if let Some(known) = memory.requests.recall(&sampler, start, before.as_ref()) {
        return known;
    }
    let found = find(&sampler, start, before.as_deref(), &mut memory.laws, &wanted);
    if wanted() {
        let rows = found.as_ref().map_or(0, |found| 2 * found.law.stretches() + found.check.rows());
        memory.requests.remember(sampler, start, before, found.clone(), rows);
    }
    found
}

/// Finds the fastest law from a state on.
fn find(
    sampler: &ConstraintSampler,
    start: BoundaryState,
    before: Option<&Law>,
    memory: &mut LawMemory,
    wanted: impl Fn() -> bool,
) -> Option<Found> {
    #[cfg(test)]
    FOUND_HERE.with(|count| count.set(count.get() + 1));
    let stop = sampler.end;
    let speed = before.map(Law::mean_speed).filter(|speed| *speed > 0.0);
    // No nearer than the law before leads: the robot may not be able to come to rest there.
    let known = before.map_or(0.0, |law| law.end() - sampler.at);
    let mut window = speed.map_or(FIRST_LOOK_AHEAD_S, |speed| AIMED_LAW_S * speed).max(BEHIND_LAW_FACTOR * known);
    let mut found = None;
    while wanted() {
        let to = if sampler.at + 1.2 * window < stop { sampler.at + window } else { stop };
        let mut attempt = |(share, density): &(f64, f64)| {
            let (to, edges) = (sampler.at + share * (to - sampler.at), [start, BoundaryState::REST]);
            let SampledPath { path, thinned, end } = match speed {
                Some(speed) => sampler.look_at_speed(to, *density, edges, speed),
                None => sampler.look(to, *density, start, BoundaryState::REST),
            }?;
            let sparse = thinned.as_ref().unwrap_or(&path);
            let found = || {
                let found = law_within_limits(sampler, sparse, start, before, &wanted);
                (found.map(|(law, used)| (Arc::new(law), used)), wanted())
            };
            let (law, used) = memory.recall(key(sparse, start, before), found)?;
            Some((path, end, law, used))
        };
        // Between the places, a law may require more than is available: a small excess is acceptable.
        let mut best: Option<(ConstrainedPath, f64, Arc<Law>, f64)> = None;
        for attempt in SHARES_AND_DENSITIES.iter().take_while(|_| wanted()).filter_map(&mut attempt) {
            if best.as_ref().is_none_or(|(.., least)| attempt.3 < *least) {
                best = Some(attempt);
            }
            if best.as_ref().is_some_and(|(.., used)| *used <= TEMPERED_USE) {
                break;
            }
        }
        let Some((path, end, law, _)) = best.filter(|(.., used)| *used <= MOST_USED_SHARE) else { return found };
        let ahead = law.duration();
        let stops = sampler.stops && end >= stop;
        found = Some(Found { law, check: Arc::new(LimitCheck::new(path)), end, stops });
        if end < to || to >= stop || ahead >= LEAST_LAW_S {
            return found;
        }
        // Nominal times are short where constant limits are low: look far enough, but not much farther.
        window *= (1.5 * LEAST_LAW_S / ahead).clamp(1.5, 8.0);
    }
    None
}

/// The duration of the fastest motion along everything that the sampler covers, from rest to rest, in s: sought at the
/// places of `first`, which reach the end, then at closer places; `None` where no law keeps the limits.
pub(crate) fn fastest_duration(sampler: &ConstraintSampler, first: SampledPath) -> Option<f64> {
    let closer = DENSITIES.iter().filter_map(|density| {
        let sampled = sampler.look(sampler.end, *density, BoundaryState::REST, BoundaryState::REST)?;
        (sampled.end >= sampler.end).then_some(sampled)
    });
    [first].into_iter().chain(closer).find_map(|sampled| {
        let sparse = sampled.thinned.as_ref().unwrap_or(&sampled.path);
        let (law, used) = law_within_limits(sampler, sparse, BoundaryState::REST, None, &|| true)?;
        (used <= MOST_USED_SHARE).then(|| law.duration())
    })
}

/// The fastest law along a path that keeps the limits at its places, with the share of them that its set-points use.
/// Where that is a little too much, the limits are lowered.
fn law_within_limits(
    sampler: &ConstraintSampler,
    path: &ConstrainedPath,
    start: BoundaryState,
    before: Option<&Law>,
    wanted: &impl Fn() -> bool,
) -> Option<(Law, f64)> {
    let mut limits = path.clone();
    let mut best: Option<(Law, f64)> = None;
    let mut pace: Option<Pace> = None;
    let mut longest: Option<f64> = None;
    for round in 0..=MOST_TEMPERINGS {
        let solved = match &pace {
            Some(pace) => fastest_near(&limits, start, BoundaryState::REST, pace),
            None => fastest_behind(&limits, start, BoundaryState::REST, before),
        };
        let Some(law) = solved.ok().filter(|_| wanted()) else { break };
        // Lower limits cost little time unless the search fails.
        if law.duration() > CREEPING * *longest.get_or_insert(law.duration()) {
            break;
        }
        // Always the pace of the first law: limits that are lowered for one parameter hold for that parameter.
        pace = pace.or_else(|| law.pace());
        let mut used = used_by_law(path, &law, TEMPERED_USE)?;
        if used.most <= MOST_USED_SHARE {
            let by_set_points = used_by_set_points(sampler, &law, 1.0, TEMPERED_USE);
            let most = used.most.max(by_set_points.most);
            if best.as_ref().is_none_or(|(_, least)| most < *least) {
                best = Some((law, most));
            }
            if used.beyond.is_empty() {
                used = by_set_points;
            }
        }
        if used.beyond.is_empty() || used.most > MOST_TEMPERED_USE {
            break;
        }
        limits.lower(&used.beyond, libm::pow(TEMPERED_SHARE, f64::from(1 + 2 * round)) * TEMPERED_USE);
    }
    best
}

/// The shortest law from a state to rest at a distance of about `about`, with acceleration and jerk times `stop_scale`.
///
/// Whether there is a law to rest at a place is decided by the solver; there is none nearer than the shortest stop.
fn find_stop(
    sampler: &ConstraintSampler,
    start: BoundaryState,
    about: f64,
    stop_scale: f64,
    wanted: impl Fn() -> bool,
) -> Option<Found> {
    let farthest = sampler.end - sampler.at;
    let mut looked_at = 0;
    let mut attempt = |far: f64| {
        let to = if far < farthest { sampler.at + far } else { sampler.end };
        // Where there is a law that does not keep the limits, closer places are needed.
        for density in STOP_DENSITIES {
            if looked_at > MOST_STOP_SAMPLES {
                return None;
            }
            let SampledPath { path, thinned, end } = sampler.look(to, density, start, BoundaryState::REST)?;
            let sparse = thinned.as_ref().unwrap_or(&path);
            looked_at += sparse.places().len();
            let law = fastest(&sparse.hardened(STOP_LIMIT_FACTOR * stop_scale), start, BoundaryState::REST)
                .ok()
                .filter(|_| end >= to)?;
            let is_smooth = || used_by_set_points(sampler, &law, stop_scale, MOST_USED_SHARE).beyond.is_empty();
            if law_keeps(sparse, &law, stop_scale) && is_smooth() {
                let stops = sampler.stops && end >= sampler.end;
                return Some(Found { law: Arc::new(law), check: Arc::new(LimitCheck::new(path)), end, stops });
            }
        }
        None
    };
    let (mut short, mut far) = (0.0, about.min(farthest));
    let mut found = None;
    for _ in 0..MOST_STOP_PLACES_TRIED {
        if !wanted() {
            return None;
        }
        match attempt(far) {
            Some(law) => {
                (found, far) =
                    (Some((law, far)), if short > 0.0 { (short * far).sqrt() } else { far / STOP_STEP_FACTOR });
            }
            None if far >= farthest => return None,
            None => {
                short = far;
                let long = found.as_ref().map(|(_, far)| *far);
                far = long.map_or(far * STOP_STEP_FACTOR, |long| (short * long).sqrt()).min(farthest);
            }
        }
        if found.as_ref().is_some_and(|(_, long)| short >= SHORTEST_STOP_SHARE * long) {
            break;
        }
    }
    found.map(|(law, _)| law)
}

/// The shortest stop from the state that the governor's stop leads to within `cycles` cycles, if it takes much less
/// time than the governor's stop.
fn find_shorter_stop(
    sampler: ConstraintSampler,
    mut prediction: StopPrediction,
    cycles: u32,
    wanted: impl Fn() -> bool,
) -> Option<Found> {
    let stop_scale = prediction.stop_scale();
    let at = sampler.at + prediction.brake(cycles)?;
    let start = prediction.edge();
    let [distance, time] = prediction.rest(&wanted)?;
    if time < SHORT_STOP_S {
        return None;
    }
    let sampler = sampler.behind(at).up_to(at + distance);
    let found = find_stop(&sampler, start, SHORTER_STOP_SHARE_OF_DISTANCE * distance, stop_scale, wanted)?;
    (found.law.duration() < SHORTER_STOP_SHARE_OF_TIME * time).then_some(found)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::command::{Command, Settings, Target};
    use crate::follow::segment::Segment;
    use crate::follow::shared_deque::SharedDeque;
    use crate::plan::planner::plan;
    use crate::time_optimal::constraint_sampler::Part;
    use arl_robot::robot::Robot;

    #[test]
    fn after_one_that_came_too_late_laws_have_more_time_for_a_while() {
        let mut solver = LawSolver::default();
        solver.follow_real_time(true);
        let search = |found: bool| {
            let result = Outcome::default();
            if found {
                result.found.set(None).unwrap();
            }
            Search { result: Arc::new(result), remaining_cycles: 1, is_late: false }
        };
        assert_eq!([false, true].map(|is_dense| solver.cycles(0.001, is_dense)), [20, 60]);
        for expected in [40, 80, 160, 300, 300] {
            let mut late = search(false);
            assert!(matches!(solver.look(&mut late), Status::Late));
            // It is counted once, however long the robot waits for it.
            solver.note_late(&mut late);
            solver.note_late(&mut late);
            assert_eq!(solver.cycles(0.001, false), expected);
        }
        assert_eq!((solver.late(), solver.cycles(0.001, true)), (5, 300));
        for _ in 0..200 {
            assert!(matches!(solver.look(&mut search(true)), Status::Done(None)));
        }
        assert!(solver.cycles(0.001, false) <= 21);
        solver.follow_real_time(false);
        assert_eq!(solver.cycles(0.001, false), 20);
    }

    /// A sampler of a motion of the axes, at a share of the speed, from its start; its segment has this number.
    fn sampler(robot: &Arc<Robot>, number: u64, percent: f64) -> ConstraintSampler {
        let start = crate::tests::axes([0.0, -90.0, 90.0, 0.0, 45.0, 0.0]);
        let plain: Command =
            crate::tests::command(Target::Joints(crate::tests::axes([30.0, -80.0, 70.0, 10.0, 60.0, 0.0])));
        let command = Command { speed: crate::command::Speed { percent, ..plain.speed }, ..plain };
        let motion = plan(robot, &start, &command, &Settings::default()).unwrap();
        let mut segments = SharedDeque::default();
        segments.push_back(Arc::new(Segment::part(&motion, motion.limits.unwrap(), number, 0.0, 1.0)));
        ConstraintSampler::new(robot, Part::whole(segments), 0.0, &start)
    }

    #[test]
    fn a_request_that_is_the_same_does_not_look_at_the_path() {
        let robot = Arc::new(Robot::builtin("kr10-r1420").unwrap());
        let mut memory = Memory::default();
        let mut law = |number: u64, percent: f64, start: BoundaryState, before: Option<Arc<Law>>| {
            let asked = FOUND_HERE.get();
            let found = recall_or_find(sampler(&robot, number, percent), start, before, &mut memory, || true);
            (FOUND_HERE.get() - asked, found.map(|found| found.law))
        };
        let (_, first) = law(1, 50.0, BoundaryState::REST, None);
        let first = first.unwrap();
        let (asked, again) = law(7, 50.0, BoundaryState::REST, None);
        assert!(asked == 0 && Arc::ptr_eq(&again.unwrap(), &first));
        assert_eq!(law(7, 40.0, BoundaryState::REST, None).0, 1);
        let state = first.at(0.2);
        let state = BoundaryState { vel: state.vel, acc: state.acc };
        assert_eq!(law(7, 50.0, state, None).0, 1);
        assert_eq!(law(7, 50.0, BoundaryState::REST, Some(first)).0, 1);
        // A search that was abandoned is not remembered.
        let mut memory = Memory::default();
        recall_or_find(sampler(&robot, 1, 50.0), BoundaryState::REST, None, &mut memory, || false);
        assert!(memory.requests.recall(&sampler(&robot, 1, 50.0), BoundaryState::REST, None).is_none());
    }

    #[test]
    fn the_next_run_knows_what_the_last_one_found() {
        let robot = Arc::new(Robot::builtin("kr10-r1420").unwrap());
        let kept = KeptMemory::default();
        let law = |speed| {
            let mut memory = Memory::begun(&kept);
            let asked = FOUND_HERE.get();
            let found = recall_or_find(sampler(&robot, 1, speed), BoundaryState::REST, None, &mut memory, || true);
            memory.leave(&kept);
            (FOUND_HERE.get() - asked, found.unwrap().law)
        };
        let (asked, first) = law(50.0);
        assert_eq!(asked, 1);
        assert_eq!(law(40.0).0, 1);
        let (asked, again) = law(50.0);
        assert!(asked == 0 && Arc::ptr_eq(&first, &again));
        // Robots that run at the same time have memories of their own.
        let [one, other] = [Memory::begun(&kept), Memory::begun(&kept)];
        let known =
            |memory: &Memory| memory.requests.recall(&sampler(&robot, 1, 50.0), BoundaryState::REST, None).is_some();
        assert_eq!((known(&one), known(&other)), (true, false));
        one.leave(&kept);
        (0..2 * MOST_KEPT).for_each(|_| Memory::default().leave(&kept));
        assert_eq!(kept.lock().unwrap().len(), MOST_KEPT);
    }

    #[test]
    fn a_path_that_was_followed_before_is_not_timed_again() {
        let robot = Arc::new(Robot::builtin("kr10-r1420").unwrap());
        let mut memory = LawMemory::default();
        let mut law = || find(&sampler(&robot, 1, 50.0), BoundaryState::REST, None, &mut memory, || true).unwrap().law;
        assert!(Arc::ptr_eq(&law(), &law()));
    }
}
