//! A process of the program that makes run after run, in a folder of its own.

use super::folder::{Folder, Spread};
use super::result::RunResult;
use std::io::{BufRead, BufReader, Write};
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::time::{Duration, Instant};

/// A run that takes longer on the clock of the computer is given up, where nobody says otherwise.
pub(super) const TIMEOUT: Duration = Duration::from_secs(600);

/// How long a process may take to end by itself.
const PATIENCE: Duration = Duration::from_secs(1);
/// How often it is looked whether somebody wants to stop.
const SIGNAL_INTERVAL: Duration = Duration::from_millis(50);
/// How often it is looked whether a process has ended.
const LOOK_INTERVAL: Duration = Duration::from_millis(1);

/// A process that makes runs.
#[derive(Debug)]
pub struct Worker {
    folder: Folder,
    timeout: Duration,
    process: Option<Process>,
}

#[derive(Debug)]
struct Process {
    child: Child,
    questions: ChildStdin,
    answers: Receiver<std::io::Result<String>>,
}

/// Why there is no answer.
enum Lost {
    /// The process has ended; how.
    Crashed(String),
    /// It takes too long.
    Hung,
    /// Nobody wants it any more.
    Enough,
}

impl Worker {
    /// A worker for a bundle that lies on the disk; its process begins with the first run.
    ///
    /// # Errors
    /// Its folder cannot be made, in words.
    pub fn new(spread: &Spread, timeout: Option<f64>) -> Result<Self, String> {
        let timeout =
            timeout.map_or(Ok(TIMEOUT), Duration::try_from_secs_f64).map_err(|error| format!("timeout: {error}"))?;
        let folder = Folder::new(spread).map_err(|error| format!("the folder of a worker: {error}"))?;
        Ok(Self { folder, timeout, process: None })
    }

    /// Makes the run of these words: its result, and whether the same run gives it again. A process that is lost is begun anew, and asked once more
    /// unless it hung: somebody may have ended it. `None` where `is_enough` said so in between.
    pub fn run(&mut self, words: &[String], is_enough: &dyn Fn() -> bool) -> Option<(RunResult, bool)> {
        let mut why = String::new();
        for _ in 0..2 {
            if is_enough() {
                return None;
            }
            if let Err(error) = self.folder.restore() {
                return Some((RunResult::lost("crashed", format!("the folder of a worker: {error}")), false));
            }
            match self.ask(words, is_enough) {
                Ok(answer) => match RunResult::of_answer(&answer) {
                    Ok(result) => return Some(result),
                    Err(problem) => why = format!("its answer is none: {problem}"),
                },
                Err(Lost::Crashed(how)) => why = how,
                Err(Lost::Hung) => {
                    let problem = format!("no answer for {} s", self.timeout.as_secs_f64());
                    return Some((RunResult::lost("hung", problem), false));
                }
                Err(Lost::Enough) => return None,
            }
            self.end();
        }
        if is_enough() { None } else { Some((RunResult::lost("crashed", why), false)) }
    }

    fn ask(&mut self, words: &[String], is_enough: &dyn Fn() -> bool) -> Result<String, Lost> {
        let mut process = match self.process.take() {
            Some(process) => process,
            None => self.begin().map_err(|error| Lost::Crashed(error.to_string()))?,
        };
        let question: Vec<String> = words.iter().map(|word| escaped(word)).collect();
        let question = question.join("\t") + "\n";
        // Where nobody reads it, there is no answer, either.
        let _ = process.questions.write_all(question.as_bytes());
        let until = Instant::now() + self.timeout;
        let answer = loop {
            let answer = process.answers.recv_timeout(SIGNAL_INTERVAL);
            if !matches!(answer, Err(RecvTimeoutError::Timeout)) {
                break answer;
            }
            if is_enough() {
                end(process, Duration::ZERO);
                return Err(Lost::Enough);
            }
            if Instant::now() >= until {
                break answer;
            }
        };
        match answer {
            Ok(Ok(answer)) => {
                self.process = Some(process);
                Ok(answer)
            }
            Err(RecvTimeoutError::Timeout) => {
                end(process, Duration::ZERO);
                Err(Lost::Hung)
            }
            Ok(Err(_)) | Err(RecvTimeoutError::Disconnected) => Err(Lost::Crashed(end(process, PATIENCE))),
        }
    }

    fn begin(&self) -> std::io::Result<Process> {
        let mut command = Command::new(self.folder.program());
        command.arg("--serve").current_dir(self.folder.path()).stdin(Stdio::piped()).stdout(Stdio::piped());
        let mut child = command.spawn()?;
        let (Some(questions), Some(out)) = (child.stdin.take(), child.stdout.take()) else {
            return Err(std::io::Error::other("it has no streams"));
        };
        let (tell, answers) = channel();
        std::thread::spawn(move || {
            for line in BufReader::new(out).lines() {
                if tell.send(line).is_err() {
                    break;
                }
            }
        });
        Ok(Process { child, questions, answers })
    }

    fn end(&mut self) {
        self.process.take().map(|process| end(process, PATIENCE));
    }
}

impl Drop for Worker {
    fn drop(&mut self) {
        self.end();
    }
}

/// Ends a process, which has a moment to end by itself; how it ended.
fn end(process: Process, patience: Duration) -> String {
    let Process { mut child, questions, .. } = process;
    // Without questions it has nothing more to do.
    drop(questions);
    let until = Instant::now() + patience;
    loop {
        match child.try_wait() {
            Ok(Some(status)) => return format!("its process ended: {status}"),
            Ok(None) if Instant::now() < until => std::thread::sleep(LOOK_INTERVAL),
            _ => break,
        }
    }
    let _ = child.kill();
    child.wait().map_or_else(|error| error.to_string(), |status| format!("its process ended: {status}"))
}

fn escaped(word: &str) -> String {
    word.replace('\\', "\\\\").replace('\t', "\\t").replace('\n', "\\n")
}
