//! What a cycle takes while the other side of a connection does wrong, beside a peer that does right.
//!
//! `cargo bench -p arl-benches --bench faults [-- SECONDS [NAME...]]`: processor time of the controller's thread in a
//! cycle, and how often it was put to sleep by anything but its clock. A foreground program moves, a background program
//! talks. The peers are processes of their own.

#![allow(missing_docs, clippy::unwrap_used, clippy::panic, reason = "a bench")]

use std::cell::RefCell;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::{TcpListener, TcpStream};
use std::process::{Child, Command, Stdio};
use std::rc::Rc;
use std::time::{Duration, Instant};

use arl_benches::script::script;
use arl_benches::statistics::{median, processor_time};
use arl_rt::clock::Clock;
use arl_rt::emit::*;
use arl_rt::{Builder, Controller};

const FILE: File = File::new("talk.arl");
const HERE: Str = Str::literal("127.0.0.1");
const PERIOD: Duration = Duration::from_millis(1);
/// Each scenario runs so many times, in turns with the others.
const ROUNDS: usize = 3;
/// Cycles at the beginning that are not looked at: connections are opened, motion is planned.
const WARM: usize = 300;

/// What the program in the background does.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Talk {
    /// Asks 64 bytes, waits for 64.
    Ask,
    /// Reads 64 bytes in every cycle.
    Read,
    /// Connects, asks, waits for the answer, closes.
    Reconnect,
    /// Writes and reads registers of the Modbus server in every cycle.
    Registers,
}

/// What a peer does with a connection.
type Manner = fn(TcpStream);

/// What a peer does.
const PEERS: [(&str, Manner); 4] = [("answers", answers), ("floods", floods), ("silent", silent), ("leaves", leaves)];

/// Name, the program, its peer, and the scenario that it is compared with.
const SCENARIOS: [(&str, Talk, &str, &str); 6] = [
    ("quiet", Talk::Ask, "answers", "quiet"),
    ("flood", Talk::Read, "floods", "quiet"),
    ("never answers", Talk::Ask, "silent", "quiet"),
    ("reconnects", Talk::Reconnect, "leaves", "quiet"),
    ("registers quiet", Talk::Registers, "master", "registers quiet"),
    ("registers flood", Talk::Registers, "masters", "registers quiet"),
];

fn answers(mut stream: TcpStream) {
    let mut piece = [0; 64];
    while stream.read_exact(&mut piece).is_ok() && stream.write_all(&piece).is_ok() {}
}

fn floods(mut stream: TcpStream) {
    let piece = vec![b'x'; 1 << 16];
    while stream.write_all(&piece).is_ok() {}
}

fn silent(mut stream: TcpStream) {
    let mut piece = [0; 64];
    while stream.read(&mut piece).is_ok_and(|count| count > 0) {}
}

fn leaves(mut stream: TcpStream) {
    let mut piece = [0; 64];
    let _ = stream.read_exact(&mut piece).and_then(|()| stream.write_all(&piece));
}

/// A master that asks for ten registers every 10 ms, or as fast as it can.
fn master(port: u16, pause: Duration) {
    let mut stream = TcpStream::connect(("127.0.0.1", port)).unwrap();
    stream.set_nodelay(true).unwrap();
    let mut answer = [0; 29];
    while stream.write_all(&[0, 1, 0, 0, 0, 6, 1, 3, 0, 0, 0, 10]).is_ok() && stream.read_exact(&mut answer).is_ok() {
        std::thread::sleep(pause);
    }
}

/// The peer's process: listens and says its port, or connects to the port that it is told.
fn be_peer(name: &str, port: &str) {
    match name {
        "master" => return master(port.parse().unwrap(), Duration::from_millis(10)),
        "masters" => {
            let port = port.parse().unwrap();
            let all: Vec<_> = (0..3).map(|_| std::thread::spawn(move || master(port, Duration::ZERO))).collect();
            return all.into_iter().for_each(|it| drop(it.join()));
        }
        _ => {}
    }
    let (_, play) = PEERS.into_iter().find(|(known, _)| *known == name).unwrap();
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    println!("{}", listener.local_addr().unwrap().port());
    for stream in listener.incoming() {
        let stream = stream.unwrap();
        stream.set_nodelay(true).unwrap();
        std::thread::spawn(move || play(stream));
    }
}

struct Peer(Child, i32);

impl Peer {
    fn start(name: &str, port: u16) -> Self {
        let mut command = Command::new(std::env::current_exe().unwrap());
        let mut child = command.args(["--peer", name, &port.to_string()]).stdout(Stdio::piped()).spawn().unwrap();
        let mut line = String::new();
        if port == 0 {
            BufReader::new(child.stdout.take().unwrap()).read_line(&mut line).unwrap();
        }
        Self(child, line.trim().parse().unwrap_or(0))
    }
}

