//! What the path ahead demands of a state: speeds that have to be reached in time.

use std::ops::{ControlFlow, Range};

use crate::follow::governor::{
    ENTRY_SPEED_SLACK, Governor, ROUNDING_SLACK, Scale, can_fade, careful, distance_to_speed, fading, fading_distance,
    longest_stop, to_rest,
};
use crate::limits::profile::{Limits, State};

/// Cells, counted from the very first one.
pub(crate) type Cells = Range<usize>;
pub(crate) const ALL_CELLS: Cells = 0..usize::MAX;
/// No cells.
pub(crate) const NO_CELLS: Cells = 0..0;

/// A speed that has to be reached.
pub(crate) struct Demand {
    pub(crate) goal: f64,
    /// The limits up to there.
    pub(crate) limits: Limits,
    /// The available distance, in s of nominal time.
    room: f64,
    kind: Kind,
    /// A lower bound of the distance left, as far as it is known without a closer look.
    pub(crate) least_remaining: f64,
    /// The cell whose speed it is.
    pub(crate) cell: Option<usize>,
}

/// What has to be completed at the end of the distance.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Kind {
    /// The speed has come down to the goal, and stays there.
    Slower,
    /// The acceleration has faded out.
    Faded,
    /// The robot is at rest.
    Rest,
    /// The demand cannot be met.
    Never,
}

impl Demand {
    /// The distance that is left when a robot in this state has reached the speed.
    pub(crate) fn remaining(&self, &State { vel, acc, .. }: &State) -> f64 {
        let limits = &self.limits;
        self.room
            - match self.kind {
                Kind::Slower => distance_to_speed(vel, acc, self.goal, limits),
                Kind::Faded => fading_distance(vel, acc, limits),
                Kind::Rest => to_rest(vel, acc, limits).map_or(f64::INFINITY, |(distance, _)| distance),
                Kind::Never => f64::INFINITY,
            }
    }
}

impl Governor<'_> {
    /// Passes to `tell` what the rest of the stretch, with these `cells`, and the entry of the next stretch demand, as
    /// far as a stop would reach.
    pub(crate) fn demands(
        &self,
        state: &State,
        scale: Scale,
        cells: &Cells,
        mut tell: impl FnMut(Demand) -> ControlFlow<()>,
    ) {
        // The result of `tell` only decides whether to continue.
        let _ = self.try_demands(state, scale, cells, &mut tell);
    }

    fn try_demands(
        &self,
        state: &State,
        scale: Scale,
        cells: &Cells,
        tell: &mut impl FnMut(Demand) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let State { at, vel, acc } = *state;
        let (mut end, mut count) = (0.0, 0_usize);
        for (index, stretch) in self.stretches.iter().enumerate() {
            let limits = careful(stretch, scale);
            let demand = |goal: f64, room: f64, kind: Kind| Demand {
                goal,
                limits,
                room,
                kind,
                least_remaining: f64::NEG_INFINITY,
                cell: None,
            };
            let (rising, most) = (acc.max(0.0), fading(vel, acc.max(0.0), &limits));
            let longest_distance = |goal: f64| {
                if goal >= most { 0.0 } else { most * rising / limits.jerk + limits.slowing(most, goal) }
            };
            let mut lowest = f64::INFINITY;
            let mut inside = false;
            let longest = longest_stop(vel, acc, &limits);
            for cell in &stretch.cells {
                let start = end;
                end += cell.length;
                count += 1;
                if at >= end {
                    continue;
                }
                // A negative acceleration must fade before the speed is zero.
                if !inside && !can_fade(vel, acc, &limits) {
                    tell(demand(0.0, 0.0, Kind::Never))?;
                }
                let speed = cell.limits.vel * scale.vel * (1.0 + ENTRY_SPEED_SLACK);
                let room = start - at;
                if inside && room > longest {
                    return ControlFlow::Continue(());
                }
                if inside && speed < lowest && cells.contains(&count) {
                    let least_remaining = room - longest_distance(speed);
                    tell(Demand { least_remaining, cell: Some(count), ..demand(speed, room, Kind::Slower) })?;
                }
                inside = true;
                lowest = lowest.min(speed);
            }
            if at >= end && !stretch.stops {
                continue;
            }
            let next = if stretch.stops { None } else { self.stretches.get(index + 1) };
            match next {
                None => tell(demand(0.0, end - at + 1e-3 * ROUNDING_SLACK, Kind::Rest))?,
                Some(next) if end - at <= longest => {
                    let speed = next.entry * scale.vel * (1.0 + ENTRY_SPEED_SLACK);
                    // No acceleration is left where the limits change. The last cycle may end a little behind that
                    // place.
                    let early = |vel: f64| (end - at - self.cycle * vel).max(0.0);
                    let fades = fading(vel, acc, &limits);
                    if fades <= speed {
                        let fades = fades.max(0.0);
                        tell(demand(fades, early(fades), Kind::Faded))?;
                    }
                    tell(demand(speed, early(speed), Kind::Slower))?;
                }
                _ => {}
            }
            return ControlFlow::Continue(());
        }
        ControlFlow::Continue(())
    }
}
