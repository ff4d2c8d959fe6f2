//! The front end for build scripts: turns ARL programs into modules of a Rust crate.

use crate::compile::{Compiled, compile_program, on_large_stack};
use crate::diagnostics::{Diagnostic, Severity};
use crate::emit::EmitOptions;
use crate::render::{plain, plain_block};
use crate::sources::{FileSystem, write_if_changed};
use crate::{CheckOptions, Sources};
use arl_lang::catalog::Family;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// Compiles ARL programs in a build script.
///
/// ```no_run
/// // build.rs
/// arl2rs::Build::new().program("robot/pick.arl").compile();
/// ```
///
/// ```ignore
/// // src/main.rs
/// mod picking {
///     arl_rt::include_arl!("pick");
/// }
/// ```
///
/// Paths are relative to the folder of Cargo.toml. cargo runs the script again when a file that was read or looked for
/// changes; an output file is written only when its content changes. Errors in the programs fail the build and are
/// shown with their positions.
#[derive(Clone, Debug, Default)]
#[must_use = "nothing happens before `compile`"]
pub struct Build {
    programs: Vec<(String, PathBuf)>,
    options: CheckOptions,
    errors_in_code: bool,
    silent: bool,
    copies: Option<PathBuf>,
}

impl Build {
    /// A build without programs.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a program, given by the file that has `main`. It becomes `NAME.rs` in `OUT_DIR`.
    pub fn program(self, main: impl Into<PathBuf>) -> Self {
        let main = main.into();
        self.program_as(name(&main), main)
    }

    /// Adds a program that is called `name` instead of being called after its file.
    pub fn program_as(mut self, name: impl Into<String>, main: impl Into<PathBuf>) -> Self {
        self.programs.push((name.into(), main.into()));
        self
    }

    /// Sets the kind of robot that the programs are for; six-axis by default.
    pub fn family(mut self, family: Family) -> Self {
        self.options.family = family;
        self
    }

    /// Also warns where the compiler accepts what the controller would not.
    pub fn strict(mut self, strict: bool) -> Self {
        self.options.strict = strict;
        self
    }

    /// Sets the folder that `/home/ae/script/` stands for in an import; each program's own folder by default.
    pub fn script_dir(mut self, folder: impl Into<PathBuf>) -> Self {
        self.options.script_dir = Some(folder.into());
        self
    }

    /// Turns errors in ARL into `compile_error!` in the emitted file instead of errors of the build script. The file
    /// then also contains the last correct version of the program, so that editors still understand the rest of the
    /// crate.
    pub fn errors_in_code(mut self, yes: bool) -> Self {
        self.errors_in_code = yes;
        self
    }

    /// Sets whether cargo shows warnings; it does by default.
    pub fn warnings(mut self, show: bool) -> Self {
        self.silent = !show;
        self
    }

    /// Also writes the emitted files to this folder, to be read or committed.
    pub fn copy_to(mut self, folder: impl Into<PathBuf>) -> Self {
        self.copies = Some(folder.into());
        self
    }

    /// Compiles everything. Prints to standard output what cargo needs to know: files to watch, warnings, errors. If
    /// there was an error, cargo ends the build after the script.
    pub fn compile(self) {
        #[expect(clippy::disallowed_methods, reason = "cargo says so where the files go")]
        let out = std::env::var_os("OUT_DIR").map(PathBuf::from);
        let lines = match out {
            Some(out) => self.compile_into(&out),
            None => vec!["cargo::error=OUT_DIR is not set: arl2rs::Build is for build scripts".into()],
        };
        for line in lines {
            println!("{line}");
        }
    }

    /// Compiles into a folder, for callers that are not cargo build scripts. Returns the lines that [`Build::compile`]
    /// prints for cargo: `cargo::rerun-if-changed=..`, `cargo::warning=..`, `cargo::error=..`.
    pub fn compile_into(&self, out: &Path) -> Vec<String> {
        on_large_stack(|| self.lines(out, &FileSystem))
    }

    fn lines(&self, out: &Path, sources: &dyn Sources) -> Vec<String> {
        let mut watched = BTreeSet::new();
        let mut lines = Vec::new();
        let mut names: Vec<(&str, &Path)> = Vec::new();
        for (name, main) in &self.programs {
            if let Some((_, other)) = names.iter().find(|(other, _)| other == name) {
                lines.push(format!(
                    "cargo::error={} and {} would both become {name}.rs: give one of them another name with `program_as`",
                    other.display(),
                    main.display()
                ));
                continue;
            }
            names.push((name, main));
            let compiled = match compile_program(main, sources, &self.options, &EmitOptions::default()) {
                Ok(compiled) => compiled,
                Err(bug) => {
                    lines.push(error_line(&format!("{}: {bug}", main.display())));
                    watched.insert(main.clone());
                    continue;
                }
            };
            for path in compiled.read() {
                watched.insert(watchable(&path, out));
            }
            lines.extend(self.output(&compiled, name, out));
        }
        let mut all: Vec<String> = watched
            .into_iter()
            .filter(|path| !path.as_os_str().is_empty())
            .map(|path| format!("cargo::rerun-if-changed={}", path.display()))
            .collect();
        all.push("cargo::rerun-if-changed=build.rs".into());
        all.extend(lines);
        all
    }

