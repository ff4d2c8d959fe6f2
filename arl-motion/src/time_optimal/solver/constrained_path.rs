//! The input of the solver: rows of limits at places along a path.

use std::borrow::Cow;

use crate::time_optimal::solver::{BoundaryState, Refusal};

/// The least time in s that an acceleration takes to rise near rest where jerk is limited at all, and how long this
/// applies.
const RISE_BESIDE_REST_S: f64 = 0.002;
const BESIDE_REST_S: f64 = 0.006;

/// One quantity that moves with the path parameter, at one place: its derivatives by the parameter and its limits.
///
/// A parameter that moves with speed v, acceleration a and jerk j moves the quantity with speed `first` v, acceleration
/// `first` a + `second` v2 and jerk `first` j + 3 `second` v a + `third` v3. Units are the caller's, the same in all
/// rows of one quantity; time is in s.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Row {
    /// First derivative by the path parameter.
    pub first: f64,
    /// Second derivative.
    pub second: f64,
    /// Third derivative.
    pub third: f64,
    /// Highest speed in both directions, per s; finite.
    pub vel: f64,
    /// Highest acceleration in both directions, per s2; infinite where there is no limit.
    pub acc: f64,
    /// Highest jerk in both directions, per s3; infinite where there is no limit.
    pub jerk: f64,
}

impl Row {
    /// Whether all values are valid.
    fn is_sound(&self) -> bool {
        [self.first, self.second, self.third, self.vel].iter().all(|value| value.is_finite())
            && self.vel > 0.0
            && self.acc > 0.0
            && self.jerk > 0.0
    }

    /// The row with its speed limit only.
    pub(crate) fn of_speed(&self) -> Self {
        Self { acc: f64::INFINITY, jerk: f64::INFINITY, ..*self }
    }

    /// Whether the quantity moves here at all.
    pub(crate) fn moves(&self) -> bool {
        self.first != 0.0 || self.second != 0.0 || self.third != 0.0
    }
}

/// A path as places along its parameter, each with the rows that hold there.
///
/// Where a derivative jumps, the place has the rows of both sides. Limits hold at the places, and between them as far
/// as the derivatives change linearly from place to place.
#[derive(Clone, Default, Debug)]
pub struct ConstrainedPath {
    at: Vec<f64>,
    rows: Vec<Row>,
    ends: Vec<usize>,
    /// For each place, the end of the rows that hold before it, and the start of those that hold behind it.
    sides: Vec<[usize; 2]>,
}

impl ConstrainedPath {
    /// Creates a path without places.
    pub fn new() -> Self {
        Self::default()
    }

    /// The number of rows of all places.
    pub(crate) fn row_count(&self) -> usize {
        self.rows.len()
    }

    /// Drops all places and keeps the memory.
    pub fn clear(&mut self) {
        self.at.clear();
        self.rows.clear();
        self.ends.clear();
        self.sides.clear();
    }

    /// Adds the next place, at the path parameter `at`, with its rows.
    pub fn push(&mut self, at: f64, rows: impl IntoIterator<Item = Row>) {
        let start = self.rows.len();
        self.at.push(at);
        self.rows.extend(rows);
        self.ends.push(self.rows.len());
        self.sides.push([self.rows.len(), start]);
    }

    /// Adds the next place, where derivatives jump: with the rows of the side before it, `before` in number, followed
    /// by those of the side behind it.
    pub fn push_jump(&mut self, at: f64, rows: impl IntoIterator<Item = Row>, before: usize) {
        let start = self.rows.len();
        self.push(at, rows);
        if let Some(sides) = self.sides.last_mut() {
            *sides = [start + before; 2];
        }
    }

    /// The rows of the place `index` that hold before it; none past the end.
    pub fn rows_before(&self, index: usize) -> &[Row] {
        let start = if index == 0 { 0 } else { self.ends.get(index - 1).copied().unwrap_or(self.rows.len()) };
        let end = self.sides.get(index).map_or(start, |[end, _]| *end);
        self.rows.get(start..end).unwrap_or_default()
    }

