//! What a debugger sees of a running program, in code that was made for one.

use crate::engine::{Engine, shown_sizes};
use crate::frame::{Boxed, State};
use crate::handles::{Handle, ShownHandles, damaged};
use crate::intern::intern;
use crate::teach::Variable;
use arl_code::{Address, Local, Op, Place, Space};
use arl_lang::catalog::Base;
use arl_rt::emit::{Cx, Done, FunctionFrame, Rc};
use std::future::poll_fn;
use std::pin::pin;
use std::task::Poll;

/// The frames of running functions, each with the number of functions that wait for it. Other code has none.
#[derive(Default)]
pub(crate) struct Frames<'a>(Vec<(usize, FunctionFrame<'a>)>);

impl<'a> Frames<'a> {
    /// Enters a function that so many wait for.
    pub(crate) fn enter(&mut self, depth: usize, frame: FunctionFrame<'a>) {
        self.0.push((depth, frame));
    }

    /// Leaves the functions that so many or more wait for.
    pub(crate) fn leave(&mut self, depth: usize) {
        while self.0.last().is_some_and(|(own, _)| *own >= depth) {
            self.0.pop();
        }
    }

    /// The running function.
    pub(crate) fn last(&self) -> Option<&FunctionFrame<'a>> {
        self.0.last().map(|(_, frame)| frame)
    }

    /// Waits, unless the program pointer is set in one of the functions meanwhile.
    pub(crate) async fn unless_moved<T>(&self, waiting: impl Future<Output = T>) -> Option<T> {
        let mut waiting = pin!(waiting);
        let is_moved = || self.0.iter().any(|(_, frame)| frame.is_moved());
        poll_fn(|context| {
            if is_moved() {
                return Poll::Ready(None);
            }
            match waiting.as_mut().poll(context) {
                Poll::Pending if is_moved() => Poll::Ready(None),
                other => other.map(Some),
            }
        })
        .await
    }
}

impl Engine {
    /// The frame of the function that begins, or of the action of an event.
    pub(crate) fn open<'a>(&self, cx: &'a Cx, state: &State, line: u32, is_action: bool) -> FunctionFrame<'a> {
        let number = state.position.function;
        let file = self.file_of(number);
        if is_action {
            return cx.action(file, line);
        }
        let name = self.code.functions.get(number).map_or("", |function| intern(&function.name));
        cx.frame(name, file, line)
    }

    /// Shows a local variable; `None` if the code is damaged.
    pub(crate) fn show(&self, state: &mut State, frame: &FunctionFrame<'_>, local: u32) -> Option<()> {
        let local = self.code.locals.get(local as usize)?;
        let (number, name, sizes) = (local.number as usize, intern(&local.name), shown_sizes(&local.ty));
        if let Space::Boxed(at) = local.place.space {
            let boxed = state.boxes.get(state.position.boxed + usize::from(at))?.as_ref()?;
            let (words, texts) = (Rc::clone(&boxed.words), Rc::clone(&boxed.texts));
            let (place, ty, family) = (Place::start(Space::Boxed(at)), local.ty.clone(), self.code.family);
            let variable = Rc::new(Variable { words, texts, place, ty, family });
            frame.variable(number, name, sizes, &variable);
            boxed.shown.replace(Some(variable));
            return Some(());
        }
        let own = handles_of(state, local)?;
        let first = own.iter().flatten().next()?;
        if local.ty.is_array() {
            let all = Rc::new(ShownHandles::new(own.iter().flatten(), true));
            frame.handle(number, name, sizes, &all);
            first.shown.replace(Some(all));
        } else {
            frame.handle(number, name, sizes, first);
        }
        Some(())
    }

    /// Goes on where the program pointer was set to. Variables whose declarations are jumped over get their start
    /// values, those that are not visible there end.
    pub(crate) fn go_to_pointer(&self, state: &mut State, frames: &mut Frames<'_>) -> Done<()> {
        let found = frames.0.iter().find_map(|(depth, frame)| Some((*depth, frame.moved_to()?)));
        let Some((depth, line)) = found else { return Ok(()) };
        frames.leave(depth + 1);
        while state.callers.len() > depth {
            let Some(function) = self.code.functions.get(state.position.function) else { break };
            state.leave(function);
        }
        let Some(at) = self.halt_of(state.position.function, line) else {
            return Err(self.alarm(state, damaged(), line));
        };
        state.position.at = at as usize;
        let own = self.range_of(state.position.function);
        let ahead = self.code.ops.get(at as usize..own.end as usize).unwrap_or_default();
        if ahead.iter().any(|op| matches!(op, Op::Enter { .. })) {
            state.leave_nesting();
        }
        for (number, local) in (0..).zip(&self.code.locals).filter(|(_, local)| own.contains(&local.scope.start)) {
            if !local.scope.contains(&at) {
                drop_local(state, local);
            } else if self.begin_local(state, local)
                && let Some(frame) = frames.last()
            {
                self.show(state, frame, number);
            }
        }
        Ok(())
    }

    /// Gives a variable its start value, if it does not exist.
    fn begin_local(&self, state: &mut State, local: &Local) -> bool {
        if let Space::Boxed(at) = local.place.space {
            let Some(slot) = state.boxes.get_mut(state.position.boxed + usize::from(at)) else { return false };
            if slot.is_some() {
                return false;
            }
            *slot = Some(Rc::new(Boxed::with_start_value(&local.ty, self.code.family)));
            return true;
        }
        let Base::Handle(handle) = local.ty.base else { return false };
        let Some(own) = handles_of(state, local) else { return false };
        let is_missing = own.iter().any(Option::is_none);
        for slot in own.iter_mut().filter(|slot| slot.is_none()) {
            *slot = Some(Rc::new(Handle::new(handle.into())));
        }
        is_missing
    }

    /// The operations of a function.
    fn range_of(&self, function: usize) -> std::ops::Range<Address> {
        let start = self.code.functions.get(function).map_or(0, |function| function.start);
        let starts = self.code.functions.iter().map(|function| function.start);
        let end = starts.filter(|other| *other > start).min().unwrap_or(self.code.ops.len() as Address);
        start..end
    }

    /// Where the first statement of a line begins.
    fn halt_of(&self, function: usize, line: u32) -> Option<Address> {
        let is_it =
            |at: &Address| matches!(self.code.ops.get(*at as usize), Some(Op::Halt { line: own }) if *own == line);
        self.range_of(function).find(is_it)
    }
}

/// The handles of a variable.
fn handles_of<'a>(state: &'a mut State, local: &Local) -> Option<&'a mut [Option<Rc<Handle>>]> {
    let at = state.position.handle + local.place.handle as usize;
    state.handles.get_mut(at..at + local.ty.count())
}

/// Ends a variable.
fn drop_local(state: &mut State, local: &Local) {
    if let Space::Boxed(at) = local.place.space {
        if let Some(slot) = state.boxes.get_mut(state.position.boxed + usize::from(at)) {
            *slot = None;
        }
    } else if let Some(own) = handles_of(state, local) {
        own.fill(None);
    }
}
