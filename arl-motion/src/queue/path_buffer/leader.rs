//! Who leads the robot along the path: the governor, or a time law.

use crate::time_optimal::law_follower::LawFollower;

/// Who leads the robot.
#[derive(Clone, Debug, Default)]
pub(crate) enum Leader {
    /// The governor.
    #[default]
    Governor,
    /// The governor, up to the next stop, as no law from rest has been found.
    GovernorWithoutLaw,
    /// Time laws.
    Laws(Box<LawFollower>),
    /// A time law that leads to rest sooner than the governor would, which goes on from there.
    ShorterStop(Box<LawFollower>),
}

impl Leader {
    /// Who follows a law.
    pub(crate) fn follower(&self) -> Option<&LawFollower> {
        match self {
            Leader::Governor | Leader::GovernorWithoutLaw => None,
            Leader::Laws(follower) | Leader::ShorterStop(follower) => Some(follower),
        }
    }
}

/// What becomes of segments that are appended.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
pub(crate) enum Appending {
    /// They join the path where its leader can take them.
    #[default]
    Blended,
    /// They come behind a stop.
    BehindStop,
    /// They join a draft of the path, whoever leads. Up to the time that it holds, in s of nominal time since the path
    /// began, nothing has changed.
    Draft(f64),
}
