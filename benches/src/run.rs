//! Runs a function of an emitted program on a controller.

use std::cell::Cell;
use std::pin::Pin;
use std::rc::Rc;
use std::task::{Context, Poll};
use std::time::{Duration, Instant};

use arl_rt::emit::{BoxFuture, Done, Family, File};
use arl_rt::{Captured, Controller, Cx, Outcome, Program};

/// What a run gave.
#[derive(Clone, Copy, Debug, Default)]
pub struct Run {
    /// The checksum of the kernel.
    pub checksum: f64,
    /// The time from the first statement to the last, the work of the controller between the cycles included.
    pub whole: Duration,
    /// The part of it in which the program's statements ran.
    pub program: Duration,
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
    let program = Box::new(Alone { globals, work, result: Rc::clone(&result) });
    let built = Controller::builder().output(Captured::new()).build(program);
    let mut controller = built.map_err(|error| error.to_string())?;
    match controller.run() {
        Outcome::Ended => Ok(result.get()),
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
    F: for<'a> Fn(&'a Cx, &'a G) -> Work<'a>,
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

    fn main<'a>(&'a self, cx: &'a Cx) -> BoxFuture<'a> {
        Box::pin(async move {
            let first = cx.cycle();
            let timed = Timed { work: (self.work)(cx, &self.globals), start: None, program: Duration::ZERO };
            let (done, whole, program) = timed.await;
            let cycles = cx.cycle() - first;
            self.result.set(Run { checksum: done?, whole, program, cycles });
            Ok(())
        })
    }
}

/// Measures the polls of a future.
struct Timed<'a> {
    work: Work<'a>,
    start: Option<Instant>,
    program: Duration,
}

impl Future for Timed<'_> {
    type Output = (Done<f64>, Duration, Duration);

    fn poll(mut self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<Self::Output> {
        let before = Instant::now();
        let start = *self.start.get_or_insert(before);
        let polled = self.work.as_mut().poll(context);
        let after = Instant::now();
        self.program += after - before;
        polled.map(|done| (done, after - start, self.program))
    }
}
