//! The state while the statements of one function are emitted.

use super::control_flow::ControlFlow;
use super::elements::LookedUp;
use super::fragment::Fragment;
use super::local_names::LocalNames;
use super::rows::Columns;
use super::unit::Unit;
use super::usage::Usage;
use crate::effects::facts::{self, FactScope, Facts};
use crate::effects::pointer;
use crate::effects::ranges::Ranges;
use crate::hir::{Expr, Func, FuncId, LocalId, ModuleId, Program, Value};
use arl_lang::catalog::Family;
use arl_lang::span::Span;
use proc_macro2::{Ident, Literal, TokenStream};
use quote::{ToTokens, quote};
use std::collections::HashSet;

/// Emits the statements of one function, or an expression outside functions.
pub(super) struct Body<'p, 'u> {
    pub(super) unit: &'u Unit<'p>,
    pub(super) module: ModuleId,
    pub(super) func: Option<&'p Func>,
    names: LocalNames,
    pub(super) locals: Locals,
    pub(super) flow: ControlFlow,
    pub(super) position: SourcePosition,
    pub(super) form: Form,
}

/// What is known about the local variables.
#[derive(Default)]
pub(super) struct Locals {
    pub(super) usage: Usage,
    /// The values of the variables that loops count.
    pub(super) ranges: Ranges,
    pub(super) looked_up: LookedUp,
    /// The variables that are visible in ARL at this point.
    pub(super) visible: Vec<LocalId>,
    /// The variables that are declared at their first assignment, until it is emitted.
    pub(super) deferred: HashSet<LocalId>,
    /// The variables that live before the parts of their block.
    pub(super) hoisted: HashSet<LocalId>,
}

/// The position in the program of the code being emitted.
#[derive(Default)]
pub(super) struct SourcePosition {
    /// The line that alarms are reported on.
    pub(super) line: u32,
    /// The line of the last comment.
    pub(super) commented: u32,
    /// Whether anything that needs the program pointer has been emitted since the flag was cleared.
    pub(super) acts: bool,
    /// The columns that replace constants and the line while the statements of a table are emitted.
    pub(super) columns: Columns,
}

/// The form of the function being emitted.
#[derive(Default)]
pub(super) struct Form {
    /// What a recursive function does before it calls itself, until that has been emitted.
    pub(super) guard: Option<TokenStream>,
    /// Whether the function is compiled into its callers.
    pub(super) inlined: bool,
    /// Whether the function is a template.
    pub(super) in_template: bool,
}

impl<'p, 'u> Body<'p, 'u> {
    /// For a function.
    pub(super) fn of_function(unit: &'u Unit<'p>, func: &'p Func) -> Self {
        let waits = |id: FuncId| unit.program.funcs.get(id.0 as usize).is_some_and(|func| func.effects.waits);
        let mut body = Self { func: Some(func), ..Self::outside(unit, func.module) };
        body.locals.ranges = Ranges::of_function(func);
        body.flow.weights = body.weigh(func);
        let scattered = func.has_goto || body.flow.weights.cut;
        body.locals.usage = Usage::of_function(func, scattered, &waits);
        let names = unit.names.locals(func, scattered, &|local| !body.locals.usage.is_read(local));
        body.names = LocalNames::new(names);
        body.locals.visible.clone_from(&func.params);
        body
    }

    /// For expressions outside functions.
    pub(super) fn outside(unit: &'u Unit<'p>, module: ModuleId) -> Self {
        Self {
            unit,
            module,
            func: None,
            names: LocalNames::default(),
            locals: Locals::default(),
            flow: ControlFlow::default(),
            position: SourcePosition::default(),
            form: Form::default(),
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
        self.names.local(id)
    }

    /// The value of a constant expression.
    pub(super) fn constant(&self, expr: &'p Expr) -> Option<&'p Value> {
        facts::constant(self.program(), self.func, expr)
    }

    /// The scope used to determine facts.
    pub(super) fn scope(&self) -> FactScope<'_> {
        FactScope { program: self.unit.program, func: self.func, ranges: &self.locals.ranges }
    }

    pub(super) fn facts(&self, expr: &Expr) -> Facts {
        facts::of_expr(self.scope(), expr)
    }

    /// Sets the line of the alarms and the comment of the following code to the line of `span`.
    pub(super) fn stand_at(&mut self, span: Span) {
        self.position.line = self.unit.line(self.module, span);
    }

    /// The comment for a statement, unless its line has one already.
    pub(super) fn comment(&mut self, span: Span) -> TokenStream {
        let line = self.unit.line(self.module, span);
        if line == self.position.commented {
            return TokenStream::new();
        }
        self.position.commented = line;
        self.unit.marks.comment(self.unit.text(self.module, span))
    }

    /// A fallible call of the runtime: an error becomes an alarm at the current line.
    pub(super) fn checked(&self, call: TokenStream) -> TokenStream {
        let line = self.line_number();
        quote!(#call.at(FILE, #line)?)
    }

    pub(super) fn line_number(&self) -> TokenStream {
        let number = || Literal::u32_unsuffixed(self.position.line).into_token_stream();
        self.position.columns.line().unwrap_or_else(number)
    }

    /// `cx.line(FILE, n);` if the code emitted since the last call needs the program pointer.
    pub(super) fn pointer(&mut self) -> TokenStream {
        if !std::mem::take(&mut self.position.acts) {
            return TokenStream::new();
        }
        self.line_statement()
    }

    /// `cx.line(FILE, n);` before a statement that evaluates this expression, if that needs the program pointer.
    pub(super) fn pointer_for(&mut self, expr: &Expr) -> TokenStream {
        // Calls that have become functions of their own set the pointer there.
        debug_assert!(
            self.unit.templates.are_used()
                || self.position.acts == pointer::is_needed(self.scope(), &self.unit.movers, expr),
            "{expr:?}"
        );
        self.pointer()
    }

    /// `cx.line(FILE, n);`
    pub(super) fn line_statement(&self) -> TokenStream {
        let line = self.line_number();
        quote!(cx.line(FILE, #line);)
    }

    /// A name for a temporary that is not used for anything else in reach.
    pub(super) fn fresh(&mut self, wanted: &str) -> Ident {
        self.names.fresh(wanted, &self.unit.names, self.module)
    }

    /// A name that stays reserved for the whole function.
    pub(super) fn reserve(&mut self, wanted: &str) -> Ident {
        self.names.reserve(wanted, &self.unit.names, self.module)
    }

    /// Releases a name taken by [`Self::reserve`].
    pub(super) fn release(&mut self, name: &Ident) {
        self.names.release(name);
    }

    /// Puts a value into a temporary, in a statement before it.
    pub(super) fn settle(&mut self, value: Fragment, wanted: &str) -> Fragment {
        if value.settled {
            return value;
        }
        let name = self.fresh(wanted);
        let (before, tokens) = (&value.before, &value.tokens);
        Fragment { before: quote!(#before let #name = #tokens;), ..Fragment::settled(quote!(#name)) }
    }

    /// Runs `run` only to see what the code looks like; the temporaries that it names are free again afterwards.
    pub(super) fn on_trial<R>(&mut self, run: impl FnOnce(&mut Self) -> R) -> R {
        let before = self.names.temporaries();
        let result = run(self);
        self.names.keep_temporaries(before);
        result
    }

    /// Runs `run` with the temporaries of an inner statement, which may have the same names as those of the outer one.
    pub(super) fn with_own_temporaries<R>(&mut self, run: impl FnOnce(&mut Self) -> R) -> R {
        let outer = self.names.inner_statement();
        let result = run(self);
        self.names.outer_statement(outer);
        result
    }
}
