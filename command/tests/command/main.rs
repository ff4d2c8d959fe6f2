//! The command line, as users see it.
#![allow(clippy::expect_used, reason = "tests read and write files, and may fail")]

mod cache;
mod checking;
mod collisions;
mod formatting;
mod keys;
mod killing;
mod odd_files;
mod pointers;
mod projects;
mod recording;
mod repeating;
mod results;
mod running;
mod several;
mod standstill;
mod sweeping;
mod system_variables;
mod telling;
mod testing;
mod view;

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// A folder for one test, removed at the end.
struct Folder {
    path: PathBuf,
}

impl Folder {
    fn new(name: &str) -> Self {
        let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("command").join(name);
        let _ = std::fs::remove_dir_all(&path);
        std::fs::create_dir_all(&path).expect("a folder");
        Self { path }
    }

    fn with(self, name: &str, text: &str) -> Self {
        self.write(name, text);
        self
    }

    fn write(&self, name: &str, text: &str) {
        let path = self.path.join(name);
        std::fs::create_dir_all(path.parent().expect("a parent")).expect("a folder");
        std::fs::write(path, text).expect("a file");
    }

    fn read(&self, name: &str) -> String {
        std::fs::read_to_string(self.path.join(name)).expect("the file is there")
    }

    fn has(&self, name: &str) -> bool {
        self.path.join(name).exists()
    }

    /// The command in this folder; compiled programs of all tests share a cache, so that the runtime is compiled once.
    fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_arl2rs"));
        command.args(arguments).current_dir(&self.path).env("ARL2RS_CACHE", cache()).env("NO_COLOR", "1");
        command
    }

    fn arl2rs(&self, arguments: &[&str]) -> Answer {
        let answer = Answer::of(self.command(arguments).output().expect("the command starts"));
        // Which test comes first, and compiles the runtime, says nothing about it.
        let of_first = ["compiling the runtime", "compiled in"];
        let lines =
            answer.err.split_inclusive('\n').filter(|line| !of_first.iter().any(|first| line.starts_with(first)));
        Answer { err: lines.collect(), ..answer }
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.path);
    }
}

fn cache() -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).join("cache")
}

/// What the command said.
#[derive(PartialEq, Eq, Debug)]
struct Answer {
    code: Option<i32>,
    out: String,
    err: String,
}

impl Answer {
    fn of(output: Output) -> Self {
        Self {
            code: output.status.code(),
            out: String::from_utf8_lossy(&output.stdout).into_owned(),
            err: String::from_utf8_lossy(&output.stderr).into_owned(),
        }
    }

    #[track_caller]
    fn is(&self, code: i32, out: &str) -> &Self {
        assert_eq!((self.code, self.out.as_str()), (Some(code), out), "standard error: {}", self.err);
        self
    }

    #[track_caller]
    fn says(&self, words: &str) -> &Self {
        assert!(self.err.contains(words), "`{words}` is not in: {}", self.err);
        self
    }
}
