//! The interface as both sides see it: the same as in `arl.h`, which describes each part.

use std::ffi::{c_char, c_void};

use crate::Served;

/// The version of the interface.
pub const INTERFACE: u32 = 3;
/// The result of `go_on` if the run continues.
pub const RUNS: i32 = -1;
/// The result if the run has panicked.
pub const BROKEN: i32 = -2;
/// The result on another thread than that of the run.
pub const WRONG_THREAD: i32 = -3;

/// A function that receives a text: its context, and the bytes.
pub type Take = unsafe extern "C" fn(*mut c_void, *const c_char, usize);

/// `ArlInterface` of `arl.h`.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
#[allow(missing_docs, reason = "arl.h says it")]
pub struct Interface {
    pub version: u32,
    pub columns: u32,
    pub begin: unsafe extern "C" fn(*const *const c_char, usize, i32, Take, *mut c_void) -> *mut Served,
    pub go_on: unsafe extern "C" fn(*mut Served, u64, i32) -> i32,
    pub stop: unsafe extern "C" fn(*const Served),
    pub order: unsafe extern "C" fn(*mut Served, *const c_char, Take, *mut c_void) -> i32,
    pub said: unsafe extern "C" fn(*mut Served, Take, *mut c_void),
    pub state: unsafe extern "C" fn(*mut Served, Take, *mut c_void),
    pub rows: unsafe extern "C" fn(*mut Served, Take, *mut c_void),
    pub time: unsafe extern "C" fn(*const Served) -> f64,
    pub end: unsafe extern "C" fn(*mut Served),
    pub header: unsafe extern "C" fn(Take, *mut c_void),
    pub summary: unsafe extern "C" fn(*mut Served, Take, *mut c_void),
    pub report: unsafe extern "C" fn(*mut Served, Take, *mut c_void),
    pub watch: unsafe extern "C" fn(*mut Served, *const c_char, Take, *mut c_void) -> i32,
    pub observe: unsafe extern "C" fn(*mut Served, *mut f64, usize) -> usize,
    pub global: unsafe extern "C" fn(*mut Served, *const c_char, Take, *mut c_void) -> i32,
    pub set_global: unsafe extern "C" fn(*mut Served, *const c_char, *const c_char, Take, *mut c_void) -> i32,
    pub files: unsafe extern "C" fn(*mut Served, Take, *mut c_void),
}
