//! Compiles ARL in memory, and a cargo project of what was emitted, and runs its programs.

use arl2rs::emit::{EmitOptions, Sizes, emit};
use arl2rs::hir::Program;
use arl2rs::{CheckOptions, SourceError, Sources, check};
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// Source files in memory, by name.
#[derive(Clone, Default, Debug)]
pub struct Files(pub BTreeMap<PathBuf, Vec<u8>>);

impl Sources for Files {
    fn read(&self, path: &Path) -> Result<Vec<u8>, SourceError> {
        self.0.get(path).cloned().ok_or(SourceError::Missing)
    }
}

/// The Rust of a program, whose main file is the first, in the forms of programs of such sizes.
///
/// # Errors
/// The compile errors, a line each.
pub fn compile(files: &[(String, String)], sizes: Sizes) -> Result<String, String> {
    compile_for(files, &CheckOptions::default(), sizes)
}

/// The Rust of a program that is checked with these options.
///
/// # Errors
/// The compile errors, a line each.
pub fn compile_for(files: &[(String, String)], options: &CheckOptions, sizes: Sizes) -> Result<String, String> {
    let program = checked(files, options)?;
    Ok(emit(&program, &EmitOptions { sizes, ..EmitOptions::default() }))
}

/// The checked program.
///
/// # Errors
/// The compile errors, a line each.
pub fn checked(files: &[(String, String)], options: &CheckOptions) -> Result<Program, String> {
    let sources = Files(files.iter().map(|(name, text)| (name.into(), text.clone().into_bytes())).collect());
    let checked = check(Path::new(&files[0].0), &sources, options);
    match checked.program {
        Some(program) => Ok(program),
        None => {
            let errors =
                checked.diagnostics.iter().filter(|found| found.severity == arl2rs::diagnostics::Severity::Error);
            let mut text = String::new();
            for error in errors {
                let at = error.primary.at;
                let file = checked.files.get(at.file).map_or("?", |file| file.name.as_str());
                let _ = writeln!(text, "{file}:{}: {}", checked.files.line(at), error.message);
            }
            Err(text)
        }
    }
}

/// How a run ended, as the program of the project reports it.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Run {
    /// What was printed.
    pub out: Vec<u8>,
    /// `ended`, or `alarm NUMBER FILE LINE`.
    pub end: String,
}

/// Where projects are compiled: below the target folder of the workspace, whose compiled packages they share.
#[derive(Clone, Debug)]
pub struct Project {
    folder: PathBuf,
    target: PathBuf,
}

impl Project {
    /// The project of this name. `temporary` is cargo's folder for tests, `CARGO_TARGET_TMPDIR`.
    pub fn new(temporary: &str, name: &str) -> Self {
        let temporary = Path::new(temporary);
        Self { folder: temporary.join(name), target: temporary.parent().unwrap_or(temporary).to_path_buf() }
    }

