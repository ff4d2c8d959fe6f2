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
];
