//! A program that is driven: what it says, line by line, and what it is told.

use std::io::{BufRead, BufReader, Read, Write};
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::time::{Duration, Instant};

use arl_wire::Line;

/// How long a line of a program that has ended may still take: its streams may be open in a process of its own making.
const LAST_LINES: Duration = Duration::from_secs(1);

/// A program that runs, and is told what to do by lines.
pub(crate) struct ProgramLink {
    child: Child,
    /// Gone once the program was told to leave.
    orders: Option<ChildStdin>,
    lines: Receiver<Line>,
}

impl ProgramLink {
    /// Starts the program.
    pub(crate) fn start(mut command: Command) -> std::io::Result<Self> {
        command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = command.spawn()?;
        let (sender, lines) = channel();
        let (orders, out, err) = (child.stdin.take(), child.stdout.take(), child.stderr.take());
        read(out, sender.clone(), |line| serde_json::from_str(&line).unwrap_or(Line::Other(line)));
        read(err, sender, Line::Other);
        Ok(Self { child, orders, lines })
    }

    /// The next line that has come.
    pub(crate) fn line(&self) -> Option<Line> {
        self.lines.try_recv().ok()
    }

    /// The same, but none any more from a moment on.
    pub(crate) fn line_before(&self, moment: Instant) -> Option<Line> {
        // What is taken is heard.
        (Instant::now() < moment).then(|| self.line())?
    }

    /// What a program that has ended said at last: all that was on its way.
    pub(crate) fn last_lines(&self) -> impl Iterator<Item = Line> {
        std::iter::from_fn(|| self.lines.recv_timeout(LAST_LINES).ok())
    }

    /// Tells the program something. One that has ended does not hear it, which shows by itself.
    pub(crate) fn order(&mut self, order: &str) {
        if let Some(orders) = &mut self.orders {
            let _ = writeln!(orders, "{order}").and_then(|()| orders.flush());
        }
    }

    /// Lets the program stop the robot and end.
    pub(crate) fn leave(&mut self) {
        self.orders = None;
    }

    /// The exit code, once the program has ended.
    pub(crate) fn ended(&mut self) -> Option<u8> {
        let status = self.child.try_wait().ok().flatten()?;
        Some(u8::try_from(status.code().unwrap_or(1)).unwrap_or(1))
    }
}

impl Drop for ProgramLink {
    fn drop(&mut self) {
        self.orders = None;
        // As a rule it has ended. A robot never goes on without its pendant.
        if self.ended().is_none() {
            let _ = self.child.kill();
            let _ = self.child.wait();
        }
    }
}

/// Passes a stream's lines on until it ends.
fn read(stream: Option<impl Read + Send + 'static>, sender: Sender<Line>, line: fn(String) -> Line) {
    let Some(stream) = stream else { return };
    std::thread::spawn(move || {
        let mut bytes = Vec::new();
        let mut stream = BufReader::new(stream);
        while matches!(stream.read_until(b'\n', &mut bytes), Ok(1..)) {
            let text = String::from_utf8_lossy(&bytes).trim_end_matches(['\n', '\r']).to_owned();
            if sender.send(line(text)).is_err() {
                return;
            }
            bytes.clear();
        }
    });
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    #[test]
    fn no_line_is_lost_where_time_is_over_and_the_last_ones_come_behind_the_end() {
        let mut command = Command::new("sh");
        command.args(["-c", "echo one; echo two; echo three >&2"]);
        let mut link = ProgramLink::start(command).unwrap();
        while link.ended().is_none() {
            std::thread::sleep(Duration::from_millis(1));
        }
        assert_eq!(link.line_before(Instant::now()), None);
        let mut lines: Vec<Line> = link.last_lines().collect();
        lines.sort_by_key(|line| format!("{line:?}"));
        assert_eq!(lines, ["one", "three", "two"].map(|text| Line::Other(text.into())));
    }
}
