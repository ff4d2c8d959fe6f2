//! What clients of the Modbus TCP server may do wrong: nothing of it is left open, the server goes on, and so does the
//! program.

use std::io::{Read, Write};
use std::net::{Shutdown, SocketAddr, TcpListener, TcpStream};
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

use arl_rt::emit::*;
use arl_rt::{Builder, Controller, State};

use crate::common::{self, FILE, open, say};
use crate::watch::{Robot, watched};

/// Reads register 100 of unit 9.
const REQUEST: [u8; 12] = [0, 1, 0, 0, 0, 6, 9, 3, 0, 100, 0, 1];
const ANSWER: [u8; 11] = [0, 1, 0, 0, 0, 5, 9, 3, 2, 0, 0];

fn controller() -> (Controller, SocketAddr) {
    let cell = arl_rt::Cell::parse("cell.toml", "[modbus_tcp]\nport = 0\nconnections = 2\n").unwrap();
    let (controller, _) = common::controller(Controller::builder().cell(cell), |_| Box::pin(async { Ok(()) }));
    let address = controller.modbus_tcp_address().unwrap();
    (controller, address)
}

fn client(address: SocketAddr) -> TcpStream {
    let stream = TcpStream::connect(address).unwrap();
    stream.set_read_timeout(Some(Duration::from_secs(20))).unwrap();
    stream.set_write_timeout(Some(Duration::from_millis(300))).unwrap();
    stream
}

fn ask(stream: &mut TcpStream) -> std::io::Result<()> {
    let mut answer = [0; ANSWER.len()];
    stream.write_all(&REQUEST)?;
    stream.read_exact(&mut answer)?;
    assert_eq!(answer, ANSWER);
    Ok(())
}

fn is_answered(stream: &mut TcpStream) {
    ask(stream).unwrap();
}

/// Asks until the clients that came before, and that the system still keeps in its queue, do not take the places.
fn is_answered_soon(address: SocketAddr) {
    let start = Instant::now();
    while let Err(error) = ask(&mut client(address)) {
        assert!(start.elapsed() < Duration::from_secs(20), "nobody is served any more: {error}");
    }
}

/// Lets clients do something wrong. What they leave goes while the server runs, the rest with the server.
fn after(wrong: impl FnOnce(SocketAddr)) {
    watched(|| {
        let before = open::all();
        let (controller, address) = controller();
        // The socket that listens, the poll, what wakes it; the thread, which gives itself its name a little later.
        let served = (before.0 + 3, before.1 + 1);
        open::wait_for(served);
        wrong(address);
        is_answered_soon(address);
        open::wait_for(served);
        drop(controller);
    });
}

#[test]
fn clients_that_leave_in_the_middle_leave_nothing() {
    after(|address| {
        for round in 0..500 {
            // The server sends away who comes while the ones before are still counted.
            let _ = client(address).write_all(&REQUEST[..round % REQUEST.len()]);
        }
    });
}

#[test]
fn clients_that_reset_leave_nothing() {
    after(|address| {
        for _ in 0..200 {
            let mut stream = client(address);
            // One byte of the answer is taken: closing with the rest unread is a reset.
            let _ = stream.write_all(&REQUEST).and_then(|()| stream.read_exact(&mut [0]));
        }
    });
}

#[test]
fn clients_that_send_garbage_leave_nothing() {
    after(|address| {
        for round in 0..200_usize {
            let mut stream = client(address);
            let garbage: Vec<u8> = (0..1000).map(|at| (at * 7919 + round * 31 + at / 11) as u8).collect();
            let _ = stream.write_all(&garbage);
            let _ = stream.shutdown(Shutdown::Write);
            let _ = stream.read_to_end(&mut Vec::new());
        }
    });
}

#[test]
fn a_client_that_floods_and_never_reads_leaves_nothing() {
    after(|address| {
        let mut stream = client(address);
        let heap = REQUEST.repeat(10_000);
        let full = (0..1000).any(|_| stream.write_all(&heap).is_err());
        assert!(full, "the server read on");
    });
}

#[test]
fn clients_that_find_no_place_leave_nothing() {
    after(|address| {
        let mut served = [client(address), client(address)];
        served.iter_mut().for_each(is_answered);
        for _ in 0..200 {
            let mut rest = Vec::new();
            // A reset is an end, too.
            let _ = client(address).read_to_end(&mut rest);
            assert!(rest.is_empty());
        }
        served.iter_mut().for_each(is_answered);
    });
}

#[test]
fn a_crowd_that_comes_at_once_and_stays_takes_no_place_from_who_is_served() {
    after(|address| {
        let mut served = [client(address), client(address)];
        served.iter_mut().for_each(is_answered);
        // Nobody of them leaves by itself; more than that a process may not have open everywhere.
        let mut crowd: Vec<TcpStream> = (0..400).map(|_| client(address)).collect();
        served.iter_mut().for_each(is_answered);
        for stream in &mut crowd {
            // They were sent away: an end, or a reset.
            assert!(!matches!(stream.read(&mut [0]), Ok(1)), "it got an answer that it did not ask for");
        }
        served.iter_mut().for_each(is_answered);
    });
}

#[test]
fn a_server_goes_with_its_clients_time_after_time() {
    watched(|| {
        for _ in 0..50 {
            let (controller, address) = controller();
            let mut served = client(address);
            is_answered(&mut served);
            let mut silent = client(address);
            drop(controller);
            for stream in [&mut served, &mut silent] {
                let mut rest = Vec::new();
                let _ = stream.read_to_end(&mut rest);
                assert!(rest.is_empty());
            }
        }
    });
}

