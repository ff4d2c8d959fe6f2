//! Random bytes for tests of code that reads bytes from outside.

// In tests only: the generator that programs use.
// up: a helper of tests only
use crate::context::random::Random;

/// A reproducible pseudo-random sequence.
pub(crate) struct Noise(Random);

impl Noise {
    /// The sequence of a seed.
    pub(crate) fn new(seed: u64) -> Self {
        Self(Random::new(seed))
    }

    /// A number below `end`.
    pub(crate) fn below(&mut self, end: usize) -> usize {
        self.0.next() as usize % end.max(1)
    }

    /// Up to `most` bytes; small numbers more often than large ones.
    pub(crate) fn bytes(&mut self, most: usize) -> Vec<u8> {
        let len = self.below(most + 1);
        (0..len)
            .map(|_| {
                let wide = self.below(3) == 0;
                self.below(if wide { 256 } else { 8 }) as u8
            })
            .collect()
    }
}
