//! Smooth random paths of six axes.

use crate::random::Random;

/// The limits of the six axes in deg/s: those of the built-in robot kr10-r1420.
pub const SPEEDS: [f64; 6] = [220.0, 210.0, 270.0, 381.0, 311.0, 492.0];
/// Acceleration in deg/s2 and jerk in deg/s3 as multiples of the speed.
pub const ACCELERATION: f64 = 5.0;
/// See [`ACCELERATION`].
pub const JERK: f64 = 60.0;

/// Degree of the splines.
const DEGREE: usize = 5;

/// A uniform B-spline of degree 5 with random control points; its parameter goes from 0 to 1.
pub struct Spline {
    points: Vec<[f64; 6]>,
}

impl Spline {
    /// `count` control points, each at most `step` times the axis's speed in deg/s away from the one before.
    pub fn random(seed: u64, count: usize, step: f64) -> Self {
        let mut random = Random::new(seed);
        let mut at = [0.0; 6];
        let points = (0..count.max(DEGREE + 1)).map(|_| {
            for (value, speed) in at.iter_mut().zip(SPEEDS) {
                *value += random.between(-1.0, 1.0) * step * speed;
            }
            at
        });
        Self { points: points.collect() }
    }

    /// The axes in deg at `at` and their first three derivatives by the parameter.
    pub fn jet(&self, at: f64) -> [[f64; 6]; 4] {
        let pieces = self.points.len() - DEGREE;
        let along = at.clamp(0.0, 1.0) * pieces as f64;
        let piece = (along as usize).min(pieces - 1);
        let share = along - piece as f64;
        let mut points = [[0.0; 6]; DEGREE + 1];
        points.copy_from_slice(&self.points[piece..=piece + DEGREE]);
        let mut jet = [[0.0; 6]; 4];
        for (order, values) in jet.iter_mut().enumerate() {
            let basis = basis(DEGREE - order, share);
            let scale = (pieces as f64).powi(order as i32);
            for (point, weight) in points.iter().zip(basis) {
                for (value, part) in values.iter_mut().zip(point) {
                    *value += part * weight * scale;
                }
            }
            // The control points of the next derivative.
            for index in 0..DEGREE - order {
                let next = points[index + 1];
                points[index].iter_mut().zip(next).for_each(|(value, next)| *value = next - *value);
            }
        }
        jet
    }
}

/// The functions of a uniform B-spline that differ from zero, at `share` of a piece.
fn basis(degree: usize, share: f64) -> [f64; DEGREE + 1] {
    let mut values = [0.0; DEGREE + 1];
    values[0] = 1.0;
    for grade in 1..=degree {
        let mut raised = [0.0; DEGREE + 1];
        for index in 0..grade {
            // The function that begins `grade - 1 - index` pieces before this one.
            let rising = (share + (grade - 1 - index) as f64) / grade as f64;
            raised[index] += values[index] * (1.0 - rising);
            raised[index + 1] += values[index] * rising;
        }
        values = raised;
    }
    values
}
