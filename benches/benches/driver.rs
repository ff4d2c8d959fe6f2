//! What it costs to drive an arm over the network, beside a bare loop that exchanges packets of the same length.
//!
//! `cargo bench -p arl-benches --bench driver [-- CYCLES]`. The other side is a thread that answers at once. All take
//! turns; a cycle waits for its answer, so that a second has as many set-points as it can.

use std::error::Error;
use std::net::UdpSocket;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::scope;
use std::time::{Duration, Instant};

use arl_benches::cell::Robot;
use arl_drivers::rsi::RsiArm;
use arl_drivers::udp::UdpArm;
use arl_drivers::udp::packet::{COMMAND_LENGTH, STATE_LENGTH};
use arl_rt::clock::Rate;
use arl_rt::{Builder, Controller};
use rustix::thread::ClockId;
use rustix::time::clock_gettime;

/// How often all take turns.
const TURNS: usize = 5;
/// Cycles before what is measured: the first plans.
const FIRST: usize = 200;

fn main() -> Result<(), Box<dyn Error>> {
    let cycles: usize = std::env::args().skip(1).find_map(|word| word.parse().ok()).unwrap_or(10_000);
    let mut all: [(&str, Vec<Cost>); 4] =
        [("simulated", vec![]), ("bare exchange", vec![]), ("UDP", vec![]), ("RSI", vec![])];
    for _ in 0..TURNS {
        let [simulated, bare, udp, rsi] = &mut all;
        simulated.1.push(controlled(cycles, |builder| builder)?);
        bare.1.push(with_echo(|address| exchanged(cycles, address))?);
        udp.1.push(with_echo(|address| {
            controlled(cycles, |builder| builder.robot_driver(UdpArm::new(address).in_its_own_time()))
        })?);
        rsi.1.push(with_robot(|listen| {
            let arm = RsiArm::new(listen).in_its_own_time();
            controlled(cycles, |builder| {
                let cell = arl_rt::Cell { rate: Rate::from_micros(4000), ..arl_rt::Cell::default() };
                builder.cell(cell).clock(arm.clock()).robot_driver(arm)
            })
        })?);
    }
    println!("medians of {TURNS} times {cycles} cycles    us of a processor   set-points a second");
    for (what, costs) in &mut all {
        let (busy, rate) = (median(costs, |cost| cost.busy * 1e6), median(costs, |cost| 1.0 / cost.lasts));
        println!("{what:<36} {busy:>19.1} {rate:>21.0}");
    }
    Ok(())
}

/// What a cycle costs, in s.
#[derive(Clone, Copy)]
struct Cost {
    /// Of the processor that it runs on.
    busy: f64,
    /// By the clock.
    lasts: f64,
}

fn median(costs: &mut [Cost], of: fn(&Cost) -> f64) -> f64 {
    costs.sort_by(|one, other| of(one).total_cmp(&of(other)));
    costs.get(costs.len() / 2).map_or(f64::NAN, of)
}

/// Measures something that is done so often, in this thread.
fn measured(cycles: usize, mut cycle: impl FnMut()) -> Cost {
    (0..FIRST).for_each(|_| cycle());
    let busy = || {
        let time = clock_gettime(ClockId::ThreadCPUTime);
        time.tv_sec as f64 + time.tv_nsec as f64 * 1e-9
    };
    let (began, at) = (Instant::now(), busy());
    (0..cycles).for_each(|_| cycle());
    let count = cycles as f64;
    Cost { busy: (busy() - at) / count, lasts: began.elapsed().as_secs_f64() / count }
}

/// Cycles of a controller whose robot moves.
fn controlled(cycles: usize, driven: impl FnOnce(Builder) -> Builder) -> Result<Cost, Box<dyn Error>> {
    let program = Robot::new(1, 0, i32::MAX, 50.0);
    let mut controller = driven(Controller::builder()).build(Box::new(program))?;
    let cost = measured(cycles, || {
        controller.step();
    });
    if controller.outcome().is_some() {
        return Err("the program has ended".into());
    }
    Ok(cost)
}

