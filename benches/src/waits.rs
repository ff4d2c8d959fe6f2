//! Programs that mostly wait, `cells/waits.arl`, compiled.

use crate::run::{Run, run};

#[allow(clippy::all, clippy::too_many_lines, missing_docs, unreachable_pub, dead_code, unused_qualifications)]
mod emitted {
    include!(concat!(env!("OUT_DIR"), "/waits.rs"));
}

/// A way to wait.
#[derive(Clone, Copy, Debug)]
pub struct Waits {
    /// The function of `cells/waits.arl`.
    pub name: &'static str,
    /// Runs it for so many cycles.
    pub emitted: fn(i32) -> Result<Run, String>,
}

macro_rules! waits {
    ($($name:ident)*) => {
        /// All ways to wait.
        pub const ALL: &[Waits] = &[$(
            Waits {
                name: stringify!($name),
                emitted: |cycles| {
                    run(emitted::Globals::new(), move |cx, _| {
                        Box::pin(async move {
                            emitted::waits::$name(cx, cycles).await?;
                            Ok(0.0)
                        })
                    })
                },
            }
        ),*];
    };
}

waits! { waittimes outputs conditions }
