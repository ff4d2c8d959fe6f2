//! The speed override.

use std::fmt;

/// The speed override: the share of its speed that a robot uses, 0 to 100 %. At 0 the robot comes to rest on its path.
///
/// ```
/// use arl_motion::Override;
///
/// assert_eq!(Override::from_percent(30.0)?.percent(), 30.0);
/// assert!(Override::from_percent(f64::NAN).is_err());
/// assert_eq!(Override::from_percent(500.0).unwrap_err().to_string(), "the override is 500 %: expected 0 to 100");
/// # Ok::<(), arl_motion::OverrideError>(())
/// ```
#[derive(Clone, Copy, PartialEq, PartialOrd, Debug)]
pub struct Override(f64);

impl Override {
    /// 100 %.
    pub const FULL: Override = Override(100.0);
    /// 0 %: no motion.
    pub const ZERO: Override = Override(0.0);

    /// An override of `percent` percent.
    ///
    /// # Errors
    /// `percent` is not a number from 0 to 100.
    pub fn from_percent(percent: f64) -> Result<Self, OverrideError> {
        if (0.0..=100.0).contains(&percent) { Ok(Self(percent)) } else { Err(OverrideError { percent }) }
    }

    /// The override in percent.
    pub const fn percent(self) -> f64 {
        self.0
    }
}

impl Default for Override {
    fn default() -> Self {
        Self::FULL
    }
}

impl TryFrom<f64> for Override {
    type Error = OverrideError;

    /// See [`Override::from_percent`].
    fn try_from(percent: f64) -> Result<Self, OverrideError> {
        Self::from_percent(percent)
    }
}

/// A value that is not a valid override.
#[derive(Clone, Copy, PartialEq, Debug)]
#[non_exhaustive]
pub struct OverrideError {
    /// The requested value, in percent.
    pub percent: f64,
}

impl fmt::Display for OverrideError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "the override is {} %: expected 0 to 100", self.percent)
    }
}

impl std::error::Error for OverrideError {}
