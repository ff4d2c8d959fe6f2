//! Layout: the whole text, and automatic changes when a line is ended.

use super::server::{Refusal, Server};
use super::text::Text;
use super::uri::path_of;
use arl_lang::outline::Turn;
use arl_lang::span::Span;
use arl_lang::symbol::Interner;
use arl_lang::syntax_error::BlockKind;
use arl_lang::{ParseOptions, outline, parse};
use arl2rs::format::LEVEL;
use gen_lsp_types::*;

/// The formatted text, as one change from the first line that differs to the last one.
pub(super) fn all(server: &Server, params: DocumentFormattingParams) -> Result<Option<Vec<TextEdit>>, Refusal> {
    let find = || {
        let document = server.documents.get(&path_of(&params.text_document.uri))?;
        let text = document.as_text(server.encoding);
        Some(changes(text, &arl2rs::format::format(text.text)))
    };
    Ok(find())
}

/// The part between what both texts begin with and what both end with.
fn changes(old: Text<'_>, new: &str) -> Vec<TextEdit> {
    if old.text == new {
        return Vec::new();
    }
    let (old_lines, new_lines): (Vec<&str>, Vec<&str>) = (lines(old.text), lines(new));
    let pairs = old_lines.iter().zip(&new_lines);
    let same_start = pairs.take_while(|(old, new)| old == new).count();
    let rest = old_lines.len().min(new_lines.len()) - same_start;
    let pairs = old_lines.iter().rev().zip(new_lines.iter().rev()).take(rest);
    let same_end = pairs.take_while(|(old, new)| old == new).count();
    let part = |lines: &[&str]| {
        let changed = lines.get(same_start..lines.len() - same_end).unwrap_or_default();
        changed.concat()
    };
    let start: usize = old_lines.iter().take(same_start).map(|line| line.len()).sum();
    let end = start + part(&old_lines).len();
    let range = old.range(Span::new(start as u32, end as u32));
    vec![TextEdit { range, new_text: part(&new_lines) }]
}

/// The lines with their line ends.
fn lines(text: &str) -> Vec<&str> {
    text.split_inclusive('\n').collect()
}

/// After Enter at the end of a line that opens a block or a branch: the new line is indented by one level, and if
/// nothing closes the block, its closing line is added below.
pub(super) fn typed(server: &Server, params: DocumentOnTypeFormattingParams) -> Result<Option<Vec<TextEdit>>, Refusal> {
    let find = || {
        let document = server.documents.get(&path_of(&params.text_document.uri))?;
        let text = document.as_text(server.encoding);
        below_opener(text, params.position)
    };
    Ok(find())
}

fn below_opener(text: Text<'_>, position: Position) -> Option<Vec<TextEdit>> {
    let (start, line) = text.line_at(text.offset(position));
    let (above, opener) = text.line_at(start.checked_sub(1)?);
    if !line.trim().is_empty() {
        return None;
    }
    let turns = outline(text.text).turns;
    let turn = turns.iter().rfind(|turn| (above..start).contains(&turn.start)).map(|turn| turn.turn)?;
    let indent = opener.get(..opener.len() - opener.trim_start().len())?;
    let inside = format!("{indent}{:LEVEL$}", "");
    let blank = Span::new(start, start + line.len() as u32);
    let range = text.range(blank);
    let deeper = TextEdit { range, new_text: inside.clone() };
    match turn {
        Turn::Open(kind) if is_unclosed(text.text, blank, kind) => {
            let ending = if text.text.contains("\r\n") { "\r\n" } else { "\n" };
            let closer = if kind == BlockKind::Repeat { "until()" } else { kind.closer() };
            // Two edits, so that the cursor stays in the line that is typed.
            let end = Range { start: range.end, end: range.end };
            Some(vec![deeper, TextEdit { range: end, new_text: format!("{ending}{indent}{closer}") }])
        }
        Turn::Open(_) | Turn::Branch(_) if line != inside => Some(vec![deeper]),
        _ => None,
    }
}

/// Whether the text has fewer mistakes with a line that closes a block of this kind in the place of a blank one.
fn is_unclosed(text: &str, blank: Span, kind: BlockKind) -> bool {
    let closer = if kind == BlockKind::Repeat { "until(a)" } else { kind.closer() };
    let mut closed = text.to_string();
    closed.replace_range(blank.start as usize..blank.end as usize, closer);
    mistakes(&closed) < mistakes(text)
}

fn mistakes(text: &str) -> usize {
    parse(text, &mut Interner::new(), ParseOptions::default()).errors.len()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lsp::text::Encoding;
    use arl_lang::span::LineIndex;

    /// The text after Enter was pressed at the `|`, which is on the new line.
    fn after_enter(source: &str) -> String {
        let offset = source.find('|').unwrap() as u32;
        let source = source.replacen('|', "", 1);
        let lines = LineIndex::new(&source);
        let text = Text { text: &source, lines: &lines, encoding: Encoding::Utf16 };
        let edits = below_opener(text, text.position(offset)).unwrap_or_default();
        let mut changed = source.clone();
        for edit in edits.iter().rev() {
            let span = text.span(edit.range);
            changed.replace_range(span.start as usize..span.end as usize, &edit.new_text);
        }
        changed
    }

    #[test]
    fn a_block_that_nothing_closes_is_closed() {
        let text = "func void main()\n    if(a)\n    |\nendfunc\n";
        assert_eq!(after_enter(text), "func void main()\n    if(a)\n        \n    endif\nendfunc\n");
        assert_eq!(after_enter("func void f()\n|"), "func void f()\n    \nendfunc");
        let text = "func void main()\nif(a)\n    b()\nelse\n|\nendif\nendfunc\n";
        assert_eq!(after_enter(text), "func void main()\nif(a)\n    b()\nelse\n    \nendif\nendfunc\n");
        let text = "func void f()\nrepeat\n|\nendfunc\n";
        assert_eq!(after_enter(text), "func void f()\nrepeat\n    \nuntil()\nendfunc\n");
    }

    #[test]
    fn a_block_that_is_closed_gets_its_level_only() {
        let text = "func void main()\nloop\n|\nendloop\nendfunc\n";
        assert_eq!(after_enter(text), "func void main()\nloop\n    \nendloop\nendfunc\n");
    }

    #[test]
    fn other_lines_stay() {
        for text in ["func void main()\nif(a) b = 1\n|\nendfunc\n", "int x\n|", "// if\n|\n", "/*\nloop\n|\n*/\n"] {
            assert_eq!(after_enter(text), text.replace('|', ""));
        }
    }
}
