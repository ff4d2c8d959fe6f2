//! Cases compiled together, in a few programs.

use arl_project::cache::{Kind, Place, write_if_changed};
use arl_project::cargo::{self, RustError};
use arl_project::package::{self, Emitted};
use arl_project::runtime::Unpacked;
use arl_terminal::failure::Failure;
use arl_terminal::progress::Progress;
use std::collections::{BTreeMap, HashMap};
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::{Path, PathBuf};

/// A case as Rust.
pub(super) struct EmittedCase {
    /// The ARL file.
    pub(super) source: PathBuf,
    /// Its Rust code, with the programs that its cell names.
    pub(super) rust: Emitted,
}

/// The program that has a case, and the name to start it by.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) struct Compiled {
    pub(super) program: PathBuf,
    pub(super) name: String,
    /// The code of the case, where this command runs it.
    pub(super) code: Option<PathBuf>,
}

/// The environment variable that names the case to run.
pub(super) const CASE: &str = "ARL2RS_CASE";

/// Compiles all cases; returns for each, in their order, the program or rustc's errors.
pub(super) fn compile(
    place: &Place,
    runtime: &Unpacked,
    cases: &[EmittedCase],
    progress: &Progress,
) -> Result<Vec<Result<Compiled, String>>, Failure> {
    let names: Vec<String> = cases.iter().map(|case| name(&case.source)).collect();
    let parts = parts(cases.len());
    let mut refused: HashMap<usize, String> = HashMap::new();
    // Errors that rustc finds late hide behind those that it finds early, so a few rounds may be needed.
    for _ in 0..4 {
        let kept = || (0..cases.len()).filter(|at| !refused.contains_key(at));
        write(place, runtime, cases, &names, kept(), parts)?;
        let built = cargo::build(&place.folder, &runtime.target(), false, progress)?;
        if built.errors.is_empty() {
            let programs: HashMap<String, PathBuf> = built.programs.into_iter().collect();
            return Ok(names
                .iter()
                .enumerate()
                .map(|(at, name)| match (refused.get(&at), programs.get(&part_name(place, part(name, parts)))) {
                    (Some(errors), _) => Err(errors.clone()),
                    (None, Some(program)) => Ok(Compiled { program: program.clone(), name: name.clone(), code: None }),
                    (None, None) => Err("cargo did not make its program".into()),
                })
                .collect());
        }
        let before = refused.len();
        for error in &built.errors {
            blame(error, &names, &mut refused);
        }
        if refused.len() == before {
            return Err(cargo::bug(&built.errors, Path::new("every case")));
        }
    }
    Err(Failure::Other("bug in arl2rs: the emitted Rust does not compile, whichever case is left out".into()))
}

/// Separates the name of a case from the number of a program beside it.
const BESIDE: &str = "__beside_";

/// Notes an error for the case whose file it is in.
fn blame(error: &RustError, names: &[String], refused: &mut HashMap<usize, String>) {
    let stem = error.file.as_deref().and_then(|file| Path::new(file).file_stem()).unwrap_or_default();
    let stem = stem.to_string_lossy();
    let stem = stem.split(BESIDE).next().unwrap_or_default();
    if let Some(at) = names.iter().position(|name| stem == name) {
        *refused.entry(at).or_default() += &error.rendered;
    }
}

/// How many programs the cases are compiled into: rustc works on several at once.
fn parts(cases: usize) -> usize {
    let workers = std::thread::available_parallelism().map_or(1, usize::from);
    workers.min(cases.div_ceil(40)).clamp(1, 8)
}

/// The part that a case belongs to, whatever other cases there are.
fn part(name: &str, parts: usize) -> usize {
    let mut hasher = DefaultHasher::new();
    name.hash(&mut hasher);
    (hasher.finish() % parts as u64) as usize
}

/// All places compile into one folder, so that each needs names of its own.
fn part_name(place: &Place, part: usize) -> String {
    format!("{}-part{part}", place.name)
}

/// A Rust name for a case: readable, and different for every path.
pub(super) fn name(source: &Path) -> String {
    let mut hasher = DefaultHasher::new();
    source.hash(&mut hasher);
    let stem = source.file_stem().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
    let stem: String = stem.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect();
    format!("case_{stem}_{:08x}", hasher.finish() as u32)
}

