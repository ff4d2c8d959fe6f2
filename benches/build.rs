//! Compiles the kernels, the robot of the bench `cell`, the programs that wait.

const KERNELS: [&str; 11] =
    ["sieve", "matrix", "collatz", "crc", "sort", "text", "fixed", "structures", "fib", "queens", "machine"];

fn main() {
    let build = arl2rs::Build::new();
    let build = build.program("cells/robot.arl").program("cells/waits.arl");
    KERNELS.iter().fold(build, |build, name| build.program(format!("kernels/{name}.arl"))).compile();
}
