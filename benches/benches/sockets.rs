//! A request of 64 bytes and its answer: a program's sockets beside plain sockets of Rust, against the same echo.
//!
//! `cargo bench -p arl-benches --bench sockets`: microseconds, the median and the 99th percentile.

#![allow(missing_docs, clippy::unwrap_used, reason = "a bench")]

use std::cell::RefCell;
use std::io::{Read, Write};
use std::net::{TcpListener, TcpStream};
use std::rc::Rc;
use std::time::{Duration, Instant};

use arl_benches::script::script;
use arl_rt::emit::*;
use arl_rt::{Builder, Controller};

const ROUNDS: usize = 2000;
const FILE: File = File::new("ask.arl");

/// What a program in ARL that asks and waits for the answer becomes, with a clock around each exchange.
async fn ask(cx: &Cx, port: i32, times: &RefCell<Vec<Duration>>) -> Done<()> {
    let s = Socket::default();
    while !socket::connect(cx, &s, &Str::literal("127.0.0.1"), port).await.at(FILE, 3)? {
        cx.next_cycle().await;
    }
    let request = Str::from([b'x'; 64].as_slice());
    let mut answer = Str::new();
    for _ in 0..ROUNDS {
        let start = Instant::now();
        while !socket::write_string(cx, &s, &request).await.at(FILE, 4)? {
            cx.next_cycle().await;
        }
        while !socket::read_string(cx, &s, &mut answer, 64).await.at(FILE, 5)? {
            cx.next_cycle().await;
        }
        times.borrow_mut().push(start.elapsed());
    }
    Ok(())
}

/// A server that sends back what comes, for one client.
fn echo() -> u16 {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let port = listener.local_addr().unwrap().port();
    std::thread::spawn(move || {
        let (mut stream, _) = listener.accept().unwrap();
        stream.set_nodelay(true).unwrap();
        let mut piece = [0; 64];
        while stream.read_exact(&mut piece).is_ok() && stream.write_all(&piece).is_ok() {}
    });
    port
}

fn plain() -> Vec<Duration> {
    let mut stream = TcpStream::connect(("127.0.0.1", echo())).unwrap();
    stream.set_nodelay(true).unwrap();
    let mut piece = [b'x'; 64];
    let mut times = Vec::with_capacity(ROUNDS);
    for _ in 0..ROUNDS {
        let start = Instant::now();
        stream.write_all(&piece).unwrap();
        stream.read_exact(&mut piece).unwrap();
        times.push(start.elapsed());
        // As far apart as those of the program, so that threads have gone to sleep as they do there.
        std::thread::sleep(Duration::from_millis(1));
    }
    times
}

fn ours() -> Vec<Duration> {
    let times = Rc::new(RefCell::new(Vec::with_capacity(ROUNDS)));
    let (port, kept) = (i32::from(echo()), Rc::clone(&times));
    let program = script(FILE, move |cx| {
        let times = Rc::clone(&kept);
        Box::pin(async move { ask(cx, port, &times).await })
    });
    let mut controller = Builder::default().build(program).unwrap();
    controller.run_for(60.0);
    drop::<Controller>(controller);
    times.take()
}

fn say(name: &str, mut times: Vec<Duration>) -> f64 {
    times.sort();
    let at = |part: f64| times[((times.len() - 1) as f64 * part) as usize].as_secs_f64() * 1e6;
    println!("{name:28} median {:8.1} us   p99 {:8.1} us   of {}", at(0.5), at(0.99), times.len());
    at(0.5)
}

fn main() {
    let plain = say("plain Rust", plain());
    let ours = say("a program, cycles of 1 ms", ours());
    println!(
        "goal: 1 cycle + 1.3 x plain = {:.1} us; ours / goal = {:.2}",
        1000.0 + 1.3 * plain,
        ours / (1000.0 + 1.3 * plain)
    );
}
