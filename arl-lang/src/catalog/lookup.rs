//! Finding things by name. Names match without regard to case.

use std::collections::HashMap;
use std::hash::BuildHasherDefault;
use std::ops::Range;
use std::sync::LazyLock;

use super::entry::{Constant, Entry, Kind, Param, SystemVariable};
use super::types::Family;
use super::types::{Base, Enum, EnumDef, Handle, Struct, StructDef};
use crate::symbol::NameHasher;

/// The tables of one chapter of the manual.
#[derive(Clone, Copy, Debug)]
pub struct Chapter {
    /// What the entries have in common.
    pub title: &'static str,
    /// The entries in the order of the manual.
    pub entries: &'static [Entry],
}

/// All entries, chapter by chapter in the order of the manual.
pub const CHAPTERS: &[Chapter] = &[
    Chapter { title: "Motion", entries: super::motion::MOTION },
    Chapter { title: "Course of the program", entries: super::control::CONTROL },
    Chapter { title: "Printing and settings", entries: super::auxiliary::AUXILIARY },
    Chapter { title: "Mathematics", entries: super::math::MATH },
    Chapter { title: "Bits", entries: super::bits::BITS },
    Chapter { title: "Clocks", entries: super::clock::CLOCK },
    Chapter { title: "Strings", entries: super::strings::STRINGS },
    Chapter { title: "Inputs and outputs", entries: super::io::IO },
    Chapter { title: "Sockets", entries: super::socket::SOCKET },
    Chapter { title: "Serial lines", entries: super::serial::SERIAL },
    Chapter { title: "DeviceNet", entries: super::devicenet::DEVICENET },
    Chapter { title: "Modbus TCP", entries: super::modbus_tcp::MODBUS_TCP },
    Chapter { title: "Melsec", entries: super::melsec::MELSEC },
    Chapter { title: "Modbus RTU", entries: super::modbus_rtu::MODBUS_RTU },
    Chapter { title: "Conversions", entries: super::convert::CONVERT },
    Chapter { title: "Poses", entries: super::pose::POSE },
    Chapter { title: "Calibration", entries: super::calibration::CALIBRATION },
    Chapter { title: "Progress of the motion", entries: super::trigger::TRIGGER },
    Chapter { title: "Points and programs", entries: super::points::POINTS },
    Chapter { title: "Time, files, settings", entries: super::other::OTHER },
    Chapter { title: "Interrupts, timers, triggers", entries: super::interrupt::INTERRUPT },
];

const VARIABLES: [&[SystemVariable]; 4] =
    [super::system::DATA, super::system::FUNCTION, super::system::SOCKETS, super::system::EXTERNAL];

/// Names that old programs and the manual's misprints use, and what is right.
const RENAMED: &[(&str, &str)] = &[
    ("dfspped", "$DFSPEED"),
    ("weavedatalin", "weavedata"),
    ("bitlcs1", "bitlcs"),
    ("bitrcs1", "bitrcs"),
    ("setpwmi", "setpwm"),
    ("syncaov", "syncao"),
    ("ctcforce", "ctcpforce"),
];

type Names<T> = HashMap<&'static str, T, BuildHasherDefault<NameHasher>>;

/// The built-ins, with maps from their folded names.
struct Index {
    entries: Vec<Entry>,
    functions: Names<Range<usize>>,
    instructions: Names<Range<usize>>,
    variables: Names<&'static SystemVariable>,
    constants: Names<&'static Constant>,
    enum_constants: Names<(Enum, u16)>,
    types: Names<Base>,
    renamed: Names<&'static str>,
}

static INDEX: LazyLock<Index> = LazyLock::new(Index::build);

