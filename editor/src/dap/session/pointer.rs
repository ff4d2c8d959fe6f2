//! The program pointer, set to another line by hand.

use super::{Answer, Halt, Session};
use crate::dap::program::same_file;
use crate::dap::variables::Frame;
use serde_json::{Value, json};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// The request to the program for that.
pub(super) const REQUEST: &str = "pointer";

/// The lines that the editor requested, each by its number.
#[derive(Default, Debug)]
pub(super) struct Targets(Vec<(PathBuf, u32)>);

impl Targets {
    fn number(&mut self, path: &Path, line: u32) -> usize {
        let found = self.0.iter().position(|(known, at)| known == path && *at == line);
        found.unwrap_or_else(|| {
            self.0.push((path.to_owned(), line));
            self.0.len() - 1
        })
    }

    fn of(&self, number: usize) -> Option<(PathBuf, u32)> {
        self.0.get(number).cloned()
    }
}

impl Session {
    /// The statement that the pointer would be set to: that of a line, or the next one below, in a function that runs.
    pub(super) fn goto_targets(&mut self, arguments: &Value) -> Answer {
        let path = arguments.pointer("/source/path").and_then(Value::as_str).ok_or("the source has no path")?;
        let from = arguments.get("line").and_then(Value::as_u64).unwrap_or_default() as u32;
        self.standing()?;
        let programs = &self.launched.as_ref().ok_or("nothing was launched")?.programs;
        let functions = programs.functions(path.as_ref());
        let line = functions.iter().filter_map(|lines| lines.range(from..).next()).min().copied();
        let line = line.ok_or("there is no statement here or below")?;
        if !self.running_lines(path.as_ref())?.contains(&line) {
            return Err(not_running(line));
        }
        let id = self.targets.number(path.as_ref(), line);
        Ok(json!({"targets": [{"id": id, "label": format!("line {line}"), "line": line}]}))
    }

    /// The lines with statements of the functions of a file that run, in whatever channel.
    fn running_lines(&mut self, path: &Path) -> Result<BTreeSet<u32>, String> {
        let mut lines = BTreeSet::new();
        for channel in 0..self.channels.len() {
            let frames = self.frames(channel)?;
            let programs = &self.launched.as_ref().ok_or("nothing was launched")?.programs;
            for frame in frames {
                let file = programs.path(&frame.program, &frame.file);
                if file.is_some_and(|file| same_file(&file, path)) {
                    lines.extend(programs.lines_of(&frame.program, &frame.file, &frame.name));
                }
            }
        }
        Ok(lines)
    }

    /// Sets the pointer of a channel. The program is halted, and continues there.
    pub(super) fn set_pointer(&mut self, arguments: &Value) -> Answer {
        let number = arguments.get("targetId").and_then(Value::as_u64).unwrap_or(u64::MAX) as usize;
        let (path, line) = self.targets.of(number).ok_or("there is no such target")?;
        let channel = self.channel_of(arguments)?;
        let halt = self.standing()?;
        if halt.why == "alarm" {
            return Err("the program ends with this alarm: step back first".into());
        }
        let frame = self.frame_with(channel, &path, line)?;
        self.edit(REQUEST, &[&channel.to_string(), &frame.id.to_string(), &line.to_string()])?;
        self.shown = Default::default();
        if let Some(halt) = &mut self.halt {
            (halt.why, halt.channel, halt.text) = ("goto".into(), channel, String::new());
        }
        Ok(Value::Null)
    }

    /// Where the programs are halted.
    pub(super) fn standing(&self) -> Result<&Halt, String> {
        let why = if self.process.is_some() { "the program is running: pause it first" } else { "no program runs" };
        self.halt.as_ref().ok_or_else(|| why.into())
    }

    /// The running function that has a line, with nothing but functions that it has called on top.
    fn frame_with(&mut self, channel: usize, path: &Path, line: u32) -> Result<Frame, String> {
        for frame in self.frames(channel)? {
            if frame.is_action {
                return Err(format!(
                    "{} runs: the pointer of the program below it cannot be set meanwhile",
                    frame.name
                ));
            }
            let programs = &self.launched.as_ref().ok_or("nothing was launched")?.programs;
            let file = programs.path(&frame.program, &frame.file);
            if file.is_some_and(|file| same_file(&file, path))
                && programs.lines_of(&frame.program, &frame.file, &frame.name).contains(&line)
            {
                return Ok(frame);
            }
        }
        Err(not_running(line))
    }
}

fn not_running(line: u32) -> String {
    format!("line {line} is not in a function that runs: the program pointer stays within those on the call stack")
}
