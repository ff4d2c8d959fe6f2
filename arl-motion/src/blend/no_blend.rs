//! Reasons why two motions that should be blended are not.

use std::fmt;

use crate::command::error::PlanError;

/// The reason why the robot stops at a target that should be rounded off.
#[derive(Clone, PartialEq, Eq, Hash, Debug)]
#[non_exhaustive]
pub enum NoBlend {
    /// The next motion came too late.
    Late,
    /// The zone leaves nothing to round off: it is too small compared with one of the motions, or another blend has
    /// taken all of that motion.
    NothingToRound,
    /// The next motion goes back along the path that the robot came on, so that there is nothing to round off.
    Reversal,
    /// One of the two motions moves external axes alone, while the TCP does not move.
    ExternalAlone,
    /// Any blend would take longer than the stop.
    Slower,
    /// Near the target an axis would leave its range, however small the zone.
    AxisLimit {
        /// Name of the axis.
        axis: String,
    },
    /// Near the target the robot would leave its reach, however small the zone.
    Unreachable,
    /// There is a singular point near the target, however small the zone.
    Singular {
        /// The axis that would have to turn infinitely fast, where there is one.
        axis: Option<String>,
    },
    /// On a blend the weave or the compensation would change too much over too short a distance.
    TooDense,
    /// Near the target the robot would arrive in another configuration than that of the next motion.
    Configuration,
}

impl NoBlend {
    /// Converts the error of a path near a target.
    pub(crate) fn from_plan_error(error: PlanError) -> Self {
        match error {
            PlanError::AxisLimit { axis, .. } => NoBlend::AxisLimit { axis },
            PlanError::Singular { axis, .. } | PlanError::Wrist { axis, .. } => NoBlend::Singular { axis: Some(axis) },
            PlanError::TooDense { .. } => NoBlend::TooDense,
            PlanError::TooSharp { .. } => NoBlend::NothingToRound,
            _ => NoBlend::Unreachable,
        }
    }
}

impl fmt::Display for NoBlend {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            NoBlend::Late => write!(f, "the motion after it came too late"),
            NoBlend::NothingToRound => {
                write!(
                    f,
                    "the zone is too small for one of the two motions, or another zone has taken all of that motion"
                )
            }
            NoBlend::Reversal => write!(f, "the next motion goes back along the same path"),
            NoBlend::ExternalAlone => write!(f, "one of the two motions moves external axes alone"),
            NoBlend::Slower => write!(f, "any blend would take longer"),
            NoBlend::AxisLimit { axis } => write!(f, "on a blend {axis} would leave its range"),
            NoBlend::Unreachable => write!(f, "on a blend the robot would leave its reach"),
            NoBlend::Singular { axis: Some(axis) } => {
                write!(f, "close to it is a singular point, where {axis} would have to turn infinitely fast")
            }
            NoBlend::Singular { axis: None } => write!(f, "close to it is a singular point"),
            NoBlend::TooDense => {
                write!(f, "on a blend the weave or the compensation would change too much over too short a distance")
            }
            NoBlend::Configuration => write!(f, "on a blend the robot would change to another configuration"),
        }
    }
}
