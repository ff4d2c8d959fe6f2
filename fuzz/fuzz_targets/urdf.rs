//! A URDF becomes a robot file and a shape, or is refused.
#![no_main]

use arl_runs::fuzzing::urdf;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| urdf(text));
