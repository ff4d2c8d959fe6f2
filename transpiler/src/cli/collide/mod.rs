//! Collisions of a run: each cycle, robots with themselves, with each other, with the bodies of the cell and what they carry.
//!
//! The first contact of each pair is told with the time and the place of the motion. With a clearance, so is the nearest that a pair comes
//! to each other, where that is nearer.

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

use arl_robot::cell::{Body, Cell, SignalKind};
use parry3d_f64::math::Pose;

use super::failure::Failure;
use super::listen::Hears;
use super::said::{Contact, Cycle, Hello, Line};
use super::show;
use arm::Arm;
pub(super) use check::{Look, check};
use item::{Holder, Item};
use pair::Pair;

/// What was found, for who asked for it.
#[derive(Default, Debug)]
pub(super) struct Found {
    /// Whether the program began, so that there was something to look at.
    pub(super) begun: bool,
    pub(super) contacts: Vec<Contact>,
}

/// Watches where robots and bodies are.
pub(super) struct Collisions {
    bodies: Vec<Item>,
    /// mm; 0: contacts only.
    clearance: f64,
    arms: Vec<Option<Arm>>,
    items: Vec<Item>,
    pairs: Vec<Pair>,
    found: Rc<RefCell<Found>>,
    /// Whether contacts are told as they come.
    tells: bool,
}

impl Collisions {
    /// For the bodies of a cell; what it finds can be asked for.
    ///
    /// # Errors
    /// A mesh cannot be read.
    pub(super) fn new(cell: &Cell, clearance: f64, tells: bool) -> Result<(Self, Rc<RefCell<Found>>), Failure> {
        let bodies = cell.bodies.iter().map(item_of).collect::<Result<Vec<Item>, Failure>>()?;
        let found = Rc::<RefCell<Found>>::default();
        let (arms, items, pairs) = (Vec::new(), Vec::new(), Vec::new());
        Ok((Self { bodies, clearance, arms, items, pairs, found: Rc::clone(&found), tells }, found))
    }

    fn begin(&mut self, hello: &Hello) {
        let several = hello.channels.iter().filter(|runs| !runs.links.is_empty()).count() > 1;
        self.arms = hello.channels.iter().map(|runs| (!runs.links.is_empty()).then(|| Arm::new(runs))).collect();
        self.items.clear();
        for (channel, runs) in hello.channels.iter().enumerate() {
            self.items.extend(item::limbs(channel, runs, several));
        }
        self.items.extend(self.bodies.iter().cloned());
        self.pairs = pair::pairs(&self.items, &self.arms);
        self.found.borrow_mut().begun = true;
    }

    /// Looks at all pairs that may have come near enough to each other to matter.
    fn cycle(&mut self, cycle: &Cycle) -> Vec<Contact> {
        for (arm, moves) in self.arms.iter_mut().zip(&cycle.channels) {
            if let Some(arm) = arm {
                arm.go_to(moves);
            }
        }
        let mut contacts = Vec::new();
        for pair in &mut self.pairs {
            let [Some(one), Some(other)] = pair.items.map(|at| self.items.get(at)) else { continue };
            if !(is_there(one, cycle) && is_there(other, cycle)) {
                pair.forget();
                continue;
            }
            if !pair.is_due(&self.arms) {
                continue;
            }
            let [Some(here), Some(there)] = [one, other].map(|item| place(item, &self.arms)) else { continue };
            let Some(distance) = distance((&here, one), (&there, other)) else { continue };
            let channel = pair.mover(&self.arms);
            let moves = channel.and_then(|channel| cycle.channels.get(channel));
            let contact = |distance| Contact {
                time: cycle.time,
                file: moves.map_or_else(String::new, |moves| moves.file.clone()),
                line: moves.map_or(0, |moves| moves.line),
                one: one.name.clone(),
                other: other.name.clone(),
                distance,
            };
            contacts.extend(pair.note(distance, self.clearance, &self.arms, contact));
        }
        contacts
    }

    /// The nearest that each pair came to each other, of those nearer than the clearance that did not touch; once.
    fn nearest(&mut self) -> Vec<Contact> {
        let mut near: Vec<Contact> = self.pairs.iter_mut().filter_map(Pair::take_nearest).collect();
        near.sort_by(|one, other| one.time.total_cmp(&other.time));
        near
    }

    /// Tells contacts, and has them heard by those behind.
    fn tell(&self, contacts: Vec<Contact>) -> Vec<Line> {
        if self.tells {
            contacts.iter().for_each(|contact| show::warning(&contact.to_string()));
        }
        self.found.borrow_mut().contacts.extend(contacts.iter().cloned());
        contacts.into_iter().map(Line::Contact).collect()
    }
}

impl Hears for Collisions {
    fn wants_each_cycle(&self) -> bool {
        true
    }

    fn hear(&mut self, line: &Line) -> Result<Vec<Line>, Box<dyn Error>> {
        let contacts = match line {
            Line::Hello(hello) => {
                self.begin(hello);
                Vec::new()
            }
            Line::Cycle(cycle) => self.cycle(cycle),
            Line::Ended(()) => self.nearest(),
            _ => Vec::new(),
        };
        Ok(self.tell(contacts))
    }

    fn end(mut self: Box<Self>) -> Result<(), Box<dyn Error>> {
        // It may have ended without a word.
        let near = self.nearest();
        self.tell(near);
        Ok(())
    }

    fn broken(&self) -> String {
        "collisions are not looked for".into()
    }
}

/// How far two items are apart, in mm; 0: they touch. `None` for forms that the library cannot measure, of which there are none.
fn distance((here, one): (&Pose, &Item), (there, other): (&Pose, &Item)) -> Option<f64> {
    let found = parry3d_f64::query::distance(here, &*one.shape, there, &*other.shape).ok()?.distance;
    // Where its search does not settle, the library says 0.
    let touches = || parry3d_f64::query::intersection_test(here, &*one.shape, there, &*other.shape);
    if found <= 0.0 && touches().is_ok_and(|touches| !touches.intersecting) {
        Some(f64::MIN_POSITIVE)
    } else {
        Some(found)
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
fn is_there(item: &Item, cycle: &Cycle) -> bool {
    let Some((signal, wanted)) = item.when else { return true };
    let levels = if signal.kind == SignalKind::DigitalInput { &cycle.di } else { &cycle.dout };
    (levels.as_bytes().get(signal.channel as usize - 1) == Some(&b'1')) == wanted
}

fn item_of(body: &Body) -> Result<Item, Failure> {
    item::of_body(body).map_err(|problem| Failure::Usage(format!("body `{}`: {problem}", body.name)))
}
