//! The limit of lost cycles at which robots are stopped.

use std::fmt;

use crate::cycle::clock_source::Lateness;

/// Losses within a second count together; the second is counted in this many parts.
const PARTS: u64 = 20;

/// Counts the cycles that were lost within a second.
#[derive(Debug)]
pub(super) struct LateLimit {
    /// How many may be lost; `None`: any number.
    most: Option<u32>,
    /// How many cycles a part of a second has.
    part_cycles: u64,
    /// How many were lost in each part of the last second, as a ring buffer.
    parts: [Lost; PARTS as usize],
    /// The number of the current part, counted since the start.
    newest: u64,
    /// How many were lost in total until the last call.
    seen: Lost,
}

/// How many cycles were lost.
#[derive(Clone, Copy, PartialEq, Eq, Default, Debug)]
pub(super) struct Lost {
    /// All lost cycles.
    all: u64,
    /// Those whose beat never came.
    missing: u64,
}

impl Lost {
    fn plus(self, more: Self) -> Self {
        Self { all: self.all.saturating_add(more.all), missing: self.missing.saturating_add(more.missing) }
    }

    /// What has been added since `before`; nothing where the count begins again.
    fn since(self, before: Self) -> Self {
        Self { all: self.all.saturating_sub(before.all), missing: self.missing.saturating_sub(before.missing) }
    }
}

impl From<&Lateness> for Lost {
    fn from(lateness: &Lateness) -> Self {
        Self { all: lateness.lost(), missing: lateness.missing() }
    }
}

/// The cause, and how many were lost within a second.
impl fmt::Display for Lost {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { all, missing } = *self;
        let lost = format!("{all} control cycles were lost within a second");
        match missing {
            0 => write!(f, "the computer was too busy: {lost}"),
            missing if missing == all => write!(f, "messages from the robot did not arrive: {lost}"),
            missing => write!(
                f,
                "{lost}: {missing} as messages from the robot did not arrive, {} as the computer was too busy",
                all - missing
            ),
        }
    }
}

impl LateLimit {
    /// At most `most` may be lost within a second, which has `cycles` cycles.
    pub(super) fn new(most: Option<u32>, cycles: u64) -> Self {
        Self {
            most,
            part_cycles: (cycles / PARTS).max(1),
            parts: [Lost::default(); PARTS as usize],
            newest: 0,
            seen: Lost::default(),
        }
    }

    /// Lets the losses until now count for nothing: no program ran.
    pub(super) fn forget(&mut self, lost: Lost) {
        self.seen = lost;
        self.parts.fill(Lost::default());
    }

    /// Takes in how many cycles were lost until `cycle`. Returns how many were lost within a second, where those are
    /// too many; they are reported once.
    #[inline]
    pub(super) fn look(&mut self, lost: Lost, cycle: u64) -> Option<Lost> {
        let new = lost.since(std::mem::replace(&mut self.seen, lost));
        let most = u64::from(self.most?);
        if new.all == 0 {
            return None;
        }
        // The lost cycles took their time, too.
        let part = (cycle.saturating_add(lost.all) / self.part_cycles).max(self.newest);
        for passed in 0..(part - self.newest).min(PARTS) {
            *self.count(part - passed) = Lost::default();
        }
        self.newest = part;
        let count = self.count(part);
        *count = count.plus(new);
        let together = self.parts.iter().fold(Lost::default(), |together, count| together.plus(*count));
        (together.all > most).then(|| {
            self.parts.fill(Lost::default());
            together
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

    /// A loss by a computer that is too busy.
    fn busy(all: u64) -> Lost {
        Lost { all, missing: 0 }
    }

    #[test]
    fn who_is_to_blame_is_reported() {
        let mut lateness = Lateness::default();
        lateness.note_missing(30);
        let mut limit = LateLimit::new(Some(20), 1000);
        let text = |lost: Option<Lost>| lost.map(|lost| lost.to_string()).unwrap_or_default();
        let lost = limit.look(Lost::from(&lateness), 5);
        assert_eq!(text(lost), "messages from the robot did not arrive: 30 control cycles were lost within a second");
        lateness.note_missing(20);
        lateness.note_lost(2);
        let lost = limit.look(Lost::from(&lateness), 10);
        assert_eq!(
            text(lost),
            "22 control cycles were lost within a second: 20 as messages from the robot did not arrive, 2 as the computer was too busy"
        );
    }

    #[test]
    fn losses_of_a_second_count_together() {
        let mut limit = LateLimit::new(Some(20), 1000);
        assert_eq!(limit.look(busy(0), 0), None);
        assert_eq!(limit.look(busy(15), 100), None);
        assert_eq!(limit.look(busy(15), 101), None);
        // The first ones are more than a second ago.
        assert_eq!(limit.look(busy(30), 1200), None);
        assert_eq!(limit.look(busy(36), 1300), Some(busy(21)));
        // A loss is reported once, and counts no more.
        assert_eq!(limit.look(busy(40), 1301), None);
        assert_eq!(LateLimit::new(None, 1000).look(busy(1000), 5), None);
    }

    #[test]
    fn many_small_losses_do_not_add_up_for_ever() {
        // Each tenth cycle is lost: 91 per second of real time.
        let mut limit = LateLimit::new(Some(100), 1000);
        let found: Vec<Lost> = (1..=2000).filter_map(|at| limit.look(busy(at), 10 * at)).collect();
        assert_eq!(found, []);
        let mut limit = LateLimit::new(Some(80), 1000);
        assert_eq!((1..=100).find_map(|at| limit.look(busy(at), 10 * at)), Some(busy(81)));
    }

    #[test]
    fn what_is_lost_while_no_program_runs_does_not_count() {
        let mut limit = LateLimit::new(Some(20), 1000);
        limit.forget(busy(5000));
        assert_eq!(limit.look(busy(5010), 1), None);
        // A clock that begins to count again has lost nothing.
        assert_eq!(limit.look(busy(0), 2), None);
        assert_eq!(limit.look(busy(u64::MAX), u64::MAX), Some(busy(u64::MAX)));
    }
}
