//! Many global variables of one type as one array: rustc compiles a row for each instead of its code.
//!
//! Invariants:
//! - the variables of an array belong to one module and have one type; their values are `Copy`, and their initial
//!   values are constant;
//! - they are in the order of their declarations, and are initialised in that order among all other variables.

use super::Sizes;
use super::names::{Names, ident};
use super::types::is_copy;
use crate::hir::{Expr, ExprKind, Global, GlobalId, ModuleId, Program, Type};
use arl_lang::catalog::{Base, Family};
use proc_macro2::Ident;
use std::collections::{HashMap, HashSet};

/// The arrays of a program.
#[derive(Default, Debug)]
pub(super) struct Slots {
    arrays: Vec<SlotArray>,
    /// The array of a variable, and the variable's number in it.
    of: HashMap<GlobalId, (usize, usize)>,
}

/// Variables of one type.
#[derive(Debug)]
pub(super) struct SlotArray {
    pub(super) module: ModuleId,
    pub(super) ty: Type,
    /// Whether the values are read again on load.
    pub(super) teachable: bool,
    /// The field in the module's variables.
    pub(super) field: Ident,
    pub(super) members: Vec<GlobalId>,
}

impl Slots {
    /// The arrays of a program whose variables have these names.
    pub(super) fn new(program: &Program, names: &Names, sizes: Sizes) -> Self {
        let mut slots = Self::default();
        let mut found: HashMap<(ModuleId, Type, bool), Vec<GlobalId>> = HashMap::new();
        let mut order = Vec::new();
        for (at, global) in program.globals.iter().enumerate().filter(|(_, global)| may_be(global)) {
            let members = found.entry((global.module, global.ty, global.teachable)).or_insert_with(|| {
                order.push((global.module, global.ty, global.teachable));
                Vec::new()
            });
            members.push(GlobalId(at as u32));
        }
        let mut fields: HashSet<(ModuleId, String)> = HashSet::new();
        for (at, global) in program.globals.iter().enumerate() {
            fields.insert((global.module, names.global(at as u32).to_string()));
        }
        for key in order {
            let Some(members) = found.remove(&key).filter(|members| members.len() > sizes.variables) else { continue };
            let (module, ty, teachable) = key;
            let mut field = format!("{}s", word(ty, program.family));
            while !fields.insert((module, field.clone())) {
                field.push('_');
            }
            let number = slots.arrays.len();
            slots.of.extend(members.iter().enumerate().map(|(at, id)| (*id, (number, at))));
            slots.arrays.push(SlotArray { module, ty, teachable, field: ident(&field), members });
        }
        slots
    }

    /// The array of a variable, and the variable's number in it.
    pub(super) fn of(&self, id: GlobalId) -> Option<(&SlotArray, usize)> {
        let (array, at) = self.of.get(&id)?;
        Some((self.arrays.get(*array)?, *at))
    }

    /// The arrays of a module.
    pub(super) fn of_module(&self, module: ModuleId) -> impl Iterator<Item = &SlotArray> {
        self.arrays.iter().filter(move |array| array.module == module)
    }
}

/// Whether a variable may be stored in an array.
fn may_be(global: &Global) -> bool {
    global.value.is_none() && is_copy(global.ty) && global.init.as_ref().is_none_or(is_constant)
}

/// Whether a value consists of constants, as written in the program.
pub(super) fn is_constant(expr: &Expr) -> bool {
    match &expr.kind {
        ExprKind::Const(_) => true,
        ExprKind::Struct(_, values) => values.iter().flatten().all(is_constant),
        _ => false,
    }
}

/// The name of an array of the type, without the final `s`.
fn word(ty: Type, family: Family) -> &'static str {
    match ty.base {
        Base::Void => "void",
        Base::Int => "int",
        Base::Uint => "uint",
        Base::Byte => "byte",
        Base::Double => "double",
        Base::Bool => "bool",
        Base::String => "string",
        Base::Struct(id) => id.def(family).name,
        Base::Enum(id) => id.def().name,
        Base::Handle(id) => id.def().name,
    }
}
