//! The notation of the tables in this folder.
//!
//! An entry reads like its ARL prototype, followed by a block with the manual's section, the runtime's path, the
//! effect and further marks, and an example:
//!
//! ```text
//! entries! { pub(super) MATH =
//!     /// Splits a number into fraction and power of two.
//!     fn frexp(val: double "the number", exp: {int} [out] "gets the exponent") -> double
//!         { "5.1.20", math::frexp_int, pure; "int e\nprint frexp(64,e),\" \",e" }
//! }
//! ```
//!
//! Types: a name takes what converts to it, `{name}` exactly that type, `{a, b}` exactly one of them, `[name]` an array
//! of it, `any` everything but handles. The marks in brackets are the methods of [`Param`] below, the marks after the
//! path those of [`Entry`].

use super::entry::{Access, Effect, Entry, Kind, Mode, Param, ParamType, Presence, Restore, SystemVariable, Takes};
use super::facts::{Accepted, Form, Motion, PoseShift, Range, Relation, Role, Space};
use super::types::{Base, Component, Family, Start};
use crate::ast::Unit;

/// The type with this name.
macro_rules! base {
    (void) => { $crate::catalog::Base::Void };
    (int) => { $crate::catalog::Base::Int };
    (uint) => { $crate::catalog::Base::Uint };
    (byte) => { $crate::catalog::Base::Byte };
    (double) => { $crate::catalog::Base::Double };
    (bool) => { $crate::catalog::Base::Bool };
    (string) => { $crate::catalog::Base::String };
    (pos) => { base!(@struct Pos) };
    (frame) => { base!(@struct Frame) };
    (pose) => { base!(@struct Pose) };
    (joint) => { base!(@struct Joint) };
    (tool) => { base!(@struct Tool) };
    (wobj) => { base!(@struct Wobj) };
    (weavedata) => { base!(@struct Weavedata) };
    (speed) => { base!(@struct Speed) };
    (slip) => { base!(@struct Slip) };
    (jvel) => { base!(@struct Jvel) };
    (centroid_pos) => { base!(@struct CentroidPos) };
    (inertia_tensor) => { base!(@struct InertiaTensor) };
    (tool_inertia_para) => { base!(@struct ToolInertiaPara) };
    (control) => { base!(@struct Control) };
    (compendata) => { base!(@struct Compendata) };
    (jttq) => { base!(@struct Jttq) };
    (jtci) => { base!(@struct Jtci) };
    (tcpforce) => { base!(@struct Tcpforce) };
    (vel_profile) => { base!(@enum VelProfile) };
    (printto) => { base!(@enum Printto) };
    (num_base) => { base!(@enum NumBase) };
    (stoptype) => { base!(@enum Stoptype) };
    (controlmode) => { base!(@enum Controlmode) };
    (stopbits) => { base!(@enum Stopbits) };
    (parity) => { base!(@enum Parity) };
    (weaveshape) => { base!(@enum Weaveshape) };
    (weaverotaxis) => { base!(@enum Weaverotaxis) };
    (compentype) => { base!(@enum CompenType) };
    (clock) => { base!(@handle Clock) };
    (socket) => { base!(@handle Socket) };
    (iodev) => { base!(@handle Iodev) };
    (modbus_dev) => { base!(@handle ModbusDev) };
    (melsec_dev) => { base!(@handle MelsecDev) };
    (@struct $id:ident) => { $crate::catalog::Base::Struct($crate::catalog::Struct::$id) };
    (@enum $id:ident) => { $crate::catalog::Base::Enum($crate::catalog::Enum::$id) };
    (@handle $id:ident) => { $crate::catalog::Base::Handle($crate::catalog::Handle::$id) };
}

/// The type that a parameter takes.
macro_rules! param_type {
    (any) => { $crate::catalog::ParamType::Any };
    ([$base:ident]) => { $crate::catalog::ParamType::Array(base!($base)) };
    ({$($base:ident),+}) => { $crate::catalog::ParamType::AnyOf(&[$(base!($base)),+]) };
    ($base:ident) => { $crate::catalog::ParamType::One(base!($base)) };
}

/// `fn` or `instr`.
macro_rules! kind {
    (fn) => {
        $crate::catalog::Kind::Function
    };
    (instr) => {
        $crate::catalog::Kind::Instruction
    };
}