    /// The rows of the place `index` that hold behind it; none past the end.
    pub fn rows_behind(&self, index: usize) -> &[Row] {
        let (start, end) =
            self.sides.get(index).zip(self.ends.get(index)).map_or((0, 0), |([_, start], end)| (*start, *end));
        self.rows.get(start..end).unwrap_or_default()
    }

    /// Whether derivatives jump at the place `index`.
    pub(crate) fn jumps(&self, index: usize) -> bool {
        self.rows_before(index).len() < self.rows(index).len()
    }

    /// Passes all numbers that define it to `note`.
    pub(crate) fn numbers(&self, note: &mut impl FnMut(u64)) {
        let Self { at, rows, ends, sides } = self;
        note(at.len() as u64);
        at.iter().for_each(|at| note(at.to_bits()));
        ends.iter().chain(sides.iter().flatten()).for_each(|index| note(*index as u64));
        for Row { first, second, third, vel, acc, jerk } in rows {
            [first, second, third, vel, acc, jerk].into_iter().for_each(|number| note(number.to_bits()));
        }
    }

    /// The path parameters of the places.
    pub fn places(&self) -> &[f64] {
        &self.at
    }

    /// The rows of the place `index`; none past the end.
    pub fn rows(&self, index: usize) -> &[Row] {
        let start = if index == 0 { 0 } else { self.ends.get(index - 1).copied().unwrap_or(self.rows.len()) };
        let end = self.ends.get(index).copied().unwrap_or(start);
        self.rows.get(start..end).unwrap_or_default()
    }

    /// The path with acceleration and jerk limits times `stop_scale`.
    #[must_use]
    pub fn hardened(&self, stop_scale: f64) -> Self {
        let mut path = self.clone();
        for row in &mut path.rows {
            (row.acc, row.jerk) = (row.acc * stop_scale, row.jerk * stop_scale);
        }
        path
    }

    /// Lowers limits that a motion uses too much of. `used` contains stretches from one parameter to another with the
    /// share that is used there; the limits at their places and at the adjacent places are lowered so that `most` of
    /// them would be used. The first place is not changed: the state there is given.
    pub fn lower(&mut self, used: &[([f64; 2], f64)], most: f64) {
        let mut factors = vec![1.0_f64; self.at.len()];
        for ([from, to], share) in used {
            let first = self.at.partition_point(|at| at < from).saturating_sub(1).max(1);
            let behind = self.at.partition_point(|at| at <= to) + 1;
            for factor in factors.get_mut(first..behind.min(self.at.len())).unwrap_or_default() {
                *factor = factor.min(most / share);
            }
        }
        let mut start = 0;
        for (factor, end) in factors.iter().zip(&self.ends) {
            for row in self.rows.get_mut(start..*end).unwrap_or_default() {
                (row.vel, row.acc, row.jerk) = (row.vel * factor, row.acc * factor, row.jerk * factor);
            }
            start = *end;
        }
    }

