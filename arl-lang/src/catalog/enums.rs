//! The enumerations.

use super::types::{Enum, EnumConst, EnumDef};

/// Declares an enumeration's definition: `NAME | OTHER_SPELLING => Variant "text"` a line.
macro_rules! enumeration {
    ($table:ident = $(#[doc = $doc:literal])+ $id:ident, $name:literal $(| $alias:literal)*, $rust:literal, $section:literal {
        $($constant:ident $(| $other:ident)* => $variant:ident $about:literal),* $(,)?
    }) => {
        static $table: EnumDef = EnumDef {
            id: Enum::$id,
            name: $name,
            aliases: &[$($alias),*],
            rust: $rust,
            constants: &[$(EnumConst {
                name: stringify!($constant),
                aliases: &[$(stringify!($other)),*],
                rust: stringify!($variant),
                doc: $about,
            }),*],
            doc: concat!($($doc),+).trim_ascii(),
            section: $section,
        };
    };
}

enumeration! { VEL_PROFILE =
    /// How the speed of a motion rises and falls: everywhere as fast as the limits of all axes and of the TCP
    /// allow. The system variable `$VEL_PROFILE` holds the one in use.
    VelProfile, "$VEL_PROFILE", "VelProfile", "2.6.1" {
        T_TYPE => T "unlimited jerk: the shortest, but with shocks",
        S_TYPE => S "limited jerk",
        O_TYPE => O "the same as `S_TYPE`",
    }
}

enumeration! { PRINTTO =
    /// Where `print` writes.
    Printto, "printto", "Printto", "2.6.2" {
        off => Off "nowhere: cancels the targets before it",
        hmi => Hmi "the message bar of the pendant; standard output on the command line",
        file => File "the file that filepath names",
        console => Console "the terminal; standard output on the command line",
    }
}

enumeration! { NUM_BASE =
    /// How whole numbers are written.
    NumBase, "num_base", "NumBase", "2.6.3" {
        hex => Hex "base 16",
        dec => Dec "base 10",
    }
}

enumeration! { STOPTYPE =
    /// How `stopmove` brakes.
    Stoptype, "stoptype", "Stoptype", "2.6.4" {
        general => General "within the acceleration and jerk limits in use",
        fast => Fast "with five times those limits",
    }
}

enumeration! { CONTROLMODE =
    /// The operating mode of the controller, as `$CTL_MODE` shows it.
    Controlmode, "controlmode", "Controlmode", "2.6.5" {
        MANUAL | T1 => Manual "manual, the TCP at 250 mm/s at most",
        AUTO | AUT => Auto "automatic",
        MANUFAST | T2 => Manufast "manual at full speed",
    }
}

enumeration! { STOPBITS =
    /// Stop bits of a serial line.
    Stopbits, "stopbits" | "modbus_stopbits" | "StopBitType", "Stopbits", "2.6.6" {
        one => One "one stop bit",
        two => Two "two stop bits",
    }
}

enumeration! { PARITY =
    /// Parity of a serial line.
    Parity, "parity" | "modbus_parity" | "ParityType", "Parity", "2.6.7" {
        none => None "no parity bit",
        odd => Odd "an odd number of ones",
        even => Even "an even number of ones",
    }
}

enumeration! { WEAVESHAPE =
    /// Patterns of a weave.
    Weaveshape, "weaveshape", "Weaveshape", "2.6.8" {
        simple => Simple "from side to side",
        V_shape => VShape "along the two sides of a V",
        triangle => Triangle "round a triangle in space",
        ellipse => Ellipse "round an ellipse",
        eight => Eight "along a figure of eight",
    }
}

enumeration! { WEAVEROTAXIS =
    /// The axis about which the plane of a weave is turned.
    Weaverotaxis, "weaverotaxis", "Weaverotaxis", "2.6.9" {
        rot_x => X "about x",
        rot_y => Y "about y",
        rot_z => Z "about z",
    }
}

enumeration! { COMPENTYPE =
    /// The frame in which `compen` gives its shift. The names may be written as strings, too.
    CompenType, "compentype", "CompenType", "3.2.11.2" {
        TOOL => Tool "the tool frame",
        WOBJ => Wobj "the workpiece frame",
        TOOL_PATH => ToolPath "x along the path, y across path and tool axis, z completes them",
        MODIFY_PATH => ModifyPath "as TOOL_PATH, but y keeps its side where the path turns back",
        WORLD => World "the world frame",
    }
}

impl Enum {
    /// Every enumeration.
    pub const ALL: [Enum; 10] = [
        Enum::VelProfile,
        Enum::Printto,
        Enum::NumBase,
        Enum::Stoptype,
        Enum::Controlmode,
        Enum::Stopbits,
        Enum::Parity,
        Enum::Weaveshape,
        Enum::Weaverotaxis,
        Enum::CompenType,
    ];

    /// The definition.
    pub fn def(self) -> &'static EnumDef {
        match self {
            Enum::VelProfile => &VEL_PROFILE,
            Enum::Printto => &PRINTTO,
            Enum::NumBase => &NUM_BASE,
            Enum::Stoptype => &STOPTYPE,
            Enum::Controlmode => &CONTROLMODE,
            Enum::Stopbits => &STOPBITS,
            Enum::Parity => &PARITY,
            Enum::Weaveshape => &WEAVESHAPE,
            Enum::Weaverotaxis => &WEAVEROTAXIS,
            Enum::CompenType => &COMPENTYPE,
        }
    }
}
