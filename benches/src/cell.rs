//! The robots of the bench `cell`: `cells/robot.arl` with so many interrupts and rounds.

use std::any::Any;
use std::fmt;

use arl_rt::Program;
use arl_rt::emit::{BoxFuture, Cx, Family, File};

#[allow(clippy::all, clippy::too_many_lines, missing_docs, unreachable_pub, dead_code, unused_qualifications)]
mod emitted {
    include!(concat!(env!("OUT_DIR"), "/robot.rs"));
}

/// A robot that declares its interrupts and then moves.
pub struct Robot {
    program: emitted::Globals,
    first: i32,
    interrupts: i32,
    rounds: i32,
    percent: f64,
}

impl Robot {
    /// A robot that watches so many interrupts, of the priorities from `first` on, and goes so many rounds of four
    /// motions at such a share of its speed, in %.
    pub fn new(first: i32, interrupts: i32, rounds: i32, percent: f64) -> Self {
        Self { program: emitted::Globals::new(), first, interrupts, rounds, percent }
    }
}

impl fmt::Debug for Robot {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Robot").field("interrupts", &self.interrupts).finish_non_exhaustive()
    }
}

impl Program for Robot {
    fn file(&self) -> File {
        self.program.file()
    }

    fn family(&self) -> Family {
        self.program.family()
    }

    fn init<'a>(&'a self, cx: &'a Cx) -> BoxFuture<'a> {
        self.program.init(cx)
    }

    fn globals(&self) -> &dyn Any {
        self.program.globals()
    }

    fn main<'a>(&'a self, cx: &'a Cx) -> BoxFuture<'a> {
        Box::pin(async move {
            emitted::robot::watch(cx, self.first, self.interrupts).await?;
            emitted::robot::work(cx, &self.program, self.rounds, self.percent).await
        })
    }
}
