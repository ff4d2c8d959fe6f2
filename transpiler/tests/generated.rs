//! The committed Rust of the examples is what the compiler emits now.
#![allow(clippy::disallowed_methods, clippy::expect_used, reason = "tests read and write files, and may fail")]

use arl2rs::CheckOptions;
use arl2rs::compile::compile_program;
use arl2rs::emit::EmitOptions;
use arl2rs::sources::FileSystem;
use std::path::Path;

const EXAMPLES: [&str; 6] = [
    "examples/build_door/robot/drain.arl",
    "examples/build_door/robot/fill.arl",
    "examples/macro_door/robot/greet.arl",
    "examples/light_curtain/light_curtain.arl",
    "examples/pick_and_place/pick_and_place.arl",
    "examples/plc_cell/plc_cell.arl",
];

#[test]
fn generated_files_are_fresh() {
    let workspace = Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("the workspace");
    let update = std::env::var_os("UPDATE_GENERATED").is_some();
    for example in EXAMPLES {
        let emit = || {
            let main = workspace.join(example);
            let compiled = compile_program(&main, &FileSystem, &CheckOptions::default(), &EmitOptions::default());
            compiled.expect("no bug").rust.expect("examples are right")
        };
        let rust = emit();
        assert_eq!(rust, emit(), "{example}: the same program gives the same Rust");
        let name = Path::new(example).with_extension("rs");
        let file = workspace.join("generated/src").join(name.file_name().expect("a name"));
        if update {
            std::fs::write(&file, &rust).expect("written");
        }
        let committed = std::fs::read_to_string(&file).unwrap_or_default();
        assert!(committed == rust, "{} is stale: see generated/src/lib.rs", file.display());
    }
}
