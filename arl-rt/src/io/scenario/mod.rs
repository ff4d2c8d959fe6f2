//! The I/O scenario: what the surroundings of the robot do, and when.
//!
//! ```toml
//! [[event]]
//! at = 2.0            # seconds of controller time
//! di.5 = true
//!
//! [[event]]
//! when = "do.3"       # each time the output goes on; "!do.3": off; di.N too
//! after = 0.5         # seconds later
//! ai.2 = 4.2
//! internal.1 = true   # what getintdi reads
//! internal_do.1 = true   # what getintdo reads
//! pendant = "start"
//! override = 50       # %
//! force = [0, 0, 80]  # N, what pushes the TCP, in the world; until another event says otherwise
//! torque.j3 = -20     # Nm (N of a linear axis), what turns an axis
//! jog.j1 = 5          # deg (mm): somebody jogs an axis (j1.., ej1..) by so much, while the program is paused
//! hand.j1 = 5         # deg (mm): somebody moves an axis by hand, while the servo is off
//! channel = 2         # whose robot is pushed, jogged or moved; without it that of channel 1
//!
//! [[follow]]
//! signal = "di.2"     # an input that has the level of another signal, from the start on
//! of = "do.2"         # "!do.2": the opposite
//! after = 0.4         # seconds later
//! ```
//!
//! Instead of `di.5`, keys and texts may use the signal's name from the cell file: `part_present = true`.

mod playing;
mod read;
#[cfg(test)]
mod tests;

use std::fmt;
use std::path::Path;

use super::image::PWM_CHANNELS;
use super::{Channels, Digital, Image};
use arl_motion::Override;
use arl_robot::cell::Names;
use arl_robot::changes::{Changes, Part};
use arl_robot::regular_file;
use arl_robot::robot::Robot;
use arl_robot::settings::SettingsError;
pub(crate) use playing::Playing;

/// An action at the teach pendant.
#[derive(Clone, Copy, PartialEq, Debug)]
#[non_exhaustive]
pub enum Pendant {
    /// The start button: a paused program continues; the robot first returns to its path.
    Start,
    /// The pause button: the robot stops on its path at once, and so does the program.
    Pause,
    /// Continues for one instruction that moves, waits or accesses the outside; from then on single-step mode, until
    /// start.
    Step,
    /// Ends a program that is paused; restarts a program that has ended.
    Reset,
    /// Acknowledges an alarm.
    Clear,
    /// Switches the motors on.
    ServoOn,
    /// Stops the robot on its path and switches the motors off.
    ServoOff,
    /// Switches the motors off at once, even while the robot moves.
    EmergencyStop,
    /// The speed override.
    Override(Override),
}

impl Pendant {
    /// Whether the action starts programs that wait for their start.
    pub(crate) fn lets_begin(self) -> bool {
        matches!(self, Pendant::Start | Pendant::Step)
    }
}

/// What an event does besides setting inputs.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) enum Effect {
    /// The pendant is used.
    Pendant(Pendant),
    /// The robot of a foreground channel, counted from 1, is pushed or moved.
    Robot(u8, RobotEffect),
}

/// An action on a robot.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) enum RobotEffect {
    /// A force on the TCP, in world coordinates, N.
    Force([f64; 3]),
    /// A torque (Nm; N on a linear axis) on an axis, counted from 0.
    Torque(usize, f64),
    /// An axis is jogged by a distance in deg (mm).
    Jog(AxisName, f64),
    /// An axis is moved by hand by a distance in deg (mm).
    Hand(AxisName, f64),
}

/// An axis by its name.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum AxisName {
    /// One of the robot's own axes, counted from 0: `j1` is 0.
    Own(usize),
    /// An external axis, counted from 0: `ej1` is 0.
    External(usize),
}

impl AxisName {
    /// The index of the axis among all axes of a robot, counted from 0; `None` if the robot does not have it.
    pub(crate) fn place(self, robot: &Robot) -> Option<usize> {
        let own = robot.own_axes().len();
        match self {
            AxisName::Own(axis) => Some(axis).filter(|axis| *axis < own),
            AxisName::External(axis) => Some(own + axis).filter(|axis| *axis < robot.axes.len()),
        }
    }
}

