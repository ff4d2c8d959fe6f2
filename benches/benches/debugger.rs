//! What somebody waits for who debugs: from the launch to the first halt, and from a step to what an editor shows of
//! it.
//!
//! `cargo bench -p arl-benches --bench debugger [-- STEPS]`. Builds the command first, and speaks to `arl2rs dap` over
//! its standard input and output, as an editor does. A launch, from the adapter's start to the first halt, stands
//! beside `arl2rs check` of the same program.

use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Instant;

use arl_benches::protocol::Peer;
use serde_json::{Value, json};

/// How often each program is launched.
const LAUNCHES: usize = 9;

/// How many statements `main` has.
const STATEMENTS: [usize; 3] = [50, 500, 5_000];

fn main() -> Result<(), String> {
    let words: Vec<String> = std::env::args().skip(1).filter(|word| !word.starts_with('-')).collect();
    let steps = words.first().and_then(|word| word.parse().ok()).unwrap_or(200);
    let command = arl_benches::command::build()?;
    let folder = std::env::temp_dir().join(format!("arl2rs-bench-{}", std::process::id()));
    std::fs::create_dir_all(&folder).map_err(|error| error.to_string())?;
    let measured = STATEMENTS.iter().try_for_each(|statements| measure(&command, &folder, *statements, steps));
    let _ = std::fs::remove_dir_all(&folder);
    measured
}

/// A program that goes round: counting, calls, a wait.
fn program(statements: usize) -> String {
    let mut text =
        "int sum = 0\nfunc int twice(int n)\n    return 2 * n\nendfunc\nfunc void main()\n    loop\n".to_owned();
    for at in 0..statements {
        text += &match at % 10 {
            0 => format!("        sum = twice({at})\n"),
            5 => format!("        if(sum > {at}) sum = 0\n"),
            9 => "        waittime 0.001\n".to_owned(),
            _ => format!("        sum = sum + {at}\n"),
        };
    }
    text + "    endloop\nendfunc\n"
}

fn measure(command: &Path, folder: &Path, statements: usize, steps: usize) -> Result<(), String> {
    let file = folder.join(format!("with_{statements}.arl"));
    std::fs::write(&file, program(statements)).map_err(|error| error.to_string())?;
    let [mut checks, mut launches] = [Vec::new(), Vec::new()];
    for _ in 0..LAUNCHES {
        let start = Instant::now();
        let checked = Command::new(command).arg("check").arg(&file).stderr(Stdio::null()).status();
        checks.push(milliseconds(start));
        if !checked.map_err(|error| error.to_string())?.success() {
            return Err("the program has mistakes".into());
        }
        let start = Instant::now();
        drop(Session::halted(command, &file)?);
        launches.push(milliseconds(start));
    }
    let mut session = Session::halted(command, &file)?;
    let mut halts = Vec::new();
    let mut shown = Vec::new();
    for _ in 0..steps {
        let start = Instant::now();
        session.ask("next", json!({"threadId": 1}))?;
        session.wait_for("stopped")?;
        halts.push(milliseconds(start));
        session.show()?;
        shown.push(milliseconds(start));
    }
    let mut pauses = Vec::new();
    for _ in 0..steps {
        session.ask("continue", json!({"threadId": 1}))?;
        let start = Instant::now();
        session.ask("pause", json!({"threadId": 1}))?;
        session.wait_for("stopped")?;
        pauses.push(milliseconds(start));
    }
    println!(
        "{statements} statements: check {}, launch {}; step to halt {}, with stack and variables {}, pause {}",
        figures(checks),
        figures(launches),
        figures(halts),
        figures(shown),
        figures(pauses)
    );
    Ok(())
}

/// The middle one, and what 95 % do not exceed.
fn figures(mut times: Vec<f64>) -> String {
    times.sort_by(f64::total_cmp);
    let at = |part: usize| times.get(times.len() * part / 100).copied().unwrap_or(f64::NAN);
    format!("{:.2} ms (95 %: {:.2})", at(50), at(95))
}

/// A debugging session.
struct Session {
    peer: Peer,
    sent: u32,
}

impl Session {
    /// A session whose program is halted before its first statement.
    fn halted(command: &Path, file: &Path) -> Result<Self, String> {
        let mut session = Session { peer: Peer::start(command, "dap")?, sent: 0 };
        session.ask("initialize", json!({"adapterID": "arl"}))?;
        session.ask("launch", json!({"program": file, "stopOnEntry": true}))?;
        session.ask("configurationDone", json!({}))?;
        session.wait_for("stopped")?;
        Ok(session)
    }

    fn ask(&mut self, command: &str, arguments: Value) -> Result<Value, String> {
        self.sent += 1;
        let seq = self.sent;
        self.peer.send(&json!({"seq": seq, "type": "request", "command": command, "arguments": arguments}))?;
        loop {
            let message = self.peer.receive()?;
            // An event that comes before the answer is that of an earlier step.
            if message["type"] == "response" && message["request_seq"] == seq {
                let done = message["success"] == true;
                return if done { Ok(message["body"].clone()) } else { Err(format!("{command}: {message}")) };
            }
        }
    }

    fn wait_for(&mut self, event: &str) -> Result<Value, String> {
        loop {
            let message = self.peer.receive()?;
            match message["event"].as_str() {
                Some(known) if known == event => return Ok(message["body"].clone()),
                Some("terminated") => return Err("the program has ended".into()),
                _ => {}
            }
        }
    }

    /// What an editor asks for at each halt.
    fn show(&mut self) -> Result<(), String> {
        self.ask("threads", json!({}))?;
        let stack = self.ask("stackTrace", json!({"threadId": 1}))?;
        let scopes = self.ask("scopes", json!({"frameId": stack["stackFrames"][0]["id"]}))?;
        let locals = scopes["scopes"][0]["variablesReference"].clone();
        self.ask("variables", json!({"variablesReference": locals})).map(drop)
    }
}

fn milliseconds(start: Instant) -> f64 {
    start.elapsed().as_secs_f64() * 1000.0
}