fn write(
    place: &Place,
    runtime: &Unpacked,
    cases: &[EmittedCase],
    names: &[String],
    kept: impl Iterator<Item = usize>,
    parts: usize,
) -> Result<(), Failure> {
    package::manifest(&place.folder, &place.name, runtime, Kind::Program, 0)?;
    let bin = place.folder.join("src/bin");
    let mut programs: BTreeMap<usize, (String, String)> = (0..parts).map(|part| (part, Default::default())).collect();
    for at in kept {
        let (Some(case), Some(name)) = (cases.get(at), names.get(at)) else { continue };
        let (modules, arms) = programs.entry(part(name, parts)).or_default();
        let mut add = |name: &str, rust: &str| {
            *modules += &format!("#[path = \"../cases/{name}.rs\"]\nmod {name};\n");
            write_if_changed(&place.folder.join(format!("src/cases/{name}.rs")), rust.as_bytes())
        };
        add(name, &case.rust.first)?;
        let mut others = String::new();
        for (at, other) in case.rust.others.iter().enumerate() {
            let beside = format!("{name}{BESIDE}{at}");
            add(&beside, &other.rust)?;
            others += &package::other(other, &beside);
        }
        let folder = case.source.parent().unwrap_or(Path::new("/")).display().to_string();
        *arms += &format!("        \"{name}\" => (&|| Box::new({name}::Globals::new()), &[{others}], {folder:?}),\n");
    }
    for (part, (modules, arms)) in &programs {
        let text = format!(
            "// Written by arl2rs.\n#![allow(warnings)]\n\n{modules}\n\
             use arl_rt::emit::program_main::{{Make, Other, main_with}};\n\n\
             fn main() -> std::process::ExitCode {{\n    let case = std::env::var(\"{CASE}\").unwrap_or_default();\n    \
             let (make, others, folder): (Make, &[Other], &str) = match case.as_str() {{\n{arms}        \
             _ => return std::process::ExitCode::from(2),\n    }};\n    main_with(make, others, folder)\n}}\n"
        );
        write_if_changed(&bin.join(format!("{}.rs", part_name(place, *part))), text.as_bytes())?;
    }
    remove_others(&bin, |name| programs.keys().any(|part| name == format!("{}.rs", part_name(place, *part))));
    let case = |file: &str| file.strip_suffix(".rs").and_then(|stem| stem.split(BESIDE).next()).map(str::to_owned);
    remove_others(&place.folder.join("src/cases"), |file| case(file).is_some_and(|case| names.contains(&case)));
    Ok(())
}

/// Removes what earlier runs left.
fn remove_others(folder: &Path, keep: impl Fn(&str) -> bool) {
    let Ok(entries) = std::fs::read_dir(folder) else { return };
    for entry in entries.filter_map(Result::ok) {
        if !keep(&entry.file_name().to_string_lossy()) {
            // Files that stay are not compiled, except for parts, which cargo would complain about.
            let _ = std::fs::remove_file(entry.path());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_rust_names_and_differ_by_folder() {
        let one = name(Path::new("/a/Two words-3.arl"));
        assert!(one.starts_with("case_two_words_3_"));
        assert_ne!(one, name(Path::new("/b/Two words-3.arl")));
    }

    #[test]
    fn errors_are_blamed_on_their_case() {
        let names = ["case_a_1".to_string(), "case_b_2".to_string()];
        let mut refused = HashMap::new();
        let error = |file: Option<&str>| RustError { file: file.map(Into::into), rendered: "E".into() };
        blame(&error(Some("src/bin/../cases/case_b_2.rs")), &names, &mut refused);
        blame(&error(Some("src/bin/../cases/case_a_1__beside_0.rs")), &names, &mut refused);
        blame(&error(Some("src/bin/part0.rs")), &names, &mut refused);
        blame(&error(None), &names, &mut refused);
        assert_eq!(refused, HashMap::from([(0, "E".to_string()), (1, "E".to_string())]));
    }
}
