//! What can be folded: functions and blocks, `//` comments over several lines, regions.

use super::server::{Refusal, Server};
use super::text::Text;
use arl_lang::lexer::{Lexeme, lexemes};
use gen_lsp_types::*;

/// The words that open a block, and what closes it.
const BLOCKS: [(&str, &str); 7] = [
    ("func", "endfunc"),
    ("if", "endif"),
    ("while", "endwhile"),
    ("for", "endfor"),
    ("loop", "endloop"),
    ("repeat", "until"),
    ("switch", "endswitch"),
];

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

/// Blocks, from the line that opens one to the line before the one that closes it. A word that closes what is not open
/// closes nothing; what is not closed ends with what is around it.
fn blocks(text: Text<'_>) -> Vec<FoldingRange> {
    let mut open: Vec<(&str, u32)> = Vec::new();
    let mut found = Vec::new();
    let mut first_of_line = true;
    for (lexeme, span) in lexemes(text.text) {
        if lexeme == Ok(Lexeme::Newline) {
            first_of_line = true;
            continue;
        }
        if !std::mem::replace(&mut first_of_line, false) || lexeme != Ok(Lexeme::Word) {
            continue;
        }
        let (word, line) = (span.text(text.text), text.position(span.start).line);
        if let Some((_, closer)) = BLOCKS.iter().find(|(opener, _)| opener.eq_ignore_ascii_case(word)) {
            open.push((closer, line));
        }
        let Some(at) = open.iter().rposition(|(closer, _)| closer.eq_ignore_ascii_case(word)) else { continue };
        if let Some((_, start)) = open.drain(at..).next()
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
        assert_eq!(folded("if(a) b = 1\nloop\nx()\nendloop\n"), [(1, 2)]);
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
