//! Laws that were found before, for programs that repeat the same motions.
//!
//! A law is a function of what it was found from, so a remembered one is the one that would be found. What it was found
//! from is identified by a fingerprint of 128 bits: places, the derivatives and limits of everything that moves there,
//! the state at the start, and the law before. Two paths that agree in all of these to the last bit, yet differ between
//! the places, do not occur.

use std::collections::hash_map::DefaultHasher;
use std::collections::{HashMap, VecDeque};
use std::hash::Hasher;
use std::sync::Arc;

use crate::time_optimal::constraint_sampler::ConstraintSampler;
use crate::time_optimal::solver::{BoundaryState, ConstrainedPath, Law};

/// Maximum number of stretches that are remembered for all laws together, of 80 bytes each.
const MOST_STRETCHES: usize = 60_000;
/// A search without a result takes as much room as a law of this many stretches.
const ROOM_OF_NOTHING: usize = 10;

/// Maximum number of requests that are remembered with their results, and of segments in each: a loop has a few, while
/// a dense chain has thousands and is not executed twice.
const MOST_REQUESTS: usize = 1024;
const MOST_SEGMENTS: usize = 512;
/// Maximum room of all requests, in rows of limits of 48 bytes.
const MOST_ROOM: usize = 300_000;
/// The room of a segment, in such rows.
const ROOM_OF_SEGMENT: usize = 10;

/// A law, and the share of the limits that its set-points use; `None` where there is no law.
pub(crate) type Answer = Option<(Arc<Law>, f64)>;

/// The last laws that were found.
#[derive(Debug, Default)]
pub(crate) struct LawMemory {
    known: HashMap<u128, Remembered>,
    /// Number of stretches, and number of requests so far.
    stretches: usize,
    asked: u64,
}

#[derive(Debug)]
struct Remembered {
    answer: Answer,
    /// When it was requested last.
    asked: u64,
}

impl LawMemory {
    /// The result for the same key, else what `find` returns, which is remembered if it is final.
    pub(crate) fn recall(&mut self, key: u128, find: impl FnOnce() -> (Answer, bool)) -> Answer {
        self.asked += 1;
        if let Some(known) = self.known.get_mut(&key) {
            known.asked = self.asked;
            return known.answer.clone();
        }
        let (answer, is_final) = find();
        if is_final {
            self.stretches += room(&answer);
            self.known.insert(key, Remembered { answer: answer.clone(), asked: self.asked });
            self.forget();
        }
        answer
    }

    /// Forgets the results that were not requested for the longest time, until the rest is small enough.
    fn forget(&mut self) {
        while self.stretches > MOST_STRETCHES
            && let Some(oldest) = self.known.iter().min_by_key(|(_, known)| known.asked).map(|(key, _)| *key)
            && let Some(gone) = self.known.remove(&oldest)
        {
            self.stretches -= room(&gone.answer);
        }
    }
}

/// The last requests for laws from a state on where everything that may be seen of the path is the same: then the path
/// is not examined.
#[derive(Default)]
pub(crate) struct RequestMemory<F> {
    known: VecDeque<Request<F>>,
    /// Room that they take together.
    room: usize,
}

struct Request<F> {
    sampler: ConstraintSampler,
    start: BoundaryState,
    before: Option<Arc<Law>>,
    found: F,
    room: usize,
}

impl<F: Clone> RequestMemory<F> {
    /// The result for the same request.
    pub(crate) fn recall(
        &self,
        sampler: &ConstraintSampler,
        start: BoundaryState,
        before: Option<&Arc<Law>>,
    ) -> Option<F> {
        let same = |law: Option<&Arc<Law>>| law.map(Arc::as_ptr) == before.map(Arc::as_ptr);
        let is_same =
            |known: &&Request<F>| known.start == start && same(known.before.as_ref()) && known.sampler.is_like(sampler);
        self.known.iter().find(is_same).map(|known| known.found.clone())
    }

