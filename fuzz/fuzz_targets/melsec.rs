//! Whatever a PLC answers over the MC protocol is an answer or garbage.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| arl_rt::fuzzing::melsec(bytes));
