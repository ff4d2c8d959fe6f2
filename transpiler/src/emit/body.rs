//! What is known while the statements of one function are emitted.

use super::Sizes;
use super::elements::LookedUp;
use super::fragment::Fragment;
use super::machine::Machine;
use super::marks::{Marks, clean};
use super::names::{Names, ident, is_taken_value};
use super::parts::{Frame, Weights};
use super::rows::Columns;
use super::slots::Slots;
use super::templates::Templates;
use super::temporaries::Temporaries;
use super::usage::Usage;
use crate::effects::facts::{self, FactScope, Facts};
use crate::effects::ranges::Ranges;
use crate::hir::{Expr, Func, FuncId, LocalId, ModuleId, Program, Value};
use arl_lang::catalog::Family;
use arl_lang::span::{LineIndex, Span};
use proc_macro2::{Ident, Literal, TokenStream};
use quote::{ToTokens, quote};
use std::collections::HashSet;

/// What all functions of an emission share.
pub(super) struct Unit<'p> {
    pub(super) program: &'p Program,
    pub(super) names: Names,
    pub(super) marks: Marks,
    /// Where the lines of each module begin.
    pub(super) lines: Vec<LineIndex>,
    /// The functions that move the program pointer.
    pub(super) movers: Vec<bool>,
    /// The functions that something calls.
    pub(super) reached: Vec<bool>,
    /// The functions that are compiled by themselves.
    pub(super) apart: Vec<bool>,
    pub(super) sizes: Sizes,
    /// Whether a debugger may halt the program.
    pub(super) watched: bool,
    /// Whether global variables keep their names.
    pub(super) named: bool,
    /// The variables that are in arrays.
    pub(super) slots: Slots,
    /// The calls that are made of functions of their own.
    pub(super) templates: Templates<'p>,
}

impl Unit<'_> {
    pub(super) fn family(&self) -> Family {
        self.program.family
    }

    /// The line of a place in a module.
    pub(super) fn line(&self, module: ModuleId, span: Span) -> u32 {
        self.lines.get(module.0 as usize).map_or(0, |lines| lines.line(span.start))
    }

    /// The lines of a module that a span touches, with their numbers, one below the other; long texts are cut.
    pub(super) fn text(&self, module: ModuleId, span: Span) -> String {
        const MOST: usize = 4;
        let (Some(lines), Some(source)) = (
            self.lines.get(module.0 as usize),
            self.program.modules.get(module.0 as usize).map(|module| module.source.as_str()),
        ) else {
            return String::new();
        };
        let (first, last) = (lines.line(span.start), lines.line(span.end.max(span.start + 1) - 1));
        let mut out = Vec::new();
        for line in first..=last {
            let text = lines.line_span(source, line).map_or("", |span| span.text(source));
            out.push(format!("{line}: {}", clean(text)));
            if out.len() == MOST && line < last {
                out.push("...".to_owned());
                break;
            }
        }
        out.join("\n")
    }
}

/// A loop around the statements that are being emitted.
#[derive(Clone, Debug)]
pub(super) struct Loop {
    /// How `break` is written.
    pub(super) on_break: Exit,
    /// How `continue` is written.
    pub(super) on_continue: Exit,
}

/// A way out of a loop's body.
#[derive(Clone, Debug)]
pub(super) enum Exit {
    /// `break` or `continue` without label.
    Plain,
    /// `continue 'label`, `break 'label`.
    Labelled(TokenStream),
    /// To a state of the function's machine.
    State(usize),
}

/// Whether a block is the end of the function, so that its last statement gives the result.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Tail {
    /// What comes behind the block runs afterwards.
    Inner,
    /// Nothing comes behind it.
    Function,
}

