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
/// A whole program, at a place where items are allowed. It becomes a module `program` with the functions, and `Globals`
/// with the global variables, which a controller runs:
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
/// Statements with spliced Rust values, inside an async Rust function. They become a future:
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
/// requires; where the place accepts any type, `as` with an ARL type gives it.
///
/// Both forms also accept a string literal: `arl!(r#"..."#)`, `arl!(cx, r#"..."#)`. `#![scara]` before the text means
/// that the code is for a SCARA robot.
#[proc_macro]
pub fn arl(input: TokenStream) -> TokenStream {
    expand::arl(input).into()
}

/// A program in its own file: `arl_file!("pick.arl")`, or `arl_file!("pick.arl", scara)`.
///
/// The path is relative to the folder of the Rust file. The result is the same as for a whole program in [`arl!`].
#[proc_macro]
pub fn arl_file(input: TokenStream) -> TokenStream {
    expand::arl_file(input).into()
}
