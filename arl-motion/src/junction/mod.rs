//! Where two motions meet: the blend between them, and the curvature where it meets the blend before it. All of this is
//! a function of the motions alone, so that it is the same no matter where and when it is found.

pub(crate) mod blend_thread;
pub(crate) mod gain;
mod junction_memory;

use std::cell::Cell;
use std::sync::Arc;

use crate::blend::corner::{Blend, blend, curved_blend};
use crate::blend::mid_curvature::{MidCurvature, mid_curvature};
use crate::blend::no_blend::NoBlend;
use crate::junction::gain::Stopping;
use crate::plan::lay_overlay::joined;
use crate::plan::motion::Motion;
use arl_robot::robot::Robot;

/// The motion before, where a blend leads from it whose end may be curved, and the motion's curvature where that blend
/// begins.
pub(crate) type Before = Option<(Arc<Motion>, MidCurvature)>;

/// What a junction depends on.
#[derive(Clone, PartialEq, Debug)]
pub(crate) struct MotionPair {
    pub(crate) before: Before,
    pub(crate) from: Arc<Motion>,
    pub(crate) to: Arc<Motion>,
}

/// Everything about a place where two motions meet.
#[derive(Debug)]
pub(crate) struct Junction {
    pair: MotionPair,
    curved: Option<CurvedBlends>,
    /// Only sought where nothing is curved.
    blended: Option<Result<Blended, NoBlend>>,
}

/// A blend that meets the one before it in the middle of a motion, which is curved there.
#[derive(Clone, Debug)]
pub(crate) struct CurvedBlends {
    pub(crate) curvature: MidCurvature,
    /// The blend before, and the one behind.
    pub(crate) blends: [Blend; 2],
}

/// Two motions and the blend between them.
#[derive(Clone, Debug)]
pub(crate) struct Blended {
    pub(crate) from: Arc<Motion>,
    pub(crate) to: Arc<Motion>,
    pub(crate) blend: Blend,
    /// The share of the first motion behind which that motion would have to be another one for the blend.
    pub(crate) until: f64,
}

impl Blended {
    /// What it passes on to the next junction: a blend smaller than requested stays as it is, since a curved one would
    /// begin elsewhere.
    pub(crate) fn leaves(&self) -> Before {
        self.blend.is_whole.then(|| (Arc::clone(&self.from), MidCurvature::NONE))
    }
}

/// Whether two motions take longer with a blend than with a stop.
type IsSlower<'a> = &'a dyn Fn(&Stopping, &Blend) -> bool;

/// According to the fastest laws.
const BY_LAWS: IsSlower = &|stopping: &Stopping, blend: &Blend| stopping.is_faster_than(blend);

impl Junction {
    /// Finds the junction.
    pub(crate) fn find(robot: &Robot, pair: MotionPair) -> Self {
        Self::find_by(robot, pair, BY_LAWS)
    }

    /// Finds the junction if that requires no time laws, which take long to find.
    pub(crate) fn find_quickly(robot: &Robot, pair: MotionPair) -> Option<Self> {
        let is_doubtful = Cell::new(false);
        let doubts = |stopping: &Stopping, blend: &Blend| {
            is_doubtful.set(is_doubtful.get() || stopping.doubts(blend));
            false
        };
        let found = Self::find_by(robot, pair, &doubts);
        (!is_doubtful.get()).then_some(found)
    }

    fn find_by(robot: &Robot, pair: MotionPair, is_slower: IsSlower) -> Self {
        let MotionPair { before, from, to } = &pair;
        let curved =
            before.as_ref().and_then(|(before, start)| find_curved(robot, before, *start, [from, to], is_slower));
        let blended = curved.is_none().then(|| find_blended(robot, [from, to], is_slower));
        Self { pair, curved, blended }
    }

