//! What the checks have looked at, and the worst that was seen.

use std::collections::BTreeMap;
use std::fmt;

/// How often each thing was looked at, and the worst that was seen.
#[derive(Clone, Default, Debug)]
pub(crate) struct Tally(BTreeMap<&'static str, (u64, f64)>);

impl Tally {
    pub(crate) fn note(&mut self, what: &'static str, value: f64) {
        self.note_many(what, 1, value);
    }

    /// So many values, the worst of which is this.
    pub(crate) fn note_many(&mut self, what: &'static str, count: usize, worst: f64) {
        let (known, most) = self.0.entry(what).or_insert((0, f64::NEG_INFINITY));
        *known += count as u64;
        *most = most.max(worst);
    }

    pub(crate) fn add(&mut self, other: &Tally) {
        for (what, (count, worst)) in &other.0 {
            self.note_many(what, *count as usize, *worst);
        }
    }
}

impl fmt::Display for Tally {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (what, (count, worst)) in &self.0 {
            writeln!(f, "{what:50} {count:12} at worst {worst:.6}")?;
        }
        Ok(())
    }
}
