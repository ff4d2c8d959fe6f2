//! The frames of parts that robots take along, in the world: readers of frames need not know which robot holds a part.

use std::collections::BTreeMap;

use arl_robot::kinematics::Frame;

use super::links::{WORLD, transform};
use super::messages::{FrameTransform, Timestamp};
use crate::scenery::Scenery;
use arl_wire::{Channel, Place, Placing, Runs};

/// Where parts are.
#[derive(Default)]
pub(super) struct RecordedParts {
    /// The parts that robots hold, by their numbers, with the names of their frames.
    held: BTreeMap<usize, (String, Place)>,
    /// Whether there are any parts.
    are_there: bool,
    /// What each channel runs.
    runs: Vec<Runs>,
    /// The flanges of the channels' robots in the world.
    flanges: Vec<Frame>,
}

impl RecordedParts {
    /// The parts of a scenery.
    pub(super) fn of(scenery: &Scenery) -> Self {
        let are_there = scenery.bodies.iter().any(|(body, _)| body.grip.is_some());
        Self { are_there, ..Self::default() }
    }

    /// Notes what runs on which robots ...
    pub(super) fn begin(&mut self, runs: &[Runs]) {
        if self.are_there {
            runs.clone_into(&mut self.runs);
        }
    }

    /// ... and where the robots are.
    pub(super) fn robots_are(&mut self, channels: &[Channel]) {
        self.flanges.clear();
        self.flanges.extend(self.runs.iter().zip(channels).map(|(runs, channel)| runs.flange_in_world(channel)));
    }

    /// Notes that a part is elsewhere; returns its place, if it is anywhere.
    pub(super) fn place(&mut self, placing: &Placing, frame: String, now: Timestamp) -> Option<FrameTransform> {
        self.held.remove(&placing.body);
        let place = placing.place?;
        let transform = self.transform_of(&frame, place, now);
        if place.held_by.is_some() {
            self.held.insert(placing.body, (frame, place));
        }
        Some(transform)
    }

    /// The parts that move along with a robot.
    pub(super) fn held(&self, now: Timestamp) -> impl Iterator<Item = FrameTransform> {
        self.held.values().map(move |(frame, place)| self.transform_of(frame, *place, now))
    }

    fn transform_of(&self, frame: &str, Place { held_by, at }: Place, now: Timestamp) -> FrameTransform {
        let flange = held_by.and_then(|channel| self.flanges.get(channel));
        let world = flange.map_or(at, |flange| flange * at);
        transform(now, WORLD.to_owned(), frame.to_owned(), &world)
    }
}