/// Emits the statements of one function, or an expression outside functions.
pub(super) struct Body<'p, 'u> {
    pub(super) unit: &'u Unit<'p>,
    pub(super) module: ModuleId,
    pub(super) func: Option<&'p Func>,
    /// The names of the locals.
    pub(super) names: Vec<Ident>,
    pub(super) usage: Usage,
    /// The values of the variables that loops count.
    pub(super) ranges: Ranges,
    /// The line that alarms are reported on.
    pub(super) line: u32,
    /// Temporaries of the current statement.
    temporaries: Temporaries,
    /// Names that temporaries must not take.
    taken: HashSet<String>,
    labels: usize,
    pub(super) loops: Vec<Loop>,
    /// What counts the rounds of the loop around, where that is not the context.
    pub(super) counter: Option<Ident>,
    pub(super) looked_up: LookedUp,
    /// The locals that ARL sees at this place.
    pub(super) visible: Vec<LocalId>,
    pub(super) machine: Option<Machine>,
    /// The line that the last comment was about.
    pub(super) commented: u32,
    /// What a function that calls itself does before it does so, until that has been emitted.
    pub(super) guard: Option<TokenStream>,
    /// Whether the function is compiled into its callers.
    pub(super) inlined: bool,
    /// The locals that are declared at their first assignment, until that comes.
    pub(super) deferred: HashSet<LocalId>,
    /// Whether something that needs the program pointer has been emitted since the flag was cleared.
    pub(super) acts: bool,
    /// The parts that are being emitted, the innermost last.
    pub(super) frames: Vec<Frame>,
    /// The locals that live in front of the parts of their block.
    pub(super) hoisted: HashSet<LocalId>,
    /// How many `.await`s the statements have.
    pub(super) weights: Weights,
    /// What stands for constants and for the line while the statements of a table are emitted.
    pub(super) columns: Columns,
    /// Whether the function of a template is emitted.
    pub(super) in_template: bool,
    /// What a debugger sees of the function, where it sees something.
    pub(super) frame: Option<Ident>,
}

impl<'p, 'u> Body<'p, 'u> {
    /// For a function.
    pub(super) fn of_function(unit: &'u Unit<'p>, func: &'p Func) -> Self {
        let waits = |id: FuncId| unit.program.funcs.get(id.0 as usize).is_some_and(|func| func.effects.waits);
        let ranges = Ranges::of_function(func);
        let mut body = Self { func: Some(func), ranges, ..Self::outside(unit, func.module) };
        body.weights = body.weigh(func);
        let scattered = func.has_goto || body.weights.cut;
        body.usage = Usage::of_function(func, scattered, &waits);
        body.names = unit.names.locals(func, scattered, &|local| !body.usage.is_read(local));
        body.taken = body.names.iter().map(Ident::to_string).collect();
        body.visible.clone_from(&func.params);
        body
    }

    /// For expressions outside functions.
    pub(super) fn outside(unit: &'u Unit<'p>, module: ModuleId) -> Self {
        Self {
            unit,
            module,
            func: None,
            names: Vec::new(),
            usage: Usage::default(),
            ranges: Ranges::default(),
            line: 0,
            temporaries: Temporaries::default(),
            taken: HashSet::new(),
            labels: 0,
            loops: Vec::new(),
            counter: None,
            looked_up: LookedUp::new(),
            visible: Vec::new(),
            machine: None,
            commented: 0,
            guard: None,
            inlined: false,
            deferred: HashSet::new(),
            acts: false,
            frames: Vec::new(),
            hoisted: HashSet::new(),
            weights: Weights::default(),
            columns: Columns::default(),
            in_template: false,
            frame: None,
        }
    }