    /// The folder.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    fn write(&self, path: &str, text: &str) {
        let path = self.folder.join(path);
        std::fs::create_dir_all(path.parent().expect("a file in a folder")).expect("a folder for a test");
        // Files that stay keep their times, so that cargo need not compile them again.
        if std::fs::read(&path).is_ok_and(|old| old == text.as_bytes()) {
            return;
        }
        std::fs::write(path, text).expect("a file for a test");
    }

    /// Compiles emitted programs, without a warning, into a command that runs them all.
    ///
    /// # Errors
    /// What rustc has to say.
    pub fn build(&self, programs: &[String]) -> Result<PathBuf, String> {
        self.cargo(&["build"], programs, &self.all(programs))?;
        Ok(self.target.join("debug").join(self.name()))
    }

    /// Compiles emitted programs into a command with the command line of a compiled program, that runs the one which
    /// [`Project::choose`] names; optimised where `ARL_PROPERTY_OPTIMISED` is set.
    ///
    /// # Errors
    /// What rustc has to say.
    pub fn build_choosing(&self, programs: &[String]) -> Result<PathBuf, String> {
        let library = self.library();
        let mut arms = String::new();
        for at in 0..programs.len() {
            let _ = writeln!(arms, "        \"{at}\" => run({library}::p{at}::Globals::new, \".\"),");
        }
        let optimised = std::env::var_os(OPTIMISED).is_some();
        let what: &[&str] = if optimised { &["build", "--release"] } else { &["build"] };
        self.cargo(what, programs, &CHOOSING.replace("CHOICE", CHOICE).replace("ARMS", &arms))?;
        Ok(self.target.join(if optimised { "release" } else { "debug" }).join(self.name()))
    }

    /// A run of the program `at` of a command that [`Project::build_choosing`] made, in the project's folder.
    pub fn choose(&self, command: &Path, at: usize) -> Command {
        let mut command = Command::new(command);
        command.env(CHOICE, at.to_string()).current_dir(&self.folder);
        command
    }

    /// Lets rustc look at emitted programs without compiling them.
    ///
    /// # Errors
    /// What rustc has to say, warnings included.
    pub fn check(&self, programs: &[String]) -> Result<(), String> {
        self.cargo(&["check"], programs, &self.all(programs))
    }

    /// The main file that runs all programs.
    fn all(&self, programs: &[String]) -> String {
        let library = self.library();
        let mut list = String::new();
        for at in 0..programs.len() {
            let _ = writeln!(list, "    run({at}, || Box::new({library}::p{at}::Globals::new()));");
        }
        MAIN.replace("LIST", &list)
    }

    fn name(&self) -> String {
        self.folder.file_name().expect("a name").to_string_lossy().into_owned()
    }

    fn library(&self) -> String {
        self.name().replace('-', "_")
    }

    fn cargo(&self, what: &[&str], programs: &[String], main: &str) -> Result<(), String> {
        let workspace = Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("the workspace");
        let name = self.name();
        self.write("Cargo.toml", &manifest(&name, workspace));
        if let Ok(lock) = std::fs::read_to_string(workspace.join("Cargo.lock")) {
            self.write("workspace.lock", &lock);
            if !self.folder.join("Cargo.lock").exists() {
                self.write("Cargo.lock", &lock);
            }
        }
        let _ = std::fs::remove_dir_all(self.folder.join("src/programs"));
        let mut modules = String::from("#![deny(warnings)]\n\n");
        for (at, program) in programs.iter().enumerate() {
            self.write(&format!("src/programs/p{at}.rs"), program);
            let _ = write!(modules, "#[path = \"programs/p{at}.rs\"]\npub mod p{at};\n");
        }
        self.write("src/lib.rs", &modules);
        self.write("src/main.rs", main);
        let mut command = Command::new(std::env::var_os("CARGO").unwrap_or("cargo".into()));
        command.args(what).args(["--quiet", "--offline", "--message-format=short"]).current_dir(&self.folder);
        command.env("CARGO_TARGET_DIR", &self.target).env_remove("RUSTFLAGS").env("CARGO_INCREMENTAL", "0");
        let output = command.output().expect("cargo runs");
        match output.status.success() {
            true => Ok(()),
            false => Err(String::from_utf8_lossy(&output.stderr).into_owned()),
        }
    }

    /// Runs all programs of a command that [`Project::build`] made.
    ///
    /// # Panics
    /// When the command does not end, or ends in another way than by its own.
    pub fn run(&self, command: &Path, count: usize) -> Vec<Run> {
        let mut child = Command::new(command).stdout(Stdio::piped()).spawn().expect("a compiled program");
        let mut stdout = child.stdout.take().expect("a pipe");
        let reader = std::thread::spawn(move || {
            let mut bytes = Vec::new();
            stdout.read_to_end(&mut bytes).map(|_| bytes)
        });
        let start = Instant::now();
        let status = loop {
            if let Some(status) = child.try_wait().expect("a child") {
                break Some(status);
            }
            if start.elapsed() > Duration::from_secs(120) {
                let _ = child.kill();
                break None;
            }
            std::thread::sleep(Duration::from_millis(5));
        };
        let bytes = reader.join().expect("a reader").expect("output");
        let runs = runs(&bytes);
        let last = runs.len();
        assert!(status.is_some(), "program {last} of {} does not end", self.folder.display());
        assert!(status.is_some_and(|status| status.success()), "program {last} of {} dies", self.folder.display());
        assert_eq!(last, count);
        runs
    }
}

