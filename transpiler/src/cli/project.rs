//! The cargo project that a program is compiled in.

use super::cache::{Place, write_if_changed};
use super::failure::Failure;
use super::runtime::Runtime;
use std::path::Path;

/// Writes the project of one program.
pub(super) fn write(place: &Place, runtime: &Runtime, rust: &str, folder: &Path) -> Result<(), Failure> {
    manifest(&place.folder, &place.name, runtime, PROGRAM_LEVEL)?;
    write_if_changed(&place.folder.join("src/main.rs"), main_rs(folder).as_bytes())?;
    write_if_changed(&place.folder.join("src/program.rs"), rust.as_bytes())?;
    Ok(())
}

/// Writes the project of several programs: the first one, and others under the names that the cell file gives them.
pub(super) fn write_several(
    place: &Place,
    runtime: &Runtime,
    first: &str,
    others: &[(&str, String)],
    folder: &Path,
) -> Result<(), Failure> {
    manifest(&place.folder, &place.name, runtime, PROGRAM_LEVEL)?;
    let mut modules = String::from("mod program;\n");
    let mut makers = String::new();
    write_if_changed(&place.folder.join("src/program.rs"), first.as_bytes())?;
    for (at, (name, rust)) in others.iter().enumerate() {
        write_if_changed(&place.folder.join(format!("src/program_{at}.rs")), rust.as_bytes())?;
        modules += &format!("mod program_{at};\n");
        makers += &format!("        Other {{ file: {name:?}, make: || Box::new(program_{at}::Globals::new()) }},\n");
    }
    let text = format!(
        "// Written by arl2rs.\n\n{modules}\nuse arl_rt::program_main::{{Other, main_with}};\n\n\
         fn main() -> std::process::ExitCode {{\n    let others = [\n{makers}    ];\n    \
         main_with(program::Globals::new, &others, {:?})\n}}\n",
        folder.display().to_string()
    );
    write_if_changed(&place.folder.join("src/main.rs"), text.as_bytes())?;
    Ok(())
}

/// How far programs are optimised: far enough for loops, and soon done.
const PROGRAM_LEVEL: u8 = 1;

/// What reads files at the start, or is not used at all, needs no optimisation: it would take longer to compile.
const READERS: &str = "\
arl-lang = { opt-level = 1 }
encoding_rs = { opt-level = 0 }
simba = { opt-level = 1 }
toml = { opt-level = 0 }
toml_parser = { opt-level = 0 }
wide = { opt-level = 0 }
winnow = { opt-level = 0 }
";

/// Writes Cargo.toml, and Cargo.lock where the versions of other packages are known.
pub(super) fn manifest(folder: &Path, name: &str, runtime: &Runtime, level: u8) -> Result<(), Failure> {
    // Not `package."*"`: that would also optimise what only runs while compiling.
    let text = format!(
        "# Written by arl2rs.\n\
         [package]\nname = \"{name}\"\nversion = \"0.0.0\"\nedition = \"2024\"\npublish = false\n\n\
         [workspace]\n\n\
         [dependencies]\narl-rt = {}\n\n\
         [profile.dev]\nopt-level = 3\ndebug = false\nincremental = true\noverflow-checks = false\n\
         debug-assertions = false\n\n\
         [profile.dev.package]\n\"{name}\" = {{ opt-level = {level} }}\n\
         {READERS}\n\
         [profile.release]\nlto = \"thin\"\n",
        runtime.dependency()
    );
    write_if_changed(&folder.join("Cargo.toml"), text.as_bytes())?;
    let Some(lock) = runtime.lock_file().and_then(|path| std::fs::read(path).ok()) else { return Ok(()) };
    // cargo takes out of the lock file what the project does not need, so a copy tells whether the original changed.
    if write_if_changed(&folder.join("base.lock"), &lock)? {
        std::fs::write(folder.join("Cargo.lock"), &lock)
            .map_err(|error| Failure::io("write", &folder.join("Cargo.lock"), &error))?;
    }
    Ok(())
}

fn main_rs(folder: &Path) -> String {
    format!(
        "// Written by arl2rs.\n\nmod program;\n\nfn main() -> std::process::ExitCode {{\n    \
         arl_rt::program_main::main(program::Globals::new, {:?})\n}}\n",
        folder.display().to_string()
    )
}
