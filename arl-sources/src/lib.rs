//! The sources of the runtime, so that a command compiles programs wherever it is installed.

/// Where the sources of the runtime are.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Origin {
    /// In the checkout with this path: the command was compiled there without optimisation, by somebody who works on
    /// the runtime and wants to see what was changed.
    Checkout(&'static str),
    /// Here.
    Carried(&'static Carried),
    /// In the registry, where the command itself came from: `arl-rt` in the version of this package.
    Registry,
}

/// Sources as a workspace: `Cargo.toml`, `Cargo.lock`, and a folder for each package, down from `arl-rt`.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Carried {
    /// Differs where a file differs: 16 hexadecimal digits.
    pub state: &'static str,
    /// Paths with `/` below the workspace's folder, and texts.
    pub files: &'static [(&'static str, &'static str)],
}

/// Where the sources of this version are.
pub static ORIGIN: Origin = include!(concat!(env!("OUT_DIR"), "/origin.rs"));
