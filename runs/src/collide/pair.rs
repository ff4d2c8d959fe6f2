//! Two items that may touch, and when they have to be checked again.
//!
//! A pair that is far apart cannot touch before its robots have moved as far: how far the points of a link move while
//! the axes change is bounded by the lengths of the arm. So each pair is checked in few cycles, and no contact is
//! missed in any.

use super::arm::Arm;
use super::item::{Holder, Item, Limb};
use arl_wire::Contact;

/// The closest approach of a pair is found to within this distance, in mm.
const RESOLUTION_MM: f64 = 0.05;
/// Links with fewer than this many others between them are too near to each other to be kept apart.
const LINKS_BETWEEN: usize = 2;
/// Items that touched have parted once they are this far apart, in mm: what grinds along something is one contact.
const PARTED_MM: f64 = 1.0;
/// Rounding of distances and positions, in mm.
const ROUNDING_MM: f64 = 1e-4;

/// Two items, by their indices in the list.
pub(super) struct Pair {
    pub(super) items: [usize; 2],
    /// What moves each of them.
    ends: [End; 2],
    /// Whether they are parts of one robot, which are near each other by construction.
    is_own: bool,
    /// Whether a touch before anything moves is by construction: both are parts of one robot, or neither is part of
    /// any.
    is_built: bool,
    /// How many of the joints that move them are shared, from the world or the base on.
    shared: usize,
    /// Whether they have overlapped since before anything moved, or since one of them appeared or was taken there.
    overlap: bool,
    /// Whether one of them has just appeared, or was taken or put there.
    is_new: bool,
    /// Whether they have been nearer to each other than the clearance since then.
    stays_near: bool,
    state: State,
    /// Where the robots were at the last check, and how far the items may move from there.
    known: Option<Known>,
}

/// An item, as far as its motion is concerned.
#[derive(Clone, Copy)]
struct End {
    arm: Option<usize>,
    /// The link that it is on.
    link: usize,
    /// The greatest distance of its points from the link's origin.
    farthest: f64,
}

/// The state of a pair.
enum State {
    /// So far apart that there is nothing to report.
    Apart,
    /// Nearer than the clearance: the closest approach so far.
    Near(Contact),
    /// The two touch, which is reported.
    Touching,
    /// Everything is reported.
    Done,
}

/// What happened to a pair in a cycle.
pub(super) enum Met {
    /// Its items touch; they did not before.
    Touched(Contact),
    /// They no longer touch.
    Parted,
}

struct Known {
    axes: [Vec<f64>; 2],
    /// As [`Arm::based`].
    based: [u32; 2],
    room: f64,
}

/// All pairs that count, in the order of their items: no items that are built together, and no two that both stand in
/// the world.
pub(super) fn pairs(items: &[Item], arms: &[Option<Arm>]) -> Vec<Pair> {
    let limbs: Vec<&Item> = items.iter().filter(|item| item.limb.is_some()).collect();
    // A cell may have many bodies that stand: they are only paired with what moves.
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

/// Whether two items are checked; `limbs` are those of all robots.
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

/// Whether the second item, on the flange or the last limb, takes the first one along: they are meant to touch.
fn takes(limbs: &[&Item], part: &Item, gripper: &Item) -> bool {
    let grips = |by: usize| match gripper.limb {
        Some(limb) => gripper.holder.arm() == Some(by) && is_last(limbs, gripper, limb),
        None => gripper.holder == Holder::Flange { arm: by } && gripper.part.is_none(),
    };
    part.part.is_some_and(|part| grips(part.by))
}

/// Whether both are forms of one part, standing or held.
fn are_one(one: &Item, other: &Item) -> bool {
    one.part.zip(other.part).is_some_and(|(one, other)| one.body == other.body)
}

/// Whether what is between them keeps two limbs of an item's robot apart.
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

/// Whether a limb is the last one of the robot of an item; of links, the last two count as one.
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
    /// The arm that moves it.
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

    /// Whether its items are parts of one robot.
    pub(super) fn is_own(&self) -> bool {
        self.is_own
    }

    /// The arms that move its items.
    pub(super) fn arms(&self) -> impl Iterator<Item = usize> {
        self.ends.into_iter().filter_map(|end| end.arm)
    }

    /// Notes that one of its items is elsewhere; returns whether the two touched until now.
    pub(super) fn place(&mut self, items: [&Item; 2], arms: &[Option<Arm>]) -> bool {
        self.ends = items.map(|item| End::of(item, arms));
        self.is_new = true;
        self.leave()
    }

    /// Notes that one of its items is absent or elsewhere: the pair is checked again once both are there. Returns
    /// whether the two touched until now.
    pub(super) fn leave(&mut self) -> bool {
        self.known = None;
        let touched = matches!(self.state, State::Touching);
        if touched {
            self.state = State::Apart;
        }
        touched
    }

    /// Whether the two may have come near enough to matter.
    pub(super) fn is_due(&self, arms: &[Option<Arm>]) -> bool {
        let is_known = |end: &End| self.is_own || end.arm(arms).is_none_or(Arm::is_based);
        if matches!(self.state, State::Done) || !self.ends.iter().all(is_known) {
            return false;
        }
        let Some(known) = &self.known else { return true };
        let based = self.ends.map(|end| end.arm(arms).map_or(0, Arm::based));
        (based != known.based && !self.is_own) || self.moved(&known.axes, arms) >= known.room
    }

    /// The arm that brought the two together: the one that has moved more since the last check.
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

    /// The most that the two have moved relative to each other since the axes were at `before`, in mm, by joints that
    /// do not move both.
    fn moved(&self, before: &[Vec<f64>; 2], arms: &[Option<Arm>]) -> f64 {
        let moved = |end: &End, before: &[f64]| {
            end.arm(arms).map_or(0.0, |arm| arm.moved(before, self.shared..end.link, end.farthest))
        };
        let ([one, other], [here, there]) = (&self.ends, before);
        moved(one, here) + moved(other, there)
    }

    /// Notes the present distance of the two, in mm; returns whether they met or parted.
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

    /// Notes where the robots are: the pair matters again once its items have moved `room` mm.
    fn know(&mut self, room: f64, arms: &[Option<Arm>]) {
        let axes = self.ends.map(|end| end.arm(arms).map_or_else(Vec::new, |arm| arm.axes().to_vec()));
        let based = self.ends.map(|end| end.arm(arms).map_or(0, Arm::based));
        self.known = Some(Known { axes, based, room: (room - ROUNDING_MM).max(0.0) });
    }

    /// The closest approach of the two, if it is to be reported; once.
    pub(super) fn take_nearest(&mut self) -> Option<Contact> {
        match std::mem::replace(&mut self.state, State::Done) {
            State::Near(contact) => Some(contact),
            State::Apart | State::Touching | State::Done => None,
        }
    }
}
