//! Compiling with cargo.

use crate::build_failure;
use crate::cache::{Lock, Made, remove_made};
use crate::package;
use arl_terminal::failure::Failure;
use arl_terminal::progress::Progress;
use arl_terminal::show;
use serde::Deserialize;
use std::collections::BTreeSet;
use std::ffi::OsString;
use std::io::{BufRead, BufReader, Read};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Instant;

/// The output of cargo.
#[derive(Debug, Default)]
pub struct Built {
    /// The programs or libraries, with their names.
    pub programs: Vec<(String, PathBuf)>,
    /// The errors of rustc and cargo; empty on success.
    pub errors: Vec<RustError>,
    /// The number of packages that were compiled.
    compiled: usize,
    /// All files, including those that existed already.
    artifacts: Vec<Artifact>,
}

/// Files that cargo made of one package.
#[derive(Debug)]
struct Artifact {
    manifest: PathBuf,
    files: Vec<PathBuf>,
    /// Whether they were made in this build.
    is_new: bool,
}

/// An error of rustc in emitted code.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct RustError {
    /// The file as rustc names it: relative to the project.
    pub file: Option<String>,
    /// The error as rustc shows it.
    pub rendered: String,
}

/// Compiles the project in `folder`, using the files in `target`. Damaged files are made again.
///
/// # Errors
/// cargo does not exist or cannot be started, another package cannot be obtained, or the output cannot be written to
/// the disk. Errors of rustc in the program are not returned as an error but are part of the result.
pub fn build(folder: &Path, target: &Path, release: bool, progress: &Progress) -> Result<Built, Failure> {
    if !is_there() {
        return Err(missing());
    }
    let shared = target.parent().unwrap_or(target);
    // cargo also lets only one process at a time compile there.
    let _alone = Lock::take(&shared.join("compiling"), false, "waiting for another arl2rs that is compiling")?;
    let (mut own, mut others) = (Made::read(folder), Made::read(shared));
    // On a terminal the progress is shown; otherwise the build would seem to stand still.
    let profile = target.join(if release { "release" } else { "debug" });
    let is_first = !profile.join("deps").is_dir() && !show::is_watched();
    let begun = Instant::now();
    if is_first {
        show::say("compiling the runtime, once for all programs: this takes a minute or two\n");
    }
    let damaged = own.take_damaged();
    if !damaged.is_empty() {
        remove_made(folder, target);
    }
    for file in damaged.into_iter().chain(others.take_damaged()) {
        show::warning(&format!("{} is damaged: it is compiled anew", file.display()));
        // If it cannot be removed, cargo or the linker reports the problem.
        let _ = std::fs::remove_file(&file);
    }
    // A process killed from here on has changed the recorded files.
    own.forget();
    others.forget();
    let mut built = Built::default();
    let compiled = compile(&mut built, command(folder, target, release), progress);
    for Artifact { manifest, files, is_new } in &built.artifacts {
        let made = if manifest.starts_with(folder) { &mut own } else { &mut others };
        files.iter().for_each(|file| made.add(file, *is_new));
    }
    own.write();
    others.write();
    compiled?;
    if is_first {
        show::say(&format!("compiled in {:.0} s\n", begun.elapsed().as_secs_f64()));
    }
    Ok(built)
}

/// The name or the path of cargo.
fn program() -> OsString {
    std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into())
}

/// Whether there is a cargo on this computer.
pub fn is_there() -> bool {
    let program = PathBuf::from(program());
    if program.components().count() > 1 {
        return program.is_file();
    }
    let path = std::env::var_os("PATH").unwrap_or_default();
    let mut name = program.into_os_string();
    name.push(std::env::consts::EXE_SUFFIX);
    std::env::split_paths(&path).any(|folder| folder.join(&name).is_file())
}

fn missing() -> Failure {
    let rust = "https://www.rust-lang.org/tools/install";
    let text = "cargo was not found: compiling needs Rust";
    Failure::Other(format!("{text} ({rust}); without `--engine native` programs run at once, and need none"))
}