/// A program that counts in register 0, and reads every time what it has written, while clients do something wrong.
fn while_a_program_counts(wrong: impl FnOnce(SocketAddr) + Send + 'static) {
    static COUNTED: AtomicU64 = AtomicU64::new(0);
    watched(|| {
        let cell = arl_rt::Cell::parse("cell.toml", "[modbus_tcp]\nport = 0\nconnections = 4\n").unwrap();
        let (mut controller, messages) = common::controller(Builder::default().cell(cell), |cx: &Cx| {
            Box::pin(async move {
                for round in 0_u16.. {
                    let mut back = [0; 2];
                    let written = modbus_tcp::writeregisters_bytes(cx, &round.to_be_bytes(), 0, 1).await.at(FILE, 1)?;
                    let read = modbus_tcp::readregisters_bytes(cx, &mut back, 0, 1).await.at(FILE, 2)?;
                    if !(written && read && back == round.to_be_bytes()) {
                        say(cx, &"wrong")?;
                    }
                    COUNTED.fetch_add(1, Ordering::Relaxed);
                    cx.next_cycle().await;
                }
                Ok(())
            })
        });
        let address = controller.modbus_tcp_address().unwrap();
        let clients = std::thread::spawn(move || {
            wrong(address);
            is_answered_soon(address);
        });
        let before = COUNTED.load(Ordering::Relaxed);
        while !clients.is_finished() {
            assert_eq!(controller.run_for(0.01), State::Running, "{}", messages.text());
        }
        clients.join().unwrap();
        assert!(COUNTED.load(Ordering::Relaxed) > before && messages.text().is_empty(), "{}", messages.text());
    });
}

/// Requests as fast as their answers come, in heaps, on all connections but one, whose requests are answered, too.
fn flooded(seconds: u64) {
    while_a_program_counts(move |address| {
        let flood = move |mut stream: TcpStream| {
            let (heap, mut answers) = (REQUEST.repeat(100), vec![0; 100 * ANSWER.len()]);
            let start = Instant::now();
            while start.elapsed() < Duration::from_secs(seconds) {
                stream.write_all(&heap).unwrap();
                stream.read_exact(&mut answers).unwrap();
            }
        };
        let floods: Vec<_> = (0..3).map(|_| client(address)).map(|it| std::thread::spawn(move || flood(it))).collect();
        let mut other = client(address);
        while floods.iter().any(|flood| !flood.is_finished()) {
            is_answered(&mut other);
        }
        floods.into_iter().for_each(|flood| flood.join().unwrap());
    });
}

#[test]
fn a_flood_of_requests_holds_up_nobody() {
    flooded(1);
}

#[test]
#[ignore = "long"]
fn a_long_flood_of_requests_holds_up_nobody() {
    flooded(10);
}

#[test]
fn clients_that_come_and_go_hold_up_nobody() {
    while_a_program_counts(|address| (0..1000).for_each(|_| is_answered_soon(address)));
}

#[test]
fn requests_a_byte_at_a_time_are_answered() {
    while_a_program_counts(|address| {
        // The one that says nothing holds up nobody.
        let _silent = client(address);
        let mut stream = client(address);
        stream.set_nodelay(true).unwrap();
        for _ in 0..20 {
            for byte in REQUEST {
                stream.write_all(&[byte]).unwrap();
                std::thread::sleep(Duration::from_millis(1));
            }
            let mut answer = [0; ANSWER.len()];
            stream.read_exact(&mut answer).unwrap();
            assert_eq!(answer, ANSWER);
        }
    });
}

#[test]
fn a_port_that_is_taken_is_reported_before_the_program_starts() {
    watched(|| {
        let taken = TcpListener::bind("127.0.0.1:0").unwrap();
        let port = taken.local_addr().unwrap().port();
        let cell = arl_rt::Cell::parse("cell.toml", &format!("[modbus_tcp]\nport = {port}\n")).unwrap();
        let built = Builder::default().cell(cell).build(Box::new(common::script(|_| Box::pin(async { Ok(()) }))));
        let text = built.err().unwrap().to_string();
        assert!(text.contains(&format!("cannot listen on 127.0.0.1:{port}")) && text.contains("in use"), "{text}");
    });
}

/// A program that says that it uses registers.
struct Registers;

impl Program for Registers {
    fn file(&self) -> File {
        FILE
    }

    fn family(&self) -> Family {
        Family::SixAxis
    }

    fn main<'a>(&'a self, cx: &'a Cx) -> BoxFuture<'a> {
        Box::pin(async move {
            let mut back = [0; 2];
            say(cx, &modbus_tcp::writeregisters_bytes(cx, &[1, 2], 0, 1).await.at(FILE, 1)?)?;
            say(cx, &modbus_tcp::readregisters_bytes(cx, &mut back, 0, 1).await.at(FILE, 1)?)?;
            say(cx, &(back == [1, 2]))
        })
    }

    fn beside(&self) -> Beside {
        Beside { modbus_tcp: true, ..Beside::default() }
    }
}

/// Where the cell says nothing, a program that cannot have its server goes on with registers that nobody else sees.
#[test]
fn without_a_port_by_default_the_program_goes_on_with_a_warning() {
    watched(|| {
        // Where that is not allowed to us, it is not to the server either.
        let _taken = TcpListener::bind("127.0.0.1:502");
        let builder = Builder::default().clock(arl_rt::clock::RealClock::new());
        let mut robot = Robot::of(builder, Box::new(Registers));
        // No cycle tries to start it.
        let warnings = robot.warnings();
        assert!(warnings.len() == 1 && warnings[0].contains("cannot listen on 127.0.0.1:502"), "{warnings:?}");
        assert_eq!(robot.run().text(), "true\ntrue\ntrue\n");
        assert_eq!(robot.warnings(), [""; 0]);
    });
}
