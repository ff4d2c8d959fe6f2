//! What somebody waits for who types in an editor: from a change to its diagnostics, and for what is asked.
//!
//! `cargo bench -p arl-benches --bench editor [-- CHANGES]`. Builds the command first, and speaks to `arl2rs lsp` over its
//! standard input and output, as an editor does.

use std::io::{BufRead, BufReader, Read, Write};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use std::time::Instant;

use arl_benches::programs::Kind;
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
    child: Child,
    input: ChildStdin,
    output: BufReader<ChildStdout>,
    version: u32,
}

impl Server {
    fn start(command: &std::path::Path) -> Result<Self, String> {
        let mut child = Command::new(command)
            .arg("lsp")
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .map_err(|error| error.to_string())?;
        let input = child.stdin.take().ok_or("no input")?;
        let output = BufReader::new(child.stdout.take().ok_or("no output")?);
        let mut server = Self { child, input, output, version: 0 };
        server.ask("initialize", json!({"capabilities": {}}))?;
        server.send(&json!({"jsonrpc": "2.0", "method": "initialized", "params": {}}))?;
        Ok(server)
    }

    fn send(&mut self, message: &Value) -> Result<(), String> {
        let text = message.to_string();
        write!(self.input, "Content-Length: {}\r\n\r\n{text}", text.len()).map_err(|error| error.to_string())?;
        self.input.flush().map_err(|error| error.to_string())
    }

    fn receive(&mut self) -> Result<Value, String> {
        let mut length = 0;
        loop {
            let mut line = String::new();
            if self.output.read_line(&mut line).map_err(|error| error.to_string())? == 0 {
                return Err("the server ended".into());
            }
            if line.trim().is_empty() {
                break;
            }
            if let Some(value) = line.strip_prefix("Content-Length: ") {
                length = value.trim().parse().map_err(|_| "no length")?;
            }
        }
        let mut body = vec![0; length];
        self.output.read_exact(&mut body).map_err(|error| error.to_string())?;
        serde_json::from_slice(&body).map_err(|error| error.to_string())
    }

    /// Milliseconds until a request is answered.
    fn ask(&mut self, method: &str, params: Value) -> Result<f64, String> {
        let start = Instant::now();
        self.send(&json!({"jsonrpc": "2.0", "id": 1, "method": method, "params": params}))?;
        while self.receive()?["id"] != 1 {}
        Ok(milliseconds(start))
    }

    /// Milliseconds until the diagnostics of the last version are there.
    fn told(&mut self, start: Instant) -> Result<f64, String> {
        while self.receive()?["params"]["version"] != self.version {}
        Ok(milliseconds(start))
    }

    fn open(&mut self, text: &str) -> Result<(), String> {
        self.version = 1;
        let item = json!({"uri": URI, "languageId": "arl", "version": 1, "text": text});
        self.send(&json!({"jsonrpc": "2.0", "method": "textDocument/didOpen", "params": {"textDocument": item}}))?;
        self.told(Instant::now()).map(drop)
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
            self.send(&json!({"jsonrpc": "2.0", "method": "textDocument/didChange", "params": params}))?;
            times[0].push(self.told(start)?);
            let at = json!({"textDocument": document, "position": place});
            times[1].push(self.ask("textDocument/completion", at.clone())?);
            times[2].push(self.ask("textDocument/hover", at)?);
            times[3].push(self.ask("textDocument/semanticTokens/full", json!({"textDocument": document}))?);
        }
        let cells = times.map(|mut times| {
            times.sort_by(f64::total_cmp);
            format!("{:>8.1} {:>7.1}", times[times.len() / 2], times[times.len() * 95 / 100])
        });
        Ok(format!("{} {:>9.1}", cells.join(" "), self.peak()))
    }

    /// The most memory that the server had, in MB; 0 where the system does not tell.
    fn peak(&self) -> f64 {
        let status = std::fs::read_to_string(format!("/proc/{}/status", self.child.id())).unwrap_or_default();
        let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
        let kilobytes = line.and_then(|line| line.split_whitespace().next()?.parse::<f64>().ok());
        kilobytes.unwrap_or(0.0) / 1000.0
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

fn milliseconds(start: Instant) -> f64 {
    start.elapsed().as_secs_f64() * 1000.0
}
