//! A cell file is read or refused with its place.
#![no_main]

use arl_rt::Cell;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    if let Err(error) = Cell::parse("cell.toml", text) {
        assert!(!error.message.is_empty());
    }
});
