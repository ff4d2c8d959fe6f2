//! The frames of running functions.

use crate::engine::Engine;
use crate::handles::Handle;
use crate::reach::Reach;
use crate::teach::Variable;
use arl_code::{Call, Extent, Function, ValueType, start_words};
use arl_lang::catalog::Family;
use arl_rt::emit::{Cell, Cx, Entered, Nesting, Rc, Str};
use std::cell::RefCell;

/// How many registers a function has.
pub(crate) const REGISTERS: usize = 256;

/// A variable that events see.
pub(crate) struct Boxed {
    pub(crate) words: Rc<[Cell<u64>]>,
    pub(crate) texts: Rc<[RefCell<Str>]>,
    /// The variable as a debugger sees it.
    pub(crate) shown: RefCell<Option<Rc<Variable>>>,
}

impl Boxed {
    pub(crate) fn new(extent: Extent) -> Self {
        Self {
            words: (0..extent.words).map(|_| Cell::new(0)).collect(),
            texts: (0..extent.texts).map(|_| RefCell::default()).collect(),
            shown: RefCell::default(),
        }
    }

    /// A variable with its start value.
    pub(crate) fn with_start_value(ty: &ValueType, family: Family) -> Self {
        let count = ty.count();
        let boxed = Self::new(Extent::of(ty.base, family).times(u32::try_from(count).unwrap_or(u32::MAX)));
        let mut one = Vec::new();
        start_words(ty.base, family, &mut one);
        boxed.words.iter().zip(one.iter().cycle()).for_each(|(word, start)| word.set(*start));
        boxed
    }
}

/// Where a function runs: its next operation, and where its frame begins.
#[derive(Clone, Copy, Default, Debug)]
pub(crate) struct Position {
    pub(crate) at: usize,
    pub(crate) function: usize,
    pub(crate) register: usize,
    pub(crate) word: usize,
    pub(crate) text: usize,
    pub(crate) handle: usize,
    pub(crate) boxed: usize,
}

/// A function that waits for another one to return.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Caller {
    pub(crate) position: Position,
    /// The line of the call.
    pub(crate) line: u32,
}

/// A call of a function that may call itself.
pub(crate) struct NestedCall {
    /// How many functions wait for it.
    pub(crate) depth: usize,
    pub(crate) _entered: Entered<Rc<Nesting>>,
}

/// The frames of the functions of one thread of execution: a program, a condition, an action.
#[derive(Default)]
pub(crate) struct State {
    pub(crate) registers: Vec<u64>,
    pub(crate) words: Vec<u64>,
    pub(crate) texts: Vec<Str>,
    pub(crate) handles: Vec<Option<Rc<Handle>>>,
    pub(crate) boxes: Vec<Option<Rc<Boxed>>>,
    pub(crate) callers: Vec<Caller>,
    pub(crate) position: Position,
    pub(crate) nested: Vec<NestedCall>,
    /// Words on their way from place to place.
    pub(crate) passing: Vec<u64>,
    /// The `jump` that waits above its target.
    pub(crate) above: Option<crate::args::Above>,
}

impl State {
    /// Makes the state ready for a function. What it had is kept, so that nothing is allocated again.
    pub(crate) fn begin(&mut self, number: usize, function: &Function) {
        self.callers.clear();
        self.nested.clear();
        self.above = None;
        self.position = Position { at: function.start as usize, function: number, ..Position::default() };
        self.make_room(function);
    }

    /// Lets go of what others could wait for: variables of events, connections.
    pub(crate) fn end(&mut self) {
        self.nested.clear();
        self.handles.iter_mut().for_each(|handle| *handle = None);
        self.boxes.iter_mut().for_each(|shared| *shared = None);
        self.above = None;
    }

    /// Makes room for the frame of the function at the current position.
    #[inline]
    pub(crate) fn make_room(&mut self, function: &Function) {
        let (position, frame) = (&self.position, &function.frame);
        let is_there = position.register + REGISTERS <= self.registers.len()
            && position.word + frame.words as usize <= self.words.len()
            && position.text + frame.texts as usize <= self.texts.len()
            && position.handle + frame.handles as usize <= self.handles.len()
            && position.boxed + usize::from(function.boxes) <= self.boxes.len();
        if !is_there {
            self.grow(function);
        }
    }

    #[cold]
    fn grow(&mut self, function: &Function) {
        fn grow<T: Clone>(row: &mut Vec<T>, needed: usize, filler: T) {
            if row.len() < needed {
                row.resize(needed.next_power_of_two(), filler);
            }
        }
        let position = &self.position;
        grow(&mut self.registers, position.register + REGISTERS, 0);
        grow(&mut self.words, position.word + function.frame.words as usize, 0);
        grow(&mut self.texts, position.text + function.frame.texts as usize, Str::new());
        grow(&mut self.handles, position.handle + function.frame.handles as usize, None);
        grow(&mut self.boxes, position.boxed + usize::from(function.boxes), None);
    }

    /// Enters a function. Not a part of the loop over the operations, which is slower the larger it is.
    #[inline(never)]
    pub(crate) fn call(&mut self, call: &Call, function: &Function, back: usize) {
        let caller = Position { at: back, ..self.position };
        self.callers.push(Caller { position: caller, line: call.line });
        let here = &mut self.position;
        here.at = function.start as usize;
        here.function = call.function as usize;
        here.register += usize::from(call.register);
        here.word += call.at.words as usize;
        here.text += call.at.texts as usize;
        here.handle += call.at.handles as usize;
        here.boxed += usize::from(call.boxes);
        self.make_room(function);
    }

    /// The running function is about to ask for room for another call again, or ends.
    pub(crate) fn leave_nesting(&mut self) {
        if self.nested.last().is_some_and(|call| call.depth == self.callers.len()) {
            self.nested.pop();
        }
    }

    /// Leaves a function; `false` if it was the first one.
    #[inline(never)]
    pub(crate) fn leave(&mut self, function: &Function) -> bool {
        self.leave_nesting();
        // What the function shared with its events is theirs alone from now on, and so are its connections.
        let here = &self.position;
        if function.boxes > 0 {
            let boxes = here.boxed..here.boxed + usize::from(function.boxes);
            self.boxes.get_mut(boxes).into_iter().flatten().for_each(|one| *one = None);
        }
        if function.frame.handles > 0 {
            let handles = here.handle..here.handle + function.frame.handles as usize;
            self.handles.get_mut(handles).into_iter().flatten().for_each(|one| *one = None);
        }
        let Some(caller) = self.callers.pop() else { return false };
        self.position = caller.position;
        true
    }
}

impl State {
    /// What the running function can reach; `None` if the code is damaged.
    pub(crate) fn reach<'a>(&'a mut self, engine: &'a Engine, cx: &'a Cx) -> Option<Reach<'a>> {
        let position = self.position;
        let registers = self.registers.get_mut(position.register..position.register + REGISTERS)?;
        Some(Reach {
            engine,
            cx,
            registers: registers.try_into().ok()?,
            words: self.words.get_mut(position.word..)?,
            texts: self.texts.get_mut(position.text..)?,
            handles: self.handles.get_mut(position.handle..)?,
            boxes: self.boxes.get(position.boxed..)?,
        })
    }
}
