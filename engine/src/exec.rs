//! The loop over the operations: a plain function that leaves at an operation that waits.
//!
//! A function sees its 256 registers as an array, which a register's number of 8 bits cannot leave: reading one needs
//! no check.

use crate::adapters;
use crate::args::Args;
use crate::engine::Engine;
use crate::frame::{Boxed, NestedCall, REGISTERS, State};
use crate::handles::{Handle, damaged};
use crate::reach::Reach;
use arl_code::{ChargeStep, Charging, Comparison, Entry, Op, Reg, Shifted};
use arl_rt::emit::{
    Cell, Cx, Done, Fault, Rc, Stop, append, div, fits, index, index2, rem, rem_double, shl, shr, steps,
};

/// Why the loop was left.
pub(crate) enum Exit {
    /// The first function has returned, with this word in its first register.
    Returned(u64),
    NextCycle,
    Change,
    Wait {
        to: Reg,
        limit: Option<f64>,
        line: u32,
    },
    Await(usize),
    Above(usize),
    Sink(u32),
    /// A function has returned, in code for a debugger.
    Closed,
    /// A function begins, or the action of an event.
    Open {
        line: u32,
        is_action: bool,
    },
    /// The program may be halted.
    Halt(u32),
    /// A local variable is there.
    Show(u32),
}

#[inline]
fn int(word: u64) -> i32 {
    word as u32 as i32
}

#[inline]
fn word(value: i32) -> u64 {
    u64::from(value as u32)
}

#[inline]
fn double(word: u64) -> f64 {
    f64::from_bits(word)
}

#[inline]
fn holds(by: Comparison, left: u64, right: u64) -> bool {
    match by {
        Comparison::LessInt => int(left) < int(right),
        Comparison::LessEqualInt => int(left) <= int(right),
        Comparison::LessUint => (left as u32) < right as u32,
        Comparison::LessEqualUint => left as u32 <= right as u32,
        Comparison::LessDouble => double(left) < double(right),
        Comparison::LessEqualDouble => double(left) <= double(right),
        Comparison::EqualDouble => double(left) == double(right),
        Comparison::Equal => left == right,
    }
}

fn shifted_left(of: Shifted, left: u64, right: u64) -> Result<u64, Fault> {
    let (by, by_uint) = (int(right), right as u32);
    Ok(match of {
        Shifted::Int => word(shl(int(left), by)?),
        Shifted::IntByUint => word(shl(int(left), by_uint)?),
        Shifted::Uint => u64::from(shl(left as u32, by)?),
        Shifted::UintByUint => u64::from(shl(left as u32, by_uint)?),
        Shifted::Byte => u64::from(shl(left as u8, by)?),
        Shifted::ByteByUint => u64::from(shl(left as u8, by_uint)?),
    })
}

fn shifted_right(of: Shifted, left: u64, right: u64) -> Result<u64, Fault> {
    let (by, by_uint) = (int(right), right as u32);
    Ok(match of {
        Shifted::Int => word(shr(int(left), by)?),
        Shifted::IntByUint => word(shr(int(left), by_uint)?),
        Shifted::Uint => u64::from(shr(left as u32, by)?),
        Shifted::UintByUint => u64::from(shr(left as u32, by_uint)?),
        Shifted::Byte => u64::from(shr(left as u8, by)?),
        Shifted::ByteByUint => u64::from(shr(left as u8, by_uint)?),
    })
}

