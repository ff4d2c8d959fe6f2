//! Compiles the ARL programs of this project.

fn main() {
    arl2rs::Build::new().program("robot/giver.arl").program("robot/taker.arl").compile();
}
