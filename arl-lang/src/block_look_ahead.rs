//! Decides, where a closing line does not fit the innermost block, whether the blocks inside lack their closing lines
//! or this line is superfluous. The lines that follow, up to the end of the function, decide: the reading with fewer
//! mistakes wins.

use crate::line::LineKind;
use crate::syntax_error::BlockKind;

/// The greatest number of lines to look ahead.
const MOST_LINES: usize = 400;

/// What a line means for the blocks.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) enum Event {
    /// It opens a block; `true` where it may not open one after all.
    Open(BlockKind, bool),
    /// It closes a block.
    Close(BlockKind),
    /// It begins another branch of a block of this kind.
    Branch(BlockKind),
    /// Nothing.
    None,
}

impl Event {
    /// The event of a line of this kind; `may_open`: whether it is uncertain that the line opens a block.
    pub(crate) fn of(kind: &LineKind, may_open: bool) -> Event {
        match kind {
            LineKind::Func(_) => Event::Open(BlockKind::Func, may_open),
            LineKind::If(_) => Event::Open(BlockKind::If, may_open),
            LineKind::While(_) => Event::Open(BlockKind::While, may_open),
            LineKind::Repeat => Event::Open(BlockKind::Repeat, may_open),
            LineKind::Loop => Event::Open(BlockKind::Loop, may_open),
            LineKind::For(_) => Event::Open(BlockKind::For, may_open),
            LineKind::Switch(_) => Event::Open(BlockKind::Switch, may_open),
            LineKind::ElseIf(_) | LineKind::Else => Event::Branch(BlockKind::If),
            LineKind::Case(_) | LineKind::Default => Event::Branch(BlockKind::Switch),
            LineKind::EndFunc => Event::Close(BlockKind::Func),
            LineKind::EndIf => Event::Close(BlockKind::If),
            LineKind::EndWhile => Event::Close(BlockKind::While),
            LineKind::Until(_) => Event::Close(BlockKind::Repeat),
            LineKind::EndLoop => Event::Close(BlockKind::Loop),
            LineKind::EndFor => Event::Close(BlockKind::For),
            LineKind::EndSwitch => Event::Close(BlockKind::Switch),
            LineKind::Statement(_)
            | LineKind::Import(_)
            | LineKind::BraceOpen
            | LineKind::BraceClose
            | LineKind::OtherEnd(..) => Event::None,
        }
    }
}

/// The open blocks, outermost first: the kind, and whether the closing line may be missing without a mistake.
pub(crate) type Stack = Vec<(BlockKind, bool)>;

/// How many of the blocks lack their closing line by mistake.
pub(crate) fn missing(blocks: &[(BlockKind, bool)]) -> usize {
    blocks.iter().filter(|(_, quiet)| !quiet).count()
}

/// How many mistakes there are in `events` when `stack` is open before them.
pub(crate) fn mistakes(mut stack: Stack, events: impl Iterator<Item = Event>) -> usize {
    let mut count = 0;
    for (seen, event) in events.enumerate() {
        if seen >= MOST_LINES {
            return count;
        }
        let (Event::Close(kind) | Event::Branch(kind)) = event else {
            if let Event::Open(kind, quiet) = event {
                stack.push((kind, quiet));
            }
            continue;
        };
        match stack.iter().rposition(|(open, _)| *open == kind) {
            Some(at) => {
                count += missing(stack.get(at + 1..).unwrap_or_default());
                stack.truncate(if matches!(event, Event::Close(_)) { at } else { at + 1 });
            }
            None => {
                count += 1;
                if let (Some(innermost), Event::Close(_)) = (stack.last_mut(), event) {
                    innermost.1 = true;
                }
            }
        }
    }
    count + missing(&stack)
}