/// The cargo command. cargo looks for settings from its working folder up to the root, so it runs in the root, where
/// only the system has settings. Those of `CARGO_HOME` determine where packages come from and what links them, but not
/// how the emitted code is compiled.
fn command(folder: &Path, target: &Path, release: bool) -> Command {
    let mut command = Command::new(program());
    command
        .args(["build", "--quiet", "--keep-going", "--message-format=json-diagnostic-rendered-ansi", "--manifest-path"])
        .arg(folder.join("Cargo.toml"))
        .arg("--target-dir")
        .arg(target);
    if release {
        command.arg("--release");
    }
    for setting in package::SETTINGS {
        command.args(["--config", setting]);
    }
    for (name, _) in std::env::vars_os().filter(|(name, _)| !is_kept(&name.to_string_lossy())) {
        command.env_remove(name);
    }
    // Set to nothing, these take precedence over settings.
    for name in ["CARGO_ENCODED_RUSTFLAGS", "RUSTC_WRAPPER", "RUSTC_WORKSPACE_WRAPPER"] {
        command.env(name, "");
    }
    command.current_dir(folder.ancestors().last().unwrap_or(folder));
    command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
    command
}

/// Whether cargo receives an environment variable. Of its own variables and those of rustc, only those are kept that
/// determine where packages come from, how many jobs run at a time, and what links programs.
fn is_kept(name: &str) -> bool {
    const KEPT: [&str; 6] =
        ["CARGO_HOME", "CARGO_HTTP_", "CARGO_NET_", "CARGO_REGISTR", "CARGO_SOURCE_", "CARGO_BUILD_JOBS"];
    const OTHERS: [&str; 6] = [
        "RUSTFLAGS",
        "RUSTDOCFLAGS",
        "RUSTC_WRAPPER",
        "RUSTC_WORKSPACE_WRAPPER",
        "RUSTC_BOOTSTRAP",
        "__CARGO_DEFAULT_LIB_METADATA",
    ];
    let links = name.starts_with("CARGO_TARGET_") && name.ends_with("_LINKER");
    match name.starts_with("CARGO_") {
        true => links || KEPT.iter().any(|kept| name.starts_with(kept)),
        false => !OTHERS.contains(&name),
    }
}

/// Runs cargo and collects its output.
fn compile(built: &mut Built, mut command: Command, progress: &Progress) -> Result<(), Failure> {
    let cargo = Path::new(command.get_program()).to_path_buf();
    let mut child = command.spawn().map_err(|error| match error.kind() {
        std::io::ErrorKind::NotFound => missing(),
        _ => Failure::io("run", &cargo, &error),
    })?;
    let errors = child.stderr.take();
    let complaints = std::thread::spawn(move || {
        let mut text = String::new();
        if let Some(mut errors) = errors {
            // Output that cannot be read cannot be shown.
            let _ = errors.read_to_string(&mut text);
        }
        text
    });
    if let Some(output) = child.stdout.take() {
        for line in BufReader::new(output).lines().map_while(Result::ok) {
            built.take(&line, progress);
        }
    }
    let status = child.wait().map_err(|error| Failure::io("wait for", &cargo, &error))?;
    let complaints = complaints.join().unwrap_or_default();
    // A process that was killed prints nothing.
    let complaints = if complaints.trim().is_empty() { status.to_string() } else { complaints };
    if status.success() { Ok(()) } else { refused(built, complaints.trim_end()) }
}

/// The reason why something did not compile, unless it is the emitted code.
fn refused(built: &Built, complaints: &str) -> Result<(), Failure> {
    // An error in emitted Rust has a position; one without a position concerns the environment of the compiler.
    let around: BTreeSet<&str> =
        built.errors.iter().filter(|error| error.file.is_none()).map(|error| error.rendered.as_str()).collect();
    let around = if around.is_empty() { complaints.to_owned() } else { around.into_iter().collect() };
    if let Some(explanation) = build_failure::of(&anstream::adapter::strip_str(&around).to_string()) {
        return Err(Failure::Other(explanation));
    }
    if built.errors.is_empty() {
        return Err(Failure::Other(format!("cargo could not compile the program:\n{complaints}")));
    }
    Ok(())
}

