//! Diagnostics for people, with the source below them.

use super::{Position, severity_word};
use crate::diagnostics::{Diagnostic, Files, Label, Location, Severity, SourceFile};
use annotate_snippets::{Annotation, AnnotationKind, Group, Level, Origin, Patch, Renderer, Snippet};
use arl_lang::span::Span;
use std::ops::Range;

/// Lines longer than this (in bytes) are not shown.
const LONGEST_LINE: usize = 2000;
/// The number of lines shown around a position.
const AROUND: u32 = 2;
/// Positions at most this many lines apart are shown together.
const NEAR: u32 = 200;

/// Several lines in the style of rustc, with a line end; `styled` adds terminal colours.
pub fn human(diagnostic: &Diagnostic, files: &Files, styled: bool) -> String {
    let renderer = if styled { Renderer::styled() } else { Renderer::plain() };
    let level = match diagnostic.severity {
        Severity::Error => Level::ERROR,
        Severity::Warning => Level::WARNING,
    };
    let title = level.with_name(severity_word(diagnostic.severity)).primary_title(diagnostic.message.as_str());
    let mut main = Group::with_title(title.id(diagnostic.code.to_string()));
    let (near, far): (Vec<&Label>, Vec<&Label>) =
        diagnostic.labels.iter().partition(|label| is_near(label.at, diagnostic.primary.at, files));
    main = place(main, &diagnostic.primary, AnnotationKind::Primary, &near, files);
    for label in far {
        main = place(main, label, AnnotationKind::Context, &[], files);
    }
    let fix = diagnostic.fix.as_ref().and_then(|fix| {
        let source = files.get(fix.at.file)?;
        let window = Window::around(source, &[fix.at.span])?;
        let patch = Patch::new(window.range(fix.at.span), fix.text.as_str());
        Some(Snippet::source(window.text).line_start(window.line).path(source.name.as_str()).patch(patch))
    });
    let mut groups = Vec::new();
    match (fix, &diagnostic.help) {
        (Some(patch), help) => {
            let words = help.as_deref().unwrap_or("write instead");
            groups.push(main);
            groups.push(Group::with_title(Level::HELP.secondary_title(words)).element(patch));
        }
        (None, Some(help)) => groups.push(main.element(Level::HELP.message(help.as_str()))),
        (None, None) => groups.push(main),
    }
    renderer.render(&groups) + "\n"
}

/// Whether two positions are shown together in one piece of source.
fn is_near(one: Location, other: Location, files: &Files) -> bool {
    one.file == other.file && files.line(one).abs_diff(files.line(other)) <= NEAR
}

/// Adds a position and the labels near it.
fn place<'a>(
    group: Group<'a>,
    main: &'a Label,
    kind: AnnotationKind,
    near: &[&'a Label],
    files: &'a Files,
) -> Group<'a> {
    let Some(file) = files.get(main.at.file) else { return group };
    let spans: Vec<Span> = std::iter::once(main.at.span).chain(near.iter().map(|label| label.at.span)).collect();
    let Some(window) = Window::around(file, &spans) else {
        return group.element(origin(main.at, file, files));
    };
    let marks: Vec<Annotation<'a>> = std::iter::once(mark(kind, window.range(main.at.span), &main.text))
        .chain(near.iter().map(|label| mark(AnnotationKind::Context, window.range(label.at.span), &label.text)))
        .collect();
    group.element(Snippet::source(window.text).line_start(window.line).path(file.name.as_str()).annotations(marks))
}

fn mark<'a>(kind: AnnotationKind, range: Range<usize>, text: &'a str) -> Annotation<'a> {
    let annotation = kind.span(range);
    if text.is_empty() { annotation } else { annotation.label(text) }
}

fn origin<'a>(at: Location, file: &'a SourceFile, files: &Files) -> Origin<'a> {
    let position = Position::of(at, files);
    let origin = Origin::path(file.name.as_str());
    if position.line == 0 || file.text.is_empty() {
        return origin;
    }
    origin.line(position.line as usize).char_column(position.column as usize)
}

/// The lines around some spans, so that the cost of showing an error does not grow with the file.
struct Window {
    text: String,
    start: usize,
    line: usize,
}

impl Window {
    /// `None` if there is no text to show or a line is too long.
    fn around(file: &SourceFile, spans: &[Span]) -> Option<Self> {
        if file.text.is_empty() {
            return None;
        }
        let first = spans.iter().map(|span| file.lines.line(span.start)).min()?;
        let last = spans.iter().map(|span| file.lines.line(span.end.max(span.start))).max()?;
        let first = first.saturating_sub(AROUND).max(1);
        let last = (last + AROUND).min(file.lines.count());
        let mut range = file.lines.line_span(&file.text, first)?;
        range = range.to(file.lines.line_span(&file.text, last)?);
        let text = range.text(&file.text);
        if text.split(['\n', '\r']).any(|line| line.len() > LONGEST_LINE) {
            return None;
        }
        Some(Self { text: one_kind_of_line_end(text), start: range.start as usize, line: first as usize })
    }

    fn range(&self, span: Span) -> Range<usize> {
        let shift = |offset: u32| {
            let mut at = (offset as usize).saturating_sub(self.start).min(self.text.len());
            while !self.text.is_char_boundary(at) {
                at -= 1;
            }
            at
        };
        let start = shift(span.start);
        start..shift(span.end).max(start)
    }
}

/// A lone carriage return ends a line in ARL but not in the renderer; both line ends are one byte.
fn one_kind_of_line_end(text: &str) -> String {
    let bytes = text.as_bytes();
    let lone = |at: usize| bytes.get(at) == Some(&b'\r') && bytes.get(at + 1) != Some(&b'\n');
    text.char_indices().map(|(at, c)| if lone(at) { '\n' } else { c }).collect()
}
