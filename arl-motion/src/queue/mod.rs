//! Look-ahead and interpolator: motions wait in a queue, and each cycle advances the robot along the first one.

mod add;
mod elapsed;
mod execute;
mod layer;
mod look_ahead;
mod motion_progress;
mod path_buffer;
mod path_speed;
mod preview;
mod record;
mod step;
mod suspend;

use std::sync::Arc;

use crate::blend::no_blend::NoBlend;
use crate::command::error::PlanError;
use crate::command::joints::Joints;
use crate::follow::segment::{PlainSpeed, Segment};
use crate::overlay::CompensationState;
use crate::plan::chain::DeferredMotion;
use crate::plan::motion::Motion;
use arl_robot::frames::Rig;
use arl_robot::kinematics::Frame;
use arl_robot::robot::Robot;
use layer::Layer;
use look_ahead::{LookAhead, Ready};
pub use motion_progress::Progress;
pub use path_buffer::UnblendedTarget;
use path_buffer::{Leaving, OfferOutcome};
pub use preview::Preview;
pub use record::{Closest, Figure, Limited, MotionRecord, Rate, Recorder, SmallerZone};
pub use step::Step;
pub use suspend::Start;
use suspend::Suspension;

/// Number of motions that can always wait, not counting the one being executed.
pub const LOOK_AHEAD: usize = 64;
/// Upper limit of the number of waiting motions.
const MOST_MOTIONS_AHEAD: u64 = 8192;
/// Length of the path ahead, in s at full speed, beyond which no more than [`LOOK_AHEAD`] motions wait.
const LOOK_AHEAD_S: f64 = 3.0;

/// How to come to rest on the path.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[non_exhaustive]
pub enum Stop {
    /// Within the limits of the motion.
    General,
    /// With five times the acceleration and jerk.
    Fast,
}

/// Factor on acceleration and jerk for a fast stop.
const FAST_STOP_FACTOR: f64 = 5.0;

/// Value of `slowed` where no motion was slowed: full speed, no program line.
const NOT_SLOWED: (f64, u32) = (1.0, 0);

/// The motions of one robot, planned ahead and executed cycle by cycle.
#[derive(Clone, Debug)]
pub struct Queue {
    robot: Arc<Robot>,
    /// The motions that move the robot now.
    layer: Layer,
    /// Motions that are suspended, or about to be.
    suspension: Suspension,
    halt: Halt,
    commanded: Commanded,
    /// Running number of the motion that was added last.
    added: u64,
    /// Number of the motion being executed, its remaining time in s, and for how many cycles that has been counted
    /// down.
    forecast: Option<(u64, f64, u32)>,
    /// Progress of the motions that were left behind in the last cycle.
    exited: Vec<Progress>,
    /// The length of a cycle, in s.
    cycle: f64,
    look_ahead: LookAhead,
    notices: Notices,
}

/// What keeps the robot from moving on.
#[derive(Clone, Debug, Default)]
struct Halt {
    stop: Option<Stop>,
    /// Whether a fast stop is in progress.
    braking_hard: bool,
    /// Whether all motions are dropped as soon as the robot is at rest.
    dropping: bool,
}

/// The commanded positions and their velocity.
#[derive(Clone, Debug)]
struct Commanded {
    joints: Joints,
    velocity: Joints,
    /// Whether steps contain velocities and accelerations.
    tells_rates: bool,
}

/// What callers may ask for; each item is returned once.
#[derive(Clone, Debug)]
struct Notices {
    /// Targets that should be rounded off but are not; each once.
    unblended: Vec<UnblendedTarget>,
    /// Error of a motion that waited in vain for the next one.
    broken: Option<PlanError>,
    /// Motions that were laid on the path; `Some` only where a recorder watches.
    laid: Option<Vec<LaidMotion>>,
    /// The lowest share of its speed that an overlay has left to a motion, and the program line of that motion.
    slowed: (f64, u32),
}

impl Default for Notices {
    fn default() -> Self {
        Self { unblended: Vec::new(), broken: None, laid: None, slowed: NOT_SLOWED }
    }
}

/// A motion that was laid on the path.
#[derive(Clone, Debug)]
pub(crate) struct LaidMotion {
    pub(crate) number: u64,
    pub(crate) motion: Arc<Motion>,
    /// The motion that is blended with it.
    pub(crate) leaving: Option<Leaving>,
    /// Reason why it is not blended with the motion before it although a blend was requested.
    pub(crate) unblended: Option<NoBlend>,
}

