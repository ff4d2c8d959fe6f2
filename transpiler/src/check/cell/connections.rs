//! Ports, stations, lines, registers and bytes that connections and buses do not have.

use super::{constant_int, named};
use crate::diagnostics::connections::{ConnectionProblem, Unit};
use crate::hir::{Builtin, ExprKind, Value};
use arl_lang::span::Span;
use arl_robot::outline::Outline;

/// What a parameter takes.
enum Allowed {
    /// All from the one to the other.
    Range(i32, i32),
    /// These.
    OneOf(&'static [i32]),
    /// All from the one to the other, and a third one.
    RangeOr(i32, i32, i32),
}

impl Allowed {
    fn takes(&self, value: i32) -> bool {
        match *self {
            Allowed::Range(low, high) => (low..=high).contains(&value),
            Allowed::OneOf(values) => values.contains(&value),
            Allowed::RangeOr(low, high, other) => (low..=high).contains(&value) || value == other,
        }
    }

    /// As messages write it.
    fn words(&self) -> String {
        match *self {
            Allowed::Range(low, i32::MAX) => format!("{low} or more"),
            Allowed::Range(low, high) => format!("{low} to {high}"),
            Allowed::OneOf(values) => {
                let values: Vec<String> = values.iter().map(i32::to_string).collect();
                format!("one of {}", values.join(", "))
            }
            Allowed::RangeOr(low, high, other) => format!("{low} to {high}, or {other}"),
        }
    }
}

/// Parameters by the runtime's functions, and what they take: anything else is an alarm there.
const PARAMETERS: [(&[&str], &str, Allowed); 9] = [
    (&["socket::connect", "socket::accept", "melsec::open"], "port", Allowed::Range(1, 65535)),
    (&["melsec::open"], "slave_id", Allowed::RangeOr(0, 247, 255)),
    (
        &["melsec::read_string", "melsec::read_bytes", "melsec::write_string", "melsec::write_bytes"],
        "len",
        Allowed::Range(0, 1920),
    ),
    (&["modbus_rtu::open", "modbus_rtu::open_stopbits_first"], "slave_id", Allowed::Range(1, 247)),
    (
        &["modbus_rtu::open", "modbus_rtu::open_stopbits_first"],
        "baud_rate",
        Allowed::OneOf(&[4800, 9600, 19200, 38400, 57600, 115_200]),
    ),
    (&["modbus_rtu::open", "modbus_rtu::open_stopbits_first"], "databits", Allowed::Range(5, 8)),
    (&["modbus_rtu::setcycle"], "cycle", Allowed::Range(500_000, i32::MAX)),
    (&["serial::open"], "baud_rate", Allowed::OneOf(&[300, 600, 1200, 2400, 4800, 9600, 19200, 38400, 57600, 115_200])),
    (&["serial::open"], "character_size", Allowed::Range(5, 8)),
];

/// What a call names by its first one and how many: registers, coils, bytes.
struct Stretch {
    paths: &'static [&'static str],
    start: &'static str,
    len: &'static str,
    /// What they are called.
    unit: Unit,
    /// How many there are.
    size: fn(&Outline) -> i64,
    /// How many of them so many of `len` are.
    count: fn(i64) -> i64,
    /// What becomes of a call that names others.
    result: &'static str,
}

const ALARM: &str = "the call would end in an alarm";
const FALSE: &str = "the call would give false";

