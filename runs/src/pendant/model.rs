//! What the screen knows.

use std::collections::VecDeque;

use super::sources::Sources;
use arl_wire::{Hello, Inside, Line, State};

/// The most lines of the log that are kept.
const LOG: usize = 500;

/// The time after which an order has been carried out or refused, in s.
const ORDER_S: f64 = 0.25;
/// The most lines that are printed again once the screen is gone.
const MOST_LASTING: usize = 10_000;

/// The importance of a line of the log.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Weight {
    Message,
    Warning,
    Alarm,
}

/// What the screen knows.
#[derive(Default)]
pub(super) struct PendantModel {
    pub(super) hello: Hello,
    pub(super) state: State,
    pub(super) sources: Sources,
    /// Messages, warnings and alarms, the newest last.
    pub(super) log: VecDeque<(Weight, String)>,
    /// Lines that disappear with the screen and that the user may want to read or copy: alarms, what was written to the
    /// standard error, and warnings of subscribers.
    pub(super) lasting: Vec<String>,
    /// The channel that is shown, from 0.
    pub(super) shown: usize,
    /// The text being typed, if any.
    pub(super) typed: Option<String>,
    /// The override that was requested last, until a state reports it: keys come faster than states.
    pub(super) asked_override: Option<f64>,
    /// The controller time of that request.
    asked_at: f64,
    /// The inside of the program while the user looks into it; empty at first.
    pub(super) inside: Option<Inside>,
    /// How many of its lines are scrolled out of sight.
    pub(super) scrolled: usize,
    /// Whether the program was told to leave.
    pub(super) leaving: bool,
}

impl PendantModel {
    /// A program of which only the texts are known yet.
    pub(super) fn new(sources: Sources) -> Self {
        Self { sources, ..Self::default() }
    }

    /// Takes a line of the program.
    pub(super) fn receive(&mut self, line: Line) {
        match line {
            Line::Hello(hello) => self.hello = hello,
            Line::State(state) => {
                let arrived = self.asked_override == Some(state.speed_override);
                if arrived || state.time > self.asked_at + ORDER_S {
                    self.asked_override = None;
                }
                self.state = state;
            }
            // A line of another channel, or one after the order to end, is late.
            Line::Inside(inside) => {
                if self.inside.is_some() && inside.channel == self.shown + 1 {
                    self.scrolled = self.scrolled.min(inside.variable_lines().saturating_sub(1));
                    self.inside = Some(inside);
                }
            }
            Line::Message(message) => {
                for text in message.text.trim_end_matches('\n').split('\n') {
                    self.note(Weight::Message, format!("{:9.3}  {text}", message.time));
                }
            }
            Line::Warning(text) => self.note(Weight::Warning, format!("warning: {text}")),
            Line::Alarm(alarm) => self.note_lasting(Weight::Alarm, alarm.text),
            Line::Refused(refused) => self.note(Weight::Warning, format!("{}: {}", refused.order, refused.why)),
            Line::Report(_) | Line::Cycle(_) | Line::Contact(_) | Line::Placing(_) | Line::Ended(_) => {}
            Line::Other(text) => self.note_lasting(Weight::Warning, text),
        }
    }

    /// Adds a warning of a subscriber.
    pub(super) fn warn(&mut self, text: &str) {
        self.note_lasting(Weight::Warning, format!("warning: {text}"));
    }

    /// Adds a line to the log that is printed again once the screen is gone.
    fn note_lasting(&mut self, weight: Weight, text: String) {
        if self.lasting.len() < MOST_LASTING {
            self.lasting.push(text.clone());
        }
        self.note(weight, text);
    }

    /// The present override, or the requested one.
    pub(super) fn speed_override(&self) -> f64 {
        self.asked_override.unwrap_or(self.state.speed_override)
    }

    /// Notes a requested override.
    pub(super) fn ask_for_override(&mut self, percent: f64) {
        self.asked_override = Some(percent);
        self.asked_at = self.state.time;
    }

    fn note(&mut self, weight: Weight, text: String) {
        if self.log.len() == LOG {
            self.log.pop_front();
        }
        self.log.push_back((weight, text));
    }

    /// Shows the next channel.
    pub(super) fn show_next(&mut self) {
        self.shown = (self.shown + 1) % self.state.channels.len().max(1);
    }
}
