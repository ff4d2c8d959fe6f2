//! Running functions: the one `async` function of the engine.

use crate::adapters;
use crate::args::Args;
use crate::engine::Engine;
use crate::exec::Exit;
use crate::frame::State;
use crate::handles::damaged;
use crate::watching::Frames;
use arl_rt::emit::{At, Called, Cx, Done, Fault, Stop, flow};

impl Engine {
    /// Runs a function from its beginning.
    pub(crate) async fn run_function(&self, cx: &Cx, number: usize) -> Done<()> {
        let mut state = self.take_state();
        let Some(function) = self.code.functions.get(number) else { return Err(damaged()).at(self.file_of(0), 0) };
        state.begin(number, function);
        let result = self.run(cx, &mut state).await;
        self.give_back(state);
        result.map(|_| ())
    }

    /// Runs until the first function returns; returns its first register.
    pub(crate) async fn run(&self, cx: &Cx, state: &mut State) -> Done<u64> {
        let mut frames = Frames::default();
        loop {
            let exit = self.execute(state, cx)?;
            frames.leave(state.callers.len() + 1);
            match exit {
                Exit::Returned(word) => return Ok(word),
                Exit::Closed => {}
                Exit::Open { line, is_action } => {
                    let depth = state.callers.len();
                    frames.leave(depth);
                    frames.enter(depth, self.open(cx, state, line, is_action));
                }
                Exit::Show(local) => {
                    let shown = frames.last().and_then(|frame| self.show(state, frame, local));
                    shown.ok_or_else(|| self.alarm(state, damaged(), 0))?;
                }
                Exit::Halt(line) => {
                    let Some(frame) = frames.last() else { return Err(self.alarm(state, damaged(), line)) };
                    let runs = frame.runs(line);
                    if frames.unless_moved(runs).await.is_none() {
                        self.go_to_pointer(state, &mut frames)?;
                    }
                }
                waits => match frames.unless_moved(self.wait(cx, state, waits)).await {
                    Some(done) => done?,
                    None => self.go_to_pointer(state, &mut frames)?,
                },
            }
        }
    }

    /// Does what takes time.
    async fn wait(&self, cx: &Cx, state: &mut State, exit: Exit) -> Done<()> {
        match exit {
            Exit::NextCycle => cx.next_cycle().await,
            Exit::Change => cx.change().await,
            Exit::Wait { to, limit, line } => {
                let wait = flow::waituntil(cx);
                let wait = match limit {
                    Some(seconds) => wait.maxtime(seconds).start().await,
                    None => wait.start().await,
                };
                let over = wait.map_err(|fault| self.alarm(state, fault, line))?.over();
                let at = state.position.register + usize::from(to);
                if let Some(register) = state.registers.get_mut(at) {
                    *register = over.unwrap_or(u64::MAX);
                }
            }
            Exit::Await(site) => {
                let Some(site) = self.code.sites.get(site) else { return Err(self.alarm(state, damaged(), 0)) };
                let done = match state.reach(self, cx) {
                    Some(reach) => {
                        let mut args = Args { reach, site };
                        adapters::call(cx, &mut args).await
                    }
                    None => Err(damaged()),
                };
                done.map_err(|fault| self.alarm(state, fault, site.line))?;
            }
            Exit::Above(site) => {
                let Some(site) = self.code.sites.get(site) else { return Err(self.alarm(state, damaged(), 0)) };
                let jump = match state.reach(self, cx) {
                    Some(reach) => adapters::jump(&mut Args { reach, site }),
                    None => Err(damaged()),
                };
                let above = match jump {
                    Ok(jump) => jump.above(cx).await,
                    Err(fault) => Err(fault),
                };
                state.above = Some(above.map_err(|fault| self.alarm(state, fault, site.line))?);
            }
            Exit::Sink(line) => {
                if let Some(above) = state.above.take() {
                    above.sink(cx).await.map_err(|fault| self.alarm(state, fault, line))?;
                }
            }
            Exit::Returned(_) | Exit::Closed | Exit::Open { .. } | Exit::Halt(_) | Exit::Show(_) => {}
        }
        Ok(())
    }

    /// A fault as an alarm, with the calls that led there.
    #[cold]
    pub(crate) fn alarm(&self, state: &State, fault: Fault, line: u32) -> Stop {
        let mut result: Done<()> = Err(fault).at(self.file_of(state.position.function), line);
        for caller in state.callers.iter().rev() {
            result = result.called(self.file_of(caller.position.function), caller.line);
        }
        match result {
            Err(stop) => stop,
            Ok(()) => Stop::exit(),
        }
    }
}
