//! A scenario is read or refused with its place.
#![no_main]

use arl_rt::io::Scenario;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    if let Err(error) = Scenario::parse("io.toml", text) {
        assert!(!error.message.is_empty());
    }
});
