//! A compiled program as a part of another process, which steps it and queries it from outside.

use std::cell::RefCell;
use std::ffi::OsString;
use std::fmt;
use std::rc::Rc;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::command::ending::Ending;
use crate::command::live::{Recording, alarm_line, message_line, push_state, warning_line};
use crate::command::observation::Observation;
use crate::command::options::{ClockKind, parse};
use crate::command::report;
use crate::command::set_up::{connect_to, set_up};
pub use crate::command::stack::Stack;
use crate::command::summary::summary;
use crate::command::words::{lateness, listed, lost_events_warning, time_is_over};
use crate::context::output::Message;
use crate::context::program::{Other, Program};
use crate::controller::{Controller, trace};
use crate::fault::{Alarm, File};
use crate::storage::state::Memory;

/// A run of a program in this process. Everything happens on the thread that creates it.
pub struct Run {
    controller: Controller,
    /// Lines that have not been taken yet.
    output_lines: Rc<RefCell<String>>,
    /// The time limit in s, if any, and the cycle in which it is reached.
    max_time: Option<f64>,
    last: u64,
    /// The reason why it ends before its programs do.
    cut: Option<Ending>,
    /// How it ended, once it is over.
    ended: Option<Ending>,
    /// All alarms so far.
    alarms: Vec<Alarm>,
    observation: Observation,
    /// Whether it was requested to run in real time.
    is_real: bool,
    /// The trace of the first robot, where it is requested: rows that have not been taken yet.
    rows: Option<Vec<f64>>,
    /// The files that rows refer to by their index here, where they do.
    files: Option<Vec<File>>,
    /// Whether the run is requested to end.
    stops: Arc<AtomicBool>,
    /// The connection to a listener, until the run is over.
    recording: Option<Recording>,
}

/// Whether anything outside may change something while a run goes on.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Outside {
    /// Nothing: programs that all wait in vain end the run.
    Nobody,
    /// The host may change something.
    Somebody,
}

impl Run {
    /// How many columns a row of the trace has.
    pub const COLUMNS: usize = trace::COLUMNS;
    /// The names of the columns, separated by commas.
    pub const HEADER: &str = trace::HEADER;

    /// A run at the start of its first cycle. The arguments are those of a compiled program's command line;
    /// `script_dir` is the folder of its files where they name none. With `traced` it keeps the trace of the first
    /// robot.
    ///
    /// # Errors
    /// The error in the arguments, or the reason why there is no controller, in words.
    pub fn begin(
        program: Box<dyn Program>,
        others: &[Other],
        script_dir: &str,
        arguments: Vec<OsString>,
        traced: bool,
        stack: Stack,
    ) -> Result<Self, String> {
        let output_lines = Rc::new(RefCell::new(String::new()));
        let lines = Rc::clone(&output_lines);
        let output = move |message: &Message<'_>| lines.borrow_mut().push_str(&message_line(message));
        let options = parse(arguments, script_dir).map_err(|error| error.to_string())?;
        let options = options.ok_or("--help: there is no command line here")?;
        if let Some(option) = options.needs_a_process() {
            return Err(format!("{option} is only for a program that runs on its own"));
        }
        let (max_time, repeats, wishes) = (options.max_time, options.repeats, options.wishes);
        let names_files = options.trace_columns.file;
        let is_real = options.clock == Some(ClockKind::Real);
        let keeps = options.state_dir.is_some();
        let recording = options.listener.as_deref().map(|address| connect_to(address, wishes)).transpose()?;
        let builder = set_up(options, others).map_err(|failure| failure.text)?.stack(stack.program_bytes());
        // Concurrent runs would share the folder of the program.
        let builder = if keeps { builder } else { builder.storage(Memory::default()) };
        let builder = match &recording {
            Some(recording) => builder.output(recording.beside(output)),
            None => builder.output(output),
        };
        let builder = if wishes.each_motion { builder.record_motions() } else { builder };
        let mut controller = builder.build(program).map_err(|error| error.to_string())?;
        controller.set_loop(repeats);
        controller.begin_traces();
        recording.iter().for_each(|recording| recording.begin(&controller));
        let last = max_time.map_or(u64::MAX, |seconds| controller.cycles(seconds));
        let (rows, stops, observation) = (traced.then(Vec::new), Arc::default(), Observation::default());
        Ok(Self {
            controller,
            output_lines,
            max_time,
            last,
            cut: None,
            ended: None,
            alarms: Vec::new(),
            observation,
            is_real,
            rows,
            files: names_files.then(Vec::new),
            stops,
            recording,
        })
    }

