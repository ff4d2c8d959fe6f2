//! The numbers of channels.

use std::fmt;

pub(crate) use arl_robot::cell::MOST_FOREGROUND;

/// The number of a channel of a controller. Both kinds count from 1.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub enum ChannelId {
    /// A channel with a robot, 1 to 6.
    Foreground(u8),
    /// A channel without a robot.
    Background(u8),
}

impl ChannelId {
    /// The first foreground channel: the only one of most controllers.
    pub const FIRST: Self = ChannelId::Foreground(1);
}

impl Default for ChannelId {
    fn default() -> Self {
        Self::FIRST
    }
}

impl fmt::Display for ChannelId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            ChannelId::Foreground(number) => write!(f, "channel {number}"),
            ChannelId::Background(number) => write!(f, "background channel {number}"),
        }
    }
}
