//! Why a blending zone was not used as it was asked for.

use std::fmt;

use crate::blend::no_blend::NoBlend;

/// Why a zone was not used at all, or only a part of it.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum SmallerZone {
    /// The robot stops at the target, since there is no blend.
    Stop(NoBlend),
    /// It stops there, since no motion followed while it was on its way: the program waits, or ends.
    NothingBehind,
    /// It goes on through the target without a corner, as within a spline.
    Flows,
    /// A part of the zone was used: a zone takes half of a motion at most.
    Half,
    /// A part of the zone was used: this would be with a larger one.
    Part(NoBlend),
    /// The motion did not come to its end.
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
