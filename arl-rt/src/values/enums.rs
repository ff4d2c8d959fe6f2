//! The enumerations of ARL.

use super::Str;
use crate::values::text::{Print, Style, Typed};

/// What all enumerations have in common.
pub trait Enumeration: Copy + Default + 'static {
    /// Other spellings of the type's name.
    const ALIASES: &'static [&'static str];

    /// The names of the constants as they print, in order.
    const CONSTANTS: &'static [&'static str];

    /// The number that the constant stands for, from 0.
    fn index(self) -> i32;

    /// The constant that stands for a number; `None` beyond the last.
    fn from_index(index: i32) -> Option<Self>;

    /// The constant of this name, whatever its case; the manual's aliases are accepted, too.
    fn from_name(name: &str) -> Option<Self>;
}

macro_rules! enumerations {
    ($(
        $(#[$meta:meta])*
        $rust:ident $name:literal $(| $spelling:literal)* {
            $first:ident $first_name:literal $(| $first_alias:literal)* $first_doc:literal,
            $($constant:ident $constant_name:literal $(| $alias:literal)* $doc:literal,)*
        }
    )*) => { $(
        $(#[$meta])*
        #[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default, Debug)]
        pub enum $rust {
            #[doc = $first_doc]
            #[default]
            $first,
            $(
                #[doc = $doc]
                $constant,
            )*
        }

        impl $rust {
            /// The number that the constant stands for, from 0.
            #[inline]
            pub const fn index(self) -> i32 {
                self as i32
            }

            /// The constant that stands for a number; `None` beyond the last.
            pub const fn from_index(index: i32) -> Option<Self> {
                const ALL: &[$rust] = &[$rust::$first, $($rust::$constant,)*];
                if index < 0 || index as usize >= ALL.len() { None } else { Some(ALL[index as usize]) }
            }

            /// The constant's name, as it prints.
            pub const fn name(self) -> &'static str {
                match self {
                    $rust::$first => $first_name,
                    $($rust::$constant => $constant_name,)*
                }
            }
        }

        impl Enumeration for $rust {
            const ALIASES: &'static [&'static str] = &[$($spelling,)*];
            const CONSTANTS: &'static [&'static str] = &[$first_name, $($constant_name,)*];

            fn index(self) -> i32 {
                self as i32
            }

            fn from_index(index: i32) -> Option<Self> {
                $rust::from_index(index)
            }

            fn from_name(name: &str) -> Option<Self> {
                const NAMES: &[(&str, $rust)] = &[
                    ($first_name, $rust::$first),
                    $(($first_alias, $rust::$first),)*
                    $(
                        ($constant_name, $rust::$constant),
                        $(($alias, $rust::$constant),)*
                    )*
                ];
                NAMES.iter().find(|(known, _)| known.eq_ignore_ascii_case(name)).map(|(_, constant)| *constant)
            }
        }

        impl From<$rust> for i32 {
            #[inline]
            fn from(constant: $rust) -> i32 {
                constant as i32
            }
        }

        impl Typed for $rust {
            const NAME: &'static str = $name;
        }

        impl Print for $rust {
            fn print(&self, out: &mut Str, _style: &Style) {
                out.push_str(self.name());
            }

            fn type_name(&self) -> String {
                $name.to_owned()
            }
        }
    )* };
}

