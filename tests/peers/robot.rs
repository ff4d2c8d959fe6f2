//! Programs in ARL, compiled once for all tests, and their runs.

use std::io::{BufRead, BufReader, Read};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStderr, Command, Stdio};
use std::sync::LazyLock;

use arl_tests::project::{Project, compile};
use arl2rs::emit::Sizes;

static PROGRAMS: LazyLock<Programs> = LazyLock::new(Programs::build);

struct Programs {
    project: Project,
    command: PathBuf,
    names: Vec<String>,
}

impl Programs {
    fn build() -> Self {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("peers/programs");
        let mut files: Vec<PathBuf> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
        files.sort();
        let names = files.iter().map(|file| file.file_stem().unwrap().to_string_lossy().into_owned()).collect();
        let rust = files.iter().map(|file| {
            let (name, text) = (file.file_name().unwrap().to_string_lossy(), std::fs::read_to_string(file).unwrap());
            compile(&[(name.into_owned(), text)], Sizes::DEFAULT).unwrap()
        });
        let project = Project::new(env!("CARGO_TARGET_TMPDIR"), "arl-peers");
        let command = project.build_choosing(&rust.collect::<Vec<_>>()).unwrap();
        Self { project, command, names }
    }
}

/// Leaves a file for programs.
pub(crate) fn file(name: &str, text: &str) {
    std::fs::write(PROGRAMS.project.folder().join(name), text).unwrap();
}

/// A run of a program on the real clock.
pub(crate) struct Robot {
    child: Child,
    stderr: BufReader<ChildStderr>,
}

/// How a run ended.
#[derive(PartialEq, Eq, Debug)]
pub(crate) struct End {
    /// What was printed.
    pub(crate) out: String,
    /// What stood on the standard error, but for how busy the computer was.
    pub(crate) stderr: String,
    pub(crate) code: Option<i32>,
}

impl Robot {
    /// Starts `programs/NAME.arl` in a cell.
    pub(crate) fn start(name: &str, cell: &str) -> Self {
        let programs = &*PROGRAMS;
        let at = programs.names.iter().position(|known| known == name).expect("a program of this name");
        let file = programs.project.folder().join(format!("{name}-{:?}.toml", std::thread::current().id()));
        std::fs::write(&file, cell).unwrap();
        let mut command = programs.project.choose(&programs.command, at);
        command.arg("--cell").arg(file).args(["--clock", "real", "--max-time", "60"]);
        let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        let stderr = BufReader::new(child.stderr.take().unwrap());
        Self { child, stderr }
    }

    /// Waits for a line on the standard error that begins so; what follows there.
    pub(crate) fn wait_for_line(&mut self, start: &str) -> String {
        let mut line = String::new();
        loop {
            line.clear();
            assert!(self.stderr.read_line(&mut line).unwrap() > 0, "the run ended without saying \"{start}\"");
            if let Some(rest) = line.trim_end().strip_prefix(start) {
                return rest.into();
            }
        }
    }

    /// Waits for the first line that the program prints.
    pub(crate) fn first_line(&mut self) -> String {
        let mut line = Vec::new();
        let out = self.child.stdout.as_mut().unwrap();
        // Not one byte more, for whoever reads on.
        while line.last() != Some(&b'\n') {
            let mut byte = [0];
            assert!(out.read(&mut byte).unwrap() == 1, "the run ended without printing anything");
            line.push(byte[0]);
        }
        String::from_utf8(line).unwrap().trim_end().into()
    }

    /// Waits for the end of the run.
    pub(crate) fn end(mut self) -> End {
        let (mut out, mut stderr) = (String::new(), String::new());
        self.child.stdout.take().unwrap().read_to_string(&mut out).unwrap();
        self.stderr.read_to_string(&mut stderr).unwrap();
        let stderr = stderr.split_inclusive('\n').filter(|line| !line.contains(" control cycles began late")).collect();
        End { out, stderr, code: self.child.wait().unwrap().code() }
    }
}

impl Drop for Robot {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// Runs a peer's command to its end.
///
/// # Panics
/// It fails: what it said.
pub(crate) fn run(command: &mut Command) -> String {
    let output = command.output().unwrap();
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    assert!(output.status.success(), "{command:?}: {}{}", text(&output.stdout), text(&output.stderr));
    text(&output.stdout)
}
