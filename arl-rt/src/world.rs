//! What the controller and its programs share.

use std::cell::{Cell, RefCell};
use std::fmt;

use crate::cell::Sensitivity;
use crate::communication::NetworkSettings;
use crate::fault::{Alarm, Fault, File};
use crate::fieldbus::Buses;
use crate::files::ScriptDir;
use crate::io::Image;
use crate::motion::Progress;
use crate::output::{Message, Output};
use crate::random::Random;
use crate::rate::Rate;
use crate::robot::VelocityProfile;
use crate::state::State;
use crate::system::{self, System};
use crate::unit::{Collision, SENSITIVITY, Unit, joint};
use crate::values::VelProfile;

/// What the controller and its programs share. Borrows of the cells end within the call that makes them.
pub(crate) struct World {
    /// The running number of the cycle.
    pub(crate) now: Cell<u64>,
    pub(crate) rate: Rate,
    pub(crate) system: System,
    pub(crate) io: RefCell<Image>,
    pub(crate) unit: RefCell<Unit>,
    pub(crate) scripts: ScriptDir,
    pub(crate) random: Random,
    /// The date at cycle 0, in s since 1970-01-01 00:00:00.
    pub(crate) start_date: i64,
    output: RefCell<Box<dyn Output>>,
    /// Whether messages came in this cycle.
    spoken: Cell<bool>,
    /// Whether the program waits for the start button.
    pub(crate) paused: Cell<bool>,
    /// Alarms that nobody has asked for yet.
    pub(crate) alarms: RefCell<Vec<Alarm>>,
    /// What went wrong apart from the statement that runs, and ends the program.
    trouble: RefCell<Option<Alarm>>,
    /// What happened that is no alarm but worth a word.
    warnings: RefCell<Vec<String>>,
    pub(crate) state: RefCell<State>,
    /// What the cell says of the network.
    pub(crate) network: NetworkSettings,
    /// Whether a program talks to the world, so that the world's time counts.
    outside: Cell<bool>,
    /// Home points 1 to 5.
    homes: [Option<Vec<f64>>; 5],
    home_tolerance: f64,
    /// The conditions of `startdetect` that the cell gives.
    collisions: Vec<(u8, Sensitivity)>,
    pub(crate) buses: Buses,
    /// Whether cycles take the time that they stand for.
    real_time: Cell<bool>,
}

/// What a world is made of.
pub(crate) struct Parts {
    pub(crate) rate: Rate,
    pub(crate) system: System,
    pub(crate) io: Image,
    pub(crate) unit: Unit,
    pub(crate) scripts: ScriptDir,
    pub(crate) random: Random,
    pub(crate) start_date: i64,
    pub(crate) output: Box<dyn Output>,
    pub(crate) state: State,
    pub(crate) network: NetworkSettings,
    /// Home points 2 to 5.
    pub(crate) homes: [Option<Vec<f64>>; 4],
    pub(crate) home_tolerance: f64,
    pub(crate) collisions: Vec<(u8, Sensitivity)>,
    pub(crate) buses: Buses,
    pub(crate) real_time: bool,
}

impl World {
    pub(crate) fn new(parts: Parts) -> Self {
        let [second, third, fourth, fifth] = parts.homes;
        let homes = [Some(parts.unit.robot().home.clone()), second, third, fourth, fifth];
        Self {
            homes,
            home_tolerance: parts.home_tolerance,
            collisions: parts.collisions,
            buses: parts.buses,
            real_time: Cell::new(parts.real_time),
            state: RefCell::new(parts.state),
            network: parts.network,
            outside: Cell::new(false),
            now: Cell::new(0),
            rate: parts.rate,
            system: parts.system,
            io: RefCell::new(parts.io),
            unit: RefCell::new(parts.unit),
            scripts: parts.scripts,
            random: parts.random,
            start_date: parts.start_date,
            output: RefCell::new(parts.output),
            spoken: Cell::new(false),
            paused: Cell::new(false),
            alarms: RefCell::default(),
            trouble: RefCell::default(),
            warnings: RefCell::default(),
        }
    }

    /// Sets the system variables of the manual's chapter 10.2 to their defaults.
    pub(crate) fn reset_system(&self) {
        self.system.reset();
        let unit = self.unit.borrow();
        self.system.vel_profile.set(match unit.robot().profile {
            VelocityProfile::T => VelProfile::T,
            VelocityProfile::S => VelProfile::S,
            VelocityProfile::O => VelProfile::O,
        });
        self.system.cjoint.set(joint(unit.target()));
    }

    /// The speed override in %.
    pub(crate) fn set_override(&self, percent: f64) {
        self.unit.borrow_mut().set_override(percent.clamp(0.0, 100.0));
    }

    /// Saves the system variables of which every change is kept.
    pub(crate) fn keep_state(&self) {
        if let Err(error) = system::keep(&self.system, &mut self.state.borrow_mut()) {
            self.warn(format!("system variables cannot be kept: {error}"));
        }
    }

    /// Stops all motion on its path and drops what was to follow.
    pub(crate) fn stop_motion(&self) {
        self.io.borrow_mut().forget_motion();
        self.unit.borrow_mut().stop();
    }

