//! Aligns comments at the ends of lines.

use super::spacing::LEVEL;
use super::table::width;

/// The maximum difference in width between the longest and the shortest line of a group.
const FARTHEST: usize = 40;

/// The end of a line.
#[derive(Clone, Copy, Debug)]
pub(super) enum End {
    /// A comment.
    Comment(Commented),
    /// No comment, but a declaration, which does not separate a list of declarations.
    Declaration(Commented),
    /// Anything else.
    Other,
}

/// A line that may have a comment at its end.
#[derive(Clone, Copy, Debug)]
pub(super) struct Commented {
    /// Its level.
    pub(super) level: usize,
    /// The number of columns before the blank that precedes the comment.
    pub(super) width: usize,
    /// Whether it comes directly after the previous line.
    pub(super) follows: bool,
}

impl Commented {
    /// A line with this text before its comment.
    pub(super) fn new(body: &str, level: usize, follows: bool) -> Self {
        let width = match body.rsplit_once('\n') {
            Some((_, last)) => width(last),
            None => level * LEVEL + width(body),
        };
        Self { level, width, follows }
    }
}

/// The number of blanks before the comment of each line.
pub(super) fn gaps(lines: &[End]) -> Vec<usize> {
    let mut gaps = vec![1; lines.len()];
    let mut start = 0;
    while start < lines.len() {
        let group = group(lines.get(start..).unwrap_or_default());
        let column = group.iter().map(|(_, line)| line.width).max().unwrap_or(0);
        for (at, line) in &group {
            if let Some(gap) = gaps.get_mut(start + at) {
                *gap = 1 + column - line.width;
            }
        }
        start += group.last().map_or(1, |(at, _)| at + 1);
    }
    gaps
}

/// The first lines of `lines` whose comments are aligned in one column, with their indices.
fn group(lines: &[End]) -> Vec<(usize, Commented)> {
    let mut group: Vec<(usize, Commented)> = Vec::new();
    let (mut least, mut most) = (usize::MAX, 0);
    for (at, line) in lines.iter().enumerate() {
        let (End::Comment(own) | End::Declaration(own)) = line else { break };
        let goes_on = group.first().is_none_or(|(_, first)| own.follows && own.level == first.level);
        if !goes_on {
            break;
        }
        if matches!(line, End::Declaration(_)) {
            // A group begins with a comment.
            if group.is_empty() { break } else { continue }
        }
        least = least.min(own.width);
        most = most.max(own.width);
        if most - least > FARTHEST {
            break;
        }
        group.push((at, *own));
    }
    group
}