impl Index {
    fn build() -> Self {
        let mut entries: Vec<Entry> = CHAPTERS.iter().flat_map(|chapter| chapter.entries).copied().collect();
        entries.sort_by_cached_key(|entry| (entry.kind == Kind::Instruction, entry.name.to_ascii_lowercase()));
        let mut functions = Names::default();
        let mut instructions = Names::default();
        let mut start = 0;
        for group in entries.chunk_by(|a, b| a.kind == b.kind && a.name.eq_ignore_ascii_case(b.name)) {
            let range = start..start + group.len();
            start = range.end;
            for entry in group {
                let names = if entry.kind == Kind::Function { &mut functions } else { &mut instructions };
                for name in std::iter::once(&entry.name).chain(entry.aliases) {
                    names.insert(folded(name), range.clone());
                }
            }
        }
        let mut index = Self {
            entries,
            functions,
            instructions,
            variables: Names::default(),
            constants: super::constants::CONSTANTS.iter().map(|constant| (folded(constant.name), constant)).collect(),
            enum_constants: Names::default(),
            types: Names::default(),
            renamed: RENAMED.iter().copied().collect(),
        };
        for variable in system_variables() {
            for name in std::iter::once(&variable.name).chain(variable.aliases) {
                index.variables.insert(folded(name), variable);
            }
        }
        for id in Enum::ALL {
            for (at, constant) in (0..).zip(id.def().constants) {
                for name in std::iter::once(&constant.name).chain(constant.aliases) {
                    index.enum_constants.insert(folded(name), (id, at));
                }
            }
        }
        for (name, base) in type_names() {
            index.types.insert(folded(name), base);
        }
        index
    }
}

/// All types with all their names; `$VEL_PROFILE` without its `$`.
pub fn type_names() -> impl Iterator<Item = (&'static str, Base)> {
    let basic = [
        ("void", Base::Void),
        ("int", Base::Int),
        ("uint", Base::Uint),
        ("byte", Base::Byte),
        ("double", Base::Double),
        ("bool", Base::Bool),
        ("string", Base::String),
    ];
    let named = |name: &'static str, aliases: &'static [&'static str], base: Base| {
        std::iter::once(name).chain(aliases.iter().copied()).map(move |name| (name.trim_start_matches('$'), base))
    };
    let structs = Struct::ALL.into_iter().flat_map(move |id| {
        let def = id.def(Family::SixAxis);
        named(def.name, def.aliases, Base::Struct(id))
    });
    let enums = Enum::ALL.into_iter().flat_map(move |id| named(id.def().name, id.def().aliases, Base::Enum(id)));
    let handles = Handle::ALL.into_iter().flat_map(move |id| named(id.def().name, id.def().aliases, Base::Handle(id)));
    basic.into_iter().chain(structs).chain(enums).chain(handles)
}

/// The folded spelling, kept for the life of the program; called while the index is built only.
fn folded(name: &'static str) -> &'static str {
    if name.bytes().any(|byte| byte.is_ascii_uppercase()) {
        return Box::leak(name.to_ascii_lowercase().into_boxed_str());
    }
    name
}

/// Looks up a name of any case, without allocating. No built-in name is longer than the buffer.
fn find<T: Clone>(names: &Names<T>, name: &str) -> Option<T> {
    let mut buffer = [0; 32];
    let bytes = buffer.get_mut(..name.len())?;
    bytes.copy_from_slice(name.as_bytes());
    bytes.make_ascii_lowercase();
    names.get(str::from_utf8(bytes).ok()?).cloned()
}

fn group(names: &Names<Range<usize>>, name: &str) -> &'static [Entry] {
    find(names, name).and_then(|range| INDEX.entries.get(range)).unwrap_or(&[])
}

/// All functions and instructions, sorted by name; overloads follow each other.
pub fn all_entries() -> &'static [Entry] {
    &INDEX.entries
}

/// The overloads of a function; empty if there is no function of that name.
pub fn functions(name: &str) -> &'static [Entry] {
    group(&INDEX.functions, name)
}

/// The instruction of that name; empty if there is none.
pub fn instructions(name: &str) -> &'static [Entry] {
    group(&INDEX.instructions, name)
}

/// All system variables, chapter by chapter.
pub fn system_variables() -> impl Iterator<Item = &'static SystemVariable> {
    VARIABLES.into_iter().flatten()
}

/// The system variable of that name, which is given without `$`.
pub fn system_variable(name: &str) -> Option<&'static SystemVariable> {
    find(&INDEX.variables, name)
}

