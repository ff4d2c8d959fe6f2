//! Aligns tables of points: consecutive declarations with initial values in braces.

use super::lines::{Item, LogicalLine, PlacedLexeme};
use super::spacing::{LEVEL, write};
use arl_lang::lexer::Lexeme;
use arl_lang::outline::LexemeRole;

/// The maximum width of a line of a table.
const WIDEST: usize = 120;

/// A declaration that may be a row of a table.
#[derive(Debug)]
pub(super) struct TableRow {
    /// The type, folded, including `const` if present; it is the same for all rows of a table.
    ty: String,
    /// The text before the `=`.
    left: String,
    /// The values between the braces.
    cells: Vec<String>,
}

/// A line as a row: one variable with a value in braces, on one line, without inner comments.
pub(super) fn row(line: &LogicalLine<'_>) -> Option<TableRow> {
    let code = match line.items.as_slice() {
        [code @ .., Item::LineComment(_)] => code,
        code => code,
    };
    let pieces: Vec<&PlacedLexeme<'_>> = line.pieces().collect();
    if line.frozen || pieces.len() != code.len() {
        return None;
    }
    let is = |at: usize, lexeme: Lexeme| pieces.get(at).is_some_and(|piece| piece.lexeme == lexeme);
    let ty = usize::from(pieces.first()?.is_word("const"));
    let is_type = |piece: &PlacedLexeme<'_>| {
        matches!(piece.role, LexemeRole::Type | LexemeRole::Name) || piece.lexeme == Lexeme::System
    };
    let declares = is_type(pieces.get(ty)?) && pieces.get(ty + 1)?.role == LexemeRole::Name;
    let assign = pieces.iter().position(|piece| piece.lexeme == Lexeme::Assign)?;
    let mut between = pieces.get(ty + 2..assign)?.iter();
    let plain = !between.any(|piece| piece.lexeme == Lexeme::Comma);
    if !(declares && plain && is(assign + 1, Lexeme::BraceOpen) && is(pieces.len() - 1, Lexeme::BraceClose)) {
        return None;
    }
    let words = pieces.get(..=ty)?.iter().map(|piece| piece.text.to_ascii_lowercase());
    Some(TableRow {
        ty: words.collect::<Vec<_>>().join(" "),
        left: write(code.get(..assign)?, 0).body,
        cells: cells(code.get(assign + 2..code.len() - 1)?)?,
    })
}

/// The values between commas; `None` if the braces do not end the line, or if a comma follows the last value.
fn cells(items: &[Item<'_>]) -> Option<Vec<String>> {
    let mut cells = Vec::new();
    let mut depth = 0_usize;
    let mut start = 0;
    for (at, item) in items.iter().enumerate() {
        let Item::Piece(piece) = item else { return None };
        match piece.lexeme {
            Lexeme::ParenOpen | Lexeme::BracketOpen | Lexeme::BraceOpen => depth += 1,
            Lexeme::ParenClose | Lexeme::BracketClose | Lexeme::BraceClose => depth = depth.checked_sub(1)?,
            Lexeme::Comma if depth == 0 => {
                cells.push(write(items.get(start..at)?, 0).body);
                start = at + 1;
            }
            _ => {}
        }
    }
    let last = write(items.get(start..)?, 0).body;
    if last.is_empty() && !cells.is_empty() {
        return None;
    }
    cells.push(last);
    Some(cells)
}

/// Whether both rows may be in the same table.
pub(super) fn fit(row: &TableRow, other: &TableRow) -> bool {
    row.ty == other.ty
}

/// The rows as text; `None` if they do not form a table.
pub(super) fn align(rows: &[&TableRow], level: usize) -> Option<Vec<String>> {
    let first = rows.first().filter(|_| rows.len() > 1)?;
    if rows.iter().any(|row| row.cells.len() != first.cells.len()) {
        return None;
    }
    let widest = |text: &dyn Fn(&TableRow) -> usize| rows.iter().map(|row| text(row)).max().unwrap_or(0);
    let left = widest(&|row| width(&row.left));
    let columns: Vec<usize> =
        (0..first.cells.len()).map(|at| widest(&|row| row.cells.get(at).map_or(0, |cell| width(cell)))).collect();
    let lines: Vec<String> = rows.iter().map(|row| text(row, left, &columns)).collect();
    let fits = |line: &String| level * LEVEL + width(line) <= WIDEST;
    lines.iter().all(fits).then_some(lines)
}

fn text(row: &TableRow, left: usize, columns: &[usize]) -> String {
    let mut line = padded(&row.left, left);
    line.push_str(" = {");
    let last = row.cells.len().saturating_sub(1);
    for (at, (cell, column)) in row.cells.iter().zip(columns).enumerate() {
        if at == last {
            line.push_str(cell);
        } else {
            line.push_str(&padded(&format!("{cell},"), column + 2));
        }
    }
    line.push('}');
    line
}

fn padded(text: &str, column: usize) -> String {
    format!("{text}{}", " ".repeat(column.saturating_sub(width(text))))
}

/// The number of columns that a text takes.
pub(super) fn width(text: &str) -> usize {
    text.chars().count()
}
