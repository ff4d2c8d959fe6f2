//! Checks that the numbers of a program's operations are within its tables, so that running it needs no more checks.
//!
//! The number of an element may be known only when the program runs: operations of the program check it. Code that was
//! made without them panics there, and reaches nothing outside its tables.

use crate::code::{Code, Function, Piece, Taken};
use crate::layout::Extent;
use crate::op::{Address, Op};
use crate::place::{Place, Space, ValueType};

/// The most words, strings or handles of a frame or of the global variables.
const MOST: u32 = 1 << 24;

/// Whether all numbers of the program are within its tables.
pub(crate) fn is_sound(code: &Code) -> bool {
    let functions = code.functions.len() as u32;
    let mut starts: Vec<Address> = code.functions.iter().map(|function| function.start).collect();
    starts.sort_unstable();
    starts.dedup();
    let files = code.files.len();
    code.main < functions
        && !code.files.is_empty()
        && code.first_values.iter().all(|number| *number < functions)
        && code.functions.iter().all(|function| usize::from(function.file) < files)
        && code.variables.iter().all(|variable| usize::from(variable.file) < files && code.has(&variable.place, None))
        && code.handles.len() == code.globals.handles as usize
        && code.types.iter().chain(code.variables.iter().map(|variable| &variable.ty)).all(is_small)
        && code.locals.iter().all(|local| is_small(&local.ty))
        && is_possible(&code.globals)
        && code.boxes.iter().all(is_possible)
        && code.functions.iter().all(|function| is_possible(&function.frame))
        && code.functions.iter().all(|function| {
            let next = starts.partition_point(|start| *start <= function.start);
            let end = starts.get(next).copied().unwrap_or(code.ops.len() as Address);
            let ops = code.ops.get(function.start as usize..end as usize);
            ops.is_some_and(|ops| {
                ops.last().is_some_and(leaves)
                    && ops.iter().all(|op| code.is_sound_in(op, function, function.start..end))
            })
        })
}

/// Whether there is memory for so much.
fn is_possible(extent: &Extent) -> bool {
    let Extent { words, texts, handles } = *extent;
    [words, texts, handles].iter().all(|count| *count <= MOST)
}

/// Whether there is memory for a value of a type.
fn is_small(ty: &ValueType) -> bool {
    let count = ty.sizes.iter().try_fold(1_usize, |count, size| count.checked_mul(*size));
    count.is_some_and(|count| count <= MOST as usize)
}

/// Whether the operation behind this one never follows it.
fn leaves(op: &Op) -> bool {
    use Op::*;
    matches!(op, Jump { .. } | Return | ReturnWord { .. } | ReturnText { .. } | Exit | Restart)
}

impl Code {
    /// Whether a place exists: in a function's frame, or outside functions.
    fn has(&self, place: &Place, function: Option<&Function>) -> bool {
        let within =
            |extent: Extent| place.word <= extent.words && place.text <= extent.texts && place.handle <= extent.handles;
        match place.space {
            Space::Nowhere | Space::Register(_) | Space::System(_) => true,
            Space::Frame => function.is_some_and(|function| within(function.frame)),
            Space::Global => within(self.globals),
            Space::Constant => place.word as usize <= self.words.len() && place.text as usize <= self.texts.len(),
            Space::Boxed(number) => function.is_some_and(|function| number < function.boxes),
        }
    }

    fn has_piece(&self, piece: &Piece, function: &Function) -> bool {
        let Some(own) = self.functions.get(piece.function as usize) else { return false };
        piece.taken.iter().all(|taken| match taken {
            Taken::Value(transfer) => {
                let (from, to) = (self.has(&transfer.from, Some(function)), self.has(&transfer.to, Some(own)));
                from && to && is_possible(&transfer.extent)
            }
            Taken::Boxed { from, to } => *from < function.boxes && *to < own.boxes,
            Taken::Handle { from, to, count } => {
                let within = |at: &u32, all: u32| at.checked_add(*count).is_some_and(|end| end <= all);
                within(from, function.frame.handles) && within(to, own.frame.handles)
            }
        })
    }

