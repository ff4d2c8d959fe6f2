//! When a robot is stopped since too many cycles were lost.

use std::fmt;

use crate::cycle::clock_source::Lateness;

/// Losses of a second count together, in so many parts of it.
const PARTS: u64 = 20;

/// Cycles that were lost, by what lost them.
#[derive(Clone, Copy, PartialEq, Eq, Default, Debug)]
pub(super) struct Lost {
    /// The computer did something else, or a cycle took too long.
    late: u64,
    /// What gives the beat was not heard.
    missing: u64,
}

impl Lost {
    /// All until now.
    #[inline]
    pub(super) fn of(lateness: &Lateness) -> Self {
        Self { late: lateness.lost(), missing: lateness.missing() }
    }

    fn all(self) -> u64 {
        self.late.saturating_add(self.missing)
    }

    fn plus(self, other: Self) -> Self {
        Self { late: self.late.saturating_add(other.late), missing: self.missing.saturating_add(other.missing) }
    }

    fn since(self, before: Self) -> Self {
        let Self { late, missing } = before;
        Self { late: self.late.saturating_sub(late), missing: self.missing.saturating_sub(missing) }
    }
}

/// Those of a second, and the cause.
impl fmt::Display for Lost {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { late, missing } = self;
        match (late, missing) {
            (late, 0) => write!(f, "the computer was too busy: {late} control cycles were lost within a second"),
            (0, missing) => write!(
                f,
                "{missing} messages of the robot did not arrive within a second: each one that is missing is a control \
                 cycle that is lost"
            ),
            _ => write!(
                f,
                "{} control cycles were lost within a second: {missing} since messages of the robot did not arrive, \
                 {late} since the computer was too busy",
                self.all()
            ),
        }
    }
}

/// Counts the cycles that were lost within a second.
#[derive(Debug)]
pub(super) struct LateLimit {
    /// How many may be lost; `None`: any number.
    most: Option<u32>,
    /// How many cycles a part of a second has.
    part_cycles: u64,
    /// How many were lost in each part of the last second, in a ring.
    parts: [Lost; PARTS as usize],
    /// The part that is counted now, of all since the start.
    newest: u64,
    /// How many were lost until now.
    seen: Lost,
}

impl LateLimit {
    /// So many may be lost within a second, which has so many cycles.
    pub(super) fn new(most: Option<u32>, cycles: u64) -> Self {
        let (parts, seen) = ([Lost::default(); PARTS as usize], Lost::default());
        Self { most, part_cycles: (cycles / PARTS).max(1), parts, newest: 0, seen }
    }

    /// What was lost until now counts for nothing: no program ran.
    pub(super) fn forget(&mut self, lost: Lost) {
        self.seen = lost;
        self.parts.fill(Lost::default());
    }

    /// Takes in how many cycles were lost until this one; how many were within a second, where those are too many. They are told once.
    #[inline]
    pub(super) fn look(&mut self, lost: Lost, cycle: u64) -> Option<Lost> {
        let new = lost.since(std::mem::replace(&mut self.seen, lost));
        let most = u64::from(self.most?);
        if new.all() == 0 {
            return None;
        }
        // Lost ones took their time, too.
        let part = (cycle.saturating_add(lost.all()) / self.part_cycles).max(self.newest);
        for passed in 0..(part - self.newest).min(PARTS) {
            *self.count(part - passed) = Lost::default();
        }
        self.newest = part;
        let count = self.count(part);
        *count = count.plus(new);
        let within_a_second = self.parts.iter().fold(Lost::default(), |all, count| all.plus(*count));
        (within_a_second.all() > most).then(|| {
            self.parts.fill(Lost::default());
            within_a_second
        })
    }

    fn count(&mut self, part: u64) -> &mut Lost {
        // The remainder is below the number of parts.
        &mut self.parts[(part % PARTS) as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn late(late: u64) -> Lost {
        Lost { late, missing: 0 }
    }

    #[test]
    fn losses_of_a_second_count_together() {
        let mut limit = LateLimit::new(Some(20), 1000);
        assert_eq!(limit.look(late(0), 0), None);
        assert_eq!(limit.look(late(15), 100), None);
        assert_eq!(limit.look(late(15), 101), None);
        // The first ones are more than a second ago.
        assert_eq!(limit.look(late(30), 1200), None);
        assert_eq!(limit.look(late(36), 1300), Some(late(21)));
        // It is told, and counts no more.
        assert_eq!(limit.look(late(40), 1301), None);
        assert_eq!(LateLimit::new(None, 1000).look(late(1000), 5), None);
    }

    #[test]
    fn many_small_losses_do_not_add_up_for_ever() {
        // Each tenth cycle is lost: 91 a second of the world's time.
        let mut limit = LateLimit::new(Some(100), 1000);
        let found: Vec<Lost> = (1..=2000).filter_map(|at| limit.look(late(at), 10 * at)).collect();
        assert_eq!(found, []);
        let mut limit = LateLimit::new(Some(80), 1000);
        assert_eq!((1..=100).find_map(|at| limit.look(late(at), 10 * at)), Some(late(81)));
    }

    #[test]
    fn what_is_lost_while_no_program_runs_does_not_count() {
        let mut limit = LateLimit::new(Some(20), 1000);
        limit.forget(late(5000));
        assert_eq!(limit.look(late(5010), 1), None);
        // A clock that begins to count anew has lost nothing.
        assert_eq!(limit.look(late(0), 2), None);
        assert_eq!(limit.look(late(u64::MAX), u64::MAX), Some(late(u64::MAX)));
    }

    #[test]
    fn each_cause_is_named() {
        let mut limit = LateLimit::new(Some(20), 1000);
        assert_eq!(limit.look(Lost { late: 3, missing: 15 }, 1), None);
        let found = limit.look(Lost { late: 6, missing: 15 }, 2).map(|lost| lost.to_string());
        let right = "21 control cycles were lost within a second: 15 since messages of the robot did not arrive, \
                     6 since the computer was too busy";
        assert_eq!(found.as_deref(), Some(right));
        assert!(Lost { late: 0, missing: 30 }.to_string().starts_with("30 messages of the robot did not arrive"));
        assert_eq!(late(22).to_string(), "the computer was too busy: 22 control cycles were lost within a second");
    }
}
