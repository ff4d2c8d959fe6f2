//! When a robot is stopped since too many cycles were lost.

/// How long losses count together, in s.
const WINDOW_S: f64 = 1.0;
/// In so many parts of that they are counted.
const PARTS: usize = 20;

/// Counts the cycles that were lost within a second.
#[derive(Debug)]
pub(super) struct LateLimit {
    /// How many may be lost; `None`: any number.
    most: Option<u32>,
    /// How many were lost in each part of the last second, in a ring.
    parts: [u64; PARTS],
    /// The part that is counted now, of all since the start.
    newest: u64,
    /// How many were lost until now.
    seen: u64,
}

impl LateLimit {
    pub(super) fn new(most: Option<u32>) -> Self {
        Self { most, parts: [0; PARTS], newest: 0, seen: 0 }
    }

    /// What was lost until now counts for nothing: no program ran.
    pub(super) fn forget(&mut self, lost: u64) {
        self.seen = lost;
        self.parts = [0; PARTS];
    }

    /// Takes in how many cycles were lost until this one; how many were within a second, where those are too many. They are told once.
    #[inline]
    pub(super) fn look(&mut self, lost: u64, cycle: u64, cycles_of: impl Fn(f64) -> u64) -> Option<u64> {
        let new = lost.saturating_sub(std::mem::replace(&mut self.seen, lost));
        let most = u64::from(self.most?);
        if new == 0 {
            return None;
        }
        // Lost ones took their time, too.
        let part = cycle.saturating_add(lost) / (cycles_of(WINDOW_S) / PARTS as u64).max(1);
        let passed = part.saturating_sub(self.newest).min(PARTS as u64);
        for empty in 0..passed {
            let at = (part - empty) % PARTS as u64;
            self.parts.iter_mut().skip(at as usize).take(1).for_each(|count| *count = 0);
        }
        self.newest = self.newest.max(part);
        let at = (self.newest % PARTS as u64) as usize;
        self.parts.iter_mut().skip(at).take(1).for_each(|count| *count = count.saturating_add(new));
        let all = self.parts.iter().fold(0, |all: u64, count| all.saturating_add(*count));
        (all > most).then(|| {
            self.parts = [0; PARTS];
            all
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn losses_of_a_second_count_together() {
        let cycles_of = |seconds: f64| (seconds * 1000.0) as u64;
        let mut limit = LateLimit::new(Some(20));
        assert_eq!(limit.look(0, 0, cycles_of), None);
        assert_eq!(limit.look(15, 100, cycles_of), None);
        assert_eq!(limit.look(15, 101, cycles_of), None);
        // The first ones are more than a second ago.
        assert_eq!(limit.look(30, 1200, cycles_of), None);
        assert_eq!(limit.look(36, 1300, cycles_of), Some(21));
        // It is told, and counts no more.
        assert_eq!(limit.look(40, 1301, cycles_of), None);
        assert_eq!(LateLimit::new(None).look(1000, 5, cycles_of), None);
    }

    #[test]
    fn many_small_losses_do_not_add_up_for_ever() {
        // Each tenth cycle is lost: 91 a second of the world's time.
        let mut limit = LateLimit::new(Some(100));
        let found: Vec<u64> = (1..=2000).filter_map(|at| limit.look(at, 10 * at, |_| 1000)).collect();
        assert_eq!(found, []);
        let mut limit = LateLimit::new(Some(80));
        assert_eq!((1..=100).find_map(|at| limit.look(at, 10 * at, |_| 1000)), Some(81));
    }

    #[test]
    fn what_is_lost_while_no_program_runs_does_not_count() {
        let mut limit = LateLimit::new(Some(20));
        limit.forget(5000);
        assert_eq!(limit.look(5010, 1, |_| 1000), None);
        // A clock that begins to count anew has lost nothing.
        assert_eq!(limit.look(0, 2, |_| 1000), None);
        assert_eq!(limit.look(u64::MAX, u64::MAX, |_| 1000), Some(u64::MAX));
    }
}