#[derive(Deserialize)]
struct Message {
    reason: String,
    #[serde(default)]
    manifest_path: PathBuf,
    executable: Option<PathBuf>,
    #[serde(default)]
    filenames: Vec<PathBuf>,
    fresh: Option<bool>,
    message: Option<Rustc>,
    target: Option<Target>,
}

#[derive(Deserialize)]
struct Target {
    name: String,
    #[serde(default)]
    kind: Vec<String>,
}

#[derive(Deserialize)]
struct Rustc {
    level: String,
    rendered: Option<String>,
    message: String,
    #[serde(default)]
    spans: Vec<RustcSpan>,
}

#[derive(Deserialize)]
struct RustcSpan {
    file_name: String,
    is_primary: bool,
}

impl Built {
    fn take(&mut self, line: &str, progress: &Progress) {
        let Ok(message) = serde_json::from_str::<Message>(line) else { return };
        match message.reason.as_str() {
            "compiler-artifact" => {
                let target = message.target;
                self.artifacts.push(Artifact {
                    manifest: message.manifest_path,
                    files: message.filenames.clone(),
                    is_new: message.fresh == Some(false),
                });
                // There may also be files for other linkers.
                let is_library = target.as_ref().is_some_and(|target| target.kind.iter().any(|kind| kind == "cdylib"));
                let library = message.filenames.into_iter().find(|file| is_library && is_loadable(file));
                let name = target.map(|target| target.name).unwrap_or_default();
                // Packages that exist already come first, all at once.
                if message.fresh == Some(false) {
                    self.compiled += 1;
                    progress.say(&words(self.compiled, &name));
                }
                self.programs.extend(message.executable.or(library).map(|file| (name, file)));
            }
            "compiler-message" => self.errors.extend(message.message.and_then(error)),
            _ => {}
        }
    }
}

/// Whether a file is a library that can be loaded on this system.
fn is_loadable(file: &Path) -> bool {
    file.extension().is_some_and(|ending| ending == std::env::consts::DLL_EXTENSION)
}

/// The message while packages are compiled: those of the runtime come first, once for all programs.
fn words(compiled: usize, last: &str) -> String {
    format!("compiling the runtime, once for all programs: {compiled} packages done, last {last}")
}

/// An error with its file; the closing "aborting due to 2 previous errors" is left out.
fn error(message: Rustc) -> Option<RustError> {
    if !message.level.starts_with("error") || message.message.starts_with("aborting due to") {
        return None;
    }
    let file = message.spans.iter().find(|span| span.is_primary).map(|span| span.file_name.clone());
    Some(RustError { file, rendered: message.rendered.unwrap_or(message.message) })
}

/// The message if the emitted Rust does not compile, which is never the user's error.
pub fn bug(errors: &[RustError], main: &Path) -> Failure {
    let shown: String = errors.iter().take(3).map(|error| error.rendered.clone()).collect();
    Failure::Other(format!(
        "bug in arl2rs {}: {} is a correct program, but the Rust code generated from it does not compile; please report it \
         together with the program\n{}",
        env!("CARGO_PKG_VERSION"),
        main.display(),
        shown.trim_end()
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn messages_of_cargo() {
        let progress = Progress::start("test");
        let mut built = Built::default();
        built.take(r#"{"reason":"compiler-artifact","target":{"name":"a"},"executable":"/t/a"}"#, &progress);
        built.take(r#"{"reason":"compiler-artifact","target":{"name":"b"},"executable":null}"#, &progress);
        built.take(
            r#"{"reason":"compiler-message","message":{"level":"error","message":"mismatched types","rendered":"R",
               "spans":[{"file_name":"src/other.rs","is_primary":false},{"file_name":"src/program.rs","is_primary":true}]}}"#,
            &progress,
        );
        built.take(
            r#"{"reason":"compiler-message","message":{"level":"error","message":"aborting due to 1 previous error"}}"#,
            &progress,
        );
        built.take(r#"{"reason":"compiler-message","message":{"level":"warning","message":"unused"}}"#, &progress);
        built.take("not json", &progress);
        assert_eq!(built.programs, [("a".to_string(), PathBuf::from("/t/a"))]);
        let expected = RustError { file: Some("src/program.rs".into()), rendered: "R".into() };
        assert_eq!(built.errors, [expected]);
    }
}
