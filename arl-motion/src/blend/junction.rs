//! Where two motions meet: the blend between them, and the bend where it meets the blend before it. All of it is a function of the
//! motions alone, so that it is the same whoever finds it, and when.

use std::sync::Arc;

use crate::blend::corner::{Blend, blend, curved_blend};
use crate::blend::mid_curvature::{MidCurvature, bend};
use crate::plan::lay_overlay::joined;
use crate::plan::motion::Motion;
use arl_robot::robot::Robot;

/// The motion before, where a blend leads from there, and how it is bent where that blend begins.
pub(crate) type Before = Option<(Arc<Motion>, MidCurvature)>;

/// What a junction depends on.
#[derive(Clone, Debug)]
pub(crate) struct Meeting {
    pub(crate) before: Before,
    pub(crate) from: Arc<Motion>,
    pub(crate) to: Arc<Motion>,
}

/// What there is to know of a place where two motions meet.
#[derive(Debug)]
pub(crate) struct Junction {
    meeting: Meeting,
    bent: Option<CurvedBlends>,
    /// Only looked for where nothing is bent.
    blended: Option<Blended>,
}

/// A blend that meets the one before it in the middle of a motion, which is bent there.
#[derive(Clone, Debug)]
pub(crate) struct CurvedBlends {
    pub(crate) bend: MidCurvature,
    /// The blend before, and the one behind.
    pub(crate) blends: [Blend; 2],
}

/// Two motions and the blend between them.
#[derive(Clone, Debug)]
pub(crate) struct Blended {
    pub(crate) from: Arc<Motion>,
    pub(crate) to: Arc<Motion>,
    pub(crate) blend: Blend,
    /// The part of the first motion behind which it would have to be another one for the blend.
    pub(crate) until: f64,
}

impl Junction {
    /// Finds it.
    pub(crate) fn find(robot: &Robot, meeting: Meeting) -> Self {
        let Meeting { before, from, to } = &meeting;
        let bent = before.as_ref().and_then(|(before, start)| find_curved(robot, before, *start, from, to));
        let blended = if bent.is_none() { find_blended(robot, from, to) } else { None };
        Self { meeting, bent, blended }
    }

    /// What it leaves to the next one, if it is laid as it was found.
    pub(crate) fn leaves(&self) -> Before {
        match (&self.bent, &self.blended) {
            (Some(bent), _) => Some((Arc::clone(&self.meeting.from), bent.bend)),
            (None, Some(blended)) => Some((Arc::clone(&blended.from), MidCurvature::NONE)),
            (None, None) => None,
        }
    }

    /// Whether it is of these motions.
    fn is_of(&self, from: &Arc<Motion>, to: &Arc<Motion>) -> bool {
        Arc::ptr_eq(&self.meeting.from, from) && Arc::ptr_eq(&self.meeting.to, to)
    }
}

/// A bend between two motions, behind one that is bent like `start` where the blend begins; found already, or now.
pub(crate) fn bent(
    robot: &Robot,
    known: Option<&Junction>,
    (before, start): (&Arc<Motion>, MidCurvature),
    (from, to): (&Arc<Motion>, &Arc<Motion>),
) -> Option<CurvedBlends> {
    let known = known.filter(|known| {
        let same = |(motion, bend): &(Arc<Motion>, MidCurvature)| Arc::ptr_eq(motion, before) && *bend == start;
        known.is_of(from, to) && known.meeting.before.as_ref().is_some_and(same)
    });
    match known {
        Some(known) => known.bent.clone(),
        None => find_curved(robot, before, start, from, to),
    }
}

/// The blend that two motions ask for, where nothing is bent; found already, or now.
pub(crate) fn blended(
    robot: &Robot,
    known: Option<&Junction>,
    from: &Arc<Motion>,
    to: &Arc<Motion>,
) -> Option<Blended> {
    match known.filter(|known| known.is_of(from, to) && known.bent.is_none()) {
        Some(known) => known.blended.clone(),
        None => find_blended(robot, from, to),
    }
}

fn find_curved(
    robot: &Robot,
    before: &Motion,
    start: MidCurvature,
    from: &Motion,
    to: &Motion,
) -> Option<CurvedBlends> {
    let bend = bend(robot, before, from, to).filter(|bend| *bend != MidCurvature::NONE)?;
    let first = curved_blend(robot, before, from, [start, bend])?;
    let second = curved_blend(robot, from, to, [bend, MidCurvature::NONE])?;
    Some(CurvedBlends { bend, blends: [first, second] })
}

/// A weave goes on through the blend.
fn find_blended(robot: &Robot, from: &Arc<Motion>, to: &Arc<Motion>) -> Option<Blended> {
    let fades_from = from.laid.as_ref().map_or(1.0, |laid| laid.fades_from());
    let going_on = joined(robot, from, to).filter(|(from, to)| from.goes() && to.goes());
    if let Some((from, to)) = going_on
        && let Some(blend) = blend(robot, &from, &to)
    {
        return Some(Blended { from: Arc::new(from), to: Arc::new(to), blend, until: fades_from });
    }
    let blend = blend(robot, from, to)?;
    Some(Blended { from: Arc::clone(from), to: Arc::clone(to), blend, until: 1.0 })
}
