//! Collisions of a run: each cycle, robots with themselves, with each other, with the bodies of the cell and what they carry.
//!
//! The first contact of each pair is told with the time and the line of the motion. With a clearance, so is the nearest that a pair comes to
//! each other, where that is nearer.

mod arm;
mod check;
mod item;
mod mesh;
mod pair;
#[cfg(test)]
mod tests;

use std::cell::RefCell;
use std::error::Error;
use std::rc::Rc;

use arl_robot::cell::{Body, Cell, Signal, SignalKind};
use parry3d_f64::math::Pose;

use super::failure::Failure;
use super::listen::Hears;
use super::said::{Contact, Cycle, Hello, Line, State};
use super::show;
use arm::Arm;
pub(super) use check::{Look, check};
use item::{Holder, Item};
use pair::{Pair, State as PairState};

/// What was found, for who asked for it: contacts in the order of their times.
pub(super) type Found = Rc<RefCell<Vec<Contact>>>;

/// Watches where robots and bodies are.
pub(super) struct Collisions {
    bodies: Vec<Item>,
    /// mm; 0: contacts only.
    clearance: f64,
    arms: Vec<Option<Arm>>,
    items: Vec<Item>,
    pairs: Vec<Pair>,
    /// The file of the motion of each channel.
    files: Vec<String>,
    /// The levels of inputs and outputs.
    levels: [String; 2],
    found: Found,
    /// Whether contacts are told as they come.
    tells: bool,
}

impl Collisions {
    /// For the bodies of a cell. A mesh that cannot be read is an error.
    pub(super) fn new(cell: &Cell, clearance: f64, tells: bool) -> Result<(Self, Found), Failure> {
        let bodies = cell.bodies.iter().map(item_of).collect::<Result<Vec<Item>, Failure>>()?;
        let found = Found::default();
        let collisions = Self {
            bodies,
            clearance,
            arms: Vec::new(),
            items: Vec::new(),
            pairs: Vec::new(),
            files: Vec::new(),
            levels: Default::default(),
            found: Rc::clone(&found),
            tells,
        };
        Ok((collisions, found))
    }

    fn begin(&mut self, hello: &Hello) -> Result<(), String> {
        let several = hello.channels.iter().filter(|runs| !runs.links.is_empty()).count() > 1;
        self.arms = hello.channels.iter().map(|runs| (!runs.links.is_empty()).then(|| Arm::new(runs))).collect();
        self.files = vec![String::new(); hello.channels.len()];
        self.items.clear();
        for (channel, runs) in hello.channels.iter().enumerate() {
            self.items.extend(item::limbs(channel, runs, several));
        }
        for body in &self.bodies {
            if let Holder::Flange { channel } = body.holder
                && self.arms.get(channel).is_none_or(Option::is_none)
            {
                return Err(format!("`{}` is on the flange of channel {}, which has no robot", body.name, channel + 1));
            }
        }
        self.items.extend(self.bodies.iter().cloned());
        self.pairs = pair::pairs(&self.items, &self.arms);
        Ok(())
    }

    fn state(&mut self, state: &State) {
        self.levels = [state.di.clone(), state.dout.clone()];
        for (at, channel) in state.channels.iter().enumerate() {
            if let Some(file) = self.files.get_mut(at) {
                file.clone_from(&channel.motion_file);
            }
            if let Some(Some(arm)) = self.arms.get_mut(at)
                && arm.stands_on(&channel.base)
            {
                self.pairs.iter_mut().for_each(Pair::forget);
            }
        }
    }

    /// Looks at all pairs that may have come near enough to each other to matter.
    fn cycle(&mut self, cycle: &Cycle) -> Vec<Contact> {
        for (arm, moves) in self.arms.iter_mut().zip(&cycle.channels) {
            if let Some(arm) = arm {
                arm.go_to(&moves.axes);
            }
        }
        let mut contacts = Vec::new();
        for pair in &mut self.pairs {
            let [Some(one), Some(other)] = pair.items.map(|at| self.items.get(at)) else { continue };
            if !(is_there(one, &self.levels) && is_there(other, &self.levels)) {
                pair.forget();
                continue;
            }
            if !pair.is_due(&self.arms) {
                continue;
            }
            let [Some(here), Some(there)] = [one, other].map(|item| place(item, &self.arms)) else { continue };
            // Both are of forms that the library knows.
            let Ok(distance) = parry3d_f64::query::distance(&here, &*one.shape, &there, &*other.shape) else {
                continue;
            };
            let channel = [one, other].iter().find_map(|item| item.holder.channel()).unwrap_or_default();
            let line = cycle.channels.get(channel).map_or(0, |moves| moves.line);
            let contact = |distance| Contact {
                time: cycle.time,
                file: self.files.get(channel).cloned().unwrap_or_default(),
                line,
                one: one.name.clone(),
                other: other.name.clone(),
                distance,
            };
            pair.note(distance.distance, self.clearance, &self.arms, contact);
            if let PairState::Touched(contact) = &mut pair.state
                && let Some(contact) = contact.take()
            {
                contacts.push(contact);
            }
        }
        contacts
    }

    fn tell(&self, contact: &Contact) {
        if self.tells {
            show::warning(&contact.to_string());
        }
        self.found.borrow_mut().push(contact.clone());
    }
}

impl Hears for Collisions {
    fn wants_each_cycle(&self) -> bool {
        true
    }

    fn hear(&mut self, line: &Line) -> Result<Vec<Line>, Box<dyn Error>> {
        match line {
            Line::Hello(hello) => self.begin(hello)?,
            Line::State(state) => self.state(state),
            Line::Cycle(cycle) => {
                let contacts = self.cycle(cycle);
                contacts.iter().for_each(|contact| self.tell(contact));
                return Ok(contacts.into_iter().map(Line::Contact).collect());
            }
            // The run has ended: reports come last.
            Line::Report(_) => return Ok(self.nearest().into_iter().map(Line::Contact).collect()),
            _ => {}
        }
        Ok(Vec::new())
    }

    fn end(mut self: Box<Self>) -> Result<(), Box<dyn Error>> {
        self.nearest();
        Ok(())
    }

    fn broken(&self) -> String {
        "collisions are not looked for".into()
    }
}

impl Collisions {
    /// The nearest that each pair came to each other, of those nearer than the clearance that did not touch; once.
    fn nearest(&mut self) -> Vec<Contact> {
        let near: Vec<Contact> = self.pairs.iter_mut().filter_map(Pair::take_nearest).collect();
        near.iter().for_each(|contact| self.tell(contact));
        near
    }
}

/// Where an item is in the world.
fn place(item: &Item, arms: &[Option<Arm>]) -> Option<Pose> {
    match item.holder {
        Holder::World => Some(item.at),
        Holder::Link { channel, link } => Some(arms.get(channel)?.as_ref()?.link(link)? * item.at),
        Holder::Flange { channel } => Some(arms.get(channel)?.as_ref()?.flange() * item.at),
    }
}

/// Whether an item is there by the levels of inputs and outputs.
fn is_there(item: &Item, [di, dout]: &[String; 2]) -> bool {
    let Some(Signal { kind, channel }) = item.when else { return true };
    let levels = if kind == SignalKind::DigitalInput { di } else { dout };
    levels.as_bytes().get(channel as usize - 1) == Some(&b'1')
}

fn item_of(body: &Body) -> Result<Item, Failure> {
    item::of_body(body).map_err(|problem| Failure::Usage(format!("body `{}`: {problem}", body.name)))
}
