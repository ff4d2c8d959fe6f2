//! The built-in types of ARL.

use super::facts::Range;

/// Which kind of robot a program is checked for; some types and instructions differ.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug, Default)]
pub enum Family {
    /// Six axes with a spherical wrist.
    #[default]
    SixAxis,
    /// Four axes: two arms, a lift, a turning flange.
    Scara,
}

/// A type without array dimensions.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Base {
    /// No value: the result of functions that return nothing.
    Void,
    /// 32 bits, signed, wraps.
    Int,
    /// 32 bits, unsigned, wraps.
    Uint,
    /// 8 bits, unsigned, wraps.
    Byte,
    /// IEEE 754, 64 bits.
    Double,
    /// true or false.
    Bool,
    /// Bytes, as a rule UTF-8.
    String,
    /// A structure.
    Struct(Struct),
    /// An enumeration.
    Enum(Enum),
    /// A handle: a clock, a socket, a device. Handles are not copied and have no operators.
    Handle(Handle),
}

/// The structures.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
#[expect(missing_docs, reason = "each has its text in its StructDef")]
pub enum Struct {
    Pos,
    Frame,
    Pose,
    Joint,
    Tool,
    Wobj,
    Weavedata,
    Speed,
    Slip,
    Jvel,
    CentroidPos,
    InertiaTensor,
    ToolInertiaPara,
    Control,
    Compendata,
    Jttq,
    Jtci,
    Tcpforce,
}

/// The enumerations.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
#[expect(missing_docs, reason = "each has its text in its EnumDef")]
pub enum Enum {
    VelProfile,
    Printto,
    NumBase,
    Stoptype,
    Controlmode,
    Stopbits,
    Parity,
    Weaveshape,
    Weaverotaxis,
    CompenType,
}

/// The handles.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
#[expect(missing_docs, reason = "each has its text in its HandleDef")]
pub enum Handle {
    Clock,
    Socket,
    Iodev,
    ModbusDev,
    MelsecDev,
}

/// The value of a component that was not set.
pub const UNSET: f64 = 9e9;

/// The value of a component before anything is assigned.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Start {
    /// [`UNSET`]: keeps the previous value.
    Unset,
    /// 0, false, "", an enumeration's first constant, a structure of start values.
    Zero,
    /// This number.
    Int(i32),
}

/// A component of a structure.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Component {
    /// Its name in the manual's spelling.
    pub name: &'static str,
    /// Other spellings that are accepted.
    pub aliases: &'static [&'static str],
    /// Its type.
    pub ty: Base,
    /// Its start value.
    pub start: Start,
    /// The numbers that make sense in it, besides 9e+09 where that is its start value; others cause a warning where
    /// known.
    pub range: Option<Range>,
    /// What it means, with its unit.
    pub doc: &'static str,
    /// Whether it can be set by position; `jdis` of slip is set by name only.
    pub by_position: bool,
}

/// A structure of one robot family.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct StructDef {
    /// Which structure.
    pub id: Struct,
    /// Its name in the manual's spelling.
    pub name: &'static str,
    /// Other spellings that are accepted.
    pub aliases: &'static [&'static str],
    /// The family, where the structure is of one family only.
    pub family: Option<Family>,
    /// The runtime's type in `arl_rt::values`. A component's field is its folded name.
    pub rust: &'static str,
    /// The components in the order of the manual.
    pub components: &'static [Component],
    /// What it describes.
    pub doc: &'static str,
    /// Section of the manual.
    pub section: &'static str,
}

/// A constant of an enumeration.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct EnumConst {
    /// Its name in the manual's spelling, which is also how it prints.
    pub name: &'static str,
    /// Other spellings that are accepted (`T1` for `MANUAL`).
    pub aliases: &'static [&'static str],
    /// The variant of the runtime's type.
    pub rust: &'static str,
    /// What it means.
    pub doc: &'static str,
}

/// An enumeration. The constants stand for 0, 1, 2, ...
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct EnumDef {
    /// Which enumeration.
    pub id: Enum,
    /// Its name in the manual's spelling, with `$` for `$VEL_PROFILE`.
    pub name: &'static str,
    /// Other spellings that are accepted.
    pub aliases: &'static [&'static str],
    /// The runtime's type in `arl_rt::values`.
    pub rust: &'static str,
    /// Its constants.
    pub constants: &'static [EnumConst],
    /// What it is for.
    pub doc: &'static str,
    /// Section of the manual.
    pub section: &'static str,
}

/// A handle type.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct HandleDef {
    /// Which handle.
    pub id: Handle,
    /// Its name.
    pub name: &'static str,
    /// Other spellings that are accepted.
    pub aliases: &'static [&'static str],
    /// The runtime's type in `arl_rt::values`.
    pub rust: &'static str,
    /// What it is for.
    pub doc: &'static str,
    /// Section of the manual.
    pub section: &'static str,
}
