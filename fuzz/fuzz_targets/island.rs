//! Whatever an io island answers, what is taken of it has the size that was asked for.
#![no_main]

libfuzzer_sys::fuzz_target!(|answer: (u8, u16, &[u8])| arl_rt::fuzzing::island(answer.0, answer.1, answer.2));
