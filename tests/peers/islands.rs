//! Io islands that are other people's servers of Modbus TCP.

use std::process::Command;

use crate::peer::{self, Server};
use crate::robot::{End, Robot, run};

/// An island in a manner, at a port (0: any that is free).
fn island(port: &str, manner: &str) -> Option<Server> {
    let python = peer::python(&["pymodbus"])?;
    let server = Server::start(Command::new(python).arg(peer::script("island_server.py")).args([port, manner]));
    assert!(!server.first_line.is_empty(), "the island does not start");
    Some(server)
}

fn cell(port: &str, more: &str) -> String {
    format!(
        "[[island]]\nname = \"peer\"\naddress = \"127.0.0.1\"\nport = {port}\n\
         di = [{{ channel = 1, count = 10, discrete_input = 0 }}]\ndo = [{{ channel = 1, count = 8, coil = 0 }}]\n\
         ai = [{{ channel = 1, count = 2, input_register = 0, raw = [-1000, 1000] }}]\n\
         ao = [{{ channel = 1, holding_register = 0, raw = [-10000, 10000] }}]\n{more}"
    )
}

/// What the program prints when all goes well.
const PRINTED: &str = "135 -2.5 7.5\nset\nseen\n";

#[test]
fn inputs_are_read_and_outputs_written() {
    if !peer::command("mbpoll") {
        return;
    }
    let Some(island) = island("0", "answer") else { return };
    let End { out, stderr, code } = Robot::start("island", &cell(&island.first_line, "")).end();
    assert_eq!((out.as_str(), stderr.as_str(), code), (PRINTED, "", Some(0)));
    // The run has ended: all outputs are off.
    let poll = |table: &str, count: &str| {
        let mut command = Command::new("mbpoll");
        command.args(["-m", "tcp", "-p", &island.first_line, "-0", "-1", "-q", "-t", table, "-r", "0", "-c", count]);
        run(command.arg("127.0.0.1"))
    };
    let values = |text: String| -> Vec<String> {
        let lines = text.lines().filter_map(|line| line.strip_prefix('[')?.split_once("]:"));
        lines.map(|(_, value)| value.trim().to_string()).collect()
    };
    assert_eq!(values(poll("0", "8")), ["0"; 8]);
    assert_eq!(values(poll("4", "1")), ["0"]);
}

#[test]
fn an_island_that_comes_back_gets_its_outputs_anew() {
    let Some(first) = island("0", "wait") else { return };
    let port = first.first_line.clone();
    let mut robot = Robot::start("island", &cell(&port, "lost = \"warning\"\ninputs = \"hold\"\n"));
    assert_eq!(robot.first_line(), "135 -2.5 7.5");
    drop(first);
    let message = robot.wait_for_line(&format!("warning: the island peer (127.0.0.1:{port}) is lost: "));
    assert!(message.ends_with("its inputs stay as they were"), "{message}");
    let Some(_second) = island(&port, "answer") else { return };
    let End { out, stderr, code } = robot.end();
    assert_eq!((out.as_str(), code), ("set\nseen\n", Some(0)), "{stderr}");
    assert!(stderr.contains("is back"), "{stderr}");
}

#[test]
fn an_island_that_goes_silent_or_talks_nonsense_stops_the_program() {
    for (manner, words) in
        [("silent", "it has not answered for 200 ms"), ("garbage", "what it sends is not a Modbus TCP response")]
    {
        let Some(island) = island("0", manner) else { return };
        let End { out, stderr, code } = Robot::start("island", &cell(&island.first_line, "timeout = 200\n")).end();
        assert_eq!((out.as_str(), code), ("135 -2.5 7.5\nset\n", Some(3)), "{stderr}");
        assert!(stderr.contains("alarm 20051: the island peer (127.0.0.1:") && stderr.contains(words), "{stderr}");
        assert!(stderr.contains("(island.arl:8)"), "{stderr}");
    }
}

#[test]
fn what_an_island_refuses_is_reported_at_the_start() {
    let Some(island) = island("0", "answer") else { return };
    let cell = cell(&island.first_line, "").replace("input_register = 0", "input_register = 1");
    let End { out, stderr, code } = Robot::start("island", &cell).end();
    assert_eq!((out.as_str(), code), ("", Some(2)), "{stderr}");
    assert!(stderr.contains("it refuses input registers 1 to 2 with exception 2: it does not have these"), "{stderr}");
}

#[test]
fn without_an_island_nothing_starts() {
    let End { out, stderr, code } = Robot::start("island", &cell("1", "")).end();
    assert_eq!((out.as_str(), code), ("", Some(2)), "{stderr}");
    assert!(stderr.contains("error: the island peer (127.0.0.1:1) is not available: cannot connect to"), "{stderr}");
}