    /// Whether the numbers of an operation are within the tables, the frame of its function, and the function itself.
    #[expect(clippy::too_many_lines, reason = "one arm for each operation, so that none is forgotten")]
    fn is_sound_in(&self, op: &Op, function: &Function, own: std::ops::Range<Address>) -> bool {
        use Op::*;
        let (frame, globals) = (function.frame, self.globals);
        let words = |at: u32, count: u32| at.checked_add(count).is_some_and(|end| end <= frame.words);
        let handles = |at: u32, count: u32| at.checked_add(count).is_some_and(|end| end <= frame.handles);
        let text = |at: u16| u32::from(at) < frame.texts;
        let global = |at: u32, count: u32| at.checked_add(count).is_some_and(|end| end <= globals.words);
        let constant = |at: u32, count: u32| at as usize + count as usize <= self.words.len();
        let has = |place: &Place| self.has(place, Some(function));
        match *op {
            Word { at, .. } => constant(at, 1),
            Jump { to }
            | JumpIf { to, .. }
            | JumpUnless { to, .. }
            | JumpLess { to, .. }
            | JumpLessEqual { to, .. }
            | JumpEqual { to, .. }
            | JumpNotEqual { to, .. }
            | JumpLessSmall { to, .. }
            | JumpNotLessSmall { to, .. }
            | JumpEqualSmall { to, .. }
            | JumpNotEqualSmall { to, .. }
            | StepLess { to, .. }
            | StepLessSmall { to, .. }
            | JumpCompare { to, .. } => own.contains(&to),
            Take { again } | Leave { again } => own.contains(&again),
            Load { at, .. } | Store { at, .. } => words(at, 1),
            LoadElement { at, .. } | StoreElement { at, .. } => words(at, 0),
            LoadChecked { at, size, .. } | StoreChecked { at, size, .. } => size > 0 && words(at, size.into()),
            LoadGlobal { at, .. } | StoreGlobal { at, .. } => global(at, 1),
            LoadGlobalElement { at, .. } | StoreGlobalElement { at, .. } => global(at, 0),
            LoadGlobalChecked { at, size, .. } | StoreGlobalChecked { at, size, .. } => {
                size > 0 && global(at, size.into())
            }
            LoadBoxed { from, .. } => from < function.boxes,
            StoreBoxed { to, .. } => to < function.boxes,
            CopyWords { to, from, count } => words(to, count.into()) && words(from, count.into()),
            CopyFromGlobal { to, from, count } => words(to, count.into()) && global(from, count.into()),
            CopyToGlobal { to, from, count } => global(to, count.into()) && words(from, count.into()),
            CopyElement { to, from, count, .. } => words(to, count.into()) && words(from, 0),
            CopyToElement { to, from, count, .. } => words(to, 0) && words(from, count.into()),
            CopyGlobalElement { to, from, count, .. } => words(to, count.into()) && global(from, 0),
            CopyToGlobalElement { to, from, count, .. } => global(to, 0) && words(from, count.into()),
            CopyConstants { to, from, count } => words(to, count.into()) && constant(from, count.into()),
            Clear { at, count } => words(at, count),
            Transfer { transfer } => {
                let is_sound = |it: &crate::Transfer| has(&it.from) && has(&it.to) && is_possible(&it.extent);
                self.transfers.get(transfer as usize).is_some_and(is_sound)
            }
            Text { to, at } => text(to) && (at as usize) < self.texts.len(),
            CopyText { to, from } => text(to) && text(from),
            LoadText { to, at, .. } => text(to) && at <= frame.texts,
            StoreText { from, at, .. } => text(from) && at <= frame.texts,
            LoadGlobalText { to, at } => text(to) && at < globals.texts,
            StoreGlobalText { from, at } => text(from) && at < globals.texts,
            Join { to, right } => text(to) && text(right),
            CheckLength { of, .. } => text(of),
            Append { to, more, .. } => text(to) && text(more),
            AppendGlobal { to, more, .. } => to < globals.texts && text(more),
            CompareTexts { left, right, .. } => text(left) && text(right),
            ClearTexts { at, count } => at.checked_add(count).is_some_and(|end| end <= frame.texts),
            NewHandles { at, count, .. } => handles(at, count.into()),
            DropHandles { at, count } => handles(at, count),
            Show { local } => self.locals.get(local as usize).is_some_and(|local| has(&local.place)),
            DropBox { at } => at < function.boxes,
            NewBox { to, extent } => to < function.boxes && (extent as usize) < self.boxes.len(),
            Call { call } => self.calls.get(call as usize).is_some_and(|call| {
                let at = call.at;
                (call.function as usize) < self.functions.len()
                    && at.words <= frame.words
                    && at.texts <= frame.texts
                    && at.handles <= frame.handles
            }),
            ReturnText { from } => text(from) && frame.texts > 0,
            BuiltIn { site } | Await { site } | Above { site } => self.sites.get(site as usize).is_some_and(|site| {
                site.args.iter().all(|arg| usize::from(arg.ty) < self.types.len() && has(&arg.place))
                    && has(&site.result)
            }),
            Event { event } => self.events.get(event as usize).is_some_and(|event| {
                let args = &event.site.args;
                args.iter().all(|arg| usize::from(arg.ty) < self.types.len() && has(&arg.place))
                    && event.condition.iter().chain([&event.action]).all(|piece| self.has_piece(piece, function))
            }),
            Enter { entry, .. } => self.entries.get(entry as usize).is_some_and(|entry| entry.texts.iter().all(has)),
            Copy { .. }
            | Small { .. }
            | AddInt { .. }
            | SubInt { .. }
            | MulInt { .. }
            | AddSmall { .. }
            | MulSmall { .. }
            | MulAdd { .. }
            | DivInt { .. }
            | RemInt { .. }
            | DivUint { .. }
            | RemUint { .. }
            | And { .. }
            | Or { .. }
            | Xor { .. }
            | AndSmall { .. }
            | OrSmall { .. }
            | XorSmall { .. }
            | ShiftLeft { .. }
            | ShiftRight { .. }
            | ShiftLeftSmall { .. }
            | ShiftRightSmall { .. }
            | NegInt { .. }
            | NotInt { .. }
            | ToByte { .. }
            | AddDouble { .. }
            | SubDouble { .. }
            | MulDouble { .. }
            | DivDouble { .. }
            | RemDouble { .. }
            | NegDouble { .. }
            | IntToDouble { .. }
            | UintToDouble { .. }
            | NotBool { .. }
            | IsSet { .. }
            | IsSetDouble { .. }
            | Compare { .. }
            | Return
            | ReturnWord { .. }
            | Line { .. }
            | Sink { .. }
            | StayAbove
            | Wait { .. }
            | IsLate { .. }
            | GoesOn
            | NextCycle
            | Change
            | Spend { .. }
            | Charge { .. }
            | Exit
            | Restart
            | Open { .. }
            | Halt { .. } => true,
            Index { size, .. } => size > 0,
            Index2 { rows, columns, .. } => rows > 0 && columns > 0,
            DivSmall { value, .. } | RemSmall { value, .. } => value != 0,
        }
    }
}
