//! Visitors of all kinds.

use std::io::{BufRead, BufReader, Read, Write};
use std::net::{SocketAddr, TcpStream};
use std::time::Duration;

use super::{Answers, Limits, Rank, Request, Response, Status, serve};

/// Returns the request.
struct Echo;

impl Answers for Echo {
    fn answer(&self, request: &Request) -> (Rank, Response) {
        let Request { method, path, query, body, .. } = request;
        let rank = if method == "POST" { Rank::Orders } else { Rank::Reader };
        let request = format!("{method} {path} {query} {}", String::from_utf8_lossy(body));
        (rank, Response::text(Status::Ok, &request))
    }
}

/// Nobody is sent away for being slow: who is answered has not waited for others.
fn serving() -> SocketAddr {
    let hour = Duration::from_secs(3600);
    serve(0, Limits { exchange: hour, idle: hour }, |_| Echo).unwrap().0
}

fn visitor(address: SocketAddr) -> TcpStream {
    let stream = TcpStream::connect(address).unwrap();
    stream.set_read_timeout(Some(Duration::from_secs(60))).unwrap();
    stream
}

/// The first line and the body of the next answer.
fn answer(reader: &mut BufReader<&TcpStream>) -> (String, String) {
    let (mut lines, mut line) = (Vec::new(), String::new());
    while reader.read_line(&mut line).unwrap() > 2 {
        lines.push(std::mem::take(&mut line));
    }
    let length = lines.iter().find_map(|line| line.strip_prefix("Content-Length: ")).unwrap();
    let mut body = vec![0; length.trim().parse().unwrap()];
    reader.read_exact(&mut body).unwrap();
    (lines[0].trim().to_owned(), String::from_utf8(body).unwrap())
}

/// The answer to a text, alone on its connection.
fn asked(address: SocketAddr, text: &str) -> (String, String) {
    let stream = visitor(address);
    (&stream).write_all(text.as_bytes()).unwrap();
    answer(&mut BufReader::new(&stream))
}

#[test]
fn requests_come_one_after_the_other_in_pieces_of_any_size() {
    let stream = visitor(serving());
    let mut reader = BufReader::new(&stream);
    let text = "GET /a?b=1 HTTP/1.1\r\nHost: x\r\n\r\nPOST /c HTTP/1.1\r\ncontent-length: 3\r\n\r\nyes";
    (&stream).write_all(text.as_bytes()).unwrap();
    assert_eq!(answer(&mut reader), ("HTTP/1.1 200 OK".to_owned(), "GET /a b=1 ".to_owned()));
    assert_eq!(answer(&mut reader).1, "POST /c  yes");
    for byte in text.bytes() {
        (&stream).write_all(&[byte]).unwrap();
    }
    assert_eq!(answer(&mut reader).1, "GET /a b=1 ");
    assert_eq!(answer(&mut reader).1, "POST /c  yes");
    (&stream).write_all(b"GET / HTTP/1.1\r\nConnection: close\r\n\r\n").unwrap();
    assert_eq!(answer(&mut reader).1, "GET /  ");
    assert_eq!(reader.read(&mut [0]).unwrap(), 0, "it is closed");
}

#[test]
fn what_is_no_request_is_refused() {
    let address = serving();
    let long = format!("GET /{} HTTP/1.1\r\n\r\n", "a".repeat(1 << 15));
    for (text, status) in [
        ("hello\r\n\r\n", "400 Bad Request"),
        (&long, "413 Content Too Large"),
        ("POST / HTTP/1.1\r\nContent-Length: 99999999\r\n\r\n", "413 Content Too Large"),
        ("POST / HTTP/1.1\r\nContent-Length: 99999999999999999999999\r\n\r\n", "413 Content Too Large"),
        ("POST / HTTP/1.1\r\nContent-Length: -1\r\n\r\n", "400 Bad Request"),
        ("POST / HTTP/1.1\r\nContent-Length: 1\r\nContent-Length: 2\r\n\r\nab", "400 Bad Request"),
        ("POST / HTTP/1.1\r\nTransfer-Encoding: chunked\r\n\r\n0\r\n\r\n", "400 Bad Request"),
    ] {
        assert_eq!(asked(address, text).0, format!("HTTP/1.1 {status}"), "{}", &text[..text.len().min(80)]);
    }
}

#[test]
fn a_thousand_slow_visitors_keep_nobody_waiting() {
    let address = serving();
    let order = b"POST /order HTTP/1.1\r\nContent-Length: 5\r\n\r\npause";
    let buttons = visitor(address);
    let mut reader = BufReader::new(&buttons);
    (&buttons).write_all(order).unwrap();
    assert_eq!(answer(&mut reader).1, "POST /order  pause");
    // They begin a request, and hang: in the head, in the body, or before it. As many as files allow are open at once.
    let mut slow = Vec::new();
    for number in 0..1000 {
        let stream = TcpStream::connect(address).unwrap();
        let begun = ["", "GET / HT", "POST /order HTTP/1.1\r\nContent-Length: 5\r\n\r\npa"][number % 3];
        let _ = (&stream).write_all(begun.as_bytes());
        slow.push(stream);
        if slow.len() > 400 {
            slow.remove(0);
        }
    }
    (&buttons).write_all(order).unwrap();
    assert_eq!(answer(&mut reader).1, "POST /order  pause", "the buttons keep their connection");
    assert_eq!(asked(address, "GET / HTTP/1.1\r\n\r\n").1, "GET /  ", "a new visitor is let in");
}
