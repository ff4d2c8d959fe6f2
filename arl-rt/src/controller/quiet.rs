//! Cycles in which nothing can change are skipped on the virtual clock: an hour of waiting costs as much as a second.

use super::Controller;
use super::channel::Channel;
use super::external::SERVO_PULSE_S;

impl Controller {
    /// Skips the next cycles in which nothing can change, up to the cycle number `before`, which is not skipped. The
    /// run is the same as with them, to the last bit: programs wait for a time, for signals or in vain, robots stand,
    /// and no event of a scenario is due. Where each cycle is observed, as by a trace, a recorder, a thread or a driver
    /// of your own, no cycle is skipped.
    pub(crate) fn skip_quiet_cycles(&mut self, before: u64) {
        let next = self.shared.now.get();
        let Some(until) = next.checked_sub(1).and_then(|cycle| self.quiet_until(cycle)) else { return };
        // Where everything waits for ever, that is a standstill, which has to be recognised first: that takes a while.
        if until == u64::MAX && self.standstill().is_none() {
            return;
        }
        let until = until.min(before);
        if until != u64::MAX && until > next {
            self.shared.now.set(until);
            self.stay_awake();
        }
    }

    /// Has some cycles take place before any is skipped: something may have been changed from outside.
    pub(super) fn stay_awake(&mut self) {
        self.awake_until = self.shared.now.get().saturating_add(self.late_effect());
    }

    /// For how many cycles a change may still take effect: a PLC that is wired presses some buttons by pulses.
    fn late_effect(&self) -> u64 {
        if self.external.is_wired() { self.shared.rate.cycles(2.0 * SERVO_PULSE_S) } else { 1 }
    }

    /// The cycle before which nothing changes, judged by `cycle`, the last one.
    fn quiet_until(&self, cycle: u64) -> Option<u64> {
        // This ends the check early in most cases: a program that runs mostly goes on running.
        self.channels.first().quiet_until(cycle)?;
        if cycle < self.awake_until || !self.clock.may_skip() || self.is_over() {
            return None;
        }
        if self.is_watched() || self.has_pending_work() {
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

    /// Whether anything outside observes each cycle, or may change something in any of them.
    fn is_watched(&self) -> bool {
        self.has_outside
            || self.calls.is_open()
            || !self.islands.is_empty()
            || self.shared.buses.modbus_tcp_address().is_some()
            || !self.shared.subscribers.is_empty()
            || self.shared.watcher().is_some()
    }

    /// Whether anything is under way besides the programs, their robots and the scenario.
    fn has_pending_work(&self) -> bool {
        let shared = &self.shared;
        shared.disk.is_waited_for()
            || shared.state.borrow().is_saving()
            || self.system().has_changed()
            || self.pointer_store.as_ref().is_some_and(|store| store.has_news())
            || shared.io.borrow().has_pulses()
    }
}
