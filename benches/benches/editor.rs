//! What somebody waits for who types in an editor: from a change to its diagnostics, and for what is asked.
//!
//! `cargo bench -p arl-benches --bench editor [-- CHANGES]`. Builds the command first, and speaks to `arl2rs lsp` over
//! its standard input and output, as an editor does.

use std::time::Instant;

use arl_benches::programs::Kind;
use arl_benches::protocol::Peer;
use serde_json::{Value, json};

/// The lengths of the programs, in lines.
const LINES: [usize; 3] = [100, 1_000, 10_000];

fn main() -> Result<(), String> {
    let words: Vec<String> = std::env::args().skip(1).filter(|word| !word.starts_with('-')).collect();
    let changes = words.first().and_then(|word| word.parse().ok()).unwrap_or(100);
    let command = arl_benches::command::build()?;
    println!("milliseconds: the middle one, and what 95 % do not exceed");
    println!(
        "{:>7} {:>9} {:>16} {:>16} {:>16} {:>16} {:>9}",
        "lines", "kB", "diagnostics", "completion", "hover", "colours", "peak MB"
    );
    for lines in LINES {
        let text = Kind::Typical.program(lines);
        let mut server = Server::start(&command)?;
        server.open(&text)?;
        let row = server.measure(&text, changes)?;
        println!("{:>7} {:>9.0} {row}", text.lines().count(), text.len() as f64 / 1000.0);
    }
    Ok(())
}

const URI: &str = "file:///nowhere/program.arl";

/// A running language server.
struct Server {
    peer: Peer,
    version: u32,
}

impl Server {
    fn start(command: &std::path::Path) -> Result<Self, String> {
        let mut server = Self { peer: Peer::start(command, "lsp")?, version: 0 };
        server.ask("initialize", json!({"capabilities": {}}))?;
        server.peer.send(&json!({"jsonrpc": "2.0", "method": "initialized", "params": {}}))?;
        Ok(server)
    }

    /// Milliseconds until a request is answered.
    fn ask(&mut self, method: &str, params: Value) -> Result<f64, String> {
        let start = Instant::now();
        self.peer.send(&json!({"jsonrpc": "2.0", "id": 1, "method": method, "params": params}))?;
        while self.peer.receive()?["id"] != 1 {}
        Ok(milliseconds(start))
    }

    /// Milliseconds until the diagnostics of the last version are there.
    fn await_diagnostics(&mut self, start: Instant) -> Result<f64, String> {
        while self.peer.receive()?["params"]["version"] != self.version {}
        Ok(milliseconds(start))
    }

    fn open(&mut self, text: &str) -> Result<(), String> {
        self.version = 1;
        let item = json!({"uri": URI, "languageId": "arl", "version": 1, "text": text});
        self.peer
            .send(&json!({"jsonrpc": "2.0", "method": "textDocument/didOpen", "params": {"textDocument": item}}))?;
        self.await_diagnostics(Instant::now()).map(drop)
    }

    /// A row of the table. What is typed goes to the middle of the text, a character more each time.
    fn measure(&mut self, text: &str, changes: usize) -> Result<String, String> {
        let line = text.lines().count() / 2;
        let place = json!({"line": line, "character": 0});
        let document = json!({"uri": URI});
        let mut times = [const { Vec::new() }; 4];
        for _ in 0..changes {
            self.version += 1;
            let range = json!({"start": place, "end": place});
            let params = json!({
                "textDocument": {"uri": URI, "version": self.version},
                "contentChanges": [{"range": range, "text": " "}],
            });
            let start = Instant::now();
            self.peer.send(&json!({"jsonrpc": "2.0", "method": "textDocument/didChange", "params": params}))?;
            times[0].push(self.await_diagnostics(start)?);
            let at = json!({"textDocument": document, "position": place});
            times[1].push(self.ask("textDocument/completion", at.clone())?);
            times[2].push(self.ask("textDocument/hover", at)?);
            times[3].push(self.ask("textDocument/semanticTokens/full", json!({"textDocument": document}))?);
        }
        let cells = times.map(|mut times| {
            times.sort_by(f64::total_cmp);
            format!("{:>8.1} {:>7.1}", times[times.len() / 2], times[times.len() * 95 / 100])
        });
        Ok(format!("{} {:>9.1}", cells.join(" "), self.peer.peak()))
    }
}

fn milliseconds(start: Instant) -> f64 {
    start.elapsed().as_secs_f64() * 1000.0
}
