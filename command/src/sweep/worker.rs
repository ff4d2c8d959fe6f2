//! A process of the program that makes one run after another, in a folder of its own.

use super::collision_watch::{CollisionWatch, Contacts};
use super::folder::{Folder, Spread};
use super::result::RunResult;
use arl_terminal::port::Secret;
use std::io::{BufRead, BufReader, Write};
use std::process::{Child, ChildStdin, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::time::{Duration, Instant};

/// The default time on the computer's clock after which a run is given up: s.
pub const TIMEOUT: f64 = 600.0;

/// How long a process may take to end by itself.
const PATIENCE: Duration = Duration::from_secs(1);
/// How often to check whether the user wants to stop.
const SIGNAL_INTERVAL: Duration = Duration::from_millis(50);
/// How often to check whether a process has ended.
const LOOK_INTERVAL: Duration = Duration::from_millis(1);

/// A process that makes runs.
#[derive(Debug)]
pub struct Worker {
    folder: Folder,
    timeout: Duration,
    process: Option<Process>,
    /// The secret that its process sends when it connects to the listener.
    secret: Secret,
    watch: Option<CollisionWatch>,
}

#[derive(Debug)]
struct Process {
    child: Child,
    questions: ChildStdin,
    answers: Receiver<std::io::Result<String>>,
}

/// Why there is no answer.
enum Lost {
    /// The process has ended, in this way.
    Crashed(String),
    /// It takes too long.
    Hung,
    /// The answer is no longer wanted.
    Enough,
}

impl Worker {
    /// A worker for a bundle on the disk; its process begins with the first run. With a clearance, in mm, it looks for
    /// collisions.
    ///
    /// # Errors
    /// The reason why its folder cannot be made.
    pub fn new(spread: &Spread, timeout: Option<f64>, clearance: Option<f64>) -> Result<Self, String> {
        let timeout =
            Duration::try_from_secs_f64(timeout.unwrap_or(TIMEOUT)).map_err(|error| format!("timeout: {error}"))?;
        let folder = Folder::new(spread).map_err(|error| format!("cannot prepare the folder of a worker: {error}"))?;
        let secret = Secret::new().map_err(|failure| failure.to_string())?;
        let watch = clearance.map(|clearance| CollisionWatch::new(clearance, folder.path(), secret.clone()));
        Ok(Self { folder, timeout, process: None, secret, watch })
    }

    /// Makes the run of these words; returns its result, and whether the same run gives it again. A lost process is
    /// started again, and asked once more unless it hung: it may have been ended from outside. `None` if `is_enough`
    /// became true in between.
    pub fn run(&mut self, words: &[String], is_enough: &dyn Fn() -> bool) -> Option<(RunResult, bool)> {
        let mut why = String::new();
        for _ in 0..2 {
            if is_enough() {
                return None;
            }
            if let Err(error) = self.folder.restore() {
                return Some((
                    RunResult::lost("crashed", format!("cannot prepare the folder of a worker: {error}")),
                    false,
                ));
            }
            let (answer, contacts) = match self.answer(words, is_enough) {
                Ok(answered) => answered,
                Err(problem) => return Some((RunResult::lost("refused", problem), false)),
            };
            match answer {
                Ok(answer) => match RunResult::of_answer(&answer, contacts) {
                    Ok(result) => return Some(result),
                    Err(problem) => why = format!("its answer is not valid: {problem}"),
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

    /// The program's answer, and what touched in its run, if that is looked for; or why it cannot be looked for.
    fn answer(
        &mut self,
        words: &[String],
        is_enough: &dyn Fn() -> bool,
    ) -> Result<(Result<String, Lost>, Contacts), String> {
        let Some(mut watch) = self.watch.take() else {
            return Ok((self.ask(words, is_enough), Contacts::Unasked));
        };
        let looked = watch.look(words, |words| self.ask(&words, is_enough));
        self.watch = Some(watch);
        looked
    }

    fn ask(&mut self, words: &[String], is_enough: &dyn Fn() -> bool) -> Result<String, Lost> {
        let mut process = match self.process.take() {
            Some(process) => process,
            None => self.begin().map_err(|error| Lost::Crashed(error.to_string()))?,
        };
        let question: Vec<String> = words.iter().map(|word| escaped(word)).collect();
        let question = question.join("\t") + "\n";
        // If nothing reads the question, there is no answer, either.
        let _ = process.questions.write_all(question.as_bytes());
        let begun = Instant::now();
        let answer = loop {
            let answer =
                process.answers.recv_timeout(SIGNAL_INTERVAL.min(self.timeout.saturating_sub(begun.elapsed())));
            if !matches!(answer, Err(RecvTimeoutError::Timeout)) {
                break answer;
            }
            if is_enough() {
                end(process, Duration::ZERO);
                return Err(Lost::Enough);
            }
            if begun.elapsed() >= self.timeout {
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
        let mut command = self.folder.program()?;
        command.arg("--serve").current_dir(self.folder.path()).stdin(Stdio::piped()).stdout(Stdio::piped());
        self.secret.hand_over(&mut command);
        let mut child = command.spawn()?;
        let (Some(questions), Some(out)) = (child.stdin.take(), child.stdout.take()) else {
            return Err(std::io::Error::other("its standard input or output is missing"));
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

/// Ends a process, which has a moment to end by itself; returns how it ended.
fn end(process: Process, patience: Duration) -> String {
    let Process { mut child, questions, .. } = process;
    // When its input is closed, it has nothing more to do.
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
    word.replace('\\', "\\\\").replace('\t', "\\t").replace('\n', "\\n").replace('\r', "\\r")
}

#[cfg(test)]
#[cfg(unix)]
mod tests {
    use super::*;

    const ENDED: &str =
        r#"{"summary":{"outcome":"ended","code":0,"cycle_time":1.5,"alarms":[],"real_time":false},"said":[]}"#;

    /// A worker whose program is a script of the shell.
    fn worker(script: &str, timeout: f64) -> Worker {
        let script = format!("#!/bin/sh\n{}\n", script.replace("ENDED", &format!("echo '{ENDED}'")));
        let files = vec![("program".into(), script.into_bytes()), ("script/a.arl".into(), b"a".to_vec())];
        Worker::new(&Spread::of(files).unwrap(), Some(timeout), None).unwrap()
    }

    fn ran(worker: &mut Worker) -> RunResult {
        worker.run(&["--seed".into(), "1".into()], &|| false).unwrap().0
    }

    #[test]
    fn a_process_makes_run_after_run() {
        let mut worker = worker("while read -r line; do ENDED; done", 60.0);
        assert_eq!((ran(&mut worker).outcome, ran(&mut worker).cycle_time), ("ended".into(), Some(1.5)));
    }

    #[test]
    fn a_process_that_is_lost_is_asked_again() {
        let mut worker = worker("read -r line; [ -e ../again ] || { touch ../again; exit 7; }; ENDED", 60.0);
        assert_eq!(ran(&mut worker).outcome, "ended");
    }

    #[test]
    fn a_run_that_loses_its_process_again_and_again_has_crashed() {
        let result = ran(&mut worker("read -r line; exit 7", 60.0));
        assert_eq!(result.outcome, "crashed");
        assert_eq!(result.problem.as_deref(), Some("its process ended: exit status: 7"));
        let result = ran(&mut worker("read -r line; echo nothing; read -r line", 60.0));
        assert!(result.problem.is_some_and(|why| why.starts_with("its answer is not valid")), "it says nothing of use");
    }

    #[test]
    fn a_run_that_takes_too_long_is_given_up_and_the_next_one_is_made() {
        let mut worker =
            worker("while read -r line; do [ -e ../again ] || { touch ../again; exec sleep 1000; }; ENDED; done", 0.2);
        let result = ran(&mut worker);
        assert_eq!((&*result.outcome, result.problem.as_deref()), ("hung", Some("no answer for 0.2 s")));
        worker.timeout = Duration::from_secs(60);
        assert_eq!(ran(&mut worker).outcome, "ended");
    }

    #[test]
    fn nobody_waits_for_what_nobody_wants() {
        let mut worker = worker("exec sleep 1000", 1000.0);
        assert_eq!(worker.run(&[], &|| true), None);
    }

    #[test]
    fn each_run_finds_the_files_as_they_were() {
        let script = "[ ! -e ../begun ] || exit 7; touch ../begun; while read -r line; do [ ! -e left ] || exit 8; \
                      [ \"$(cat script/a.arl)\" = a ] || exit 9; touch left; echo b > script/a.arl; ENDED; done";
        let mut worker = worker(script, 60.0);
        assert_eq!((ran(&mut worker).outcome, ran(&mut worker).outcome), ("ended".into(), "ended".into()));
    }
}
