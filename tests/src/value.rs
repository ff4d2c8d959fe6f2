//! Values: types, start values, conversions, printing.

/// A type without array sizes.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
#[expect(missing_docs, reason = "the names are ARL's")]
pub enum Base {
    Int,
    Uint,
    Byte,
    Double,
    Bool,
    Str,
    Enum(usize),
    Struct(usize),
    Void,
}

/// A type; sizes of 0 are not there.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub struct Type {
    /// The type of the elements.
    pub base: Base,
    /// The sizes of up to two dimensions.
    pub sizes: [usize; 2],
}

impl Type {
    /// No array.
    pub const fn one(base: Base) -> Self {
        Self { base, sizes: [0, 0] }
    }

    /// Whether it is an array.
    pub fn is_array(self) -> bool {
        self.sizes[0] > 0
    }

    /// The number of elements.
    pub fn elements(self) -> usize {
        self.sizes[0] * self.sizes[1].max(1)
    }
}

/// The enumerations: name and constants.
pub const ENUMS: [(&str, &[&str]); 5] = [
    ("stoptype", &["general", "fast"]),
    ("parity", &["none", "odd", "even"]),
    ("weaveshape", &["simple", "V_shape", "triangle", "ellipse", "eight"]),
    ("weaverotaxis", &["rot_x", "rot_y", "rot_z"]),
    ("controlmode", &["MANUAL", "AUTO", "MANUFAST"]),
];

/// What a component starts with.
#[derive(Clone, Copy, Debug)]
#[expect(missing_docs, reason = "the names say it")]
pub enum Start {
    Unset,
    Zero,
    Int(i32),
}

/// A component: name, type, start value.
pub type Component = (&'static str, Base, Start);

const D: Base = Base::Double;
const U: Start = Start::Unset;
const Z: Start = Start::Zero;

/// The structures: name and components. The last component of `slip` is set by name only.
pub const STRUCTS: [(&str, &[Component]); 9] = [
    ("pos", &[("x", D, U), ("y", D, U), ("z", D, U)]),
    ("frame", &[("x", D, Z), ("y", D, Z), ("z", D, Z), ("a", D, Z), ("b", D, Z), ("c", D, Z)]),
    (
        "pose",
        &[
            ("x", D, U),
            ("y", D, U),
            ("z", D, U),
            ("a", D, U),
            ("b", D, U),
            ("c", D, U),
            ("cfg", Base::Int, Start::Int(0)),
            ("turn", Base::Int, Start::Int(-1)),
            ("ej1", D, U),
            ("ej2", D, U),
            ("ej3", D, U),
            ("ej4", D, U),
            ("ej5", D, U),
            ("ej6", D, U),
        ],
    ),
    (
        "joint",
        &[
            ("j1", D, U),
            ("j2", D, U),
            ("j3", D, U),
            ("j4", D, U),
            ("j5", D, U),
            ("j6", D, U),
            ("ej1", D, U),
            ("ej2", D, U),
            ("ej3", D, U),
            ("ej4", D, U),
            ("ej5", D, U),
            ("ej6", D, U),
        ],
    ),
    ("speed", &[("per", D, U), ("tcp", D, U), ("ori", D, U), ("exj", D, U), ("exl", D, U)]),
    ("tool", &[("t_frame", Base::Struct(FRAME), Z), ("stationary", Base::Bool, Z)]),
    ("wobj", &[("w_frame", Base::Struct(FRAME), Z), ("robhold", Base::Bool, Z), ("mu_name", Base::Str, Z)]),
    (
        "weavedata",
        &[
            ("weaveshape", Base::Enum(2), Z),
            ("frequency", D, Z),
            ("amplitude", D, Z),
            ("dwell_left", D, Z),
            ("dwell_right", D, Z),
            ("dwell_middle", D, Z),
            ("track", Base::Bool, Z),
            ("swing_angle", D, Z),
            ("radius", D, Z),
            ("weaverotaxis", Base::Enum(3), Z),
            ("rotation_angle", D, Z),
            ("vibrat", Base::Bool, Z),
        ],
    ),
    ("slip", &[("perdis", D, U), ("pdis", D, U), ("odis", D, U), ("ejdis", D, U), ("eldis", D, U), ("jdis", D, U)]),
];

/// The place of `frame` in [`STRUCTS`].
pub const FRAME: usize = 1;
/// The place of `joint` in [`STRUCTS`].
pub const JOINT: usize = 3;
/// The place of `wobj` in [`STRUCTS`].
pub const WOBJ: usize = 6;
/// The place of `slip` in [`STRUCTS`].
pub const SLIP: usize = 8;

/// What stands in components that are not set.
pub const UNSET: f64 = 9e9;

/// The components of a structure.
pub fn components(number: usize) -> &'static [Component] {
    STRUCTS[number].1
}

