//! Turns of loops that calculate and do not use the context.

use std::cell::Cell;

/// The turns that loops may make in this cycle. Those left go back to the context when this is dropped.
///
/// It lives between two waits, so that the number is in a register: in the context, or in a value that lives across a
/// wait, it would be in memory, and so would everything else that the loop uses.
#[derive(Debug)]
pub struct Rounds<'a> {
    pub(super) budget: &'a Cell<i32>,
    /// Below 0 where a turn could not take place.
    pub(super) remaining: i32,
}

impl Rounds<'_> {
    /// Counts a turn; false where none is left: the loop has to give the cycle back first.
    #[inline(always)]
    pub fn take(&mut self) -> bool {
        // Below 0 the loop ends, so it goes no lower.
        self.remaining = self.remaining.wrapping_sub(1);
        self.remaining >= 0
    }

    /// Counts turns that have taken place without being counted: less than 2^30.
    #[inline(always)]
    pub fn charge(&mut self, rounds: i32) {
        // A subtraction that saturates takes four instructions more. This one cannot wrap: a turn took place, so none
        // is owed.
        self.remaining = self.remaining.wrapping_sub(rounds).max(0);
    }

    /// Whether a turn was to be made and none was left.
    #[inline(always)]
    pub fn are_spent(&self) -> bool {
        self.remaining < 0
    }
}

impl Drop for Rounds<'_> {
    #[inline(always)]
    fn drop(&mut self) {
        self.budget.set(self.remaining);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_loop_that_ends_with_its_last_round_is_not_spent() {
        let budget = Cell::new(2);
        let mut rounds = Rounds { budget: &budget, remaining: 2 };
        assert!(rounds.take() && rounds.take() && !rounds.are_spent());
        assert!(!rounds.take() && rounds.are_spent());
    }

    #[test]
    fn what_others_owe_is_no_round() {
        let budget = Cell::new(-1);
        let mut rounds = Rounds { budget: &budget, remaining: -1 };
        assert!(!rounds.take() && rounds.are_spent());
    }

    #[test]
    fn what_remains_goes_back() {
        let budget = Cell::new(20);
        let mut rounds = Rounds { budget: &budget, remaining: 20 };
        assert!(rounds.take());
        rounds.charge(4);
        drop(rounds);
        assert_eq!(budget.get(), 15);
    }

    #[test]
    fn what_is_charged_does_not_end_a_loop_that_breaks() {
        let budget = Cell::new(20);
        let mut rounds = Rounds { budget: &budget, remaining: 20 };
        assert!(rounds.take());
        rounds.charge(1 << 29);
        assert!(!rounds.are_spent());
        assert!(!rounds.take() && rounds.are_spent());
    }
}