impl Drop for Peer {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// Real time, and what the controller's thread uses of it between two waits.
struct Meter {
    next: Instant,
    since: Duration,
    sleeps: Rc<Cell<u64>>,
    times: Rc<RefCell<Vec<Duration>>>,
}

impl Clock for Meter {
    fn wait_for(&mut self, cycle: u64, _: f64) {
        if cycle > 0 {
            self.times.borrow_mut().push(processor_time() - self.since);
        }
        self.next += PERIOD;
        if let Some(early) = self.next.checked_duration_since(Instant::now()) {
            let before = sleeps();
            std::thread::sleep(early);
            self.sleeps.set(self.sleeps.get() + sleeps() - before);
        }
        self.since = processor_time();
    }
}

/// Moves to and fro for ever.
async fn moves(cx: &Cx) -> Done<()> {
    loop {
        for j1 in [150.0, -150.0] {
            let target = Joint::of_axes([j1, -90.0, 90.0, 0.0, 45.0, 0.0]);
            motion::movej(target).vp(2.0).run(cx).await.at(FILE, 1)?;
        }
    }
}

async fn talks(cx: &Cx, talk: Talk, port: i32) -> Done<()> {
    if talk == Talk::Registers {
        return registers(cx).await;
    }
    let s = Socket::default();
    let (request, mut answer) = (Str::from([b'x'; 64].as_slice()), Str::new());
    loop {
        while !socket::connect(cx, &s, &HERE, port).await.at(FILE, 3)? {
            cx.next_cycle().await;
        }
        loop {
            if talk != Talk::Read {
                while !socket::write_string(cx, &s, &request).await.at(FILE, 4)? {
                    cx.next_cycle().await;
                }
            }
            while !socket::read_string(cx, &s, &mut answer, 64).await.at(FILE, 5)? {
                cx.next_cycle().await;
            }
            if talk == Talk::Reconnect {
                break;
            }
            cx.next_cycle().await;
        }
        socket::close(cx, &s).await;
    }
}

async fn registers(cx: &Cx) -> Done<()> {
    let mut data = [0; 20];
    loop {
        modbus_tcp::writeregisters_bytes(cx, &data, 100, 10).await.at(FILE, 6)?;
        modbus_tcp::readregisters_bytes(cx, &mut data, 0, 10).await.at(FILE, 7)?;
        cx.next_cycle().await;
    }
}

/// What a run gave.
struct Result {
    times: Vec<Duration>,
    /// How often the thread was put to sleep, but by its clock, a thousand cycles.
    blocked: f64,
}

impl Result {
    /// us
    fn at(&self, part: f64) -> f64 {
        self.times[((self.times.len() - 1) as f64 * part).round() as usize].as_secs_f64() * 1e6
    }
}

fn run(talk: Talk, peer: &str, seconds: f64) -> Result {
    let times = Rc::new(RefCell::new(Vec::with_capacity(1 << 20)));
    let by_clock = Rc::new(Cell::new(0));
    let clock =
        Meter { next: Instant::now(), since: Duration::ZERO, sleeps: Rc::clone(&by_clock), times: Rc::clone(&times) };
    let mut builder = Builder::default().clock(clock);
    let (mut port, mut started) = (0, None);
    if talk == Talk::Registers {
        builder = builder.cell(arl_rt::Cell::parse("cell.toml", "[modbus_tcp]\nport = 0\n").unwrap());
    } else {
        let peer = Peer::start(peer, 0);
        port = peer.1;
        started = Some(peer);
    }
    let talks = script(FILE, move |cx| Box::pin(talks(cx, talk, port)));
    let moves = script(FILE, |cx| Box::pin(moves(cx)));
    let mut controller = builder.background(talks).build(moves).unwrap();
    if let Some(address) = controller.modbus_tcp_address() {
        started = Some(Peer::start(peer, address.port()));
    }
    controller.run_for(WARM as f64 * 0.001);
    let before = (sleeps() - by_clock.get(), times.borrow().len());
    controller.run_for(seconds);
    let cycles = times.borrow().len() - before.1;
    assert!(controller.outcome().is_none(), "{:?}", controller.outcome());
    let blocked = sleeps() - by_clock.get() - before.0;
    drop::<Controller>(controller);
    drop(started);
    let mut times = times.borrow_mut().split_off(before.1);
    times.sort();
    Result { times, blocked: blocked as f64 / cycles as f64 * 1000.0 }
}

/// How often this thread has gone to sleep by itself.
fn sleeps() -> u64 {
    let status = std::fs::read_to_string("/proc/thread-self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("voluntary_ctxt_switches:"));
    line.and_then(|count| count.trim().parse().ok()).unwrap_or(0)
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).filter(|it| it != "--bench").collect();
    if let [flag, name, port] = arguments.as_slice()
        && flag == "--peer"
    {
        return be_peer(name, port);
    }
    let seconds = arguments.first().map_or(10.0, |text| text.parse().unwrap());
    let wanted: Vec<_> = SCENARIOS
        .into_iter()
        .filter(|(name, ..)| arguments.len() < 2 || arguments[1..].iter().any(|it| it == name))
        .collect();
    let mut results: Vec<Vec<Result>> = wanted.iter().map(|_| Vec::new()).collect();
    for _ in 0..ROUNDS {
        for ((_, talk, peer, _), results) in wanted.iter().zip(&mut results) {
            results.push(run(*talk, peer, seconds));
        }
    }
    let figure = |at: usize, of: &dyn Fn(&Result) -> f64| median(results[at].iter().map(of).collect());
    println!("us of processor time a cycle, the median of {ROUNDS} runs of {seconds} s");
    for (at, (name, .., quiet)) in wanted.iter().enumerate() {
        let base = wanted.iter().position(|(known, ..)| known == quiet).unwrap_or(at);
        let high = |at: usize| figure(at, &|it| it.at(0.999));
        println!(
            "{name:16} median {:6.1}   p99.9 {:6.1} ({:4.2} of quiet)   longest {:7.1}   asleep {:.2} in 1000 cycles",
            figure(at, &|it| it.at(0.5)),
            high(at),
            high(at) / high(base),
            figure(at, &|it| it.at(1.0)),
            figure(at, &|it| it.blocked),
        );
    }
}
