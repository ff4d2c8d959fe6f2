//! Interrupts, timers and triggers.

use crate::args::Args;
use crate::engine::Engine;
use crate::frame::{Boxed, State};
use crate::handles::{Handle, damaged};
use crate::reach::Reach;
use arl_code::{Arg, Event, Piece, Place, Space, Taken, Target};
use arl_lang::catalog::{Entry, all_entries};
use arl_rt::emit::{At, Cx, Done, Fault, Rc, Str, event};

/// What a piece of an event takes along.
struct Captured {
    function: usize,
    words: Vec<(Place, Vec<u64>)>,
    texts: Vec<(Place, Str)>,
    boxes: Vec<(u16, Rc<Boxed>)>,
    handles: Vec<(u32, Rc<Handle>)>,
    line: u32,
}

impl Captured {
    fn new(piece: &Piece, line: u32, reach: &Reach<'_>) -> Result<Self, Fault> {
        let mut captured = Self {
            function: piece.function as usize,
            words: Vec::new(),
            texts: Vec::new(),
            boxes: Vec::new(),
            handles: Vec::new(),
            line,
        };
        for taken in &piece.taken {
            match taken {
                Taken::Value(transfer) => {
                    if transfer.extent.words > 0 {
                        let mut words = vec![0; transfer.extent.words as usize];
                        reach.read_words(&transfer.from, &mut words)?;
                        captured.words.push((transfer.to, words));
                    }
                    for number in 0..transfer.extent.texts {
                        let step = arl_code::Extent { texts: number, ..Default::default() };
                        let text = reach.text(&transfer.from.after(step))?.into_owned();
                        captured.texts.push((transfer.to.after(step), text));
                    }
                }
                Taken::Boxed { from, to } => {
                    let shared = reach.boxes.get(usize::from(*from)).and_then(Option::as_ref).ok_or_else(damaged)?;
                    captured.boxes.push((*to, Rc::clone(shared)));
                }
                Taken::Handle { from, to, count } => {
                    for number in 0..*count {
                        let place = Place { handle: from + number, ..Place::start(Space::Frame) };
                        captured.handles.push((to + number, reach.handle(&place)?));
                    }
                }
            }
        }
        Ok(captured)
    }

    /// A state in which the piece can run.
    fn state(&self, engine: &Engine) -> Result<State, Fault> {
        let function = engine.code.functions.get(self.function).ok_or_else(damaged)?;
        let mut state = engine.take_state();
        state.begin(self.function, function);
        for (place, words) in &self.words {
            let to = match place.space {
                Space::Register(register) => state.registers.get_mut(usize::from(register)..usize::from(register) + 1),
                _ => state.words.get_mut(place.word as usize..place.word as usize + words.len()),
            };
            to.ok_or_else(damaged)?.copy_from_slice(words);
        }
        for (place, text) in &self.texts {
            *state.texts.get_mut(place.text as usize).ok_or_else(damaged)? = text.clone();
        }
        for (at, shared) in &self.boxes {
            *state.boxes.get_mut(usize::from(*at)).ok_or_else(damaged)? = Some(Rc::clone(shared));
        }
        for (at, handle) in &self.handles {
            *state.handles.get_mut(*at as usize).ok_or_else(damaged)? = Some(Rc::clone(handle));
        }
        Ok(state)
    }

    /// Runs the piece; returns its first register.
    async fn run(&self, cx: &Cx) -> Done<u64> {
        let engine: &Engine = cx.globals().at(arl_rt::emit::File::new(""), self.line)?;
        let mut state = self.state(engine).at(engine.file_of(self.function), self.line)?;
        let result = engine.run(cx, &mut state).await;
        engine.give_back(state);
        result
    }
}

impl Engine {
    /// Declares an event.
    ///
    /// # Errors
    /// The name is taken, the priority is not valid, there are too many events; the alarm of the condition.
    pub(crate) fn declare(&self, cx: &Cx, declared: &Event, reach: Reach<'_>) -> Result<(), Fault> {
        // The condition is evaluated at once, on the stack of this function.
        cx.has_stack()?;
        let line = declared.site.line;
        let condition = declared.condition.as_ref().map(|piece| Captured::new(piece, line, &reach)).transpose()?;
        let action = Captured::new(&declared.action, line, &reach)?;
        let action = async move |cx: &Cx| action.run(cx).await.map(|_| ());
        let args = Args { reach, site: &declared.site };
        let Target::Entry(number) = declared.site.target else { return Err(damaged()) };
        let entry = all_entries().get(usize::from(number)).ok_or_else(damaged)?;
        let number_of = |name: &str| args.site.args.iter().position(|arg| is_named(entry, arg, name));
        let name = number_of("name").map(|at| args.text(at)).transpose()?;
        let priority = number_of("priority").map(|at| args.get::<i32>(at)).transpose()?;
        match entry.path {
            "event::interrupt" => {
                let condition = condition.ok_or_else(damaged)?;
                let mut event = event::interrupt(async move |cx: &Cx| Ok(condition.run(cx).await? != 0), action);
                if let Some(name) = &name {
                    event = event.name(name);
                }
                if let Some(priority) = priority {
                    event = event.priority(priority);
                }
                event.run(cx)
            }
            "event::timer" => {
                let interval = args.get(number_of("interval").ok_or_else(damaged)?)?;
                let mut event = event::timer(interval, action);
                if let Some(name) = &name {
                    event = event.name(name);
                }
                if let Some(priority) = priority {
                    event = event.priority(priority);
                }
                if let Some(at) = number_of("rmode") {
                    event = event.rmode(args.get(at)?);
                }
                event.run(cx)
            }
            "event::trigger" => {
                let condition = condition.ok_or_else(damaged)?;
                let mut event = event::trigger(async move |cx: &Cx| Ok(condition.run(cx).await? != 0), action);
                if let Some(priority) = priority {
                    event = event.priority(priority);
                }
                event.run(cx)
            }
            _ => Err(damaged()),
        }
    }
}

/// Whether an argument is that of the parameter with this name.
fn is_named(entry: &Entry, arg: &Arg, name: &str) -> bool {
    entry.params.get(usize::from(arg.param)).is_some_and(|param| param.rust == name)
}
