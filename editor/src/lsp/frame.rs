//! The workpiece frame that a pose is meant in, according to the motions that it is the target of.

use super::programs::Program;
use arl_lang::catalog::{Base, ParamType, Struct};
use arl2rs::diagnostics::{FileId, Location};
use arl2rs::index::{Argument, Callee, Meaning};
use std::collections::{BTreeSet, HashMap, HashSet};

/// The parameter that names the frame of a target, and what replaces it where it is missing.
const FRAME: &str = "w";
const STANDS_IN: &str = "$DFWOBJ";

/// The most lines that are named for a frame.
const MOST_LINES: usize = 3;

/// A sentence about the frames of a pose; empty where no motion goes to it.
pub(super) fn frames(program: &Program, meaning: Meaning) -> String {
    let index = program.index();
    let named_at: HashSet<Location> = index.with(meaning).map(|mention| mention.at).collect();
    let files: BTreeSet<FileId> = named_at.iter().map(|at| at.file).collect();
    let mut found: Vec<(&str, Vec<u32>)> = Vec::new();
    for file in files {
        let frames = index.arguments(file).filter(|one| parameter(one) == Some(FRAME));
        let frames: HashMap<Location, &Argument> = frames.map(|one| (one.of, one)).collect();
        for target in index.arguments(file).filter(|one| named_at.contains(&one.at) && is_target(one)) {
            let frame = frames.get(&target.of).map_or(STANDS_IN, |frame| program.at(frame.at).trim());
            let line = program.line(target.at);
            match found.iter_mut().find(|(known, _)| *known == frame) {
                Some((_, lines)) => lines.push(line),
                None => found.push((frame, vec![line])),
            }
        }
    }
    let shown: Vec<String> = found.iter().map(|(frame, lines)| format!("`{frame}` ({})", named(lines))).collect();
    if shown.is_empty() { String::new() } else { format!("A target in the frame {}.", shown.join(", ")) }
}

fn named(lines: &[u32]) -> String {
    let word = if lines.len() == 1 { "line" } else { "lines" };
    let more = if lines.len() > MOST_LINES { ", .." } else { "" };
    let first: Vec<String> = lines.iter().take(MOST_LINES).map(u32::to_string).collect();
    format!("{word} {}{more}", first.join(", "))
}

/// The name of the parameter that an argument of something built in goes to.
fn parameter(argument: &Argument) -> Option<&'static str> {
    match argument.callee {
        Callee::Builtin(entry) => entry.params.get(argument.parameter).map(|param| param.name),
        Callee::Function(_) => None,
    }
}

/// Whether it is a pose of something that takes a frame with it.
fn is_target(argument: &Argument) -> bool {
    let Callee::Builtin(entry) = argument.callee else { return false };
    let is_pose = |ty: &ParamType| *ty == ParamType::One(Base::Struct(Struct::Pose));
    entry.params.get(argument.parameter).is_some_and(|param| is_pose(&param.ty))
        && entry.params.iter().any(|param| param.name == FRAME)
}
