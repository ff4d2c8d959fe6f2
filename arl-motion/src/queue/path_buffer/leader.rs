//! What leads the robot along the path: the governor or a time law.

use crate::time_optimal::law_follower::LawFollower;

/// What leads the robot.
#[derive(Clone, Debug, Default)]
pub(crate) enum Leader {
    /// The governor.
    #[default]
    Governor,
    /// The governor, up to the next stop, because no law from rest was found.
    GovernorWithoutLaw,
    /// Time laws.
    Laws(Box<LawFollower>),
    /// A time law that brings the robot to rest sooner than the governor would. The governor continues from there.
    ShorterStop(Box<LawFollower>),
}

impl Leader {
    /// The follower of a law.
    pub(crate) fn follower(&self) -> Option<&LawFollower> {
        match self {
            Leader::Governor | Leader::GovernorWithoutLaw => None,
            Leader::Laws(follower) | Leader::ShorterStop(follower) => Some(follower),
        }
    }
}

/// What becomes of appended segments.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
pub(crate) enum Appending {
    /// They join the path where its leader can follow them.
    #[default]
    Blended,
    /// They are laid behind a stop.
    BehindStop,
    /// They join a draft of the path, whatever the leader. Up to the contained time, in s of nominal time since the
    /// path began, nothing has changed.
    Draft(f64),
}
