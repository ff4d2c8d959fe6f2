//! The cargo project in which a program is compiled.

use crate::cache::{Kind, Place, write_if_changed};
use crate::runtime::Unpacked;
use arl_terminal::failure::Failure;
use std::path::Path;

/// The emitted Rust of everything that becomes one program.
#[derive(Clone, Default, Debug)]
pub struct Emitted {
    /// The first program.
    pub first: String,
    /// The others.
    pub others: Vec<EmittedOther>,
    /// What they are compiled into.
    pub kind: Kind,
}

/// The emitted Rust of an additional program.
#[derive(Clone, Hash, Debug)]
pub struct EmittedOther {
    /// Its name in the cell file.
    pub file: String,
    /// The folder of its files, relative to that of the first program.
    pub folder: String,
    /// The emitted Rust.
    pub rust: String,
}

/// Writes the project of a program. `folder` is the folder of the program's files.
///
/// # Errors
/// A file of the project cannot be written.
pub fn write(place: &Place, runtime: &Unpacked, rust: &Emitted, folder: &Path) -> Result<(), Failure> {
    manifest(&place.folder, &place.name, runtime, rust.kind, PROGRAM_LEVEL)?;
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
            let start = if kind == Kind::Named { "main_named" } else { "main_with" };
            let call =
                format!("arl_rt::emit::program_main::{start}(program::Globals::new, &[\n{others}    ], {folder:?})");
            ("main.rs", format!("fn main() -> std::process::ExitCode {{\n    {drivers}\n    {call}\n}}\n"))
        }
    };
    write_if_changed(&source(file), format!("// Written by arl2rs.\n\n{modules}\n{crate_root}").as_bytes())?;
    Ok(())
}

/// The entry of an additional program, which became this module.
pub fn other(other: &EmittedOther, module: &str) -> String {
    let EmittedOther { file, folder, .. } = other;
    let make = format!("&|| Box::new({module}::Globals::new())");
    format!("arl_rt::emit::program_main::Other {{ file: {file:?}, folder: {folder:?}, make: {make} }},")
}

/// The optimisation level of programs: high enough for loops, and fast to compile.
const PROGRAM_LEVEL: u8 = 1;

/// How the runtime is compiled, which every user waits for once. The crates that move robots are as fast as possible,
/// in one codegen unit each: between units nothing small is inlined. The rest of the runtime is mostly called and
/// seldom loops, so small code is fast enough there. Crates that read files at the start, are only compiled where they
/// are used, or are not used at all, need no optimisation of their own.
const RUNTIME: &str = "\
arl-lang = { opt-level = 1, codegen-units = 2 }
arl-motion = { opt-level = 2, codegen-units = 1 }
arl-robot = { opt-level = 2, codegen-units = 1 }
arl-rt = { opt-level = \"s\", codegen-units = 8 }
arl-drivers = { opt-level = \"s\" }
encoding_rs = { opt-level = 0 }
libc = { opt-level = 0 }
libm = { opt-level = 2, codegen-units = 1 }
nalgebra = { opt-level = 0 }
quick-xml = { opt-level = \"s\" }
rustix = { opt-level = 0 }
simba = { opt-level = 0 }
toml = { opt-level = 0 }
toml_parser = { opt-level = 0 }
winnow = { opt-level = 0 }
";

/// The settings of the profile that affect what a program does, repeated where the user's settings cannot change them.
pub const SETTINGS: [&str; 6] = [
    "profile.dev.panic=\"unwind\"",
    "profile.dev.overflow-checks=false",
    "profile.dev.debug-assertions=false",
    "profile.release.panic=\"unwind\"",
    "profile.release.overflow-checks=false",
    "profile.release.debug-assertions=false",
];

/// Writes Cargo.toml, and Cargo.lock if the versions of other packages are known.
///
/// # Errors
/// One of them cannot be written.
pub fn manifest(folder: &Path, name: &str, runtime: &Unpacked, kind: Kind, level: u8) -> Result<(), Failure> {
    let (crate_type, library) = match kind {
        Kind::Library => ("[lib]\ncrate-type = [\"cdylib\"]\n\n", format!("arl-library = {}\n", runtime.library)),
        _ => ("", String::new()),
    };
    // Not `package."*"`: that would also optimise code that only runs during compilation.
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
    // cargo removes from the lock file what the project does not need, so a copy shows whether the original has
    // changed.
    let own = folder.join("Cargo.lock");
    if write_if_changed(&folder.join("base.lock"), &lock)? || !is_toml(&own) {
        std::fs::write(&own, &lock).map_err(|error| Failure::io("write", &own, &error))?;
    }
    Ok(())
}

/// Whether a file is valid TOML: the rest of a damaged one usually is not, and cargo would then always refuse it.
fn is_toml(path: &Path) -> bool {
    std::fs::read_to_string(path).is_ok_and(|text| toml::from_str::<toml::Table>(&text).is_ok())
}