impl fmt::Display for AxisName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            AxisName::Own(axis) => write!(f, "j{}", axis + 1),
            AxisName::External(axis) => write!(f, "ej{}", axis + 1),
        }
    }
}

/// What an event does.
#[derive(Clone, Copy, PartialEq, Debug)]
enum Action {
    Digital(Digital, i32, bool),
    Analog(i32, f64),
    Effect(Effect),
}

impl Action {
    /// Checks that the channel or axis exists, and the masses that the action needs.
    fn check(&self, image: &Image, robots: &[&Robot]) -> Result<(), String> {
        let found = match *self {
            Action::Digital(what, channel, _) => image.digital(what, channel).map(drop),
            Action::Analog(channel, value) => image.check_ai(channel, value),
            Action::Effect(Effect::Pendant(_)) => return Ok(()),
            Action::Effect(Effect::Robot(channel, robot_effect)) => return moves(robots, channel, robot_effect),
        };
        found.map_err(|fault| format!("cannot set an input: {fault}"))
    }

    /// Carries out a checked action; passes everything except inputs to `do_it`.
    fn play(&self, image: &mut Image, do_it: &mut impl FnMut(Effect)) {
        let _ = match *self {
            Action::Digital(what, channel, level) => image.set_digital(what, channel, level),
            Action::Analog(channel, value) => image.set_analog_input(channel, value),
            Action::Effect(effect) => {
                do_it(effect);
                Ok(())
            }
        };
    }
}

/// Actions from outside, carried out now: an event without its cause.
#[derive(Clone, PartialEq, Debug)]
pub(crate) struct Order {
    actions: Vec<Action>,
}

impl Order {
    /// Reads lines like `di.5 = true` or `pendant = "pause"`.
    pub(crate) fn parse(text: &str, names: &Names) -> Result<Self, SettingsError> {
        Ok(Self { actions: read::order(text, names)? })
    }

    /// Sets inputs; passes everything else to `do_it`. An order that cannot be carried out in full has no effect.
    pub(crate) fn carry_out(
        &self,
        image: &mut Image,
        robots: &[&Robot],
        mut do_it: impl FnMut(Effect),
    ) -> Result<(), String> {
        for action in &self.actions {
            action.check(image, robots).map_err(|problem| format!("the order {problem}"))?;
        }
        self.actions.iter().for_each(|action| action.play(image, &mut do_it));
        Ok(())
    }
}

/// The cause of an event.
#[derive(Clone, Copy, PartialEq, Debug)]
enum Cause {
    /// A point in time, in s.
    At(f64),
    /// An edge of a signal: input or output, channel counted from 0, level after the edge.
    Edge { output: bool, channel: usize, level: bool },
    /// A change of the frequency or duty cycle of a PWM output, counted from 0.
    Pwm(usize),
}

#[derive(Clone, PartialEq, Debug)]
struct Event {
    cause: Cause,
    /// Seconds from the cause to the event; an edge has its effect in the next cycle at the earliest.
    after: f64,
    actions: Vec<Action>,
    /// The line of its table.
    line: u32,
}

/// A sequence of events: what the surroundings of the robot do, and when.
#[derive(Clone, PartialEq, Default, Debug)]
pub struct Scenario {
    /// The file name in messages.
    file: String,
    events: Vec<Event>,
}

impl Scenario {
    /// Reads a scenario file.
    ///
    /// # Errors
    /// The file cannot be read, or its content is not a scenario.
    pub fn load(path: &Path) -> Result<Scenario, SettingsError> {
        Scenario::load_with(path, &Names::default())
    }

    /// Reads a scenario file that may use the cell's names of signals.
    ///
    /// # Errors
    /// The file cannot be read, or its content is not a scenario.
    pub fn load_with(path: &Path, names: &Names) -> Result<Scenario, SettingsError> {
        Scenario::load_changed(path, names, &Changes::default())
    }

