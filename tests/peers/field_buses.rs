//! Modbus and the MC protocol with other people's clients and servers.

use std::path::Path;
use std::process::Command;

use crate::peer::{self, Server};
use crate::robot::{self, End, Robot, run};

const CELL: &str = "[modbus_tcp]\nport = 0\n";
const LISTENS: &str = "warning: the Modbus TCP server listens on 127.0.0.1:";

#[test]
fn pymodbus_reads_and_writes_registers_and_coils() {
    let Some(python) = peer::python(&["pymodbus"]) else { return };
    let mut robot = Robot::start("modbus_tcp", CELL);
    let port = robot.wait_for_line(LISTENS);
    run(Command::new(python).arg(peer::script("modbus_master.py")).args(["tcp", &port]));
    let end = robot.end();
    assert_eq!((end.out.as_str(), end.code), ("{81h,05h}\nabcd\n", Some(0)), "{}", end.stderr);
}

#[test]
fn mbpoll_reads_and_writes_registers_and_coils() {
    if !peer::command("mbpoll") {
        return;
    }
    let mut robot = Robot::start("modbus_tcp", CELL);
    let port = robot.wait_for_line(LISTENS);
    let poll = |arguments: &[&str]| {
        let mut command = Command::new("mbpoll");
        command.args(["-m", "tcp", "-p", &port, "-0", "-1", "-q"]);
        run(command.args(arguments))
    };
    let read = poll(&["-t", "4", "-r", "100", "-c", "2", "127.0.0.1"]);
    assert!(read.contains("258") && read.contains("772"), "{read}");
    poll(&["-t", "0", "-r", "10", "127.0.0.1", "1", "0", "0", "0", "0", "0", "0", "1", "1", "0", "1"]);
    poll(&["-t", "4", "-r", "20", "127.0.0.1", "24930", "25444"]);
    poll(&["-t", "4", "-r", "0", "127.0.0.1", "7"]);
    let end = robot.end();
    assert_eq!((end.out.as_str(), end.code), ("{81h,05h}\nabcd\n", Some(0)), "{}", end.stderr);
}

/// A pair of pseudo terminals that are connected, by their paths.
fn lines(name: &str) -> (Server, [String; 2]) {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    let path = |end: &str| folder.join(format!("{name}-{}-{end}", std::process::id())).display().to_string();
    let paths = [path("a"), path("b")];
    // A socat that was killed leaves its links.
    paths.iter().for_each(|path| drop(std::fs::remove_file(path)));
    let pty = |path: &String| format!("pty,raw,echo=0,link={path}");
    let mut socat = Command::new("socat");
    let server = Server::spawn(socat.args([pty(&paths[0]), pty(&paths[1])]));
    while !paths.iter().all(|path| std::fs::exists(path).unwrap_or(false)) {
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    (server, paths)
}

#[test]
fn a_master_on_a_serial_line_reads_and_writes_registers() {
    let Some(python) = peer::python(&["pymodbus", "serial"]) else { return };
    if !peer::command("socat") || !peer::command("mbpoll") {
        return;
    }
    let (_socat, [ours, theirs]) = lines("rtu");
    let mut robot = Robot::start("modbus_rtu", &format!("[serial]\nrtserMB0 = \"{ours}\"\n"));
    assert_eq!(robot.first_line(), "open: true");
    let mut poll = Command::new("mbpoll");
    poll.args([
        "-m", "rtu", "-a", "17", "-b", "19200", "-P", "none", "-0", "-1", "-q", "-t", "4", "-r", "50", "-c", "2",
    ]);
    let read = run(poll.arg(&theirs));
    assert!(read.contains("258") && read.contains("772"), "{read}");
    run(Command::new(python).arg(peer::script("modbus_master.py")).args(["rtu", &theirs]));
    let end = robot.end();
    assert_eq!((end.out.as_str(), end.code), ("abcd\n6162h 6364h\n{00h,00h}\n", Some(0)), "{}", end.stderr);
}

#[test]
fn a_slave_keeps_silent_on_a_bad_line_and_tells_when_it_is_lost() {
    let Some(python) = peer::python(&["serial"]) else { return };
    if !peer::command("socat") {
        return;
    }
    let (socat, [ours, theirs]) = lines("noise");
    let mut robot = Robot::start("modbus_rtu_lost", &format!("[serial]\nrtserMB0 = \"{ours}\"\n"));
    assert_eq!(robot.first_line(), "open: true");
    run(Command::new(python).arg(peer::script("rtu_noise.py")).arg(&theirs));
    drop(socat);
    let end = robot.end();
    assert_eq!((end.out.as_str(), end.code), ("", Some(3)), "{}", end.stderr);
    assert!(end.stderr.contains("alarm 20050: read: the line is lost: "), "{}", end.stderr);
}

/// The server of the tests' own, which other people's clients have looked at.
fn melsec_server() -> Option<(Server, std::ffi::OsString)> {
    let python = peer::python(&["pymcprotocol", "slmp"])?;
    let server = Server::start(Command::new(&python).arg(peer::script("melsec_server.py")));
    Some((server, python))
}

#[test]
fn the_melsec_server_is_what_other_clients_expect() {
    let Some((server, python)) = melsec_server() else { return };
    run(Command::new(python).arg(peer::script("melsec_clients.py")).arg(&server.first_line));
}

#[test]
fn d_registers_are_written_and_read() {
    let Some((server, python)) = melsec_server() else { return };
    run(Command::new(python).arg(peer::script("melsec_clients.py")).arg(&server.first_line));
    robot::file("melsec.port", &server.first_line);
    let End { out, stderr, code } = Robot::start("melsec", "").end();
    let printed = "hello\n{01h,02h,03h,04h,05h,00h,09h,09h}\n4 a z\n4dh\nrefused: true\n";
    assert_eq!((out.as_str(), code), (printed, Some(3)), "{stderr}");
    assert!(stderr.contains("read: the PLC refused the request with code c056h (melsec.arl:25)"), "{stderr}");
    assert!(stderr.contains("alarm 20050: read: the connection is not open (melsec.arl:29)"), "{stderr}");
}