    /// A flag that ends the programs once it is true, with the robots at rest on their paths: any thread may set it.
    pub fn stops(&self) -> Arc<AtomicBool> {
        Arc::clone(&self.stops)
    }

    /// Goes on for `cycles` cycles, or until the run is over: then it returns the exit code, which is that of the
    /// command.
    pub fn go_on(&mut self, cycles: u64, outside: Outside) -> Option<u8> {
        for _ in 0..cycles {
            if self.ended.is_some() || self.conclude() {
                break;
            }
            if self.cut.is_none() && self.controller.cycle() >= self.last {
                let why = time_is_over(&self.controller, self.max_time.unwrap_or_default());
                self.cut(Ending::TimeOver, &why);
            }
            let is_alone = self.recording.as_ref().is_some_and(Recording::is_gone);
            if self.cut.is_none() && (is_alone || self.stops.load(Ordering::Relaxed)) {
                self.cut(Ending::Stopped, "interrupted: the robot stops on its path");
            }
            self.controller.step();
            self.recording.iter().for_each(|recording| recording.cycle_ended(&self.controller));
            self.keep_row();
            self.take_news();
            if self.cut.is_none()
                && outside == Outside::Nobody
                && let Some(waiting) = self.controller.standstill()
            {
                self.cut(Ending::Stuck, &format!("nothing can change any more: {}", listed(&waiting).join("; ")));
            }
        }
        // A call with 0 cycles gets the exit code, too.
        let _ = self.ended.is_some() || self.conclude();
        self.code()
    }

    /// Keeps the row of a cycle, where the trace is requested.
    fn keep_row(&mut self) {
        let Some(rows) = self.rows.as_mut().filter(|_| self.controller.first_ran()) else { return };
        rows.extend(self.controller.trace_row());
        if let Some(files) = &mut self.files {
            rows.push(self.controller.executing_file().map_or(f64::NAN, |file| place(files, file) as f64));
        }
    }

    fn code(&self) -> Option<u8> {
        self.ended.map(Ending::code)
    }

    fn cut(&mut self, ending: Ending, why: &str) {
        self.cut = Some(ending);
        self.say(&warning_line(why));
        self.controller.stop();
    }

    /// Checks whether the run is over, and completes it then.
    fn conclude(&mut self) -> bool {
        let is_over = match self.cut {
            // A run that was stopped does not begin again.
            Some(_) => self.controller.outcome().is_some(),
            None => self.controller.is_over(),
        };
        if is_over {
            self.controller.close_robots();
            self.controller.settle_state();
            self.take_news();
            let lost_events = self.recording.take().map_or(0, |recording| recording.run_ended(&self.controller));
            if let Some(text) = lost_events_warning(lost_events) {
                self.say(&warning_line(&text));
            }
            if self.is_real {
                lateness(&self.controller).iter().for_each(|text| self.say(&warning_line(text)));
            }
            self.ended = Some(Ending::of(self.cut, self.controller.outcome()));
        }
        is_over
    }

    fn take_news(&mut self) {
        for text in self.controller.take_warnings() {
            self.recording.iter().for_each(|recording| recording.warning(&self.controller, &text));
            self.say(&warning_line(&text));
        }
        for alarm in self.controller.take_alarms() {
            self.recording.iter().for_each(|recording| recording.alarm(&self.controller, &alarm));
            self.say(&alarm_line(&alarm));
            self.alarms.push(alarm);
        }
    }

