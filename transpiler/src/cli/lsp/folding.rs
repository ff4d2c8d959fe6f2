//! What can be folded: functions and blocks, `//` comments over several lines, regions.

use super::server::{Refusal, Server};
use super::text::Text;
use arl_lang::outline;
use arl_lang::outline::Turn;
use arl_lang::syntax_error::BlockKind;
use gen_lsp_types::*;

pub(super) fn folding(server: &Server, params: FoldingRangeParams) -> Result<Option<Vec<FoldingRange>>, Refusal> {
    let fold = || {
        let file = server.document(&params.text_document)?;
        let text = file.text(server)?;
        let mut ranges = blocks(text);
        ranges.extend(comments(text));
        ranges.sort_by_key(|range| (range.start_line, range.end_line));
        Some(ranges)
    };
    Ok(fold())
}

fn range(start_line: u32, end_line: u32, kind: Option<FoldingRangeKind>) -> FoldingRange {
    FoldingRange { start_line, start_character: None, end_line, end_character: None, kind, collapsed_text: None }
}

/// Blocks, from the line that opens one to the line before the one that closes it, as the parser sees them. What closes
/// nothing folds nothing; what is not closed ends with what is around it.
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

/// Comments of several lines, and what stands between `// region` and `// endregion`.
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cli::lsp::text::Encoding;
    use arl_lang::span::LineIndex;

    fn folded(source: &str) -> Vec<(u32, u32)> {
        let lines = LineIndex::new(source);
        let text = Text { text: source, lines: &lines, encoding: Encoding::Utf16 };
        let all = blocks(text).into_iter().chain(comments(text));
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
    fn comments_and_regions() {
        assert_eq!(folded("// a\n// b\nint x\n// region r\nint y\n// endregion\n"), [(0, 1), (3, 5)]);
    }
}
