//! What is compared does the same: emitted Rust, Rust by hand, Lua.

use arl_benches::{kernels, lua};

#[test]
fn all_forms_of_a_kernel_give_the_same() {
    for kernel in kernels::ALL {
        let expected = (kernel.rival)(kernel.small);
        let run = (kernel.emitted)(kernel.small);
        assert_eq!(run.map(|run| run.checksum), Ok(expected), "{}: emitted and by hand", kernel.name);
        if lua::is_there() {
            let run = lua::run(kernel.name, kernel.small, 1);
            assert_eq!(run.map(|run| run.checksum), Ok(expected), "{}: Lua and by hand", kernel.name);
        }
    }
    if !lua::is_there() {
        eprintln!("lua5.4 is not there: the kernels in Lua were not compared");
    }
}
