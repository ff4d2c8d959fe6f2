//! Requests a second that a Modbus TCP server answers: the controller's own, and that of pymodbus, each in a process of
//! its own, for the same client. Beside them what the system takes anyway: plain Rust that reads, and writes bytes that
//! it has ready.
//!
//! `cargo bench -p arl-benches --bench modbus`; pymodbus is looked for in the Python that `ARL_PEERS_PYTHON` names
//! (`python3` where it names none). In turns: the median of the rounds. With it, on Linux, the processor time that the
//! server takes for a request, which does not depend on what the client can do.

#![allow(missing_docs, clippy::unwrap_used, clippy::expect_used, reason = "a bench")]

use std::io::{BufRead, BufReader, Read, Write};
use std::net::{TcpListener, TcpStream};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use arl_benches::script::script;
use arl_rt::emit::File;
use arl_rt::{Builder, Cell};

/// What makes this very program the server, or the plain one.
const SERVE: &str = "--serve";
const PLAIN: &str = "--plain";

/// How long a request to read registers is.
const REQUEST: usize = 12;

const ROUNDS: usize = 5;

/// How long a round lasts.
const ROUND: Duration = Duration::from_millis(1000);

/// What clients do.
#[derive(Clone, Copy)]
struct Task {
    name: &'static str,
    clients: usize,
    /// How many registers each request reads.
    registers: u8,
}

const TASKS: [Task; 3] = [
    Task { name: "1 client, 10 registers", clients: 1, registers: 10 },
    Task { name: "1 client, 125 registers", clients: 1, registers: 125 },
    Task { name: "8 clients, 10 registers", clients: 8, registers: 10 },
];

fn main() {
    let wants = |what: &str| std::env::args().any(|argument| argument == what);
    if wants(SERVE) {
        return serve();
    }
    if wants(PLAIN) {
        return serve_plainly();
    }
    let this = std::env::current_exe().unwrap();
    let ours = Server::start(Command::new(&this).arg(SERVE)).expect("our own server");
    let plain = Server::start(Command::new(&this).arg(PLAIN)).expect("the plain server");
    let python = std::env::var_os("ARL_PEERS_PYTHON").unwrap_or_else(|| "python3".into());
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("benches/modbus_server.py");
    let Some(pymodbus) = Server::start(Command::new(&python).arg(script).stderr(Stdio::null())) else {
        println!("skipped: {} has no pymodbus (ARL_PEERS_PYTHON names another one)", python.to_string_lossy());
        return;
    };
    println!("requests a second, and us of the server's processor time for each");
    for task in TASKS {
        let servers = [&ours, &pymodbus, &plain];
        let mut rounds: [Rounds; 3] = Default::default();
        for _ in 0..ROUNDS {
            servers.iter().zip(&mut rounds).for_each(|(server, rounds)| rounds.add(server, task));
        }
        let [ours, theirs, plain] = rounds.map(|Rounds { rates, costs }| (median(rates), median(costs)));
        println!("{}", task.name);
        for (name, (rate, cost)) in [("ours", ours), ("pymodbus", theirs), ("plain Rust", plain)] {
            println!("  {name:10} {rate:9.0}/s {cost:7.1} us");
        }
        println!(
            "  ours / pymodbus = {:.1} (plain Rust {:.1}); pymodbus / ours, processor time = {:.1} (plain Rust {:.1})",
            ours.0 / theirs.0,
            plain.0 / theirs.0,
            theirs.1 / ours.1,
            theirs.1 / plain.1
        );
    }
    println!("goal: ours / pymodbus is 5 or more");
}

/// What came out of the rounds with a server.
#[derive(Default)]
struct Rounds {
    /// Requests a second.
    rates: Vec<f64>,
    /// Processor time of the server for a request, in us.
    costs: Vec<f64>,
}

impl Rounds {
    fn add(&mut self, server: &Server, task: Task) {
        let (before, start) = (server.processor(), Instant::now());
        let answers = answers(server.port, task) as f64;
        self.rates.push(answers / start.elapsed().as_secs_f64());
        self.costs.push((server.processor() - before) * 1e6 / answers);
    }
}

