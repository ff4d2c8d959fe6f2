//! Constants in Rust.

use super::fragment::{Fragment, Precedence};
use super::names::ident;
use crate::hir::Value;
use proc_macro2::{Literal, TokenStream};
use quote::quote;

/// A constant whose type follows from its context.
pub(super) fn constant(value: &Value) -> Fragment {
    literal(value, false)
}

/// A constant that shows its type: the receiver of a method, the argument of a generic function.
pub(super) fn typed_constant(value: &Value) -> Fragment {
    literal(value, true)
}

/// A constant as text, if its type is known; a string becomes a Rust literal.
pub(super) fn text(value: &Value) -> String {
    match value {
        Value::String(text) => Literal::string(text).to_string(),
        value => constant(value).tokens.to_string().replace(' ', ""),
    }
}

fn literal(value: &Value, typed: bool) -> Fragment {
    let fragment = match value {
        Value::Int(i32::MIN) => Fragment::postfix(quote!(i32::MIN)),
        Value::Int(value) => {
            let number = Literal::u32_unsuffixed(value.unsigned_abs());
            let number = if typed { Literal::i32_suffixed(value.saturating_abs()) } else { number };
            signed(quote!(#number), *value < 0)
        }
        Value::Uint(value) => {
            let number = if typed { Literal::u32_suffixed(*value) } else { Literal::u32_unsuffixed(*value) };
            Fragment::postfix(quote!(#number))
        }
        Value::Byte(value) => {
            let number = if typed { Literal::u8_suffixed(*value) } else { Literal::u8_unsuffixed(*value) };
            Fragment::postfix(quote!(#number))
        }
        Value::Double(value) => double(*value),
        Value::Bool(value) => Fragment::postfix(quote!(#value)),
        Value::String(text) if text.is_empty() => Fragment::postfix(quote!(Str::new())),
        Value::String(text) => Fragment::postfix(quote!(Str::literal(#text))),
        Value::Enum(id, index) => {
            let (name, constants) = (ident(id.def().rust), id.def().constants);
            let variant = ident(constants.get(*index as usize).map_or("unknown", |constant| constant.rust));
            Fragment::postfix(quote!(#name::#variant))
        }
    };
    Fragment { settled: true, ..fragment }
}

fn signed(number: TokenStream, negative: bool) -> Fragment {
    if negative { Fragment::new(quote!(-#number), Precedence::Unary) } else { Fragment::postfix(number) }
}

fn double(value: f64) -> Fragment {
    let known = [
        (std::f64::consts::PI, quote!(std::f64::consts::PI)),
        (f64::INFINITY, quote!(f64::INFINITY)),
        (f64::NEG_INFINITY, quote!(f64::NEG_INFINITY)),
    ];
    if value.is_nan() {
        return Fragment::postfix(quote!(f64::NAN));
    }
    if let Some((_, path)) = known.into_iter().find(|(known, _)| *known == value) {
        return Fragment::postfix(path);
    }
    let size = value.abs();
    // Rust's notation of a number, with an exponent if there would be many digits.
    let text = if size >= 1e15 || (size > 0.0 && size < 1e-5) { format!("{size:e}") } else { format!("{size:?}") };
    let number: TokenStream = text.parse().unwrap_or_else(|_| quote!(0.0));
    signed(number, value.is_sign_negative())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shown(value: Value) -> String {
        typed_constant(&value).tokens.to_string().replace(' ', "")
    }

    #[test]
    fn numbers_read_back_as_they_were() {
        assert_eq!(shown(Value::Int(-5)), "-5i32");
        assert_eq!(shown(Value::Int(i32::MIN)), "i32::MIN");
        assert_eq!(shown(Value::Byte(200)), "200u8");
        assert_eq!(shown(Value::Double(9e9)), "9000000000.0");
        assert_eq!(shown(Value::Double(-1e-7)), "-1e-7");
        assert_eq!(shown(Value::Double(1e300)), "1e300");
        assert_eq!(shown(Value::Double(-0.0)), "-0.0");
        assert_eq!(shown(Value::Double(f64::NAN)), "f64::NAN");
        assert_eq!(shown(Value::Double(0.1)), "0.1");
        assert_eq!(shown(Value::String("a\n\"\u{4e2d}".into())), "Str::literal(\"a\\n\\\"\u{4e2d}\")");
        for value in [0.1, 1.0 / 3.0, 123_456_789.125, 5e-324, f64::MAX, 1e15, 9.999e-6] {
            let text = shown(Value::Double(value));
            assert_eq!(text.parse::<f64>().unwrap().to_bits(), value.to_bits(), "{text}");
        }
    }
}
