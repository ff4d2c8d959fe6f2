//! A row of on-off signals.

/// A row of on-off signals, counted from 0.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(crate) struct Bits(Box<[bool]>);

impl Bits {
    /// A row of `count` signals, all off.
    pub(crate) fn new(count: u32) -> Self {
        Self(vec![false; count as usize].into())
    }

    /// The number of signals.
    pub(crate) fn len(&self) -> usize {
        self.0.len()
    }

    /// The levels of all signals.
    pub(crate) fn levels(&self) -> &[bool] {
        &self.0
    }

    /// The level of a signal; off if it does not exist.
    #[inline]
    pub(crate) fn get(&self, at: usize) -> bool {
        self.0.get(at).copied().unwrap_or(false)
    }

    /// Sets a signal if it exists.
    #[inline]
    pub(crate) fn set(&mut self, at: usize, level: bool) {
        if let Some(place) = self.0.get_mut(at) {
            *place = level;
        }
    }

    /// Copies the signals of another row of the same length.
    pub(crate) fn copy_from(&mut self, other: &Bits) {
        if self.0.len() == other.0.len() {
            self.0.copy_from_slice(&other.0);
        }
    }
}