/// How many components braces by position may set.
pub fn positional(number: usize) -> usize {
    components(number).len() - usize::from(number == SLIP)
}

/// The name of a type, as declarations and `typeof` write it.
pub fn base_name(base: Base) -> &'static str {
    match base {
        Base::Int => "int",
        Base::Uint => "uint",
        Base::Byte => "byte",
        Base::Double => "double",
        Base::Bool => "bool",
        Base::Str => "string",
        Base::Enum(number) => ENUMS[number].0,
        Base::Struct(number) => STRUCTS[number].0,
        Base::Void => "void",
    }
}

/// The name of a type with its sizes, as `typeof` gives it.
pub fn type_name(ty: Type) -> String {
    let mut name = base_name(ty.base).to_owned();
    for size in ty.sizes.into_iter().filter(|size| *size > 0) {
        name += &format!("[{size}]");
    }
    name
}

/// A value.
#[derive(Clone, PartialEq, Debug)]
#[expect(missing_docs, reason = "the names are ARL's")]
pub enum Value {
    Int(i32),
    Uint(u32),
    Byte(u8),
    Double(f64),
    Bool(bool),
    Str(Vec<u8>),
    Enum(usize, usize),
    Struct(usize, Vec<Value>),
    /// The elements of an array, one after the other, and its sizes.
    Array(Vec<Value>, [usize; 2]),
    Void,
}

/// The value that a variable of this type starts with.
pub fn start(ty: Type) -> Value {
    if ty.is_array() {
        return Value::Array(vec![start(Type::one(ty.base)); ty.elements()], ty.sizes);
    }
    match ty.base {
        Base::Int => Value::Int(0),
        Base::Uint => Value::Uint(0),
        Base::Byte => Value::Byte(0),
        Base::Double => Value::Double(0.0),
        Base::Bool => Value::Bool(false),
        Base::Str => Value::Str(Vec::new()),
        Base::Enum(number) => Value::Enum(number, 0),
        Base::Struct(number) => {
            let value = |component: &Component| match component.2 {
                Start::Unset => Value::Double(UNSET),
                Start::Zero => start(Type::one(component.1)),
                Start::Int(value) => Value::Int(value),
            };
            Value::Struct(number, components(number).iter().map(value).collect())
        }
        Base::Void => Value::Void,
    }
}

/// The value brought to another type, as implicit conversions do it. An int that is brought to uint or byte is a
/// constant that fits, or a bit pattern.
pub fn convert(value: Value, to: Base) -> Value {
    match (value, to) {
        (Value::Int(x), Base::Uint) => Value::Uint(x as u32),
        (Value::Int(x), Base::Byte) => Value::Byte(x as u8),
        (Value::Int(x), Base::Double) => Value::Double(f64::from(x)),
        (Value::Int(x), Base::Bool) => Value::Bool(x != 0),
        (Value::Int(x), Base::Enum(number)) => Value::Enum(number, x as usize),
        (Value::Uint(x), Base::Int) => Value::Int(x as i32),
        (Value::Uint(x), Base::Byte) => Value::Byte(x as u8),
        (Value::Uint(x), Base::Double) => Value::Double(f64::from(x)),
        (Value::Uint(x), Base::Bool) => Value::Bool(x != 0),
        (Value::Byte(x), Base::Int) => Value::Int(i32::from(x)),
        (Value::Byte(x), Base::Uint) => Value::Uint(u32::from(x)),
        (Value::Byte(x), Base::Double) => Value::Double(f64::from(x)),
        (Value::Byte(x), Base::Bool) => Value::Bool(x != 0),
        (Value::Double(x), Base::Bool) => Value::Bool(x != 0.0),
        (Value::Enum(_, at), Base::Int) => Value::Int(at as i32),
        (value, _) => value,
    }
}

