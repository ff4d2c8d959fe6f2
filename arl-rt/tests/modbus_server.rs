//! What clients of the Modbus TCP server may do wrong: nothing of it is left open, and the server goes on.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test")]
#![cfg(target_os = "linux")]

mod common;

use std::io::{Read, Write};
use std::net::{Shutdown, SocketAddr, TcpStream};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use arl_rt::{Cell, Controller};
use common::open;

/// Descriptors and threads belong to the process: one test at a time.
static ALONE: Mutex<()> = Mutex::new(());

/// Reads register 100 of unit 9.
const REQUEST: [u8; 12] = [0, 1, 0, 0, 0, 6, 9, 3, 0, 100, 0, 1];
const ANSWER: [u8; 11] = [0, 1, 0, 0, 0, 5, 9, 3, 2, 0, 0];

fn controller() -> (Controller, SocketAddr) {
    let cell = Cell::parse("cell.toml", "[modbus_tcp]\nport = 0\nconnections = 2\n").unwrap();
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
    let _alone = ALONE.lock().unwrap_or_else(PoisonError::into_inner);
    let before = open::all();
    let (controller, address) = controller();
    // The socket that listens, the poll, what wakes it; the thread, which gives itself its name a little later.
    let served = (before.0 + 3, before.1 + 1);
    open::wait_for(served);
    wrong(address);
    is_answered_soon(address);
    open::wait_for(served);
    drop(controller);
    open::wait_for(before);
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
            assert_eq!(rest, []);
        }
        served.iter_mut().for_each(is_answered);
    });
}

#[test]
fn a_server_goes_with_its_clients_time_after_time() {
    let _alone = ALONE.lock().unwrap_or_else(PoisonError::into_inner);
    let before = open::all();
    for _ in 0..50 {
        let (controller, address) = controller();
        let mut served = client(address);
        is_answered(&mut served);
        let mut silent = client(address);
        drop(controller);
        for stream in [&mut served, &mut silent] {
            let mut rest = Vec::new();
            let _ = stream.read_to_end(&mut rest);
            assert_eq!(rest, []);
        }
    }
    open::wait_for(before);
}
