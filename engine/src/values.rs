//! Typed values from words and strings, and back.

use arl_lang::catalog::{Base, Family};
use arl_rt::emit::*;

/// The most words that a value has that is no array.
pub(crate) const MOST_WORDS: usize = 16;

/// The words and strings of a value, from which its components are taken one after the other.
pub(crate) struct Source<'a> {
    pub(crate) words: &'a [u64],
    pub(crate) texts: &'a [Str],
    pub(crate) family: Family,
}

impl Source<'_> {
    #[inline]
    fn word(&mut self) -> u64 {
        let Some((first, rest)) = self.words.split_first() else { return 0 };
        self.words = rest;
        *first
    }

    fn text(&mut self) -> Str {
        let Some((first, rest)) = self.texts.split_first() else { return Str::new() };
        self.texts = rest;
        first.clone()
    }
}

/// The words and strings that a value is put into.
pub(crate) struct Target {
    words: [u64; MOST_WORDS],
    count: usize,
    pub(crate) text: Option<Str>,
    pub(crate) family: Family,
}

impl Target {
    pub(crate) fn new(family: Family) -> Self {
        Self { words: [0; MOST_WORDS], count: 0, text: None, family }
    }

    /// The words that were put in.
    pub(crate) fn words(&self) -> &[u64] {
        self.words.get(..self.count).unwrap_or(&self.words)
    }

    #[inline]
    fn put(&mut self, word: u64) {
        if let Some(place) = self.words.get_mut(self.count) {
            *place = word;
            self.count += 1;
        }
    }
}

/// A type of ARL as the runtime has it.
pub(crate) trait Value: Sized {
    /// The type in the catalog.
    const BASE: Base;

    /// Takes the value from its words and strings.
    fn load(from: &mut Source<'_>) -> Self;

    /// Puts the value into words and strings.
    fn store(&self, to: &mut Target);
}

macro_rules! numbers {
    ($($ty:ty, $base:ident: $from:expr, $to:expr;)*) => { $(
        impl Value for $ty {
            const BASE: Base = Base::$base;

            #[inline]
            fn load(from: &mut Source<'_>) -> Self {
                let convert: fn(u64) -> $ty = $from;
                convert(from.word())
            }

            #[inline]
            fn store(&self, to: &mut Target) {
                let convert: fn($ty) -> u64 = $to;
                to.put(convert(*self));
            }
        }
    )* };
}

numbers! {
    i32, Int: |word| word as u32 as i32, |value| u64::from(value as u32);
    u32, Uint: |word| word as u32, u64::from;
    u8, Byte: |word| word as u8, u64::from;
    f64, Double: f64::from_bits, f64::to_bits;
    bool, Bool: |word| word != 0, u64::from;
}

impl Value for Str {
    const BASE: Base = Base::String;

    fn load(from: &mut Source<'_>) -> Self {
        from.text()
    }

    fn store(&self, to: &mut Target) {
        to.text = Some(self.clone());
    }
}

macro_rules! enumerations {
    ($($name:ident)*) => { $(
        impl Value for $name {
            const BASE: Base = Base::Enum(arl_lang::catalog::Enum::$name);

            fn load(from: &mut Source<'_>) -> Self {
                $name::from_index(from.word() as u32 as i32).unwrap_or_default()
            }

            fn store(&self, to: &mut Target) {
                to.put(u64::from(self.index() as u32));
            }
        }
    )* };
}

enumerations! { VelProfile Printto NumBase Stoptype Controlmode Stopbits Parity Weaveshape Weaverotaxis CompenType }

macro_rules! structures {
    ($($name:ident = $base:ident { $($field:ident)* })*) => { $(
        impl Value for $name {
            const BASE: Base = Base::Struct(arl_lang::catalog::Struct::$base);

            fn load(from: &mut Source<'_>) -> Self {
                Self { $($field: Value::load(from),)* }
            }

            fn store(&self, to: &mut Target) {
                $(self.$field.store(to);)*
            }
        }
    )* };
}

structures! {
    Pos = Pos { x y z }
    Frame = Frame { x y z a b c }
    Pose = Pose { x y z a b c cfg turn ej1 ej2 ej3 ej4 ej5 ej6 }
    JointScara = Joint { j1 j2 j3 j4 ej1 ej2 ej3 ej4 ej5 ej6 }
    Tool = Tool { t_frame stationary }
    Wobj = Wobj { w_frame robhold mu_name }
    Weavedata = Weavedata {
        weaveshape frequency amplitude dwell_left dwell_right dwell_middle track swing_angle radius weaverotaxis
        rotation_angle vibrat
    }
    Speed = Speed { per tcp ori exj exl }
    SlipScara = Slip { pdis ejdis eldis odis perdis }
    JvelScara = Jvel { jv1 jv2 jv3 jv4 ev1 ev2 ev3 ev4 ev5 ev6 }
    CentroidPos = CentroidPos { x y z }
    InertiaTensor = InertiaTensor { ixx ixy ixz iyy iyz izz }
    ToolInertiaPara = ToolInertiaPara { m centroidpos inertiatensor }
    Control = Control { rising_vel rising_acc rising_dec falling_vel falling_acc falling_dec }
    Compendata = Compendata { tcp_max_vel tcp_max_acc tcp_max_jerk ori_max_vel ori_max_acc ori_max_jerk }
    Jttq = Jttq { jt1 jt2 jt3 jt4 jt5 jt6 et1 et2 et3 et4 et5 et6 }
    Jtci = Jtci { ji1 ji2 ji3 ji4 ji5 ji6 ei1 ei2 ei3 ei4 ei5 ei6 }
    Tcpforce = Tcpforce { fx fy fz tx ty tz }
}

/// Structures of which SCARA robots have their own form: the runtime takes and gives those of six-axis robots.
macro_rules! of_both_families {
    ($($name:ident or $scara:ident { $($field:ident)* })*) => { $(
        impl Value for $name {
            const BASE: Base = <$scara as Value>::BASE;

            fn load(from: &mut Source<'_>) -> Self {
                match from.family {
                    Family::SixAxis => Self { $($field: Value::load(from),)* },
                    Family::Scara => $scara::load(from).into(),
                }
            }

            fn store(&self, to: &mut Target) {
                match to.family {
                    Family::SixAxis => { $(self.$field.store(to);)* }
                    Family::Scara => $scara::from(self.clone()).store(to),
                }
            }
        }
    )* };
}

of_both_families! {
    Joint or JointScara { j1 j2 j3 j4 j5 j6 ej1 ej2 ej3 ej4 ej5 ej6 }
    Slip or SlipScara { perdis pdis odis ejdis eldis jdis }
    Jvel or JvelScara { jv1 jv2 jv3 jv4 jv5 jv6 ev1 ev2 ev3 ev4 ev5 ev6 }
}
