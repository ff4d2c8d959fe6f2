//! The formatter: the only layout of programs. It changes the space between lexemes and the case of words that the
//! language declares, and nothing else.
//!
//! A line passes through these modules: `lines` reads it with its roles, `levels` determines its nesting level,
//! `spelling` writes the words of the language as the manual does, `spacing` sets blanks, and `table`, `comments` and
//! `blanks` consider its neighbours. Finally, `same` compares the result with the original text.

mod blanks;
mod comments;
mod levels;
mod lines;
mod same;
mod spacing;
mod spelling;
mod table;
#[cfg(test)]
mod tests;
mod trivia;

use comments::{Commented, End};
use levels::LineLevel;
use lines::{LogicalLine, read};
pub use spacing::LEVEL;
use spacing::Text;
use table::TableRow;

/// The byte order mark that may begin a text.
const MARK: char = '\u{feff}';

/// Formats a program. Lines with errors stay as they are; so does the whole text if its lexemes, comments or lines
/// would not be the same afterwards. The line ends are those of the first line.
///
/// ```
/// let text = "func void main( )\nIF (getdi(1)==true)\nLin p1 , vl : 100 mm/s\nendif\nendfunc";
/// let laid_out = arl2rs::format::format(text);
/// let right = "func void main()\n    if(getdi(1) == true)\n        lin p1, vl:100mm/s\n    endif\nendfunc\n";
/// assert_eq!(laid_out, right);
/// assert_eq!(arl2rs::format::format(&laid_out), laid_out);
/// ```
pub fn format(text: &str) -> String {
    let plain = text.strip_prefix(MARK).unwrap_or(text);
    // Offsets in a text have 32 bits.
    if u32::try_from(text.len()).is_err() {
        return text.to_string();
    }
    let line_end = line_end(plain);
    let plain = plain.replace("\r\n", "\n").replace('\r', "\n");
    let mut lines = read(&plain);
    let laid_out = lay_out(&mut lines);
    let same = same::same(&lines, &read(&laid_out));
    debug_assert!(same, "not the same: {plain:?} became {laid_out:?}");
    if !same {
        return text.to_string();
    }
    let mark = if text.starts_with(MARK) { "\u{feff}" } else { "" };
    format!("{mark}{}", laid_out.replace('\n', line_end))
}

/// The first line end of a text.
fn line_end(text: &str) -> &'static str {
    let at = text.find(['\r', '\n']).unwrap_or(text.len());
    match text.as_bytes().get(at..) {
        Some([b'\r', b'\n', ..]) => "\r\n",
        Some([b'\r', ..]) => "\r",
        _ => "\n",
    }
}

/// Formats a text whose line ends are all `\n`; removes blank lines from `lines` and changes the spelling of words
/// there.
fn lay_out(lines: &mut Vec<LogicalLine<'_>>) -> String {
    let written = take_blanks(lines);
    let functions = spelling::functions(lines);
    for line in lines.iter_mut().filter(|line| !line.frozen) {
        spelling::spell(&mut line.items, &functions);
    }
    let mut places = levels::places(lines);
    let end = places.pop().unwrap_or_default();
    let blanks = blanks::blanks(lines, &places, &written);
    indent_comments(lines, &mut places, end);
    let mut texts: Vec<Option<Text>> = lines.iter().zip(&places).map(|(line, place)| text_of(line, *place)).collect();
    set_tables(lines, &places, &blanks, &mut texts);
    joined(lines, &places, &blanks, &texts)
}

/// Removes the blank lines; returns for each other line whether one preceded it.
fn take_blanks(lines: &mut Vec<LogicalLine<'_>>) -> Vec<bool> {
    let mut written = Vec::with_capacity(lines.len());
    let mut blank = false;
    lines.retain(|line| {
        let is_blank = line.is_blank();
        if !is_blank {
            written.push(blank);
        }
        blank = is_blank;
        !is_blank
    });
    written
}

/// Indents comments on lines of their own like the line that follows them.
fn indent_comments(lines: &[LogicalLine<'_>], places: &mut [LineLevel], end: LineLevel) {
    let mut below = end.level;
    for (line, place) in lines.iter().zip(places).rev() {
        if line.is_comment() {
            place.level = below;
        } else {
            below = place.of_comment();
        }
    }
}

/// The text of a line; `None` if it stays as it is.
fn text_of(line: &LogicalLine<'_>, place: LineLevel) -> Option<Text> {
    (!line.frozen).then(|| spacing::write(&line.items, (place.level + 1) * LEVEL))
}

/// Aligns consecutive declarations in columns.
fn set_tables(lines: &[LogicalLine<'_>], places: &[LineLevel], blanks: &[bool], texts: &mut [Option<Text>]) {
    let rows: Vec<Option<TableRow>> = lines.iter().map(table::row).collect();
    let level = |at: usize| places.get(at).map(|place| place.level);
    let mut start = 0;
    while let Some(first) = rows.get(start) {
        let Some(first) = first else {
            start += 1;
            continue;
        };
        let mut group = vec![first];
        while let Some(Some(row)) = rows.get(start + group.len())
            && table::fit(first, row)
            && level(start) == level(start + group.len())
            && blanks.get(start + group.len()) == Some(&false)
        {
            group.push(row);
        }
        let aligned = table::align(&group, level(start).unwrap_or(0)).unwrap_or_default();
        for (text, aligned) in texts.iter_mut().skip(start).flatten().zip(aligned) {
            text.body = aligned;
        }
        start += group.len();
    }
}

/// All lines, with a single line end at the end of the text.
fn joined(lines: &[LogicalLine<'_>], places: &[LineLevel], blanks: &[bool], texts: &[Option<Text>]) -> String {
    let mut ends: Vec<End> = Vec::with_capacity(lines.len());
    for (((line, text), place), blank) in lines.iter().zip(texts).zip(places).zip(blanks) {
        let commented = |text: &Text| Commented::new(&text.body, place.level, !blank);
        ends.push(match text {
            Some(text) if text.trailing.is_some() => End::Comment(commented(text)),
            Some(text) if line.declares() => End::Declaration(commented(text)),
            _ => End::Other,
        });
    }
    let gaps = comments::gaps(&ends);
    let mut whole = String::new();
    for (at, (line, place)) in lines.iter().zip(places).enumerate() {
        if blanks.get(at) == Some(&true) {
            whole.push('\n');
        }
        match texts.get(at) {
            Some(Some(text)) => {
                whole.extend(std::iter::repeat_n(' ', place.level * LEVEL));
                whole.push_str(&text.body);
                if let Some(comment) = &text.trailing {
                    whole.extend(std::iter::repeat_n(' ', gaps.get(at).copied().unwrap_or(1)));
                    whole.push_str(comment);
                }
            }
            _ => whole.push_str(line.raw),
        }
        whole.push('\n');
    }
    whole.truncate(whole.trim_end_matches('\n').len());
    if !whole.is_empty() {
        whole.push('\n');
    }
    whole
}
