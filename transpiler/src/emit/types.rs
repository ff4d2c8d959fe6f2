//! Types and default values in Rust.

use super::names::{field, ident};
use crate::hir::Type;
use arl_lang::catalog::{Base, Family, Struct};
use proc_macro2::{Ident, Literal, TokenStream};
use quote::quote;

/// Arrays up to this size in bytes are stored in place, larger ones on the heap.
const SMALL: usize = 1024;

/// Whether values of the type are copied by a plain assignment.
pub(super) fn is_copy(ty: Type) -> bool {
    !ty.is_array() && !matches!(ty.base, Base::String | Base::Handle(_) | Base::Struct(Struct::Wobj))
}

/// Whether a value of the type fits into a register.
pub(super) fn is_number(ty: Type) -> bool {
    !ty.is_array() && matches!(ty.base, Base::Int | Base::Uint | Base::Byte | Base::Double | Base::Bool)
}

/// Whether a variable of the type is a handle or an array of handles.
pub(super) fn is_handle(ty: Type) -> bool {
    matches!(ty.base, Base::Handle(_))
}

/// Whether a global of the type is an array of cells.
pub(super) fn is_cells(ty: Type) -> bool {
    ty.is_array() && is_copy(ty.element())
}

/// The type in Rust.
pub(super) fn rust_type(ty: Type, family: Family) -> TokenStream {
    let element = base_type(ty.base, family);
    if !ty.is_array() {
        return element;
    }
    let (array, count) = (array_type(ty, family), Literal::usize_unsuffixed(ty.len()));
    quote!(#array<#element, #count>)
}

/// The type without dimensions in Rust.
pub(super) fn base_type(base: Base, family: Family) -> TokenStream {
    match base {
        Base::Void => quote!(()),
        Base::Int => quote!(i32),
        Base::Uint => quote!(u32),
        Base::Byte => quote!(u8),
        Base::Double => quote!(f64),
        Base::Bool => quote!(bool),
        Base::String => quote!(Str),
        Base::Struct(_) | Base::Enum(_) | Base::Handle(_) => {
            let name = type_name(base, family);
            quote!(#name)
        }
    }
}

/// The runtime's type for a structure, an enumeration or a handle.
pub(super) fn type_name(base: Base, family: Family) -> Ident {
    ident(match base {
        Base::Struct(id) => id.def(family).rust,
        Base::Enum(id) => id.def().rust,
        Base::Handle(id) => id.def().rust,
        _ => "Str",
    })
}

/// Whether the robot family has its own type here: the runtime stores and returns the types of six-axis robots.
pub(super) fn differs(base: Base, family: Family) -> bool {
    matches!(base, Base::Struct(id) if id.def(family).rust != id.def(Family::SixAxis).rust)
}

/// `Array` or `SmallArray`.
pub(super) fn array_type(ty: Type, family: Family) -> Ident {
    let small = ty.bytes(family) <= SMALL;
    ident(if small { "SmallArray" } else { "Array" })
}

/// The type of a global variable of this type: `Cell<i32>`, `Shared<Str>`, or the handle itself.
pub(super) fn variable_type(ty: Type, family: Family) -> TokenStream {
    let value = rust_type(ty, family);
    if is_cells(ty) {
        let small = array_type(ty, family) == "SmallArray";
        let cells = if small { quote!(SmallCells) } else { quote!(Cells) };
        let (element, count) = (base_type(ty.base, family), Literal::usize_unsuffixed(ty.len()));
        quote!(#cells<#element, #count>)
    } else if is_handle(ty) {
        value
    } else if is_copy(ty) {
        quote!(Cell<#value>)
    } else {
        quote!(Shared<#value>)
    }
}

/// The type of a local variable of this type that is visible to events: `Rc<Cell<i32>>`.
pub(super) fn shared_type(ty: Type, family: Family) -> TokenStream {
    let value = rust_type(ty, family);
    if is_handle(ty) {
        quote!(Rc<#value>)
    } else if is_copy(ty) {
        quote!(Rc<Cell<#value>>)
    } else {
        quote!(Rc<Shared<#value>>)
    }
}

/// A variable of that type with this value.
pub(super) fn shared_value(ty: Type, value: TokenStream) -> TokenStream {
    if is_handle(ty) {
        quote!(Rc::new(#value))
    } else if is_copy(ty) {
        quote!(Rc::new(Cell::new(#value)))
    } else {
        quote!(Rc::new(Shared::new(#value)))
    }
}

/// The default value of a type.
pub(super) fn start_value(ty: Type, family: Family) -> TokenStream {
    if ty.is_array() {
        let (array, element) = (array_type(ty, family), base_type(ty.base, family));
        let count = Literal::usize_unsuffixed(ty.len());
        return quote!(#array::<#element, #count>::start());
    }
    match ty.base {
        Base::Void => quote!(()),
        Base::Int | Base::Uint | Base::Byte => quote!(0),
        Base::Double => quote!(0.0),
        Base::Bool => quote!(false),
        Base::String => quote!(Str::new()),
        Base::Enum(id) => {
            let (name, first) = (ident(id.def().rust), id.def().constants.first().map_or("default", |it| it.rust));
            let first = ident(first);
            quote!(#name::#first)
        }
        Base::Struct(_) | Base::Handle(_) => {
            let name = type_name(ty.base, family);
            quote!(#name::default())
        }
    }
}

/// The field of a structure's component.
pub(super) fn component(id: Struct, index: usize, family: Family) -> Ident {
    field(id.def(family).components.get(index).map_or("unknown", |component| component.name))
}
