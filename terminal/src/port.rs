//! A port of this computer for one run, and the secret that tells the run from whoever else connects to it.
//!
//! The other side is `arl-rt/src/command/connection.rs`.

use std::fmt::Write as _;
use std::io::{ErrorKind, Read, Result, Write};
use std::net::{Ipv4Addr, SocketAddr, TcpListener, TcpStream};
use std::process::Command;
use std::time::Duration;

use crate::failure::Failure;

/// The variable of the environment that hands the secret over: other users see command lines, but no environments.
const SECRET: &str = "ARL2RS_SECRET";
/// How many random bytes a word of the secret has.
const BYTES: usize = 16;
/// How often it is looked whether the program has connected, or has ended before it did.
const LOOK_INTERVAL: Duration = Duration::from_millis(2);
/// So many connections may be open that have not said who they are, then the first one has to go; and so many are taken
/// in at a time.
const MOST_UNKNOWN: usize = 128;

/// What a run says when it connects, and what it is answered.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Secret {
    said: String,
    answer: String,
}

impl Secret {
    /// Another one.
    ///
    /// # Errors
    /// The system gives no random numbers.
    pub fn new() -> std::result::Result<Self, Failure> {
        let word = || -> std::result::Result<String, Failure> {
            let mut bytes = [0; BYTES];
            let filled = getrandom::fill(&mut bytes);
            filled.map_err(|error| Failure::Other(format!("the system provides no random numbers: {error}")))?;
            let mut text = String::new();
            for byte in bytes {
                // Writing to a string cannot fail.
                let _ = write!(text, "{byte:02x}");
            }
            Ok(text)
        };
        Ok(Self { said: word()?, answer: word()? })
    }

    /// Hands it over to a program that will connect.
    pub fn hand_over(&self, command: &mut Command) {
        command.env(SECRET, format!("{}:{}", self.said, self.answer));
    }

    /// Connects as a program does that it was handed over to.
    ///
    /// # Errors
    /// Nobody is at the address, or who is there does not know the secret.
    pub fn connect(&self, address: &str) -> Result<TcpStream> {
        let mut stream = TcpStream::connect(address)?;
        stream.write_all(format!("{}\n", self.said).as_bytes())?;
        let mut answer = vec![0; self.answer.len() + 1];
        stream.read_exact(&mut answer)?;
        match answer == format!("{}\n", self.answer).into_bytes() {
            true => Ok(stream),
            false => Err(ErrorKind::PermissionDenied.into()),
        }
    }
}

/// What a run connects to.
#[derive(Debug)]
pub struct Port {
    listener: TcpListener,
    address: SocketAddr,
    secret: Secret,
}

impl Port {
    /// Another one, of this computer, for a run that knows this secret.
    ///
    /// # Errors
    /// There are none left.
    pub fn open(secret: Secret) -> std::result::Result<Self, Failure> {
        let opened = TcpListener::bind((Ipv4Addr::LOCALHOST, 0)).and_then(|listener| {
            listener.set_nonblocking(true)?;
            Ok(Self { address: listener.local_addr()?, listener, secret })
        });
        opened.map_err(|error| Failure::Usage(format!("cannot open a port on 127.0.0.1: {error}")))
    }

    /// Where it is.
    pub fn address(&self) -> String {
        self.address.to_string()
    }

    /// Has a program connect, which this option of its own tells where.
    pub fn ask(&self, command: &mut Command, option: &str) {
        self.secret.hand_over(command);
        command.arg(option).arg(self.address());
    }

    /// The connection of the run, or how it ended without one. Whoever else connects is not heard. There is none behind
    /// it.
    ///
    /// # Errors
    /// The port is of no use any more, or `ended` says so.
    pub fn accept<E>(self, mut ended: impl FnMut() -> Result<Option<E>>) -> Result<std::result::Result<TcpStream, E>> {
        let mut unknown = Vec::new();
        loop {
            // Asked first: a connection that was made before the end is there to be accepted then.
            let ended = ended()?;
            if let Some(mut stream) = self.look(&mut unknown)? {
                stream.set_nonblocking(false)?;
                stream.write_all(format!("{}\n", self.secret.answer).as_bytes())?;
                return Ok(Ok(stream));
            }
            match ended {
                Some(ended) => return Ok(Err(ended)),
                None => std::thread::sleep(LOOK_INTERVAL),
            }
        }
    }

    /// The connection that has said the word, among those that are there and those that wait. Those that have said
    /// another one are closed.
    fn look(&self, unknown: &mut Vec<Unknown>) -> Result<Option<TcpStream>> {
        let word = format!("{}\n", self.secret.said).into_bytes();
        let mut at = 0;
        while let Some(one) = unknown.get_mut(at) {
            match one.says(&word) {
                Says::Nothing => at += 1,
                Says::Another => drop(unknown.remove(at)),
                Says::TheWord => return Ok(Some(unknown.remove(at).stream)),
            }
        }
        // Not all that wait: somebody may connect again and again, and faster.
        for _ in 0..MOST_UNKNOWN {
            let stream = match self.listener.accept() {
                Ok((stream, _)) => stream,
                Err(error) if error.kind() == ErrorKind::WouldBlock => break,
                // Who has left again is nobody.
                Err(error) if error.kind() == ErrorKind::ConnectionAborted => continue,
                Err(error) => return Err(error),
            };
            stream.set_nonblocking(true)?;
            let mut one = Unknown { stream, said: Vec::new() };
            match one.says(&word) {
                // Only who was asked before has to go.
                Says::Nothing => {
                    if unknown.len() >= MOST_UNKNOWN {
                        unknown.remove(0);
                    }
                    unknown.push(one);
                }
                Says::Another => {}
                Says::TheWord => return Ok(Some(one.stream)),
            }
        }
        Ok(None)
    }
}

