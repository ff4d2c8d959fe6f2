//! Islands that work, that disappear, that refuse requests, and that send invalid data.

use std::io::{Read, Write};
use std::net::{SocketAddr, TcpListener, TcpStream};
use std::time::{Duration, Instant};

use arl_robot::outline::Outline;

use super::*;
use crate::fieldbus::modbus::SharedTables;
use crate::fieldbus::modbus::server::Server;
use crate::io::{Channels, Digital, Image};

const POINTS: &str = "di = [{ channel = 1, count = 3, coil = 100 }]\ndo = [{ channel = 1, count = 3, coil = 200 }]\n\
                      ai = [{ channel = 2, holding_register = 10 }]\nao = [{ channel = 2, holding_register = 20 }]\n";

fn settings(address: SocketAddr, more: &str) -> Vec<Island> {
    let (ip, port) = (address.ip(), address.port());
    let text = format!(
        "[[island]]\nname = \"valves\"\naddress = \"{ip}\"\nport = {port}\npoll = 1\ntimeout = 300\n{POINTS}{more}"
    );
    Outline::of_cell("cell.toml", &text).unwrap().islands
}

fn server(address: &str) -> (Server, SharedTables) {
    let tables = SharedTables::default();
    (Server::start(address.parse().unwrap(), 4, tables.clone()).unwrap(), tables)
}

/// A run: islands, and an image that is updated in cycles.
struct Run {
    islands: Islands,
    image: Image,
    warnings: Vec<String>,
    cycle: u64,
}

impl Run {
    fn start(address: SocketAddr, more: &str) -> Self {
        let islands = Islands::start(&settings(address, more)).unwrap();
        Self { islands, image: Image::new(&Channels::default()), warnings: Vec::new(), cycle: 0 }
    }

    fn cycle(&mut self) {
        self.islands.read(self.image.inputs_mut());
        self.warnings.extend(self.islands.take_warning());
        self.islands.write(self.image.outputs_all(self.cycle));
        self.cycle += 1;
    }

    /// Runs cycles until a condition holds.
    fn until(&mut self, what: &str, mut so: impl FnMut(&Self) -> bool) {
        let start = Instant::now();
        while !so(self) {
            assert!(start.elapsed() < Duration::from_secs(20), "{what} does not come; {:?}", self.warnings);
            self.cycle();
            std::thread::sleep(Duration::from_micros(200));
        }
    }

    fn inputs(&self) -> (i32, f64) {
        (self.image.digitals(Digital::Di, 1, 3).unwrap(), self.image.analog_input(2).unwrap())
    }
}

fn set_inputs(tables: &SharedTables, bits: u8, register: [u8; 2]) {
    let mut tables = tables.wait();
    tables.write_coils(100, 3, &[bits]).unwrap();
    tables.registers_mut(10, 1).unwrap().copy_from_slice(&register);
}

/// The outputs in the island: bits, register.
fn outputs(tables: &SharedTables) -> (u8, [u8; 2]) {
    let tables = tables.wait();
    let mut bits = [0];
    tables.read_coils(200, 3, &mut bits).unwrap();
    (bits[0], tables.registers(20, 1).unwrap().try_into().unwrap())
}

#[test]
fn signals_go_both_ways() {
    let (server, tables) = server("127.0.0.1:0");
    set_inputs(&tables, 0b101, [0x7f, 0xff]);
    let mut run = Run::start(server.address(), "");
    run.cycle();
    assert_eq!(run.inputs(), (0b101, 10.0), "they are there in the first cycle");
    run.image.set_digitals(Digital::Do, 1, 3, 0b110).unwrap();
    run.image.set_analog_output(2, -10.0).unwrap();
    run.until("the outputs", |_| outputs(&tables) == (0b110, [0x80, 0x01]));
    set_inputs(&tables, 0b010, [0x80, 0x01]);
    run.until("the inputs", |run| run.inputs() == (0b010, -10.0));
    assert_eq!((run.warnings.len(), run.islands.fault()), (0, None));
}

#[test]
fn it_is_known_when_the_island_has_an_output() {
    let (server, tables) = server("127.0.0.1:0");
    let mut run = Run::start(server.address(), "");
    assert!(
        !run.islands.has_reached(OutputSignal::Digital(1), 0) && run.islands.has_reached(OutputSignal::Digital(4), 0)
    );
    for level in [1, 0, 1, 0, 1] {
        run.image.set_digitals(Digital::Do, 1, 1, level).unwrap();
        let cycle = run.cycle;
        run.until("the output", |run| {
            run.islands.has_reached(OutputSignal::Digital(1), cycle)
                && run.islands.has_reached(OutputSignal::Analog(2), cycle)
        });
        assert_eq!(i32::from(outputs(&tables).0), level);
    }
}

