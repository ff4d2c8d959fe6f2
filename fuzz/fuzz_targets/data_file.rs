//! A data file that somebody edited gives values or alarms.
#![no_main]

use std::cell::Cell;

use arl_rt::values::{Joint, Shared, SmallArray, Str};
use arl_rt::program::{DataFile, DataVar};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|content: &[u8]| {
    let (home, count, speed) = (Cell::new(Joint::default()), Cell::new(0_i32), Cell::new(0.0_f64));
    let (table, title) = (Shared::<SmallArray<f64, 4>>::default(), Shared::<Str>::default());
    let vars = vec![
        DataVar { name: "home", sizes: &[], slot: &home },
        DataVar { name: "count", sizes: &[], slot: &count },
        DataVar { name: "speed", sizes: &[], slot: &speed },
        DataVar { name: "table", sizes: &[2, 2], slot: &table },
        DataVar { name: "title", sizes: &[], slot: &title },
    ];
    arl_rt::fuzzing::data_file(&DataFile { file: "p_data.arl", vars }, content);
});
