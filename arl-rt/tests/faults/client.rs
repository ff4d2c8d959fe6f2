//! Sockets of a program that connects: what differs from one that accepts (`sockets.rs`), and what a peer may do late.

use std::io::{Read, Write};
use std::net::TcpListener;
use std::time::{Duration, Instant};

use arl_rt::emit::*;
use arl_rt::{Controller, Outcome};

use crate::common::{self, FILE, alarm, say};
use crate::watch::watched;

/// The address of all peers.
const HERE: Str = Str::literal("127.0.0.1");

/// Runs a program against a peer: how it ended, what it printed, its warnings. Nothing of it is left afterwards.
fn against<F>(peer: impl FnOnce(TcpListener) + Send + 'static, program: impl FnOnce(i32) -> F) -> (Outcome, String)
where
    F: for<'a> Fn(&'a Cx) -> BoxFuture<'a> + 'static,
{
    watched(|| {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let port = i32::from(listener.local_addr().unwrap().port());
        let peer = std::thread::spawn(move || peer(listener));
        let (mut controller, messages) = common::controller(Controller::builder(), program(port));
        controller.run_for(600.0);
        let outcome = controller.outcome().cloned();
        let place = controller.place();
        drop(controller);
        peer.join().unwrap();
        (outcome.unwrap_or_else(|| panic!("still running: {place:?}")), messages.text())
    })
}

/// `waituntil connect(s,"127.0.0.1",port)`
async fn connect(cx: &Cx, s: &Socket, port: i32) -> Done<()> {
    while !socket::connect(cx, s, &HERE, port).await.at(FILE, 1)? {
        cx.next_cycle().await;
    }
    Ok(())
}

/// `waituntil read(s,data,len)`
async fn read(cx: &Cx, s: &Socket, len: i32) -> Done<Str> {
    let mut data = Str::new();
    while !socket::read_string(cx, s, &mut data, len).await.at(FILE, 2)? {
        cx.next_cycle().await;
    }
    Ok(data)
}

#[test]
fn the_peer_resets_the_connection() {
    // Closing with bytes unread is a reset.
    let peer = |listener: TcpListener| {
        let (mut stream, _) = listener.accept().unwrap();
        let mut one = [0];
        stream.read_exact(&mut one).unwrap();
    };
    let (outcome, _) = against(peer, |port| {
        move |cx: &Cx| {
            Box::pin(async move {
                let s = Socket::default();
                connect(cx, &s, port).await?;
                loop {
                    socket::write_string(cx, &s, &Str::literal("more and more")).await.at(FILE, 3)?;
                    cx.next_cycle().await;
                }
            })
        }
    });
    assert!(alarm(outcome).starts_with("alarm 20050: write: the connection is lost: "));
}

#[test]
fn the_peer_answers_byte_by_byte_and_with_garbage() {
    const LINES: usize = 40;
    let garbage = |at: usize| ((at * 7919 + at / 11) % 255) as u8 + 1;
    let peer = move |listener: TcpListener| {
        let (mut stream, _) = listener.accept().unwrap();
        stream.set_nodelay(true).unwrap();
        for line in 0..LINES {
            for at in 0..line {
                stream.write_all(&[garbage(line * 100 + at)]).unwrap();
            }
            stream.write_all(b"\0").unwrap();
            stream.write_all(b"\0").unwrap();
        }
        let _ = stream.read(&mut [0]);
    };
    let (outcome, out) = against(peer, move |port| {
        move |cx: &Cx| {
            Box::pin(async move {
                let s = Socket::default();
                connect(cx, &s, port).await?;
                for line in 0..LINES {
                    let mut data = Str::new();
                    while !socket::readuntil(cx, &s, &mut data, &Str::literal("\0\0")).await.at(FILE, 4)? {
                        cx.next_cycle().await;
                    }
                    let expected: Vec<u8> = (0..line).map(|at| garbage(line * 100 + at)).collect();
                    if data.as_bytes() != expected {
                        say(cx, &(line as i32))?;
                    }
                }
                Ok(())
            })
        }
    });
    assert_eq!((outcome, out.as_str()), (Outcome::Ended, ""));
}

#[test]
fn a_flood_that_nobody_reads_is_held_back() {
    let peer = |listener: TcpListener| {
        let (mut stream, _) = listener.accept().unwrap();
        stream.set_write_timeout(Some(Duration::from_millis(300))).unwrap();
        let piece: Vec<u8> = (0..=255).cycle().take(1 << 16).collect();
        let (mut sent, start) = (0, Instant::now());
        while start.elapsed() < Duration::from_secs(2) {
            match stream.write(&piece) {
                Ok(count) => sent += count,
                Err(_) => break,
            }
        }
        // The buffer of the connection, and those of the system.
        assert!(sent > 1 << 20 && sent < 32 << 20, "{sent} bytes were taken");
    };
    let (outcome, out) = against(peer, |port| {
        move |cx: &Cx| {
            Box::pin(async move {
                let s = Socket::default();
                connect(cx, &s, port).await?;
                flow::waittime(1.0).run(cx).await.at(FILE, 3)?;
                let first = read(cx, &s, 1 << 20).await?;
                let whole = first.as_bytes().iter().zip((0..=255u8).cycle()).all(|(a, b)| *a == b);
                say(cx, &whole)?;
                let mut data = Str::new();
                while !socket::readuntil(cx, &s, &mut data, &Str::literal("not there")).await.at(FILE, 4)? {
                    cx.next_cycle().await;
                }
                Ok(())
            })
        }
    });
    assert_eq!(out, "true\n");
    // Either the buffer is full, or the peer gave up before.
    assert!(alarm(outcome).starts_with("alarm 20050: readuntil: "));
}

#[test]
fn what_was_sent_last_arrives_although_the_program_ends() {
    let peer = |listener: TcpListener| {
        let (mut stream, _) = listener.accept().unwrap();
        stream.write_all(b"nobody reads this").unwrap();
        let mut all = Vec::new();
        stream.read_to_end(&mut all).unwrap();
        assert_eq!(all.len(), 500_000);
    };
    let (outcome, _) = against(peer, |port| {
        move |cx: &Cx| {
            Box::pin(async move {
                let s = Socket::default();
                connect(cx, &s, port).await?;
                let much = Str::from(vec![b'x'; 500_000].as_slice());
                socket::write_string(cx, &s, &much).await.at(FILE, 3).map(drop)
            })
        }
    });
    assert_eq!(outcome, Outcome::Ended);
}
