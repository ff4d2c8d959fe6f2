//! I/O channels and program channels that a cell does not have, and values that its channels cannot carry.

use super::Problem;
use super::declare::problems;
use arl_robot::channels::AnalogType;

problems! {
    /// What is wrong with a channel or with the value that it is set to.
    pub(crate) enum ChannelProblem {
        error 805 "A channel that the cell does not have" => {
            /// There are `count` channels of this kind, from 1 on.
            Missing { kind: &'static str, channel: i32, count: u32 },
            /// There are `count` foreground channels, from 1 on.
            NoForeground { channel: i32, count: u32 },
            /// The last channel of a range is given first.
            Reversed { kind: &'static str, from: i32, to: i32 },
            /// More channels than an int has bits.
            TooMany { kind: &'static str, from: i32, to: i32 },
        }
        error 806 "An analog value outside its channel's range" => {
            /// A value that the type of an analog output cannot carry.
            Value { channel: i32, value: f64, ty: AnalogType },
        }
    }
}

/// The consequence of a call with such a channel.
const ALARM: &str = "the call would end in an alarm";

impl Problem for ChannelProblem {
    fn message(&self) -> String {
        match self {
            ChannelProblem::Missing { kind, channel, count: 0 } => {
                format!("{kind} {channel} does not exist: the cell has no {kind}")
            }
            ChannelProblem::Missing { kind, channel, count } => {
                format!("{kind} {channel} does not exist: the cell has {kind} 1 to {count}")
            }
            ChannelProblem::NoForeground { channel, count: 1 } => {
                format!("foreground channel {channel} does not exist: the cell has one, channel 1")
            }
            ChannelProblem::NoForeground { channel, count } => {
                format!("foreground channel {channel} does not exist: the cell has channels 1 to {count}")
            }
            ChannelProblem::Reversed { kind, from, to } => {
                format!("{kind} {from} to {to} is a reversed range: the lower number comes first")
            }
            ChannelProblem::TooMany { kind, from, to } => {
                format!("{kind} {from} to {to} are more than 32 channels, which is the most that one int holds")
            }
            ChannelProblem::Value { channel, value, ty } => {
                let ((low, high), unit) = (ty.range(), ty.unit());
                format!("AO {channel} of the cell carries {low} to {high} {unit}, not {value} {unit}")
            }
        }
    }

    fn label(&self) -> String {
        String::new()
    }

    fn help(&self) -> Option<String> {
        Some(match self {
            ChannelProblem::Missing { .. } => {
                format!("[io] of the cell file says how many channels there are; {ALARM}")
            }
            ChannelProblem::NoForeground { .. } => {
                format!("each [[channel]] of the cell file that is not in the background adds one; {ALARM}")
            }
            ChannelProblem::Value { .. } => format!("[io] of the cell file says what each channel carries; {ALARM}"),
            ChannelProblem::Reversed { .. } | ChannelProblem::TooMany { .. } => ALARM.to_string(),
        })
    }
}
