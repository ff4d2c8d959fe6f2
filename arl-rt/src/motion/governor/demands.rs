//! What the way ahead demands of a state: speeds that have to be reached in time.

use std::ops::{ControlFlow, Range};

use super::{Governor, ROUNDING, SLOWER, Scale, careful, fading, longest_stop, to_rest, way_of_fading, way_to_speed};
use crate::motion::profile::{Limits, State};

/// Cells, counted from the first one of all.
pub(super) type Cells = Range<usize>;
pub(super) const ALL_CELLS: Cells = 0..usize::MAX;
/// None of them.
pub(super) const NO_CELLS: Cells = 0..0;

/// A speed that has to be reached.
pub(super) struct Demand {
    pub(super) goal: f64,
    /// The limits up to there.
    pub(super) limits: Limits,
    /// How much of the way is left when it has been reached.
    pub(super) left: f64,
    /// The cell whose speed it is.
    pub(super) cell: Option<usize>,
}

impl Governor<'_> {
    /// Tells what the rest of the stretch, with these of its `cells`, and the entry of the next one demand, as far as a stop
    /// would reach.
    pub(super) fn demands(
        &self,
        state: &State,
        scale: Scale,
        cells: &Cells,
        mut tell: impl FnMut(Demand) -> ControlFlow<()>,
    ) {
        // What is told decides alone whether to go on.
        let _ =
            self.try_demands(state, scale, cells, |goal, limits, left, cell| tell(Demand { goal, limits, left, cell }));
    }

    fn try_demands(
        &self,
        state: &State,
        scale: Scale,
        cells: &Cells,
        mut tell: impl FnMut(f64, Limits, f64, Option<usize>) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let State { at, vel, acc } = *state;
        let (mut end, mut count) = (0.0, 0_usize);
        for (index, stretch) in self.stretches.iter().enumerate() {
            let limits = careful(stretch, scale);
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
                // An acceleration below zero must fade before the speed does.
                if !inside && to_rest(vel, acc, &limits).is_none() {
                    tell(0.0, limits, f64::NEG_INFINITY, None)?;
                }
                let speed = cell.limits.vel * scale.vel * (1.0 + SLOWER);
                if inside && start - at > longest {
                    return ControlFlow::Continue(());
                }
                if inside && speed < lowest && cells.contains(&count) {
                    let way = way_to_speed(vel, acc, speed, &limits);
                    tell(speed, limits, start - at - way, Some(count))?;
                }
                inside = true;
                lowest = lowest.min(speed);
            }
            if at >= end && !stretch.stops {
                continue;
            }
            let next = if stretch.stops { None } else { self.stretches.get(index + 1) };
            match next {
                None => {
                    let way = to_rest(vel, acc, &limits).map_or(f64::INFINITY, |(way, _)| way);
                    tell(0.0, limits, end - at + 1e-3 * ROUNDING - way, None)?;
                }
                Some(next) if end - at <= longest => {
                    let speed = next.entry * scale.vel * (1.0 + SLOWER);
                    // No acceleration is left where the limits change. The last cycle may end a little behind it.
                    let early = |vel: f64| (end - at - self.cycle * vel).max(0.0);
                    let fades = fading(vel, acc, &limits);
                    if fades <= speed {
                        let fades = fades.max(0.0);
                        tell(fades, limits, early(fades) - way_of_fading(vel, acc, &limits), None)?;
                    }
                    tell(speed, limits, early(speed) - way_to_speed(vel, acc, speed, &limits), None)?;
                }
                _ => {}
            }
            return ControlFlow::Continue(());
        }
        ControlFlow::Continue(())
    }
}