    /// Writes the output of one program and returns the lines for cargo.
    fn output(&self, compiled: &Compiled, name: &str, out: &Path) -> Vec<String> {
        let files = compiled.shown_files();
        let text_of = |diagnostic: &Diagnostic| plain(diagnostic, &files);
        let all = &compiled.checked.diagnostics;
        let mut lines: Vec<String> = all
            .iter()
            .filter(|diagnostic| diagnostic.severity == Severity::Warning && !self.silent)
            .map(|warning| format!("cargo::warning={}", text_of(warning)))
            .collect();
        let last_good = out.join(format!("{name}.last.rs"));
        let text = match &compiled.rust {
            Some(rust) => rust.clone(),
            None if self.errors_in_code => {
                let errors = compiled.errors().map(|error| plain_block(error, &files));
                let errors: String =
                    errors.map(|error| format!("::core::compile_error!({});\n", raw(&error))).collect();
                errors + &read_last(&last_good)
            }
            None => {
                lines.extend(compiled.errors().map(|error| error_line(&text_of(error))));
                return lines;
            }
        };
        let mut targets = vec![out.join(format!("{name}.rs"))];
        if compiled.rust.is_some() {
            targets.push(last_good);
            targets.extend(self.copies.as_ref().map(|folder| folder.join(format!("{name}.rs"))));
        }
        for target in targets {
            if let Err(error) = write_if_changed(&target, text.as_bytes()) {
                lines.push(error_line(&format!("cannot write {}: {error}", target.display())));
            }
        }
        lines
    }
}

/// A text as a raw string: rustc shows the line of an error, and escapes in it would be unreadable.
fn raw(text: &str) -> String {
    let text = text.replace('\r', "");
    let mut hashes = "#".to_owned();
    while text.contains(&format!("\"{hashes}")) {
        hashes.push('#');
    }
    format!("r{hashes}\"{text}\"{hashes}")
}

/// The code with which a crate can be checked as long as there is no correct version of the program.
const NOTHING_YET: &str = "\
/// The program has errors.
pub struct Globals {}

impl Globals {
    /// The program has errors.
    pub fn new() -> Self {
        Self {}
    }
}
";

#[expect(clippy::disallowed_methods, reason = "this is a door")]
fn read_last(path: &Path) -> String {
    std::fs::read_to_string(path).unwrap_or_else(|_| NOTHING_YET.into())
}

fn error_line(text: &str) -> String {
    format!("cargo::error={}", text.replace(['\n', '\r'], " "))
}

fn name(main: &Path) -> String {
    main.file_stem().map(|stem| stem.to_string_lossy().to_lowercase()).unwrap_or_default()
}

/// The path to watch. cargo considers a file that does not exist always changed, so its folder is watched instead,
/// unless cargo itself writes below that folder.
#[expect(clippy::disallowed_methods, reason = "this is a door")]
fn watchable(path: &Path, out: &Path) -> PathBuf {
    if path.exists() {
        return path.to_path_buf();
    }
    let folder = path.parent().unwrap_or(Path::new(""));
    let real = |path: &Path| std::fs::canonicalize(path).ok();
    let contains_output = match (real(if folder.as_os_str().is_empty() { Path::new(".") } else { folder }), real(out)) {
        (Some(folder), Some(out)) => out.starts_with(folder),
        _ => true,
    };
    if contains_output { PathBuf::new() } else { folder.to_path_buf() }
}

#[cfg(test)]
#[expect(clippy::disallowed_methods, reason = "tests look at what was written")]
mod tests {
    use super::*;

    struct Folder(PathBuf);

    impl Folder {
        fn new(name: &str) -> Self {
            let path = std::env::temp_dir().join(format!("arl2rs-build-{name}-{}", std::process::id()));
            std::fs::create_dir_all(path.join("out")).expect("a folder");
            std::fs::create_dir_all(path.join("robot")).expect("a folder");
            Self(path)
        }

        fn program(&self, name: &str, text: &str) -> PathBuf {
            let path = self.0.join("robot").join(name);
            std::fs::write(&path, text).expect("a file");
            path
        }

        fn out(&self, name: &str) -> PathBuf {
            self.0.join("out").join(name)
        }

        fn lines(&self, build: &Build) -> Vec<String> {
            build.lines(&self.0.join("out"), &FileSystem)
        }
    }

