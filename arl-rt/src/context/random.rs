//! The random numbers of programs, the same in every run.

use std::cell::Cell;

/// The default seed.
pub(crate) const SEED: u64 = 1;

/// A sequence of random numbers: SplitMix64.
#[derive(Debug)]
pub(crate) struct Random(Cell<u64>);

impl Random {
    pub(crate) fn new(seed: u64) -> Self {
        Self(Cell::new(seed))
    }

    /// A number from 0 to 2147483647.
    pub(crate) fn next(&self) -> i32 {
        let state = self.0.get().wrapping_add(0x9e37_79b9_7f4a_7c15);
        self.0.set(state);
        let mixed = (state ^ (state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((mixed ^ (mixed >> 31)) >> 33) as i32
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_seed_gives_one_row() {
        let row = |seed| {
            let random = Random::new(seed);
            std::array::from_fn::<i32, 1000, _>(|_| random.next())
        };
        assert_eq!(row(7), row(7));
        assert_ne!(row(7), row(8));
        assert!(row(7).iter().all(|number| *number >= 0));
        let mean = row(7).iter().map(|number| f64::from(*number)).sum::<f64>() / 1000.0;
        assert!((mean / f64::from(i32::MAX) - 0.5).abs() < 0.05, "{mean}");
    }
}
