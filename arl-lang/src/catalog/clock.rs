//! 5.3: clocks.

use super::declare::{base, entries, folded, kind, param_type};

entries! { pub(super) CLOCK =
    /// Starts a clock; after clkstop it goes on counting.
    fn clkstart(c: clock "the clock")
        { "5.3.2", clock::clkstart, acts; "clock c\nclkstart(c)" }
    /// Stops a clock; it keeps its value.
    fn clkstop(c: clock "the clock")
        { "5.3.3", clock::clkstop, acts; "clock c\nclkstart(c)\nclkstop(c)" }
    /// Sets a clock to 0; a running clock continues from there.
    fn clkreset(c: clock "the clock")
        { "5.3.4", clock::clkreset, acts; "clock c\nclkreset(c)" }
    /// Reads a clock in controller time, s.
    fn clkread(c: clock "the clock") -> double
        { "5.3.5", clock::clkread, acts, looks; "clock c\nclkstart(c)\nwaittime 0.5\nclkstop(c)\nprint clkread(c) >= 0.5" }
}