impl Engine {
    /// Runs until something waits, the first function returns, or the program stops.
    #[expect(clippy::indexing_slicing, reason = "code is checked before it runs: its numbers are within its tables")]
    #[expect(
        clippy::too_many_lines,
        reason = "an arm for each operation; functions of their own would cost each a call"
    )]
    pub(crate) fn execute(&self, state: &mut State, cx: &Cx) -> Done<Exit> {
        let ops = &self.code.ops[..];
        let globals = &self.words[..];
        'function: loop {
            let State { registers, words, texts, handles, boxes, position, passing, callers, nested, above, .. } =
                &mut *state;
            let mut at = position.at;
            let function = position.function;
            let Ok(r) = <&mut [u64; REGISTERS]>::try_from(&mut registers[position.register..][..REGISTERS]) else {
                return Err(self.alarm(state, damaged(), 0));
            };
            let m = &mut words[position.word..];
            let t = &mut texts[position.text..];
            let h = &mut handles[position.handle..];
            let b = &mut boxes[position.boxed..];
            macro_rules! reach {
                () => {
                    Reach {
                        engine: self,
                        cx,
                        registers: &mut *r,
                        words: &mut *m,
                        texts: &mut *t,
                        handles: &mut *h,
                        boxes: &*b,
                    }
                };
            }
            macro_rules! leave {
                ($exit:expr) => {{
                    position.at = at;
                    return Ok($exit);
                }};
            }
            macro_rules! go_to {
                ($to:expr) => {
                    at = $to as usize
                };
            }
            let (fault, line): (Fault, u32) = loop {
                // What a fallible operation gives, or the alarm at its line.
                macro_rules! checked {
                    ($result:expr, $line:expr) => {
                        match $result {
                            Ok(value) => value,
                            Err(fault) => break (fault, $line.into()),
                        }
                    };
                }
                macro_rules! reg {
                    ($number:expr) => {
                        r[usize::from($number)]
                    };
                }
                // By reference: each operation reads what it needs, and not all of its bytes.
                let op = &ops[at];
                at += 1;
                match *op {
                    Op::Copy { to, from } => reg!(to) = reg!(from),
                    Op::Small { to, value } => reg!(to) = word(value),
                    Op::Word { to, at } => reg!(to) = self.code.words[at as usize],

                    Op::AddInt { to, left, right } => {
                        reg!(to) = word(int(reg!(left)).wrapping_add(int(reg!(right))));
                    }
                    Op::SubInt { to, left, right } => {
                        reg!(to) = word(int(reg!(left)).wrapping_sub(int(reg!(right))));
                    }
                    Op::MulInt { to, left, right } => {
                        reg!(to) = word(int(reg!(left)).wrapping_mul(int(reg!(right))));
                    }
                    Op::AddSmall { to, left, value } => reg!(to) = word(int(reg!(left)).wrapping_add(value)),
                    Op::MulSmall { to, left, value } => reg!(to) = word(int(reg!(left)).wrapping_mul(value)),
                    Op::MulAdd { to, left, right, value } => {
                        reg!(to) = word(int(reg!(left)).wrapping_mul(value).wrapping_add(int(reg!(right))));
                    }
                    Op::DivInt { to, left, right, line } => {
                        reg!(to) = word(checked!(div(int(reg!(left)), int(reg!(right))), line));
                    }
                    Op::RemInt { to, left, right, line } => {
                        reg!(to) = word(checked!(rem(int(reg!(left)), int(reg!(right))), line));
                    }
                    // The constant 2 is the most frequent, and the processor's division takes long.
                    Op::DivSmall { to, left, value } => {
                        let left = int(reg!(left));
                        reg!(to) = word(if value == 2 { left / 2 } else { left.wrapping_div(value) });
                    }
                    Op::RemSmall { to, left, value } => {
                        let left = int(reg!(left));
                        reg!(to) = word(if value == 2 { left % 2 } else { left.wrapping_rem(value) });
                    }
                    Op::DivUint { to, left, right, line } => {
                        reg!(to) = u64::from(checked!(div(reg!(left) as u32, reg!(right) as u32), line));
                    }
                    Op::RemUint { to, left, right, line } => {
                        reg!(to) = u64::from(checked!(rem(reg!(left) as u32, reg!(right) as u32), line));
                    }
                    Op::And { to, left, right } => reg!(to) = reg!(left) & reg!(right),
                    Op::Or { to, left, right } => reg!(to) = reg!(left) | reg!(right),
                    Op::Xor { to, left, right } => reg!(to) = reg!(left) ^ reg!(right),
                    Op::AndSmall { to, left, value } => reg!(to) = reg!(left) & word(value),
                    Op::OrSmall { to, left, value } => reg!(to) = reg!(left) | word(value),
                    Op::XorSmall { to, left, value } => reg!(to) = reg!(left) ^ word(value),
                    Op::ShiftLeft { to, left, right, of, line } => {
                        reg!(to) = checked!(shifted_left(of, reg!(left), reg!(right)), line);
                    }
                    Op::ShiftRight { to, left, right, of, line } => {
                        reg!(to) = checked!(shifted_right(of, reg!(left), reg!(right)), line);
                    }
                    Op::ShiftLeftSmall { to, left, count } => {
                        reg!(to) = u64::from((reg!(left) as u32).wrapping_shl(u32::from(count)));
                    }
                    Op::ShiftRightSmall { to, left, count } => {
                        reg!(to) = word(int(reg!(left)).wrapping_shr(u32::from(count)));
                    }
                    Op::NegInt { to, from } => reg!(to) = word(int(reg!(from)).wrapping_neg()),
                    Op::NotInt { to, from } => reg!(to) = word(!int(reg!(from))),
                    Op::ToByte { to, from } => reg!(to) = reg!(from) & 0xff,

                    Op::AddDouble { to, left, right } => {
                        reg!(to) = (double(reg!(left)) + double(reg!(right))).to_bits();
                    }
                    Op::SubDouble { to, left, right } => {
                        reg!(to) = (double(reg!(left)) - double(reg!(right))).to_bits();
                    }
                    Op::MulDouble { to, left, right } => {
                        reg!(to) = (double(reg!(left)) * double(reg!(right))).to_bits();
                    }
                    Op::DivDouble { to, left, right } => {
                        reg!(to) = (double(reg!(left)) / double(reg!(right))).to_bits();
                    }
                    Op::RemDouble { to, left, right, line } => {
                        reg!(to) = checked!(rem_double(double(reg!(left)), double(reg!(right))), line).to_bits();
                    }
                    Op::NegDouble { to, from } => reg!(to) = (-double(reg!(from))).to_bits(),
                    Op::IntToDouble { to, from } => reg!(to) = f64::from(int(reg!(from))).to_bits(),
                    Op::UintToDouble { to, from } => reg!(to) = f64::from(reg!(from) as u32).to_bits(),

                    Op::NotBool { to, from } => reg!(to) = u64::from(reg!(from) == 0),
                    Op::IsSet { to, from } => reg!(to) = u64::from(reg!(from) != 0),
                    Op::IsSetDouble { to, from } => reg!(to) = u64::from(double(reg!(from)) != 0.0),
                    Op::Compare { to, left, right, by } => reg!(to) = u64::from(holds(by, reg!(left), reg!(right))),

                    Op::Jump { to } => go_to!(to),
                    Op::JumpIf { from, to } => {
                        if reg!(from) != 0 {
                            go_to!(to);
                        }
                    }
                    Op::JumpUnless { from, to } => {
                        if reg!(from) == 0 {
                            go_to!(to);
                        }
                    }
                    Op::JumpLess { left, right, to } => {
                        if int(reg!(left)) < int(reg!(right)) {
                            go_to!(to);
                        }
                    }
                    Op::JumpLessEqual { left, right, to } => {
                        if int(reg!(left)) <= int(reg!(right)) {
                            go_to!(to);
                        }
                    }
                    Op::JumpEqual { left, right, to } => {
                        if reg!(left) == reg!(right) {
                            go_to!(to);
                        }
                    }
                    Op::JumpNotEqual { left, right, to } => {
                        if reg!(left) != reg!(right) {
                            go_to!(to);
                        }
                    }
                    Op::JumpLessSmall { left, value, to } => {
                        if int(reg!(left)) < value {
                            go_to!(to);
                        }
                    }
                    Op::JumpNotLessSmall { left, value, to } => {
                        if int(reg!(left)) >= value {
                            go_to!(to);
                        }
                    }
                    Op::JumpEqualSmall { left, value, to } => {
                        if int(reg!(left)) == value {
                            go_to!(to);
                        }
                    }
                    Op::JumpNotEqualSmall { left, value, to } => {
                        if int(reg!(left)) != value {
                            go_to!(to);
                        }
                    }
                    Op::StepLess { left, right, by, to } => {
                        let next = int(reg!(left)).wrapping_add(by.into());
                        reg!(left) = word(next);
                        if next < int(reg!(right)) {
                            go_to!(to);
                        }
                    }
                    Op::StepLessSmall { left, by, value, to } => {
                        let next = int(reg!(left)).wrapping_add(by.into());
                        reg!(left) = word(next);
                        if next < value {
                            go_to!(to);
                        }
                    }
                    Op::JumpCompare { left, right, by, wanted, to } => {
                        if holds(by, reg!(left), reg!(right)) == wanted {
                            go_to!(to);
                        }
                    }

                    Op::Load { to, at } => reg!(to) = m[at as usize],
                    Op::Store { from, at } => m[at as usize] = reg!(from),
                    Op::LoadElement { to, index, at } => {
                        reg!(to) = m[at as usize + reg!(index) as u32 as usize];
                    }
                    Op::StoreElement { from, index, at } => {
                        m[at as usize + reg!(index) as u32 as usize] = reg!(from);
                    }
                    Op::LoadChecked { to, index: number, size, at, line } => {
                        reg!(to) = m[at as usize + checked!(index(int(reg!(number)), size.into()), line)];
                    }
                    Op::StoreChecked { from, index: number, size, at, line } => {
                        m[at as usize + checked!(index(int(reg!(number)), size.into()), line)] = reg!(from);
                    }
                    Op::LoadGlobal { to, at } => reg!(to) = globals[at as usize].get(),
                    Op::StoreGlobal { from, at } => globals[at as usize].set(reg!(from)),
                    Op::LoadGlobalElement { to, index, at } => {
                        reg!(to) = globals[at as usize + reg!(index) as u32 as usize].get();
                    }
                    Op::StoreGlobalElement { from, index, at } => {
                        globals[at as usize + reg!(index) as u32 as usize].set(reg!(from));
                    }
                    Op::LoadGlobalChecked { to, index: number, size, at, line } => {
                        reg!(to) = globals[at as usize + checked!(index(int(reg!(number)), size.into()), line)].get();
                    }
                    Op::StoreGlobalChecked { from, index: number, size, at, line } => {
                        globals[at as usize + checked!(index(int(reg!(number)), size.into()), line)].set(reg!(from));
                    }
                    Op::LoadBoxed { to, from, at } => {
                        let Some(cell) = b[usize::from(from)].as_ref().and_then(|shared| shared.words.get(at as usize))
                        else {
                            break (damaged(), 0);
                        };
                        reg!(to) = cell.get();
                    }
                    Op::StoreBoxed { to, from, at } => {
                        let Some(cell) = b[usize::from(to)].as_ref().and_then(|shared| shared.words.get(at as usize))
                        else {
                            break (damaged(), 0);
                        };
                        cell.set(reg!(from));
                    }
                    Op::Index { to, index: number, size, line } => {
                        reg!(to) = checked!(index(int(reg!(number)), size.into()), line) as u64;
                    }
                    Op::Index2 { to, row, column, rows, columns, line } => {
                        let numbers = [int(reg!(row)), int(reg!(column))];
                        reg!(to) = checked!(index2(numbers, [rows.into(), columns.into()]), line) as u64;
                    }

                    Op::CopyWords { to, from, count } => {
                        m.copy_within(from as usize..from as usize + usize::from(count), to as usize);
                    }
                    Op::CopyFromGlobal { to, from, count } => load(m, to as usize, globals, from as usize, count),
                    Op::CopyToGlobal { to, from, count } => store(globals, to as usize, m, from as usize, count),
                    Op::CopyElement { to, index, from, count } => {
                        let from = from as usize + reg!(index) as u32 as usize;
                        m.copy_within(from..from + usize::from(count), to as usize);
                    }
                    Op::CopyToElement { to, index, from, count } => {
                        let to = to as usize + reg!(index) as u32 as usize;
                        m.copy_within(from as usize..from as usize + usize::from(count), to);
                    }
                    Op::CopyGlobalElement { to, index, from, count } => {
                        load(m, to as usize, globals, from as usize + reg!(index) as u32 as usize, count);
                    }
                    Op::CopyToGlobalElement { to, index, from, count } => {
                        store(globals, to as usize + reg!(index) as u32 as usize, m, from as usize, count);
                    }
                    Op::CopyConstants { to, from, count } => {
                        let (to, from, count) = (to as usize, from as usize, usize::from(count));
                        m[to..to + count].copy_from_slice(&self.code.words[from..from + count]);
                    }
                    Op::Clear { at, count } => m[at as usize..at as usize + count as usize].fill(0),
                    Op::Transfer { transfer } => {
                        let transfer = &self.code.transfers[transfer as usize];
                        let done = reach!().transfer(&transfer.from, &transfer.to, transfer.extent, passing);
                        checked!(done, transfer.line);
                    }

                    Op::Text { to, at } => t[usize::from(to)] = self.constants[at as usize].clone(),
                    Op::CopyText { to, from } => t[usize::from(to)] = t[usize::from(from)].clone(),
                    Op::LoadText { to, index, at } => {
                        t[usize::from(to)] = t[at as usize + reg!(index) as u32 as usize].clone();
                    }
                    Op::StoreText { from, index, at } => {
                        t[at as usize + reg!(index) as u32 as usize] = t[usize::from(from)].clone();
                    }
                    Op::LoadGlobalText { to, at } => t[usize::from(to)] = self.texts[at as usize].borrow().clone(),
                    Op::StoreGlobalText { from, at } => {
                        drop(self.texts[at as usize].replace(t[usize::from(from)].clone()));
                    }
                    Op::Join { to, right } => {
                        let left = std::mem::take(&mut t[usize::from(to)]);
                        let joined = left + &t[usize::from(right)];
                        t[usize::from(to)] = joined;
                    }
                    Op::CheckLength { of, line } => {
                        let text = std::mem::take(&mut t[usize::from(of)]);
                        t[usize::from(of)] = checked!(fits(text), line);
                    }
                    Op::Append { to, more, line } => {
                        // The text may be appended to itself.
                        let mut text = std::mem::take(&mut t[usize::from(to)]);
                        let done = match to == more {
                            true => {
                                append(&mut text.clone(), &text).map(|()| text.push_bytes(&text.clone().into_bytes()))
                            }
                            false => append(&mut text, &t[usize::from(more)]),
                        };
                        t[usize::from(to)] = text;
                        checked!(done, line);
                    }
                    Op::AppendGlobal { to, more, line } => {
                        let done = append(&mut self.texts[to as usize].borrow_mut(), &t[usize::from(more)]);
                        checked!(done, line);
                    }
                    Op::CompareTexts { to, left, right, by } => {
                        let (left, right) = (t[usize::from(left)].as_bytes(), t[usize::from(right)].as_bytes());
                        reg!(to) = u64::from(match by {
                            Comparison::LessUint => left < right,
                            Comparison::LessEqualUint => left <= right,
                            _ => left == right,
                        });
                    }
                    Op::ClearTexts { at, count } => {
                        t[at as usize..at as usize + count as usize].iter_mut().for_each(|text| text.clear());
                    }

                    Op::NewHandles { at, count, kind } => {
                        for place in &mut h[at as usize..at as usize + usize::from(count)] {
                            // What nobody else uses any more is used again: nothing is allocated.
                            match place.as_mut().and_then(Rc::get_mut) {
                                Some(old) => *old = Handle::new(kind),
                                None => *place = Some(Rc::new(Handle::new(kind))),
                            }
                        }
                    }
                    Op::DropHandles { at, count } => {
                        h[at as usize..at as usize + count as usize].iter_mut().for_each(|place| *place = None);
                    }
                    Op::NewBox { to, extent } => {
                        b[usize::from(to)] = Some(Rc::new(Boxed::new(self.code.boxes[extent as usize])));
                    }

                    Op::Call { call } => {
                        let call = &self.code.calls[call as usize];
                        let called = &self.code.functions[call.function as usize];
                        state.call(call, called, at);
                        continue 'function;
                    }
                    Op::Return | Op::ReturnWord { .. } | Op::ReturnText { .. } => {
                        match *op {
                            Op::ReturnWord { from } => r[0] = reg!(from),
                            Op::ReturnText { from } => t[0] = t[usize::from(from)].clone(),
                            _ => {}
                        }
                        let first = r[0];
                        if state.leave(&self.code.functions[function]) {
                            if self.code.watched {
                                return Ok(Exit::Closed);
                            }
                            continue 'function;
                        }
                        return Ok(Exit::Returned(first));
                    }
                    Op::Line { line } => cx.line(self.file_of(function), line),
                    Op::BuiltIn { site } => {
                        let site = &self.code.sites[site as usize];
                        let done = adapters::call_now(cx, &mut Args { reach: reach!(), site });
                        checked!(done, site.line);
                    }
                    Op::Await { site } => leave!(Exit::Await(site as usize)),
                    Op::Above { site } => leave!(Exit::Above(site as usize)),
                    Op::Sink { line } => leave!(Exit::Sink(line)),
                    Op::StayAbove => {
                        *above = None;
                    }
                    Op::Event { event } => {
                        let event = &self.code.events[event as usize];
                        let done = self.declare(cx, event, reach!());
                        checked!(done, event.site.line);
                    }
                    Op::Wait { to, limit, line } => {
                        let limit = limit.map(|limit| double(reg!(limit)));
                        leave!(Exit::Wait { to, limit, line })
                    }
                    Op::IsLate { to, wait } => reg!(to) = u64::from(cx.cycle() >= reg!(wait)),
                    Op::GoesOn => cx.goes_on(),

                    Op::NextCycle => leave!(Exit::NextCycle),
                    Op::Change => leave!(Exit::Change),
                    Op::Spend { rounds } => {
                        if cx.spend_rounds(rounds) {
                            leave!(Exit::NextCycle);
                        }
                    }
                    Op::Take { again } => {
                        if !cx.rounds().take() {
                            go_to!(again);
                            leave!(Exit::NextCycle);
                        }
                    }
                    Op::Leave { again } => {
                        if cx.rounds().are_spent() {
                            go_to!(again);
                            leave!(Exit::NextCycle);
                        }
                    }
                    Op::Charge { first, last, step, how, rounds } => {
                        let (first, last) = (int(reg!(first)), int(reg!(last)));
                        let count = match step {
                            ChargeStep::Up => last.wrapping_sub(first),
                            ChargeStep::Down => first.wrapping_sub(last),
                            ChargeStep::By(by) => steps(last.wrapping_sub(first), int(reg!(by))),
                            ChargeStep::DownBy(by) => steps(first.wrapping_sub(last), int(reg!(by))),
                        };
                        let count = count.wrapping_add(1).wrapping_mul(rounds);
                        // A program pointer that was set may have led into the loop: its first value is not known.
                        let count = if self.code.watched { count.max(0) } else { count };
                        match how {
                            Charging::Counter => cx.rounds().charge(count),
                            Charging::Charge => cx.charge(count),
                            Charging::Spend => {
                                if cx.spend_rounds(count) {
                                    leave!(Exit::NextCycle);
                                }
                            }
                        }
                    }
                    Op::Enter { entry, line } => {
                        let entry = &self.code.entries[entry as usize];
                        let bytes = checked!(held_bytes(entry, &reach!()), line);
                        let entered = checked!(cx.enter_apart(entry.weight, bytes), line);
                        nested.push(NestedCall { depth: callers.len(), _entered: entered });
                    }
                    Op::Open { line, is_action } => leave!(Exit::Open { line, is_action }),
                    Op::Halt { line } => leave!(Exit::Halt(line)),
                    Op::Show { local } => leave!(Exit::Show(local)),
                    Op::DropBox { at } => b[usize::from(at)] = None,
                    Op::Exit => return Err(Stop::exit()),
                    Op::Restart => return Err(Stop::restart()),
                }
            };
            return Err(self.alarm(state, fault, line));
        }
    }
}

/// How many bytes a function was handed.
fn held_bytes(entry: &Entry, reach: &Reach<'_>) -> Result<usize, Fault> {
    let texts = entry.texts.iter().map(|place| reach.text(place).map(|text| text.len()));
    texts.sum::<Result<usize, Fault>>().map(|bytes| bytes + entry.bytes as usize)
}

/// Copies global words to the frame.
#[expect(clippy::indexing_slicing, reason = "code is checked before it runs: its numbers are within its tables")]
fn load(frame: &mut [u64], to: usize, globals: &[Cell<u64>], from: usize, count: u16) {
    let count = usize::from(count);
    for (word, cell) in frame[to..to + count].iter_mut().zip(&globals[from..from + count]) {
        *word = cell.get();
    }
}

/// Copies words of the frame to the global variables.
#[expect(clippy::indexing_slicing, reason = "code is checked before it runs: its numbers are within its tables")]
fn store(globals: &[Cell<u64>], to: usize, frame: &[u64], from: usize, count: u16) {
    let count = usize::from(count);
    for (cell, word) in globals[to..to + count].iter().zip(&frame[from..from + count]) {
        cell.set(*word);
    }
}
