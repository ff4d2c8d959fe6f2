//! Compiling with cargo.

use super::failure::{Failure, INTERRUPTED};
use super::progress::Progress;
use super::trouble;
use serde::Deserialize;
use std::collections::BTreeSet;
use std::io::{BufRead, BufReader, Read};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};

/// What cargo made.
#[derive(Debug, Default)]
pub(super) struct Built {
    /// The programs, or libraries, with their names.
    pub(super) programs: Vec<(String, PathBuf)>,
    /// What rustc and cargo refused; empty when all went well.
    pub(super) errors: Vec<RustError>,
    /// How many packages were compiled.
    compiled: usize,
}

/// An error of rustc in emitted code.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) struct RustError {
    /// The file, as rustc names it: relative to the project.
    pub(super) file: Option<String>,
    /// The error as rustc shows it.
    pub(super) rendered: String,
}

/// Whether Ctrl-C is for the program that runs in front of this process.
static LEFT_TO_PROGRAM: AtomicBool = AtomicBool::new(false);
/// Whether Ctrl-C was pressed since.
static WAS_PRESSED: AtomicBool = AtomicBool::new(false);

/// Makes Ctrl-C end the command with its exit code. cargo is of the same group of processes, and ends by itself.
pub(super) fn end_on_interrupt() {
    // Without a handler the process still ends, only with another code.
    let _ = ctrlc::set_handler(|| {
        if !LEFT_TO_PROGRAM.load(Ordering::Relaxed) {
            std::process::exit(i32::from(INTERRUPTED));
        }
        WAS_PRESSED.store(true, Ordering::Relaxed);
    });
}

/// From now on Ctrl-C is the running program's business.
pub(super) fn leave_interrupts_to_the_program() {
    LEFT_TO_PROGRAM.store(true, Ordering::Relaxed);
}

/// Whether Ctrl-C was pressed while it was the program's business.
pub(super) fn was_interrupted() -> bool {
    WAS_PRESSED.load(Ordering::Relaxed)
}

/// Compiles the project in `folder`.
pub(super) fn build(folder: &Path, target: &Path, release: bool, progress: &Progress) -> Result<Built, Failure> {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let mut command = Command::new(&cargo);
    command
        .args(["build", "--quiet", "--keep-going", "--message-format=json-diagnostic-rendered-ansi", "--target-dir"])
        .arg(target);
    if release {
        command.arg("--release");
    }
    // What the emitted code is compiled with must not depend on what the user compiles.
    for name in
        ["CARGO_TARGET_DIR", "CARGO_BUILD_TARGET", "CARGO_INCREMENTAL", "RUSTC_WRAPPER", "CARGO_ENCODED_RUSTFLAGS"]
    {
        command.env_remove(name);
    }
    command.current_dir(folder).stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().map_err(|error| match error.kind() {
        std::io::ErrorKind::NotFound => Failure::Other(
            "cargo was not found: compiling needs Rust, see https://www.rust-lang.org/tools/install".into(),
        ),
        _ => Failure::io("run", Path::new(&cargo), &error),
    })?;
    let errors = child.stderr.take();
    let complaints = std::thread::spawn(move || {
        let mut text = String::new();
        if let Some(mut errors) = errors {
            // What cannot be read cannot be shown.
            let _ = errors.read_to_string(&mut text);
        }
        text
    });
    let mut built = Built::default();
    if let Some(output) = child.stdout.take() {
        for line in BufReader::new(output).lines().map_while(Result::ok) {
            built.take(&line, progress);
        }
    }
    let status = child.wait().map_err(|error| Failure::io("wait for", Path::new(&cargo), &error))?;
    let complaints = complaints.join().unwrap_or_default();
    if status.success() {
        return Ok(built);
    }
    // Emitted Rust that is wrong has a place; what has none is about what is around the compiler.
    let around: BTreeSet<&str> =
        built.errors.iter().filter(|error| error.file.is_none()).map(|error| error.rendered.as_str()).collect();
    let around = if around.is_empty() { complaints.clone() } else { around.into_iter().collect() };
    if let Some(trouble) = trouble::of(&anstream::adapter::strip_str(&around).to_string()) {
        return Err(Failure::Other(trouble));
    }
    if built.errors.is_empty() {
        return Err(Failure::Other(format!("cargo could not compile the program:\n{}", complaints.trim_end())));
    }
    Ok(built)
}

#[derive(Deserialize)]
struct Message {
    reason: String,
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
                // Beside it there are what other linkers want.
                let is_library = target.as_ref().is_some_and(|target| target.kind.iter().any(|kind| kind == "cdylib"));
                let library = message.filenames.into_iter().find(|file| is_library && is_loadable(file));
                let name = target.map(|target| target.name).unwrap_or_default();
                // What is there already comes first, and at once.
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

/// Whether a file is a library that can be loaded here.
fn is_loadable(file: &Path) -> bool {
    file.extension().is_some_and(|ending| ending == std::env::consts::DLL_EXTENSION)
}

/// What is said while packages are compiled: those of the runtime come first, once for all programs.
fn words(compiled: usize, last: &str) -> String {
    format!("compiling the runtime, once for all programs: {compiled} packages done, last {last}")
}

/// An error with a place; the closing "aborting due to 2 previous errors" has none and is left out.
fn error(message: Rustc) -> Option<RustError> {
    if !message.level.starts_with("error") || message.message.starts_with("aborting due to") {
        return None;
    }
    let file = message.spans.iter().find(|span| span.is_primary).map(|span| span.file_name.clone());
    Some(RustError { file, rendered: message.rendered.unwrap_or(message.message) })
}

/// What to say when the emitted Rust does not compile: that is never the user's mistake.
pub(super) fn bug(errors: &[RustError], main: &Path) -> Failure {
    let shown: String = errors.iter().take(3).map(|error| error.rendered.clone()).collect();
    Failure::Other(format!(
        "bug in arl2rs {}: {} is a correct program, but the Rust that it became does not compile; please report it \
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
