//! Collisions of a run, looked for in each cycle: robots with themselves, with each other, with the bodies of the cell,
//! what they carry and what their external axes move.
//!
//! Each contact of a pair is reported with the time and the place of the motion; after the pair has parted, the next
//! touch is another contact. With a clearance, the closest approach of a pair that never touched is reported as well,
//! if it is below the clearance.

mod arm;
mod item;
mod mesh;
mod pair;
mod parts;
#[cfg(test)]
mod tests;
mod unchecked;

use std::cell::RefCell;
use std::collections::btree_map::Entry;
use std::collections::{BTreeMap, BTreeSet};
use std::error::Error;
use std::fmt;
use std::rc::Rc;

use arl_robot::cell::{Carrier, MOST_FOREGROUND};
use parry3d_f64::math::Pose;

use crate::listen::Subscriber;
use crate::scenery::Scenery;
use arl_terminal::failure::Failure;
use arl_terminal::show;
use arl_wire::{Contact, Cycle, Hello, Line, Placing, Runs, name_of_link};
use arm::Arm;
use item::{Holder, Item};
use pair::{Met, Pair};
use parts::Parts;
pub use unchecked::Unchecked;
use unchecked::Waiting;

/// The result of looking for collisions.
#[derive(Default, Debug)]
pub struct Found {
    /// Whether the program began, so that there was something to look at.
    pub begun: bool,
    /// The pairs that came too near to each other, in the order of time.
    pub contacts: Vec<Contact>,
    /// The robots that were not checked against anything else for a time.
    pub unchecked: Vec<Unchecked>,
}

/// Everything that can touch or be touched, for run after run.
#[derive(Clone)]
pub struct Scene {
    parts: Option<Parts>,
    bodies: Vec<Item>,
    /// For each channel, the forms of the robot's links, where it has any.
    links: Vec<Vec<Item>>,
    /// For each channel, whether the cell says where the robot stands.
    placed: Vec<bool>,
    carriers: Vec<Carrier>,
}

impl fmt::Debug for Scene {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Scene").field("carriers", &self.carriers).finish_non_exhaustive()
    }
}

impl Scene {
    /// The scene of a scenery. A robot whose shape cannot be read is reported to `tell`, and is checked as capsules.
    ///
    /// # Errors
    /// A mesh cannot be read.
    pub fn of(scenery: &Scenery, tell: &dyn Fn(&str)) -> Result<Self, Failure> {
        let (parts, bodies, links) = (Parts::of(scenery)?, bodies(scenery)?, links(scenery, tell));
        let placed = (0..MOST_FOREGROUND).map(|channel| scenery.is_placed(channel)).collect();
        Ok(Self { parts, bodies, links, placed, carriers: scenery.carriers.clone() })
    }

    /// Returns the subscriber that tracks bodies taken along by robots and the one that looks for collisions, in this
    /// order, and what they will have found. With a clearance above 0, in mm, what comes nearer is reported, too;
    /// `tells`: whether contacts are reported as they occur.
    pub fn watch(mut self, clearance: f64, tells: bool) -> (Watchers, Rc<RefCell<Found>>) {
        let mut watchers = Watchers::new();
        if let Some(parts) = self.parts.take() {
            watchers.push(Box::new(parts));
        }
        let (collisions, found) = Collisions::new(self, clearance, tells);
        watchers.push(Box::new(collisions));
        (watchers, found)
    }
}

type Watchers = Vec<Box<dyn Subscriber>>;

/// Watches where robots and bodies are.
struct Collisions {
    bodies: Vec<Item>,
    /// For each channel, the forms of the robot's links, where it has any.
    links: Vec<Vec<Item>>,
    /// For each channel, whether the cell says where the robot stands.
    placed: Vec<bool>,
    carriers: Vec<Carrier>,
    /// mm; 0: contacts only.
    clearance: f64,
    /// The arms of the channels' robots, followed by those of the carriers.
    arms: Vec<Option<Arm>>,
    items: Vec<Item>,
    pairs: Vec<Pair>,
    /// The pairs that have touched or were reported as near, by names: a body may have several forms.
    touched: BTreeSet<[String; 2]>,
    /// How many forms of a pair touch now, by the names of the two.
    touching: BTreeMap<[String; 2], usize>,
    waiting: Waiting,
    found: Rc<RefCell<Found>>,
    /// Whether contacts are reported as they occur.
    tells: bool,
}

impl Collisions {
    /// Looks for collisions in a scene; also returns where its findings will be.
    fn new(scene: Scene, clearance: f64, tells: bool) -> (Self, Rc<RefCell<Found>>) {
        let Scene { bodies, links, placed, carriers, parts: _ } = scene;
        let found = Rc::<RefCell<Found>>::default();
        let collisions = Self {
            bodies,
            links,
            placed,
            carriers,
            clearance,
            arms: Vec::new(),
            items: Vec::new(),
            pairs: Vec::new(),
            touched: BTreeSet::new(),
            touching: BTreeMap::new(),
            waiting: Waiting::default(),
            found: Rc::clone(&found),
            tells,
        };
        (collisions, found)
    }