    pub(super) fn program(&self) -> &'p Program {
        self.unit.program
    }

    pub(super) fn family(&self) -> Family {
        self.unit.family()
    }

    /// The name of a local variable.
    pub(super) fn local(&self, id: LocalId) -> Ident {
        self.names.get(id.0 as usize).cloned().unwrap_or_else(|| ident("unknown"))
    }

    /// The value of a constant expression.
    pub(super) fn constant(&self, expr: &'p Expr) -> Option<&'p Value> {
        facts::constant(self.program(), self.func, expr)
    }

    /// What facts are found with.
    pub(super) fn scope(&self) -> FactScope<'_> {
        FactScope { program: self.unit.program, func: self.func, ranges: &self.ranges }
    }

    pub(super) fn facts(&self, expr: &Expr) -> Facts {
        facts::of_expr(self.scope(), expr)
    }

    /// Makes alarms (and the comment) of what follows stand at the line of `span`.
    pub(super) fn stand_at(&mut self, span: Span) {
        self.line = self.unit.line(self.module, span);
    }

    /// The comment for a statement, unless its line has one already.
    pub(super) fn comment(&mut self, span: Span) -> TokenStream {
        let line = self.unit.line(self.module, span);
        if line == self.commented {
            return TokenStream::new();
        }
        self.commented = line;
        self.unit.marks.comment(self.unit.text(self.module, span))
    }

    /// A fallible call of the runtime: its fault becomes an alarm at the current line.
    pub(super) fn checked(&self, call: TokenStream) -> TokenStream {
        let line = self.line_number();
        quote!(#call.at(FILE, #line)?)
    }

    pub(super) fn line_number(&self) -> TokenStream {
        let number = || Literal::u32_unsuffixed(self.line).into_token_stream();
        self.columns.line().unwrap_or_else(number)
    }

    /// `cx.line(FILE, n);` where what was emitted since the last call needs the program pointer.
    pub(super) fn pointer(&mut self) -> TokenStream {
        if !std::mem::take(&mut self.acts) {
            return TokenStream::new();
        }
        self.line_statement()
    }

    /// `cx.line(FILE, n);`
    pub(super) fn line_statement(&self) -> TokenStream {
        let line = self.line_number();
        quote!(cx.line(FILE, #line);)
    }

    /// A name for a temporary that nothing in reach has.
    pub(super) fn fresh(&mut self, wanted: &str) -> Ident {
        let wanted = if is_taken_value(wanted) { "value" } else { wanted };
        let (taken, names, module) = (&self.taken, &self.unit.names, self.module);
        let is_taken = |name: &str| taken.contains(name) || names.has_function(module, name);
        ident(&self.temporaries.give(wanted, is_taken))
    }

    /// A name that stays reserved for the whole function.
    pub(super) fn reserve(&mut self, wanted: &str) -> Ident {
        let name = self.fresh(wanted);
        self.temporaries.truncate(self.temporaries.len() - 1);
        self.taken.insert(name.to_string());
        name
    }

    /// Gives back what [`Self::reserve`] took.
    pub(super) fn release(&mut self, name: &Ident) {
        self.taken.remove(&name.to_string());
    }

    /// A number for labels that no other loop of the function has.
    pub(super) fn label_number(&mut self) -> usize {
        self.labels += 1;
        self.labels
    }

    /// Puts a value into a temporary, as a statement before.
    pub(super) fn settle(&mut self, value: Fragment, wanted: &str) -> Fragment {
        if value.settled {
            return value;
        }
        let name = self.fresh(wanted);
        let (before, tokens) = (&value.before, &value.tokens);
        Fragment { before: quote!(#before let #name = #tokens;), ..Fragment::settled(quote!(#name)) }
    }

    /// Runs for what the code looks like; the temporaries that it names are free afterwards.
    pub(super) fn on_trial<R>(&mut self, run: impl FnOnce(&mut Self) -> R) -> R {
        let before = self.temporaries.len();
        let result = run(self);
        self.temporaries.truncate(before);
        result
    }

    /// Runs with the temporaries of an inner statement, whose names may be those of the outer one.
    pub(super) fn with_own_temporaries<R>(&mut self, run: impl FnOnce(&mut Self) -> R) -> R {
        let outer = std::mem::take(&mut self.temporaries);
        let result = run(self);
        self.temporaries = outer;
        result
    }
}

/// `'round`, `'round2`
pub(super) fn label(name: &str, number: usize) -> syn::Lifetime {
    let text = if number == 1 { format!("'{name}") } else { format!("'{name}{number}") };
    syn::Lifetime::new(&text, proc_macro2::Span::call_site())
}