const STRETCHES: [Stretch; 5] = [
    Stretch {
        paths: &[
            "modbus_tcp::readregisters_string",
            "modbus_tcp::readregisters_bytes",
            "modbus_tcp::writeregisters_string",
            "modbus_tcp::writeregisters_bytes",
        ],
        start: "start",
        len: "len",
        unit: Unit { one: "register", many: "registers" },
        size: |_| 1 << 16,
        count: |len| len,
        result: FALSE,
    },
    Stretch {
        paths: &["modbus_tcp::readcoils", "modbus_tcp::writecoils"],
        start: "start",
        len: "length",
        unit: Unit { one: "coil", many: "coils" },
        size: |_| 1 << 16,
        count: |len| len,
        result: FALSE,
    },
    Stretch {
        paths: &[
            "modbus_rtu::read_string",
            "modbus_rtu::read_bytes",
            "modbus_rtu::write_string",
            "modbus_rtu::write_bytes",
        ],
        start: "start",
        len: "len",
        unit: Unit { one: "byte of the slave", many: "bytes of the slave" },
        size: |_| 1 << 17,
        count: |len| len,
        result: ALARM,
    },
    Stretch {
        paths: &["melsec::read_string", "melsec::read_bytes", "melsec::write_string", "melsec::write_bytes"],
        start: "start",
        len: "len",
        unit: Unit { one: "D register", many: "D registers" },
        size: |_| 1 << 24,
        // Two bytes a register, the last one's low byte alone.
        count: |len| (len + 1) / 2,
        result: ALARM,
    },
    Stretch {
        paths: &["devicenet::dnwrite", "devicenet::dnread"],
        start: "offset",
        len: "len",
        unit: Unit { one: "byte of the DeviceNet bus", many: "bytes of the DeviceNet bus" },
        size: |cell| cell.devicenet.into(),
        count: |len| len,
        result: "the call would give 1",
    },
];

/// What is wrong with a call, and where.
pub(super) fn problem(builtin: &Builtin, cell: &Outline) -> Option<(Span, ConnectionProblem)> {
    parameter(builtin).or_else(|| stretch(builtin, cell)).or_else(|| line(builtin, cell))
}

fn parameter(builtin: &Builtin) -> Option<(Span, ConnectionProblem)> {
    let rules = PARAMETERS.iter().filter(|(paths, ..)| paths.contains(&builtin.entry.path));
    rules.into_iter().find_map(|(_, param, allowed)| {
        let (value, span) = constant_int(named(builtin, param)?)?;
        let problem = ConnectionProblem::Value { param, value, allowed: allowed.words() };
        (!allowed.takes(value)).then_some((span, problem))
    })
}

fn stretch(builtin: &Builtin, cell: &Outline) -> Option<(Span, ConnectionProblem)> {
    let stretch = STRETCHES.iter().find(|stretch| stretch.paths.contains(&builtin.entry.path))?;
    let (start, span) = constant_int(named(builtin, stretch.start)?)?;
    // Where that is not known, as few as there may be.
    let len = named(builtin, stretch.len).and_then(constant_int).map_or(0, |(len, _)| len);
    let (start, count, size) = (i64::from(start), (stretch.count)(i64::from(len)), (stretch.size)(cell));
    let fits = start >= 0 && len >= 0 && start + count <= size;
    let Stretch { unit, result, .. } = *stretch;
    (!fits).then_some((span, ConnectionProblem::Missing { unit, start, count, size, result }))
}

fn line(builtin: &Builtin, cell: &Outline) -> Option<(Span, ConnectionProblem)> {
    let opens = matches!(builtin.entry.path, "serial::open" | "modbus_rtu::open" | "modbus_rtu::open_stopbits_first");
    let expr = named(builtin, "devname").filter(|_| opens)?;
    let ExprKind::Const(Value::String(name)) = &expr.kind else { return None };
    // What has a slash is the path of a device.
    let known = cell.lines.contains_key(&**name) || name.contains('/');
    let problem = || {
        let known = cell.lines.keys().cloned().collect();
        ConnectionProblem::Line { name: name.to_string(), known }
    };
    (!known).then(|| (expr.span, problem()))
}

/// Registers and coils are used that no PLC can reach.
pub(super) fn unseen(builtin: &Builtin) -> Option<ConnectionProblem> {
    builtin.is_served().then_some(ConnectionProblem::Unseen { name: builtin.entry.name })
}
