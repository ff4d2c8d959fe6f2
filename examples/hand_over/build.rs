//! Compiles the ARL programs of this project.

fn main() {
    let programs = arl2rs::Build::new().program("robot/giver.arl").program("robot/taker.arl");
    programs.program("robot/watcher.arl").compile();
}