/// A connection that has not said yet who it is.
struct Unknown {
    stream: TcpStream,
    said: Vec<u8>,
}

/// What a connection has said.
enum Says {
    /// Not enough.
    Nothing,
    /// Something else, or it is gone.
    Another,
    TheWord,
}

impl Unknown {
    fn says(&mut self, word: &[u8]) -> Says {
        // Not a byte more than the word: what comes behind it is for who hears the run.
        let mut rest = vec![0; word.len() - self.said.len()];
        match self.stream.read(&mut rest) {
            Ok(0) => return Says::Another,
            Ok(count) => self.said.extend(rest.iter().take(count)),
            Err(error) if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::Interrupted) => {}
            Err(_) => return Says::Another,
        }
        // A part is not judged: who learned that it is wrong could guess the word byte by byte.
        match self.said.as_slice() {
            said if said.len() < word.len() => Says::Nothing,
            said if said == word => Says::TheWord,
            _ => Says::Another,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn secrets_differ() {
        let secrets = [Secret::new().expect("random numbers"), Secret::new().expect("random numbers")];
        assert_ne!(secrets[0], secrets[1]);
        assert!(secrets.iter().all(|secret| secret.said.len() == 2 * BYTES && secret.said != secret.answer));
    }

    #[test]
    fn whoever_connects_first_is_not_heard_unless_it_is_the_run() {
        let secret = Secret::new().expect("random numbers");
        let port = Port::open(secret.clone()).expect("a port");
        let address = port.address();
        // One says nothing, one something else, one leaves at once, and some are many.
        let silent: Vec<TcpStream> = (0..100).map(|_| TcpStream::connect(&address).expect("a port")).collect();
        let mut stranger = TcpStream::connect(&address).expect("a port");
        stranger.write_all(b"{\"hello\":{\"channels\":[]}}\n").expect("it is open");
        drop(TcpStream::connect(&address).expect("a port"));
        let run = std::thread::spawn(move || {
            let mut stream = secret.connect(&address).expect("it knows the secret");
            stream.write_all(b"{\"ended\":0}\n").expect("it is open");
        });
        let stream = port.accept(|| Ok(None::<()>)).expect("no error").expect("a connection");
        assert_eq!(std::io::read_to_string(stream).expect("a text"), "{\"ended\":0}\n");
        run.join().expect("no panic");
        let mut left = Vec::new();
        // It was closed, and told nothing.
        assert!(stranger.read_to_end(&mut left).is_err() || left.is_empty());
        drop(silent);
    }

    #[test]
    fn a_part_of_the_word_is_as_good_as_any_other_words() {
        let secret = Secret::new().expect("random numbers");
        let port = Port::open(secret.clone()).expect("a port");
        let says = |words: &str| {
            let mut stream = TcpStream::connect(port.address()).expect("a port");
            stream.write_all(words.as_bytes()).expect("it is open");
            stream
        };
        let part = secret.said.get(..8).expect("a word");
        let _kept = [says(part), says("?"), says(&"?".repeat(8))];
        let mut unknown = Vec::new();
        assert!(port.look(&mut unknown).expect("no error").is_none());
        assert_eq!(unknown.len(), 3);
        let mut whole = says(&"?".repeat(secret.said.len() + 1));
        whole.set_nonblocking(true).expect("it is open");
        let waits =
            |stream: &mut TcpStream| stream.read(&mut [0]).is_err_and(|error| error.kind() == ErrorKind::WouldBlock);
        while waits(&mut whole) {
            assert!(port.look(&mut unknown).expect("no error").is_none());
        }
        assert_eq!(unknown.len(), 3);
    }

    #[test]
    fn a_crowd_does_not_push_the_run_out() {
        let secret = Secret::new().expect("random numbers");
        let port = Port::open(secret.clone()).expect("a port");
        let (mut unknown, mut crowd) = (Vec::new(), Vec::new());
        for _ in 0..2 {
            crowd.extend((0..70).map(|_| TcpStream::connect(port.address()).expect("a port")));
            assert!(port.look(&mut unknown).expect("no error").is_none());
            assert!(unknown.len() <= MOST_UNKNOWN);
        }
        let mut run = TcpStream::connect(port.address()).expect("a port");
        run.write_all(format!("{}\n", secret.said).as_bytes()).expect("it is open");
        while port.look(&mut unknown).expect("no error").is_none() {}
    }

    #[test]
    fn a_run_that_ends_without_a_connection_is_not_waited_for() {
        let port = Port::open(Secret::new().expect("random numbers")).expect("a port");
        let stranger = TcpStream::connect(port.address()).expect("a port");
        assert_eq!(port.accept(|| Ok(Some(7))).expect("no error").expect_err("it has ended"), 7);
        drop(stranger);
    }
}
