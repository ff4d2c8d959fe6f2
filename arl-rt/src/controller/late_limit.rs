//! When a robot is stopped since too many cycles were lost.

/// Losses of a second count together, in so many parts of it.
const PARTS: u64 = 20;

/// Counts the cycles that were lost within a second.
#[derive(Debug)]
pub(super) struct LateLimit {
    /// How many may be lost; `None`: any number.
    most: Option<u32>,
    /// How many cycles a part of a second has.
    part_cycles: u64,
    /// How many were lost in each part of the last second, in a ring.
    parts: [u64; PARTS as usize],
    /// The part that is counted now, of all since the start.
    newest: u64,
    /// How many were lost until now.
    seen: u64,
}

impl LateLimit {
    /// So many may be lost within a second, which has so many cycles.
    pub(super) fn new(most: Option<u32>, cycles: u64) -> Self {
        Self { most, part_cycles: (cycles / PARTS).max(1), parts: [0; PARTS as usize], newest: 0, seen: 0 }
    }

    /// What was lost until now counts for nothing: no program ran.
    pub(super) fn forget(&mut self, lost: u64) {
        self.seen = lost;
        self.parts.fill(0);
    }

    /// Takes in how many cycles were lost until this one; how many were within a second, where those are too many. They are told once.
    #[inline]
    pub(super) fn look(&mut self, lost: u64, cycle: u64) -> Option<u64> {
        let new = lost.saturating_sub(std::mem::replace(&mut self.seen, lost));
        let most = u64::from(self.most?);
        if new == 0 {
            return None;
        }
        // Lost ones took their time, too.
        let part = (cycle.saturating_add(lost) / self.part_cycles).max(self.newest);
        for passed in 0..(part - self.newest).min(PARTS) {
            *self.count(part - passed) = 0;
        }
        self.newest = part;
        let count = self.count(part);
        *count = count.saturating_add(new);
        let all = self.parts.iter().fold(0, |all: u64, count| all.saturating_add(*count));
        (all > most).then(|| {
            self.parts.fill(0);
            all
        })
    }

    fn count(&mut self, part: u64) -> &mut u64 {
        // The remainder is below the number of parts.
        &mut self.parts[(part % PARTS) as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn losses_of_a_second_count_together() {
        let mut limit = LateLimit::new(Some(20), 1000);
        assert_eq!(limit.look(0, 0), None);
        assert_eq!(limit.look(15, 100), None);
        assert_eq!(limit.look(15, 101), None);
        // The first ones are more than a second ago.
        assert_eq!(limit.look(30, 1200), None);
        assert_eq!(limit.look(36, 1300), Some(21));
        // It is told, and counts no more.
        assert_eq!(limit.look(40, 1301), None);
        assert_eq!(LateLimit::new(None, 1000).look(1000, 5), None);
    }

    #[test]
    fn many_small_losses_do_not_add_up_for_ever() {
        // Each tenth cycle is lost: 91 a second of the world's time.
        let mut limit = LateLimit::new(Some(100), 1000);
        let found: Vec<u64> = (1..=2000).filter_map(|at| limit.look(at, 10 * at)).collect();
        assert_eq!(found, []);
        let mut limit = LateLimit::new(Some(80), 1000);
        assert_eq!((1..=100).find_map(|at| limit.look(at, 10 * at)), Some(81));
    }

    #[test]
    fn what_is_lost_while_no_program_runs_does_not_count() {
        let mut limit = LateLimit::new(Some(20), 1000);
        limit.forget(5000);
        assert_eq!(limit.look(5010, 1), None);
        // A clock that begins to count anew has lost nothing.
        assert_eq!(limit.look(0, 2), None);
        assert_eq!(limit.look(u64::MAX, u64::MAX), Some(u64::MAX));
    }
}
