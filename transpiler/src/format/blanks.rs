//! Blank lines between lines.

use super::levels::LineLevel;
use super::lines::LogicalLine;

/// For each line, none of which is blank itself, whether a blank line precedes it; `written` tells where the author put
/// blank lines.
pub(super) fn blanks(lines: &[LogicalLine<'_>], places: &[LineLevel], written: &[bool]) -> Vec<bool> {
    let mut blanks = Vec::with_capacity(lines.len());
    let mut opened = true;
    for ((line, place), written) in lines.iter().zip(places).zip(written) {
        blanks.push(*written && !opened && (line.is_comment() || !place.closes));
        opened = !line.is_comment() && place.opens;
    }
    set_functions_apart(lines, places, &mut blanks);
    blanks
}

/// Puts one blank line between functions; comments directly above a function belong to it.
fn set_functions_apart(lines: &[LogicalLine<'_>], places: &[LineLevel], blanks: &mut [bool]) {
    // The last line that is not a comment. It matters whether a function was open before it or begins with it.
    let mut last: Option<usize> = None;
    for (at, (line, place)) in lines.iter().zip(places).enumerate() {
        if line.is_comment() {
            continue;
        }
        let before = last.replace(at).and_then(|last| Some((last, places.get(last)?)));
        let Some((last, before)) = before.filter(|_| place.begins_function) else { continue };
        if before.ends_function || place.before > 0 {
            let mut first = at;
            while first > last + 1 && !blanks.get(first).is_some_and(|blank| *blank) {
                first -= 1;
            }
            for at in [last + 1, first] {
                if let Some(blank) = blanks.get_mut(at) {
                    *blank = true;
                }
            }
        }
    }
}
