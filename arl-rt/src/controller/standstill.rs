//! Whether a run can go on: programs may wait for what can never happen.

use super::Controller;
use super::channel::Repose;
use crate::context::standstill::Standstill;

/// How long everything must have waited where a PLC is wired, whose signals take effect with delays, in s.
const PLC_DELAY_S: f64 = 1.0;

impl Controller {
    /// The programs that wait in vain, if nothing can change any more: all programs wait for conditions, for the start
    /// button, for stopped motion or for motion at an override of 0 %, nothing moves, no timer runs, no pulse is on, no
    /// event of the scenario is left, and nothing is outside: no driver of your own, no bus, no connection, no real
    /// clock, and no [`Handle`](super::Handle). `None` where something may still happen, and when the programs have
    /// ended.
    ///
    /// The owner of the controller can still change an input or press a button; then it goes on.
    pub fn standstill(&self) -> Option<Vec<Standstill>> {
        let cycle = self.shared.now.get().checked_sub(1)?;
        // This ends the check early in most cases: a program that runs mostly goes on running.
        let first = self.channels.first().repose(cycle)?;
        if self.has_outside || self.calls.is_open() || self.clock.is_real() || self.is_busy() {
            return None;
        }
        let mut waiting = Vec::new();
        for (at, channel) in self.channels.iter().enumerate() {
            let repose = if at == 0 { first } else { channel.repose(cycle)? };
            if let Repose::Waiting(waits_for) = repose {
                let (file, line) = channel.cx().place();
                waiting.push(Standstill { channel: channel.channel_state().id, file, line, waits_for });
            }
        }
        let since = cycle.saturating_sub(self.channels.iter().map(|channel| channel.cx().acted()).max()?);
        // What one program did last, another may only see in the next cycle.
        let delay = if self.external.is_wired() { self.shared.rate.cycles(PLC_DELAY_S) } else { 1 };
        (!waiting.is_empty() && since >= delay).then_some(waiting)
    }

    /// Whether anything is under way besides the programs and their robots.
    fn is_busy(&self) -> bool {
        let shared = &self.shared;
        let io = shared.io.borrow();
        shared.disk.is_waited_for()
            || io.has_pulses()
            || self.scenario.goes_on(&io)
            || !self.islands.is_empty()
            || shared.buses.modbus_tcp_address().is_some()
    }
}
