//! Constants with plain names.

use super::entry::{Constant, ConstantValue};

pub(super) const CONSTANTS: &[Constant] = &[
    Constant {
        name: "PI",
        value: ConstantValue::Double(std::f64::consts::PI),
        doc: "The number pi; $PI is the same.",
        section: "10.2.20",
    },
    Constant { name: "endl", value: ConstantValue::String("\n"), doc: "A new line, for print.", section: "3.5.1" },
    Constant {
        name: "R1",
        value: ConstantValue::String("R1"),
        doc: "The name of the mechanical unit, as in `startdetect cid:1,mu:R1`.",
        section: "3.5.8",
    },
];
