//! Programs for tests, written as closures.
#![allow(dead_code, unreachable_pub, reason = "each test file uses its part")]
#![allow(clippy::unwrap_used, clippy::panic, reason = "these are tests, too")]

#[cfg(target_os = "linux")]
pub mod open;

use arl_rt::emit::*;
use arl_rt::{Builder, Captured, Controller, Outcome};

/// The file of every test program.
pub const FILE: File = File::new("t.arl");

/// A program that is a closure.
pub struct Script<F>(pub F);

impl<F> Program for Script<F>
where
    F: for<'a> Fn(&'a Cx) -> BoxFuture<'a> + 'static,
{
    fn file(&self) -> File {
        FILE
    }

    fn family(&self) -> Family {
        Family::SixAxis
    }

    fn main<'a>(&'a self, cx: &'a Cx) -> BoxFuture<'a> {
        (self.0)(cx)
    }
}

/// A closure as a program.
pub fn script<F>(run: F) -> Script<F>
where
    F: for<'a> Fn(&'a Cx) -> BoxFuture<'a> + 'static,
{
    Script(run)
}

/// A controller for a closure, and its messages.
pub fn controller<F>(builder: Builder, script: F) -> (Controller, Captured)
where
    F: for<'a> Fn(&'a Cx) -> BoxFuture<'a> + 'static,
{
    let messages = Captured::new();
    let controller = builder.output(messages.clone()).build(Box::new(Script(script))).unwrap();
    (controller, messages)
}

/// A controller for a closure whose messages go where the builder says.
pub fn plain<F>(builder: Builder, script: F) -> Controller
where
    F: for<'a> Fn(&'a Cx) -> BoxFuture<'a> + 'static,
{
    builder.build(Box::new(Script(script))).unwrap()
}

/// Runs a closure to its end; how it ended, and its messages.
pub fn run<F>(script: F) -> (Outcome, String)
where
    F: for<'a> Fn(&'a Cx) -> BoxFuture<'a> + 'static,
{
    let (mut controller, messages) = controller(Controller::builder(), script);
    (controller.run(), messages.text())
}

/// The text of the alarm that ended a program.
pub fn alarm(outcome: Outcome) -> String {
    match outcome {
        Outcome::Alarm(alarm) => alarm.to_string(),
        other => panic!("no alarm: {other}"),
    }
}

/// `print` of one value.
pub fn say(cx: &Cx, value: &dyn arl_rt::values::text::Print) -> Done<()> {
    text::print().argtoprint(value).run(cx).at(FILE, 99)
}

/// What was written, as a trace is.
#[derive(Clone, Default)]
pub struct Kept(pub std::rc::Rc<std::cell::RefCell<Vec<u8>>>);

impl std::io::Write for Kept {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        self.0.borrow_mut().extend_from_slice(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}

/// A joint target that every six-axis robot reaches.
pub fn bent(j1: f64) -> Joint {
    Joint::of_axes([j1, -90.0, 90.0, 0.0, 45.0, 0.0])
}
