//! `arl2rs dap`: a debug adapter on standard input and output.
//!
//! The engine runs the program in a process of its own, with a halt before each statement; it connects to the adapter
//! and halts where the adapter says (`arl-rt/src/command/debug/`). The adapter handles the editor's side: breakpoints
//! with conditions, frames, variables and expressions. A step backward is a run from the start to one statement
//! earlier: on the virtual clock a run repeats itself.

mod breakpoints;
mod evaluate;
mod executable;
mod launch;
mod leftovers;
mod literal;
mod process;
mod program;
mod protocol;
mod session;
mod state;
mod variables;

pub use program::{FileKey, Key, Programs};

use crate::framing::Messages;
use arl_terminal::exit::Exit;
use arl_terminal::show;
use session::Session;
use std::sync::mpsc::channel;

/// An event for the adapter.
enum Event {
    /// A request of the editor.
    Request(protocol::Request),
    /// The editor is gone.
    Gone,
    /// News of the program with this number; each run has its own.
    Process(u64, process::News),
}

/// Serves one editor until it is gone or has said `disconnect`.
pub fn dap() -> Exit {
    let (sender, events) = channel();
    let requests = sender.clone();
    let reader = std::thread::spawn(move || {
        let mut input = Messages::new(std::io::stdin().lock());
        while let Some(body) = input.next_message() {
            // What is not a request needs no answer.
            if let Ok(request) = serde_json::from_slice::<protocol::Request>(&body)
                && requests.send(Event::Request(request)).is_err()
            {
                return true;
            }
        }
        let _ = requests.send(Event::Gone);
        !input.is_something_else()
    });
    // After `disconnect` the reader still waits for a message.
    let is_gone = Session::new(sender, events).serve();
    if is_gone && reader.join().is_ok_and(|understood| !understood) {
        show::error("expected messages of the debug adapter protocol, each behind a line `Content-Length: BYTES`");
        return Exit::FAILURE;
    }
    Exit::SUCCESS
}
