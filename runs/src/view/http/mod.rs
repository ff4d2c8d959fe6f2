//! An HTTP server for one page and few visitors, which clients that send slowly, or nothing, cannot block: each request
//! has a time limit, and where there are too many connections, the least important one is closed.

mod places;
mod request;
mod response;
#[cfg(test)]
mod tests;

use std::io::{self, Read};
use std::net::{Ipv4Addr, Shutdown, SocketAddr, TcpListener, TcpStream};
use std::sync::Arc;
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use arl_terminal::failure::Failure;
use places::Places;
pub(super) use places::Rank;
pub(super) use request::Request;
use request::Requests;
pub(super) use response::{Response, Status};

/// The time limits of visitors.
#[derive(Clone, Copy, Debug)]
pub(super) struct Limits {
    /// A request must be complete this long after its first byte, and an answer must be taken this long after its own.
    exchange: Duration,
    /// A connection on which nothing arrives for this long is closed.
    idle: Duration,
}

impl Limits {
    pub(super) const USUAL: Self = Self { exchange: Duration::from_secs(10), idle: Duration::from_secs(120) };
}

/// How long to wait for the rest of what is not a request.
const PARTING: Duration = Duration::from_millis(500);
/// Stack of a connection's thread, in bytes.
const STACK: usize = 1 << 20;
/// How long no visitor is let in after that has failed: files or threads may have run out.
const BREATHER: Duration = Duration::from_millis(5);

/// Answers requests; the rank determines which connections may stay where there are too many.
pub(super) trait Answers: Send + Sync + 'static {
    /// The answer to a request.
    fn answer(&self, request: &Request) -> (Rank, Response);
}

/// Serves on a port of this computer, any free one for 0; returns the address, and the thread that lets visitors in.
///
/// # Errors
/// The port is not available.
pub(super) fn serve<A: Answers>(
    port: u16,
    limits: Limits,
    answers: impl FnOnce(SocketAddr) -> A,
) -> io::Result<(SocketAddr, JoinHandle<()>)> {
    let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, port))?;
    let address = listener.local_addr()?;
    let answers = Arc::new(answers(address));
    let door = std::thread::Builder::new().name("http".into());
    Ok((address, door.spawn(move || let_in(&listener, limits, &answers))?))
}

/// Lets visitors in, forever: each has a thread.
fn let_in<A: Answers>(listener: &TcpListener, limits: Limits, answers: &Arc<A>) {
    let places = Arc::new(Places::default());
    loop {
        let Ok((stream, _)) = listener.accept() else {
            places.free_one();
            std::thread::sleep(BREATHER);
            continue;
        };
        let (place, stream) = places.take(stream);
        let answers = Arc::clone(answers);
        let thread = std::thread::Builder::new().name("http-visitor".into()).stack_size(STACK);
        let visit = move || {
            let visited = visit(&stream, limits, &*answers, |rank| place.rises_to(rank));
            // If the visitor leaves in the middle, there is nobody to report the error to.
            drop(visited);
        };
        if thread.spawn(visit).is_err() {
            places.free_one();
            std::thread::sleep(BREATHER);
        }
    }
}

/// Answers the requests of a connection until it ends.
fn visit(stream: &TcpStream, limits: Limits, answers: &impl Answers, rises_to: impl Fn(Rank)) -> io::Result<()> {
    stream.set_nodelay(true)?;
    let mut requests = Requests::new(stream, limits);
    while let Some(request) = requests.next() {
        match request {
            Ok(request) => {
                let (rank, response) = answers.answer(&request);
                rises_to(rank);
                response.write(stream, request.keeps_open, limits.exchange)?;
                if !request.keeps_open {
                    return Ok(());
                }
            }
            Err(problem) => {
                Response::text(problem.status, problem.why).write(stream, false, limits.exchange)?;
                return part(stream);
            }
        }
    }
    Ok(())
}

/// Reads what is still being sent, for a moment: a connection that is closed before it is read loses the answer.
fn part(mut stream: &TcpStream) -> io::Result<()> {
    stream.shutdown(Shutdown::Write)?;
    stream.set_read_timeout(Some(PARTING))?;
    let mut bytes = [0; 4096];
    let until = Instant::now() + PARTING;
    while Instant::now() < until && stream.read(&mut bytes)? > 0 {}
    Ok(())
}

/// The error for a port that is not available.
pub(super) fn refusal(port: u16, error: &io::Error) -> Failure {
    Failure::Usage(match error.kind() {
        io::ErrorKind::AddrInUse => format!(
            "port {port} is taken, perhaps by another view: choose another `--port`, or leave it out for a free one"
        ),
        _ => format!("cannot serve on port {port}: {error}"),
    })
}
