//! Decides which statements become tables.

use super::shape::{Shape, StatementRow};
use crate::effects::flow;
use crate::emit::Sizes;
use crate::emit::body::Body;
use crate::hir::{ExprKind, Stmt};
use std::collections::HashMap;

/// Statements that are emitted together.
#[derive(Debug)]
pub(in crate::emit) enum Group<'p> {
    /// A single statement, unchanged.
    Alone(&'p Stmt),
    /// The statements of a table.
    Table(Vec<StatementRow<'p>>),
}

/// A kind that occurs once in a run stays outside the tables if it is between two tables with this many rows each on
/// average, or before or after all tables: there it is more readable than in a table.
const ROWS_BESIDE: usize = 32;

/// The number of times that a run is cut at a kind that occurs once.
const MOST_CUTS: usize = 8;

impl<'p> Body<'p, '_> {
    /// The statements of a block, grouped as they are emitted.
    pub(in crate::emit) fn groups(&self, statements: Vec<&'p Stmt>) -> Vec<Group<'p>> {
        let sizes = self.unit.sizes;
        let mut groups = Vec::with_capacity(statements.len());
        let mut run = Vec::new();
        for stmt in statements {
            match self.row(stmt) {
                Some(row) => run.push(row),
                None => {
                    arrange(sizes, std::mem::take(&mut run), MOST_CUTS, &mut groups);
                    groups.push(Group::Alone(stmt));
                }
            }
        }
        arrange(sizes, run, MOST_CUTS, &mut groups);
        groups
    }

    /// A statement as a row, if possible: it writes and declares no local, and continues with the next statement. A
    /// call that leads back stays alone: right before the first one the function asks for room.
    fn row(&self, stmt: &'p Stmt) -> Option<StatementRow<'p>> {
        let row = StatementRow::of(stmt, self.family(), &self.unit.slots)?;
        let is_call = matches!(row.expr.kind, ExprKind::Call(..) | ExprKind::Builtin(_) | ExprKind::Assign(_));
        let stays = flow::ends(row.expr) || !self.facts(row.expr).writes.is_empty() || self.calls_itself(stmt);
        (is_call && !stays).then_some(row)
    }
}

/// Splits a run into tables and single statements.
fn arrange<'p>(sizes: Sizes, run: Vec<StatementRow<'p>>, cuts: usize, groups: &mut Vec<Group<'p>>) {
    let mut counts: HashMap<&Shape, usize> = HashMap::new();
    run.iter().for_each(|row| *counts.entry(&row.shape).or_default() += 1);
    let single: Vec<bool> = run.iter().map(|row| counts.get(&row.shape) == Some(&1)).collect();
    let (kinds, once) = (counts.len(), single.iter().filter(|single| **single).count());
    let is_table = run.len() >= sizes.table && run.len() >= sizes.rows_of_a_kind.saturating_mul(kinds);
    let at_an_end = single.first() == Some(&true) || single.last() == Some(&true);
    let far_between = run.len() >= ROWS_BESIDE.saturating_mul(once + 1);
    let cut = once > 0 && (at_an_end || far_between) && sizes.table > 1;
    if is_table && !cut && !run.is_empty() {
        groups.push(Group::Table(run));
        return;
    }
    if once > 0 && cuts > 0 {
        let mut piece = Vec::new();
        for (row, single) in run.into_iter().zip(single) {
            if single {
                arrange(sizes, std::mem::take(&mut piece), cuts - 1, groups);
                groups.push(Group::Alone(row.stmt));
            } else {
                piece.push(row);
            }
        }
        arrange(sizes, piece, cuts - 1, groups);
        return;
    }
    stretches(sizes, run, groups);
}

/// Turns stretches of one kind into tables if they are long enough.
fn stretches<'p>(sizes: Sizes, run: Vec<StatementRow<'p>>, groups: &mut Vec<Group<'p>>) {
    let mut rows = run.into_iter().peekable();
    while let Some(first) = rows.next() {
        let mut stretch = vec![first];
        while let Some(row) = rows.next_if(|row| stretch.first().is_some_and(|first| first.shape == row.shape)) {
            stretch.push(row);
        }
        if stretch.len() >= sizes.table {
            groups.push(Group::Table(stretch));
        } else {
            groups.extend(stretch.into_iter().map(|row| Group::Alone(row.stmt)));
        }
    }
}
