//! The nesting level of each line, by the blocks around it.

use super::lines::LogicalLine;
use arl_lang::outline::Turn;
use arl_lang::syntax_error::{BLOCK_LEVELS, BlockKind};

/// The position of a line among the blocks.
#[derive(Clone, Copy, PartialEq, Eq, Default, Debug)]
pub(super) struct LineLevel {
    /// The number of blocks around it that count.
    pub(super) level: usize,
    /// The number of blocks open before it: the level of a comment above it if it closes a block.
    pub(super) before: usize,
    /// Whether the next line is the first one of a block or a branch.
    pub(super) opens: bool,
    /// Whether it ends a block or a branch.
    pub(super) closes: bool,
    /// Whether a function begins.
    pub(super) begins_function: bool,
    /// Whether a function ends.
    pub(super) ends_function: bool,
}

impl LineLevel {
    /// The level of a comment above the line.
    pub(super) fn of_comment(self) -> usize {
        if self.closes { self.before } else { self.level }
    }
}

/// An open block.
struct Frame {
    kind: BlockKind,
    /// Whether it begins with a `{`.
    braced: bool,
}

/// The positions of the lines, followed by that of the end of the text.
pub(super) fn places(lines: &[LogicalLine<'_>]) -> Vec<LineLevel> {
    let opens = doubtful_openers(lines);
    let mut doubts = opens.into_iter();
    let mut stack: Vec<Frame> = Vec::new();
    let mut places: Vec<LineLevel> = lines.iter().map(|line| place(line, &mut stack, &mut doubts)).collect();
    places.push(LineLevel { level: capped(stack.len()), before: capped(stack.len()), ..LineLevel::default() });
    places
}

/// Limits the level: more blocks than can be open do not move a line further to the right.
fn capped(level: usize) -> usize {
    level.min(BLOCK_LEVELS)
}

/// The position of a line; updates the stack of blocks.
fn place(line: &LogicalLine<'_>, stack: &mut Vec<Frame>, doubts: &mut impl Iterator<Item = bool>) -> LineLevel {
    let mut place = LineLevel { level: capped(stack.len()), before: capped(stack.len()), ..LineLevel::default() };
    for (at, turn) in line.turns.iter().enumerate() {
        let own = match turn.turn {
            Turn::MayOpen(kind) if doubts.next().unwrap_or(false) => Turn::Open(kind),
            own => own,
        };
        let level = take(own, turn.braced, stack);
        if at == 0 {
            place.level = capped(level);
            place.closes = matches!(own, Turn::Close(_) | Turn::CloseOther(_) | Turn::CloseBrace)
                || own == Turn::Branch(BlockKind::If);
            place.begins_function = own == Turn::Open(BlockKind::Func);
            place.ends_function = own == Turn::Close(BlockKind::Func);
        }
        place.opens = matches!(own, Turn::Open(_) | Turn::Branch(_) | Turn::OpenBrace);
    }
    place
}

/// Opens and closes blocks; returns the level of the line that does so.
fn take(turn: Turn, braced: bool, stack: &mut Vec<Frame>) -> usize {
    let level = match turn {
        Turn::Open(BlockKind::Func) => {
            stack.clear();
            stack.push(Frame { kind: BlockKind::Func, braced });
            0
        }
        Turn::Open(kind) => {
            stack.push(Frame { kind, braced });
            stack.len() - 1
        }
        Turn::Branch(kind) => match innermost(stack, kind) {
            Some(at) => {
                stack.truncate(at + 1);
                at
            }
            None => stack.len(),
        },
        Turn::Close(kind) => close(stack, innermost(stack, kind)),
        Turn::CloseOther(function) => {
            let around = if function { innermost(stack, BlockKind::Func) } else { None };
            let last = stack.len().checked_sub(1);
            close(stack, around.or(last))
        }
        Turn::CloseBrace => {
            let last = stack.last().filter(|frame| frame.braced).map(|_| stack.len() - 1);
            close(stack, last)
        }
        Turn::OpenBrace => stack.len().saturating_sub(1),
        Turn::None | Turn::MayOpen(_) => stack.len(),
    };
    if (braced || turn == Turn::OpenBrace)
        && let Some(frame) = stack.last_mut()
    {
        frame.braced = true;
    }
    level
}

/// Closes the block at `at` and those inside it.
fn close(stack: &mut Vec<Frame>, at: Option<usize>) -> usize {
    let level = at.unwrap_or(stack.len());
    stack.truncate(level);
    level
}

fn innermost(stack: &[Frame], kind: BlockKind) -> Option<usize> {
    stack.iter().rposition(|frame| frame.kind == kind)
}

/// Which of the lines that may open an `if` do so: those with a `{`, and in each function the first ones, as many as it
/// has more `endif` than `if`.
fn doubtful_openers(lines: &[LogicalLine<'_>]) -> Vec<bool> {
    let mut openers: Vec<bool> = Vec::new();
    let mut first = 0;
    let mut surplus = 0_isize;
    let settle = |openers: &mut Vec<bool>, first: usize, surplus: isize| {
        let count = usize::try_from(surplus).unwrap_or(0);
        let undecided = openers.iter_mut().skip(first).filter(|opens| !**opens);
        undecided.take(count).for_each(|opens| *opens = true);
    };
    for turn in lines.iter().flat_map(|line| &line.turns) {
        match turn.turn {
            Turn::Open(BlockKind::Func) | Turn::Close(BlockKind::Func) => {
                settle(&mut openers, first, surplus);
                (first, surplus) = (openers.len(), 0);
            }
            Turn::Open(BlockKind::If) => surplus -= 1,
            Turn::Close(BlockKind::If) => surplus += 1,
            Turn::MayOpen(_) => openers.push(turn.braced),
            _ => {}
        }
    }
    settle(&mut openers, first, surplus);
    openers
}
