//! Counts how often each statement of a program runs, where the program was made for a debugger.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use std::rc::Rc;

use super::between::{Between, CycleOrder};
use crate::context::cx::Cx;
use crate::context::standard_error::tell;
use crate::context::watcher::{Go, Watcher};
use crate::controller::Controller;
use crate::fault::Alarm;

/// How often the statements of a program ran, by file and line.
type Counts = BTreeMap<(&'static str, u32), u64>;

/// The counts of a program, which is identified by the folder of its files and its main file.
struct Program {
    folder: PathBuf,
    main: &'static str,
    counts: Counts,
    /// How often functions began, by file and name.
    entered: BTreeMap<(&'static str, Rc<str>), u64>,
}

/// Counts statements, and never halts.
#[derive(Default)]
struct Counter(RefCell<Vec<Program>>);

impl Watcher for Counter {
    fn statement(&self, cx: &Cx, frame: u64) -> Go {
        let Some((file, line, false)) = cx.frames().place(frame) else { return Go::On };
        let (folder, main) = (cx.program_itself().folder(), cx.program().name());
        let mut programs = self.0.borrow_mut();
        let known = programs.iter().position(|program| program.main == main && program.folder == folder);
        let at = known.unwrap_or_else(|| {
            let (counts, entered) = (Counts::new(), BTreeMap::new());
            programs.push(Program { folder: folder.to_path_buf(), main, counts, entered });
            programs.len() - 1
        });
        if let Some(program) = programs.get_mut(at) {
            *program.counts.entry((file.name(), line)).or_default() += 1;
            if let Some(name) = cx.frames().begins(frame) {
                *program.entered.entry((file.name(), name)).or_default() += 1;
            }
        }
        Go::On
    }

    fn goes_on(&self) -> Go {
        Go::On
    }

    fn alarm(&self, _: &Alarm) {}
}

/// Writes the counts at the end of the run.
struct Coverage {
    counter: Rc<Counter>,
    file: File,
    path: PathBuf,
}

impl Between for Coverage {
    fn cycle_begins(&mut self, _: &mut Controller) -> CycleOrder {
        CycleOrder::Runs
    }

    fn run_ended(&mut self, _: &mut Controller) {
        if let Err(error) = self.write() {
            tell(format_args!("warning: cannot write {}: {error}", self.path.display()));
        }
    }
}

impl Coverage {
    /// Writes a line for each statement that ran: folder and main file of its program, file, line, count; then the same
    /// for functions, with the name in place of the line.
    fn write(&mut self) -> std::io::Result<()> {
        let mut out = BufWriter::new(&self.file);
        for Program { folder, main, counts, entered } in &*self.counter.0.borrow() {
            for ((file, line), count) in counts {
                writeln!(out, "{}\t{main}\t{file}\t{line}\t{count}", folder.display())?;
            }
            for ((file, name), count) in entered {
                writeln!(out, "{}\t{main}\t{file}\t{name}\t{count}", folder.display())?;
            }
        }
        out.flush()
    }
}

/// Counts the statements of a run; the file is written at its end.
pub(crate) fn count(controller: &Controller, path: &Path) -> std::io::Result<Box<dyn Between>> {
    let (counter, file) = (Rc::new(Counter::default()), File::create(path)?);
    controller.watch(Rc::<Counter>::clone(&counter));
    Ok(Box::new(Coverage { counter, file, path: path.to_path_buf() }))
}
