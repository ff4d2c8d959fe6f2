//! Length of a cycle.

use std::fmt;
use std::time::Duration;

use arl_robot::Rate;

/// The length of a control cycle: 0.1 ms to 100 ms.
///
/// ```
/// use arl_motion::Cycle;
/// use std::time::Duration;
///
/// let cycle = Cycle::new(Duration::from_millis(4))?;
/// assert_eq!(cycle.period(), 0.004);
/// assert!(Cycle::new(Duration::ZERO).is_err());
/// # Ok::<(), arl_motion::CycleError>(())
/// ```
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Cycle {
    period: f64,
}

impl Cycle {
    /// 1 ms.
    pub const MS: Cycle = Cycle { period: 0.001 };
    /// The shortest cycle.
    pub const SHORTEST: Duration = Duration::from_micros(Rate::SHORTEST as u64);
    /// The longest cycle.
    pub const LONGEST: Duration = Duration::from_micros(Rate::LONGEST as u64);

    /// A cycle of this length.
    ///
    /// # Errors
    /// The length is shorter than [`Cycle::SHORTEST`] or longer than [`Cycle::LONGEST`].
    pub fn new(length: Duration) -> Result<Self, CycleError> {
        if (Self::SHORTEST..=Self::LONGEST).contains(&length) {
            Ok(Self { period: length.as_secs_f64() })
        } else {
            Err(CycleError { length })
        }
    }

    /// The length in s.
    pub const fn period(self) -> f64 {
        self.period
    }

    /// The length as a duration.
    pub fn length(self) -> Duration {
        Duration::from_secs_f64(self.period)
    }
}

/// The cycle of a controller: it has the same range.
impl From<Rate> for Cycle {
    fn from(rate: Rate) -> Self {
        Self { period: rate.period() }
    }
}

/// A length that is too short or too long for a cycle.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[non_exhaustive]
pub struct CycleError {
    /// The requested length.
    pub length: Duration,
}

impl fmt::Display for CycleError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (shortest, longest) = (Cycle::SHORTEST, Cycle::LONGEST);
        write!(f, "a cycle of {:?}: expected {shortest:?} to {longest:?}", self.length)
    }
}

impl std::error::Error for CycleError {}
