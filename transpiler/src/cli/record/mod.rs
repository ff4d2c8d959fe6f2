//! `arl2rs run --record FILE.mcap`: the program runs as ever and says to the recorder what happens; the recorder writes it into a file that
//! viewers of robot data open, and a description of the robots beside it.
//!
//! The program connects to the recorder, not the other way round: so its streams stay its own. What the recording holds stands in
//! `docs/recordings.md`.

mod links;
mod messages;
mod recorder;
mod schemas;
#[cfg(test)]
mod tests;
mod urdf;

use std::fs::File;
use std::io::{BufRead, BufReader, BufWriter};
use std::net::{Ipv4Addr, TcpListener, TcpStream};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus};
use std::time::Duration;

use super::failure::Failure;
use super::said::Line;
use super::show;
use recorder::Recorder;

/// The description of the robots, beside a recording.
const DESCRIPTION: &str = "cell.urdf";
/// How often it is looked whether the program has connected, or has ended before it did.
const LOOK_INTERVAL: Duration = Duration::from_millis(2);

/// A recording that a program will make.
pub(super) struct Recording {
    path: PathBuf,
    file: File,
    listener: TcpListener,
}

impl Recording {
    /// Makes the file: better to fail now than after a long run.
    pub(super) fn create(path: &Path) -> Result<Self, Failure> {
        let file = File::create(path).map_err(|error| Failure::io("write", path, &error))?;
        let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, 0)).and_then(|listener| {
            listener.set_nonblocking(true)?;
            Ok(listener)
        });
        let listener =
            listener.map_err(|error| Failure::Usage(format!("there is no place to record from: {error}")))?;
        Ok(Self { path: path.to_owned(), file, listener })
    }

    /// Has the program say what happens.
    pub(super) fn ask(&self, command: &mut Command) -> Result<(), Failure> {
        let address = self.listener.local_addr().map_err(|error| Failure::io("write", &self.path, &error))?;
        command.arg("--record").arg(address.to_string());
        Ok(())
    }

    /// Records until the program has ended, whatever comes between.
    pub(super) fn record(self, program: &mut Child) -> std::io::Result<ExitStatus> {
        let Self { path, file, listener } = self;
        match accept(&listener, program)? {
            Err(ended) => {
                // It did not even begin, and has said why.
                drop(std::fs::remove_file(&path));
                Ok(ended)
            }
            Ok(stream) => {
                if let Err(error) = write(&path, file, &stream) {
                    show::warning(&format!("the recording {} is not whole: {error}", path.display()));
                    // The program goes on; nobody writes what it says any more.
                    drop(std::io::copy(&mut &stream, &mut std::io::sink()));
                }
                program.wait()
            }
        }
    }
}

/// The program's connection, or how it ended before.
fn accept(listener: &TcpListener, program: &mut Child) -> std::io::Result<Result<TcpStream, ExitStatus>> {
    loop {
        match listener.accept() {
            Ok((stream, _)) => {
                stream.set_nonblocking(false)?;
                return Ok(Ok(stream));
            }
            Err(error) if error.kind() == std::io::ErrorKind::WouldBlock => {}
            Err(error) => return Err(error),
        }
        if let Some(ended) = program.try_wait()? {
            return Ok(Err(ended));
        }
        std::thread::sleep(LOOK_INTERVAL);
    }
}

/// Writes what comes until nothing comes any more.
fn write(path: &Path, file: File, stream: &TcpStream) -> Result<(), Box<dyn std::error::Error>> {
    let mut recorder = Recorder::new(BufWriter::new(file))?;
    let mut stream = BufReader::new(stream);
    let mut bytes = Vec::new();
    while matches!(stream.read_until(b'\n', &mut bytes), Ok(1..)) {
        let line: Line = serde_json::from_slice(&bytes)?;
        let begins = matches!(line, Line::Hello(_));
        recorder.hear(line)?;
        if begins {
            let description = path.with_file_name(DESCRIPTION);
            std::fs::write(&description, urdf::urdf(recorder.arms()))
                .map_err(|error| format!("cannot write {}: {error}", description.display()))?;
        }
        bytes.clear();
    }
    recorder.finish()?;
    Ok(())
}
