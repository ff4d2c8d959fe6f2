//! Runs a function of an emitted program on a controller.

use std::any::Any;
use std::cell::Cell;
use std::pin::Pin;
use std::rc::Rc;
use std::time::Duration;

use crate::statistics::processor_time;
use arl_rt::emit::{BoxFuture, Done, Family, File};
use arl_rt::{Captured, Controller, Cx, Outcome, Program};

/// What a run gave.
#[derive(Clone, Copy, Debug, Default)]
pub struct Run {
    /// The checksum of the kernel.
    pub checksum: f64,
    /// The processor time from the first statement to the last. What the controller does in each cycle is part of it.
    pub time: Duration,
    /// How many cycles it took.
    pub cycles: u64,
}

/// A function of a program, as a future that the controller polls.
pub type Work<'a> = Pin<Box<dyn Future<Output = Done<f64>> + 'a>>;

/// Runs a function of a program whose global variables have their start values.
///
/// # Errors
/// The program ended otherwise than by itself, or there is no controller for it.
pub fn run<G, F>(globals: G, work: F) -> Result<Run, String>
where
    G: Program + 'static,
    F: for<'a> Fn(&'a Cx, &'a G) -> Work<'a> + 'static,
{
    let result = Rc::new(Cell::new(Run::default()));
    let (program, output) = (Box::new(Alone { globals, work, result: Rc::clone(&result) }), Captured::new());
    let built = Controller::builder().output(output.clone()).build(program);
    let mut controller = built.map_err(|error| error.to_string())?;
    match controller.run() {
        Outcome::Ended => {
            let run = result.get();
            // What it printed counts where the function itself gives nothing.
            let printed = output.text().trim_end().parse().ok();
            Ok(Run { checksum: printed.unwrap_or(run.checksum), ..run })
        }
        other => Err(other.to_string()),
    }
}

/// A program with one of its functions in place of `main`.
struct Alone<G, F> {
    globals: G,
    work: F,
    result: Rc<Cell<Run>>,
}

impl<G, F> Program for Alone<G, F>
where
    G: Program,
    F: for<'a> Fn(&'a Cx, &'a G) -> Work<'a> + 'static,
{
    fn file(&self) -> File {
        self.globals.file()
    }

    fn family(&self) -> Family {
        self.globals.family()
    }

    fn init<'a>(&'a self, cx: &'a Cx) -> BoxFuture<'a> {
        self.globals.init(cx)
    }

    fn globals(&self) -> &dyn Any {
        self.globals.globals()
    }

    fn main<'a>(&'a self, cx: &'a Cx) -> BoxFuture<'a> {
        Box::pin(async move {
            let (first, start) = (cx.cycle(), processor_time());
            let checksum = (self.work)(cx, &self.globals).await?;
            self.result.set(Run { checksum, time: processor_time() - start, cycles: cx.cycle() - first });
            Ok(())
        })
    }
}
