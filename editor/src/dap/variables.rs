//! What the editor shows of a halted program: frames, scopes, variables with their parts.

use super::evaluate::{Root, Variable, part_type};
use super::literal::{Literal, Part};
use super::program::Key;
use arl_lang::catalog::Family;
use serde_json::{Value, json};

/// Something that has parts, under the number by which the editor requests it.
#[derive(Clone, PartialEq, Debug)]
pub(super) enum Container {
    /// The locals of a frame.
    Locals(usize),
    /// The global variables of the frame's program, file by file.
    Globals(usize),
    /// The global variables of one file.
    File(usize, String),
    /// The system variables.
    System(usize),
    /// Inputs and outputs.
    Signals,
    /// One kind of signals.
    Kind(&'static str),
    /// The axes and the TCP of the frame's channel.
    Robot(usize),
    /// A value of a variable, as seen from a frame.
    Value { frame: usize, target: Target, ty: String, value: Literal, path: Vec<Part> },
}

/// A variable that can be set.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) enum Target {
    /// A local, by its name.
    Local(String),
    /// A global variable of a file.
    Global(String, String),
    /// A system variable, by its name without `$`.
    System(String),
    /// Nothing that can be set.
    Nothing,
}

/// A frame that the editor knows.
#[derive(Clone, PartialEq, Debug)]
pub(super) struct Frame {
    pub(super) channel: usize,
    pub(super) program: Key,
    /// Its number in the program; 0 where none runs.
    pub(super) id: u64,
    pub(super) name: String,
    pub(super) file: String,
    pub(super) line: u32,
    /// Whether it is the action of an event.
    pub(super) is_action: bool,
}

/// What was shown since the program was halted.
#[derive(Default, Debug)]
pub(super) struct Shown {
    frames: Vec<Frame>,
    containers: Vec<Container>,
}

impl Shown {
    /// The number of a frame.
    pub(super) fn frame(&mut self, frame: Frame) -> usize {
        match self.frames.iter().position(|known| known.channel == frame.channel && known.id == frame.id) {
            Some(at) => at + 1,
            None => {
                self.frames.push(frame);
                self.frames.len()
            }
        }
    }

    /// The frame with this number.
    pub(super) fn frame_of(&self, number: usize) -> Option<&Frame> {
        self.frames.get(number.checked_sub(1)?)
    }

    /// The number of something with parts.
    pub(super) fn container(&mut self, container: Container) -> usize {
        match self.containers.iter().position(|known| *known == container) {
            Some(at) => at + 1,
            None => {
                self.containers.push(container);
                self.containers.len()
            }
        }
    }

    /// The container with this number.
    pub(super) fn container_of(&self, number: usize) -> Option<&Container> {
        self.containers.get(number.checked_sub(1)?)
    }

    /// A value as the editor shows it.
    pub(super) fn value(
        &mut self,
        name: &str,
        frame: usize,
        target: Target,
        variable: &Variable,
        path: Vec<Part>,
    ) -> Value {
        let Variable { ty, value } = variable;
        let (named, indexed) = match value {
            Literal::Plain(_) => (0, 0),
            Literal::Named(parts) => (parts.len(), 0),
            Literal::Listed(parts) => (0, parts.len()),
        };
        let shown = value.text();
        let reference = match named + indexed {
            0 => 0,
            _ => {
                let (ty, value) = (ty.clone(), value.clone());
                self.container(Container::Value { frame, target: target.clone(), ty, value, path: path.clone() })
            }
        };
        let evaluate = expression(&target, &path);
        let mut shown = json!({"name": name, "value": shown, "type": ty, "variablesReference": reference});
        if let Some(evaluate) = evaluate {
            shown["evaluateName"] = json!(evaluate);
        }
        if indexed > 0 {
            shown["indexedVariables"] = json!(indexed);
        }
        shown
    }

    /// The parts of a value.
    pub(super) fn parts(&mut self, container: &Container, family: Family) -> Vec<Value> {
        let Container::Value { frame, target, ty, value, path } = container else { return Vec::new() };
        let mut shown = Vec::new();
        for (part, literal) in value.parts() {
            let name = match &part {
                Part::Named(name) => name.clone(),
                Part::At(at) => format!("[{at}]"),
            };
            let inner = part_type(ty, &part, family).unwrap_or_default();
            let path = [path.as_slice(), &[part]].concat();
            let variable = Variable { ty: inner, value: literal.clone() };
            shown.push(self.value(&name, *frame, target.clone(), &variable, path));
        }
        shown
    }
}

/// The expression that names a part of a variable.
fn expression(target: &Target, path: &[Part]) -> Option<String> {
    let mut text = match target {
        Target::Local(name) => name.clone(),
        Target::Global(_, name) => name.clone(),
        Target::System(name) => format!("${name}"),
        Target::Nothing => return None,
    };
    for part in path {
        match part {
            Part::Named(name) => text += &format!(".{name}"),
            Part::At(at) => text += &format!("[{at}]"),
        }
    }
    Some(text)
}

impl Target {
    /// The variable that an expression names; a local variable goes before a global one.
    pub(super) fn of(
        root: &Root,
        locals: &[String],
        file_of: impl Fn(Option<&str>, &str) -> Option<String>,
    ) -> Option<Self> {
        match root {
            Root::System(name) => Some(Self::System(name.clone())),
            Root::Variable(None, name) if locals.iter().any(|known| known == name) => Some(Self::Local(name.clone())),
            Root::Variable(module, name) => Some(Self::Global(file_of(module.as_deref(), name)?, name.clone())),
        }
    }
}
