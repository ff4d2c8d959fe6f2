//! The cargo project that a program is compiled in.

use crate::cache::{Kind, Place, write_if_changed};
use crate::runtime::Unpacked;
use arl_terminal::failure::Failure;
use std::path::Path;

/// The emitted Rust of what becomes one program.
#[derive(Clone, Default, Debug)]
pub struct Emitted {
    /// The first program.
    pub first: String,
    /// The others.
    pub others: Vec<EmittedOther>,
    /// What they are made into.
    pub kind: Kind,
}

/// The emitted Rust of a program beside the first one.
#[derive(Clone, Hash, Debug)]
pub struct EmittedOther {
    /// The name that the cell file gives it.
    pub file: String,
    /// The folder of its files, counted from that of the first program.
    pub folder: String,
    /// What it became.
    pub rust: String,
}

/// Writes the project of a program. `folder` is that of its files.
///
/// # Errors
/// A file of it cannot be written.
pub fn write(place: &Place, runtime: &Unpacked, rust: &Emitted, folder: &Path) -> Result<(), Failure> {
    manifest(&place.folder, &place.name, runtime, (rust.kind, PROGRAM_LEVEL))?;
    let source = |name: &str| place.folder.join("src").join(name);
    write_if_changed(&source("program.rs"), rust.first.as_bytes())?;
    let mut modules = String::from("mod program;\n");
    let mut others = String::new();
    for (at, beside) in rust.others.iter().enumerate() {
        let name = format!("program_{at}");
        write_if_changed(&source(&format!("{name}.rs")), beside.rust.as_bytes())?;
        modules += &format!("mod {name};\n");
        others += &format!("        {}\n", other(beside, &name));
    }
    let folder = folder.display().to_string();
    let drivers = "arl_rt::emit::program_main::drivers(arl_drivers::connect);";
    let (file, crate_root) = match rust.kind {
        Kind::Library => (
            "lib.rs",
            format!(
                "fn make() -> program::Globals {{\n    {drivers}\n    program::Globals::new()\n}}\n\n\
                 arl_library::library!(make, [\n{others}], {folder:?});\n"
            ),
        ),
        kind => {
            let start = match kind {
                Kind::Watched => "main_watched",
                Kind::Named => "main_named",
                _ => "main_with",
            };
            let call =
                format!("arl_rt::emit::program_main::{start}(program::Globals::new, &[\n{others}    ], {folder:?})");
            ("main.rs", format!("fn main() -> std::process::ExitCode {{\n    {drivers}\n    {call}\n}}\n"))
        }
    };
    write_if_changed(&source(file), format!("// Written by arl2rs.\n\n{modules}\n{crate_root}").as_bytes())?;
    Ok(())
}

/// The entry of a program beside the first one, which became this module.
pub fn other(other: &EmittedOther, module: &str) -> String {
    let EmittedOther { file, folder, .. } = other;
    let make = format!("|| Box::new({module}::Globals::new())");
    format!("arl_rt::emit::program_main::Other {{ file: {file:?}, folder: {folder:?}, make: {make} }},")
}

/// How far programs are optimised: far enough for loops, and soon done.
const PROGRAM_LEVEL: u8 = 1;

/// How the runtime is compiled, which everybody waits for once. What moves robots is as fast as it can be, in one piece
/// each: between pieces nothing small is inlined. The rest of the runtime is mostly called, and seldom loops: small is
/// fast enough there. What reads files at the start, is only compiled where it is used, or is not used at all, needs no
/// optimisation of its own.
const RUNTIME: &str = "\
arl-lang = { opt-level = 1, codegen-units = 2 }
arl-motion = { opt-level = 2, codegen-units = 1 }
arl-robot = { opt-level = 2, codegen-units = 1 }
arl-rt = { opt-level = \"s\", codegen-units = 8 }
arl-drivers = { opt-level = \"s\" }
encoding_rs = { opt-level = 0 }
libc = { opt-level = 0 }
libm = { opt-level = 0 }
nalgebra = { opt-level = 0 }
quick-xml = { opt-level = \"s\" }
rustix = { opt-level = 0 }
simba = { opt-level = 0 }
toml = { opt-level = 0 }
toml_parser = { opt-level = 0 }
winnow = { opt-level = 0 }
";

/// What the profile says of what a program does, said once more where settings of a user's cannot change it.
pub const SETTINGS: [&str; 6] = [
    "profile.dev.panic=\"unwind\"",
    "profile.dev.overflow-checks=false",
    "profile.dev.debug-assertions=false",
    "profile.release.panic=\"unwind\"",
    "profile.release.overflow-checks=false",
    "profile.release.debug-assertions=false",
];

/// Writes Cargo.toml, and Cargo.lock where the versions of other packages are known.
///
/// # Errors
/// One of them cannot be written.
pub fn manifest(folder: &Path, name: &str, runtime: &Unpacked, (kind, level): (Kind, u8)) -> Result<(), Failure> {
    let (crate_type, library) = match kind {
        Kind::Library => ("[lib]\ncrate-type = [\"cdylib\"]\n\n", format!("arl-library = {}\n", runtime.library)),
        _ => ("", String::new()),
    };
    // Not `package."*"`: that would also optimise what only runs while compiling.
    let text = format!(
        "# Written by arl2rs.\n\
         [package]\nname = \"{name}\"\nversion = \"0.0.0\"\nedition = \"2024\"\npublish = false\n\n\
         [workspace]\n\n{crate_type}\
         [dependencies]\narl-rt = {}\narl-drivers = {}\n{library}\n\
         [profile.dev]\nopt-level = 3\ndebug = false\nincremental = false\nlto = \"off\"\n\
         overflow-checks = false\ndebug-assertions = false\n\n\
         [profile.dev.package]\n\"{name}\" = {{ opt-level = {level}, incremental = true }}\n\
         {RUNTIME}\n\
         [profile.release]\nlto = \"thin\"\n",
        runtime.dependency, runtime.drivers
    );
    write_if_changed(&folder.join("Cargo.toml"), text.as_bytes())?;
    let Some(lock) = runtime.lock_file.as_ref().and_then(|path| std::fs::read(path).ok()) else { return Ok(()) };
    // cargo takes out of the lock file what the project does not need, so a copy tells whether the original changed.
    let own = folder.join("Cargo.lock");
    if write_if_changed(&folder.join("base.lock"), &lock)? || !is_toml(&own) {
        std::fs::write(&own, &lock).map_err(|error| Failure::io("write", &own, &error))?;
    }
    Ok(())
}

/// Whether a file holds TOML: what is left of a damaged one does not, as a rule, and cargo refuses it for good.
fn is_toml(path: &Path) -> bool {
    std::fs::read_to_string(path).is_ok_and(|text| toml::from_str::<toml::Table>(&text).is_ok())
}
