//! The code of a table: its rows, and the loop over them.

use super::shape::{Hole, Row, Shape};
use crate::emit::body::{Body, Tail};
use crate::emit::consts;
use crate::emit::fragment::{Fragment, Precedence};
use crate::emit::names::{camel_case, field, ident};
use crate::emit::sequence::Mode;
use crate::emit::tokens::mentions;
use crate::emit::types::base_type;
use crate::hir::{Expr, ExprKind, Value};
use arl_lang::catalog::{Base, Family};
use proc_macro2::{Ident, Literal, TokenStream};
use quote::{ToTokens, quote};
use std::collections::{HashMap, HashSet};

/// What stands for constants and for the line while the statements of a table are emitted.
#[derive(Default, Debug)]
pub(in crate::emit) struct Columns {
    line: Option<Ident>,
    /// The columns of the constants, which are told by where they are.
    of: HashMap<*const Expr, Ident>,
}

impl Columns {
    /// The line of the row.
    pub(in crate::emit) fn line(&self) -> Option<TokenStream> {
        self.line.as_ref().map(ToTokens::to_token_stream)
    }

    /// Whether code names one of them.
    pub(in crate::emit) fn are_in(&self, code: &TokenStream) -> bool {
        self.line.iter().chain(self.of.values()).any(|name| mentions(code, &name.to_string()))
    }

