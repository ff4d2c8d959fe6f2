//! A program that is driven: the lines that it sends, and the orders that it is given.

use std::io::{BufRead, BufReader, Read, Write};
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::time::{Duration, Instant};

use arl_terminal::exit::Exit;
use arl_terminal::interrupt::{self, Left};
use arl_wire::Line;

/// How long to wait for another line of a program that has ended: a process that it started may keep its streams open.
const LAST_LINES: Duration = Duration::from_secs(1);

/// A running program that takes orders, a line each.
pub(crate) struct ProgramLink {
    child: Child,
    /// `None` once the program was told to leave.
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

    /// Passes interrupts on to the program.
    pub(crate) fn gets(&self, interrupts: &Left) {
        interrupts.pass_on_to(&self.child);
    }

    /// The next line that has arrived.
    pub(crate) fn line(&self) -> Option<Line> {
        self.lines.try_recv().ok()
    }

    /// The next line that has arrived; `None` from `moment` on.
    pub(crate) fn line_before(&self, moment: Instant) -> Option<Line> {
        // The time is checked first: a line that is taken is not lost.
        (Instant::now() < moment).then(|| self.line())?
    }

    /// The last lines of a program that has ended: all that were still on their way.
    pub(crate) fn last_lines(&self) -> impl Iterator<Item = Line> {
        std::iter::from_fn(|| self.lines.recv_timeout(LAST_LINES).ok())
    }

    /// Sends the program an order. A program that has ended does not get it, which shows by itself.
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
        // An interrupt may come before the program watches for it.
        let killed = if interrupt::was_pressed() { Exit::INTERRUPTED.0 } else { 1 };
        Some(status.code().map_or(killed, |code| u8::try_from(code).unwrap_or(1)))
    }
}

impl Drop for ProgramLink {
    fn drop(&mut self) {
        self.orders = None;
        // As a rule the program has ended. A robot never continues without its pendant.
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
