//! The lines in which two texts differ.

/// Lines around a difference that are shown.
const AROUND: usize = 2;
/// Texts with more lines are compared up to the first difference only.
const MOST_LINES: usize = 2000;

/// The differences of two texts, line by line: `-` expected, `+` actual. Characters that cannot be seen are escaped.
pub(super) fn diff(expected: &[u8], came: &[u8]) -> String {
    let old = lines(expected);
    let new = lines(came);
    let same_start = old.iter().zip(&new).take_while(|(a, b)| a == b).count();
    let steps = if old.len().max(new.len()) - same_start <= MOST_LINES {
        let mut steps: Vec<Step<'_>> = old.iter().take(same_start).map(|line| Step::Same(line)).collect();
        steps.extend(compare(old.get(same_start..).unwrap_or(&[]), new.get(same_start..).unwrap_or(&[])));
        steps
    } else {
        let mut steps: Vec<Step<'_>> = old.iter().take(same_start).map(|line| Step::Same(line)).collect();
        steps.extend(old.get(same_start).map(|line| Step::Gone(line)));
        steps.extend(new.get(same_start).map(|line| Step::Came(line)));
        steps
    };
    shown(&steps)
}

enum Step<'a> {
    Same(&'a str),
    Gone(&'a str),
    Came(&'a str),
}

/// The lines, the last one marked if it has no line end.
fn lines(text: &[u8]) -> Vec<String> {
    let text = String::from_utf8_lossy(text);
    let mut lines: Vec<String> = text.split_inclusive('\n').map(visible).collect();
    if let Some(last) = lines.last_mut().filter(|_| !text.ends_with('\n')) {
        last.push_str(" (no line end)");
    }
    lines
}

fn visible(line: &str) -> String {
    let line = line.strip_suffix('\n').unwrap_or(line);
    line.chars().flat_map(|c| if c.is_control() { c.escape_default().collect() } else { vec![c] }).collect()
}

/// The longest common subsequence, from a table of its lengths.
fn compare<'a>(old: &'a [String], new: &'a [String]) -> Vec<Step<'a>> {
    let width = new.len() + 1;
    let mut table = vec![0_u32; (old.len() + 1) * width];
    let at = |table: &[u32], i: usize, j: usize| table.get(i * width + j).copied().unwrap_or(0);
    for (i, a) in old.iter().enumerate().rev() {
        for (j, b) in new.iter().enumerate().rev() {
            let length =
                if a == b { at(&table, i + 1, j + 1) + 1 } else { at(&table, i + 1, j).max(at(&table, i, j + 1)) };
            if let Some(cell) = table.get_mut(i * width + j) {
                *cell = length;
            }
        }
    }
    let (mut i, mut j) = (0, 0);
    let mut steps = Vec::new();
    loop {
        match (old.get(i), new.get(j)) {
            (Some(a), Some(b)) if a == b => {
                steps.push(Step::Same(a));
                (i, j) = (i + 1, j + 1);
            }
            (Some(a), b) if b.is_none() || at(&table, i + 1, j) >= at(&table, i, j + 1) => {
                steps.push(Step::Gone(a));
                i += 1;
            }
            (_, Some(b)) => {
                steps.push(Step::Came(b));
                j += 1;
            }
            (_, None) => return steps,
        }
    }
}

fn shown(steps: &[Step<'_>]) -> String {
    let changed: Vec<usize> =
        steps.iter().enumerate().filter(|(_, step)| !matches!(step, Step::Same(_))).map(|(at, _)| at).collect();
    let near = |at: usize| changed.iter().any(|change| change.abs_diff(at) <= AROUND);
    let mut text = String::new();
    let mut gap = false;
    for (at, step) in steps.iter().enumerate() {
        if !near(at) {
            gap = true;
            continue;
        }
        if gap {
            text += &format!("@ line {}\n", at + 1);
            gap = false;
        }
        let (sign, line) = match step {
            Step::Same(line) => (' ', line),
            Step::Gone(line) => ('-', line),
            Step::Came(line) => ('+', line),
        };
        text += &format!("{sign}{line}\n");
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shows_what_changed_and_what_is_near() {
        let old = b"1\n2\n3\n4\n5\n6\n";
        let new = b"1\n2\n3\n4\nfive\n6\n7";
        assert_eq!(diff(old, new), "@ line 3\n 3\n 4\n-5\n+five\n 6\n+7 (no line end)\n");
    }

    #[test]
    fn unseen_characters_are_seen() {
        assert_eq!(diff(b"a\tb\r\n", b"a b\n"), "-a\\tb\\r\n+a b\n");
        assert_eq!(diff(b"", b"x\n"), "+x\n");
        assert_eq!(diff(b"x\n", b""), "-x\n");
    }

    #[test]
    fn long_texts_show_the_first_difference() {
        let old = "x\n".repeat(5000);
        let new = "x\n".repeat(100) + &"y\n".repeat(4900);
        assert_eq!(diff(old.as_bytes(), new.as_bytes()), "@ line 99\n x\n x\n-x\n+y\n");
    }
}
