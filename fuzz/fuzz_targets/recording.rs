//! A recording is read, as far as it goes, or refused.
#![no_main]

use arl_runs::fuzzing::recording;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| recording(bytes));
