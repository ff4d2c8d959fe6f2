//! Sockets, whether the program connects or accepts.

use std::cell::Cell;
use std::io::{Read, Write};
use std::net::{SocketAddr, TcpListener, TcpStream};
use std::rc::Rc;
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use arl_rt::emit::*;
use arl_rt::{Controller, Outcome};

use crate::common::{FILE, say};
use crate::manners::{Manner, until_it_goes};
use crate::watch::{Robot, TIMES, again_and_again, soon, watched};

const HERE: Str = Str::literal("127.0.0.1");
const QUESTION: Str = Str::literal("question\n");
const ANSWER: &[u8] = b"the whole message\n";

/// What the program is.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Side {
    Client,
    Server,
}

/// Where the peer meets the program.
enum Endpoint {
    /// It listens.
    Here(TcpListener),
    /// The program listens there.
    There(SocketAddr),
}

impl Endpoint {
    /// A place to meet, and its port. A port of ours is free again at once, as nobody has connected to it.
    fn new(side: Side) -> (Self, i32) {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let address = listener.local_addr().unwrap();
        let port = i32::from(address.port());
        match side {
            Side::Client => (Endpoint::Here(listener), port),
            Side::Server => (Endpoint::There(address), port),
        }
    }

    /// The next connection.
    fn connection(&self) -> TcpStream {
        let stream = match self {
            Endpoint::Here(listener) => listener.accept().unwrap().0,
            Endpoint::There(address) => soon("the program does not listen", || TcpStream::connect(address).ok()),
        };
        stream.set_nodelay(true).unwrap();
        stream
    }
}

/// `waituntil connect(s,..)` or `waituntil accept(s,..)`
async fn open(cx: &Cx, s: &Socket, side: Side, port: i32) -> Done<()> {
    loop {
        let open = match side {
            Side::Client => socket::connect(cx, s, &HERE, port).await,
            Side::Server => socket::accept(cx, s, &HERE, port).await,
        };
        if open.at(FILE, 1)? {
            return Ok(());
        }
        cx.next_cycle().await;
    }
}

/// Asks, and prints what comes back in so many cycles, if it is a line, and the state of the connection.
async fn ask(cx: &Cx, s: &Socket, patience: u64) -> Done<()> {
    let mut answer = Str::literal("-");
    let (mut asked, until) = (false, cx.cycle() + patience);
    let detect = cx.system().detect_socket_close.get();
    while cx.cycle() < until && !(detect && socket::geterror(cx, s).await.at(FILE, 2)? != 0) {
        asked = asked || socket::write_string(cx, s, &QUESTION).await.at(FILE, 3)?;
        if socket::readuntil(cx, s, &mut answer, &Str::literal("\n")).await.at(FILE, 4)? {
            break;
        }
        cx.next_cycle().await;
    }
    say(cx, &answer)?;
    say(cx, &socket::geterror(cx, s).await.at(FILE, 5)?)
}

/// Runs a program that asks a peer of this manner, and then, from its beginning again, one that answers as it should.
fn ask_twice(side: Side, manner: Manner, detect: bool) -> String {
    watched(|| {
        let (endpoint, port) = Endpoint::new(side);
        let peer = std::thread::spawn(move || {
            for manner in [manner, Manner::ByteByByte] {
                manner.play(endpoint.connection(), QUESTION.as_bytes().len(), ANSWER);
            }
        });
        let patience = Rc::new(Cell::new(manner.patience()));
        let given = Rc::clone(&patience);
        let mut robot = Robot::new(Controller::builder(), move |cx: &Cx| {
            let patience = given.get();
            Box::pin(async move {
                cx.system().detect_socket_close.set(detect);
                let s = Socket::default();
                open(cx, &s, side, port).await?;
                ask(cx, &s, patience).await?;
                socket::close(cx, &s).await;
                say(cx, &socket::geterror(cx, &s).await.at(FILE, 6)?)
            })
        });
        let output = robot.run().text();
        patience.set(Manner::ByteByByte.patience());
        assert_eq!(robot.run().text(), "the whole message\n0\n0\n", "the program goes on after {manner:?}");
        drop(robot);
        peer.join().unwrap();
        output
    })
}

#[test]
fn whatever_a_peer_does_the_program_is_informed_and_goes_on() {
    const CLOSED: &str = "readuntil: the connection is lost: the other side has closed it";
    const RESET: &str = "readuntil: the connection is lost: Connection reset by peer (os error 104)";
    const FULL: &str = "readuntil: 1048576 bytes have been received, but what is looked for is not among them";
    for side in [Side::Client, Side::Server] {
        for manner in Manner::ALL {
            let alarm = |text: &str| format!("alarm 20050: {text} (t.arl:4)");
            let (detected, otherwise) = match manner {
                Manner::LeavesHalfway => ("-\n1\n0\n".into(), alarm(CLOSED)),
                Manner::Resets => ("-\n1\n0\n".into(), alarm(RESET)),
                Manner::Silent | Manner::Garbage => ("-\n0\n0\n".to_owned(), "-\n0\n0\n".to_owned()),
                Manner::ByteByByte => ("the whole message\n0\n0\n".into(), "the whole message\n0\n0\n".into()),
                Manner::Floods => (alarm(FULL), alarm(FULL)),
            };
            assert_eq!(ask_twice(side, manner, true), detected, "{side:?} {manner:?}");
            assert_eq!(ask_twice(side, manner, false), otherwise, "{side:?} {manner:?}");
        }
    }
}

