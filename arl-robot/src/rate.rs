//! The length of a control cycle, and the conversion of seconds into cycles.

/// The longest wait in cycles: longer than any program runs.
const MAX_WAIT_CYCLES: f64 = 9e15;

/// The length of the control cycle. It is a whole number of microseconds, so that times stay exact.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Rate {
    micros: u32,
}

impl Rate {
    /// The shortest cycle, in microseconds.
    pub const SHORTEST: u32 = 100;
    /// The longest cycle, in microseconds.
    pub const LONGEST: u32 = 100_000;

    /// A cycle of `micros` microseconds, clamped to the range [`Rate::SHORTEST`] to [`Rate::LONGEST`].
    pub fn from_micros(micros: u32) -> Self {
        Self { micros: micros.clamp(Self::SHORTEST, Self::LONGEST) }
    }

    /// The length in microseconds.
    pub fn micros(self) -> u32 {
        self.micros
    }

    /// The length in seconds.
    #[inline]
    pub fn period(self) -> f64 {
        f64::from(self.micros) / 1e6
    }

    /// The time at the start of a cycle, in seconds.
    #[inline]
    pub fn time(self, cycle: u64) -> f64 {
        // A product of integers first: 3000 cycles of 1 ms are exactly 3 s.
        (cycle as f64 * f64::from(self.micros)) / 1e6
    }

    /// The number of cycles until `seconds` have passed: 0 for 0, at least 1 for any longer time.
    pub fn cycles(self, seconds: f64) -> u64 {
        // A slack of a thousandth of a cycle, so that 0.003 s are three cycles of 1 ms, whatever the last bit.
        let cycles = (seconds * 1e6 / f64::from(self.micros) - 1e-3).ceil();
        if cycles >= 1.0 {
            cycles.min(MAX_WAIT_CYCLES) as u64
        } else if seconds > 0.0 {
            1
        } else {
            0
        }
    }
}

impl Default for Rate {
    fn default() -> Self {
        Self { micros: 1000 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn seconds_become_whole_cycles() {
        let rate = Rate::default();
        for (seconds, cycles) in
            [(0.0, 0), (1e-9, 1), (0.001, 1), (0.003, 3), (0.0301, 31), (3.0, 3000), (1e300, 9_000_000_000_000_000)]
        {
            assert_eq!(rate.cycles(seconds), cycles, "{seconds}");
        }
        for cycles in 0..100_000 {
            assert_eq!(rate.cycles(rate.time(cycles)), cycles);
            assert_eq!(Rate::from_micros(250).cycles(Rate::from_micros(250).time(cycles)), cycles);
        }
        assert_eq!(rate.time(3000), 3.0);
    }
}
