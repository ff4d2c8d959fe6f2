//! A row of on-off signals.

/// On-off signals in a row, from 0.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(crate) struct Bits(Box<[bool]>);

impl Bits {
    /// So many signals, all off.
    pub(crate) fn new(count: u32) -> Self {
        Self(vec![false; count as usize].into())
    }

    /// How many there are.
    pub(crate) fn len(&self) -> usize {
        self.0.len()
    }

    /// All of them.
    pub(crate) fn levels(&self) -> &[bool] {
        &self.0
    }

    /// A signal; off where there is none.
    #[inline]
    pub(crate) fn get(&self, at: usize) -> bool {
        self.0.get(at).copied().unwrap_or(false)
    }

    /// Sets a signal, where there is one.
    #[inline]
    pub(crate) fn set(&mut self, at: usize, level: bool) {
        if let Some(place) = self.0.get_mut(at) {
            *place = level;
        }
    }

    /// Takes over the signals of another row of the same length.
    pub(crate) fn copy_from(&mut self, other: &Bits) {
        if self.0.len() == other.0.len() {
            self.0.copy_from_slice(&other.0);
        }
    }
}