/// The exchange alone: packets there and back, each of which is waited for.
fn exchanged(cycles: usize, address: &str) -> Result<Cost, Box<dyn Error>> {
    let socket = UdpSocket::bind("127.0.0.1:0")?;
    socket.connect(address)?;
    let (command, mut state) = ([0; COMMAND_LENGTH], [0; STATE_LENGTH + 1]);
    let mut lost = 0;
    let cost = measured(cycles, || {
        let done = socket.send(&command).and_then(|_| socket.recv(&mut state));
        lost += u32::from(done.is_err());
    });
    if lost > 0 { Err("exchanges were lost".into()) } else { Ok(cost) }
}

/// Beside an arm that is where it shall be.
fn with_echo(work: impl FnOnce(&str) -> Result<Cost, Box<dyn Error>>) -> Result<Cost, Box<dyn Error>> {
    let socket = UdpSocket::bind("127.0.0.1:0")?;
    let address = socket.local_addr()?.to_string();
    beside(|ended| echo(&socket, ended), || work(&address))
}

/// Beside a robot that is where it was told to be.
fn with_robot(work: impl FnOnce(&str) -> Result<Cost, Box<dyn Error>>) -> Result<Cost, Box<dyn Error>> {
    let listen = UdpSocket::bind("127.0.0.1:0")?.local_addr()?.to_string();
    beside(|ended| send(&listen, ended), || work(&listen))
}

fn beside(
    other: impl FnOnce(&AtomicBool) -> std::io::Result<()> + Send,
    work: impl FnOnce() -> Result<Cost, Box<dyn Error>>,
) -> Result<Cost, Box<dyn Error>> {
    let ended = Arc::new(AtomicBool::new(false));
    scope(|scope| {
        let other = scope.spawn(|| other(&ended));
        let cost = work();
        ended.store(true, Ordering::Relaxed);
        other.join().map_err(|_| "the other side has panicked")??;
        cost
    })
}

fn echo(socket: &UdpSocket, ended: &AtomicBool) -> std::io::Result<()> {
    socket.set_read_timeout(Some(Duration::from_millis(50)))?;
    let (mut command, mut state, mut sequence) = ([0; COMMAND_LENGTH + 1], [0; STATE_LENGTH], 0_u64);
    state[..8].copy_from_slice(b"ARLS\x01\0\x06\0");
    while !ended.load(Ordering::Relaxed) {
        let Ok((_, from)) = socket.recv_from(&mut command) else { continue };
        sequence += 1;
        // Session, drives, sequence, the command's, position.
        state[8..12].copy_from_slice(&command[8..12]);
        state[12] = command[12];
        state[16..24].copy_from_slice(&sequence.to_le_bytes());
        state[24..32].copy_from_slice(&command[16..24]);
        state[40..136].copy_from_slice(&command[32..128]);
        socket.send_to(&state, from)?;
    }
    Ok(())
}

fn send(listen: &str, ended: &AtomicBool) -> std::io::Result<()> {
    let socket = UdpSocket::bind("127.0.0.1:0")?;
    socket.set_read_timeout(Some(Duration::from_millis(50)))?;
    let (mut ipoc, mut bytes) = (0, [0; 1024]);
    let mut axes = "A1=\"0\" A2=\"0\" A3=\"0\" A4=\"0\" A5=\"0\" A6=\"0\"".to_owned();
    while !ended.load(Ordering::Relaxed) {
        ipoc += 4;
        let message = format!("<Rob Type=\"KUKA\"><AIPos {axes}/><Delay D=\"0\"/><IPOC>{ipoc}</IPOC></Rob>");
        socket.send_to(message.as_bytes(), listen)?;
        let Ok(length) = socket.recv(&mut bytes) else { continue };
        let answer = String::from_utf8_lossy(bytes.get(..length).unwrap_or_default());
        if let Some((_, rest)) = answer.split_once("<AK ")
            && let Some((correction, _)) = rest.split_once("/>")
        {
            axes = correction.to_owned();
        }
    }
    Ok(())
}
