//! Comments at the ends of lines, in columns.

use super::spacing::LEVEL;
use super::table::width;

/// How much shorter than the longest line of a group the shortest one may be.
const FARTHEST: usize = 40;

/// A line with a comment at its end.
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

/// The blanks in front of the comment of each line; `None` stands for a line without one.
pub(super) fn gaps(lines: &[Option<Commented>]) -> Vec<usize> {
    let mut gaps = vec![1; lines.len()];
    let mut start = 0;
    while start < lines.len() {
        let group = group(lines.get(start..).unwrap_or_default());
        let end = start + group.len().max(1);
        let column = group.iter().map(|line| line.width).max().unwrap_or(0);
        for (gap, line) in gaps.iter_mut().skip(start).zip(&group) {
            *gap = 1 + column - line.width;
        }
        start = end;
    }
    gaps
}

/// The lines at the beginning of `lines` whose comments stand in one column.
fn group(lines: &[Option<Commented>]) -> Vec<Commented> {
    let mut group: Vec<Commented> = Vec::new();
    let (mut least, mut most) = (usize::MAX, 0);
    for line in lines {
        let Some(line) = line else { break };
        least = least.min(line.width);
        most = most.max(line.width);
        let fits =
            group.first().is_none_or(|first| line.follows && line.level == first.level && most - least <= FARTHEST);
        if !fits {
            break;
        }
        group.push(*line);
    }
    group
}
