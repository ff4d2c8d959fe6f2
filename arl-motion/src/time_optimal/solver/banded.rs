//! Symmetric linear equations in which every unknown is coupled only with the next two.

/// A symmetric positive definite matrix with two diagonals beside the main one, by columns: the diagonal element and
/// the two below. After [`Banded::factor`] it contains its factors.
#[derive(Default, Debug)]
pub(crate) struct Banded {
    columns: Vec<[f64; 3]>,
}

impl Banded {
    /// Resets it to a matrix of zeros.
    pub(crate) fn reset(&mut self, size: usize) {
        self.columns.clear();
        self.columns.resize(size, [0.0; 3]);
    }

    /// The columns from `first` on.
    pub(crate) fn from(&mut self, first: usize) -> &mut [[f64; 3]] {
        self.columns.get_mut(first..).unwrap_or_default()
    }

    /// Subtracts from the right hand sides of the other equations what the unknown `index` contributes when it is
    /// `value`.
    pub(crate) fn shift(&self, index: usize, value: f64, sides: &mut [f64]) {
        for beside in 1..=2 {
            if let (Some(column), Some(side)) = (self.columns.get(index), sides.get_mut(index + beside)) {
                *side -= column[beside] * value;
            }
            let before = index.checked_sub(beside);
            let column = before.and_then(|before| self.columns.get(before));
            if let (Some(column), Some(side)) = (column, before.and_then(|before| sides.get_mut(before))) {
                *side -= column[beside] * value;
            }
        }
    }

    /// Makes the unknown `index` zero, whatever the equations.
    pub(crate) fn pin(&mut self, index: usize) {
        for back in 1..=2 {
            if let Some(column) = index.checked_sub(back).and_then(|column| self.columns.get_mut(column)) {
                column[back] = 0.0;
            }
        }
        if let Some(column) = self.columns.get_mut(index) {
            *column = [1.0, 0.0, 0.0];
        }
    }

    /// Factors it into L D L'. A pivot that is too small due to rounding is raised.
    pub(crate) fn factor(&mut self) {
        let (mut one, mut two) = ([0.0; 3], [0.0; 3]);
        for column in &mut self.columns {
            // `one` and `two` are the factored columns one and two before this one.
            let mut pivot = column[0] - one[1] * one[1] * one[0] - two[2] * two[2] * two[0];
            pivot = pivot.max(1e-13 * column[0]).max(f64::MIN_POSITIVE);
            let low = (column[1] - one[1] * one[2] * one[0]) / pivot;
            *column = [pivot, low, column[2] / pivot];
            two = one;
            one = *column;
        }
    }

    /// Solves the factored equations in place.
    pub(crate) fn solve(&self, values: &mut [f64]) {
        let (mut one, mut two) = (0.0, 0.0);
        let (mut by_one, mut by_two) = ([0.0; 3], [0.0; 3]);
        for (value, column) in values.iter_mut().zip(&self.columns) {
            *value -= by_one[1] * one + by_two[2] * two;
            (two, one) = (one, *value);
            (by_two, by_one) = (by_one, *column);
        }
        let (mut one, mut two) = (0.0, 0.0);
        for (value, column) in values.iter_mut().zip(&self.columns).rev() {
            *value = *value / column[0] - column[1] * one - column[2] * two;
            (two, one) = (one, *value);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use arl_robot::kinematics::random::Random;

    #[test]
    fn solutions_fulfil_the_equations() {
        let mut random = Random::new(31);
        for size in 1..12 {
            let mut matrix = Banded::default();
            matrix.reset(size);
            for column in matrix.from(0) {
                *column = [random.between(3.0, 5.0), random.between(-1.0, 1.0), random.between(-1.0, 1.0)];
            }
            let columns = matrix.columns.clone();
            let wanted: Vec<f64> = (0..size).map(|_| random.between(-1.0, 1.0)).collect();
            let mut values = vec![0.0; size];
            for (index, column) in columns.iter().enumerate() {
                values[index] += column[0] * wanted[index];
                for below in [1, 2].into_iter().filter(|below| index + below < size) {
                    values[index + below] += column[below] * wanted[index];
                    values[index] += column[below] * wanted[index + below];
                }
            }
            matrix.factor();
            matrix.solve(&mut values);
            assert!(values.iter().zip(&wanted).all(|(value, wanted)| (value - wanted).abs() < 1e-10));
        }
    }

    #[test]
    fn an_unknown_can_be_given() {
        let mut random = Random::new(32);
        let size = 9;
        for given in 0..size {
            let mut matrix = Banded::default();
            matrix.reset(size);
            for column in matrix.from(0) {
                *column = [random.between(3.0, 5.0), random.between(-1.0, 1.0), random.between(-1.0, 1.0)];
            }
            let columns = matrix.columns.clone();
            let sides: Vec<f64> = (0..size).map(|_| random.between(-1.0, 1.0)).collect();
            let mut values = sides.clone();
            matrix.shift(given, 2.5, &mut values);
            matrix.pin(given);
            values[given] = 2.5;
            matrix.factor();
            matrix.solve(&mut values);
            assert!((values[given] - 2.5).abs() < 1e-12);
            for row in (0..size).filter(|row| *row != given) {
                let own = columns[row][0] * values[row];
                let beside = (1..=2).map(|away| {
                    let below = row.checked_sub(away).map_or(0.0, |column| columns[column][away] * values[column]);
                    below + values.get(row + away).map_or(0.0, |value| columns[row][away] * value)
                });
                assert!((own + beside.sum::<f64>() - sides[row]).abs() < 1e-10, "{given} {row}");
            }
        }
    }
}
