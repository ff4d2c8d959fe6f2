//! What can be folded: functions and blocks, `//` comments over several lines, regions.

use super::server::{Refusal, Server};
use super::text::Text;
use arl_lang::lexer::{Lexeme, lexemes};
use arl_lang::outline;
use arl_lang::outline::Turn;
use arl_lang::span::Span;
use arl_lang::syntax_error::BlockKind;
use gen_lsp_types::*;

pub(super) fn folding(server: &Server, params: FoldingRangeParams) -> Result<Option<Vec<FoldingRange>>, Refusal> {
    let fold = || {
        let file = server.document(&params.text_document)?;
        let text = file.text(server)?;
        let mut ranges = blocks(text);
        ranges.extend(comments(text));
        ranges.extend(long_comments(text));
        ranges.sort_by_key(|range| (range.start_line, range.end_line));
        Some(ranges)
    };
    Ok(fold())
}

fn range(start_line: u32, end_line: u32, kind: Option<FoldingRangeKind>) -> FoldingRange {
    FoldingRange { start_line, start_character: None, end_line, end_character: None, kind, collapsed_text: None }
}

/// Blocks, from the line that opens one to the line before the one that closes it, as the parser sees them. A closing
/// line without a block folds nothing; an unclosed block ends with the block around it.
fn blocks(text: Text<'_>) -> Vec<FoldingRange> {
    let mut open: Vec<(BlockKind, u32)> = Vec::new();
    let mut found = Vec::new();
    for placed in outline(text.text).turns {
        let line = text.position(placed.start).line;
        let closed = match placed.turn {
            Turn::Open(kind) => {
                open.push((kind, line));
                continue;
            }
            Turn::Close(kind) => open.iter().rposition(|(opened, _)| *opened == kind),
            Turn::CloseOther(_) => open.len().checked_sub(1),
            _ => None,
        };
        if let Some((_, start)) = closed.and_then(|at| open.drain(at..).next())
            && start + 1 < line
        {
            found.push(range(start, line - 1, None));
        }
    }
    found
}

/// Comments of several lines, and what is between `// region` and `// endregion`.
fn comments(text: Text<'_>) -> Vec<FoldingRange> {
    let mut found = Vec::new();
    let mut regions = Vec::new();
    let mut run: Option<u32> = None;
    let lines = text.text.lines().chain([""]);
    for (number, line) in (0..).zip(lines) {
        let comment = line.trim().strip_prefix("//").map(|comment| comment.trim().to_ascii_lowercase());
        match comment.as_deref() {
            Some(comment) if comment.starts_with("region") => regions.push(number),
            Some(comment) if comment.starts_with("endregion") => {
                found.extend(regions.pop().map(|start| range(start, number, Some(FoldingRangeKind::Region))));
            }
            Some(_) => {
                run.get_or_insert(number);
                continue;
            }
            None => {}
        }
        if let Some(start) = run.take().filter(|start| start + 1 < number) {
            found.push(range(start, number - 1, Some(FoldingRangeKind::Comment)));
        }
    }
    found
}

/// `/* .. */` over several lines; the last line stays where something else is on it, too.
fn long_comments(text: Text<'_>) -> Vec<FoldingRange> {
    let code = lexemes(text.text).filter(|(lexeme, _)| *lexeme != Ok(Lexeme::Newline)).map(|(_, span)| span);
    let end = text.text.len() as u32;
    let mut found = Vec::new();
    let mut at = 0;
    // Between two words there is nothing but spaces and comments.
    for next in code.chain([Span::new(end, end)]) {
        let between = text.text.get(at as usize..next.start as usize).unwrap_or_default();
        for (start, end) in long_comments_of(between) {
            let lines = text.range(Span::new(at + start as u32, at + end as u32));
            let behind = text.text.get(at as usize + end..).and_then(|rest| rest.lines().next()).unwrap_or_default();
            let last = lines.end.line.saturating_sub(u32::from(!behind.trim().is_empty()));
            if lines.start.line < last {
                found.push(range(lines.start.line, last, Some(FoldingRangeKind::Comment)));
            }
        }
        at = next.end;
    }
    found
}

/// The `/* .. */` of a text that has no code in it: where each begins, and ends.
fn long_comments_of(text: &str) -> Vec<(usize, usize)> {
    let mut found = Vec::new();
    let mut at = 0;
    while let Some(start) = text.get(at..).and_then(|rest| rest.find('/')).map(|slash| at + slash) {
        let rest = text.get(start..).unwrap_or_default();
        at = if let Some(inside) = rest.strip_prefix("/*") {
            let end = inside.find("*/").map_or(text.len(), |end| start + 2 + end + 2);
            found.push((start, end));
            end
        } else if rest.starts_with("//") {
            // The rest of the line begins nothing.
            rest.find('\n').map_or(text.len(), |end| start + end)
        } else {
            start + 1
        };
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lsp::text::Encoding;
    use arl_lang::span::LineIndex;

    fn folded(source: &str) -> Vec<(u32, u32)> {
        let lines = LineIndex::new(source);
        let text = Text { text: source, lines: &lines, encoding: Encoding::Utf16 };
        let all = blocks(text).into_iter().chain(comments(text)).chain(long_comments(text));
        all.map(|range| (range.start_line, range.end_line)).collect()
    }

    #[test]
    fn blocks_end_before_their_last_line() {
        assert_eq!(folded("func void main()\nif(a)\nb = 1\nendif\nendfunc\n"), [(1, 2), (0, 3)]);
        assert_eq!(folded("func void f()\nif(a) b = 1\nloop\nx()\nendloop\nendfunc\n"), [(2, 3), (0, 4)]);
    }

    #[test]
    fn what_is_not_closed_costs_itself_only() {
        assert_eq!(folded("func void f()\nwhile(a)\nb()\nendfunc\nendif\n"), [(0, 2)]);
    }

    #[test]
    fn long_comments_fold() {
        assert_eq!(folded("/* a\nb\n*/\nint x /* y */ /* z\nw */\n"), [(0, 2), (3, 4)]);
        assert_eq!(folded("// /* a\nint x\nstring s = \"/*\"\n// */\n"), []);
        assert_eq!(folded("/*/ a\nb */\n"), [(0, 1)]);
        assert_eq!(folded("/* a\nb\n*/ int x\n/* c\n*/ int y\n"), [(0, 1)]);
    }

    #[test]
    fn comments_and_regions() {
        assert_eq!(folded("// a\n// b\nint x\n// region r\nint y\n// endregion\n"), [(0, 1), (3, 5)]);
    }
}
