//! Programs of benches, written as closures in Rust.

use arl_rt::Program;
use arl_rt::emit::{BoxFuture, Cx, Family, File};

struct Script<F> {
    file: File,
    run: F,
}

impl<F> Program for Script<F>
where
    F: for<'a> Fn(&'a Cx) -> BoxFuture<'a> + 'static,
{
    fn file(&self) -> File {
        self.file
    }

    fn family(&self) -> Family {
        Family::SixAxis
    }

    fn main<'a>(&'a self, cx: &'a Cx) -> BoxFuture<'a> {
        (self.run)(cx)
    }
}

/// A closure as a program of a six-axis robot, in a file of this name.
pub fn script<F>(file: File, run: F) -> Box<dyn Program>
where
    F: for<'a> Fn(&'a Cx) -> BoxFuture<'a> + 'static,
{
    Box::new(Script { file, run })
}
