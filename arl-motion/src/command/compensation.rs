//! Compensations as requested.

/// The frame along and about whose axes a compensation acts.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Reference {
    /// The tool frame.
    Tool,
    /// The workpiece frame of the motion.
    Wobj,
    /// x along the path, y across x and the tool's z axis, z across both.
    ToolPath,
    /// Like `ToolPath`, but y keeps its side where the path turns back. It does not turn the tool.
    ModifyPath,
    /// The world frame.
    World,
}

/// Number of frames.
const REFERENCES: usize = 5;

/// The compensation of planned motions: initially none.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Compensation {
    /// Running number: a motion continues from the shift of the one before it only within the same compensation.
    pub number: u32,
    /// Limits of its growth: mm/s, mm/s2, mm/s3, deg/s, deg/s2, deg/s3; each above 0.
    pub limits: [f64; 6],
    totals: [[f64; 6]; REFERENCES],
}

impl Compensation {
    /// A compensation that is zero so far.
    pub fn new(number: u32, limits: [f64; 6]) -> Self {
        Self { number, limits, totals: [[0.0; 6]; REFERENCES] }
    }

    /// Adds to the compensation in a frame: x, y, z in mm, a, b, c in deg.
    pub fn add(&mut self, reference: Reference, by: &[f64; 6]) {
        if let Some(total) = self.totals.get_mut(reference as usize) {
            for (total, by) in total.iter_mut().zip(by) {
                *total += by;
            }
        }
    }

    /// The total compensation in a frame: x, y, z in mm, a, b, c in deg.
    pub fn total(&self, reference: Reference) -> [f64; 6] {
        self.totals.get(reference as usize).copied().unwrap_or_default()
    }

    /// All components of the compensation, in all frames.
    pub(crate) fn all(&self) -> impl Iterator<Item = f64> {
        self.totals.iter().flatten().copied()
    }

    /// Whether it needs the direction of the path.
    pub(crate) fn follows_path(&self) -> bool {
        [Reference::ToolPath, Reference::ModifyPath].iter().any(|reference| self.total(*reference) != [0.0; 6])
    }
}
