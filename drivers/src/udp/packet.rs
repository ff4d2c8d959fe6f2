//! The packets: all numbers little-endian, all lengths fixed. `docs/udp-and-rsi.md` has them as tables.

use arl_rt::motion::Joints;
use arl_rt::robot_driver::{Drives, Power, Setpoint};

/// How long packets are, in bytes.
pub const COMMAND_LENGTH: usize = 320;
/// The same of what the arm says.
pub const STATE_LENGTH: usize = 344;

const COMMAND: [u8; 4] = *b"ARLC";
const STATE: [u8; 4] = *b"ARLS";
const VERSION: u16 = 1;
/// How many bytes a fault's text may have.
const TEXT: usize = 64;

/// Flags of a command.
const CYCLIC: u32 = 1;
const HAS_TORQUE: u32 = 2;
/// Flags of a state.
const MEASURES_VELOCITY: u32 = 1;
const MEASURES_TORQUE: u32 = 2;

/// What an arm is told.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Command {
    /// Which run this is: the arm answers to one at a time.
    pub session: u32,
    /// How many packets of this run there were, with this one.
    pub sequence: u64,
    /// How many axes the robot has, and how many external ones.
    pub axes: (u8, u8),
    /// What the motors are told.
    pub power: Power,
    /// Whether another one follows within a cycle: an arm that gets none any more has to brake.
    pub is_cyclic: bool,
    /// Where the arm shall be.
    pub setpoint: Setpoint,
}

/// What an arm says.
#[derive(Clone, PartialEq, Debug)]
pub struct State {
    /// The run that it answers to.
    pub session: u32,
    /// How many packets the arm has sent, with this one: an older one that comes later does not count.
    pub sequence: u64,
    /// The newest command that the arm had.
    pub answers: u64,
    /// How many axes the arm has, and how many external ones.
    pub axes: (u8, u8),
    /// How its drives are.
    pub drives: Drives,
    /// Where its axes are, in deg (mm).
    pub position: Joints,
    /// How fast they move, in deg/s (mm/s), where it measures that.
    pub velocity: Option<Joints>,
    /// What its motors give at the axes, in Nm (N), where it measures that.
    pub torque: Option<[f64; 6]>,
}

impl Command {
    /// The packet.
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
    /// What a packet says; `None`: it is not a state of an arm.
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

/// Writes one thing behind the other. What does not fit is left out: the lengths above are held by a test.
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

/// Reads one thing behind the other.
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
