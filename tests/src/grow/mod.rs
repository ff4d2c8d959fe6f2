//! Grows random programs that are right by construction.

mod constant;
mod control;
mod expr;
mod names;
mod place;
mod program;
mod stmt;

use crate::random::Random;
use crate::tree::{Expr, Kind, Program, Var, Variable};
use crate::value::{Base, STRUCTS, Type};

pub use program::{Shape, linear, program};

/// The types of which every program has global variables.
pub const BASES: [Base; 6] = [Base::Int, Base::Uint, Base::Byte, Base::Double, Base::Bool, Base::Str];

/// What grows programs: the program so far and the function that is being written.
#[derive(Debug)]
pub struct Grower {
    /// Where all choices come from.
    pub random: Random,
    /// What is finished.
    pub program: Program,
    /// The module of the function.
    module: usize,
    locals: Vec<Variable>,
    scopes: Vec<Vec<usize>>,
    labels: Vec<String>,
    /// Labels that are jumped to and stand further below.
    promised: Vec<usize>,
    /// Variables that only count turns.
    guards: Vec<usize>,
    result: Base,
    /// The function calls itself with one less in this variable.
    depth: Option<usize>,
    /// Percent of divisors, indices and so on that nothing keeps in range.
    risk: usize,
    /// Percent of expressions with side effects.
    effects: usize,
    /// Whether `waittime` may stand in the function.
    waits: bool,
    /// Whether the program jumps.
    jumps: bool,
    loops: usize,
    /// The statements that the function may still get.
    room: usize,
}

impl Grower {
    fn new(seed: u64) -> Self {
        Self {
            random: Random::new(seed),
            program: Program::default(),
            module: 0,
            locals: Vec::new(),
            scopes: Vec::new(),
            labels: Vec::new(),
            promised: Vec::new(),
            guards: Vec::new(),
            result: Base::Void,
            depth: None,
            risk: 0,
            effects: 15,
            waits: false,
            jumps: false,
            loops: 0,
            room: 0,
        }
    }

    /// Any type of a single value.
    fn any_base(&mut self) -> Base {
        match self.random.below(10) {
            0 => Base::Enum(self.random.below(crate::value::ENUMS.len())),
            1 => Base::Struct(self.random.below(STRUCTS.len())),
            _ => *self.random.pick(&BASES),
        }
    }

    /// Any type, arrays included.
    fn any_type(&mut self) -> Type {
        let base = self.any_base();
        match self.random.below(12) {
            0 => Type { base, sizes: [[2, 3, 4, 8][self.random.below(4)], 0] },
            1 => Type { base, sizes: [2, [2, 4][self.random.below(2)]] },
            _ => Type::one(base),
        }
    }

    fn declare(&mut self, name: String, ty: Type) -> usize {
        self.locals.push(Variable { name, ty, constant: false, value: None });
        let local = self.locals.len() - 1;
        if let Some(scope) = self.scopes.last_mut() {
            scope.push(local);
        }
        local
    }

    /// The variables that can be named here.
    fn visible(&self) -> Vec<(Var, bool)> {
        let mut found: Vec<(Var, bool)> = Vec::new();
        let mut names: Vec<&str> = Vec::new();
        for local in self.scopes.iter().rev().flat_map(|scope| scope.iter().rev()) {
            let name = self.locals[*local].name.as_str();
            if !names.iter().any(|other| other.eq_ignore_ascii_case(name)) {
                names.push(name);
                found.push((Var::Local(*local), false));
            }
        }
        for (at, global) in self.program.globals.iter().enumerate() {
            let hidden = names.iter().any(|other| other.eq_ignore_ascii_case(&global.variable.name));
            found.push((Var::Global(at), hidden && global.module == self.module));
        }
        found
    }

    fn variable(&self, var: Var) -> &Variable {
        match var {
            Var::Local(local) => &self.locals[local],
            Var::Global(global) => &self.program.globals[global].variable,
        }
    }

    /// A variable as an expression.
    fn var(&mut self, var: Var, hidden: bool) -> Expr {
        let variable = self.variable(var);
        let (ty, constant) = (variable.ty, variable.value.clone());
        let qualified = hidden || (matches!(var, Var::Global(_)) && self.random.chance(4));
        Expr { kind: Kind::Var { var, qualified }, ty, constant, pattern: false }
    }

    fn local(&self, local: usize) -> Expr {
        let variable = &self.locals[local];
        let kind = Kind::Var { var: Var::Local(local), qualified: false };
        Expr { kind, ty: variable.ty, constant: variable.value.clone(), pattern: false }
    }
}
