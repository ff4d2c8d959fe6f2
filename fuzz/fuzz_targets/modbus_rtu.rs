//! Whatever comes over a serial line, in whatever pieces, the Modbus RTU slave finds requests or noise.
#![no_main]

libfuzzer_sys::fuzz_target!(|pieces: Vec<(bool, &[u8])>| arl_rt::fuzzing::modbus_rtu(&pieces));