    /// The path as it is timed with jerk limits: none of its accelerations rises at once near rest. The square of the
    /// warped parameter's speed would have a pole there.
    pub(crate) fn rising_beside_rest(&self, edges: [BoundaryState; 2]) -> Cow<'_, Self> {
        let mut path = Cow::Borrowed(self);
        let last = self.at.len().saturating_sub(1);
        for (index, edge) in [0, last].into_iter().zip(edges) {
            let Some(rest) = self.at.get(index).filter(|_| edge.rests()) else { continue };
            let least = |of: fn(&Row) -> f64| {
                self.rows(index).iter().map(|row| of(row) / row.first.abs()).fold(f64::INFINITY, f64::min)
            };
            let (acc, jerk) = (least(|row| row.acc), least(|row| row.jerk));
            if !acc.is_finite() || jerk * RISE_BESIDE_REST_S <= acc {
                continue;
            }
            let near = 0.5 * acc * BESIDE_REST_S * BESIDE_REST_S;
            let from = self.at.partition_point(|at| *at < rest - near);
            let behind = self.at.partition_point(|at| *at <= rest + near);
            let start = from.checked_sub(1).and_then(|before| self.ends.get(before)).copied().unwrap_or_default();
            let end = behind.checked_sub(1).and_then(|last| self.ends.get(last)).copied().unwrap_or_default();
            for row in path.to_mut().rows.get_mut(start..end).unwrap_or_default() {
                row.jerk = row.jerk.min(row.acc / RISE_BESIDE_REST_S);
            }
        }
        path
    }

    /// The path with only those places that are to be kept.
    pub(crate) fn only(&self, keep: &[bool]) -> Self {
        let mut kept = Self::new();
        for (index, (at, _)) in self.at.iter().zip(keep).enumerate().filter(|(_, (_, keep))| **keep) {
            let before = self.rows_before(index).len();
            let rows = self.rows(index);
            if before < rows.len() {
                kept.push_jump(*at, rows.iter().copied(), before);
            } else {
                kept.push(*at, rows.iter().copied());
            }
        }
        kept
    }

    /// The first and the last path parameter.
    pub(crate) fn span(&self) -> Result<(f64, f64), Refusal> {
        match self.at.as_slice() {
            [first, .., last] => Ok((*first, *last)),
            _ => Err(Refusal::Short),
        }
    }

    /// Whether any row limits the jerk.
    pub(crate) fn limits_jerk(&self) -> bool {
        self.rows.iter().any(|row| row.jerk.is_finite() && row.moves())
    }

    /// Refuses a path that cannot be timed.
    pub(crate) fn check(&self) -> Result<(), Refusal> {
        self.span()?;
        if let Some(place) = self.at.iter().position(|at| !at.is_finite()) {
            return Err(Refusal::Place { place });
        }
        if let Some(place) = self.at.windows(2).position(|pair| pair[1] <= pair[0]) {
            return Err(Refusal::Place { place: place + 1 });
        }
        if let Some(row) = self.rows.iter().position(|row| !row.is_sound()) {
            let place = self.ends.iter().position(|end| row < *end).unwrap_or_default();
            return Err(Refusal::Row { place });
        }
        if self.rows.iter().all(|row| row.first == 0.0) {
            return Err(Refusal::Still);
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_are_lowered_beside_a_stretch_but_not_at_the_first_place() {
        let mut path = ConstrainedPath::new();
        for at in 0..6 {
            path.push(f64::from(at), [Row { first: 1.0, second: 0.0, third: 0.0, vel: 1.0, acc: 1.0, jerk: 1.0 }]);
        }
        let jerks = |path: &ConstrainedPath| (0..6).map(|index| path.rows(index)[0].jerk).collect::<Vec<f64>>();
        path.lower(&[([2.5, 2.5], 2.0)], 1.0);
        assert_eq!(jerks(&path), [1.0, 1.0, 0.5, 0.5, 1.0, 1.0]);
        path.lower(&[([0.2, 0.3], 2.0)], 1.0);
        assert_eq!(jerks(&path), [1.0, 0.5, 0.5, 0.5, 1.0, 1.0]);
        path.lower(&[([4.0, 5.0], 2.0)], 1.0);
        assert_eq!(jerks(&path), [1.0, 0.5, 0.5, 0.25, 0.5, 0.5]);
        path.lower(&[([9.0, 9.0], 2.0)], 1.0);
        assert_eq!(jerks(&path), [1.0, 0.5, 0.5, 0.25, 0.5, 0.25]);
    }

    #[test]
    fn a_place_has_the_rows_of_both_sides() {
        let row = |first: f64| Row { first, second: 0.0, third: 0.0, vel: 1.0, acc: 1.0, jerk: 1.0 };
        let mut path = ConstrainedPath::new();
        path.push(0.0, [row(1.0)]);
        path.push_jump(1.0, [row(2.0), row(3.0), row(4.0)], 1);
        path.push(2.0, [row(5.0), row(6.0)]);
        let firsts = |rows: &[Row]| rows.iter().map(|row| row.first).collect::<Vec<f64>>();
        let sides = |index: usize| [path.rows_before(index), path.rows(index), path.rows_behind(index)].map(firsts);
        assert_eq!(sides(0), [vec![1.0], vec![1.0], vec![1.0]]);
        assert_eq!(sides(1), [vec![2.0], vec![2.0, 3.0, 4.0], vec![3.0, 4.0]]);
        assert_eq!(sides(2), [vec![5.0, 6.0], vec![5.0, 6.0], vec![5.0, 6.0]]);
        assert_eq!(sides(3), [vec![], vec![], vec![]]);
    }
}
