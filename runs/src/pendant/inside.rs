//! The running functions and the variables, which replace axes and io while the user looks into the program.

use ratatui::Frame;
use ratatui::layout::{Constraint, Layout, Rect};
use ratatui::text::{Line, Span};
use ratatui::widgets::Paragraph;

use super::screen::{QUIET, STRONG, titled};
use arl_wire::{Inside, Variable};

/// The most functions that are shown.
const MOST_CALLS: usize = 6;

/// Draws both, without the first `scrolled` lines of the variables.
pub(super) fn draw(frame: &mut Frame<'_>, area: Rect, inside: &Inside, scrolled: usize) {
    let calls = call_lines(inside);
    let height = calls.len() as u16 + 2;
    let [above, below] = Layout::vertical([Constraint::Length(height), Constraint::Min(0)]).areas(area);
    frame.render_widget(Paragraph::new(calls).block(titled("calls")), above);
    let variables = variable_lines(inside);
    let room = usize::from(titled("").inner(below).height);
    let scrolled = scrolled.min(variables.len().saturating_sub(room));
    let shown: Vec<Line<'_>> = variables.into_iter().skip(scrolled).collect();
    let title = if scrolled > 0 { "variables ↑" } else { "variables" };
    frame.render_widget(Paragraph::new(shown).block(titled(title)), below);
}

/// The lines of the calls, the innermost function first.
fn call_lines(inside: &Inside) -> Vec<Line<'_>> {
    if inside.frames.is_empty() {
        return vec![Line::styled("no function runs", QUIET)];
    }
    let line = |function: &arl_wire::Function| {
        let place = format!("  {}:{}", function.file, function.line);
        Line::from(vec![Span::raw(function.name.clone()), Span::styled(place, QUIET)])
    };
    let mut lines: Vec<Line<'_>> = inside.frames.iter().take(MOST_CALLS).map(line).collect();
    if inside.frames.len() > MOST_CALLS {
        lines.push(Line::styled(format!("and {} more", inside.frames.len() - MOST_CALLS), QUIET));
    }
    lines
}

/// The variables of the innermost function, then those of the files.
fn variable_lines(inside: &Inside) -> Vec<Line<'_>> {
    let mut lines: Vec<Line<'_>> = inside.variables.iter().chain(&inside.handles).map(variable_line).collect();
    for file in &inside.files {
        lines.push(Line::styled(file.file.as_str(), QUIET));
        lines.extend(file.variables.iter().chain(&file.handles).map(variable_line));
    }
    lines
}

fn variable_line(variable: &Variable) -> Line<'_> {
    Line::from(vec![Span::styled(variable.name.as_str(), STRONG), Span::raw(" "), Span::raw(variable.value.as_str())])
}
