//! The reason why a controller cannot be set up.

use std::fmt;

use crate::context::named::GlobalError;
use crate::io::DriverError;
use crate::storage::state::StateError;
use arl_robot::cell::SettingsError;
use arl_robot::robot::{Family, RobotError};

/// The reason why a controller cannot be set up.
#[derive(Clone, PartialEq, Debug)]
#[non_exhaustive]
pub enum SetupError {
    /// The description of the robot has an error.
    Robot(RobotError),
    /// The program was checked for another family of robot.
    Family {
        /// The family that the program was checked for.
        program: Family,
        /// The robot's name.
        robot: String,
        /// The robot's family.
        family: Family,
    },
    /// There are too many channels, or programs for them are missing.
    Channels(String),
    /// The cell or the scenario does not fit.
    Cell(String),
    /// A bus or island that the cell has, or a thread, cannot be started.
    Outside(String),
    /// Stored data is damaged.
    State(StateError),
    /// The robot of a channel cannot be started.
    Driver {
        /// The number of the channel, from 1.
        channel: u8,
        /// The error of its driver.
        problem: DriverError,
    },
    /// The io driver cannot be started; its error.
    Io(DriverError),
    /// A global variable does not exist, or does not take its value.
    Global(GlobalError),
    /// Any other reason, in words.
    Other(String),
}

impl fmt::Display for SetupError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            SetupError::Robot(error) => write!(f, "{error}"),
            SetupError::Family { program, robot, family } => write!(
                f,
                "the program was checked for a {} robot, but robot {robot} is a {} one",
                word(*program),
                word(*family)
            ),
            SetupError::Channels(text)
            | SetupError::Cell(text)
            | SetupError::Outside(text)
            | SetupError::Other(text) => {
                write!(f, "{text}")
            }
            SetupError::Global(error) => write!(f, "{error}"),
            SetupError::State(error) => write!(f, "{error}"),
            SetupError::Driver { channel, problem } => {
                write!(f, "the robot of channel {channel} cannot be started: {problem}")
            }
            SetupError::Io(problem) => write!(f, "the io driver cannot be started: {problem}"),
        }
    }
}

impl std::error::Error for SetupError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            SetupError::Robot(error) => Some(error),
            SetupError::State(error) => Some(error),
            SetupError::Driver { problem, .. } | SetupError::Io(problem) => Some(problem),
            SetupError::Global(error) => Some(error),
            _ => None,
        }
    }
}

impl From<RobotError> for SetupError {
    fn from(error: RobotError) -> Self {
        SetupError::Robot(error)
    }
}

impl From<SettingsError> for SetupError {
    fn from(error: SettingsError) -> Self {
        SetupError::Cell(error.to_string())
    }
}

impl From<String> for SetupError {
    fn from(why: String) -> Self {
        SetupError::Other(why)
    }
}

impl From<StateError> for SetupError {
    fn from(error: StateError) -> Self {
        SetupError::State(error)
    }
}

/// The family as robot files spell it.
pub(super) fn word(family: Family) -> &'static str {
    match family {
        Family::SixAxis => "six-axis",
        Family::Scara => "scara",
    }
}
