//! The kernels: what was emitted for them, and their rivals.

use crate::rivals;
use crate::run::{Run, run};

/// A kernel in all its forms.
#[derive(Clone, Copy, Debug)]
pub struct Kernel {
    /// Its name: that of its files, too.
    pub name: &'static str,
    /// The argument for a test.
    pub small: i32,
    /// The argument for a measurement.
    pub large: i32,
    /// What was emitted.
    pub emitted: fn(i32) -> Result<Run, String>,
    /// The same by hand.
    pub rival: fn(i32) -> f64,
}

/// `name(small, large) = call;` The call gives what the emitted function gives.
macro_rules! kernels {
    ($($name:ident($small:literal, $large:literal) = |$cx:pat_param, $g:pat_param, $size:ident| $call:expr;)*) => {
        mod emitted {
            $(
                #[allow(clippy::all, clippy::too_many_lines, missing_docs, unreachable_pub, dead_code, unused_qualifications)]
                pub(super) mod $name {
                    include!(concat!(env!("OUT_DIR"), "/", stringify!($name), ".rs"));
                }
            )*
        }

        /// All kernels.
        pub const ALL: &[Kernel] = &[$(
            Kernel {
                name: stringify!($name),
                small: $small,
                large: $large,
                emitted: |$size| {
                    #[allow(unused_imports)]
                    use emitted::$name::$name::*;
                    run(emitted::$name::Globals::new(), move |$cx, $g| Box::pin(async move { Ok(f64::from($call)) }))
                },
                rival: |$size| f64::from(rivals::$name($size)),
            }
        ),*];
    };
}

kernels! {
    sieve(3, 400) = |cx, _, size| sieve(cx, size).await;
    matrix(2, 100) = |cx, _, size| matrix(cx, size).await;
    collatz(1000, 60_000) = |cx, _, size| collatz(cx, size).await;
    crc(3, 300) = |cx, g, size| crc(cx, g, size).await?;
    sort(1, 8) = |cx, g, size| sort(cx, g, size).await?;
    text(1000, 100_000) = |cx, _, size| text(cx, size).await?;
    fixed(10, 800) = |cx, _, size| fixed(cx, size).await?;
    structures(10, 10_000) = |cx, g, size| structures(cx, g, size).await;
    fib(15, 32) = |cx, _, size| fib(cx, size)?;
    queens(6, 11) = |cx, _, size| queens(cx, size)?;
    machine(1000, 500_000) = |cx, _, size| machine(cx, size).await;
}