    fn begin(&mut self, hello: &Hello) {
        let several = hello.channels.iter().filter(|runs| !runs.links.is_empty()).count() > 1;
        let robot = |(channel, runs): (usize, &Runs)| {
            let is_placed = self.placed.get(channel) == Some(&true);
            (!runs.links.is_empty()).then(|| Arm::new(channel, runs, is_placed))
        };
        self.arms = hello.channels.iter().enumerate().map(robot).collect();
        let carrier = |at| Arm::carrier(&self.carriers, at, &hello.channels);
        self.arms.extend((0..self.carriers.len()).map(carrier));
        self.items.clear();
        for (channel, runs) in hello.channels.iter().enumerate() {
            let links = self.links.get(channel).filter(|links| !links.is_empty());
            let named = |item: &Item| match item.holder {
                Holder::Link { link, .. } => {
                    Item { name: name_of_link(link, runs.links.len(), &runs.limbs).to_owned(), ..item.clone() }
                }
                _ => item.clone(),
            };
            let limbs = links.map(|links| links.iter().map(named).collect());
            let mut limbs: Vec<Item> = limbs.unwrap_or_else(|| item::limbs(channel, runs));
            if several {
                for limb in &mut limbs {
                    let name = format!("{} of channel {}", limb.name, channel + 1);
                    limb.kind = Some(std::mem::replace(&mut limb.name, name));
                }
            }
            self.items.extend(limbs);
        }
        let held = |body: &Item| Item { holder: body.holder.in_arms(hello.channels.len(), &self.arms), ..body.clone() };
        self.items.extend(self.bodies.iter().map(held));
        self.pairs = pair::pairs(&self.items, &self.arms);
        self.touching.clear();
        let with_others = self.pairs.iter().filter(|pair| !pair.is_own()).flat_map(Pair::arms);
        self.waiting = Waiting::new(with_others.filter(|arm| *arm < hello.channels.len()));
        self.found.borrow_mut().begun = true;
    }

    /// Moves a body that robots take along to another place.
    fn place(&mut self, placing: &Placing) {
        for item in &mut self.items {
            let Some(part) = item.part.filter(|part| part.body == placing.body) else { continue };
            let place = placing.place.filter(|place| place.held_by.is_none() == (item.holder == Holder::World));
            item.absent = place.is_none();
            if let Some(place) = place {
                item.at = arm::of_frame(&place.at) * part.piece;
            }
        }
        for pair in &mut self.pairs {
            let [Some(one), Some(other)] = pair.items.map(|at| self.items.get(at)) else { continue };
            let is_its = [one, other].iter().any(|item| item.part.is_some_and(|part| part.body == placing.body));
            if is_its && pair.place([one, other], &self.arms) {
                part(&mut self.touching, [one, other]);
            }
        }
    }

    /// Moves all robots to their present positions.
    fn go_to(&mut self, cycle: &Cycle) {
        for (at, arm) in self.arms.iter_mut().enumerate() {
            let Some(arm) = arm else { continue };
            if cycle.channels.get(arm.channel()).is_some_and(|moves| arm.go_to(moves)) {
                self.waiting.moved(at);
            }
        }
        let unchecked = self.waiting.cycle(&self.arms, cycle.time);
        self.tell_unchecked(unchecked);
    }

    /// Checks all pairs that may have come near enough to each other to matter.
    fn cycle(&mut self, cycle: &Cycle) -> Vec<Contact> {
        self.go_to(cycle);
        let mut contacts = Vec::new();
        for pair in &mut self.pairs {
            let [Some(one), Some(other)] = pair.items.map(|at| self.items.get(at)) else { continue };
            if !(is_there(one, cycle) && is_there(other, cycle)) {
                if pair.leave() {
                    part(&mut self.touching, [one, other]);
                }
                continue;
            }
            if !pair.is_due(&self.arms) {
                continue;
            }
            let [Some(here), Some(there)] = [one, other].map(|item| place(item, &self.arms)) else { continue };
            let Some(distance) = distance(&here, one, &there, other) else { continue };
            let moves = pair.mover(&self.arms).and_then(|arm| cycle.channels.get(arm.channel()));
            let contact = |distance| Contact {
                time: cycle.time,
                file: moves.map_or_else(String::new, |moves| moves.file.clone()),
                line: moves.map_or(0, |moves| moves.line),
                one: one.name.clone(),
                other: other.name.clone(),
                distance,
            };
            match pair.note(distance, self.clearance, &self.arms, contact) {
                Some(Met::Touched(contact)) => {
                    let forms = self.touching.entry(names([one, other])).or_default();
                    *forms += 1;
                    if *forms == 1 {
                        self.touched.insert(names([one, other]));
                        contacts.push(contact);
                    }
                }
                Some(Met::Parted) => part(&mut self.touching, [one, other]),
                None => {}
            }
        }
        contacts
    }

