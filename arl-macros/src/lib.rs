//! `arl!` and `arl_file!`: robot programs in ARL inside Rust. Use them through `arl_rt`.

mod expand;
mod input;
mod leaf;
mod report;
mod stub;
mod text;

use proc_macro::TokenStream;

/// ARL inside Rust.
///
/// A whole program, where items may stand. It becomes a module `program` with the functions, and `Globals` with the
/// global variables, which a controller runs:
///
/// ```ignore
/// mod pick {
///     arl_rt::arl! {
///         func void main()
///             print "hello"
///         endfunc
///     }
/// }
/// ```
///
/// Statements, inside an async Rust function, with Rust values spliced in. It becomes a future:
///
/// ```ignore
/// async fn approach(cx: &Cx, height: f64, count: i32) -> Done<()> {
///     arl!(cx, {
///         for(int i = 0; i < #count; i++)
///             lin {z #(height + 10.0)}, vl:100mm/s
///         endfor
///         print "at ", #(height as double)
///     }).await
/// }
/// ```
///
/// A spliced value is evaluated once, before the first statement, and converted with `Into` to the type that its place
/// asks for; where the place takes any type, `as` with an ARL type says which.
///
/// Both forms take a string literal instead: `arl!(r#"..."#)`, `arl!(cx, r#"..."#)`. `#![scara]` in front of the text
/// says that it is for a SCARA robot.
#[proc_macro]
pub fn arl(input: TokenStream) -> TokenStream {
    expand::arl(input).into()
}

/// A program in a file of its own: `arl_file!("pick.arl")`, or `arl_file!("pick.arl", scara)`.
///
/// The path counts from the folder of the Rust file. It becomes the same as the whole program of [`arl!`].
#[proc_macro]
pub fn arl_file(input: TokenStream) -> TokenStream {
    expand::arl_file(input).into()
}
