//! Comments at the ends of lines, in columns.

use super::spacing::LEVEL;
use super::table::width;

/// How much shorter than the longest line of a group the shortest one may be.
const FARTHEST: usize = 40;

/// What a line has at its end.
#[derive(Clone, Copy, Debug)]
pub(super) enum End {
    /// A comment.
    Comment(Commented),
    /// None, but it declares something: so it parts no list of declarations.
    Declaration(Commented),
    /// Nothing that counts.
    Other,
}

/// A line that may have a comment at its end.
#[derive(Clone, Copy, Debug)]
pub(super) struct Commented {
    /// Its level.
    pub(super) level: usize,
    /// The columns in front of the blank before the comment.
    pub(super) width: usize,
    /// Whether it stands directly below the line before.
    pub(super) follows: bool,
}

impl Commented {
    /// A line with this text in front of its comment.
    pub(super) fn new(body: &str, level: usize, follows: bool) -> Self {
        let width = match body.rsplit_once('\n') {
            Some((_, last)) => width(last),
            None => level * LEVEL + width(body),
        };
        Self { level, width, follows }
    }
}

/// The blanks in front of the comment of each line.
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

/// The lines at the beginning of `lines` whose comments stand in one column: which they are.
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
