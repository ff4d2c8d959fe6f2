//! Reasons why a path cannot be timed.

use std::fmt;

/// The reason why there is no motion along a path.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Refusal {
    /// The path has fewer than two places.
    Short,
    /// A place is not a number or does not come after the one before.
    Place {
        /// Index of the place.
        place: usize,
    },
    /// A row has a derivative that is not a number, or a limit that is not positive.
    Row {
        /// Index of the row's place.
        place: usize,
    },
    /// Nothing moves along the path.
    Still,
    /// A speed or acceleration at the start or the end is not a number, or a speed is negative.
    Boundary,
    /// The start or the end is too fast: no motion within the limits has both speeds.
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