impl Queue {
    /// Creates an empty queue for a robot at rest at `start`, for cycles in real time. No cycle waits for what threads
    /// find in parallel (blends and time laws): the robot continues with what it has, and comes to rest on its path
    /// where nothing more comes. So the set-points also depend on the computer; [`Queue::found_late`] counts what came
    /// too late.
    pub fn new(robot: Arc<Robot>, start: Joints) -> Self {
        let mut queue = Self::repeatable(robot, start);
        queue.follow_real_time(true);
        queue
    }

    /// Creates an empty queue of a robot at rest at `start`, for cycles that may take any time, as in simulation and
    /// planning: a cycle that needs a blend or a time law waits for it (30 ms and more at times), so that the same
    /// commands at the same cycles give the same set-points, to the last bit, on every machine.
    pub fn repeatable(robot: Arc<Robot>, start: Joints) -> Self {
        Self {
            robot,
            layer: Layer::resting_at(start),
            suspension: Suspension::default(),
            halt: Halt::default(),
            commanded: Commanded { joints: start, velocity: Joints::ZERO, tells_rates: true },
            added: 0,
            forecast: None,
            exited: Vec::with_capacity(LOOK_AHEAD),
            cycle: 0.001,
            look_ahead: LookAhead::default(),
            notices: Notices::default(),
        }
    }

    /// Sets whether cycles from now on run in real time, as with [`Queue::new`], or wait, as with
    /// [`Queue::repeatable`].
    pub fn follow_real_time(&mut self, in_real_time: bool) {
        self.look_ahead.in_real_time = in_real_time;
        self.layer.path.follow_real_time(in_real_time);
    }

    /// The number of time laws and blends that came too late in real time, except those whose delay did not change the
    /// motion of the robot.
    pub fn found_late(&self) -> u64 {
        self.layer.path.late_laws() + self.look_ahead.late_blends.count
    }

    /// The robot that moves.
    pub fn robot(&self) -> &Robot {
        &self.robot
    }

    /// Whether another motion can be added: up to [`LOOK_AHEAD`] always, beyond that as long as the path ahead is
    /// shorter than what stopping may take.
    pub fn has_room(&self) -> bool {
        let executing = u64::from(self.layer.execution.started == Some(self.layer.finished + 1));
        let waiting = (self.unfinished() as u64).saturating_sub(executing);
        waiting < LOOK_AHEAD as u64 || (waiting < MOST_MOTIONS_AHEAD && self.is_short_of_path())
    }

    /// From now on notes the motions that are laid on the path, for [`Queue::take_laid`].
    pub(crate) fn watch(&mut self) {
        self.notices.laid = Some(Vec::new());
    }

    /// Takes the motions that were laid on the path since the last call.
    pub(crate) fn take_laid(&mut self) -> Vec<LaidMotion> {
        self.notices.laid.as_mut().map_or_else(Vec::new, std::mem::take)
    }

    /// Takes the error of a motion that waited in vain for the next one, if there was one since the last call.
    pub fn take_broken(&mut self) -> Option<PlanError> {
        self.notices.broken.take()
    }

    /// Handles the outcome of motions that were offered to the path.
    fn take_answer(&mut self) {
        match self.layer.path.take_answer() {
            Some(OfferOutcome::Taken { unblended, count }) => {
                for _ in 0..count {
                    if let Some(taken) = self.layer.waiting.pop() {
                        let of_it = unblended.iter().find(|target| target.number == taken.number);
                        self.note_laid(&taken.motion, taken.number, of_it.cloned());
                    }
                }
            }
            Some(OfferOutcome::Refused) => {
                if let Some(Ready { motion, number, prepared, .. }) = self.layer.waiting.pop() {
                    let (path, prepared) = (&mut self.layer.path, prepared.as_ref());
                    let unblended = path.append_behind_stop(&self.robot, &motion, number, prepared, self.cycle);
                    self.note_laid(&motion, number, unblended);
                }
            }
            None => {}
        }
    }

    /// Notes a motion that was laid on the path, and the target before it where that should be rounded off but is not.
    fn note_laid(&mut self, motion: &Arc<Motion>, number: u64, unblended: Option<UnblendedTarget>) {
        if let Some(laid) = &mut self.notices.laid {
            let leaving = self.layer.path.leaving_before(number).filter(|_| motion.goes());
            let unblended = unblended.as_ref().map(|target| target.why.clone());
            laid.push(LaidMotion { number, motion: Arc::clone(motion), leaving, unblended });
        }
        if let Some(target) = unblended
            && !self.notices.unblended.iter().any(|known| known.is_same(&target))
        {
            self.notices.unblended.push(target);
        }
    }

    /// Takes the targets, since the last call, that should be rounded off but are reached with a stop. Targets between
    /// the same two program lines with the same reason count as one.
    pub fn take_unblended(&mut self) -> Vec<UnblendedTarget> {
        std::mem::take(&mut self.notices.unblended)
    }

