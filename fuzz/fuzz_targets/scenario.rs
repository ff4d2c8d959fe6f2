//! A scenario, and an order, are read or refused with their place.
#![no_main]

use arl_rt::io::Scenario;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    if let Err(error) = Scenario::parse("io.toml", text) {
        assert!(!error.message.is_empty());
    }
});
