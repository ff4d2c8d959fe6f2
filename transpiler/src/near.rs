//! Finds the name that was probably meant, at a limited cost.

pub(crate) use arl_lang::near::nearest;

/// The maximum number of comparisons with wrong names in one check. A program with that many errors needs no hints for
/// the last ones.
const COMPARISONS: usize = 1 << 20;

/// How many comparisons a check may still make to find the names that were meant. The cost of a check thus grows only
/// with the size of the program.
#[derive(Debug)]
pub(crate) struct Hints {
    remaining: usize,
}

impl Default for Hints {
    fn default() -> Self {
        Self { remaining: COMPARISONS }
    }
}

impl Hints {
    /// The nearest of `count` candidates, which are collected only if the budget allows it.
    pub(crate) fn nearest<'a, I: Iterator<Item = &'a str>>(
        &mut self,
        name: &str,
        count: usize,
        candidates: impl FnOnce() -> I,
    ) -> Option<&'a str> {
        self.remaining = self.remaining.checked_sub(count.max(1))?;
        nearest(name, candidates())
    }
}

#[cfg(test)]
mod tests {
    use super::Hints;

    #[test]
    fn hints_end_where_they_cost_too_much() {
        let mut hints = Hints { remaining: 5 };
        let names = || ["count", "mount"].into_iter();
        assert_eq!(hints.nearest("cuont", 2, names), Some("count"));
        assert_eq!(hints.nearest("cuont", 2, names), Some("count"));
        assert_eq!(hints.nearest("cuont", 2, names), None);
        assert_eq!(hints.nearest("cuont", 1, names), Some("count"));
    }
}
