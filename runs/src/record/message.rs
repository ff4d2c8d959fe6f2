//! The messages of a recording and their topics, in one place for the code that writes recordings, reads them, or takes
//! their messages as they are made.

use std::borrow::Cow;

use arl_robot::cell::MOST_FOREGROUND;
use prost::{DecodeError, Message as _};

use super::messages::{Cell, Channel, Contact, Controller, FrameTransforms, Io, JointStates, Log, Motion, SceneUpdate};
use super::schemas::{self, Schema};

const CELL: &str = "/arl/cell";
const CONTROLLER: &str = "/arl/controller";
const IO: &str = "/arl/io";
const MOTIONS: &str = "/arl/motions";
const CONTACTS: &str = "/arl/contacts";
/// The topics of channels end in the channel's number, from 1: `/arl/channel_1`.
const CHANNEL: &str = "/arl/channel_";
const SCENE: &str = "/scene";
const FRAMES: &str = "/tf";
const JOINTS: &str = "/joint_states";
const LOG: &str = "/log";

/// The most programs of a controller: those of robots, and those in the background.
pub(crate) const MOST_PROGRAMS: usize = MOST_FOREGROUND + u8::MAX as usize;

/// A message of a recording.
#[derive(Clone, PartialEq, Debug)]
pub(crate) enum RunMessage {
    /// What runs on which robots; the first message.
    Cell(Cell),
    /// Bodies come, go or move.
    Scene(SceneUpdate),
    /// The mode and the override have changed.
    Controller(Controller),
    /// Inputs and outputs have changed.
    Io(Io),
    /// A channel, from 1, has moved or continued.
    Channel(usize, Channel),
    /// What a motion did.
    Motion(Motion),
    /// Two things came too near to each other.
    Contact(Contact),
    /// What a program printed, warnings and alarms.
    Log(Log),
    /// Frames, for viewers: they follow from channels.
    Frames(FrameTransforms),
    /// Joints, for viewers: they follow from channels.
    Joints(JointStates),
}

impl RunMessage {
    /// The name of its topic.
    pub(crate) fn topic(&self) -> Cow<'static, str> {
        match self {
            Self::Cell(_) => CELL.into(),
            Self::Scene(_) => SCENE.into(),
            Self::Controller(_) => CONTROLLER.into(),
            Self::Io(_) => IO.into(),
            Self::Channel(number, _) => format!("{CHANNEL}{number}").into(),
            Self::Motion(_) => MOTIONS.into(),
            Self::Contact(_) => CONTACTS.into(),
            Self::Log(_) => LOG.into(),
            Self::Frames(_) => FRAMES.into(),
            Self::Joints(_) => JOINTS.into(),
        }
    }

    /// The description of its fields for readers.
    pub(super) fn schema(&self) -> &'static Schema {
        match self {
            Self::Cell(_) => &schemas::CELL,
            Self::Scene(_) => &schemas::SCENE_UPDATE,
            Self::Controller(_) => &schemas::CONTROLLER,
            Self::Io(_) => &schemas::IO,
            Self::Channel(..) => &schemas::CHANNEL,
            Self::Motion(_) => &schemas::MOTION,
            Self::Contact(_) => &schemas::CONTACT,
            Self::Log(_) => &schemas::LOG,
            Self::Frames(_) => &schemas::FRAME_TRANSFORMS,
            Self::Joints(_) => &schemas::JOINT_STATES,
        }
    }

    /// The message as protocol buffers.
    pub(crate) fn encoded(&self) -> Vec<u8> {
        match self {
            Self::Cell(message) => message.encode_to_vec(),
            Self::Scene(message) => message.encode_to_vec(),
            Self::Controller(message) => message.encode_to_vec(),
            Self::Io(message) => message.encode_to_vec(),
            Self::Channel(_, message) => message.encode_to_vec(),
            Self::Motion(message) => message.encode_to_vec(),
            Self::Contact(message) => message.encode_to_vec(),
            Self::Log(message) => message.encode_to_vec(),
            Self::Frames(message) => message.encode_to_vec(),
            Self::Joints(message) => message.encode_to_vec(),
        }
    }

    /// Reads a message of a topic. `None`: it is of other origin, or follows from other messages.
    ///
    /// # Errors
    /// The message is not of the topic's kind.
    pub(crate) fn decoded(topic: &str, bytes: &[u8]) -> Result<Option<Self>, DecodeError> {
        Ok(Some(match topic {
            CELL => Self::Cell(Cell::decode(bytes)?),
            SCENE => Self::Scene(SceneUpdate::decode(bytes)?),
            CONTROLLER => Self::Controller(Controller::decode(bytes)?),
            IO => Self::Io(Io::decode(bytes)?),
            MOTIONS => Self::Motion(Motion::decode(bytes)?),
            CONTACTS => Self::Contact(Contact::decode(bytes)?),
            LOG => Self::Log(Log::decode(bytes)?),
            _ => match topic.strip_prefix(CHANNEL).and_then(|number| number.parse().ok()) {
                Some(number @ 1..=MOST_PROGRAMS) => Self::Channel(number, Channel::decode(bytes)?),
                _ => return Ok(None),
            },
        }))
    }
}