    /// The closest approach of each pair that came nearer than the clearance without touching; each is returned once.
    fn nearest(&mut self) -> Vec<Contact> {
        let mut near: Vec<Contact> = self.pairs.iter_mut().filter_map(Pair::take_nearest).collect();
        near.sort_by(|one, other| one.distance.total_cmp(&other.distance));
        near.retain(|contact| self.touched.insert([contact.one.clone(), contact.other.clone()]));
        near.sort_by(|one, other| one.time.total_cmp(&other.time));
        near
    }

    /// Reports robots that were not checked against anything else.
    fn tell_unchecked(&self, unchecked: Vec<Unchecked>) {
        if self.tells {
            unchecked.iter().for_each(|robot| show::warning(&robot.to_string()));
        }
        self.found.borrow_mut().unchecked.extend(unchecked);
    }

    /// Reports contacts, and passes them on to the subscribers after this one.
    fn tell(&self, contacts: Vec<Contact>) -> Vec<Line> {
        if self.tells {
            contacts.iter().for_each(|contact| show::warning(&contact.to_string()));
        }
        self.found.borrow_mut().contacts.extend(contacts.iter().cloned());
        contacts.into_iter().map(Line::Contact).collect()
    }
}

impl Subscriber for Collisions {
    fn wants_each_cycle(&self) -> bool {
        true
    }

    fn receive(&mut self, line: &Line) -> Result<Vec<Line>, Box<dyn Error>> {
        let contacts = match line {
            Line::Hello(hello) => {
                self.begin(hello);
                Vec::new()
            }
            Line::Placing(placing) => {
                self.place(placing);
                Vec::new()
            }
            Line::Cycle(cycle) => self.cycle(cycle),
            Line::Ended(_) => {
                let unchecked = self.waiting.ended(&self.arms);
                self.tell_unchecked(unchecked);
                self.nearest()
            }
            _ => Vec::new(),
        };
        Ok(self.tell(contacts))
    }

    fn broken(&self) -> String {
        "collisions are no longer looked for".into()
    }
}

/// The names of two items, under which all their forms are one pair.
fn names(items: [&Item; 2]) -> [String; 2] {
    items.map(|item| item.name.clone())
}

/// Notes that two forms no longer touch.
fn part(touching: &mut BTreeMap<[String; 2], usize>, items: [&Item; 2]) {
    if let Entry::Occupied(mut forms) = touching.entry(names(items)) {
        *forms.get_mut() -= 1;
        if *forms.get() == 0 {
            forms.remove();
        }
    }
}

/// The distance between two items, in mm; 0 if they touch. `None` for forms that the library cannot measure, of which
/// there are none.
fn distance(here: &Pose, one: &Item, there: &Pose, other: &Item) -> Option<f64> {
    let found = parry3d_f64::query::distance(here, &*one.shape, there, &*other.shape).ok()?.distance;
    // Where its search does not settle, the library returns 0.
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
        // Carriers have become arms once the robots are known.
        Holder::World | Holder::Carrier(_) => Some(item.at),
        Holder::Link { arm, link } => Some(arms.get(arm)?.as_ref()?.link(link)? * item.at),
        Holder::Flange { arm } => Some(arms.get(arm)?.as_ref()?.flange() * item.at),
    }
}

/// Whether an item is there, given the levels of inputs and outputs.
fn is_there(item: &Item, cycle: &Cycle) -> bool {
    item.when.map_or(!item.absent, |level| cycle.has(level))
}

/// The forms of the bodies of a cell.
fn bodies(scenery: &Scenery) -> Result<Vec<Item>, Failure> {
    let mut items = Vec::new();
    for (number, (body, looks)) in scenery.bodies.iter().enumerate() {
        let wrong = |problem| Failure::Usage(format!("body `{}`: {problem}", body.name));
        items.extend(item::of_body(number, body, looks).map_err(wrong)?);
    }
    Ok(items)
}

/// The forms of the links of robots, by channels: empty where a robot has no shape of its own, or where its shape
/// cannot be read, which is reported.
fn links(scenery: &Scenery, tell: &dyn Fn(&str)) -> Vec<Vec<Item>> {
    let of_channel = |channel: usize| {
        let Some(shape) = scenery.shape(channel) else { return Vec::new() };
        let mut items = Vec::new();
        let last = shape.links().count().saturating_sub(1);
        for (link, looks) in shape.links() {
            match item::of_link(channel, link, last, looks) {
                Ok(forms) => items.extend(forms),
                Err(problem) => {
                    let text = format!("{problem}; the robot of channel {} is checked as capsules", channel + 1);
                    tell(&text);
                    return Vec::new();
                }
            }
        }
        items
    };
    (0..MOST_FOREGROUND).map(of_channel).collect()
}
