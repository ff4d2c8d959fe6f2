//! Compiling with cargo.

use crate::build_failure;
use crate::cache::{Lock, Made, remove_made};
use crate::package;
use arl_terminal::failure::Failure;
use arl_terminal::progress::Progress;
use arl_terminal::show;
use serde::Deserialize;
use std::collections::BTreeSet;
use std::io::{BufRead, BufReader, Read};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Instant;

/// What cargo made.
#[derive(Debug, Default)]
pub struct Built {
    /// The programs, or libraries, with their names.
    pub programs: Vec<(String, PathBuf)>,
    /// What rustc and cargo refused; empty when all went well.
    pub errors: Vec<RustError>,
    /// How many packages were compiled.
    compiled: usize,
    /// All that there is.
    artifacts: Vec<Artifact>,
}

/// Files that cargo made of one package.
#[derive(Debug)]
struct Artifact {
    manifest: PathBuf,
    files: Vec<PathBuf>,
    /// Whether they were made now.
    is_new: bool,
}

/// An error of rustc in emitted code.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct RustError {
    /// The file, as rustc names it: relative to the project.
    pub file: Option<String>,
    /// The error as rustc shows it.
    pub rendered: String,
}

/// Compiles the project in `folder`, with what is in `target`. What of that is damaged is made anew.
///
/// # Errors
/// cargo is not there or cannot be started, another package cannot be had, or the disk does not take what is made. What
/// rustc says of the program is not an error, but part of what comes back.
pub fn build(folder: &Path, target: &Path, release: bool, progress: &Progress) -> Result<Built, Failure> {
    let shared = target.parent().unwrap_or(target);
    // cargo lets one process at a time compile there, too.
    let _alone = Lock::take(&shared.join("compiling"), false, "waiting for another arl2rs that is compiling")?;
    let (mut own, mut others) = (Made::read(folder), Made::read(shared));
    // Who looks at a terminal sees what is done; others would take it for a standstill.
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
        // Where it cannot be removed, cargo or the linker says what is wrong.
        let _ = std::fs::remove_file(&file);
    }
    // Who is killed meanwhile has changed what was recorded.
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

/// cargo, which looks for settings from its own folder up to the root: there nobody but the system has any. Those of
/// `CARGO_HOME` say where packages come from and what links them, but not what the emitted code is compiled to.
fn command(folder: &Path, target: &Path, release: bool) -> Command {
    let mut command = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
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
    // Set to nothing they go before what settings say.
    for name in ["CARGO_ENCODED_RUSTFLAGS", "RUSTC_WRAPPER", "RUSTC_WORKSPACE_WRAPPER"] {
        command.env(name, "");
    }
    command.current_dir(folder.ancestors().last().unwrap_or(folder));
    command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
    command
}

/// Whether cargo is given a variable of the environment: of its own, and of rustc's, those that say where packages come
/// from, how many things it does at a time, and what links programs.
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

/// Lets cargo work, and gathers what it makes.
fn compile(built: &mut Built, mut command: Command, progress: &Progress) -> Result<(), Failure> {
    let cargo = Path::new(command.get_program()).to_path_buf();
    let mut child = command.spawn().map_err(|error| match error.kind() {
        std::io::ErrorKind::NotFound => Failure::Other(
            "cargo was not found: compiling needs Rust, see https://www.rust-lang.org/tools/install".into(),
        ),
        _ => Failure::io("run", &cargo, &error),
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
    if let Some(output) = child.stdout.take() {
        for line in BufReader::new(output).lines().map_while(Result::ok) {
            built.take(&line, progress);
        }
    }
    let status = child.wait().map_err(|error| Failure::io("wait for", &cargo, &error))?;
    let complaints = complaints.join().unwrap_or_default();
    // Who was ended from outside says nothing.
    let complaints = if complaints.trim().is_empty() { status.to_string() } else { complaints };
    if status.success() { Ok(()) } else { refused(built, complaints.trim_end()) }
}

/// Why something did not compile, unless that is the emitted code.
fn refused(built: &Built, complaints: &str) -> Result<(), Failure> {
    // Emitted Rust that is wrong has a place; what has none is about what is around the compiler.
    let around: BTreeSet<&str> =
        built.errors.iter().filter(|error| error.file.is_none()).map(|error| error.rendered.as_str()).collect();
    let around = if around.is_empty() { complaints.to_owned() } else { around.into_iter().collect() };
    if let Some(trouble) = build_failure::of(&anstream::adapter::strip_str(&around).to_string()) {
        return Err(Failure::Other(trouble));
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
