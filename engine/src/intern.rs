//! Texts of programs that live as long as the process: names of files and variables, string constants.
//!
//! The runtime takes them as `&'static str`, as compiled programs have them. Equal ones share their memory, so that
//! running one program again and again takes no more.

use std::collections::HashSet;
use std::sync::{Mutex, PoisonError};

static KNOWN: Mutex<Option<HashSet<&'static str>>> = Mutex::new(None);
static KNOWN_SIZES: Mutex<Option<HashSet<&'static [usize]>>> = Mutex::new(None);

/// The text, for as long as the process runs.
pub(crate) fn intern(text: &str) -> &'static str {
    let mut known = KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
    let known = known.get_or_insert_with(HashSet::new);
    if let Some(found) = known.get(text) {
        return found;
    }
    let kept: &'static str = text.to_owned().leak();
    known.insert(kept);
    kept
}

/// The sizes of an array, for as long as the process runs.
pub(crate) fn intern_sizes(sizes: &[usize]) -> &'static [usize] {
    let mut known = KNOWN_SIZES.lock().unwrap_or_else(PoisonError::into_inner);
    let known = known.get_or_insert_with(HashSet::new);
    if let Some(found) = known.get(sizes) {
        return found;
    }
    let kept: &'static [usize] = sizes.to_vec().leak();
    known.insert(kept);
    kept
}
