//! Chains of short motions.

use std::f64::consts::TAU;

/// A path of points, and how it is moved along.
pub struct Chain {
    /// Its name.
    pub name: &'static str,
    /// The point of each index, in mm from the start, or in deg of the axes; between whole indices the curve that the
    /// points lie on.
    pub point: fn(f64) -> [f64; 3],
    /// Whether the points are of the axes.
    pub axes: bool,
    /// The programmed speed in mm/s, or in percent.
    pub speed: f64,
    /// Whether the points lie on a smooth curve.
    pub smooth: bool,
    /// So many points show what it takes.
    pub enough: usize,
    /// No more points than these: the robot does not reach them, or they take minutes.
    pub most: usize,
}

/// Points on a circle of 100 mm radius, 0.1 mm apart.
fn circle(index: f64) -> [f64; 3] {
    let (sine, cosine) = (index * 0.001).sin_cos();
    [0.0, 100.0 * sine, 100.0 - 100.0 * cosine]
}

/// A line, 0.1 mm a point.
fn line(index: f64) -> [f64; 3] {
    [0.0, index * 0.1, 0.0]
}

/// A spiral from 20 to 150 mm radius.
fn spiral(index: f64) -> [f64; 3] {
    // The way goes with the square of the angle.
    let turns = (index * 0.1 / (TAU * 2.0) + 100.0).sqrt();
    let (sine, cosine) = (turns * TAU).sin_cos();
    let radius = 2.0 * turns;
    [0.0, radius * cosine - 20.0, radius * sine]
}

/// Waves of changing curvature, like a path out of a computer-aided design.
fn waves(index: f64) -> [f64; 3] {
    let at = index * 0.1 / 60.0;
    [20.0 * at.sin(), 120.0 * (at * 0.31).sin(), 40.0 * (at * 0.47).sin()]
}

/// Corners of 90 deg, 10 to 20 mm apart; between whole indices there is nothing.
fn corners(index: f64) -> [f64; 3] {
    let across = if matches!(index as usize % 4, 1 | 2) { 20.0 } else { 0.0 };
    [0.0, (index as usize / 2 * 2 % 32) as f64 * 10.0, across]
}

/// Three axes, each in its own rhythm.
fn axes(index: f64) -> [f64; 3] {
    let at = index * 0.01;
    [30.0 * at.sin(), 10.0 * (at * 0.7).sin(), 20.0 * (1.3 * at).sin()]
}

/// All chains.
pub const CHAINS: [Chain; 6] = [
    Chain { name: "line", point: line, axes: false, speed: 1000.0, smooth: true, enough: 2000, most: 6000 },
    Chain { name: "circle", point: circle, axes: false, speed: 1000.0, smooth: true, enough: 2000, most: usize::MAX },
    Chain { name: "spiral", point: spiral, axes: false, speed: 300.0, smooth: true, enough: 2000, most: usize::MAX },
    Chain { name: "waves", point: waves, axes: false, speed: 500.0, smooth: true, enough: 2000, most: usize::MAX },
    Chain { name: "corners", point: corners, axes: false, speed: 500.0, smooth: false, enough: 120, most: 200 },
    Chain { name: "axes", point: axes, axes: true, speed: 30.0, smooth: true, enough: 600, most: 1000 },
];
