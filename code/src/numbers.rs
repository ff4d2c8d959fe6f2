//! Types of the catalog as numbers, as bytes have them.

/// Base types.
pub(crate) mod base {
    use arl_lang::catalog::{Base, Enum, Handle, Struct};
    use serde::de::Error;
    use serde::{Deserialize, Deserializer, Serializer};

    const SIMPLE: [Base; 7] = [Base::Void, Base::Int, Base::Uint, Base::Byte, Base::Double, Base::Bool, Base::String];

    /// All base types in order.
    fn all() -> impl Iterator<Item = Base> {
        let simple = SIMPLE.into_iter().chain(Struct::ALL.into_iter().map(Base::Struct));
        simple.chain(Enum::ALL.into_iter().map(Base::Enum)).chain(Handle::ALL.into_iter().map(Base::Handle))
    }

    pub(crate) fn serialize<S: Serializer>(base: &Base, to: S) -> Result<S::Ok, S::Error> {
        let number = all().position(|other| other == *base).unwrap_or_default();
        to.serialize_u8(u8::try_from(number).unwrap_or(u8::MAX))
    }

    pub(crate) fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<Base, D::Error> {
        let number = u8::deserialize(from)?;
        all().nth(usize::from(number)).ok_or_else(|| D::Error::custom("there is no such type"))
    }
}

/// Robot families.
pub(crate) mod family {
    use arl_lang::catalog::Family;
    use serde::{Deserialize, Deserializer, Serializer};

    #[expect(clippy::trivially_copy_pass_by_ref, reason = "serde calls it so")]
    pub(crate) fn serialize<S: Serializer>(family: &Family, to: S) -> Result<S::Ok, S::Error> {
        to.serialize_bool(*family == Family::Scara)
    }

    pub(crate) fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<Family, D::Error> {
        Ok(if bool::deserialize(from)? { Family::Scara } else { Family::SixAxis })
    }
}