/// How numbers are written at the moment.
#[derive(Clone, Copy, Debug)]
pub struct Style {
    /// The significant digits of doubles.
    pub digits: usize,
    /// Whether `hex` or `dec` was said, and which.
    pub hex: Option<bool>,
}

/// How a print begins.
pub const PLAIN: Style = Style { digits: 6, hex: None };

/// Appends a value as `print` writes it.
pub fn print(value: &Value, style: Style, out: &mut Vec<u8>) {
    match value {
        Value::Int(x) if style.hex == Some(true) => out.extend(format!("{x:x}").bytes()),
        Value::Uint(x) if style.hex == Some(true) => out.extend(format!("{x:x}").bytes()),
        Value::Int(x) => out.extend(x.to_string().bytes()),
        Value::Uint(x) => out.extend(x.to_string().bytes()),
        Value::Byte(x) if style.hex == Some(false) => out.extend(x.to_string().bytes()),
        Value::Byte(x) => out.extend(format!("{x:02x}h").bytes()),
        Value::Double(x) => out.extend(general(*x, style.digits).bytes()),
        Value::Bool(x) => out.extend(x.to_string().bytes()),
        Value::Str(x) => out.extend(x),
        Value::Enum(number, at) => out.extend(ENUMS[*number].1[*at].bytes()),
        Value::Struct(number, parts) => {
            let skipped = |at: usize, part: &Value| {
                (*number == WOBJ && at == 2 && *part == Value::Str(Vec::new()))
                    || (*number == SLIP && at == 5 && *part == Value::Double(UNSET))
            };
            let shown: Vec<&Value> =
                parts.iter().enumerate().filter(|(at, part)| !skipped(*at, part)).map(|(_, part)| part).collect();
            list(&shown, style, out);
        }
        Value::Array(elements, [rows, 0]) => {
            debug_assert_eq!(elements.len(), *rows);
            list(&elements.iter().collect::<Vec<_>>(), style, out);
        }
        Value::Array(elements, [_, columns]) => {
            let row = |row: &[Value]| Value::Array(row.to_vec(), [*columns, 0]);
            let rows: Vec<Value> = elements.chunks(*columns).map(row).collect();
            list(&rows.iter().collect::<Vec<_>>(), style, out);
        }
        Value::Void => {}
    }
}

fn list(values: &[&Value], style: Style, out: &mut Vec<u8>) {
    out.push(b'{');
    for (at, value) in values.iter().enumerate() {
        if at > 0 {
            out.push(b',');
        }
        print(value, style, out);
    }
    out.push(b'}');
}

/// A double like C's `%g` with so many digits.
pub fn general(value: f64, digits: usize) -> String {
    // No double has more; each further one would be a zero, which is not written.
    let digits = digits.min(1100);
    if value.is_nan() {
        return "nan".into();
    }
    if value.is_infinite() {
        return if value > 0.0 { "inf".into() } else { "-inf".into() };
    }
    if value == 0.0 {
        return "0".into();
    }
    let scientific = format!("{value:.*e}", digits - 1);
    let (mantissa, exponent) = scientific.split_once('e').unwrap();
    let exponent: i32 = exponent.parse().unwrap();
    if exponent < -4 || exponent >= digits as i32 {
        let sign = if exponent < 0 { '-' } else { '+' };
        return format!("{}e{sign}{:02}", without_zeros(mantissa), exponent.abs());
    }
    without_zeros(&format!("{value:.*}", (digits as i32 - 1 - exponent) as usize)).into()
}

fn without_zeros(text: &str) -> &str {
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { text }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn doubles_print_like_in_c() {
        for (value, text) in [
            (0.1 + 0.2, "0.3"),
            (9e9, "9e+09"),
            (123456.0, "123456"),
            (1234567.0, "1.23457e+06"),
            (0.0001, "0.0001"),
            (0.00001, "1e-05"),
            (-2.5, "-2.5"),
            (999999.5, "1e+06"),
            (100.0, "100"),
            (1e100, "1e+100"),
            (-0.0, "0"),
        ] {
            assert_eq!(general(value, 6), text);
        }
        assert_eq!(general(std::f64::consts::PI, 3), "3.14");
    }
}
