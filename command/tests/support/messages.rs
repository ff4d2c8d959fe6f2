//! Messages of editors over streams, for clients of the command's servers.

use serde_json::Value;
use std::io::{BufRead, BufReader, Read, Write};
use std::process::{ChildStdin, ChildStdout};
use std::sync::mpsc::{Receiver, channel};

/// Sends the text of a message.
pub(crate) fn send(input: &mut ChildStdin, text: &str) {
    write!(input, "Content-Length: {}\r\n\r\n{text}", text.len()).expect("the server reads");
    input.flush().expect("the server reads");
}

/// The messages that come out of a server.
pub(crate) fn messages(output: ChildStdout) -> Receiver<Value> {
    let (sender, receiver) = channel();
    std::thread::spawn(move || {
        let mut output = BufReader::new(output);
        loop {
            let mut length = 0;
            loop {
                let mut line = String::new();
                if output.read_line(&mut line).expect("the output is text") == 0 {
                    return;
                }
                if line.trim().is_empty() {
                    break;
                }
                if let Some(value) = line.strip_prefix("Content-Length: ") {
                    length = value.trim().parse().expect("a length");
                }
            }
            let mut body = vec![0; length];
            output.read_exact(&mut body).expect("the whole message");
            if sender.send(serde_json::from_slice(&body).expect("a message is JSON")).is_err() {
                return;
            }
        }
    });
    receiver
}
