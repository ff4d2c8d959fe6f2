//! Time that is summed over days.

/// A sum of cycle times in s. The rounding error of each addition is added with the next one: after a hundred hours
/// nothing is lost, where plain sums are off by milliseconds.
#[derive(Clone, Copy, PartialEq, Default, Debug)]
pub(crate) struct Elapsed {
    sum: f64,
    rest: f64,
}

impl Elapsed {
    /// Adds a time in s.
    pub(crate) fn add(&mut self, seconds: f64) {
        let with_rest = seconds + self.rest;
        let sum = self.sum + with_rest;
        self.rest = with_rest - (sum - self.sum);
        self.sum = sum;
    }

    /// The sum in s.
    pub(crate) fn seconds(self) -> f64 {
        self.sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hours_of_cycles_add_up_to_hours() {
        let (mut elapsed, mut plain) = (Elapsed::default(), 0.0);
        for _ in 0..36_000_000 {
            elapsed.add(0.001);
            plain += 0.001;
        }
        assert!((elapsed.seconds() - 36_000.0).abs() < 1e-10, "{elapsed:?}");
        assert!((plain - 36_000.0_f64).abs() > 1e-6, "it is worth its while: {plain}");
    }
}
