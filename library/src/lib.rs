//! A compiled ARL program as a shared library, behind a small versioned C interface: `arl.h` describes it.
//!
//! [`library!`] turns a crate into such a library; `arl2rs build --library` writes one that uses it. With the feature
//! `load`, `Library` opens such a library from Rust.
//!
//! Only plain C crosses the interface: pointers, numbers, functions. No panic crosses it.

mod interface;
#[cfg(feature = "load")]
mod load;
mod room;
mod serve;

pub use interface::{BROKEN, INTERFACE, Interface, RUNS, Take, WRONG_THREAD};
#[cfg(feature = "load")]
pub use load::{Library, LoadError, Session};
pub use serve::Served;

#[doc(hidden)]
pub use arl_rt;
#[doc(hidden)]
pub use serve::{Made, begin, interface};

/// Turns the crate, of type `cdylib`, into a library with this program, the programs that its cells may name, and the
/// folder of its files: `library!(program::Globals::new, [], "/robot/pick")`.
#[macro_export]
macro_rules! library {
    ($program:expr, [$($other:expr),* $(,)?], $script_dir:expr) => {
        /// The function that a host calls first.
        // SAFETY: no other crate of the library has a symbol of this name.
        #[unsafe(no_mangle)]
        pub extern "C" fn arl_interface() -> *const $crate::Interface {
            unsafe extern "C" fn begin(
                arguments: *const *const ::core::ffi::c_char,
                count: usize,
                traced: i32,
                why: $crate::Take,
                context: *mut ::core::ffi::c_void,
            ) -> *mut $crate::Served {
                let made = $crate::Made {
                    program: &|| ::std::boxed::Box::new($program()),
                    others: &[$($other),*],
                    script_dir: $script_dir,
                };
                // SAFETY: the host meets the requirements of `arl.h` for these pointers.
                unsafe { $crate::begin(made, (arguments, count), traced, (why, context)) }
            }
            static INTERFACE: $crate::Interface = $crate::interface(begin);
            &INTERFACE
        }
    };
}
