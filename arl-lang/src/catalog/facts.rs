//! Facts about entries that checks and translation depend on: what a parameter addresses, what a motion does, which
//! forms are not plain calls. Nothing outside the catalog knows a built-in by its name.

use std::fmt;

/// A range of numbers that make sense.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Range {
    /// From the least to the greatest.
    Within(f64, f64),
    /// Numbers above this one.
    Above(f64),
    /// This number and those above it.
    AtLeast(f64),
    /// This number and those below it.
    AtMost(f64),
    /// Only `false`, which counts as 0: what `true` would switch on does not exist.
    OnlyFalse,
}

impl Range {
    /// Whether a number is in the range; `false` and `true` count as 0 and 1.
    pub fn holds(self, number: f64) -> bool {
        match self {
            Self::Within(low, high) => (low..=high).contains(&number),
            Self::Above(low) => number > low,
            Self::AtLeast(low) => number >= low,
            Self::AtMost(high) => number <= high,
            Self::OnlyFalse => number == 0.0,
        }
    }
}

impl fmt::Display for Range {
    /// Completes "must be".
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Within(low, high) => write!(f, "from {low} to {high}"),
            Self::Above(low) => write!(f, "above {low}"),
            Self::AtLeast(low) => write!(f, "{low} or more"),
            Self::AtMost(high) => write!(f, "{high} or less"),
            Self::OnlyFalse => f.write_str("false"),
        }
    }
}

/// What a parameter addresses, by a number or a name.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Space {
    /// Digital inputs, from 1.
    DigitalInput,
    /// Digital outputs, from 1.
    DigitalOutput,
    /// Analog inputs, from 1.
    AnalogInput,
    /// Analog outputs, from 1.
    AnalogOutput,
    /// Signals inside the controller, from 1.
    InternalSignal,
    /// Foreground channels of programs, from 1.
    ForegroundChannel,
    /// Registers of the controller's Modbus TCP server, from 0.
    ModbusRegister,
    /// Coils of the controller's Modbus TCP server, from 0.
    ModbusCoil,
    /// Bytes of the controller's Modbus RTU slave, from 0.
    SlaveByte,
    /// D registers of a Melsec PLC, from 0.
    MelsecRegister,
    /// Bytes of the DeviceNet buffer, from 0.
    DeviceNetByte,
    /// Serial lines, by name.
    SerialLine,
}

/// How a parameter is related to an earlier one that addresses something.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Relation {
    /// It gives how much is addressed; this many units make one addressed place.
    Extent(u32),
    /// It is the value that the addressed place gets.
    Content,
}

/// The whole numbers that a connection accepts. All others are an alarm at run time.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Accepted {
    /// All from the least to the greatest.
    Range(i32, i32),
    /// All from the least to the greatest, and a third one.
    RangeOr(i32, i32, i32),
    /// Exactly these.
    OneOf(&'static [i32]),
}

impl Accepted {
    /// Whether a number is one of them.
    pub fn holds(self, number: i32) -> bool {
        match self {
            Self::Range(low, high) => (low..=high).contains(&number),
            Self::RangeOr(low, high, other) => (low..=high).contains(&number) || number == other,
            Self::OneOf(numbers) => numbers.contains(&number),
        }
    }
}

impl fmt::Display for Accepted {
    /// Completes "it is".
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Range(low, i32::MAX) => write!(f, "{low} or more"),
            Self::Range(low, high) => write!(f, "{low} to {high}"),
            Self::RangeOr(low, high, other) => write!(f, "{low} to {high}, or {other}"),
            Self::OneOf(numbers) => {
                let numbers: Vec<String> = numbers.iter().map(i32::to_string).collect();
                write!(f, "one of {}", numbers.join(", "))
            }
        }
    }
}

/// How the compiler translates the use of an entry.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Form {
    /// As a call of the runtime's function.
    Call,
    /// `waituntil`: a loop around its condition.
    WaitUntil,
    /// `jump`: a motion whose second half may depend on a condition.
    Jump,
    /// `interrupt`, `timer`, `trigger`: condition and action become closures.
    Event,
    /// `typeof`: a constant, since the type is known.
    TypeOf,
    /// `exit`: leaves the program.
    Exit,
    /// `restart`: begins the program again.
    Restart,
}

/// What a motion instruction does.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Motion {
    /// `movej`: the axes go to axis positions.
    Joint,
    /// `ptp`: the axes go to a pose.
    PointToPoint,
    /// `jump`: the axes go to a pose via a height.
    Jump,
    /// `lin`: the TCP goes on a straight line to a pose.
    Line,
    /// `cir`: the TCP goes on an arc to a pose.
    Arc,
    /// `ccir`: the TCP goes on an arc that several instructions make together.
    JoinedArc,
    /// `spl`: the TCP goes on a smooth curve through poses.
    Spline,
}

impl Motion {
    /// Whether it ends in the configuration in which it starts: the TCP goes along a path.
    pub fn keeps_configuration(self) -> bool {
        match self {
            Self::Line | Self::Arc | Self::JoinedArc | Self::Spline => true,
            Self::Joint | Self::PointToPoint | Self::Jump => false,
        }
    }
}

/// Along which axes a function shifts and turns a pose.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum PoseShift {
    /// `offset`: those of the workpiece.
    Workpiece,
    /// `reltool`: those of the tool.
    Tool,
}

/// The role of a system variable for motion, or what an instruction changes there.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Role {
    /// Lies between a pose and the flange besides tool and workpiece, or makes parts of a pose no longer count.
    Frame,
    /// Whether targets are reached in the configuration that they state.
    ConfigurationCheck,
    /// Whether lines may pass near the wrist singularity.
    WristPassage,
    /// How the tool turns on arcs.
    ArcOrientation,
    /// Diverts lines from their targets.
    Compensation,
    /// The tool of motions that give none.
    DefaultTool,
    /// The workpiece of motions that give none.
    DefaultWorkpiece,
    /// The flange as a tool.
    Flange,
    /// The world as a workpiece.
    World,
}
