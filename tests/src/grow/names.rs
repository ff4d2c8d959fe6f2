//! Names, many of them words of Rust or of what emitted code uses.

use super::Grower;
use crate::random::Random;
use crate::value::{STRUCTS, components};

/// Names of variables, functions and labels.
const NAMES: &str = "\
    a b c n i j k x y z count total speed1 part_2 Abc _x __ x_ r2d2 match fn impl self Self crate super async \
    await dyn type move ref mut pub use mod let enum struct trait unsafe where extern static yield try abstract \
    final box gen macro union priv virtual typeof1 become override do in as i32 u8 u32 f64 str Str Cell Shared \
    Array SmallArray Cx cx g Globals Done Stop Variables wait old value at State state Some None1 Ok Err Result \
    Option Vec Box1 div rem shl shr index index2 math bits strings convert flow motion init new it values drop \
    Clone Default1 Printed std core alloc arl_rt depth _depth main first next last left right it_2 old_2 value2 \
    at_1 i2 i_2 a_1 a1 ffh each beach dah fast odd j1 cfg t_frame Rust assert_eq panic vec format include line \
    enter spend late Future Pin Program Family Pos1 Double1 Teach Fixed rem_double in_range one_of is_true loop1 Start \
    End label start";

/// Names of files.
const MODULES: &str = "\
    prog match self crate super globals program std core arl_rt emit main values Cell x fn async io text math \
    super_2 Upper variables state file cx g";

/// One of these words.
fn word(words: &'static str, random: &mut Random) -> &'static str {
    let words: Vec<&str> = words.split_whitespace().collect();
    words[random.below(words.len())]
}

impl Grower {
    /// A name for a local that its scope does not have.
    pub(super) fn local_name(&mut self) -> String {
        loop {
            let name = self.any_name();
            let mut scope = self.scopes.last().into_iter().flatten();
            if !scope.any(|local| self.locals[*local].name.eq_ignore_ascii_case(&name)) {
                return name;
            }
        }
    }

    fn any_name(&mut self) -> String {
        let name = word(NAMES, &mut self.random);
        if self.random.chance(15) { format!("{name}{}", self.random.below(4)) } else { name.to_owned() }
    }

    pub(super) fn label_name(&mut self) -> String {
        loop {
            let name = self.any_name();
            if !self.labels.iter().any(|label| label.eq_ignore_ascii_case(&name)) {
                return name;
            }
        }
    }

    pub(super) fn global_name(&mut self, module: usize) -> String {
        loop {
            let name = self.any_name();
            let mut globals = self.program.globals.iter().filter(|global| global.module == module);
            if !globals.any(|global| global.variable.name.eq_ignore_ascii_case(&name)) {
                return name;
            }
        }
    }

    pub(super) fn func_name(&mut self, module: usize) -> String {
        loop {
            let name = self.any_name();
            let mut funcs = self.program.funcs.iter().filter(|func| func.module == module);
            // `{x (a)}` is a call where everything in the braces can be one.
            let mut components = (0..STRUCTS.len()).flat_map(components);
            if components.any(|(component, ..)| component.eq_ignore_ascii_case(&name)) {
                continue;
            }
            if !name.eq_ignore_ascii_case("main") && !funcs.any(|func| func.name.eq_ignore_ascii_case(&name)) {
                return name;
            }
        }
    }

    pub(super) fn module_name(&mut self) -> String {
        loop {
            let name = word(MODULES, &mut self.random);
            if !self.program.modules.iter().any(|module| module.eq_ignore_ascii_case(name)) {
                return name.to_owned();
            }
        }
    }

    /// Whether any variable has this name.
    pub(super) fn is_variable(&self, name: &str) -> bool {
        let locals = self.locals.iter().map(|local| &local.name);
        let globals = self.program.globals.iter().map(|global| &global.variable.name);
        locals.chain(globals).any(|other| other.eq_ignore_ascii_case(name))
    }
}
