//! Finds the name that was probably meant.

/// The candidate nearest to `name`, if it is near enough to be a likely slip: the number of single-character edits
/// (swaps of neighbours count once) may be a third of the length. Names of one or two characters are near too many
/// others.
///
/// ```
/// let names = ["waituntil", "waittime"];
/// assert_eq!(arl_lang::near::nearest("waitutil", names.into_iter()), Some("waituntil"));
/// assert_eq!(arl_lang::near::nearest("position", names.into_iter()), None);
/// ```
pub fn nearest<'a>(name: &str, candidates: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    within(name, name.chars().count() / 3, candidates)
}

/// The candidate nearest to `name` of those that are at most `limit` edits away.
pub(crate) fn within<'a>(name: &str, limit: usize, candidates: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    let folded = name.to_ascii_lowercase();
    candidates
        .filter_map(|candidate| {
            let far = candidate.len().abs_diff(name.len()) > limit;
            let edits = if far { usize::MAX } else { distance(&folded, &candidate.to_ascii_lowercase()) };
            (edits <= limit).then_some((edits, candidate))
        })
        .min()
        .map(|(_, candidate)| candidate)
}

/// Edits between two names: insert, delete, replace, swap of neighbours (restricted Damerau-Levenshtein).
fn distance(left: &str, right: &str) -> usize {
    let left: Vec<char> = left.chars().collect();
    let right: Vec<char> = right.chars().collect();
    let width = right.len() + 1;
    let mut before: Vec<usize> = vec![0; width];
    let mut last: Vec<usize> = (0..width).collect();
    for (row, a) in left.iter().enumerate() {
        let mut this = vec![row + 1; width];
        for (column, b) in right.iter().enumerate() {
            let get = |line: &[usize], at: usize| line.get(at).copied().unwrap_or(usize::MAX / 2);
            let replace = get(&last, column) + usize::from(a != b);
            let mut best = replace.min(get(&last, column + 1) + 1).min(get(&this, column) + 1);
            let swapped = row > 0 && column > 0 && left.get(row - 1) == Some(b) && right.get(column - 1) == Some(a);
            if swapped {
                best = best.min(get(&before, column - 1) + 1);
            }
            if let Some(cell) = this.get_mut(column + 1) {
                *cell = best;
            }
        }
        before = std::mem::replace(&mut last, this);
    }
    last.last().copied().unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::nearest;

    #[test]
    fn finds_slips_and_leaves_strangers() {
        let names = ["waituntil", "waittime", "movej", "count"];
        assert_eq!(nearest("waitutil", names.into_iter()), Some("waituntil"));
        assert_eq!(nearest("cuont", names.into_iter()), Some("count"));
        assert_eq!(nearest("Movej1", names.into_iter()), Some("movej"));
        assert_eq!(nearest("position", names.into_iter()), None);
        assert_eq!(nearest("vl", ["sl", "vp"].into_iter()), None);
    }
}