    /// The junction for an equal pair of motions.
    fn of(&self, pair: MotionPair) -> Self {
        let own = |motion: &Arc<Motion>| {
            let pairs = [(&self.pair.from, &pair.from), (&self.pair.to, &pair.to)];
            let same = pairs.into_iter().find(|(known, _)| Arc::ptr_eq(known, motion));
            Arc::clone(same.map_or(motion, |(_, own)| own))
        };
        let with_own =
            |blended: &Blended| Blended { from: own(&blended.from), to: own(&blended.to), ..blended.clone() };
        let blended = self.blended.as_ref().map(|blended| blended.as_ref().map(with_own).map_err(NoBlend::clone));
        Self { curved: self.curved.clone(), blended, pair }
    }

    /// What it passes on to the next junction, if it is laid as found.
    pub(crate) fn leaves(&self) -> Before {
        match (&self.curved, &self.blended) {
            (Some(curved), _) => Some((Arc::clone(&self.pair.from), curved.curvature)),
            (None, Some(Ok(blended))) => blended.leaves(),
            (None, _) => None,
        }
    }

    /// Whether it belongs to these motions.
    fn is_of(&self, from: &Arc<Motion>, to: &Arc<Motion>) -> bool {
        Arc::ptr_eq(&self.pair.from, from) && Arc::ptr_eq(&self.pair.to, to)
    }
}

/// The curved blends between two motions, where the blend before begins with the curvature `start`: those already
/// found, or found now.
pub(crate) fn curved(
    robot: &Robot,
    known: Option<&Junction>,
    before: &Arc<Motion>,
    start: MidCurvature,
    from: &Arc<Motion>,
    to: &Arc<Motion>,
) -> Option<CurvedBlends> {
    let known = known.filter(|known| {
        let same =
            |(motion, curvature): &(Arc<Motion>, MidCurvature)| Arc::ptr_eq(motion, before) && *curvature == start;
        known.is_of(from, to) && known.pair.before.as_ref().is_some_and(same)
    });
    match known {
        Some(known) => known.curved.clone(),
        None => find_curved(robot, before, start, [from, to], BY_LAWS),
    }
}

/// The blend that two motions request, where nothing is curved: the one already found, or found now.
pub(crate) fn blended(
    robot: &Robot,
    known: Option<&Junction>,
    from: &Arc<Motion>,
    to: &Arc<Motion>,
) -> Result<Blended, NoBlend> {
    let known = known.filter(|known| known.is_of(from, to)).and_then(|known| known.blended.clone());
    known.unwrap_or_else(|| find_blended(robot, [from, to], BY_LAWS))
}

fn find_curved(
    robot: &Robot,
    before: &Motion,
    start: MidCurvature,
    [from, to]: [&Motion; 2],
    is_slower: IsSlower,
) -> Option<CurvedBlends> {
    let curvature = mid_curvature(robot, before, from, to).filter(|curvature| *curvature != MidCurvature::NONE)?;
    let first = curved_blend(robot, before, from, [start, curvature])?;
    let second = curved_blend(robot, from, to, [curvature, MidCurvature::NONE])?;
    // Without the curvature, the blend may still save time.
    if is_slower(&Stopping::new(robot, from, to), &second) {
        return None;
    }
    Some(CurvedBlends { curvature, blends: [first, second] })
}

/// Finds a blend. A weave continues through it.
fn find_blended(robot: &Robot, [from, to]: [&Arc<Motion>; 2], is_slower: IsSlower) -> Result<Blended, NoBlend> {
    let fades_from = from.laid.as_ref().map_or(1.0, |laid| laid.fades_from());
    let going_on = joined(robot, from, to).filter(|(from, to)| from.goes() && to.goes());
    if let Some((from, to)) = going_on
        && let Ok(blend) = find_blend(robot, [&from, &to], is_slower)
    {
        return Ok(Blended { from: Arc::new(from), to: Arc::new(to), blend, until: fades_from });
    }
    let blend = find_blend(robot, [from, to], is_slower)?;
    Ok(Blended { from: Arc::clone(from), to: Arc::clone(to), blend, until: 1.0 })
}

fn find_blend(robot: &Robot, [from, to]: [&Motion; 2], is_slower: IsSlower) -> Result<Blend, NoBlend> {
    let stopping = Stopping::new(robot, from, to);
    blend(robot, from, to, |blend| is_slower(&stopping, blend))
}
