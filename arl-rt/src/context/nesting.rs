//! How deep functions may call themselves: the same depth, whoever runs the program.
//!
//! A call of a function that may call itself has a weight: 1, and more if it has many expressions or variables. The
//! stacks of programs have room for that weight in native code.

use std::cell::Cell;
use std::fmt;
use std::ops::Deref;

use crate::fault::Fault;

/// The weight that nested calls of functions that may call themselves have at most.
const MOST_NESTED: u32 = 20_000;

/// How many bytes of strings and arrays nested function calls may hold.
const MOST_BYTES_HELD: usize = 256 << 20;

/// The calls of a program's functions that have not ended, of those that may call themselves.
#[derive(Default, Debug)]
pub struct Nesting {
    weight: Cell<u32>,
    /// How many bytes they hold.
    held: Cell<usize>,
}

impl Nesting {
    /// # Errors
    /// As for [`Cx::enter`](crate::emit::Cx::enter).
    #[inline]
    pub(super) fn enter<N: Deref<Target = Self>>(nesting: N, weight: u32, bytes: usize) -> Result<Entered<N>, Fault> {
        let nested = nesting.weight.get().saturating_add(weight);
        if nested > MOST_NESTED {
            return Err(Fault::Depth);
        }
        let held = nesting.held.get().saturating_add(bytes);
        if held > MOST_BYTES_HELD {
            return Err(Fault::DepthBytes { most: MOST_BYTES_HELD });
        }
        nesting.weight.set(nested);
        nesting.held.set(held);
        Ok(Entered { nesting, weight, bytes })
    }
}

/// A call of a function that may call itself. It ends when this is dropped.
#[must_use = "the call ends when this is dropped"]
pub struct Entered<N: Deref<Target = Nesting>> {
    nesting: N,
    weight: u32,
    bytes: usize,
}

impl<N: Deref<Target = Nesting>> fmt::Debug for Entered<N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Entered").field("weight", &self.weight).field("bytes", &self.bytes).finish_non_exhaustive()
    }
}

impl<N: Deref<Target = Nesting>> Drop for Entered<N> {
    #[inline]
    fn drop(&mut self) {
        let nesting = &self.nesting;
        nesting.weight.set(nesting.weight.get().saturating_sub(self.weight));
        nesting.held.set(nesting.held.get().saturating_sub(self.bytes));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn calls_count_until_they_end() {
        let nesting = Nesting::default();
        let mut calls: Vec<_> = (0..MOST_NESTED).map(|_| Nesting::enter(&nesting, 1, 0)).collect();
        assert!(calls.iter().all(Result::is_ok));
        assert!(matches!(Nesting::enter(&nesting, 1, 0), Err(Fault::Depth)));
        calls.truncate(7);
        assert!(matches!(Nesting::enter(&nesting, MOST_NESTED - 6, 0), Err(Fault::Depth)));
        assert!(Nesting::enter(&nesting, MOST_NESTED - 7, 0).is_ok());
        drop(calls);
        assert!(Nesting::enter(&nesting, MOST_NESTED, 0).is_ok());
    }

    #[test]
    fn what_they_hold_counts_until_they_end() {
        let nesting = Nesting::default();
        let call = Nesting::enter(&nesting, 1, MOST_BYTES_HELD);
        assert!(matches!(Nesting::enter(&nesting, 1, 1), Err(Fault::DepthBytes { .. })));
        drop(call);
        assert!(Nesting::enter(&nesting, 1, 1).is_ok());
        assert_eq!((nesting.weight.get(), nesting.held.get()), (0, 0));
    }
}