    /// The column of a constant, in the way in which it is wanted.
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

/// Statements of one shape.
struct Kind<'r, 'p> {
    /// The one that is emitted.
    first: &'r Row<'p>,
    /// The columns: the numbers of the constants that differ, and their names.
    columns: Vec<(usize, Ident)>,
    code: TokenStream,
}

impl<'p> Body<'p, '_> {
    /// The code of a table.
    pub(in crate::emit) fn table(&mut self, rows: &[Row<'p>]) -> TokenStream {
        let mut numbers: HashMap<&Shape, usize> = HashMap::new();
        let mut of_kind: Vec<Vec<&Row<'p>>> = Vec::new();
        for row in rows {
            let next = of_kind.len();
            let number = *numbers.entry(&row.shape).or_insert(next);
            if number == next {
                of_kind.push(Vec::new());
            }
            of_kind.get_mut(number).into_iter().for_each(|rows| rows.push(row));
        }
        let line = self.reserve("line");
        let kinds: Vec<Kind<'_, 'p>> = of_kind.iter().filter_map(|rows| self.kind(rows, &line)).collect();
        let code = self.loop_over(rows, &kinds, &numbers, &line);
        self.release(&line);
        code
    }

    /// A kind of statement with its code.
    fn kind<'r>(&mut self, rows: &[&'r Row<'p>], line: &Ident) -> Option<Kind<'r, 'p>> {
        let first = *rows.first()?;
        let differs = |(at, hole): (usize, &Hole<'p>)| {
            let other = |row: &&Row<'p>| row.holes.get(at).is_none_or(|other| !same(hole.value, other.value));
            rows.iter().any(other).then_some((at, *hole))
        };
        let varying: Vec<(usize, Hole<'p>)> = first.holes.iter().enumerate().filter_map(differs).collect();
        let columns: Vec<(usize, Ident)> =
            varying.iter().map(|(at, hole)| (*at, self.reserve(&field(hole.name).to_string()))).collect();
        let of =
            varying.iter().zip(&columns).map(|((_, hole), (_, name))| (std::ptr::from_ref(hole.expr), name.clone()));
        self.columns = Columns { line: Some(line.clone()), of: of.collect() };
        let code = self.statement(first.stmt, Tail::Inner);
        self.columns = Columns::default();
        columns.iter().for_each(|(_, name)| self.release(name));
        Some(Kind { first, columns, code })
    }

    /// The rows, and the loop that runs them.
    fn loop_over(
        &mut self,
        rows: &[Row<'p>],
        kinds: &[Kind<'_, 'p>],
        numbers: &HashMap<&Shape, usize>,
        line: &Ident,
    ) -> TokenStream {
        let with_line = kinds.iter().any(|kind| mentions(&kind.code, &line.to_string()));
        let line_type = with_line.then(|| quote!(u32));
        let line_name = with_line.then(|| line.to_token_stream());
        let names: Vec<Ident> = kind_names(self, kinds);
        let types = |kind: &Kind<'_, 'p>, in_enum: bool| -> Vec<TokenStream> {
            let holes = kind.columns.iter().filter_map(|(at, _)| kind.first.holes.get(*at));
            holes.map(|hole| column_type(hole.value.base(), self.family(), in_enum)).collect()
        };
        let columns = |kind: &Kind<'_, 'p>| -> Vec<TokenStream> {
            kind.columns.iter().map(|(_, name)| name.to_token_stream()).collect()
        };
        let (declared, row_type, pattern, code) = match kinds {
            [kind] => {
                let types: Vec<_> = line_type.into_iter().chain(types(kind, false)).collect();
                let names: Vec<_> = line_name.into_iter().chain(columns(kind)).collect();
                (TokenStream::new(), tuple(&types), tuple(&names), kind.code.clone())
            }
            kinds => {
                let variants = kinds.iter().zip(&names).map(|(kind, name)| {
                    let types = types(kind, true);
                    if types.is_empty() { quote!(#name) } else { quote!(#name(#(#types),*)) }
                });
                let declared = quote!(#[derive(Clone, Copy)] enum Row { #(#variants),* });
                let arms = kinds.iter().zip(&names).map(|(kind, name)| {
                    let (columns, code) = (columns(kind), &kind.code);
                    let columns = (!columns.is_empty()).then(|| quote!((#(#columns),*)));
                    quote!(Row::#name #columns => { #code })
                });
                let row = self.fresh("row");
                let types: Vec<_> = line_type.into_iter().chain([quote!(Row)]).collect();
                let names: Vec<_> = line_name.into_iter().chain([quote!(#row)]).collect();
                (declared, tuple(&types), tuple(&names), quote!(match #row { #(#arms)* }))
            }
        };
        let text = rows.iter().map(|row| {
            let number = numbers.get(&row.shape).copied().unwrap_or(0);
            let line = with_line.then(|| self.unit.line(self.module, row.stmt.span).to_string());
            let values = kinds.get(number).into_iter().flat_map(|kind| &kind.columns);
            let values = values.filter_map(|(at, _)| Some(consts::text(row.holes.get(*at)?.value)));
            match (kinds, names.get(number)) {
                ([_], _) | (_, None) => in_row(line.into_iter().chain(values)),
                (_, Some(name)) => {
                    let values: Vec<String> = values.collect();
                    let values = if values.is_empty() { String::new() } else { format!("({})", values.join(", ")) };
                    in_row(line.into_iter().chain([format!("Row::{name}{values}")]))
                }
            }
        });
        let count = Literal::usize_unsuffixed(rows.len());
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

/// The names of the kinds: of the instructions and functions that they call.
fn kind_names(body: &Body<'_, '_>, kinds: &[Kind<'_, '_>]) -> Vec<Ident> {
    let mut used = HashSet::new();
    let name_of = |stmt: &Expr| match &stmt.kind {
        ExprKind::Builtin(builtin) => camel_case(&builtin.entry.name.to_ascii_lowercase()),
        ExprKind::Call(id, _) => camel_case(&body.unit.names.func(id.0).to_string()),
        _ => "Set".to_owned(),
    };
    let names = kinds.iter().map(|kind| {
        let wanted = name_of(kind.first.expr);
        let mut name = if wanted == "Self" { "SelfCall".to_owned() } else { wanted.clone() };
        let mut number = 2;
        while !used.insert(name.clone()) {
            name = format!("{wanted}{number}");
            number += 1;
        }
        ident(&name)
    });
    names.collect()
}

/// The type of a column; a `static` needs no lifetime for its texts.
fn column_type(base: Base, family: Family, in_enum: bool) -> TokenStream {
    match base {
        Base::String if in_enum => quote!(&'static str),
        Base::String => quote!(&str),
        base => base_type(base, family),
    }
}

/// `(line, x, y)`; one alone needs no parentheses.
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

/// Whether two constants are the same to the last bit.
fn same(one: &Value, other: &Value) -> bool {
    match (one, other) {
        (Value::Double(one), Value::Double(other)) => one.to_bits() == other.to_bits(),
        (one, other) => one == other,
    }
}
