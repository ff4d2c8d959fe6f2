//! Preview: what the queued motions will do, without executing them.

use std::time::Duration;

use super::Queue;
use super::step::Step;
use crate::command::error::PlanError;
use crate::command::{Cycle, Joints, Override};

/// The motion that a queue has ahead of it, as a function of time.
///
/// ```
/// use arl_motion::{Command, Cycle, Joints, Override, Queue, Settings, Target, robot::Robot};
/// use std::{sync::Arc, time::Duration};
///
/// let robot = Arc::new(Robot::builtin("kr10-r1420").expect("a built-in robot"));
/// let mut queue = Queue::repeatable(Arc::clone(&robot), Joints::home(&robot));
/// queue.add(&Command::new(Target::axes([30.0, -90.0, 90.0, 0.0, 30.0, 0.0])), &Settings::default())?;
///
/// let ahead = queue.preview(Cycle::MS, Override::FULL)?;
/// let halfway = ahead.at(ahead.duration() / 2);
/// assert!(halfway.velocity.axes[0] > 0.0 && halfway.joints.axes[0] < 30.0);
/// assert_eq!(ahead.at(ahead.duration()).joints.axes[0], 30.0);
/// // Nothing has moved.
/// assert_eq!(*queue.joints(), Joints::home(&robot));
/// # Ok::<(), arl_motion::PlanError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Preview {
    cycle: Cycle,
    /// The current state of the robot, followed by the set-points.
    steps: Vec<Step>,
}

impl Preview {
    /// Maximum number of cycles of a preview: all of them are kept in memory.
    pub const MOST_CYCLES: usize = (1 << 20) - 1;

    /// How long it takes until the robot is at rest and nothing is left to do.
    pub fn duration(&self) -> Duration {
        self.cycle.length() * u32::try_from(self.steps.len().saturating_sub(1)).unwrap_or(u32::MAX)
    }

    /// The set-points, a cycle apart; the first one is the current state of the robot.
    pub fn steps(&self) -> &[Step] {
        &self.steps
    }

    /// The set-point at a time from now; after the end, the last one. Between two cycles, positions, velocities and
    /// accelerations of the axes change smoothly from one to the other, the TCP evenly.
    pub fn at(&self, time: Duration) -> Step {
        // Whole numbers, so that a cycle is over at exactly its end.
        let cycle = self.cycle.length().as_nanos();
        let passed = usize::try_from(time.as_nanos() / cycle).unwrap_or(usize::MAX);
        let share = (time.as_nanos() % cycle) as f64 / cycle as f64;
        let from = passed.min(self.steps.len().saturating_sub(1));
        match (self.steps.get(from), self.steps.get(from + 1)) {
            (Some(from), Some(to)) if share > 0.0 => between(from, to, share, self.cycle.period()),
            (Some(step), _) => *step,
            (None, _) => Step::resting(Joints::ZERO, Default::default()),
        }
    }
}

impl Queue {
    /// Finds what the queued motions will do from now on, at an override, if no other command comes: a copy of the
    /// queue goes ahead, waits for blends and time laws as [`Queue::repeatable`] does, and stops where the robot is at
    /// rest and cannot continue. This takes as long as computing these cycles takes, and about 0.5 kB of memory for
    /// each of them.
    ///
    /// # Errors
    /// A motion that waits for the next one cannot be executed without it, or the motions take more than
    /// [`Preview::MOST_CYCLES`].
    pub fn preview(&self, cycle: Cycle, speed_override: Override) -> Result<Preview, PlanError> {
        self.preview_up_to(cycle, speed_override, Preview::MOST_CYCLES)
    }

    /// The preview of at most `most` cycles.
    pub(crate) fn preview_up_to(
        &self,
        cycle: Cycle,
        speed_override: Override,
        most: usize,
    ) -> Result<Preview, PlanError> {
        let mut copy = self.clone();
        copy.follow_real_time(false);
        copy.tell_rates(true);
        copy.conclude()?;
        let mut steps = vec![self.now()];
        let stands = |copy: &Queue| copy.is_layer_idle() || copy.stopped() || speed_override == Override::ZERO;
        while !(copy.rests() && stands(&copy)) {
            // The first step is the state at the start.
            if steps.len() > most {
                return Err(PlanError::TooLong { most });
            }
            steps.push(copy.step(cycle, speed_override));
        }
        Ok(Preview { cycle, steps })
    }
}

/// Interpolates between two set-points that are `period` s apart, by polynomials of the fifth degree.
fn between(from: &Step, to: &Step, share: f64, period: f64) -> Step {
    let mut step = Step { tcp: from.tcp.try_lerp_slerp(&to.tcp, share, 1e-9).unwrap_or(from.tcp), ..*from };
    step.tcp_speed += (to.tcp_speed - from.tcp_speed) * share;
    let of = |step: &Step| [step.joints.all(), step.velocity.all(), step.acceleration.all()];
    let ([p0, v0, a0], [p1, v1, a1]) = (of(from), of(to));
    let [mut joints, mut velocity, mut acceleration] = of(from);
    let starts = p0.iter().zip(&v0).zip(&a0);
    let ends = p1.iter().zip(&v1).zip(&a1);
    let out = joints.iter_mut().zip(&mut velocity).zip(&mut acceleration);
    for (((p, v), a), (((p0, v0), a0), ((p1, v1), a1))) in out.zip(starts.zip(ends)) {
        [*p, *v, *a] = quintic([*p0, *v0, *a0], [*p1, *v1, *a1], share, period);
    }
    (step.joints, step.velocity, step.acceleration) =
        (Joints::of(&joints), Joints::of(&velocity), Joints::of(&acceleration));
    step
}

/// A value with two derivatives at a share of `time` s, between two points where all three are given.
fn quintic([p0, v0, a0]: [f64; 3], [p1, v1, a1]: [f64; 3], share: f64, time: f64) -> [f64; 3] {
    let (c1, c2) = (v0 * time, a0 * time * time / 2.0);
    let (distance, speed, change) = (p1 - p0 - c1 - c2, v1 * time - c1 - 2.0 * c2, a1 * time * time - 2.0 * c2);
    let c3 = 10.0 * distance - 4.0 * speed + change / 2.0;
    let c4 = -15.0 * distance + 7.0 * speed - change;
    let c5 = 6.0 * distance - 3.0 * speed + change / 2.0;
    let s = share;
    [
        p0 + s * (c1 + s * (c2 + s * (c3 + s * (c4 + s * c5)))),
        (c1 + s * (2.0 * c2 + s * (3.0 * c3 + s * (4.0 * c4 + s * 5.0 * c5)))) / time,
        (2.0 * c2 + s * (6.0 * c3 + s * (12.0 * c4 + s * 20.0 * c5))) / (time * time),
    ]
}
