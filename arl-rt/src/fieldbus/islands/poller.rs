//! The thread of an island: it exchanges inputs and outputs, and reconnects after the island is lost.

use std::sync::Arc;
use std::time::{Duration, Instant};

use arl_robot::islands::{Island, Rest};

use super::link::IslandLink;
use super::plan::{ExchangePlan, SignalRange, Signals};
use super::shared::SharedImages;
use crate::cycle::catch_panic::catch_panic;
use crate::fieldbus::modbus::client::{self, Refusal};

/// The first and the longest pause of the thread before it reconnects. Each pause is twice the previous one.
const FIRST_RECONNECT_PAUSE: Duration = Duration::from_millis(100);
const MAX_RECONNECT_PAUSE: Duration = Duration::from_secs(5);

/// The data of the thread.
pub(super) struct Poller {
    island: Island,
    plan: ExchangePlan,
    shared: Arc<SharedImages>,
    inputs: Signals,
    outputs: Signals,
    /// Signals at rest.
    resting: [Signals; 2],
    request: Vec<u8>,
}

impl Poller {
    /// A poller for an island; `resting` are the inputs and outputs at rest, with which it starts.
    pub(super) fn new(island: Island, shared: Arc<SharedImages>, resting: [Signals; 2]) -> Self {
        let (plan, [inputs, outputs]) = (ExchangePlan::new(&island.points), resting.clone());
        Self { island, plan, shared, inputs, outputs, resting, request: Vec::with_capacity(256) }
    }

    /// Exchanges until the thread is to stop.
    pub(super) fn run(mut self) {
        let mut pause = FIRST_RECONNECT_PAUSE;
        while !self.shared.stops() {
            let begin = Instant::now();
            // Inputs that are no longer exchanged are lost, for whatever reason: robots must not rely on them.
            let visited = catch_panic(|| self.visit()).unwrap_or_else(|| Err("its thread has panicked".to_owned()));
            let Err(why) = visited else { return };
            let resting = (self.island.inputs == Rest::Zero).then_some(&self.resting[0]);
            self.shared.lose(why, resting);
            // An island that comes and goes is not contacted more often than one that is gone.
            if begin.elapsed() > MAX_RECONNECT_PAUSE {
                pause = FIRST_RECONNECT_PAUSE;
            }
            self.sleep_until(Instant::now() + pause);
            pause = (2 * pause).min(MAX_RECONNECT_PAUSE);
        }
    }

    /// Connects, and exchanges until the thread is to stop.
    fn visit(&mut self) -> Result<(), String> {
        let mut link = IslandLink::open(self.island.address, self.island.unit, self.island.timeout)?;
        let mut next = Instant::now();
        while !self.shared.stops() {
            if let Some(cycle) = self.shared.take_outputs(&mut self.outputs) {
                self.write(&mut link)?;
                self.shared.wrote(cycle);
            }
            for run in &self.plan.reads {
                client::read_request(&mut self.request, run.table, run.start, run.count);
                let answer = link.ask(&self.request).map_err(|why| about(run, &why))?;
                let function = self.request.first().copied().unwrap_or_default();
                let data = client::read_answer(run.table, function, run.count.into(), answer);
                run.take(data.map_err(|refusal| refused(run, refusal))?, &mut self.inputs);
            }
            self.shared.bring_inputs(&self.inputs);
            // A delayed exchange does not make the next ones follow faster.
            next = (next + self.island.poll).max(Instant::now());
            self.sleep_until(next);
        }
        if self.shared.take_outputs(&mut self.outputs).is_some() {
            if self.island.end == Rest::Zero {
                self.outputs.copy_from(&self.resting[1]);
            }
            self.write(&mut link)?;
        }
        Ok(())
    }

    fn write(&mut self, link: &mut IslandLink) -> Result<(), String> {
        for run in &self.plan.writes {
            let data = client::write_request(&mut self.request, run.table, run.start, run.count);
            run.put(&self.outputs, data);
            let answer = link.ask(&self.request).map_err(|why| about(run, &why))?;
            client::write_answer(&self.request, answer).map_err(|refusal| refused(run, refusal))?;
        }
        Ok(())
    }

    /// Sleeps, unless the thread is to stop.
    fn sleep_until(&self, end: Instant) {
        while !self.shared.stops()
            && let Some(remaining) = end.checked_duration_since(Instant::now()).filter(|remaining| !remaining.is_zero())
        {
            std::thread::park_timeout(remaining);
        }
    }
}

fn about(run: &SignalRange, why: &str) -> String {
    format!("{why} (it was asked for {})", run.describe())
}

fn refused(run: &SignalRange, refusal: Refusal) -> String {
    match refusal {
        Refusal::Exception(code) => {
            format!("it refuses {} with exception {code}: {}", run.describe(), client::exception(code))
        }
        Refusal::Garbage => about(run, "what it sends is not a Modbus TCP response"),
    }
}
