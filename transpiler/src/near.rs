//! Finds the name that was probably meant, without spending too much on it.

pub(crate) use arl_lang::near::nearest;

/// How many names a check compares with wrong ones, all in all. Whoever has so many mistakes needs no hints for the
/// last.
const COMPARISONS: usize = 1 << 20;

/// What a check may still spend on looking for names that were meant, so that its cost grows with the program only.
#[derive(Debug)]
pub(crate) struct Hints {
    left: usize,
}

impl Default for Hints {
    fn default() -> Self {
        Self { left: COMPARISONS }
    }
}

impl Hints {
    /// The nearest of so many candidates, which are gathered only where there is something left to spend.
    pub(crate) fn nearest<'a, I: Iterator<Item = &'a str>>(
        &mut self,
        name: &str,
        count: usize,
        candidates: impl FnOnce() -> I,
    ) -> Option<&'a str> {
        self.left = self.left.checked_sub(count.max(1))?;
        nearest(name, candidates())
    }
}

#[cfg(test)]
mod tests {
    use super::Hints;

    #[test]
    fn hints_end_where_they_cost_too_much() {
        let mut hints = Hints { left: 5 };
        let names = || ["count", "mount"].into_iter();
        assert_eq!(hints.nearest("cuont", 2, names), Some("count"));
        assert_eq!(hints.nearest("cuont", 2, names), Some("count"));
        assert_eq!(hints.nearest("cuont", 2, names), None);
        assert_eq!(hints.nearest("cuont", 1, names), Some("count"));
    }
}
