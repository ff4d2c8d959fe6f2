//! Compiles the ARL programs of this project.

fn main() {
    arl2rs::Build::new().program("robot/fill.arl").program("robot/drain.arl").compile();
}
