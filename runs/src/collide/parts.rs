//! Bodies that robots take along and put down: where they are.

use std::error::Error;

use arl_robot::cell::{Grip, Signal};
use arl_robot::kinematics::Frame;
use parry3d_f64::math::{Pose, Vector};
use parry3d_f64::shape::SharedShape;

use super::arm::of_frame;
use super::item;
use crate::listen::Subscriber;
use crate::scenery::Scenery;
use arl_terminal::failure::Failure;
use arl_wire::{Line, Place, Placing, Runs, State};

/// The bodies with a grip. While its gripper is on and holds nothing, a robot takes the nearest body that its TCP is
/// near to.
#[derive(Clone)]
pub(super) struct Parts {
    pub(super) parts: Vec<Part>,
    /// What each channel runs.
    runs: Vec<Runs>,
}

#[derive(Clone)]
pub(super) struct Part {
    /// Which body of the cell.
    body: usize,
    grip: Grip,
    /// Until it is taken, it is there only while this signal has this level.
    when: Option<(Signal, bool)>,
    /// Its forms, each where it is in the body.
    forms: Vec<(SharedShape, Pose)>,
    place: Place,
    was_taken: bool,
    /// What was last reported of it, if anything was.
    pub(super) reported: Option<Placing>,
}

impl Parts {
    /// The parts of a scenery, if it has any.
    ///
    /// # Errors
    /// A mesh cannot be read.
    pub(super) fn of(scenery: &Scenery) -> Result<Option<Self>, Failure> {
        let mut parts = Vec::new();
        for (number, (body, looks)) in scenery.bodies.iter().enumerate() {
            let Some(grip) = body.grip else { continue };
            let wrong = |problem| Failure::Usage(format!("body `{}`: {problem}", body.name));
            let forms = item::hulls(looks).map_err(wrong)?;
            let place = Place { held_by: None, at: body.at };
            parts.push(Part { body: number, grip, when: body.when, forms, place, was_taken: false, reported: None });
        }
        Ok((!parts.is_empty()).then_some(Self { parts, runs: Vec::new() }))
    }

    /// Handles a state: which parts appear, are taken, and are put down.
    fn state(&mut self, state: &State) -> Vec<Placing> {
        let flanges = self.runs.iter().zip(&state.channels);
        let flanges: Vec<Frame> = flanges.map(|(runs, channel)| runs.flange_in_world(channel)).collect();
        for part in &mut self.parts {
            let flange = part.place.held_by.and_then(|channel| flanges.get(channel));
            if let Some(flange) = flange.filter(|_| !state.has(part.grip.by)) {
                part.place = Place { held_by: None, at: flange * part.place.at };
            }
        }
        let there = self.there(state);
        for (channel, flange) in flanges.iter().enumerate() {
            let tcp = state.channels.get(channel).and_then(|of| <[f64; 3]>::try_from(of.tcp.get(..3)?).ok());
            if let Some(tcp) = tcp {
                self.take(state, channel, Vector::from_array(tcp), flange, &there);
            }
        }
        let there = self.there(state);
        let all = self.parts.iter_mut().zip(there);
        all.filter_map(|(part, there)| {
            let placing = Placing { body: part.body, place: there.then_some(part.place) };
            (part.reported.as_ref() != Some(&placing)).then(|| part.reported.insert(placing).clone())
        })
        .collect()
    }

    /// Which of the parts are there.
    fn there(&self, state: &State) -> Vec<bool> {
        let mut before_was_taken = true;
        let mut is_there = |part: &Part| {
            let came = (before_was_taken || !part.grip.follows) && part.when.is_none_or(|when| state.has(when));
            before_was_taken = part.was_taken;
            part.was_taken || came
        };
        self.parts.iter().map(&mut is_there).collect()
    }

    /// Lets a robot take parts along: the nearest one for each of its grippers that is on and holds nothing.
    fn take(&mut self, state: &State, channel: usize, tcp: Vector, flange: &Frame, there: &[bool]) {
        let held = self.parts.iter().filter(|part| part.place.held_by == Some(channel));
        let mut busy: Vec<_> = held.map(|part| part.grip.by).collect();
        loop {
            let is_free = |part: &Part| {
                let own = part.grip.channel as usize == channel + 1 && part.place.held_by.is_none();
                own && state.has(part.grip.by) && !busy.contains(&part.grip.by)
            };
            let all = self.parts.iter_mut().zip(there).filter(|(part, there)| **there && is_free(part));
            let near = all.map(|(part, _)| (part.distance(tcp), part));
            let near = near.filter(|(distance, part)| *distance <= part.grip.within);
            let Some((_, part)) = near.min_by(|(one, _), (other, _)| one.total_cmp(other)) else { return };
            part.place = Place { held_by: Some(channel), at: flange.inverse() * part.place.at };
            part.was_taken = true;
            busy.push(part.grip.by);
        }
    }
}

impl Part {
    /// The distance of a point of the world from it, in mm; 0 inside it.
    fn distance(&self, place: Vector) -> f64 {
        let here = of_frame(&self.place.at);
        let all = self.forms.iter().map(|(shape, at)| shape.distance_to_point(&(here * *at), place, true));
        all.fold(f64::INFINITY, f64::min)
    }
}

impl Subscriber for Parts {
    fn receive(&mut self, line: &Line) -> Result<Vec<Line>, Box<dyn Error>> {
        match line {
            Line::Hello(hello) => self.runs.clone_from(&hello.channels),
            Line::State(state) => return Ok(self.state(state).into_iter().map(Line::Placing).collect()),
            _ => {}
        }
        Ok(Vec::new())
    }

    fn broken(&self) -> String {
        "bodies stay where they are".into()
    }
}