    /// Remembers the result of a request that was not known, if it takes little memory: that of `rows` rows of limits,
    /// in addition to the path.
    pub(crate) fn remember(
        &mut self,
        sampler: ConstraintSampler,
        start: BoundaryState,
        before: Option<Arc<Law>>,
        found: F,
        rows: usize,
    ) {
        if sampler.segments() > MOST_SEGMENTS {
            return;
        }
        let room = rows + ROOM_OF_SEGMENT * sampler.segments();
        self.known.push_back(Request { sampler, start, before, found, room });
        self.room += room;
        while (self.room > MOST_ROOM || self.known.len() > MOST_REQUESTS)
            && let Some(oldest) = self.known.pop_front()
        {
            self.room -= oldest.room;
        }
    }
}

fn room(answer: &Answer) -> usize {
    answer.as_ref().map_or(ROOM_OF_NOTHING, |(law, _)| law.stretches())
}

/// The fingerprint of what a law is found from.
pub(crate) fn key(path: &ConstrainedPath, start: BoundaryState, before: Option<&Law>) -> u128 {
    // The second hasher starts differently, so that the two are independent.
    let mut halves = [DefaultHasher::new(), DefaultHasher::new()];
    halves[1].write_u64(1);
    let mut note = |number: u64| halves.iter_mut().for_each(|half| half.write_u64(number));
    path.numbers(&mut note);
    [start.vel, start.acc].into_iter().for_each(|number| note(number.to_bits()));
    if let Some(law) = before {
        law.numbers(&mut note);
    }
    let [high, low] = halves.map(|half| u128::from(half.finish()));
    high << 64 | low
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::time_optimal::solver::{Row, fastest, places};

    fn path(places: &[f64], second: f64) -> ConstrainedPath {
        let mut path = ConstrainedPath::new();
        for at in places {
            let bent = if *at > 1.0 { second } else { 0.0 };
            path.push(*at, [Row { first: 1.0, second: bent, third: 0.0, vel: 1.0, acc: 5.0, jerk: 50.0 }]);
        }
        path
    }

    fn find(path: &ConstrainedPath) -> (Answer, bool) {
        (fastest(path, BoundaryState::REST, BoundaryState::REST).ok().map(|law| (Arc::new(law), 1.0)), true)
    }

    #[test]
    fn the_same_is_found_once_and_everything_counts() {
        let all = places(0.0, 2.0, 60, BoundaryState::REST, BoundaryState::REST);
        let mut memory = LawMemory::default();
        let (plain, bent) = (path(&all, 0.0), path(&all, 1e-12));
        let first = memory.recall(key(&plain, BoundaryState::REST, None), || find(&plain)).unwrap();
        let again = memory.recall(key(&plain, BoundaryState::REST, None), || panic!("it is known")).unwrap();
        assert!(Arc::ptr_eq(&first.0, &again.0));
        let state = BoundaryState { vel: 0.5, acc: 0.0 };
        let keys = [
            key(&plain, BoundaryState::REST, None),
            key(&bent, BoundaryState::REST, None),
            key(&plain, state, None),
            key(&plain, BoundaryState { acc: 1e-300, ..state }, None),
            key(&plain, state, Some(&first.0)),
        ];
        for (index, key) in keys.iter().enumerate() {
            assert!(keys.iter().skip(index + 1).all(|other| other != key), "{index}");
        }
    }

    #[test]
    fn what_was_not_asked_for_for_longest_goes() {
        let all = places(0.0, 2.0, 60, BoundaryState::REST, BoundaryState::REST);
        let plain = path(&all, 0.0);
        let (law, _) = find(&plain);
        let mut memory = LawMemory::default();
        let most = (MOST_STRETCHES / law.as_ref().unwrap().0.stretches()) as u128;
        for key in 0..most {
            memory.recall(key, || (law.clone(), true));
        }
        memory.recall(0, || panic!("it is known"));
        memory.recall(most, || (law.clone(), true));
        assert!(memory.known.contains_key(&0) && !memory.known.contains_key(&1) && memory.stretches <= MOST_STRETCHES);
        // A search that was abandoned is not remembered.
        memory.recall(most + 1, || (None, false));
        assert!(!memory.known.contains_key(&(most + 1)));
    }
}
