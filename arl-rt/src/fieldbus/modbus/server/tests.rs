//! The server with clients that behave well and with others that do not.

use std::io::{Read, Write};
use std::net::{Shutdown, TcpStream};
use std::time::{Duration, Instant};

use super::*;
use crate::fieldbus::noise::Noise;

fn server(connections: usize) -> (Server, SharedTables) {
    let tables = SharedTables::default();
    let server = Server::start("127.0.0.1:0".parse().unwrap(), connections, tables.clone()).unwrap();
    (server, tables)
}

fn client(server: &Server) -> TcpStream {
    let stream = TcpStream::connect(server.address()).unwrap();
    stream.set_nodelay(true).unwrap();
    stream.set_read_timeout(Some(Duration::from_secs(20))).unwrap();
    stream
}

/// A request to read registers 100 and 101 of unit 9 in a transaction.
fn request(transaction: u16) -> [u8; 12] {
    let [high, low] = transaction.to_be_bytes();
    [high, low, 0, 0, 0, 6, 9, 3, 0, 100, 0, 2]
}

fn expect(stream: &mut TcpStream, bytes: &[u8]) {
    let mut found = vec![0; bytes.len()];
    stream.read_exact(&mut found).unwrap();
    assert_eq!(found, bytes);
}

fn expect_end(stream: &mut TcpStream) {
    let mut rest = Vec::new();
    // A reset also counts as the end.
    let _ = stream.read_to_end(&mut rest);
    assert!(rest.is_empty());
}

fn expect_answer(stream: &mut TcpStream, transaction: u16) {
    let [high, low] = transaction.to_be_bytes();
    expect(stream, &[high, low, 0, 0, 0, 7, 9, 3, 4, 1, 2, 3, 4]);
}

fn set(tables: &SharedTables) {
    tables.wait().registers_mut(100, 2).unwrap().copy_from_slice(&[1, 2, 3, 4]);
}

#[test]
fn requests_are_answered_whole_in_pieces_and_in_heaps() {
    let (server, tables) = server(2);
    set(&tables);
    let mut stream = client(&server);
    stream.write_all(&request(1)).unwrap();
    expect_answer(&mut stream, 1);
    for byte in request(2) {
        stream.write_all(&[byte]).unwrap();
    }
    expect_answer(&mut stream, 2);
    let heap: Vec<u8> = (3..1003).flat_map(request).collect();
    stream.write_all(&heap).unwrap();
    for transaction in 3..1003 {
        expect_answer(&mut stream, transaction);
    }
}

#[test]
fn several_clients_see_the_same_tables() {
    let (server, tables) = server(8);
    let mut clients: Vec<TcpStream> = (0..8).map(|_| client(&server)).collect();
    for (at, stream) in clients.iter_mut().enumerate() {
        stream.write_all(&[0, 1, 0, 0, 0, 6, 1, 6, 0, at as u8, 0, 70 + at as u8]).unwrap();
        expect(stream, &[0, 1, 0, 0, 0, 6, 1, 6, 0, at as u8, 0, 70 + at as u8]);
    }
    let wanted: Vec<u8> = (70..78).flat_map(|value| [0, value]).collect();
    assert_eq!(tables.wait().registers(0, 8).unwrap(), wanted);
}

#[test]
fn who_comes_when_all_places_are_taken_is_sent_away() {
    let (server, tables) = server(2);
    set(&tables);
    let mut two = [client(&server), client(&server)];
    for stream in &mut two {
        stream.write_all(&request(7)).unwrap();
        expect_answer(stream, 7);
    }
    expect_end(&mut client(&server));
    let [first, mut second] = two;
    drop(first);
    // The slot is free as soon as the server has noticed the end.
    let mut third = loop {
        let mut stream = client(&server);
        let mut byte = [0];
        if stream.write_all(&request(8)).is_ok() && matches!(stream.read(&mut byte), Ok(1)) {
            break stream;
        }
    };
    expect(&mut third, &[8, 0, 0, 0, 7, 9, 3, 4, 1, 2, 3, 4]);
    second.write_all(&request(9)).unwrap();
    expect_answer(&mut second, 9);
}