/// The name of a Rust item for an ARL name: the folded name.
macro_rules! folded {
    ($name:ident) => {{
        const LOWER: [u8; stringify!($name).len()] = $crate::catalog::declare::lower(stringify!($name));
        match str::from_utf8(&LOWER) {
            Ok(text) => text,
            Err(_) => "",
        }
    }};
}

/// A table of functions (`fn`) and instructions (`instr`).
macro_rules! entries {
    ($vis:vis $table:ident = $(
        $(#[doc = $doc:literal])+
        $kind:ident $name:ident (
            $($param:ident : $ty:tt $([$($mark:ident $(($($arg:expr),*))?),*])? $about:literal),* $(,)?
        ) $(-> $result:ident)?
            { $section:literal, $module:ident :: $function:ident, $effect:ident $(($how:expr))?
                $(, $flag:ident $(($($value:expr),*))?)* ; $example:literal }
    )*) => {
        $vis const $table: &[$crate::catalog::Entry] = &[$(
            $crate::catalog::Entry::declare(kind!($kind), stringify!($name), concat!($($doc),+))
                .params(const { &[$(
                    $crate::catalog::Param::declare(stringify!($param), folded!($param), param_type!($ty), $about)
                        $($(.$mark($($($arg),*)?))*)?
                ),*] })
                $(.result(base!($result)))?
                .place($section, concat!(stringify!($module), "::", stringify!($function)), $example)
                .$effect($($how)?)
                $(.$flag($($($value),*)?))*
        ),*];
    };
}

/// A table of system variables: `NAME: type[size] = "default" { "section", when it is restored, marks; "example" }`.
macro_rules! variables {
    ($vis:vis $table:ident = $(
        $(#[doc = $doc:literal])+
        $name:ident : $ty:ident $([$size:literal])? = $default:literal
            { $section:literal, $restore:ident $(, $flag:ident $(($($value:expr),*))?)* ; $example:literal }
    )*) => {
        $vis const $table: &[$crate::catalog::SystemVariable] = &[$(
            $crate::catalog::SystemVariable::declare(stringify!($name), folded!($name), base!($ty), concat!($($doc),+))
                .dims(&[$($size)?])
                .value($default)
                .place($section, $example)
                .$restore()
                $(.$flag($($($value),*)?))*
        ),*];
    };
}

/// Components of a structure: names that share type, start value and text.
macro_rules! components {
    ($($($name:ident)+ : $ty:ident $start:ident $(($value:literal))? $([$($mark:ident $(($($arg:expr),*))?),*])? $about:literal),* $(,)?) => {
        components!(@list [] $({ [$($name)+] (base!($ty)) (components!(@start $start $($value)?)) ($($(.$mark($($($arg),*)?))*)?) $about })*)
    };
    (@start unset) => { $crate::catalog::Start::Unset };
    (@start zero) => { $crate::catalog::Start::Zero };
    (@start starts $value:literal) => { $crate::catalog::Start::Int($value) };
    (@list [$($done:tt)*]) => { &[$($done)*] };
    (@list [$($done:tt)*] { [] $ty:tt $start:tt $marks:tt $about:literal } $($rest:tt)*) => {
        components!(@list [$($done)*] $($rest)*)
    };
    (@list [$($done:tt)*] { [$name:ident $($more:ident)*] ($ty:expr) ($start:expr) ($($marks:tt)*) $about:literal } $($rest:tt)*) => {
        components!(@list
            [$($done)* $crate::catalog::Component::declare(stringify!($name), $ty, $start, $about) $($marks)*,]
            { [$($more)*] ($ty) ($start) ($($marks)*) $about } $($rest)*)
    };
}

pub(super) use {base, components, entries, folded, kind, param_type, variables};

/// The bytes of `name` in lower case; `N` is its length.
pub(super) const fn lower<const N: usize>(name: &str) -> [u8; N] {
    let mut folded = [0; N];
    let bytes = name.as_bytes();
    let mut at = 0;
    while at < N && at < bytes.len() {
        folded[at] = bytes[at].to_ascii_lowercase();
        at += 1;
    }
    folded
}

/// The text of doc comments without blanks around it.
const fn trimmed(text: &'static str) -> &'static str {
    text.trim_ascii()
}

impl Param {
    /// A required parameter that may be given without its label.
    pub(super) const fn declare(name: &'static str, rust: &'static str, ty: ParamType, doc: &'static str) -> Self {
        Self {
            name,
            aliases: &[],
            rust,
            ty,
            mode: Mode::In,
            presence: Presence::Required,
            bare: true,
            family: None,
            units: &[],
            range: None,
            doubted: false,
            set: false,
            keeps: false,
            counts: None,
            addresses: None,
            relation: None,
            accepts: None,
            delays: false,
            limits: false,
            doc,
        }
    }
}

/// Declares chainable setters.
macro_rules! setters {
    ($owner:ty : $($(#[doc = $doc:literal])+ $name:ident ($($arg:ident : $ty:ty),*) { $($field:ident = $value:expr),+ })*) => {
        impl $owner {
            $(
                $(#[doc = $doc])+
                pub(super) const fn $name(mut self, $($arg: $ty),*) -> Self {
                    $(self.$field = $value;)+
                    self
                }
            )*
        }
    };
}

setters! { Param:
    /// A variable that is written.
    out() { mode = Mode::Out }
    /// An expression that is evaluated again and again.
    condition() { mode = Mode::Condition }
    /// An expression that is evaluated when an event occurs.
    action() { mode = Mode::Action }
    /// May be missing.
    optional() { presence = Presence::Optional }
    /// May be missing; this ARL text then takes its place.
    otherwise(text: &'static str) { presence = Presence::Default(text) }
    /// May be given this many times.
    repeat(min: u8, max: u8) { presence = Presence::Repeat { min, max } }
    /// Must have its label.
    labelled() { bare = false }
    /// For one robot family only.
    of(family: Family) { family = Some(family) }
    /// The units that may follow a number.
    units(units: &'static [Unit]) { units = units }
    /// The least and greatest constant.
    range(low: f64, high: f64) { range = Some(Range::Within(low, high)) }
    /// Constants above this one.
    above(low: f64) { range = Some(Range::Above(low)) }
    /// The least constant.
    at_least(low: f64) { range = Some(Range::AtLeast(low)) }
    /// The greatest constant.
    at_most(high: f64) { range = Some(Range::AtMost(high)) }
    /// A bare number far below the usual values is most often meant in another unit.
    doubted() { doubted = true }
    /// Not 9e+09, which means "not set".
    set() { set = true }
    /// The name of a system variable that can be saved.
    keeps() { keeps = true }
    /// The number of items in the array passed with it, of this many bits each.
    counts(bits: u32) { counts = Some(bits) }
    /// The first or the last addressed place of this space.
    addresses(space: Space) { addresses = Some(space) }
    /// How much is addressed; this many units make one place.
    extent(per_place: u32) { relation = Some(Relation::Extent(per_place)) }
    /// The value that the addressed place gets.
    content() { relation = Some(Relation::Content) }
    /// What a connection accepts.
    accepts(numbers: Accepted) { accepts = Some(numbers) }
    /// A time for which the call waits.
    delays() { delays = true }
    /// The longest time for which the call waits.
    limits() { limits = true }
    /// Other labels.
    alias(names: &'static [&'static str]) { aliases = names }
    /// The builder's method, where the folded name is a word of Rust.
    rust(name: &'static str) { rust = name }
}

impl Entry {
    /// A pure entry without parameters or result, which does not fail and may run in the background.
    pub(super) const fn declare(kind: Kind, name: &'static str, doc: &'static str) -> Self {
        Self {
            name,
            aliases: &[],
            kind,
            params: &[],
            exclusive: &[],
            result: Base::Void,
            family: None,
            effect: Effect::Pure,
            fails: false,
            background: true,
            form: Form::Call,
            motion: None,
            shift: None,
            changes: None,
            ended_by: None,
            connects: false,
            uses_disk: false,
            teaches: false,
            halts: false,
            looks: false,
            path: "",
            doc: trimmed(doc),
            section: "",
            example: "",
        }
    }
}

setters! { Entry:
    /// The parameters.
    params(params: &'static [Param]) { params = params }
    /// The type of the result.
    result(base: Base) { result = base }
    /// The manual's section, the runtime's function, an example.
    place(section: &'static str, path: &'static str, example: &'static str) { section = section, path = path, example = example }
    /// A function of its arguments alone.
    pure() { effect = Effect::Pure }
    /// Looks at or changes the controller at once.
    acts() { effect = Effect::Acts }
    /// Plans motion; not in the background.
    plans(motion: Motion) { effect = Effect::Plans, background = false, motion = Some(motion) }
    /// Takes its time; motion continues.
    lasts() { effect = Effect::Lasts }
    /// Waits until all earlier motion has ended.
    waits() { effect = Effect::Waits }
    /// Ends the program or starts it again.
    ends() { effect = Effect::Ends }
    /// Not translated as a plain call.
    form(form: Form) { form = form }
    /// Shifts and turns the pose `p`.
    shifts(axes: PoseShift) { shift = Some(axes) }
    /// Changes what motion depends on.
    changes(role: Role) { changes = Some(role) }
    /// Begins what another instruction ends.
    until(name: &'static str) { ended_by = Some(name) }
    /// Opens a connection.
    connects() { connects = true }
    /// Waits for the disk.
    uses_disk() { uses_disk = true }
    /// Writes points of a program while the program runs.
    teaches() { teaches = true }
    /// Stops the robot until the program lets it continue.
    halts() { halts = true }
    /// Only reads, changes nothing.
    looks() { looks = true }
    /// An alarm is possible.
    fails() { fails = true }
    /// Not in background channels.
    foreground() { background = false }
    /// For one robot family only.
    only(family: Family) { family = Some(family) }
    /// Other spellings.
    alias(names: &'static [&'static str]) { aliases = names }
    /// Groups of parameters of which at most one may be given.
    exclusive(groups: &'static [&'static [&'static str]]) { exclusive = groups }
}

impl SystemVariable {
    /// A variable that programs may write.
    pub(super) const fn declare(name: &'static str, field: &'static str, ty: Base, doc: &'static str) -> Self {
        Self {
            name,
            aliases: &[],
            elements: None,
            ty,
            dims: &[],
            access: Access::ReadWrite,
            takes: Takes::All,
            restore: Restore::Reset,
            default: "",
            role: None,
            field,
            doc: trimmed(doc),
            section: "",
            example: "",
        }
    }
}

setters! { SystemVariable:
    /// Array sizes.
    dims(sizes: &'static [u32]) { dims = sizes }
    /// The default, as ARL text.
    value(text: &'static str) { default = text }
    /// The manual's section and an example.
    place(section: &'static str, example: &'static str) { section = section, example = example }
    /// Goes back to its default at each program reset.
    reset() { restore = Restore::Reset }
    /// Goes back to the last saved value at start-up.
    saved() { restore = Restore::Saved }
    /// Keeps every change.
    permanent() { restore = Restore::Permanent }
    /// Goes back to its default at start-up.
    startup() { restore = Restore::Startup }
    /// Written by the controller only.
    readonly() { access = Access::ReadOnly }
    /// The least and greatest value.
    range(low: f64, high: f64) { takes = Takes::Range(low, high) }
    /// Its role for motion.
    role(role: Role) { role = Some(role) }
    /// The names of its elements, without their number.
    elements(name: &'static str) { elements = Some(name) }
    /// The texts that it takes.
    words(words: &'static [&'static str]) { takes = Takes::Words(words) }
    /// Other spellings.
    alias(names: &'static [&'static str]) { aliases = names }
}

impl Component {
    /// A component that can be set by position.
    pub(super) const fn declare(name: &'static str, ty: Base, start: Start, doc: &'static str) -> Self {
        Self { name, aliases: &[], ty, start, range: None, doc, by_position: true }
    }
}

setters! { Component:
    /// Other spellings.
    alias(names: &'static [&'static str]) { aliases = names }
    /// Set by name only.
    named() { by_position = false }
    /// The least and greatest number that make sense.
    range(low: f64, high: f64) { range = Some(Range::Within(low, high)) }
    /// Only numbers above this one make sense.
    above(low: f64) { range = Some(Range::Above(low)) }
    /// The least number that makes sense.
    at_least(low: f64) { range = Some(Range::AtLeast(low)) }
    /// The greatest number that makes sense.
    at_most(high: f64) { range = Some(Range::AtMost(high)) }
    /// Only `false` makes sense.
    only_false() { range = Some(Range::OnlyFalse) }
}
