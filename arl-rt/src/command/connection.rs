//! The connection of a run to its listener or debugger. Any user of the computer may connect to a port, or open one: so
//! both sides prove that they belong together before anything else is sent.
//!
//! The process that starts the run passes a secret in its environment, `ARL2RS_SECRET`: two words separated by a colon,
//! which other users cannot see. The run sends the first word in a line, and the listener answers with the second one
//! in a line. Without a secret none of this is sent: a host may listen without it.

use std::io::{Error, ErrorKind, Read, Result, Write};
use std::net::TcpStream;
use std::time::Duration;

/// The environment variable with the secret.
const SECRET: &str = "ARL2RS_SECRET";
/// How long the listener may take to answer.
const PATIENCE: Duration = Duration::from_secs(30);

/// Connects to the listener at an address.
///
/// # Errors
/// There is no listener, or the listener did not start this run.
pub(super) fn connect(address: &str) -> Result<TcpStream> {
    let mut stream = TcpStream::connect(address)?;
    if let Ok(secret) = std::env::var(SECRET) {
        greet(&mut stream, &secret)?;
    }
    Ok(stream)
}

/// Sends the first word, and expects the second one.
fn greet(stream: &mut TcpStream, secret: &str) -> Result<()> {
    let (own, other) = secret.split_once(':').unwrap_or((secret, ""));
    stream.write_all(format!("{own}\n").as_bytes())?;
    stream.set_read_timeout(Some(PATIENCE))?;
    let mut answer = vec![0; other.len() + 1];
    let answered = stream.read_exact(&mut answer);
    stream.set_read_timeout(None)?;
    match answered {
        Ok(()) if answer.strip_suffix(b"\n") == Some(other.as_bytes()) => Ok(()),
        _ => Err(Error::new(ErrorKind::PermissionDenied, "the listener there did not start this run")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::net::TcpListener;

    /// The result of a greeting with this answer, and what was sent.
    fn greeted(answer: &str) -> (Result<()>, String) {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let address = listener.local_addr().unwrap();
        let answer = answer.to_owned();
        let other = std::thread::spawn(move || {
            let (mut stream, _) = listener.accept().unwrap();
            let mut sent = [0; 4];
            stream.read_exact(&mut sent).unwrap();
            stream.write_all(answer.as_bytes()).unwrap();
            String::from_utf8_lossy(&sent).into_owned()
        });
        let mut stream = TcpStream::connect(address).unwrap();
        (greet(&mut stream, "one:two"), other.join().unwrap())
    }

    #[test]
    fn only_who_knows_the_secret_is_spoken_to() {
        let (greeted_well, sent) = greeted("two\n");
        assert!(greeted_well.is_ok());
        assert_eq!(sent, "one\n");
        for answer in ["", "two", "one\n", "too\n"] {
            assert_eq!(greeted(answer).0.unwrap_err().kind(), ErrorKind::PermissionDenied, "{answer}");
        }
    }
}