#[test]
fn who_is_silent_for_long_makes_room() {
    let tables = SharedTables::default();
    let patience = Duration::from_millis(300);
    let server = Server::with_patience(patience, "127.0.0.1:0".parse().unwrap(), 2, tables.clone()).unwrap();
    set(&tables);
    let (mut silent, mut speaks) = (client(&server), client(&server));
    for stream in [&mut silent, &mut speaks] {
        stream.write_all(&request(1)).unwrap();
        expect_answer(stream, 1);
    }
    // Rejected clients reconnect until there is room.
    let mut third = loop {
        speaks.write_all(&request(2)).unwrap();
        expect_answer(&mut speaks, 2);
        let mut stream = client(&server);
        let mut byte = [0];
        if stream.write_all(&request(3)).is_ok() && matches!(stream.read(&mut byte), Ok(1)) {
            break stream;
        }
    };
    expect(&mut third, &[3, 0, 0, 0, 7, 9, 3, 4, 1, 2, 3, 4]);
    expect_end(&mut silent);
    speaks.write_all(&request(4)).unwrap();
    expect_answer(&mut speaks, 4);
}

#[test]
fn who_sends_a_request_byte_by_byte_makes_room() {
    let tables = SharedTables::default();
    let patience = Duration::from_millis(300);
    let server = Server::with_patience(patience, "127.0.0.1:0".parse().unwrap(), 1, tables.clone()).unwrap();
    set(&tables);
    let mut slow = client(&server);
    let slow_one = std::thread::spawn(move || {
        // The header of a long request, and its bytes one by one, as long as they are accepted.
        let mut sent = slow.write_all(&[0, 1, 0, 0, 0, 250, 9]);
        while sent.is_ok() {
            std::thread::sleep(Duration::from_millis(40));
            sent = slow.write_all(&[3]);
        }
    });
    let began = Instant::now();
    let mut other = loop {
        assert!(began.elapsed() < Duration::from_secs(8), "the slow one keeps its place");
        let mut stream = client(&server);
        if stream.write_all(&request(3)).is_ok() && matches!(stream.read(&mut [0]), Ok(1)) {
            break stream;
        }
    };
    expect(&mut other, &[3, 0, 0, 0, 7, 9, 3, 4, 1, 2, 3, 4]);
    slow_one.join().unwrap();
}

#[test]
fn garbage_ends_its_connection_only() {
    let (server, tables) = server(4);
    set(&tables);
    let mut good = client(&server);
    let mut noise = Noise::new(3);
    for _ in 0..200 {
        let mut bad = client(&server);
        // Writing to a connection that has ended fails, sooner or later.
        let _ = bad.write_all(&noise.bytes(2000));
        let _ = bad.shutdown(Shutdown::Write);
        let mut answers = Vec::new();
        let _ = bad.read_to_end(&mut answers);
    }
    good.write_all(&request(5)).unwrap();
    expect_answer(&mut good, 5);
}

#[test]
fn a_client_that_leaves_in_the_middle_leaves_nothing() {
    let (server, tables) = server(1);
    set(&tables);
    for round in 0..1000_u16 {
        let mut stream = client(&server);
        let end = usize::from(round % 12);
        // The server may still count the previous client as connected.
        let _ = stream.write_all(&request(round)[..end]);
    }
    let mut answer = [0; 13];
    while !matches!(
        TcpStream::connect(server.address()).and_then(|mut stream| {
            stream.write_all(&request(5))?;
            stream.read_exact(&mut answer)
        }),
        Ok(())
    ) {}
    assert_eq!(answer[..2], [0, 5]);
}

#[test]
fn a_flood_without_reading_holds_up_nobody_else() {
    let (server, tables) = server(2);
    set(&tables);
    let mut flood = client(&server);
    flood.set_write_timeout(Some(Duration::from_millis(200))).unwrap();
    let heap: Vec<u8> = (0..10_000).flat_map(request).collect();
    // The answers are not read, so that the server stops reading.
    let mut full = false;
    for _ in 0..1000 {
        full = flood.write_all(&heap).is_err();
        if full {
            break;
        }
    }
    assert!(full, "the server read on");
    let mut other = client(&server);
    for transaction in 0..100 {
        other.write_all(&request(transaction)).unwrap();
        expect_answer(&mut other, transaction);
    }
}

#[test]
fn a_port_that_is_taken_is_an_error() {
    let (server, tables) = server(1);
    assert!(Server::start(server.address(), 1, tables).is_err());
}

#[test]
fn nothing_remains_of_a_server() {
    let (server, _) = server(1);
    let address = server.address();
    let mut stream = client(&server);
    drop(server);
    expect_end(&mut stream);
    assert!(TcpStream::connect(address).is_err());
}
