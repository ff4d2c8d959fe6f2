//! Whatever a client sends, the Modbus TCP server answers or parts with it.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| arl_rt::fuzzing::modbus_tcp(bytes));
