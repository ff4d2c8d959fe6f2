//! Ports, stations, lines, registers and bytes that connections and buses do not have.

use super::Problem;
use super::declare::problems;
use arl_lang::catalog::Accepted;

problems! {
    /// What is wrong with an argument of a connection or bus.
    pub(crate) enum ConnectionProblem {
        error 807 "An argument that a connection cannot have" => {
            /// A value that the parameter does not accept.
            Value { param: &'static str, value: i32, accepted: Accepted },
        }
        error 808 "Registers or bytes that a bus does not have" => {
            /// `count` units from `start` on, some of which do not exist: there are `size` of them, from 0 on. `result`
            /// is the consequence for the call.
            Missing { unit: NamedUnits, start: i64, count: i64, size: i64, result: &'static str },
        }
        error 809 "A serial line without a device" => {
            /// A serial line for which the cell has no device; `known` are the lines that it has.
            Line { name: String, known: Vec<String> },
        }
        warning 853 "Registers that no PLC can reach" => {
            /// Registers or coils in a cell without a server.
            Unseen { name: &'static str },
        }
    }
}

/// The name of a unit, in the singular and the plural.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) struct NamedUnits {
    pub(crate) one: &'static str,
    pub(crate) many: &'static str,
}

impl Problem for ConnectionProblem {
    fn message(&self) -> String {
        match self {
            ConnectionProblem::Value { param, value, accepted } => {
                format!("`{param}` cannot be {value}: it must be {accepted}")
            }
            ConnectionProblem::Missing { unit, start, count: 0 | 1, .. } => format!("there is no {} {start}", unit.one),
            ConnectionProblem::Missing { unit, start, count: ..0, .. } => {
                format!("a call cannot name fewer than 0 {} from {start} on", unit.many)
            }
            ConnectionProblem::Missing { unit, start, count, .. } => {
                format!("{} {start} to {} do not all exist", unit.many, start + count - 1)
            }
            ConnectionProblem::Line { name, .. } => format!("the cell has no device for the serial line \"{name}\""),
            ConnectionProblem::Unseen { name } => {
                format!("`{name}` in a cell without a Modbus TCP server: no PLC can reach these registers and coils")
            }
        }
    }

    fn label(&self) -> String {
        String::new()
    }

    fn help(&self) -> Option<String> {
        Some(match self {
            ConnectionProblem::Value { .. } => "the call would end in an alarm".into(),
            ConnectionProblem::Missing { size: 0, result, .. } => format!("there are none; {result}"),
            ConnectionProblem::Missing { size, result, .. } => {
                format!("the valid numbers are 0 to {}; {result}", size - 1)
            }
            ConnectionProblem::Line { known, .. } if known.is_empty() => {
                "[serial] of the cell file assigns devices to names; a path such as /dev/ttyS0 needs no entry".into()
            }
            ConnectionProblem::Line { known, .. } => {
                format!("[serial] of the cell file has devices for: {}", known.join(", "))
            }
            ConnectionProblem::Unseen { .. } => {
                "[modbus_tcp] in the cell file starts the server; without it only `--clock real` does".into()
            }
        })
    }
}
