//! Columns: the values of point tables, and comments behind lines.

use super::{Kind, Row};

/// No line of a table gets longer than this, in characters.
const WIDEST: usize = 120;
/// A line that would move a comment to the right by more than this does not share its column.
const FARTHEST: usize = 40;

/// A declaration with values in braces, in parts.
struct Entry {
    /// The type, and `const` in front of it.
    ty: String,
    head: String,
    values: Vec<String>,
}

/// Aligns declarations of one type with values in braces that follow each other.
pub(super) fn tables(rows: &mut [Row]) {
    let mut at = 0;
    while at < rows.len() {
        let entries: Vec<Entry> = table(rows.get(at..).unwrap_or_default());
        let count = entries.len();
        if let (2.., Some(bodies)) = (count, aligned(&entries))
            && let Some(rows) = rows.get_mut(at..at + count)
            && rows.iter().zip(&bodies).all(|(row, body)| row.indent + body.chars().count() <= WIDEST)
        {
            rows.iter_mut().zip(bodies).for_each(|(row, body)| row.body = body);
        }
        at += count.max(1);
    }
}

/// The entries that the rows begin with and that belong together.
fn table(rows: &[Row]) -> Vec<Entry> {
    let mut entries: Vec<Entry> = Vec::new();
    let mut indent = None;
    for row in rows {
        let Some(entry) = entry(row) else { break };
        let fits = entries.first().is_none_or(|first| {
            first.ty == entry.ty && first.values.len() == entry.values.len() && indent == Some(row.indent)
        });
        if !fits {
            break;
        }
        indent = Some(row.indent);
        entries.push(entry);
    }
    entries
}

/// The parts of a row that declares one variable with plain values in braces.
fn entry(row: &Row) -> Option<Entry> {
    row.width()?;
    let (head, values) = row.body.split_once(" = {")?;
    let values = values.strip_suffix('}')?;
    if values.is_empty() || values.contains(['{', '}', '(', ')', '"', '/']) {
        return None;
    }
    let (ty, name) = head.rsplit_once(' ')?;
    let is_name = |text: &str| text.chars().all(|one| one.is_ascii_alphanumeric() || one == '_');
    let is_type = |text: &str| {
        text.strip_prefix("const ").unwrap_or(text).chars().all(|one| one.is_ascii_alphanumeric() || one == '_')
    };
    if !is_name(name) || !is_type(ty) {
        return None;
    }
    let values = values.split(", ").map(ToString::to_string).collect();
    Some(Entry { ty: ty.to_ascii_lowercase(), head: head.to_string(), values })
}

/// The bodies with their `=` and their commas in columns.
fn aligned(entries: &[Entry]) -> Option<Vec<String>> {
    let head = entries.iter().map(|entry| entry.head.len()).max()?;
    let columns = entries.first()?.values.len();
    let width = |column: usize| entries.iter().filter_map(|entry| entry.values.get(column)).map(String::len).max();
    let widths: Vec<usize> = (0..columns).filter_map(width).collect();
    let body = |entry: &Entry| {
        let mut body = format!("{:head$} = {{", entry.head);
        for (at, (value, width)) in entry.values.iter().zip(&widths).enumerate() {
            if at + 1 == columns {
                body.push_str(value);
            } else {
                body.push_str(&format!("{:1$}", format!("{value},"), width + 2));
            }
        }
        body.push('}');
        body
    };
    Some(entries.iter().map(body).collect())
}

/// Aligns the comments behind lines that follow each other in one block.
pub(super) fn comments(rows: &mut [Row]) {
    let mut at = 0;
    while at < rows.len() {
        let count = group(rows.get(at..).unwrap_or_default());
        let Some(rows) = rows.get_mut(at..at + count) else { break };
        let column = rows.iter().filter_map(Row::width).max().unwrap_or(0);
        for row in rows {
            let missing = row.width().map_or(0, |width| column - width);
            row.body.extend(std::iter::repeat_n(' ', missing));
        }
        at += count.max(1);
    }
}

/// How many rows the first one shares the column of its comment with, itself counted.
fn group(rows: &[Row]) -> usize {
    let (mut least, mut most) = (usize::MAX, 0);
    let indent = rows.first().map(|row| row.indent);
    let mut shares = |row: &&Row| {
        let Some(width) = row.width().filter(|_| row.trailing.is_some() && Some(row.indent) == indent) else {
            return false;
        };
        (least, most) = (least.min(width), most.max(width));
        row.kind == Kind::Code && most - least <= FARTHEST
    };
    rows.iter().take_while(&mut shares).count()
}
