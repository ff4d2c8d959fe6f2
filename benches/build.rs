//! Compiles the kernels and the robot of the bench `cell`.

const KERNELS: [&str; 11] =
    ["sieve", "matrix", "collatz", "crc", "sort", "text", "fixed", "structures", "fib", "queens", "machine"];

fn main() {
    let build = arl2rs::Build::new();
    let build = build.program("cells/robot.arl");
    KERNELS.iter().fold(build, |build, name| build.program(format!("kernels/{name}.arl"))).compile();
}
