//! Converts quantities to pixels, and places the ticks.

/// A range that is drawn between two places.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct Scale {
    low: f64,
    start: f64,
    /// px for one unit.
    factor: f64,
}

impl Scale {
    /// `low` is drawn at `start`, `high` at `end` (px).
    pub(super) fn new([low, high]: [f64; 2], start: f64, end: f64) -> Self {
        Self { low, start, factor: (end - start) / (high - low) }
    }

    /// Where a value is drawn.
    pub(super) fn at(&self, value: f64) -> f64 {
        self.start + (value - self.low) * self.factor
    }
}

/// A step of 1, 2 or 5 times a power of ten that fits about `count` times into the range.
pub(super) fn step(range: f64, count: f64) -> f64 {
    let rough = (range / count).max(1e-9);
    let power = libm::exp10(libm::log10(rough).floor());
    let factor = [1.0, 2.0, 5.0].into_iter().find(|factor| factor * power >= rough * 0.999).unwrap_or(10.0);
    factor * power
}

/// The multiples of `step` in a range.
pub(super) fn ticks([low, high]: [f64; 2], step: f64) -> impl Iterator<Item = f64> {
    let first = (low / step - 1e-6).ceil() as i64;
    let last = (high / step + 1e-6).floor() as i64;
    (first..=last).map(move |at| at as f64 * step)
}

/// A tick's number, with as many decimals as its step needs.
pub(super) fn label(value: f64, step: f64) -> String {
    let places = if step >= 1.0 { 0 } else { (-libm::log10(step) - 1e-9).ceil() as usize };
    let text = format!("{value:.places$}");
    if value == 0.0 { text.trim_start_matches('-').to_owned() } else { text }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_are_round() {
        assert_eq!([10.0, 23.0, 0.7, 4000.0].map(|range| step(range, 5.0)), [2.0, 5.0, 0.2, 1000.0]);
        assert_eq!(ticks([-3.0, 7.1], 2.0).collect::<Vec<_>>(), [-2.0, 0.0, 2.0, 4.0, 6.0]);
        assert_eq!([label(200.0, 100.0), label(0.6, 0.2), label(-0.0, 5.0)], ["200", "0.6", "0"]);
    }

    #[test]
    fn scales_may_go_upwards() {
        let scale = Scale::new([0.0, 100.0], 300.0, 100.0);
        assert_eq!([0.0, 50.0, 100.0].map(|value| scale.at(value)), [300.0, 200.0, 100.0]);
    }
}