/// Sends lines as fast as the other side takes them.
fn flood(mut stream: TcpStream, seconds: u64) -> JoinHandle<usize> {
    std::thread::spawn(move || {
        let lines = b"0123456789abcde\n".repeat(4096);
        let (mut sent, start) = (0, Instant::now());
        while start.elapsed() < Duration::from_secs(seconds) && stream.write_all(&lines).is_ok() {
            sent += lines.len();
        }
        sent
    })
}

/// A program reads a flood line by line, hundred lines a cycle, and goes on with a peer that answers as it should.
fn flooded(seconds: u64) {
    for side in [Side::Client, Side::Server] {
        watched(|| {
            let (endpoint, port) = Endpoint::new(side);
            let peer = std::thread::spawn(move || {
                let sent = flood(endpoint.connection(), seconds).join().unwrap();
                Manner::ByteByByte.play(endpoint.connection(), QUESTION.as_bytes().len(), ANSWER);
                sent
            });
            let lines = Rc::new(Cell::new(0_usize));
            let counted = Rc::clone(&lines);
            let mut robot = Robot::new(Controller::builder(), move |cx: &Cx| {
                let counted = Rc::clone(&counted);
                Box::pin(async move {
                    cx.system().detect_socket_close.set(true);
                    let s = Socket::default();
                    open(cx, &s, side, port).await?;
                    let mut line = Str::new();
                    while socket::geterror(cx, &s).await.at(FILE, 7)? == 0 {
                        for _ in 0..100 {
                            if socket::readuntil(cx, &s, &mut line, &Str::literal("\n")).await.at(FILE, 8)? {
                                counted.set(counted.get() + 1);
                                if line != "0123456789abcde" {
                                    say(cx, &line)?;
                                }
                            }
                        }
                        cx.next_cycle().await;
                    }
                    socket::close(cx, &s).await;
                    open(cx, &s, side, port).await?;
                    ask(cx, &s, Manner::ByteByByte.patience()).await
                })
            });
            let end = robot.run();
            assert_eq!((end.outcome, end.out.as_str()), (Outcome::Ended, "the whole message\n0\n"));
            drop(robot);
            let sent = peer.join().unwrap();
            // Nothing was lost but a line that the peer had not sent whole.
            assert_eq!(lines.get(), sent / 16, "{side:?}");
            assert!(lines.get() > 10_000, "{side:?}: {} lines", lines.get());
        });
    }
}

#[test]
fn a_flood_that_the_program_reads_loses_nothing() {
    flooded(1);
}

#[test]
#[ignore = "long"]
fn a_long_flood_that_the_program_reads_loses_nothing() {
    flooded(10);
}

#[test]
fn a_thousand_connections_one_after_the_other() {
    for side in [Side::Client, Side::Server] {
        watched(|| {
            let (endpoint, port) = Endpoint::new(side);
            let peer = std::thread::spawn(move || {
                for _ in 0..TIMES {
                    let mut stream = endpoint.connection();
                    let mut five = [0; 5];
                    stream.read_exact(&mut five).unwrap();
                    assert_eq!(&five, b"hello");
                    stream.write_all(b"world").unwrap();
                    until_it_goes(stream);
                }
            });
            let mut robot = Robot::new(Controller::builder(), move |cx: &Cx| {
                Box::pin(async move {
                    let s = Socket::default();
                    let greet = async || {
                        let mut answer = Str::new();
                        open(cx, &s, side, port).await?;
                        socket::write_string(cx, &s, &Str::literal("hello")).await.at(FILE, 7)?;
                        while !socket::read_string(cx, &s, &mut answer, 5).await.at(FILE, 8)? {
                            cx.next_cycle().await;
                        }
                        Ok(answer == "world")
                    };
                    say(cx, &again_and_again(greet, async || socket::close(cx, &s).await).await?)
                })
            });
            assert_eq!(robot.run().text(), format!("{TIMES}\n"), "{side:?}");
            drop(robot);
            peer.join().unwrap();
        });
    }
}

#[test]
fn a_port_that_is_taken_is_waited_for() {
    watched(|| {
        let (endpoint, port) = Endpoint::new(Side::Client);
        let Endpoint::Here(listener) = endpoint else { unreachable!() };
        let address = listener.local_addr().unwrap();
        let peer = std::thread::spawn(move || {
            std::thread::sleep(Duration::from_millis(300));
            drop(listener);
            Manner::ByteByByte.play(Endpoint::There(address).connection(), QUESTION.as_bytes().len(), ANSWER);
        });
        let mut robot = Robot::new(Controller::builder(), move |cx: &Cx| {
            Box::pin(async move {
                let s = Socket::default();
                let start = cx.cycle();
                open(cx, &s, Side::Server, port).await?;
                say(cx, &(cx.cycle() > start + 100))?;
                ask(cx, &s, Manner::ByteByByte.patience()).await
            })
        });
        assert_eq!(robot.run().text(), "true\nthe whole message\n0\n");
        let warnings = robot.warnings();
        drop(robot);
        peer.join().unwrap();
        let attempts = warnings.iter().filter(|text| text.contains("trying again")).count();
        assert_eq!(attempts, 1, "{warnings:?}");
    });
}
