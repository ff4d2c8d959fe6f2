//! A recording is read, as far as it goes, or refused.
#![no_main]

use arl2rs::cli::fuzzing::recording;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| recording(bytes));