#[test]
fn what_is_lost_is_reported_and_comes_back() {
    for (more, rest, warning) in [
        ("", (0, 0.0), None),
        ("lost = \"warning\"\n", (0, 0.0), Some("its inputs go to 0")),
        ("lost = \"warning\"\ninputs = \"hold\"\n", (0b111, 5.0), Some("its inputs stay as they were")),
    ] {
        let (first, tables) = server("127.0.0.1:0");
        let address = first.address();
        set_inputs(&tables, 0b111, [0x40, 0x00]);
        let mut run = Run::start(address, more);
        run.image.set_digitals(Digital::Do, 1, 3, 0b011).unwrap();
        run.until("the outputs", |_| outputs(&tables).0 == 0b011);
        drop(first);
        run.until("the loss", |run| run.islands.fault().is_some() || !run.warnings.is_empty());
        let words = run.islands.fault().map_or_else(|| run.warnings.concat(), str::to_owned);
        assert!(words.contains(&format!("the island valves ({address}) is lost: ")), "{words}");
        assert!(words.contains(warning.unwrap_or_default()) && run.warnings.is_empty() == warning.is_none(), "{words}");
        assert_eq!((run.inputs().0, run.inputs().1.round()), rest);
        // Another island, whose outputs are off.
        run.image.set_digitals(Digital::Do, 1, 3, 0b001).unwrap();
        let (_again, tables) = server(&address.to_string());
        set_inputs(&tables, 0b100, [0x40, 0x00]);
        run.until("the outputs again", |_| outputs(&tables).0 == 0b001);
        run.until("the inputs again", |run| run.inputs().0 == 0b100);
        assert_eq!(run.islands.fault(), None);
        assert!(run.warnings.last().unwrap().contains("valves") && run.warnings.last().unwrap().ends_with(" is back"));
    }
}

#[test]
fn at_the_end_outputs_go_to_0_or_stay() {
    for (more, end) in [("", (0, [0, 0])), ("end = \"hold\"\n", (0b101, [0x7f, 0xff]))] {
        let (server, tables) = server("127.0.0.1:0");
        let mut run = Run::start(server.address(), more);
        run.image.set_digitals(Digital::Do, 1, 3, 0b101).unwrap();
        run.image.set_analog_output(2, 10.0).unwrap();
        // The last outputs of a cycle are written, whatever the thread was doing.
        run.until("the images", |run| run.islands.ports[0].shared.wait().outputs.bits[0]);
        drop(run);
        assert_eq!(outputs(&tables), end);
    }
    // Without a cycle the outputs have not been set.
    let (server, tables) = server("127.0.0.1:0");
    tables.wait().write_coils(200, 3, &[0b111]).unwrap();
    drop(Run::start(server.address(), ""));
    assert_eq!(outputs(&tables).0, 0b111);
}

#[test]
fn an_island_that_is_not_there_is_reported_at_the_start() {
    let address = TcpListener::bind("127.0.0.1:0").unwrap().local_addr().unwrap();
    let error = Islands::start(&settings(address, "")).err().unwrap();
    assert!(error.starts_with(&format!("the island valves ({address}) is not available: cannot connect")), "{error}");
    let mut run = Run::start(address, "lost = \"warning\"\n");
    run.until("the warning", |run| !run.warnings.is_empty());
    assert!(run.warnings[0].contains("its inputs go to 0"), "{:?}", run.warnings);
}

#[test]
fn a_refusal_names_what_is_refused() {
    let (server, _) = server("127.0.0.1:0");
    // The runtime's own server has no discrete inputs.
    let mut islands = settings(server.address(), "");
    islands[0].points.di[0].table = arl_robot::islands::Table::DiscreteInput;
    let error = Islands::start(&islands).err().unwrap();
    assert!(
        error.contains("it refuses discrete input 100 with exception 1: it does not have this function"),
        "{error}"
    );
}

/// An island that answers each request with `answer`.
fn stranger(answer: fn(&[u8]) -> Vec<u8>) -> SocketAddr {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let address = listener.local_addr().unwrap();
    std::thread::spawn(move || {
        for stream in listener.incoming() {
            let Ok(stream) = stream else { return };
            std::thread::spawn(move || talk(stream, answer));
        }
    });
    address
}

fn talk(mut stream: TcpStream, answer: fn(&[u8]) -> Vec<u8>) {
    let mut request = [0; 300];
    while let Ok(count @ 1..) = stream.read(&mut request) {
        if stream.write_all(&answer(&request[..count])).is_err() {
            return;
        }
    }
}

#[test]
fn whoever_talks_nonsense_is_lost() {
    type Answer = fn(&[u8]) -> Vec<u8>;
    let right = |request: &[u8]| [&request[..5], &[4, request[6], 1, 1, 0]].concat();
    assert_eq!(right(&[0, 1, 0, 0, 0, 6, 9, 1, 0, 100, 0, 3]).len(), 10);
    let strangers: [(Answer, &str); 6] = [
        (|_| Vec::new(), "it has not answered for 300 ms (it was asked for coils 100 to 102)"),
        (|_| b"HTTP/1.1 400 Bad Request\r\n\r\n".to_vec(), "is not a Modbus TCP response"),
        // Another transaction, another unit, too many coils, a further answer after it.
        (
            |request| [&[9, 9], &request[2..5], &[4, request[6], 1, 1, 0]].concat(),
            "is not a Modbus TCP response to this request: it answers request number 2313 instead of 1",
        ),
        (
            |request| [&request[..5], &[4, 77, 1, 1, 0]].concat(),
            "is not a Modbus TCP response to this request: unit 77 answers instead of unit ",
        ),
        (|request| [&request[..5], &[5, request[6], 1, 2, 0, 0]].concat(), "is not a Modbus TCP response"),
        (
            |request| [&request[..5], &[4, request[6], 1, 1, 0, 0, 0, 0, 0]].concat(),
            "is not a Modbus TCP response to this request: more data follows the response",
        ),
    ];
    for (answer, words) in strangers {
        let error = Islands::start(&settings(stranger(answer), "")).err().unwrap();
        assert!(error.contains(words), "{error}");
    }
}

#[test]
fn one_that_keeps_silent_holds_nobody_up() {
    let address = stranger(|_| Vec::new());
    let mut run = Run::start(address, "lost = \"warning\"\n");
    for _ in 0..1000 {
        run.cycle();
    }
    assert!(run.warnings.len() <= 1, "{:?}", run.warnings);
}