/// Takes the report of a command apart: for each program the bytes printed, their number in front, and its end.
fn runs(mut bytes: &[u8]) -> Vec<Run> {
    let mut runs = Vec::new();
    let line = |bytes: &mut &[u8]| {
        let end = bytes.iter().position(|byte| *byte == b'\n')?;
        let line = String::from_utf8_lossy(&bytes[..end]).into_owned();
        *bytes = &bytes[end + 1..];
        Some(line)
    };
    while let Some(header) = line(&mut bytes) {
        let (length, end) = header.split_once(' ').expect("a number and an end");
        let (out, rest) = bytes.split_at(length.parse().expect("a number"));
        runs.push(Run { out: out.to_vec(), end: end.into() });
        bytes = rest;
    }
    runs
}

fn manifest(name: &str, workspace: &Path) -> String {
    let runtime = workspace.join("arl-rt").display().to_string();
    format!(
        "[package]\nname = \"{name}\"\nversion = \"0.0.0\"\nedition = \"2024\"\npublish = false\n\n[workspace]\n\n\
         [dependencies]\narl-rt = {{ path = {runtime:?}, default-features = false, features = [\"serial\"] }}\n\n\
         [profile.dev]\ndebug = false\n\n\
         [profile.dev.package]\narl-motion = {{ opt-level = 2 }}\narl-robot = {{ opt-level = 2 }}\n\
         arl-rt = {{ opt-level = 1 }}\nnalgebra = {{ opt-level = 2 }}\nsimba = {{ opt-level = 2 }}\n\n\
         [profile.release]\nopt-level = 2\ncodegen-units = 16\n"
    )
}

/// Says that programs shall be optimised.
const OPTIMISED: &str = "ARL_PROPERTY_OPTIMISED";

/// Names the program to run.
const CHOICE: &str = "ARL_TEST_PROGRAM";

/// Runs one program as its command line says.
const CHOOSING: &str = r#"use arl_rt::emit::program_main::main as run;
use std::process::ExitCode;

fn main() -> ExitCode {
    match std::env::var("CHOICE").unwrap_or_default().as_str() {
ARMS        other => panic!("there is no program {other}"),
    }
}
"#;

/// Runs every program, each for a minute of the controller's time at most.
const MAIN: &str = r#"use arl_rt::{Controller, Message, Outcome, Program, State};
use std::cell::RefCell;
use std::io::Write;
use std::rc::Rc;

fn run(at: usize, program: impl FnOnce() -> Box<dyn Program>) {
    let out = Rc::new(RefCell::new(Vec::new()));
    let kept = Rc::clone(&out);
    let mut controller = Controller::builder()
        .output(move |message: &Message<'_>| {
            let mut out = kept.borrow_mut();
            out.extend_from_slice(message.text);
            if !message.text.ends_with(b"\n") {
                out.push(b'\n');
            }
        })
        .build(program())
        .unwrap();
    let state = controller.run_for(60.0);
    let end = match controller.outcome() {
        _ if state != State::Ended => format!("still running, program {at}"),
        Some(Outcome::Alarm(alarm)) => {
            format!("alarm {} {} {}", alarm.fault.number(), alarm.file.name(), alarm.line)
        }
        Some(_) => "ended".into(),
        None => "no outcome".into(),
    };
    drop(controller);
    let out = out.borrow();
    let mut stdout = std::io::stdout().lock();
    writeln!(stdout, "{} {end}", out.len()).unwrap();
    stdout.write_all(&out).unwrap();
    stdout.flush().unwrap();
}

fn main() {
    std::thread::Builder::new().stack_size(256 << 20).spawn(all).unwrap().join().unwrap();
}

fn all() {
LIST}
"#;
