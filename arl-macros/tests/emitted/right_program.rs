// What the build script emits for a right program compiles without a word, also where everything is forbidden.
#![deny(warnings)]
#![allow(dead_code)]

mod robot {
    include!("right.rs");
}

fn main() {
    let globals = robot::Globals::new();
    assert_eq!(arl_rt::Program::file(&globals).name(), "right.arl");
}
