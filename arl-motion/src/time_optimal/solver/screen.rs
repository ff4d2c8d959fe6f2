//! Selects the limits that may matter.
//!
//! At any place, a few of the rows are stricter than all others. Leaving out the others makes the problem several times
//! smaller; the solution is then reviewed against all of them. Ranges of rows are those between the ends of two places.

use crate::time_optimal::solver::warped_row::WarpedRow;

/// Whether a row's limits count upwards and downwards.
#[derive(Clone, Copy, Default, Debug)]
pub(crate) struct CountingLimits {
    pub(crate) acc: [bool; 2],
    pub(crate) jerk: [bool; 2],
}

/// All rows, and which of their limits are kept.
#[derive(Debug)]
pub(crate) struct Screen {
    rows: Vec<WarpedRow>,
    kept: Vec<CountingLimits>,
    /// Where the rows of each place begin and end.
    ends: Vec<usize>,
    /// The lowest of the speed limits that count.
    least: f64,
}

/// Shares of the highest x at which the limits are compared.
const SHARES: [f64; 4] = [0.03, 0.3, 0.65, 1.0];
/// Shares of the known approximate x at which the limits are compared.
const SHARES_OF_KNOWN: [f64; 2] = [0.7, 1.0];
/// The range of motions around an even speed for which limits are compared.
const ANY: Doubt = Doubt { slopes: 1.0, rest: 0.7 };
const ABOUT_EVEN: Doubt = Doubt { slopes: 0.3, rest: 0.9 };
/// The excess of a limit that was left out, as a factor, above which it is added.
const EXCESS: f64 = 1.002;

/// How uncertain the motion at a place is.
#[derive(Clone, Copy)]
struct Doubt {
    /// The share of the possible accelerations that the motion may have.
    slopes: f64,
    /// The used share of a jerk limit without a bend from which the limit counts.
    rest: f64,
}

impl Screen {
    /// Creates a screen from the rows, the start of the rows of each place, and the highest possible x of each place;
    /// or from the approximate x everywhere, where that is known.
    pub(crate) fn new(
        rows: Vec<WarpedRow>,
        ends: Vec<usize>,
        most: impl Iterator<Item = f64>,
        known: Option<f64>,
    ) -> Self {
        let mut kept = vec![CountingLimits::default(); rows.len()];
        for (range, most) in ends.windows(2).zip(most) {
            let (rows, kept) = (&rows[range[0]..range[1]], &mut kept[range[0]..range[1]]);
            if let Some(known) = known {
                SHARES_OF_KNOWN.iter().for_each(|share| compare(rows, kept, share * known, ABOUT_EVEN));
                continue;
            }
            // Close to rest, nothing else may limit x.
            let by_jerk = highest_square(rows.iter().map(|row| row.jerk[2]));
            let most = if most.is_finite() { most } else { by_jerk.min(1e6) };
            for share in SHARES {
                compare(rows, kept, share * most, ANY);
            }
        }
        let least = rows.iter().map(|row| row.vel).filter(|vel| *vel > 0.0).fold(f64::INFINITY, f64::min);
        Self { rows, kept, ends, least }
    }

    fn range(&self, place: usize) -> std::ops::Range<usize> {
        let at = |index: usize| self.ends.get(index).copied().unwrap_or(self.rows.len());
        at(place)..at(place + 1)
    }

    /// The rows of a place.
    pub(crate) fn rows(&self, place: usize) -> impl Iterator<Item = (&WarpedRow, &CountingLimits)> {
        let range = self.range(place);
        self.rows[range.clone()].iter().zip(&self.kept[range])
    }

    /// The strictest speed limit of a place, as a factor of x: where nothing moves at the place, the speed is still not
    /// higher than anywhere else.
    pub(crate) fn speed(&self, place: usize) -> f64 {
        self.rows[self.range(place)].iter().map(|row| row.vel).fold(self.least, f64::max)
    }

    /// The largest share of its limits that a place uses with x, the acceleration and the bend. Limits that are
    /// exceeded and were left out are kept from now on; the second value is whether there were any.
    pub(crate) fn review(&mut self, place: usize, square: f64, slope: f64, bend: f64) -> (f64, bool) {
        let (mut used, mut added) = (self.speed(place) * square, false);
        let root = square.max(0.0).sqrt();
        let range = self.range(place);
        for (row, kept) in self.rows[range.clone()].iter().zip(&mut self.kept[range]) {
            let acc = row.acc[0] * slope + row.acc[1] * square;
            let jerk = (row.jerk[0] * bend + row.jerk[1] * slope + row.jerk[2] * square) * root;
            for (value, kept) in [(acc, &mut kept.acc), (jerk, &mut kept.jerk)] {
                used = used.max(value.abs());
                if value.abs() > EXCESS {
                    let kept = &mut kept[usize::from(value < 0.0)];
                    added |= !*kept;
                    *kept = true;
                }
            }
        }
        (used, added)
    }
}

/// The highest x at which no jerk exceeds 1 at an even speed, with these factors of x.
pub(crate) fn highest_square(jerks: impl Iterator<Item = f64>) -> f64 {
    let most = jerks.map(f64::abs).fold(0.0, f64::max);
    1.0 / libm::cbrt(most * most)
}

/// Keeps the limits that bound the acceleration at x, and those that bound the bend at some accelerations.
fn compare(rows: &[WarpedRow], kept: &mut [CountingLimits], square: f64, doubt: Doubt) {
    let (mut low, mut high) = ((f64::NEG_INFINITY, 0, 0), (f64::INFINITY, 0, 0));
    for (index, row) in rows.iter().enumerate() {
        narrow(row.acc[0], row.acc[1] * square, 1.0, index, &mut low, &mut high);
    }
    for (bound, index, sign) in [low, high] {
        if bound.is_finite() {
            kept[index].acc[sign] = true;
        }
    }
    let most = 1.0 / square.sqrt();
    for slope in [doubt.slopes * low.0, 0.0, doubt.slopes * high.0] {
        if !slope.is_finite() {
            continue;
        }
        let (mut low, mut high) = ((f64::NEG_INFINITY, 0, 0), (f64::INFINITY, 0, 0));
        for (index, row) in rows.iter().enumerate() {
            let rest = row.jerk[1] * slope + row.jerk[2] * square;
            narrow(row.jerk[0], rest, most, index, &mut low, &mut high);
            // Where the bend hardly matters.
            if rest.abs() > doubt.rest * most {
                kept[index].jerk[usize::from(rest < 0.0)] = true;
            }
        }
        for (bound, index, sign) in [low, high] {
            if bound.is_finite() {
                kept[index].jerk[sign] = true;
            }
        }
    }
}

/// A bound with the row and the sign that define it.
type Bound = (f64, usize, usize);

/// Narrows the bounds of y by |`rate` y + `rest`| <= `most`.
fn narrow(rate: f64, rest: f64, most: f64, index: usize, low: &mut Bound, high: &mut Bound) {
    if rate == 0.0 {
        return;
    }
    let (up, down) = ((most - rest) / rate, (-most - rest) / rate);
    let ((above, above_sign), (below, below_sign)) =
        if rate > 0.0 { ((up, 0), (down, 1)) } else { ((down, 1), (up, 0)) };
    if above < high.0 {
        *high = (above, index, above_sign);
    }
    if below > low.0 {
        *low = (below, index, below_sign);
    }
}
