//! What the checker and the debugger say of an operation without a value is what the program's alarm says.

#![allow(clippy::unwrap_used, reason = "a test")]

use arl_rt::fault::Fault;
use arl2rs::operators::OperatorAlarm;

#[test]
fn operators_have_the_words_of_their_alarms() {
    let shift = |count, width: u8| {
        (OperatorAlarm::ShiftCount { count, most: u32::from(width) - 1 }, Fault::ShiftCount { count, width })
    };
    for (alarm, fault) in [(OperatorAlarm::DivideByZero, Fault::DivideByZero), shift(-1, 32), shift(9, 8)] {
        assert_eq!(alarm.to_string(), format!("alarm {}: {fault}", fault.number()));
    }
}
