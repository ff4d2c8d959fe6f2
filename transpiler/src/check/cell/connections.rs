//! Ports, stations, lines, registers and bytes that connections and buses do not have.

use super::{addressed, constant_int, given, related};
use crate::diagnostics::connections::{ConnectionProblem, NamedUnits};
use crate::hir::{Builtin, ExprKind, Value};
use arl_lang::catalog::{Relation, Space};
use arl_lang::span::Span;
use arl_robot::outline::Outline;

/// Registers, coils or bytes that calls address by the first one and a count.
struct Stretch {
    /// Their name.
    unit: NamedUnits,
    /// Their total number.
    size: i64,
    /// The consequence for a call that names others.
    result: &'static str,
}

const ALARM: &str = "the call would end in an alarm";
const FALSE: &str = "the call would give false";

/// The range of a space in a cell; `None` for a space that is addressed one by one.
fn stretch_of(space: Space, cell: &Outline) -> Option<Stretch> {
    let (one, many, size, result) = match space {
        Space::ModbusRegister => ("register", "registers", 1 << 16, FALSE),
        Space::ModbusCoil => ("coil", "coils", 1 << 16, FALSE),
        Space::SlaveByte => ("byte of the slave", "bytes of the slave", 1 << 17, ALARM),
        Space::MelsecRegister => ("D register", "D registers", 1 << 24, ALARM),
        Space::DeviceNetByte => {
            let size = cell.devicenet.into();
            ("byte of the DeviceNet bus", "bytes of the DeviceNet bus", size, "the call would give 1")
        }
        Space::DigitalInput
        | Space::DigitalOutput
        | Space::AnalogInput
        | Space::AnalogOutput
        | Space::InternalSignal
        | Space::ForegroundChannel
        | Space::SerialLine => return None,
    };
    Some(Stretch { unit: NamedUnits { one, many }, size, result })
}

/// The problem with a call, and its position.
pub(super) fn problem(builtin: &Builtin, cell: &Outline) -> Option<(Span, ConnectionProblem)> {
    parameter(builtin).or_else(|| stretch(builtin, cell)).or_else(|| line(builtin, cell))
}

fn parameter(builtin: &Builtin) -> Option<(Span, ConnectionProblem)> {
    given(builtin).find_map(|(param, expr)| {
        let accepted = param.accepts?;
        let (value, span) = constant_int(expr)?;
        let problem = ConnectionProblem::Value { param: param.name, value, accepted };
        (!accepted.holds(value)).then_some((span, problem))
    })
}

fn stretch(builtin: &Builtin, cell: &Outline) -> Option<(Span, ConnectionProblem)> {
    let (space, start) = addressed(builtin).next()?;
    let Stretch { unit, size, result } = stretch_of(space, cell)?;
    let (start, span) = constant_int(start)?;
    let extent = related(builtin, |relation| matches!(relation, Relation::Extent(_)));
    // If the count is not known, the smallest possible one is assumed.
    let (count, len) = match extent.and_then(|(relation, expr)| Some((relation, constant_int(expr)?.0))) {
        Some((Relation::Extent(per_place), len)) => {
            let per_place = i64::from(per_place);
            ((i64::from(len) + per_place - 1) / per_place, len)
        }
        _ => (0, 0),
    };
    let start = i64::from(start);
    let fits = start >= 0 && len >= 0 && start + count <= size;
    (!fits).then_some((span, ConnectionProblem::Missing { unit, start, count, size, result }))
}

fn line(builtin: &Builtin, cell: &Outline) -> Option<(Span, ConnectionProblem)> {
    let (_, expr) = addressed(builtin).find(|(space, _)| *space == Space::SerialLine)?;
    let ExprKind::Const(Value::String(name)) = &expr.kind else { return None };
    // A name with a slash is the path of a device.
    let known = cell.lines.contains_key(&**name) || name.contains('/');
    let problem = || {
        let known = cell.lines.keys().cloned().collect();
        ConnectionProblem::Line { name: name.to_string(), known }
    };
    (!known).then(|| (expr.span, problem()))
}

/// Reports the use of registers and coils that no PLC can reach.
pub(super) fn unseen(builtin: &Builtin) -> Option<ConnectionProblem> {
    builtin.is_served().then_some(ConnectionProblem::Unseen { name: builtin.entry.name })
}
