//! However bytes come in pieces, `readuntil` loses none.
#![no_main]

libfuzzer_sys::fuzz_target!(|input: (&[u8], Vec<&[u8]>)| arl_rt::fuzzing::read_until(input.0, &input.1));
