//! Two items that may touch, and when they have to be looked at again.
//!
//! A pair that is far apart cannot touch before its robots have moved as far: how far the places of a link move while
//! the axes change is bounded by the lengths of the arm. So each pair is looked at in few cycles, and no contact is
//! missed in any.

use super::arm::Arm;
use super::item::{Holder, Item, Limb};
use arl_wire::Contact;

/// The nearest that a pair comes to each other is found to so many mm.
const RESOLUTION_MM: f64 = 0.05;
/// Links with fewer than so many others between them are too near to each other to be kept apart.
const LINKS_BETWEEN: usize = 2;
/// What touched has parted once it is so many mm apart: what grinds along something is one contact.
const PARTED_MM: f64 = 1.0;
/// Rounding of distances and positions, in mm.
const ROUNDING_MM: f64 = 1e-4;

/// Two items, by their places in the list.
pub(super) struct Pair {
    pub(super) items: [usize; 2],
    /// What moves each of them.
    ends: [End; 2],
    /// Whether they are parts of one robot: that they are near each other is how it is built.
    is_own: bool,
    /// Whether what touches before anything moves is built so: both are parts of one robot, or neither is of any.
    is_built: bool,
    /// How many of the joints that move each of them are the same ones, from the world or the base on.
    shared: usize,
    /// Whether they overlap since before anything moved, or since one of them came or was taken there.
    overlap: bool,
    /// Whether one of them has just come, or was taken or put there.
    is_new: bool,
    /// Whether they are nearer to each other than the clearance since then.
    stays_near: bool,
    state: State,
    /// Where the robots were when it was last looked at, and how far the items may move from there.
    known: Option<Known>,
}

/// An item, as far as its motion goes.
#[derive(Clone, Copy)]
struct End {
    arm: Option<usize>,
    /// The link that it is on.
    link: usize,
    /// How far its places are from the link's origin at most.
    farthest: f64,
}

/// What has come of a pair.
enum State {
    /// So far apart that there is nothing to tell.
    Apart,
    /// Nearer than the clearance: the nearest so far.
    Near(Contact),
    /// It touches, as was told.
    Touching,
    /// All is told.
    Done,
}

/// What came of a pair in a cycle.
pub(super) enum Met {
    /// Its items touch, which they did not before.
    Touched(Contact),
    /// They do not touch any more.
    Parted,
}

struct Known {
    axes: [Vec<f64>; 2],
    /// As [`Arm::based`].
    based: [u32; 2],
    room: f64,
}

/// All pairs that count, in the order of their items: nothing that is built together, nothing that stands in the world
/// with something else that does.
pub(super) fn pairs(items: &[Item], arms: &[Option<Arm>]) -> Vec<Pair> {
    let limbs: Vec<&Item> = items.iter().filter(|item| item.limb.is_some()).collect();
    // A cell may have many bodies that stand: they are looked at with what moves only.
    let (standing, moving): (Vec<_>, Vec<_>) = items.iter().enumerate().partition(|(_, item)| stands(item));
    let mut pairs = Vec::new();
    for (number, (at, one)) in moving.iter().enumerate() {
        let behind = moving.iter().skip(number + 1);
        for (other_at, other) in standing.iter().chain(behind) {
            let ([at, behind], [one, other]) =
                if at < other_at { ([*at, *other_at], [*one, *other]) } else { ([*other_at, *at], [*other, *one]) };
            if counts(&limbs, one, other) {
                pairs.push(Pair::new([at, behind], [one, other], arms));
            }
        }
    }
    pairs.sort_unstable_by_key(|pair| pair.items);
    pairs
}

fn stands(item: &Item) -> bool {
    matches!(item.holder, Holder::World | Holder::Link { link: 0, .. })
}

/// Whether two items are looked at; `limbs` are those of all robots.
fn counts(limbs: &[&Item], one: &Item, other: &Item) -> bool {
    if one.may_touch(other) || other.may_touch(one) {
        return false;
    }
    if takes(limbs, one, other) || takes(limbs, other, one) || are_one(one, other) {
        return false;
    }
    if one.holder.arm() != other.holder.arm() {
        return true;
    }
    match (one.limb, other.limb) {
        (Some(limb), Some(behind)) => are_apart(limbs, one, (limb, behind)),
        // What is on the flange is fixed to the last limb.
        (Some(limb), None) | (None, Some(limb)) => !is_last(limbs, one, limb),
        (None, None) => false,
    }
}