fn median(mut rounds: Vec<f64>) -> f64 {
    rounds.sort_by(f64::total_cmp);
    rounds[rounds.len() / 2]
}

/// How many answers the clients get in a round. Each waits for its answer before it asks again: of several requests at
/// once, pymodbus answers the first one only.
fn answers(port: u16, task: Task) -> usize {
    let threads: Vec<_> = (0..task.clients).map(|_| std::thread::spawn(move || ask(port, task.registers))).collect();
    threads.into_iter().map(|thread| thread.join().unwrap()).sum()
}

/// Reads registers for a round; how often.
fn ask(port: u16, registers: u8) -> usize {
    let mut stream = TcpStream::connect(("127.0.0.1", port)).unwrap();
    stream.set_nodelay(true).unwrap();
    let mut answer = vec![0; answer_size(registers)];
    let (start, mut count) = (Instant::now(), 0_usize);
    while start.elapsed() < ROUND {
        count += 1;
        let [high, low] = (count as u16).to_be_bytes();
        stream.write_all(&[high, low, 0, 0, 0, 6, 1, 3, 0, 100, 0, registers]).unwrap();
        stream.read_exact(&mut answer).unwrap();
        assert_eq!(answer[..2], [high, low]);
        assert_eq!(answer[6..9], [1, 3, 2 * registers]);
    }
    count
}

/// How long the answer with so many registers is.
fn answer_size(registers: u8) -> usize {
    9 + 2 * usize::from(registers)
}

/// A server in a process of its own.
struct Server {
    child: Child,
    port: u16,
}

impl Server {
    /// Starts a command that says its port first; nothing where it does not.
    fn start(command: &mut Command) -> Option<Self> {
        let mut child = command.stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().ok()?;
        let mut line = String::new();
        BufReader::new(child.stdout.take()?).read_line(&mut line).ok()?;
        let port = line.trim().parse();
        if port.is_err() {
            let _ = child.wait();
        }
        Some(Self { child, port: port.ok()? })
    }
}

impl Server {
    /// The processor time that it has taken, in s; not a number where the system does not tell.
    fn processor(&self) -> f64 {
        let stat = std::fs::read_to_string(format!("/proc/{}/stat", self.child.id())).unwrap_or_default();
        // Behind the name, which may have blanks: its own time and that of the system for it, in hundredths.
        let fields: Vec<&str> = stat.rsplit(')').next().unwrap_or_default().split_whitespace().collect();
        let ticks = |at: usize| fields.get(at).and_then(|field| field.parse::<f64>().ok()).unwrap_or(f64::NAN);
        (ticks(11) + ticks(12)) / 100.0
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// Serves until the standard input ends.
fn serve() {
    let cell = Cell::parse("cell.toml", "[modbus_tcp]\nport = 0\n").unwrap();
    let nothing = script(File::new("nothing.arl"), |_| Box::pin(async { Ok(()) }));
    let controller = Builder::default().cell(cell).build(nothing).unwrap();
    println!("{}", controller.modbus_tcp_address().unwrap().port());
    let _ = std::io::stdin().read(&mut [0]);
}

/// Answers whatever has the length of a request with zeros, until the standard input ends.
fn serve_plainly() {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    println!("{}", listener.local_addr().unwrap().port());
    std::thread::spawn(move || {
        for stream in listener.incoming() {
            std::thread::spawn(move || answer_plainly(stream.unwrap()));
        }
    });
    let _ = std::io::stdin().read(&mut [0]);
}

fn answer_plainly(mut stream: TcpStream) {
    stream.set_nodelay(true).unwrap();
    let (mut requests, mut answers) = ([0; 100 * REQUEST], Vec::new());
    while let Ok(count @ 1..) = stream.read(&mut requests) {
        answers.clear();
        for request in requests[..count].chunks_exact(REQUEST) {
            let end = answers.len() + answer_size(request[11]);
            answers.extend_from_slice(&[request[0], request[1], 0, 0, 0, 0, 1, 3, 2 * request[11]]);
            answers.resize(end, 0);
        }
        if stream.write_all(&answers).is_err() {
            return;
        }
    }
}
