//! `arl2rs lsp`: a language server on standard input and output.
//!
//! Messages come in (`transport`), change the open files (`documents`) or are requests, each of which one file answers
//! from the index of the program (`programs`). Everything is checked again after a change: that is fast enough for each
//! key, and nothing can be out of date.

mod actions;
mod calls;
mod capabilities;
mod completion;
mod describe;
mod diagnostics;
mod documents;
mod folding;
mod formatting;
mod frame;
mod highlights;
mod hints;
mod hover;
mod lenses;
mod markup;
mod navigation;
mod places;
mod programs;
mod projects;
mod rename;
mod requests;
mod server;
mod settings;
mod signals;
mod signature;
mod symbols;
mod text;
mod tokens;
mod transport;
mod typing;
mod uri;
mod workspace;

use arl_terminal::exit::Exit;

/// Serves one client until it says `exit` or closes the connection.
pub fn lsp() -> Exit {
    let incoming = transport::reader();
    let (outgoing, writer) = transport::writer();
    let ended_well = server::Server::new(outgoing).serve(&incoming);
    // The last messages are still written.
    let _ = writer.join();
    if ended_well { Exit::SUCCESS } else { Exit::FAILURE }
}
