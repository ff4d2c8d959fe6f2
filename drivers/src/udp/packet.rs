//! The packets: all numbers little-endian, all lengths fixed. `docs/udp-and-rsi.md` has them as tables.

use arl_rt::motion::Joints;
use arl_rt::robot_driver::{Drives, Power, Setpoint};

/// The length of a command packet, in bytes.
pub const COMMAND_LENGTH: usize = 320;
/// The length of a state packet from the arm, in bytes.
pub const STATE_LENGTH: usize = 344;

const COMMAND: [u8; 4] = *b"ARLC";
const STATE: [u8; 4] = *b"ARLS";
const VERSION: u16 = 1;
/// The most bytes of a fault's text.
const TEXT: usize = 64;

/// Flags of a command.
const CYCLIC: u32 = 1;
const HAS_TORQUE: u32 = 2;
/// Flags of a state.
const MEASURES_VELOCITY: u32 = 1;
const MEASURES_TORQUE: u32 = 2;

/// A command to an arm.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Command {
    /// The number of the run: the arm answers to one run at a time.
    pub session: u32,
    /// The number of packets of this run, including this one.
    pub sequence: u64,
    /// The number of axes of the robot, and of external ones.
    pub axes: (u8, u8),
    /// The command to the motors.
    pub power: Power,
    /// Whether another command follows within a cycle: an arm that then gets none has to brake.
    pub is_cyclic: bool,
    /// The set-point of the arm.
    pub setpoint: Setpoint,
}

/// The state of an arm.
#[derive(Clone, PartialEq, Debug)]
pub struct State {
    /// The run to which it answers.
    pub session: u32,
    /// The number of packets that the arm has sent, including this one: an older one that arrives later does not count.
    pub sequence: u64,
    /// The newest command that the arm has received.
    pub answers: u64,
    /// The number of axes of the arm, and of external ones.
    pub axes: (u8, u8),
    /// The state of its drives.
    pub drives: Drives,
    /// The positions of its axes, in deg (mm).
    pub position: Joints,
    /// The speeds of its axes, in deg/s (mm/s), if it measures them.
    pub velocity: Option<Joints>,
    /// The torques of its motors at the axes, in Nm (N), if it measures them.
    pub torque: Option<[f64; 6]>,
}

impl Command {
    /// The bytes of the packet.
    pub fn to_bytes(&self) -> [u8; COMMAND_LENGTH] {
        let Setpoint { position, velocity, acceleration, torque, period, .. } = &self.setpoint;
        let mut bytes = [0; COMMAND_LENGTH];
        let mut out = Writer(&mut bytes);
        out.put(&COMMAND);
        out.put(&VERSION.to_le_bytes());
        out.put(&[self.axes.0, self.axes.1]);
        out.put(&self.session.to_le_bytes());
        let power: u32 = match self.power {
            Power::Off => 0,
            Power::On => 1,
            Power::Cut => 2,
        };
        out.put(&power.to_le_bytes());
        out.put(&self.sequence.to_le_bytes());
        out.put(&((period * 1e6).round() as u32).to_le_bytes());
        let flags = u32::from(self.is_cyclic) * CYCLIC + u32::from(torque.is_some()) * HAS_TORQUE;
        out.put(&flags.to_le_bytes());
        out.joints(position);
        out.joints(velocity);
        out.numbers(acceleration);
        out.numbers(&torque.unwrap_or_default());
        bytes
    }
}

impl State {
    /// Parses a packet; `None` if it is not a state of an arm.
    pub fn from_bytes(bytes: &[u8]) -> Option<Self> {
        if bytes.len() != STATE_LENGTH {
            return None;
        }
        let mut from = Reader(bytes);
        if from.take()? != STATE || u16::from_le_bytes(from.take()?) != VERSION {
            return None;
        }
        let [own, external] = from.take()?;
        let session = u32::from_le_bytes(from.take()?);
        let drives = u32::from_le_bytes(from.take()?);
        let sequence = u64::from_le_bytes(from.take()?);
        let answers = u64::from_le_bytes(from.take()?);
        let flags = u32::from_le_bytes(from.take()?);
        let length = u32::from_le_bytes(from.take()?) as usize;
        let position = from.joints()?;
        let velocity = from.joints()?;
        let torque = from.numbers()?;
        let text: [u8; TEXT] = from.take()?;
        let drives = match drives {
            0 => Drives::Off,
            1 => Drives::On,
            2 => Drives::Fault(String::from_utf8_lossy(text.get(..length)?).into()),
            _ => return None,
        };
        Some(Self {
            session,
            sequence,
            answers,
            axes: (own, external),
            drives,
            position,
            velocity: (flags & MEASURES_VELOCITY != 0).then_some(velocity),
            torque: (flags & MEASURES_TORQUE != 0).then_some(torque),
        })
    }
}

/// Writes values one after the other. Values that do not fit are left out; a test checks the lengths above.
struct Writer<'a>(&'a mut [u8]);

impl Writer<'_> {
    fn put(&mut self, bytes: &[u8]) {
        if let Some((place, rest)) = std::mem::take(&mut self.0).split_at_mut_checked(bytes.len()) {
            place.copy_from_slice(bytes);
            self.0 = rest;
        }
    }

    fn numbers(&mut self, numbers: &[f64; 6]) {
        numbers.iter().for_each(|number| self.put(&number.to_le_bytes()));
    }

    fn joints(&mut self, joints: &Joints) {
        self.numbers(&joints.axes);
        self.numbers(&joints.external);
    }
}

/// Reads values one after the other.
struct Reader<'a>(&'a [u8]);

impl Reader<'_> {
    fn take<const N: usize>(&mut self) -> Option<[u8; N]> {
        let (found, rest) = self.0.split_first_chunk()?;
        self.0 = rest;
        Some(*found)
    }

    fn numbers(&mut self) -> Option<[f64; 6]> {
        let mut numbers = [0.0; 6];
        for number in &mut numbers {
            *number = f64::from_le_bytes(self.take()?);
        }
        Some(numbers)
    }

    fn joints(&mut self) -> Option<Joints> {
        Some(Joints { axes: self.numbers()?, external: self.numbers()? })
    }
}
