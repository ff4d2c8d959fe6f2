//! Cycles in which nothing can change are left out on the virtual clock: an hour of waiting costs as much as a second.

use super::Controller;
use super::channel::Channel;
use super::external::SERVO_PULSE_S;

impl Controller {
    /// Leaves out the cycles to come in which nothing can change, but for the one with the number `before` and those
    /// behind it. The run is the same as with them, to the last bit: programs wait for a time, for signals or for
    /// nothing any more, robots stand, and no event of a scenario is due. Whoever looks at each cycle, as a trace, a
    /// recorder, a thread or a driver of your own, has each cycle.
    pub(crate) fn skip_quiet_cycles(&mut self, before: u64) {
        let next = self.shared.now.get();
        let Some(until) = next.checked_sub(1).and_then(|cycle| self.quiet_until(cycle)) else { return };
        // Where everything waits for ever, that is a standstill, which is found out first: it takes a while.
        if until == u64::MAX && self.standstill().is_none() {
            return;
        }
        let until = until.min(before);
        if until != u64::MAX && until > next {
            self.shared.now.set(until);
            self.stay_awake();
        }
    }

    /// Has some cycles take place before any is left out: somebody may have changed something.
    pub(super) fn stay_awake(&mut self) {
        self.awake_until = self.shared.now.get().saturating_add(self.late_effect());
    }

    /// For so many cycles what was changed may have an effect: a PLC that is wired presses some buttons by pulses.
    fn late_effect(&self) -> u64 {
        if self.external.is_wired() { self.shared.rate.cycles(2.0 * SERVO_PULSE_S) } else { 1 }
    }

    /// The cycle before which nothing changes, judged by this cycle, the last one.
    fn quiet_until(&self, cycle: u64) -> Option<u64> {
        // What runs mostly runs: that is found out first.
        self.channels.first().quiet_until(cycle)?;
        if cycle < self.awake_until || !self.clock.may_skip() || self.is_over() {
            return None;
        }
        if self.is_watched() || self.is_under_way() {
            return None;
        }
        // What one program did last, another may only see in the next cycle.
        let acted = self.channels.iter().map(|channel| channel.cx().acted()).max().unwrap_or_default();
        if cycle.saturating_sub(acted.max(self.scenario.played())) < self.late_effect() {
            return None;
        }
        let mut channels = self.channels.iter().map(|channel: &Channel| channel.quiet_until(cycle));
        let wakes = channels.try_fold(u64::MAX, |first, wakes| Some(first.min(wakes?)))?;
        Some(wakes.min(self.scenario.quiet_until(&self.shared.io.borrow())?))
    }

    /// Whether somebody has a look at each cycle, or may change something in any.
    fn is_watched(&self) -> bool {
        self.has_outside
            || self.calls.is_open()
            || !self.islands.is_empty()
            || self.shared.buses.modbus_tcp_address().is_some()
            || !self.shared.subscribers.is_empty()
            || self.shared.watcher().is_some()
    }

    /// Whether something is on its way beside the programs, their robots and the scenario.
    fn is_under_way(&self) -> bool {
        let shared = &self.shared;
        shared.disk.is_waited_for()
            || shared.state.borrow().is_saving()
            || self.system().has_changed()
            || self.pointer_store.as_ref().is_some_and(|store| store.has_news())
            || shared.io.borrow().has_pulses()
    }
}
