//! All channels of a controller: the foreground ones by their numbers, then the background ones.

use std::cell::RefCell;
use std::rc::Rc;

use super::channel::Channel;
use super::{Outcome, State};
use crate::cycle::channel_id::ChannelId;
use crate::unit::Unit;

/// All channels of a controller: the foreground ones by their numbers, then the background ones. There is at least one
/// foreground channel.
pub(super) struct Channels {
    first: Channel,
    others: Vec<Channel>,
}

impl Channels {
    pub(super) fn new(first: Channel, others: Vec<Channel>) -> Self {
        Self { first, others }
    }

    /// The first foreground channel.
    pub(super) fn first(&self) -> &Channel {
        &self.first
    }

    /// All channels, in their order.
    pub(super) fn iter(&self) -> impl Iterator<Item = &Channel> {
        std::iter::once(&self.first).chain(&self.others)
    }

    /// The channels with a robot, in their order.
    pub(super) fn foreground(&self) -> impl Iterator<Item = &Channel> {
        self.iter().filter(|channel| matches!(channel.channel_state().id, ChannelId::Foreground(_)))
    }

    /// The foreground channel with this number, from 1.
    pub(super) fn numbered(&self, number: u8) -> Option<&Channel> {
        self.foreground().find(|channel| channel.channel_state().id == ChannelId::Foreground(number))
    }

    /// The robots of the foreground channels, in their order.
    pub(super) fn units(&self) -> impl Iterator<Item = &Rc<RefCell<Unit>>> {
        self.iter().filter_map(|channel| channel.channel_state().shared_unit())
    }

    /// Calls `act` for each channel, in their order.
    #[inline]
    pub(super) fn each(&mut self, mut act: impl FnMut(&mut Channel)) {
        act(&mut self.first);
        self.others.iter_mut().for_each(act);
    }

    /// How the programs ended, once those of all foreground channels have: with the alarm of the first channel that has
    /// one, otherwise as the program of the first channel did.
    pub(super) fn outcome(&self) -> Option<&Outcome> {
        let first = self.first.outcome()?;
        if self.foreground().any(|channel| channel.outcome().is_none()) {
            return None;
        }
        let mut outcomes = self.iter().filter_map(Channel::outcome);
        Some(outcomes.find(|outcome| matches!(outcome, Outcome::Alarm(_))).unwrap_or(first))
    }

    /// What the foreground channels do together: running where one of them runs.
    pub(super) fn state(&self) -> State {
        let states = self.foreground().map(Channel::state);
        states.fold(State::Ended, |all, state| match (all, state) {
            (State::Running, _) | (_, State::Running) => State::Running,
            (State::Paused, _) | (_, State::Paused) => State::Paused,
            (State::Ended, State::Ended) => State::Ended,
        })
    }
}