/// Whether the first one is taken along by the second one, what is on the flange or the last limb: that it touches it
/// is what it is for.
fn takes(limbs: &[&Item], part: &Item, gripper: &Item) -> bool {
    let holds = |by: usize| match gripper.limb {
        Some(limb) => gripper.holder.arm() == Some(by) && is_last(limbs, gripper, limb),
        None => gripper.holder == Holder::Flange { arm: by } && gripper.part.is_none(),
    };
    part.part.is_some_and(|part| holds(part.by))
}

/// Whether both are forms of one part, here or there.
fn are_one(one: &Item, other: &Item) -> bool {
    one.part.zip(other.part).is_some_and(|(one, other)| one.body == other.body)
}

/// Whether something keeps two limbs of the robot of an item apart.
fn are_apart(limbs: &[&Item], of: &Item, both: (Limb, Limb)) -> bool {
    match both {
        (Limb::Capsule { at, radius, .. }, Limb::Capsule { at: behind, radius: other_radius, .. }) => {
            // What is between them may be too short to keep them apart.
            let (first, second) = (at.min(behind), at.max(behind));
            let between = limbs.iter().filter(|item| item.holder.arm() == of.holder.arm());
            let length = |item: &&Item| match item.limb {
                Some(Limb::Capsule { at, length, .. }) if at > first && at < second => Some(length),
                _ => None,
            };
            between.filter_map(length).sum::<f64>() > radius + other_radius
        }
        (Limb::Link { link, .. }, Limb::Link { link: behind, .. }) => link.abs_diff(behind) > LINKS_BETWEEN,
        _ => false,
    }
}

/// Whether a limb is the last one of the robot of an item; of links, what axes turn beside the flange is one limb.
fn is_last(limbs: &[&Item], of: &Item, limb: Limb) -> bool {
    match limb {
        Limb::Capsule { .. } => {
            let of_arm = |other: &&&Item| other.holder.arm() == of.holder.arm();
            limbs.iter().rfind(of_arm).and_then(|last| last.limb) == Some(limb)
        }
        Limb::Link { link, of } => link + 1 >= of,
    }
}

impl End {
    /// What moves it.
    fn arm(self, arms: &[Option<Arm>]) -> Option<&Arm> {
        arms.get(self.arm?)?.as_ref()
    }

    fn of(item: &Item, arms: &[Option<Arm>]) -> Self {
        let arm = |at: usize| arms.get(at).and_then(Option::as_ref);
        let (link, beside) = match item.holder {
            Holder::World | Holder::Carrier(_) => (0, 0.0),
            Holder::Link { link, .. } => (link, 0.0),
            Holder::Flange { arm: at } => (arm(at).map_or(0, Arm::count), arm(at).map_or(0.0, Arm::flange_length)),
        };
        Self { arm: item.holder.arm(), link, farthest: item.farthest() + beside }
    }
}

impl Pair {
    fn new(items: [usize; 2], both: [&Item; 2], arms: &[Option<Arm>]) -> Self {
        let ends = both.map(|item| End::of(item, arms));
        let [one, other] = both;
        let is_own = one.holder.arm() == other.holder.arm();
        let is_built = is_own || !ends.iter().any(|end| end.arm(arms).is_some_and(Arm::is_robot));
        let shared = match (ends[0].arm(arms), ends[1].arm(arms)) {
            (Some(one), Some(other)) => one.shared_with(other).min(ends[0].link).min(ends[1].link),
            _ => 0,
        };
        let (overlap, is_new, stays_near) = (false, false, false);
        Self { items, ends, is_own, is_built, shared, overlap, is_new, stays_near, state: State::Apart, known: None }
    }

    #[cfg(test)]
    pub(super) fn is_own(&self) -> bool {
        self.is_own
    }

    /// Takes in that one of its items, which are these, is elsewhere. Whether they touched until now.
    pub(super) fn place(&mut self, items: [&Item; 2], arms: &[Option<Arm>]) -> bool {
        self.ends = items.map(|item| End::of(item, arms));
        self.is_new = true;
        self.leave()
    }

