//! Reasons why a blending zone was not used as requested.

use std::fmt;

use crate::blend::no_blend::NoBlend;

/// Reason why a zone was not used at all, or only in part.
#[derive(Clone, PartialEq, Eq, Debug)]
#[non_exhaustive]
pub enum SmallerZone {
    /// The robot stops at the target because there is no blend.
    Stop(NoBlend),
    /// The robot stops there because no motion followed while it was on its path: the program waits or ends.
    NothingBehind,
    /// The path continues through the target without a corner, as within a spline.
    Flows,
    /// A part of the zone was used: a zone takes at most half of a motion.
    Half,
    /// A part of the zone was used: this is what a larger one would cause.
    Part(NoBlend),
    /// The motion was not completed.
    Unfinished,
}

impl SmallerZone {
    /// Whether the robot stops at the target.
    pub fn stops(&self) -> bool {
        matches!(self, Self::Stop(_) | Self::NothingBehind)
    }
}

impl fmt::Display for SmallerZone {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Stop(why) => write!(f, "{why}"),
            Self::NothingBehind => write!(f, "no motion followed in time: the program waits or ends there"),
            Self::Flows => write!(f, "the path goes on there without a corner"),
            Self::Half => write!(f, "a zone takes half of a motion at most"),
            Self::Part(NoBlend::Slower) => write!(f, "a larger one would take longer"),
            Self::Part(why) => write!(f, "with a larger one: {why}"),
            Self::Unfinished => write!(f, "the motion was not completed"),
        }
    }
}