/// The system variable one of whose elements has that default name, which is given without `$`, and the element's
/// number.
///
/// ```
/// use arl_lang::catalog::{system_element, system_variable};
/// assert_eq!(system_element("tool7"), system_variable("TOOLS").map(|tools| (tools, 7)));
/// assert_eq!(system_element("tool32"), None);
/// ```
pub fn system_element(name: &str) -> Option<(&'static SystemVariable, u32)> {
    let digits = name.trim_start_matches(|letter: char| !letter.is_ascii_digit());
    let stem = name.get(..name.len() - digits.len())?;
    let number = digits.parse().ok().filter(|number: &u32| number.to_string() == digits)?;
    let variable = system_variables()
        .find(|variable| variable.elements.is_some_and(|elements| elements.eq_ignore_ascii_case(stem)))?;
    variable.dims.first().is_some_and(|size| number < *size).then_some((variable, number))
}

/// All constants with plain names.
pub fn constants() -> &'static [Constant] {
    super::constants::CONSTANTS
}

/// The constant of that name: `PI`, `endl`.
pub fn constant(name: &str) -> Option<&'static Constant> {
    find(&INDEX.constants, name)
}

/// The enumeration that has a constant of that name, and its number there. No name is in two enumerations.
pub fn enum_constant(name: &str) -> Option<(Enum, u16)> {
    find(&INDEX.enum_constants, name)
}

/// The type of that name, `void` and other spellings included. `$VEL_PROFILE` is found under `vel_profile`; see
/// [`Base::is_system`].
pub fn base_type(name: &str) -> Option<Base> {
    find(&INDEX.types, name)
}

/// Whether users cannot give this name to anything: Appendix A of the manual and the words of the control structures.
/// Built-in functions can be hidden, so they are not reserved.
pub fn reserved(name: &str) -> bool {
    crate::is_reserved(name)
}

/// The right name in place of an old or misprinted one, which may be given with or without `$`.
pub fn renamed(name: &str) -> Option<&'static str> {
    find(&INDEX.renamed, name.trim_start_matches('$'))
}

/// The instruction that an event after a motion is short for (manual 7.1).
pub fn trigger() -> Option<&'static Entry> {
    instructions("trigger").first()
}

/// The aliases that are spellings of older and later editions of the language; the others are this edition's own.
pub(super) const OTHER_EDITIONS: &[&str] =
    &["startweavelin", "startweavespa", "DETECT_SOCK_CLOSE", "ERR_SOCK_CLOSED", "mu_name"];

/// Whether a name is spelled as another edition of the language spells it, in any case.
pub fn is_of_other_edition(written: &str) -> bool {
    OTHER_EDITIONS.iter().any(|other| other.eq_ignore_ascii_case(written))
}

fn is_named(asked: &str, name: &str, aliases: &[&str]) -> bool {
    name.eq_ignore_ascii_case(asked) || aliases.iter().any(|alias| alias.eq_ignore_ascii_case(asked))
}

impl Base {
    /// The type's name in the manual's spelling.
    pub fn name(self) -> &'static str {
        match self {
            Base::Void => "void",
            Base::Int => "int",
            Base::Uint => "uint",
            Base::Byte => "byte",
            Base::Double => "double",
            Base::Bool => "bool",
            Base::String => "string",
            Base::Struct(id) => id.def(Family::SixAxis).name,
            Base::Enum(id) => id.def().name,
            Base::Handle(id) => id.def().name,
        }
    }

    /// Whether the type's name is written with `$`.
    pub fn is_system(self) -> bool {
        self.name().starts_with('$')
    }
}

impl SystemVariable {
    /// The default names of its elements, without `$`; none where they have no names.
    pub fn element_names(&self) -> impl Iterator<Item = String> {
        let count = self.dims.first().copied().unwrap_or_default();
        self.elements.into_iter().flat_map(move |name| (0..count).map(move |number| format!("{name}{number}")))
    }
}

impl Entry {
    /// The number of the parameter with this label.
    pub fn param(&self, label: &str) -> Option<usize> {
        self.params.iter().position(|param| param.is_named(label))
    }
}

impl Param {
    /// Whether this is one of the parameter's labels.
    pub fn is_named(&self, label: &str) -> bool {
        is_named(label, self.name, self.aliases)
    }
}

impl StructDef {
    /// The number of the component with this name.
    pub fn component(&self, name: &str) -> Option<usize> {
        self.components.iter().position(|component| is_named(name, component.name, component.aliases))
    }
}

impl EnumDef {
    /// The number of the constant with this name.
    pub fn constant(&self, name: &str) -> Option<u16> {
        let at = self.constants.iter().position(|constant| is_named(name, constant.name, constant.aliases))?;
        u16::try_from(at).ok()
    }
}
