//! The result of a run: a row of the table.

use super::collision_watch::Contacts;
use crate::parameters::Parameters;
use arl_wire::Contact;
use serde::{Deserialize, Serialize};

/// A row of the results.
#[derive(Clone, PartialEq, Serialize, Debug)]
pub struct Row {
    /// The number of the run, from 1.
    pub run: usize,
    /// Its parameters.
    pub parameters: Parameters,
    /// Its result.
    #[serde(flatten)]
    pub result: RunResult,
}

/// The result of a run.
#[derive(Clone, PartialEq, Default, Serialize, Deserialize, Debug)]
pub struct RunResult {
    /// `ended`, `alarm`, `time_over`, `stuck`; `refused` where it could not begin, `crashed` and `hung` where its
    /// process was lost.
    pub outcome: String,
    /// The exit code that a run by itself would have.
    pub code: Option<u8>,
    /// How long it took, in s of the robot's time.
    pub cycle_time: Option<f64>,
    /// How long the first robot moved, in s.
    pub moving: Option<f64>,
    /// How long it was at rest, in s.
    pub standing: Option<f64>,
    /// How many motions it executed.
    pub motions: Option<u64>,
    /// The length of its TCP's path, in mm.
    pub way: Option<f64>,
    /// The alarms.
    pub alarms: Vec<Alarm>,
    /// What touched, or came too near to each other, if that was looked for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub collisions: Option<Vec<Collision>>,
    /// What the program printed, a line each.
    pub output: Vec<String>,
    /// Why it could not begin, or was lost.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub problem: Option<String>,
}

/// An alarm of a run.
#[derive(Clone, PartialEq, Default, Serialize, Deserialize, Debug)]
pub struct Alarm {
    /// Its number.
    pub number: u32,
    /// Its text.
    pub text: String,
    /// The file of the program.
    pub file: String,
    /// The line, from 1; 0 if it concerns no line.
    pub line: u32,
    /// The channel whose program it is.
    pub channel: String,
}

/// Two bodies that touch for the first time, or their closest approach.
#[derive(Clone, PartialEq, Default, Serialize, Deserialize, Debug)]
pub struct Collision {
    /// When, in s of the robot's time.
    pub time: f64,
    /// The file of the motion that brought them together.
    pub file: String,
    /// Its line, from 1.
    pub line: u32,
    /// Their names.
    pub bodies: [String; 2],
    /// Their distance, in mm; 0: they touch.
    pub distance: f64,
}

impl From<Contact> for Collision {
    fn from(contact: Contact) -> Self {
        let Contact { time, file, line, one, other, distance } = contact;
        Self { time, file, line, bodies: [one, other], distance }
    }
}

/// The answer of a compiled program.
#[derive(Deserialize)]
struct Answer {
    summary: Option<Summary>,
    #[serde(default)]
    said: Vec<OutputLine>,
    refused: Option<String>,
}

#[derive(Deserialize)]
struct Summary {
    outcome: String,
    code: Option<u8>,
    cycle_time: f64,
    moving: Option<f64>,
    standing: Option<f64>,
    motions: Option<u64>,
    way: Option<f64>,
    alarms: Vec<Alarm>,
    real_time: bool,
}

#[derive(Deserialize)]
struct OutputLine {
    message: Option<Message>,
}

#[derive(Deserialize)]
struct Message {
    text: String,
    hmi: bool,
    console: bool,
}

impl RunResult {
    /// The result in a program's answer, with what was found in its run if that was looked for, and whether the same
    /// run gives it again.
    ///
    /// # Errors
    /// This is not an answer, or the run was not received to its end.
    pub(super) fn of_answer(line: &str, contacts: Contacts) -> Result<(Self, bool), String> {
        let answer: Answer = serde_json::from_str(line).map_err(|error| error.to_string())?;
        let Some(Summary { outcome, code, cycle_time, moving, standing, motions, way, alarms, real_time }) =
            answer.summary
        else {
            // The reason may be something outside, such as an io island that is switched off.
            return Ok((Self::lost("refused", answer.refused.unwrap_or_default()), false));
        };
        let collisions = match contacts {
            Contacts::All(contacts) => Some(contacts.into_iter().map(Collision::from).collect()),
            Contacts::Unasked | Contacts::Unknown => None,
            Contacts::Broken => return Err("its run was not observed to the end".into()),
        };
        let messages = answer.said.into_iter().filter_map(|line| line.message);
        let shown = messages.filter(|message| message.hmi || message.console);
        let lines = |message: Message| -> Vec<String> {
            let text = message.text.strip_suffix('\n').unwrap_or(&message.text);
            text.split('\n').map(str::to_owned).collect()
        };
        let output = shown.flat_map(lines).collect();
        let cycle_time = Some(cycle_time);
        let result = Self {
            outcome,
            code,
            cycle_time,
            moving,
            standing,
            motions,
            way,
            alarms,
            collisions,
            output,
            problem: None,
        };
        Ok((result, !real_time))
    }

    /// A run that could not begin, or was lost.
    pub fn lost(outcome: &str, problem: String) -> Self {
        Self { outcome: outcome.into(), problem: Some(problem), ..Self::default() }
    }

    /// Whether it came to an end of its own.
    pub(super) fn is_whole(&self) -> bool {
        self.problem.is_none()
    }
}