    /// Takes the lowest share of its programmed speed, 0 to 1, that a weave or a compensation has left to a motion
    /// since the last call, and the program line of that motion.
    pub fn take_slowed(&mut self) -> (f64, u32) {
        std::mem::replace(&mut self.notices.slowed, NOT_SLOWED)
    }

    /// Where the last motion of the queue ends and the next one will start.
    pub fn end(&self) -> &Joints {
        self.layer.deferred.as_ref().map_or(&self.layer.end, DeferredMotion::end)
    }

    /// The current commanded positions.
    pub fn joints(&self) -> &Joints {
        &self.commanded.joints
    }

    /// The current TCP in the world, with the tool and the base of the motion that is or was last executed, translation
    /// in mm.
    pub fn tcp(&self) -> Frame {
        self.layer.execution.rig.tcp_at(&self.robot.kinematics.forward(&self.commanded.joints.axes))
    }

    /// Whether there is no motion at all: none being executed, waiting or suspended.
    pub fn idle(&self) -> bool {
        self.is_layer_idle() && self.is_clear()
    }

    /// The running number of the motion that is executed or comes next; `None` where none is laid on the path.
    pub fn current(&self) -> Option<u64> {
        self.layer.path.current().map(|(segment, _)| segment.number)
    }

    /// Whether the robot is at rest, at the end of a motion or within one.
    pub fn rests(&self) -> bool {
        self.layer.path.rests()
    }

    /// Whether the robot was told to stop and has not been told since to resume or to drop its motions.
    pub fn stopped(&self) -> bool {
        self.halt.stop.is_some()
    }

    /// Brings the robot to rest on the path; motions stay in the queue until [`Queue::resume`]. A general stop does not
    /// soften a fast one.
    pub fn stop_on_path(&mut self, stop: Stop) {
        if self.halt.stop != Some(Stop::Fast) {
            self.halt.stop = Some(stop);
        }
    }

    /// Continues along the path after a stop; after a fast one as soon as the robot is at rest.
    pub fn resume(&mut self) {
        self.halt.stop = None;
    }

    /// Drops all waiting motions and the one being executed: at once where the robot is at rest, else when it has come
    /// to rest. Without a stop the robot first continues to the next target that it reaches exactly.
    pub fn clear(&mut self) {
        self.suspension.clear();
        self.drop_added();
    }

    /// Drops the motions that were added since others were suspended, in the same way as [`Queue::clear`]; suspended
    /// motions stay.
    pub fn drop_added(&mut self) {
        self.layer.requests.clear();
        self.layer.path.keep_to_stop();
        self.layer.waiting.clear();
        self.layer.deferred = None;
        self.halt.dropping = true;
        self.drop_at_rest();
    }

    /// Sets the commanded positions, as when a robot is switched on. Returns whether that was possible: not while there
    /// are motions, and not for values that are not finite.
    pub fn place(&mut self, joints: Joints) -> bool {
        let idle = self.is_layer_idle() && self.rests() && joints.is_finite();
        if idle {
            (self.commanded.joints, self.layer.end) = (joints, joints);
            self.commanded.velocity = Joints::ZERO;
            self.layer.compensation_state = CompensationState::default();
        }
        idle
    }

    /// The running number of the last motion that is no longer executed: it has ended, or a blend leads away from it.
    pub fn over(&self) -> u64 {
        self.layer.over
    }

    /// Where the motion being executed ends, or else the next one.
    pub fn target(&self) -> &Joints {
        self.layer.path.current().map_or(&self.layer.end, |(segment, _)| segment.target())
    }

    /// What the robot carries in the motion that is or was last executed, and where its base is in the world.
    pub fn rig(&self) -> &Rig {
        &self.layer.execution.rig
    }

    /// Sets whether steps contain velocities, accelerations and the speed of the TCP; by default they do. Without them
    /// these values are 0, and a caller that uses positions alone saves the time to find them.
    pub fn tell_rates(&mut self, wanted: bool) {
        if wanted != self.commanded.tells_rates {
            // The velocity was not kept up to date.
            self.commanded.velocity = Joints::ZERO;
        }
        self.commanded.tells_rates = wanted;
    }

    /// The length of the last cycle, in s.
    pub(super) fn cycle(&self) -> f64 {
        self.cycle
    }

    /// The segment that the robot is on, and its speed there where the segment is not part of a blend.
    pub(super) fn plain_speed(&self) -> Option<(&Segment, Option<PlainSpeed>)> {
        self.layer.path.plain_speed()
    }

    /// Factor by which the limits of acceleration and jerk in the last cycle exceeded those of the robot file.
    pub(super) fn hardness(&self) -> f64 {
        if self.halt.braking_hard { FAST_STOP_FACTOR } else { 1.0 }
    }
}
