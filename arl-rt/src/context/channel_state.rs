//! The state of one channel: its robot, its modal system variables, and the state of its program.

use std::cell::{Cell, Ref, RefCell, RefMut};
use std::rc::Rc;

use crate::context::shared_state::SharedState;
use crate::context::system::System;
use crate::cycle::channel_id::ChannelId;
use crate::fault::{Alarm, Fault, File};
use crate::motion::{NoBlend, Progress, UnblendedTarget};
use crate::storage::pointers::StoredPointers;
use crate::unit::{Collision, Mounts, SENSITIVITY, Unit, joint};
use crate::values::{self, VelProfile};
use arl_robot::cell::Sensitivity;
use arl_robot::robot::VelocityProfile;

/// The state of one channel, whatever program it runs. Borrows of the cells end within the call that makes them.
pub(crate) struct ChannelState {
    pub(crate) shared: Rc<SharedState>,
    pub(crate) id: ChannelId,
    /// Its index among all channels, from 0, the foreground channels first.
    pub(crate) index: usize,
    pub(crate) system: System,
    /// The robot; a background channel has none.
    unit: Option<Rc<RefCell<Unit>>>,
    /// Where a program stood here before the controller was switched on.
    kept: StoredPointers,
    /// Whether a program has run here since then.
    pub(crate) begun: Cell<bool>,
    /// In how many cycles the program had more turns of loops to make than one cycle may have.
    pub(crate) full_cycles: Cell<u64>,
    /// Whether the program waits for the start button.
    pub(crate) paused: Cell<bool>,
    pub(crate) stepping: Stepping,
    /// Which motions set the current tool and workpiece frame.
    pub(crate) mounts: Cell<Mounts>,
    /// Whether a program that comes to its end is reset and begins again.
    pub(crate) repeats: Cell<bool>,
    /// Whether an alarm has ended the program and has not been cleared.
    pub(crate) alarmed: Cell<bool>,
    /// An alarm that ends the program and did not come from the current statement.
    pending_alarm: RefCell<Option<Alarm>>,
    /// Home points 1 to 5.
    homes: [Option<Vec<f64>>; 5],
    home_tolerance: f64,
    /// The conditions of `startdetect` that the cell gives.
    collisions: Vec<(u8, Sensitivity)>,
    /// The robot's base in the world, where the cell gives it.
    pub(crate) base: Option<values::Frame>,
}

/// Single steps.
#[derive(Default)]
pub(crate) struct Stepping {
    /// Whether the program goes on step by step.
    pub(crate) on: Cell<bool>,
    /// How many instructions may still be executed.
    pub(crate) remaining: Cell<u32>,
    /// The motion with which the step ends, where it is planned already.
    pub(crate) until: Cell<Option<u64>>,
}

/// The robot of a foreground channel, and the cell's settings for it.
pub(crate) struct Station {
    pub(crate) unit: Rc<RefCell<Unit>>,
    /// Home points 2 to 5.
    pub(crate) homes: [Option<Vec<f64>>; 4],
    pub(crate) home_tolerance: f64,
    pub(crate) collisions: Vec<(u8, Sensitivity)>,
    /// The robot's base in the world, where the cell gives it.
    pub(crate) base: Option<values::Frame>,
    pub(crate) kept: StoredPointers,
}

impl ChannelState {
    /// A foreground channel.
    pub(crate) fn foreground(
        shared: Rc<SharedState>,
        id: ChannelId,
        index: usize,
        system: System,
        station: Station,
    ) -> Self {
        let Station { unit, homes: [second, third, fourth, fifth], home_tolerance, collisions, base, kept } = station;
        let homes = [Some(unit.borrow().robot().home.clone()), second, third, fourth, fifth];
        Self {
            homes,
            home_tolerance,
            collisions,
            base,
            kept,
            unit: Some(unit),
            ..Self::background(shared, id, index, system)
        }
    }

