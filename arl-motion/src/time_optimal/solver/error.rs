//! Why a path cannot be timed.

use std::fmt;

/// Why there is no motion along a path.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Refusal {
    /// Fewer than two places.
    Short,
    /// A place that is not a number or does not come after the one before.
    Place {
        /// Its index.
        place: usize,
    },
    /// A row with a derivative that is not a number, or with a limit that is not positive.
    Row {
        /// The index of its place.
        place: usize,
    },
    /// Nothing moves along the path.
    Still,
    /// A speed or acceleration at the start or the end that is not a number, or a speed below zero.
    Boundary,
    /// The start or the end is too fast: no motion within the limits has them both.
    Fast,
}

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Short => f.write_str("a path has fewer than two points; it needs a start and an end"),
            Self::Place { place } => write!(f, "point {place} of a path does not come after the point before"),
            Self::Row { place } => {
                write!(
                    f,
                    "point {place} of a path has a derivative that is not a number or a limit that is not positive"
                )
            }
            Self::Still => f.write_str("nothing moves along a path; some first derivative must differ from zero"),
            Self::Boundary => f.write_str("the speed at the start or end of a path is not a number, or is below zero"),
            Self::Fast => f.write_str("no motion within the limits joins the speeds at the start and end of a path"),
        }
    }
}

impl std::error::Error for Refusal {}
