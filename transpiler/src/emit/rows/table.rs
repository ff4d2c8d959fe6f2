//! The code of a table: its rows, and the loop over them.

use super::shape::{Filling, Hole, Shape, StatementRow};
use crate::emit::body::Body;
use crate::emit::consts;
use crate::emit::control_flow::Tail;
use crate::emit::fragment::{Fragment, Precedence};
use crate::emit::names::{camel_case, field, ident};
use crate::emit::sequence::Mode;
use crate::emit::tokens::{mentions, uses_variable};
use crate::emit::types::base_type;
use crate::hir::{Expr, ExprKind, Place, Value};
use arl_lang::catalog::{Base, Family};
use proc_macro2::{Ident, Literal, TokenStream};
use quote::{ToTokens, quote};
use std::collections::{HashMap, HashSet};

/// The columns that replace constants and the line while the statements of a table are emitted.
#[derive(Default, Debug)]
pub(in crate::emit) struct Columns {
    line: Option<Ident>,
    /// The columns of the constants, which are identified by their addresses.
    of: HashMap<*const Expr, Ident>,
    /// The columns that select the variable of an array.
    slots: HashMap<*const Place, Ident>,
}

impl Columns {
    /// Columns for the line and for the fillings of holes.
    pub(in crate::emit) fn new<'h>(line: Ident, holes: impl Iterator<Item = (&'h Hole<'h>, &'h Ident)>) -> Self {
        let mut columns = Self { line: Some(line), ..Self::default() };
        holes.for_each(|(hole, name)| columns.put(hole, name));
        columns
    }

    fn put(&mut self, hole: &Hole<'_>, name: &Ident) {
        match hole.filling {
            Filling::Constant(expr, _) => _ = self.of.insert(std::ptr::from_ref(expr), name.clone()),
            Filling::Variable(place, _) => _ = self.slots.insert(std::ptr::from_ref(place), name.clone()),
        }
    }

    /// Whether there are no columns.
    pub(in crate::emit) fn is_empty(&self) -> bool {
        self.line.is_none() && self.of.is_empty() && self.slots.is_empty()
    }

    /// The line of the row.
    pub(in crate::emit) fn line(&self) -> Option<TokenStream> {
        self.line.as_ref().map(ToTokens::to_token_stream)
    }

    /// Whether code mentions any of the columns.
    pub(in crate::emit) fn are_in(&self, code: &TokenStream) -> bool {
        self.line
            .iter()
            .chain(self.of.values())
            .chain(self.slots.values())
            .any(|name| mentions(code, &name.to_string()))
    }

    /// The column that selects the variable of an array for a place.
    pub(in crate::emit) fn slot(&self, place: &Place) -> Option<Ident> {
        if self.slots.is_empty() { None } else { self.slots.get(&std::ptr::from_ref(place)).cloned() }
    }

    /// The column of a constant in the wanted mode.
    pub(in crate::emit) fn of(&self, expr: &Expr, mode: Mode) -> Option<Fragment> {
        if self.of.is_empty() {
            return None;
        }
        let name = self.of.get(&std::ptr::from_ref(expr))?;
        let text = matches!(expr.kind, ExprKind::Const(Value::String(_)));
        Some(match mode {
            Mode::Printed => Fragment { settled: true, ..Fragment::new(quote!(&#name), Precedence::Unary) },
            Mode::Reference if text => Fragment::new(quote!(&Str::literal(#name)), Precedence::Unary),
            Mode::Reference => Fragment { settled: true, ..Fragment::new(quote!(&#name), Precedence::Unary) },
            _ if text => Fragment::settled(quote!(Str::literal(#name))),
            _ => Fragment::settled(quote!(#name)),
        })
    }
}

/// The data of one row.
#[derive(Clone, Copy, Debug)]
pub(in crate::emit) struct Entry<'r, 'p> {
    /// The value of the first column, for example the line.
    pub(in crate::emit) lead: usize,
    pub(in crate::emit) shape: &'r Shape,
    pub(in crate::emit) holes: &'r [Hole<'p>],
}

/// The first column of a table.
#[derive(Clone, Copy, Debug)]
pub(in crate::emit) struct Lead<'a> {
    pub(in crate::emit) name: &'a Ident,
    /// The type of the column.
    pub(in crate::emit) ty: &'a TokenStream,
}

/// Rows of one shape.
struct Kind<'r, 'p> {
    holes: &'r [Hole<'p>],
    /// The columns: the numbers of the constants that differ, and their names.
    columns: Vec<(usize, Ident)>,
    /// The name of the variant, if there are several kinds.
    name: Ident,
    code: TokenStream,
}

impl<'p> Body<'p, '_> {
    /// The code of a table of statements.
    pub(in crate::emit) fn table(&mut self, rows: &[StatementRow<'p>]) -> TokenStream {
        let line_of = |row: &StatementRow<'p>| self.unit.line(self.module, row.stmt.span) as usize;
        let entries: Vec<Entry<'_, 'p>> =
            rows.iter().map(|row| Entry { lead: line_of(row), shape: &row.shape, holes: &row.holes }).collect();
        let name = self.reserve("line");
        let lead = Lead { name: &name, ty: &quote!(u32) };
        let word = |at: usize, body: &Self| rows.get(at).map_or_else(String::new, |row| word(row.expr, body));
        let code = self.tabulate(&entries, lead, &word, &mut |body, at| {
            body.position.columns.line = Some(name.clone());
            rows.get(at).map(|row| body.statement(row.stmt, Tail::Inner)).unwrap_or_default()
        });
        self.release(&name);
        code
    }

    /// The code of a table. `emit` makes the code for the entry with a given number, with columns in place of the parts
    /// in which the entries of its shape differ; `word` gives the name of its kind.
    pub(in crate::emit) fn tabulate(
        &mut self,
        entries: &[Entry<'_, 'p>],
        lead: Lead<'_>,
        word: &dyn Fn(usize, &Self) -> String,
        emit: &mut dyn FnMut(&mut Self, usize) -> TokenStream,
    ) -> TokenStream {
        let mut numbers: HashMap<&Shape, usize> = HashMap::new();
        let mut of_kind: Vec<Vec<usize>> = Vec::new();
        for (at, entry) in entries.iter().enumerate() {
            let next = of_kind.len();
            let number = *numbers.entry(entry.shape).or_insert(next);
            if number == next {
                of_kind.push(Vec::new());
            }
            of_kind.get_mut(number).into_iter().for_each(|kind| kind.push(at));
        }
        let mut used = HashSet::new();
        let mut kinds = Vec::new();
        for members in &of_kind {
            let Some(first) = members.first() else { continue };
            let name = distinct(word(*first, self), &mut used);
            kinds.extend(self.kind(entries, members, name, emit));
        }
        self.loop_over(entries, &kinds, &numbers, lead)
    }

    /// The rows of a shape, with their code.
    fn kind<'r>(
        &mut self,
        entries: &[Entry<'r, 'p>],
        members: &[usize],
        name: Ident,
        emit: &mut dyn FnMut(&mut Self, usize) -> TokenStream,
    ) -> Option<Kind<'r, 'p>> {
        let first = *members.first()?;
        let holes = entries.get(first)?.holes;
        let differs = |(at, hole): (usize, &Hole<'p>)| {
            let rows = members.iter().filter_map(|member| entries.get(*member));
            let mut others = rows.filter_map(|row| row.holes.get(at));
            others.any(|other| !same(hole.filling, other.filling)).then_some((at, *hole))
        };
        let varying: Vec<(usize, Hole<'p>)> = holes.iter().enumerate().filter_map(differs).collect();
        let columns: Vec<(usize, Ident)> =
            varying.iter().map(|(at, hole)| (*at, self.reserve(&field(hole.name).to_string()))).collect();
        for ((_, hole), (_, name)) in varying.iter().zip(&columns) {
            self.position.columns.put(hole, name);
        }
        let code = emit(self, first);
        self.position.columns = Columns::default();
        columns.iter().for_each(|(_, name)| self.release(name));
        Some(Kind { holes, columns, name, code })
    }

    /// The rows, and the loop over them.
    fn loop_over(
        &mut self,
        entries: &[Entry<'_, 'p>],
        kinds: &[Kind<'_, 'p>],
        numbers: &HashMap<&Shape, usize>,
        lead: Lead<'_>,
    ) -> TokenStream {
        let uses_lead = kinds.iter().any(|kind| uses_variable(&kind.code, &lead.name.to_string()));
        let lead_type = uses_lead.then(|| lead.ty.clone());
        let lead_name = uses_lead.then(|| lead.name.to_token_stream());
        let family = self.family();
        let (declared, row_type, pattern, code) = match kinds {
            [kind] => {
                let types: Vec<_> = lead_type.into_iter().chain(kind.types(family, false)).collect();
                let names: Vec<_> = lead_name.into_iter().chain(kind.names()).collect();
                (TokenStream::new(), tuple(&types), tuple(&names), kind.code.clone())
            }
            kinds => {
                let variants = kinds.iter().map(|kind| kind.with(kind.types(family, true)));
                let declared = quote!(#[derive(Clone, Copy)] enum Row { #(#variants),* });
                let arms = kinds.iter().map(|kind| {
                    let (pattern, code) = (kind.with(kind.names()), &kind.code);
                    quote!(Row::#pattern => { #code })
                });
                let row = self.fresh("row");
                let types: Vec<_> = lead_type.into_iter().chain([quote!(Row)]).collect();
                let names: Vec<_> = lead_name.into_iter().chain([quote!(#row)]).collect();
                (declared, tuple(&types), tuple(&names), quote!(match #row { #(#arms)* }))
            }
        };
        let text = entries.iter().map(|entry| {
            let first = uses_lead.then(|| entry.lead.to_string());
            let kind = numbers.get(entry.shape).and_then(|number| kinds.get(*number));
            let columns = kind.map_or(&[][..], |kind| kind.columns.as_slice());
            let values = columns.iter().filter_map(|(at, _)| Some(self.in_column(entry.holes.get(*at)?.filling)));
            match kind.filter(|_| kinds.len() > 1) {
                None => in_row(first.into_iter().chain(values)),
                Some(Kind { name, .. }) => {
                    let values: Vec<String> = values.collect();
                    let values = if values.is_empty() { String::new() } else { format!("({})", values.join(", ")) };
                    in_row(first.into_iter().chain([format!("Row::{name}{values}")]))
                }
            }
        });
        let count = Literal::usize_unsuffixed(entries.len());
        let rows = self.unit.marks.rows(text.collect());
        quote! {
            {
                #declared
                static ROWS: [#row_type; #count] = #rows;
                for &#pattern in &ROWS {
                    #code
                }
            }
        }
    }
}

impl Body<'_, '_> {
    /// The text of a column's value.
    pub(in crate::emit) fn in_column(&self, filling: Filling<'_>) -> String {
        match filling {
            Filling::Constant(_, value) => consts::text(value),
            Filling::Variable(_, id) => self.place_in_array(id).to_string().replace(' ', ""),
        }
    }
}

impl Kind<'_, '_> {
    fn names(&self) -> Vec<TokenStream> {
        self.columns.iter().map(|(_, name)| name.to_token_stream()).collect()
    }

    fn types(&self, family: Family, in_enum: bool) -> Vec<TokenStream> {
        let holes = self.columns.iter().filter_map(|(at, _)| self.holes.get(*at));
        let types = holes.map(|hole| match hole.filling {
            Filling::Constant(_, value) => column_type(value.base(), family, in_enum),
            Filling::Variable(..) => quote!(usize),
        });
        types.collect()
    }

    /// `Lin(x, y)`
    fn with(&self, parts: Vec<TokenStream>) -> TokenStream {
        let name = &self.name;
        if parts.is_empty() { quote!(#name) } else { quote!(#name(#(#parts),*)) }
    }
}

/// The name of a kind of statement: that of the instruction or function that it calls.
fn word(expr: &Expr, body: &Body<'_, '_>) -> String {
    match &expr.kind {
        ExprKind::Builtin(builtin) => camel_case(&builtin.entry.name.to_ascii_lowercase()),
        ExprKind::Call(id, _) => camel_case(&body.unit.names.func(id.0).to_string()),
        _ => "Set".to_owned(),
    }
}

/// A name that no other kind has.
fn distinct(wanted: String, used: &mut HashSet<String>) -> Ident {
    let mut name = if wanted == "Self" { "SelfCall".to_owned() } else { wanted.clone() };
    let mut number = 2;
    while !used.insert(name.clone()) {
        name = format!("{wanted}{number}");
        number += 1;
    }
    ident(&name)
}

/// The type of a column; a `static` needs no lifetime for its strings.
pub(in crate::emit) fn column_type(base: Base, family: Family, in_enum: bool) -> TokenStream {
    match base {
        Base::String if in_enum => quote!(&'static str),
        Base::String => quote!(&str),
        base => base_type(base, family),
    }
}

/// `(line, x, y)`; a single part needs no parentheses.
fn tuple(parts: &[TokenStream]) -> TokenStream {
    match parts {
        [part] => part.clone(),
        parts => quote!((#(#parts),*)),
    }
}

/// The text of a row.
fn in_row(values: impl Iterator<Item = String>) -> String {
    let values: Vec<String> = values.collect();
    match values.as_slice() {
        [value] => format!("{value},\n"),
        values => format!("({}),\n", values.join(", ")),
    }
}

/// Whether two holes have the same filling; constants are compared bit by bit.
pub(in crate::emit) fn same(one: Filling<'_>, other: Filling<'_>) -> bool {
    match (one, other) {
        (Filling::Constant(_, Value::Double(one)), Filling::Constant(_, Value::Double(other))) => {
            one.to_bits() == other.to_bits()
        }
        (Filling::Constant(_, one), Filling::Constant(_, other)) => one == other,
        (Filling::Variable(_, one), Filling::Variable(_, other)) => one == other,
        _ => false,
    }
}
