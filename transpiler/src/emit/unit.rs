//! Data shared by all functions of one emission.

use super::marks::{Marks, clean};
use super::names::Names;
use super::slots::Slots;
use super::templates::Templates;
use super::{EmitOptions, Sizes, parts};
use crate::effects;
use crate::hir::{ModuleId, Program};
use arl_lang::catalog::Family;
use arl_lang::span::{LineIndex, Span};

/// Data shared by all functions of one emission.
pub(super) struct Unit<'p> {
    pub(super) program: &'p Program,
    pub(super) names: Names,
    pub(super) marks: Marks,
    /// The positions of the lines of each module.
    pub(super) lines: Vec<LineIndex>,
    /// For each function, whether it moves the program pointer.
    pub(super) movers: Vec<bool>,
    /// For each function, whether it is called.
    pub(super) reached: Vec<bool>,
    /// For each function, whether it is compiled separately.
    pub(super) apart: Vec<bool>,
    pub(super) sizes: Sizes,
    /// Whether global variables keep their names.
    pub(super) named: bool,
    /// The variables stored in arrays.
    pub(super) slots: Slots,
    /// The calls that become functions of their own.
    pub(super) templates: Templates<'p>,
}

impl<'p> Unit<'p> {
    pub(super) fn new(program: &'p Program, &EmitOptions { sizes, named, .. }: &EmitOptions) -> Self {
        let lines = program.modules.iter().map(|module| LineIndex::new(&module.source)).collect();
        let (movers, reached) = (effects::pointer_movers(program), effects::reached(program));
        let mut names = Names::new(program);
        let slots = Slots::new(program, &names, sizes);
        let apart = parts::apart(program, sizes);
        let templates = match parts::is_large(program, sizes) {
            true => Templates::new(program, &mut names, &slots, sizes),
            false => Templates::default(),
        };
        Self { program, names, slots, templates, marks: Marks::default(), lines, movers, reached, apart, sizes, named }
    }

    pub(super) fn family(&self) -> Family {
        self.program.family
    }

    /// The line of a position in a module.
    pub(super) fn line(&self, module: ModuleId, span: Span) -> u32 {
        self.lines.get(module.0 as usize).map_or(0, |lines| lines.line(span.start))
    }

    /// The lines of a module that a span touches, each with its number; long texts are cut.
    pub(super) fn text(&self, module: ModuleId, span: Span) -> String {
        const MOST: usize = 4;
        let (Some(lines), Some(source)) = (
            self.lines.get(module.0 as usize),
            self.program.modules.get(module.0 as usize).map(|module| module.source.as_str()),
        ) else {
            return String::new();
        };
        let (first, last) = (lines.line(span.start), lines.line(span.end.max(span.start + 1) - 1));
        let mut out = Vec::new();
        for line in first..=last {
            let text = lines.line_span(source, line).map_or("", |span| span.text(source));
            out.push(format!("{line}: {}", clean(text)));
            if out.len() == MOST && line < last {
                out.push("...".to_owned());
                break;
            }
        }
        out.join("\n")
    }
}