    /// A background channel.
    pub(crate) fn background(shared: Rc<SharedState>, id: ChannelId, index: usize, system: System) -> Self {
        Self {
            shared,
            id,
            index,
            system,
            unit: None,
            kept: StoredPointers::default(),
            begun: Cell::new(false),
            full_cycles: Cell::new(0),
            paused: Cell::new(false),
            stepping: Stepping::default(),
            mounts: Cell::default(),
            repeats: Cell::new(false),
            alarmed: Cell::new(false),
            pending_alarm: RefCell::default(),
            homes: [const { None }; 5],
            home_tolerance: 0.0,
            collisions: Vec::new(),
            base: None,
        }
    }

    /// Where a program stood here before the controller was switched on.
    pub(crate) fn kept(&self) -> &StoredPointers {
        &self.kept
    }

    /// The robot, for an instruction or function that is not allowed in a background channel.
    ///
    /// # Errors
    /// [`Fault::Background`].
    #[inline]
    pub(crate) fn unit(&self, function: &'static str) -> Result<Ref<'_, Unit>, Fault> {
        self.robot().ok_or(Fault::Background { function })
    }

    /// The robot, to be changed by an instruction that is not allowed in a background channel.
    ///
    /// # Errors
    /// [`Fault::Background`].
    #[inline]
    pub(crate) fn unit_mut(&self, function: &'static str) -> Result<RefMut<'_, Unit>, Fault> {
        self.robot_mut().ok_or(Fault::Background { function })
    }

    /// A shared reference to the robot, if there is one.
    pub(crate) fn shared_unit(&self) -> Option<&Rc<RefCell<Unit>>> {
        self.unit.as_ref()
    }

    /// The robot, if there is one.
    #[inline]
    pub(crate) fn robot(&self) -> Option<Ref<'_, Unit>> {
        Some(self.unit.as_ref()?.borrow())
    }

    /// The robot, if there is one, to be changed.
    #[inline]
    pub(crate) fn robot_mut(&self) -> Option<RefMut<'_, Unit>> {
        Some(self.unit.as_ref()?.borrow_mut())
    }

    /// Sets the system variables of the manual's chapter 10.2 to their defaults.
    pub(crate) fn reset_system(&self) {
        self.system.reset();
        let Some(unit) = self.robot() else { return };
        self.system.vel_profile.set(match unit.robot().profile {
            VelocityProfile::T => VelProfile::T,
            VelocityProfile::S => VelProfile::S,
            VelocityProfile::O => VelProfile::O,
        });
        self.system.cjoint.set(joint(unit.target()));
    }

    /// Stops all motion on its path and drops the motions that follow.
    pub(crate) fn stop_motion(&self) {
        self.shared.io.borrow_mut().forget_motion(self.index);
        if let Some(mut unit) = self.robot_mut() {
            unit.stop();
        }
    }

    /// The sensitivity of a condition of `startdetect`.
    pub(crate) fn sensitivity(&self, cid: u8) -> Sensitivity {
        let given = self.collisions.iter().rev().find(|(known, _)| *known == cid);
        given.map_or(Sensitivity::Percent(SENSITIVITY), |(_, sensitivity)| sensitivity.clone())
    }

    /// The collision of this cycle, if there was one, as an alarm of the motion in which it happened; while the robot
    /// stands, of the instruction at the program pointer. The robot is stopped.
    pub(crate) fn collision(&self, place: (File, u32)) -> Option<Alarm> {
        let mut unit = self.robot_mut()?;
        let Collision { axis, surplus, allowed } = unit.take_collision()?;
        let (file, line) = unit.motion_pointer().filter(|_| !unit.ended()).unwrap_or(place);
        unit.stop_fast();
        let (name, measure) = match unit.robot().own_axes().get(axis) {
            Some(axis) => (axis.name.as_str(), if axis.linear { "N" } else { "Nm" }),
            None => ("an axis", "Nm"),
        };
        let more = if surplus > 0.0 { "more" } else { "less" };
        let text = format!(
            "collision: {name} exerts {:.1} {measure} {more} than the motion and the load require; {allowed:.1} {measure} \
             are allowed",
            surplus.abs()
        );
        Some(Alarm::new(Fault::Collision(text.into()), file, line))
    }

    /// A new fault of the robot, if there is one, as an alarm of the motion in which it happened; while the robot
    /// stands, of the instruction at the program pointer.
    pub(crate) fn robot_alarm(&self, place: (File, u32)) -> Option<Alarm> {
        let (fault, motion) = self.robot_mut()?.take_fault()?;
        let (file, line) = motion.unwrap_or(place);
        Some(Alarm::new(fault, file, line))
    }