    /// Like `load_with`, with changed values at some places.
    ///
    /// # Errors
    /// As for [`load_with`](Self::load_with); or the file does not have one of the places.
    pub(crate) fn load_changed(path: &Path, names: &Names, changes: &Changes) -> Result<Scenario, SettingsError> {
        let name = path.display().to_string();
        let text = regular_file::read_text(path)
            .map_err(|error| SettingsError::of_file(&name, format!("cannot read the io scenario: {error}")))?;
        Scenario::parse_with(&name, &changes.apply(Part::Io, &name, text)?, names)
    }

    /// The scenario that `text` describes; `file` names the text in errors.
    ///
    /// # Errors
    /// The text is not TOML, or not a scenario: with line, column and what was expected.
    pub fn parse(file: &str, text: &str) -> Result<Scenario, SettingsError> {
        Scenario::parse_with(file, text, &Names::default())
    }

    /// Like `parse`, for a cell that has names for signals.
    ///
    /// ```
    /// use arl_rt::cell::Cell;
    /// use arl_rt::io::Scenario;
    /// let cell = Cell::parse("cell.toml", "[names]\n\"di.1\" = \"part_present\"\n")?;
    /// let text = "[[event]]\nat = 1\npart_present = true\n";
    /// assert!(Scenario::parse_with("s.toml", text, &cell.names).is_ok());
    /// assert!(Scenario::parse("s.toml", text).is_err());
    /// # Ok::<(), arl_rt::cell::SettingsError>(())
    /// ```
    ///
    /// # Errors
    /// The text is not TOML, or not a scenario: with line, column and what was expected.
    pub fn parse_with(file: &str, text: &str, names: &Names) -> Result<Scenario, SettingsError> {
        Ok(Scenario { file: file.to_owned(), events: read::scenario(file, text, names)? })
    }

    /// Checks that all channels and axes that the scenario names exist, and the masses that it needs; `robots` are
    /// those of the foreground channels.
    pub(crate) fn check(&self, channels: &Channels, robots: &[&Robot]) -> Result<(), String> {
        let image = Image::new(channels);
        for event in &self.events {
            let place = format!("{}:{}: the scenario", self.file, event.line);
            if let Cause::Edge { output, channel, level: _ } = event.cause {
                let (name, count) = if output { ("do", channels.dout) } else { ("di", channels.di) };
                if channel >= count as usize {
                    return Err(format!("{place} waits for {name}.{}, but there are {count}", channel + 1));
                }
            }
            if let Cause::Pwm(channel) = event.cause
                && channel >= PWM_CHANNELS
            {
                return Err(format!("{place} waits for pwm.{}, but there are {PWM_CHANNELS}", channel + 1));
            }
            for action in &event.actions {
                action.check(&image, robots).map_err(|problem| format!("{place} {problem}"))?;
            }
        }
        Ok(())
    }
}

/// Checks whether an action is possible on the robot of a channel.
fn moves(robots: &[&Robot], channel: u8, robot_effect: RobotEffect) -> Result<(), String> {
    let Some(robot) = robots.get(usize::from(channel).wrapping_sub(1)) else {
        let count = robots.len();
        return Err(format!("is about the robot of channel {channel}, but there are {count} channels with a robot"));
    };
    let own = robot.own_axes().len();
    match robot_effect {
        RobotEffect::Jog(axis, _) | RobotEffect::Hand(axis, _) if axis.place(robot).is_none() => {
            let external = match robot.external_axes().len() {
                0 => String::new(),
                count => format!(" and ej1 to ej{count}"),
            };
            Err(format!("moves {axis}, but robot {} has j1 to j{own}{external}", robot.name))
        }
        RobotEffect::Jog(..) | RobotEffect::Hand(..) => Ok(()),
        RobotEffect::Torque(axis, _) if axis >= own => {
            Err(format!("turns j{}, but robot {} has j1 to j{own}", axis + 1, robot.name))
        }
        RobotEffect::Force(_) | RobotEffect::Torque(..) if robot.links.is_empty() => {
            Err(format!("pushes the robot, but the file of robot {} has no [[link]]", robot.name))
        }
        RobotEffect::Force(_) | RobotEffect::Torque(..) => Ok(()),
    }
}