    /// The sensitivity of a condition of `startdetect`.
    pub(crate) fn sensitivity(&self, cid: u8) -> Sensitivity {
        let given = self.collisions.iter().rev().find(|(known, _)| *known == cid);
        given.map_or(Sensitivity::Percent(SENSITIVITY), |(_, sensitivity)| sensitivity.clone())
    }

    /// The collision of this cycle, if there was one, as the alarm of the motion that met it. The robot is told to stop.
    pub(crate) fn collision(&self, program: File) -> Option<Alarm> {
        let mut unit = self.unit.borrow_mut();
        let Collision { axis, surplus, allowed } = unit.take_collision()?;
        unit.stop_fast();
        let (file, line) = unit.motion_pointer().unwrap_or((program, 0));
        let (name, measure) = match unit.robot().own_axes().get(axis) {
            Some(axis) => (axis.name.as_str(), if axis.linear { "N" } else { "Nm" }),
            None => ("an axis", "Nm"),
        };
        let more = if surplus > 0.0 { "more" } else { "less" };
        let text = format!(
            "collision: {name} gives {:.1} {measure} {more} than the motion and the load ask for, {allowed:.1} {measure} \
             are allowed",
            surplus.abs()
        );
        Some(Alarm { fault: Fault::Collision(text.into()), file, line })
    }

    /// Brings the variables up to date that tell where the robot is.
    pub(crate) fn update_system(&self, unit: &Unit) {
        let system = &self.system;
        // Outside a motion they keep what the last one left.
        if let Some(progress) = unit.progress() {
            self.tell_progress(&progress);
        }
        system.at_home.update(|at_home| {
            for (at, home) in at_home.iter_mut().zip(&self.homes) {
                *at = home.as_ref().is_some_and(|home| unit.is_at(home, self.home_tolerance));
            }
        });
    }

    /// Sets the variables that tell how far the motion has come.
    pub(crate) fn tell_progress(&self, progress: &Progress) {
        let system = &self.system;
        system.traj_elapse_time.set(progress.elapsed_time);
        system.traj_left_time.set(progress.left_time);
        system.traj_elapse_dis.set(progress.elapsed_distance);
        system.traj_left_dis.set(progress.left_distance);
    }

    /// Whether all planned motion has ended and the robot has settled.
    #[inline]
    pub(crate) fn motion_ended(&self) -> bool {
        self.unit.borrow().ended()
    }

    /// Whether the motion with this running number and all before it have ended, and the robot has settled, unless there are
    /// others behind it.
    pub(crate) fn motion_ended_up_to(&self, motion: u64) -> bool {
        let unit = self.unit.borrow();
        let (planned, finished) = unit.motions();
        if planned > motion { finished >= motion } else { unit.ended() }
    }

    /// Says that the program waits for the robot: motions that waited for the next one go without it.
    pub(crate) fn conclude_motion(&self) {
        let concluded = self.unit.borrow_mut().conclude();
        if let Err(alarm) = concluded {
            self.trouble(alarm);
        }
    }

    /// Ends the program with an alarm that is not that of the statement that runs. The first one counts.
    pub(crate) fn trouble(&self, alarm: Alarm) {
        self.trouble.borrow_mut().get_or_insert(alarm);
    }

    /// Whether the program is about to be ended by [`World::trouble`].
    pub(crate) fn in_trouble(&self) -> bool {
        self.trouble.borrow().is_some()
    }

    /// What went wrong apart from the statement that runs.
    pub(crate) fn take_trouble(&self) -> Option<Alarm> {
        let broken = self.unit.borrow_mut().take_broken();
        self.trouble.borrow_mut().take().or(broken)
    }

    /// Passes a message on.
    pub(crate) fn message(&self, hmi: bool, console: bool, text: &[u8]) {
        let time = self.rate.time(self.now.get());
        self.output.borrow_mut().message(&Message { time, hmi, console, text });
        self.spoken.set(true);
    }

    /// Ends a cycle's messages.
    pub(crate) fn flush(&self) {
        if self.spoken.replace(false) {
            self.output.borrow_mut().flush();
        }
    }

    /// Says that the program talks to the world: from now on the world's time counts.
    pub(crate) fn meet_outside(&self) {
        self.outside.set(true);
        self.real_time.set(true);
    }

    /// Whether somebody has said so since the last call.
    #[inline]
    pub(crate) fn met_outside(&self) -> bool {
        self.outside.replace(false)
    }

    /// Whether cycles take the time that they stand for, or will from the next one on.
    pub(crate) fn is_real_time(&self) -> bool {
        self.real_time.get()
    }

    /// Notes what is no alarm but worth a word.
    pub(crate) fn warn(&self, text: String) {
        self.warnings.borrow_mut().push(text);
    }

    /// The warnings since the last call.
    #[inline]
    pub(crate) fn take_warnings(&self) -> Vec<String> {
        std::mem::take(&mut self.warnings.borrow_mut())
    }
}

impl fmt::Debug for World {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("World").field("now", &self.now.get()).finish_non_exhaustive()
    }
}