enumerations! {
    /// The speed profile of a motion.
    VelProfile "$VEL_PROFILE" {
        T "T_TYPE" "Trapezoidal: acceleration jumps.",
        S "S_TYPE" "Jerk-limited: as fast at each place as every axis allows.",
        O "O_TYPE" "The same as `S_TYPE`.",
    }

    /// Where `print` sends its text.
    Printto "printto" {
        Off "off" "Nowhere.",
        Hmi "hmi" "The messages of the operator panel.",
        File "file" "A file.",
        Console "console" "The terminal.",
    }

    /// The base in which integers are printed.
    NumBase "num_base" {
        Hex "hex" "Hexadecimal.",
        Dec "dec" "Decimal.",
    }

    /// How a motion is stopped.
    Stoptype "stoptype" {
        General "general" "Within the limits in force.",
        Fast "fast" "Harder than the limits in force.",
    }

    /// The operating mode of the controller.
    Controlmode "controlmode" {
        Manual "MANUAL" | "T1" "By hand, slow.",
        Auto "AUTO" | "AUT" "Automatic.",
        Manufast "MANUFAST" | "T2" "By hand, at full speed.",
    }

    /// Stop bits of a serial line.
    Stopbits "stopbits" | "modbus_stopbits" | "StopBitType" {
        One "one" "1 stop bit.",
        Two "two" "2 stop bits.",
    }

    /// The parity of a serial line.
    Parity "parity" | "modbus_parity" | "ParityType" {
        None "none" "No parity bit.",
        Odd "odd" "Odd parity.",
        Even "even" "Even parity.",
    }

    /// The figure of a weave.
    Weaveshape "weaveshape" {
        Simple "simple" "From side to side.",
        VShape "V_shape" "A V in space.",
        Triangle "triangle" "A triangle in space.",
        Ellipse "ellipse" "An ellipse.",
        Eight "eight" "A figure of eight.",
    }

    /// The axis about which the plane of a weave is turned.
    Weaverotaxis "weaverotaxis" {
        X "rot_x" "The x axis.",
        Y "rot_y" "The y axis.",
        Z "rot_z" "The z axis.",
    }

    /// The coordinate system in which a compensation is given.
    CompenType "compentype" {
        Tool "TOOL" "The tool.",
        Wobj "WOBJ" "The workpiece.",
        ToolPath "TOOL_PATH" "Tangent of the path and z of the tool.",
        ModifyPath "MODIFY_PATH" "As `TOOL_PATH`, but y keeps its side where the path turns back.",
        World "WORLD" "The world.",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn walk<E: Enumeration + Print + Typed + PartialEq + std::fmt::Debug>(type_name: &str, printed: &[&str]) {
        assert_eq!(E::NAME, type_name);
        assert_eq!(E::default(), E::from_index(0).unwrap());
        for (at, name) in printed.iter().enumerate() {
            let constant = E::from_index(at as i32).unwrap();
            assert_eq!(constant.index(), at as i32);
            assert_eq!(constant.printed(&Style::START), *name);
            assert_eq!(E::from_name(&name.to_lowercase()), Some(constant));
        }
        assert_eq!(E::CONSTANTS, printed);
        assert_eq!(E::from_index(printed.len() as i32), None);
        assert_eq!(E::from_index(-1), None);
        assert_eq!(E::from_name("nobody"), None);
    }

    #[test]
    fn print_their_names() {
        walk::<VelProfile>("$VEL_PROFILE", &["T_TYPE", "S_TYPE", "O_TYPE"]);
        walk::<Printto>("printto", &["off", "hmi", "file", "console"]);
        walk::<NumBase>("num_base", &["hex", "dec"]);
        walk::<Stoptype>("stoptype", &["general", "fast"]);
        walk::<Controlmode>("controlmode", &["MANUAL", "AUTO", "MANUFAST"]);
        walk::<Stopbits>("stopbits", &["one", "two"]);
        walk::<Parity>("parity", &["none", "odd", "even"]);
        walk::<Weaveshape>("weaveshape", &["simple", "V_shape", "triangle", "ellipse", "eight"]);
        walk::<Weaverotaxis>("weaverotaxis", &["rot_x", "rot_y", "rot_z"]);
        walk::<CompenType>("compentype", &["TOOL", "WOBJ", "TOOL_PATH", "MODIFY_PATH", "WORLD"]);
    }

    fn declared<E: Enumeration + Typed + std::fmt::Debug>(id: arl_lang::catalog::Enum, variants: &[E]) {
        let def = id.def();
        assert_eq!(E::NAME, def.name);
        assert_eq!(E::ALIASES, def.aliases);
        assert_eq!(std::any::type_name::<E>().rsplit("::").next(), Some(def.rust));
        assert_eq!(variants.len(), def.constants.len());
        for (at, (constant, variant)) in def.constants.iter().zip(variants).enumerate() {
            assert_eq!(E::CONSTANTS[at], constant.name);
            assert_eq!(format!("{variant:?}"), constant.rust);
            for name in constant.aliases.iter().chain([&constant.name]) {
                assert_eq!(E::from_name(name).map(Enumeration::index), Some(at as i32), "{name}");
            }
        }
    }

    #[test]
    fn are_those_of_the_catalog() {
        use arl_lang::catalog::Enum;
        fn all<E: Enumeration>() -> Vec<E> {
            (0..).map_while(E::from_index).collect()
        }
        for id in Enum::ALL {
            match id {
                Enum::VelProfile => declared(id, &all::<VelProfile>()),
                Enum::Printto => declared(id, &all::<Printto>()),
                Enum::NumBase => declared(id, &all::<NumBase>()),
                Enum::Stoptype => declared(id, &all::<Stoptype>()),
                Enum::Controlmode => declared(id, &all::<Controlmode>()),
                Enum::Stopbits => declared(id, &all::<Stopbits>()),
                Enum::Parity => declared(id, &all::<Parity>()),
                Enum::Weaveshape => declared(id, &all::<Weaveshape>()),
                Enum::Weaverotaxis => declared(id, &all::<Weaverotaxis>()),
                Enum::CompenType => declared(id, &all::<CompenType>()),
            }
        }
    }

    #[test]
    fn know_other_names() {
        assert_eq!(Controlmode::from_name("aut"), Some(Controlmode::Auto));
        assert_eq!(i32::from(Controlmode::from_name("T2").unwrap()), 2);
    }
}
