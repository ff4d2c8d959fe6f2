//! Looks up the elements of arrays. An array is a pointer to its elements. For all rustc knows, any write in a loop
//! might change this pointer, so that it is read in each round. A loop in which nothing waits therefore looks it up
//! once.

use super::body::Body;
use super::types::{array_type, is_cells};
use crate::effects::facts;
use crate::hir::{Expr, ExprKind, GlobalId, LocalId, Passed, Place, Projection, Root, Stmt, Type};
use crate::visit;
use proc_macro2::{Ident, TokenStream};
use quote::quote;

/// The global arrays whose elements a surrounding loop has looked up, and the names of these elements.
pub(super) type LookedUp = Vec<(GlobalId, Ident)>;

/// How a loop uses an array.
struct Use<'p> {
    place: &'p Place,
    /// Whether only elements are used.
    elements_only: bool,
    written: bool,
}

/// The arrays that a loop uses, in the order of their use.
#[derive(Default)]
struct Uses<'p>(Vec<Use<'p>>);

impl<'p> Uses<'p> {
    fn see(&mut self, expr: &'p Expr) {
        // An assignment that changes nothing is not a write.
        let writes = facts::same_anyway(expr).is_none();
        match &expr.kind {
            ExprKind::Place(place) => self.place(place, false),
            ExprKind::Step(_, place) => self.place(place, writes),
            ExprKind::Assign(both) | ExprKind::AssignOp(_, both) => self.place(&both.0, writes),
            ExprKind::Builtin(builtin) => builtin.args.iter().for_each(|arg| {
                if let Passed::Out(place) = &arg.value {
                    // Built-ins may take the variable itself.
                    self.place(place, true);
                    self.whole(place.root);
                }
            }),
            _ => {}
        }
    }

    fn place(&mut self, place: &'p Place, written: bool) {
        let elements_only = matches!(place.path.first(), Some(Projection::Index(..)));
        match self.0.iter_mut().find(|used| is_same(used.place.root, place.root)) {
            Some(used) => {
                used.elements_only &= elements_only;
                used.written |= written;
            }
            None => self.0.push(Use { place, elements_only, written }),
        }
    }

    fn whole(&mut self, root: Root) {
        self.0.iter_mut().filter(|used| is_same(used.place.root, root)).for_each(|used| used.elements_only = false);
    }
}

/// Whether both are the same variable of the program.
fn is_same(one: Root, other: Root) -> bool {
    match (one, other) {
        (Root::Local(one), Root::Local(other)) => one == other,
        (Root::Global(one), Root::Global(other)) => one == other,
        _ => false,
    }
}

impl<'p> Body<'p, '_> {
    /// The statements that look up the elements of the arrays that a loop with these parts uses, with the names of the
    /// elements.
    pub(super) fn look_up(&mut self, blocks: &[&'p [Stmt]], exprs: &[&'p Expr]) -> Vec<(Ident, TokenStream)> {
        let mut uses = Uses::default();
        for stmt in blocks.iter().copied().flatten() {
            visit::exprs_in_stmt(stmt, &mut |expr| uses.see(expr));
        }
        exprs.iter().for_each(|expr| visit::exprs(expr, &mut |expr| uses.see(expr)));
        uses.0.iter().filter(|used| used.elements_only).filter_map(|used| self.look_up_array(used)).collect()
    }

    fn look_up_array(&mut self, used: &Use<'p>) -> Option<(Ident, TokenStream)> {
        match used.place.root {
            Root::Global(id) => {
                if !self.program().globals.get(id.0 as usize).is_some_and(|global| is_cells(global.ty)) {
                    return None;
                }
                let variable = self.whole_variable(used.place.root);
                let wanted = self.unit.names.global(id.0).to_string();
                let name = self.reserve(&wanted);
                self.locals.looked_up.push((id, name.clone()));
                let statement = quote!(let #name = #variable.elements(););
                Some((name, statement))
            }
            Root::Local(id) if self.locals.visible.contains(&id) && self.has_pointer(id) => {
                let name = self.local(id);
                let how = if used.written { quote!(elements_mut) } else { quote!(elements) };
                let statement = quote!(let #name = #name.#how(););
                Some((name, statement))
            }
            _ => None,
        }
    }

    /// Whether a local variable is a pointer to its elements and belongs to this function alone.
    fn has_pointer(&self, id: LocalId) -> bool {
        let is_array = |ty: Type| ty.is_array() && array_type(ty, self.family()) == "Array";
        self.func.is_some_and(|func| {
            let local = func.locals.get(id.0 as usize);
            !func.params.contains(&id) && local.is_some_and(|local| is_array(local.ty) && !local.shared)
        })
    }

    /// The name of the elements of a global array, if they have been looked up.
    pub(super) fn elements_of(&self, id: GlobalId) -> Option<&Ident> {
        self.locals.looked_up.iter().find(|(known, _)| *known == id).map(|(_, name)| name)
    }

    /// Forgets the arrays looked up since there were `before` of them.
    pub(super) fn forget_looked_up(&mut self, before: usize) {
        for (_, name) in self.locals.looked_up.split_off(before) {
            self.release(&name);
        }
    }
}