    /// Updates the variables that depend on the robot's position.
    pub(crate) fn update_system(&self, unit: &Unit) {
        let system = &self.system;
        // Outside a motion they keep the values of the last one.
        if let Some(progress) = unit.progress() {
            self.set_progress_variables(&progress);
        }
        system.at_home.update(|at_home| {
            for (at, home) in at_home.iter_mut().zip(&self.homes) {
                *at = home.as_ref().is_some_and(|home| unit.is_at(home, self.home_tolerance));
            }
        });
    }

    /// Sets the variables for the progress of the motion.
    pub(crate) fn set_progress_variables(&self, progress: &Progress) {
        let system = &self.system;
        system.traj_elapse_time.set(progress.elapsed_time);
        system.traj_left_time.set(progress.remaining_time);
        system.traj_elapse_dis.set(progress.elapsed_distance);
        system.traj_left_dis.set(progress.remaining_distance);
    }

    /// Whether all planned motion has ended and the robot has settled.
    #[inline]
    pub(crate) fn motion_ended(&self) -> bool {
        self.robot().is_none_or(|unit| unit.ended())
    }

    /// As `motion_ended`, for a level of the program: motions that it has stopped are not waited for.
    #[inline]
    pub(crate) fn motion_ended_for(&self, level: u32) -> bool {
        self.robot().is_none_or(|unit| unit.ended_for(level))
    }

    /// Whether the motion with this running number has ended, and the robot has settled, unless other motions follow
    /// it.
    pub(crate) fn has_motion_ended(&self, motion: u64) -> bool {
        let Some(unit) = self.robot() else { return true };
        unit.has_ended(motion) && (unit.motions().0 > motion || unit.moves() || unit.is_settled())
    }

    /// Drops motion that was stopped and not started again; returns whether there was any.
    pub(crate) fn drop_suspended(&self) -> bool {
        self.robot_mut().is_some_and(|mut unit| unit.drop_aside())
    }

    /// The running numbers of the motion planned last and of the one that ended last.
    pub(crate) fn motions(&self) -> (u64, u64) {
        self.robot().map_or((0, 0), |unit| unit.motions())
    }

    /// The program waits for the robot: motions that waited for the next one are planned without it.
    pub(crate) fn conclude_motion(&self) {
        let concluded = self.robot_mut().map_or(Ok(()), |mut unit| unit.conclude());
        if let Err(alarm) = concluded {
            self.raise_alarm(alarm);
        }
    }

    /// Ends the program with an alarm that did not come from the current statement. The first one counts.
    pub(crate) fn raise_alarm(&self, alarm: Alarm) {
        self.pending_alarm.borrow_mut().get_or_insert(alarm);
    }

    /// Whether the program is about to be ended by [`ChannelState::raise_alarm`].
    pub(crate) fn has_pending_alarm(&self) -> bool {
        self.pending_alarm.borrow().is_some()
    }

    /// Warns of targets that should be blended but are not.
    pub(crate) fn warn_of_missing_blends(&self, shared: &SharedState) {
        let Some(mut unit) = self.robot_mut() else { return };
        // Where the stop saves time the programmer need not change anything: that is for the report.
        let unblended = unit.take_unblended().into_iter().filter(|(_, target)| target.why != NoBlend::Slower);
        for (file, UnblendedTarget { line, corner, why, .. }) in unblended {
            let file = file.name();
            shared.warn(match (corner, why) {
                (_, NoBlend::Late) | (None, _) => format!("{file}:{line}: the motion came too late to be blended with the one before it: the robot stops between the two"),
                (Some(corner), why) => format!("{file}:{line}: the target of the motion of line {corner} is not rounded off but reached with a stop: {why}"),
            });
        }
    }

    /// Takes the alarm that did not come from the current statement.
    pub(crate) fn take_pending_alarm(&self) -> Option<Alarm> {
        let broken = self.robot_mut().and_then(|mut unit| unit.take_broken());
        self.pending_alarm.borrow_mut().take().or(broken)
    }
}
