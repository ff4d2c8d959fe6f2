//! From a type that is known when a program runs to a type of Rust.

/// Evaluates an expression with `$T` as the Rust type of a base type; `$otherwise` for those that have no values.
macro_rules! with_type {
    ($base:expr, $family:expr, $T:ident => $value:expr, otherwise $otherwise:expr) => {{
        use arl_lang::catalog::{Base, Enum, Family, Struct};
        macro_rules! of {
            ($ty:ty) => {{
                type $T = $ty;
                $value
            }};
        }
        match ($base, $family) {
            (Base::Int, _) => of!(i32),
            (Base::Uint, _) => of!(u32),
            (Base::Byte, _) => of!(u8),
            (Base::Double, _) => of!(f64),
            (Base::Bool, _) => of!(bool),
            (Base::String, _) => of!(arl_rt::emit::Str),
            (Base::Struct(Struct::Joint), Family::Scara) => of!(arl_rt::emit::JointScara),
            (Base::Struct(Struct::Slip), Family::Scara) => of!(arl_rt::emit::SlipScara),
            (Base::Struct(Struct::Jvel), Family::Scara) => of!(arl_rt::emit::JvelScara),
            (Base::Struct(Struct::Pos), _) => of!(arl_rt::emit::Pos),
            (Base::Struct(Struct::Frame), _) => of!(arl_rt::emit::Frame),
            (Base::Struct(Struct::Pose), _) => of!(arl_rt::emit::Pose),
            (Base::Struct(Struct::Joint), _) => of!(arl_rt::emit::Joint),
            (Base::Struct(Struct::Tool), _) => of!(arl_rt::emit::Tool),
            (Base::Struct(Struct::Wobj), _) => of!(arl_rt::emit::Wobj),
            (Base::Struct(Struct::Weavedata), _) => of!(arl_rt::emit::Weavedata),
            (Base::Struct(Struct::Speed), _) => of!(arl_rt::emit::Speed),
            (Base::Struct(Struct::Slip), _) => of!(arl_rt::emit::Slip),
            (Base::Struct(Struct::Jvel), _) => of!(arl_rt::emit::Jvel),
            (Base::Struct(Struct::CentroidPos), _) => of!(arl_rt::emit::CentroidPos),
            (Base::Struct(Struct::InertiaTensor), _) => of!(arl_rt::emit::InertiaTensor),
            (Base::Struct(Struct::ToolInertiaPara), _) => of!(arl_rt::emit::ToolInertiaPara),
            (Base::Struct(Struct::Control), _) => of!(arl_rt::emit::Control),
            (Base::Struct(Struct::Compendata), _) => of!(arl_rt::emit::Compendata),
            (Base::Struct(Struct::Jttq), _) => of!(arl_rt::emit::Jttq),
            (Base::Struct(Struct::Jtci), _) => of!(arl_rt::emit::Jtci),
            (Base::Struct(Struct::Tcpforce), _) => of!(arl_rt::emit::Tcpforce),
            (Base::Enum(Enum::VelProfile), _) => of!(arl_rt::emit::VelProfile),
            (Base::Enum(Enum::Printto), _) => of!(arl_rt::emit::Printto),
            (Base::Enum(Enum::NumBase), _) => of!(arl_rt::emit::NumBase),
            (Base::Enum(Enum::Stoptype), _) => of!(arl_rt::emit::Stoptype),
            (Base::Enum(Enum::Controlmode), _) => of!(arl_rt::emit::Controlmode),
            (Base::Enum(Enum::Stopbits), _) => of!(arl_rt::emit::Stopbits),
            (Base::Enum(Enum::Parity), _) => of!(arl_rt::emit::Parity),
            (Base::Enum(Enum::Weaveshape), _) => of!(arl_rt::emit::Weaveshape),
            (Base::Enum(Enum::Weaverotaxis), _) => of!(arl_rt::emit::Weaverotaxis),
            (Base::Enum(Enum::CompenType), _) => of!(arl_rt::emit::CompenType),
            (Base::Void | Base::Handle(_), _) => $otherwise,
        }
    }};
}

pub(crate) use with_type;
