//! `scan` reads any bytes with any delimiter.
#![no_main]

use arl_rt::emit::text::scan;
use arl_rt::values::Str;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|input: (&[u8], &[u8])| {
    let (from, delimiter) = (Str::from(input.0), Str::from(input.1));
    let (mut int, mut double, mut bool, mut text) = (0_i32, 0.0_f64, false, Str::default());
    let done = scan(&from, &delimiter)
        .argtosave(&mut int)
        .argtosave(&mut double)
        .argtosave(&mut bool)
        .argtosave(&mut text)
        .run();
    if let Err(fault) = done {
        assert!(!fault.to_string().is_empty());
    }
});
