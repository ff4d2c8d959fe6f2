//! What the robot could do from a state if nothing better were found: the backup of the governor's invariant.
//!
//! There are two kinds. In the first kind, the robot brakes within its stretch, to the lowest of all speeds demanded up
//! to the end of the stretch, and its acceleration has faded before that end. In the second kind, its acceleration
//! fades at once, across ends of stretches, with the lowest limits of all stretches on the way; where that leads,
//! without acceleration, the first kind must be possible. At the end of a backup, and on the even path behind it, the
//! first kind is possible: what it braked for is done, what was too far away to be examined is farther than a stop, and
//! the speed at which the next stretch may be entered is such that, from there on, all its demands can be met. So there
//! is always a backup: the current one as long as it lasts, and a new one behind it.

use std::ops::ControlFlow;

use crate::follow::governor::demands::ALL_CELLS;
use crate::follow::governor::{
    CELL_SPEED_SLACK, Cells, Governor, RELATIVE_SLACK, Scale, TakeWhileSum, careful, distance_to_speed, fading,
    fading_distance, lower,
};
use crate::limits::profile::{Change, LOOK_AHEAD_MARGIN, Limits, State};

/// A speed to change to, and the limits meanwhile.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Aim {
    goal: f64,
    limits: Limits,
}

impl Aim {
    /// The change to it from a state.
    pub(crate) fn change(&self, state: &State) -> Change {
        let Self { goal, mut limits } = *self;
        // With a little more jerk than is normally used, the acceleration fades just with the speed.
        if fading(state.vel, state.acc.min(0.0), &limits) < 0.0 {
            limits.jerk = state.acc * state.acc / (2.0 * state.vel);
        }
        Change::new(state.vel, state.acc, goal, &limits)
    }
}

impl Governor<'_> {
    /// What the robot could do from a state, as far as the speeds of these cells are concerned, with a slack for
    /// speeds, as a share, and for distances, in s of nominal time.
    pub(crate) fn possible(&self, state: &State, scale: Scale, slack: f64, cells: &Cells) -> Option<Aim> {
        self.within(state, scale, slack, cells).or_else(|| self.across(state, scale, slack))
    }

    /// The first kind: within the stretch.
    fn within(&self, state: &State, scale: Scale, slack: f64, cells: &Cells) -> Option<Aim> {
        let State { vel, acc, .. } = *state;
        let Some((here, cell)) = self.at(state.at) else {
            let limits = Limits { vel: 0.0, acc: 1.0, jerk: 1.0 };
            return state.rests().then_some(Aim { goal: 0.0, limits });
        };
        let limits = careful(here, scale);
        let peak = fading(vel, acc.max(0.0), &limits);
        let highest = cell.limits.vel * scale.vel * (1.0 + CELL_SPEED_SLACK + slack);
        if vel < 0.0 || acc.abs() * LOOK_AHEAD_MARGIN > limits.acc * (1.0 + RELATIVE_SLACK + slack) || peak > highest {
            return None;
        }
        let mut goal = fading(vel, acc, &limits).max(0.0);
        let mut met = true;
        self.demands(state, scale, cells, |demand| {
            met = demand.least_remaining >= 0.0 || demand.remaining(state) >= -slack;
            goal = goal.min(demand.goal);
            if met { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
        });
        met.then_some(Aim { goal, limits })
    }

    /// By how much, in shares of full speed or in s of nominal time, a state is beyond what the first kind permits, as
    /// far as the speeds of these cells are concerned; below 0, the room that is left.
    pub(crate) fn excess(&self, state: &State, scale: Scale, cells: &Cells) -> f64 {
        let Some((here, cell)) = self.at(state.at) else { return f64::INFINITY };
        let peak = fading(state.vel, state.acc.max(0.0), &careful(here, scale));
        let mut excess = peak - cell.limits.vel * scale.vel * (1.0 + CELL_SPEED_SLACK);
        self.demands(state, scale, cells, |demand| {
            let surely = demand.least_remaining;
            excess = excess.max(if surely > 0.0 { -surely } else { -demand.remaining(state) });
            ControlFlow::Continue(())
        });
        excess
    }

    /// Whether the acceleration of a state fades at about the end of its stretch or later.
    pub(crate) fn fades_across(&self, state: &State, scale: Scale) -> bool {
        let Some(first) = self.stretches.front() else { return false };
        let distance = fading_distance(state.vel, state.acc, &careful(first, scale));
        let end = first.cells.iter().map(|cell| cell.length).take_while_sum(state.at + distance);
        !first.stops && state.at + distance + self.cycle * state.vel >= end
    }

    /// The second kind: the acceleration fades across ends of stretches.
    pub(crate) fn across(&self, state: &State, scale: Scale, slack: f64) -> Option<Aim> {
        let State { at, vel, acc } = *state;
        if vel < 0.0 {
            return None;
        }
        let mut found: Option<(Limits, State)> = None;
        let (mut end, mut lowest) = (0.0, f64::INFINITY);
        let mut began = None;
        for (index, stretch) in self.stretches.iter().enumerate() {
            let mut entered = false;
            for cell in &stretch.cells {
                let start = end;
                end += cell.length;
                if at >= end {
                    continue;
                }
                if !entered {
                    entered = true;
                    began = began.or(Some(index));
                    let here = careful(stretch, scale);
                    let limits = found.map_or(here, |(limits, _)| lower(limits, here));
                    let faded = fading(vel, acc, &limits);
                    if faded < 0.0 || acc.abs() * LOOK_AHEAD_MARGIN > limits.acc * (1.0 + RELATIVE_SLACK + slack) {
                        return None;
                    }
                    let distance = fading_distance(vel, acc, &limits);
                    found = Some((limits, State { at: at + distance, vel: faded, acc: 0.0 }));
                }
                let (limits, then) = found?;
                let speed = cell.limits.vel * scale.vel * (1.0 + CELL_SPEED_SLACK + slack);
                lowest = lowest.min(speed);
                // Where the speed is lower in the end, it has to be lower already when the cell begins.
                if then.vel > lowest
                    || (vel > speed && start - at < distance_to_speed(vel, acc, speed, &limits) - slack)
                {
                    return None;
                }
                if then.at < end {
                    // Within a stretch, braking at once achieves all that braking later would.
                    if began == Some(index) {
                        return None;
                    }
                    // The fading ends in the middle of a cycle, and what follows begins with the next one.
                    let late = (then.at + self.cycle * then.vel).min(end.next_down());
                    let then = State { at: late.max(then.at), ..then };
                    let goes_on = self.within(&then, scale, slack, &ALL_CELLS).is_some();
                    return goes_on.then_some(Aim { goal: then.vel, limits });
                }
            }
            if entered && stretch.stops {
                return None;
            }
        }
        None
    }
}