    fn say(&self, line: &str) {
        self.output_lines.borrow_mut().push_str(line);
    }

    /// Carries out the words of a scenario's event: see [`Controller::order`].
    ///
    /// # Errors
    /// The text is not an order, or the run is over; then nothing was done.
    pub fn order(&mut self, text: &str) -> Result<(), String> {
        if self.ended.is_some() {
            return Err("the run is over".into());
        }
        self.controller.order(text).map_err(|error| error.to_string())
    }

    /// The messages, warnings and alarms since the last call, one JSON object per line, as `--live` writes them.
    pub fn take_said(&mut self) -> String {
        std::mem::take(&mut self.output_lines.borrow_mut())
    }

    /// The state of the controller, a JSON object as `--live` writes it.
    pub fn state(&self) -> String {
        let mut line = String::new();
        push_state(&mut line, &self.controller, self.controller.time());
        line
    }

    /// The rows of the trace since the last call, one after the other; the values of axes that do not exist are NaN.
    /// With `--trace-columns file` each row has one more number at its end: the index, from 0, in
    /// [`files`](Self::files) of the file that its line belongs to; NaN where no motion is executed.
    pub fn take_rows(&mut self) -> Vec<f64> {
        self.rows.as_mut().map(std::mem::take).unwrap_or_default()
    }

    /// The names of the files that rows of the trace refer to so far.
    pub fn files(&self) -> Vec<&'static str> {
        self.files.iter().flatten().map(|file| file.name()).collect()
    }

    /// The result of the run, or its progress: a JSON object with the outcome, the exit code, the cycle time in s, the
    /// alarms, and with `--report` the totals of the first robot's motions.
    pub fn summary(&self) -> String {
        summary(&self.controller, self.ended, &self.alarms)
    }

    /// What each motion did, one JSON object per line, where `--report` was given.
    pub fn report(&self) -> String {
        report::all_json(&self.controller.recorded_motions())
    }

    /// Sets the signals and global variables that [`observe`](Self::observe) fills in, one name per line: `do.1`,
    /// `global.placed`.
    ///
    /// # Errors
    /// One of them does not exist, or is not a number; then nothing changes.
    pub fn watch(&mut self, names: &str) -> Result<(), String> {
        self.observation.watch(names, &self.controller)
    }

    /// How many numbers [`observe`](Self::observe) fills in.
    pub fn observed(&self) -> usize {
        self.observation.count()
    }

    /// Fills in the row of the trace of the last cycle, followed by the watched values.
    pub fn observe(&self, numbers: &mut [f64]) {
        self.observation.fill(numbers, &self.controller);
    }

    /// The value of a global variable, as a literal.
    ///
    /// # Errors
    /// There is no variable of this name.
    pub fn global(&self, name: &str) -> Result<String, String> {
        self.controller.global(name).map_err(|error| error.to_string())
    }

    /// Gives a global variable a value, between two cycles.
    ///
    /// # Errors
    /// There is no variable of this name, or the value does not fit.
    pub fn set_global(&mut self, name: &str, literal: &str) -> Result<(), String> {
        self.controller.set_global(name, literal).map_err(|error| error.to_string())
    }

    /// Controller time in s: the start of the next cycle.
    pub fn time(&self) -> f64 {
        self.controller.time()
    }
}

/// The index of a file among the known ones; a new one is appended.
fn place(files: &mut Vec<File>, file: File) -> usize {
    let known = files.iter().position(|known| *known == file);
    known.unwrap_or_else(|| {
        files.push(file);
        files.len() - 1
    })
}

impl fmt::Debug for Run {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Run").field("time", &self.time()).field("code", &self.code()).finish_non_exhaustive()
    }
}