    /// One of its items is not there, or elsewhere: it is looked at anew once both are there. Whether they touched
    /// until now.
    pub(super) fn leave(&mut self) -> bool {
        self.known = None;
        let touched = matches!(self.state, State::Touching);
        if touched {
            self.state = State::Apart;
        }
        touched
    }

    /// Whether it may have come near enough to matter.
    pub(super) fn is_due(&self, arms: &[Option<Arm>]) -> bool {
        let is_known = |end: &End| self.is_own || end.arm(arms).is_none_or(Arm::is_based);
        if matches!(self.state, State::Done) || !self.ends.iter().all(is_known) {
            return false;
        }
        let Some(known) = &self.known else { return true };
        let based = self.ends.map(|end| end.arm(arms).map_or(0, Arm::based));
        (based != known.based && !self.is_own) || self.moved(&known.axes, arms) >= known.room
    }

    /// The arm that brought the two together: the one that has moved more since they were looked at.
    pub(super) fn mover<'a>(&self, arms: &'a [Option<Arm>]) -> Option<&'a Arm> {
        let [one, other] = &self.ends;
        let (Some(first), Some(second)) = (one.arm(arms), other.arm(arms)) else {
            return one.arm(arms).or(other.arm(arms));
        };
        let moved = |end: &End, arm: &Arm, before: &[f64]| arm.moved(before, 0..end.link, end.farthest);
        match &self.known {
            Some(Known { axes: [here, there], .. }) if moved(other, second, there) > moved(one, first, here) => {
                Some(second)
            }
            _ => Some(first),
        }
    }

    /// The most that the two have moved against each other since the axes were there, in mm: by what does not move
    /// both.
    fn moved(&self, before: &[Vec<f64>; 2], arms: &[Option<Arm>]) -> f64 {
        let moved = |end: &End, before: &[f64]| {
            end.arm(arms).map_or(0.0, |arm| arm.moved(before, self.shared..end.link, end.farthest))
        };
        let ([one, other], [here, there]) = (&self.ends, before);
        moved(one, here) + moved(other, there)
    }

    /// Notes how far apart the two are now, in mm; what came of that.
    pub(super) fn note(
        &mut self,
        distance: f64,
        clearance: f64,
        arms: &[Option<Arm>],
        contact: impl Fn(f64) -> Contact,
    ) -> Option<Met> {
        let mut met = None;
        if matches!(self.state, State::Touching) {
            if distance < PARTED_MM {
                self.know(PARTED_MM - distance, arms);
                return None;
            }
            self.state = State::Apart;
            met = Some(Met::Parted);
        }
        let touches = distance <= 0.0;
        let is_first = self.is_new || (self.is_built && contact(0.0).line == 0);
        let is_built_so = self.overlap || is_first;
        self.overlap = touches && is_built_so;
        self.stays_near = (is_first || self.stays_near) && distance < clearance;
        self.is_new = false;
        if touches && !is_built_so {
            self.state = State::Touching;
            self.know(PARTED_MM, arms);
            return Some(Met::Touched(contact(0.0)));
        }
        let clearance = if self.is_own { 0.0 } else { clearance };
        let room = if distance < clearance {
            let nearest = if let State::Near(nearest) = &self.state { nearest.distance } else { f64::INFINITY };
            if distance < nearest && !self.stays_near {
                self.state = State::Near(contact(distance));
            }
            (distance - nearest).max(RESOLUTION_MM.min(distance))
        } else {
            distance - clearance
        };
        self.know(room, arms);
        met
    }

    /// Takes in where the robots are: the pair matters again once its items have moved so far, in mm.
    fn know(&mut self, room: f64, arms: &[Option<Arm>]) {
        let axes = self.ends.map(|end| end.arm(arms).map_or_else(Vec::new, |arm| arm.axes().to_vec()));
        let based = self.ends.map(|end| end.arm(arms).map_or(0, Arm::based));
        self.known = Some(Known { axes, based, room: (room - ROUNDING_MM).max(0.0) });
    }

    /// The nearest that the two came to each other, if that is to be told; once.
    pub(super) fn take_nearest(&mut self) -> Option<Contact> {
        match std::mem::replace(&mut self.state, State::Done) {
            State::Near(contact) => Some(contact),
            State::Apart | State::Touching | State::Done => None,
        }
    }
}
