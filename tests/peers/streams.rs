//! Sockets and serial lines with servers in Python and pseudo terminals of socat.

use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use crate::peer::{self, Server};
use crate::robot::{self, Robot};

/// Runs a program against a server of this manner, whose port it finds in a file; what it printed.
fn with_server(manner: &str, program: &str) -> Option<String> {
    let python = peer::python(&["socket"])?;
    let server = Server::start(Command::new(python).arg(peer::script("stream_server.py")).arg(manner));
    robot::file(&format!("{manner}.port"), &server.first_line);
    let end = Robot::start(program, "").end();
    assert_eq!(end.code, Some(0), "{}{}", end.out, end.stderr);
    Some(end.out)
}

#[test]
fn an_echo_comes_back() {
    let Some(out) = with_server("echo", "echo") else { return };
    assert_eq!(out, "hello\nworld\n{00h,ffh,80h,0ah}\ntrue40960\n");
}

#[test]
fn lines_are_answered_on_two_connections() {
    let Some(out) = with_server("lines", "lines") else { return };
    assert_eq!(out, "3 ONE\n5 THREE\n3 TWO\n");
}

#[test]
fn an_interrupt_connects_again() {
    let Some(out) = with_server("flaky", "reconnect") else { return };
    assert_eq!(out, format!("{}true\n", "hello\n".repeat(5)));
}

/// A serial line whose other end is a command.
struct Pty {
    child: Child,
    path: PathBuf,
}

impl Pty {
    fn start(name: &str, command: &str) -> Option<Self> {
        if !peer::command("socat") {
            return None;
        }
        let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("{name}-{}", std::process::id()));
        let _ = std::fs::remove_file(&path);
        let ends = [format!("pty,raw,echo=0,link={}", path.display()), format!("EXEC:{command}")];
        let child = Command::new("socat").args(ends).stdin(Stdio::null()).stdout(Stdio::null()).spawn().unwrap();
        let start = Instant::now();
        while !path.exists() {
            assert!(start.elapsed() < Duration::from_secs(10), "socat makes no pseudo terminal");
            std::thread::sleep(Duration::from_millis(5));
        }
        Some(Self { child, path })
    }

    fn cell(&self) -> String {
        format!("[serial]\ncom1 = {:?}\n", self.path.display().to_string())
    }
}

impl Drop for Pty {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
        let _ = std::fs::remove_file(&self.path);
    }
}

#[test]
fn a_serial_line_has_all_settings_of_the_manual() {
    let Some(line) = Pty::start("echoing-line", "cat") else { return };
    let end = Robot::start("serial_line", &line.cell()).end();
    let printed = format!("{}worl\n{}{{01h,02h,03h,04h}}\nfalse\n", "true\n".repeat(10), "true\n".repeat(4));
    assert_eq!((end.out, end.code), (printed, Some(3)), "{}", end.stderr);
    assert!(end.stderr.contains("another program has it open") || end.stderr.contains("busy"), "{}", end.stderr);
    assert!(end.stderr.contains("alarm 20050: open: the connection is already open: close it first"), "{}", end.stderr);
}

#[test]
fn a_serial_line_that_goes_away_is_an_alarm() {
    let Some(line) = Pty::start("lost-line", "head -c 1") else { return };
    let end = Robot::start("serial_lost", &line.cell()).end();
    assert_eq!((end.out.as_str(), end.code), ("true\nx\n", Some(3)), "{}", end.stderr);
    assert!(end.stderr.contains("alarm 20050: read: the line is lost: "), "{}", end.stderr);
}
