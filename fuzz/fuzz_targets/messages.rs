//! Messages of a recording are taken in or refused.
#![no_main]

use arl_runs::fuzzing::messages;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| messages(bytes));