    impl Drop for Folder {
        fn drop(&mut self) {
            let _ = std::fs::remove_dir_all(&self.0);
        }
    }

    const GOOD: &str = "func void main()\n    int unused = 1\n    print 1\nendfunc\n";
    const BAD: &str = "func void main()\n    prnt 1\n    goto no\nendfunc\n";

    #[test]
    fn every_file_is_watched_and_warnings_are_reported() {
        let folder = Folder::new("watch");
        let main = folder.program("a.arl", &format!("import \"m.arl\"\n{GOOD}"));
        folder.program("m.arl", "int x = 1\n");
        folder.program("a_data.arl", "int y = 1\n");
        let lines = folder.lines(&Build::new().program(&main));
        let robot = folder.0.join("robot");
        let watched: Vec<String> =
            lines.iter().filter_map(|line| line.strip_prefix("cargo::rerun-if-changed=").map(Into::into)).collect();
        // m_data.arl does not exist: its folder is watched, so that its creation is noticed.
        let expected = [robot.clone(), main, robot.join("a_data.arl"), robot.join("m.arl"), PathBuf::from("build.rs")];
        assert_eq!(watched, expected.map(|path| path.display().to_string()));
        assert!(lines.iter().any(|line| line.starts_with("cargo::warning=") && line.contains("a.arl:3:")), "{lines:?}");
        assert!(!lines.iter().any(|line| line.starts_with("cargo::error=")), "{lines:?}");
        let silent = folder.lines(&Build::new().program(folder.0.join("robot/a.arl")).warnings(false));
        assert!(!silent.iter().any(|line| line.starts_with("cargo::warning=")), "{silent:?}");
    }

    #[test]
    fn a_folder_that_cargo_writes_below_is_not_watched() {
        let folder = Folder::new("root");
        let main = folder.0.join("a.arl");
        std::fs::write(&main, GOOD).expect("a file");
        let lines = folder.lines(&Build::new().program(&main));
        assert!(!lines.contains(&format!("cargo::rerun-if-changed={}", folder.0.display())), "{lines:?}");
        assert!(!lines.contains(&"cargo::rerun-if-changed=".to_string()), "{lines:?}");
    }

    #[test]
    fn errors_are_reported_on_one_line_each_and_nothing_is_written() {
        let folder = Folder::new("errors");
        let main = folder.program("a.arl", BAD);
        let lines = folder.lines(&Build::new().program(&main));
        let errors: Vec<&String> = lines.iter().filter(|line| line.starts_with("cargo::error=")).collect();
        assert_eq!(errors.len(), 2, "{lines:?}");
        assert!(errors[0].contains("a.arl:2:5: ARL0211: "), "{errors:?}");
        assert!(lines.iter().all(|line| !line.contains('\n')));
        assert!(!folder.out("a.rs").exists());
    }

    #[test]
    fn errors_in_code_keep_the_last_good_program() {
        let folder = Folder::new("code");
        let main = folder.program("a.arl", BAD);
        let build = Build::new().program(&main).errors_in_code(true);
        let text = || std::fs::read_to_string(folder.out("a.rs")).expect("the file");
        assert!(!folder.lines(&build).iter().any(|line| line.starts_with("cargo::error=")));
        assert!(text().contains("compile_error!") && text().contains("pub struct Globals"));
        folder.program("a.arl", GOOD);
        folder.lines(&build);
        let good = text();
        assert!(!good.contains("compile_error!"));
        folder.program("a.arl", BAD);
        folder.lines(&build);
        assert_eq!(text().matches("compile_error!").count(), 2);
        assert!(text().ends_with(&good));
    }

    #[test]
    fn files_are_written_only_when_they_change_and_copied_where_wanted() {
        let folder = Folder::new("copies");
        let main = folder.program("a.arl", GOOD);
        let build = Build::new().program(&main).copy_to(folder.0.join("copies"));
        folder.lines(&build);
        let time = || std::fs::metadata(folder.out("a.rs")).and_then(|data| data.modified()).expect("a time");
        let (first, copy) = (time(), std::fs::read(folder.0.join("copies/a.rs")).expect("a copy"));
        assert_eq!(copy, std::fs::read(folder.out("a.rs")).expect("the file"));
        folder.lines(&build);
        assert_eq!(time(), first);
    }

    #[test]
    fn names_stand_for_one_program_each() {
        let folder = Folder::new("names");
        let main = folder.program("a.arl", GOOD);
        let twice = folder.lines(&Build::new().program(&main).program(&main));
        assert!(twice.iter().any(|line| line.starts_with("cargo::error=") && line.contains("program_as")));
        let lines = folder.lines(&Build::new().program(&main).program_as("b", &main));
        assert!(!lines.iter().any(|line| line.starts_with("cargo::error=")), "{lines:?}");
        assert!(folder.out("b.rs").exists());
    }
}
