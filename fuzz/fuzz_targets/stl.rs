//! An STL file becomes triangles, or is refused.
#![no_main]

use arl_runs::fuzzing::stl;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| stl(bytes));
