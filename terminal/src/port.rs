//! A port of this computer for one run, and the secret that distinguishes the run from other clients.
//!
//! The other side is `arl-rt/src/command/connection.rs`.

use std::fmt::Write as _;
use std::io::{ErrorKind, Read, Result, Write};
use std::net::{Ipv4Addr, SocketAddr, TcpListener, TcpStream};
use std::process::Command;
use std::time::Duration;

use crate::failure::Failure;

/// The environment variable that passes the secret: other users can see command lines, but not environments.
const SECRET: &str = "ARL2RS_SECRET";
/// The number of random bytes in a word of the secret.
const BYTES: usize = 16;
/// The interval of checks whether the program has connected, or has ended before that.
const LOOK_INTERVAL: Duration = Duration::from_millis(2);
/// The most open connections that are not yet identified, before the first one is closed; and the most connections
/// accepted at a time.
const MOST_UNKNOWN: usize = 128;

/// The word that a run sends when it connects, and the answer to it.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Secret {
    word: String,
    answer: String,
}

impl Secret {
    /// A new secret.
    ///
    /// # Errors
    /// The system provides no random numbers.
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
        Ok(Self { word: word()?, answer: word()? })
    }

    /// Passes the secret to a program that will connect.
    pub fn hand_over(&self, command: &mut Command) {
        command.env(SECRET, format!("{}:{}", self.word, self.answer));
    }

    /// Connects like a program to which the secret was passed.
    ///
    /// # Errors
    /// Nothing listens at the address, or the listener does not know the secret.
    pub fn connect(&self, address: &str) -> Result<TcpStream> {
        let mut stream = TcpStream::connect(address)?;
        stream.write_all(format!("{}\n", self.word).as_bytes())?;
        let mut answer = vec![0; self.answer.len() + 1];
        stream.read_exact(&mut answer)?;
        match answer == format!("{}\n", self.answer).into_bytes() {
            true => Ok(stream),
            false => Err(ErrorKind::PermissionDenied.into()),
        }
    }
}

/// A port to which a run connects.
#[derive(Debug)]
pub struct Port {
    listener: TcpListener,
    address: SocketAddr,
    secret: Secret,
}

impl Port {
    /// Opens a new port of this computer for a run that knows this secret.
    ///
    /// # Errors
    /// No ports are left.
    pub fn open(secret: Secret) -> std::result::Result<Self, Failure> {
        let opened = TcpListener::bind((Ipv4Addr::LOCALHOST, 0)).and_then(|listener| {
            listener.set_nonblocking(true)?;
            Ok(Self { address: listener.local_addr()?, listener, secret })
        });
        opened.map_err(|error| Failure::Usage(format!("cannot open a port on 127.0.0.1: {error}")))
    }

    /// The address of the port.
    pub fn address(&self) -> String {
        self.address.to_string()
    }

    /// Lets a program connect; the program gets the address through this option.
    pub fn ask(&self, command: &mut Command, option: &str) {
        self.secret.hand_over(command);
        command.arg(option).arg(self.address());
    }

    /// The connection of the run, or how the run ended without one. Other clients are ignored. No further connection is
    /// accepted.
    ///
    /// # Errors
    /// The port is no longer usable, or `ended` fails.
    pub fn accept<E>(self, mut ended: impl FnMut() -> Result<Option<E>>) -> Result<std::result::Result<TcpStream, E>> {
        let mut unknown = Vec::new();
        loop {
            // Called first: a connection made before the end can then be accepted.
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

    /// The connection that has sent the word, among the open and the waiting ones. Connections that have sent another
    /// word are closed.
    fn look(&self, unknown: &mut Vec<Unknown>) -> Result<Option<TcpStream>> {
        let word = format!("{}\n", self.secret.word).into_bytes();
        let mut at = 0;
        while let Some(one) = unknown.get_mut(at) {
            match one.says(&word) {
                Says::Nothing => at += 1,
                Says::Another => drop(unknown.remove(at)),
                Says::TheWord => return Ok(Some(unknown.remove(at).stream)),
            }
        }
        // Not all that wait: a client may connect again and again, and faster.
        for _ in 0..MOST_UNKNOWN {
            let stream = match self.listener.accept() {
                Ok((stream, _)) => stream,
                Err(error) if error.kind() == ErrorKind::WouldBlock => break,
                // A client that has disconnected again is ignored.
                Err(error) if error.kind() == ErrorKind::ConnectionAborted => continue,
                Err(error) => return Err(error),
            };
            stream.set_nonblocking(true)?;
            let mut one = Unknown { stream, received: Vec::new() };
            match one.says(&word) {
                // Only connections that were checked before are closed.
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

/// A connection that is not yet identified.
struct Unknown {
    stream: TcpStream,
    received: Vec<u8>,
}

/// What a connection has sent.
enum Says {
    /// Not enough bytes.
    Nothing,
    /// Something else, or the connection is closed.
    Another,
    TheWord,
}

impl Unknown {
    fn says(&mut self, word: &[u8]) -> Says {
        // Not a byte more than the word: the bytes after it are for the reader of the run.
        let mut rest = vec![0; word.len() - self.received.len()];
        match self.stream.read(&mut rest) {
            Ok(0) => return Says::Another,
            Ok(count) => self.received.extend(rest.iter().take(count)),
            Err(error) if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::Interrupted) => {}
            Err(_) => return Says::Another,
        }
        // An incomplete word is not judged: a client that learned that it is wrong could guess the word byte by byte.
        match self.received.as_slice() {
            received if received.len() < word.len() => Says::Nothing,
            received if received == word => Says::TheWord,
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
        assert!(secrets.iter().all(|secret| secret.word.len() == 2 * BYTES && secret.word != secret.answer));
    }

    #[test]
    fn whoever_connects_first_is_not_heard_unless_it_is_the_run() {
        let secret = Secret::new().expect("random numbers");
        let port = Port::open(secret.clone()).expect("a port");
        let address = port.address();
        // One sends nothing, one something else, one disconnects at once, and one client opens many connections.
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
        let mut rest = Vec::new();
        // It was closed without an answer.
        assert!(stranger.read_to_end(&mut rest).is_err() || rest.is_empty());
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
        let part = secret.word.get(..8).expect("a word");
        let _kept = [says(part), says("?"), says(&"?".repeat(8))];
        let mut unknown = Vec::new();
        assert!(port.look(&mut unknown).expect("no error").is_none());
        assert_eq!(unknown.len(), 3);
        let mut whole = says(&"?".repeat(secret.word.len() + 1));
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
        run.write_all(format!("{}\n", secret.word).as_bytes()).expect("it is open");
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
