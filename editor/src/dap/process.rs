//! The program that is debugged: a process that connects to the adapter.

use super::Event;
use arl_terminal::port::{Port, Secret};
use serde_json::Value;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// How long a program may take from its start until it connects.
const LONGEST_START: Duration = Duration::from_secs(20);

/// News of a program.
pub(super) enum News {
    /// A message that it sends by itself.
    Message(Value),
    /// What it prints, on `stdout` or `stderr`.
    Output(&'static str, String),
    /// It is gone; its exit code, if it ended before that could be requested.
    Ended(Option<i32>),
}

/// A program that runs.
pub(super) struct Process {
    child: Child,
    stream: TcpStream,
    answers: Receiver<Value>,
    asked: u64,
}

impl Process {
    /// Starts a program; its news comes under this number.
    ///
    /// # Errors
    /// The program cannot be started, or ends before it connects: then its output and its end are news, too.
    pub(super) fn start(mut command: Command, number: u64, events: &Sender<Event>) -> Result<Self, String> {
        let port = Secret::new().and_then(Port::open).map_err(|failure| failure.to_string())?;
        port.ask(&mut command, "--debug");
        command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = command.spawn().map_err(|error| format!("the program cannot be started: {error}"))?;
        let pipes: [Option<(&'static str, Box<dyn Read + Send>)>; 2] = [
            child.stdout.take().map(|out| ("stdout", Box::new(out) as Box<dyn Read + Send>)),
            child.stderr.take().map(|out| ("stderr", Box::new(out) as Box<dyn Read + Send>)),
        ];
        let said = Arc::new(Mutex::new(None));
        let readers: Vec<_> =
            pipes.into_iter().flatten().map(|(name, pipe)| output(name, pipe, number, events, &said)).collect();
        let stream = match accept(port, &mut child) {
            Ok(stream) => stream,
            Err(why) => {
                let _ = child.kill();
                let code = child.wait().ok().and_then(|status| status.code());
                readers.into_iter().for_each(|reader| drop(reader.join()));
                let _ = events.send(Event::Process(number, News::Ended(code)));
                return Err(said.lock().unwrap_or_else(PoisonError::into_inner).take().unwrap_or(why));
            }
        };
        let (sender, answers) = channel();
        let incoming = BufReader::new(stream.try_clone().map_err(|error| error.to_string())?);
        let events = events.clone();
        std::thread::spawn(move || {
            for line in incoming.lines().map_while(Result::ok) {
                let Ok(value) = serde_json::from_str::<Value>(&line) else { continue };
                let taken = match value.get("answer") {
                    Some(_) => sender.send(value).is_ok(),
                    None => events.send(Event::Process(number, News::Message(value))).is_ok(),
                };
                if !taken {
                    return;
                }
            }
            drop(sender);
            // What it has printed comes first.
            readers.into_iter().for_each(|reader| drop(reader.join()));
            let _ = events.send(Event::Process(number, News::Ended(None)));
        });
        Ok(Self { child, stream, answers, asked: 0 })
    }

    /// Sends a request, and waits for the answer.
    ///
    /// # Errors
    /// The program's refusal, or that it is gone.
    pub(super) fn ask(&mut self, word: &str, values: &[&str]) -> Result<Value, String> {
        let gone = "the program has ended";
        self.asked += 1;
        let line: Vec<String> = values.iter().map(|value| value.replace(['\t', '\n', '\r'], " ")).collect();
        let text = [&[self.asked.to_string(), word.to_owned()], line.as_slice()].concat().join("\t");
        self.stream.write_all((text + "\n").as_bytes()).map_err(|_| gone)?;
        let answer = self.answers.recv().map_err(|_| gone)?;
        match answer.get("error").and_then(Value::as_str) {
            Some(error) => Err(error.to_owned()),
            None => Ok(answer),
        }
    }

    /// Its exit code, once it has ended.
    pub(super) fn exit_code(&mut self) -> Option<i32> {
        self.child.wait().ok()?.code()
    }
}

impl Drop for Process {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// Waits until the program connects.
fn accept(port: Port, child: &mut Child) -> Result<TcpStream, String> {
    let start = Instant::now();
    let gone = || -> std::io::Result<Option<String>> {
        Ok(match child.try_wait()? {
            Some(status) => Some(format!("the program ended before it connected ({status})")),
            None => (start.elapsed() > LONGEST_START).then(|| "the program does not answer".to_owned()),
        })
    };
    let stream = port.accept(gone).map_err(|error| error.to_string())??;
    stream.set_nodelay(true).map_err(|error| error.to_string())?;
    Ok(stream)
}

/// Passes on what a program prints, and keeps its first error.
fn output(
    name: &'static str,
    pipe: Box<dyn Read + Send>,
    number: u64,
    events: &Sender<Event>,
    said: &Arc<Mutex<Option<String>>>,
) -> std::thread::JoinHandle<()> {
    let (events, said) = (events.clone(), Arc::clone(said));
    std::thread::spawn(move || {
        let mut pipe = BufReader::new(pipe);
        let mut line = Vec::new();
        while matches!(pipe.read_until(b'\n', &mut line), Ok(1..)) {
            let text = String::from_utf8_lossy(&line).into_owned();
            line.clear();
            if let Some(error) = text.strip_prefix("error: ").filter(|_| name == "stderr") {
                let mut said = said.lock().unwrap_or_else(PoisonError::into_inner);
                said.get_or_insert_with(|| error.trim_end().to_owned());
            }
            if events.send(Event::Process(number, News::Output(name, text))).is_err() {
                return;
            }
        }
    })
}
