//! `arl2rs sweep`: a program runs once for each row of a table of parameters, on all cores, and the results are a table
//! again.
//!
//! A run is a function of what it depends on. So each run has a folder of its own with all files that it reads, its
//! result is kept under a hash of them, and if its process is lost, it is made again.

mod bundle;
mod cell_files;
mod collision_watch;
mod folder;
mod kept;
mod parquet;
mod pool;
mod result;
mod table;
mod worker;

use crate::args::SweepOptions;
pub use crate::parameters::{Parameters, as_arl};
use arl_project::cache::Cache;
use arl_robot::result_file::ResultFile;
use arl_terminal::exit::Exit;
use arl_terminal::failure::Failure;
use arl_terminal::interrupt;
use arl_terminal::{answer, show};
use bundle::not_written;
pub use bundle::{Bundle, MAX_TIME};
pub use folder::Spread;
use indicatif::{ProgressBar, ProgressStyle};
pub use kept::Kept;
use pool::Work;
pub use result::{Row, RunResult};
use std::ops::ControlFlow;
use std::path::Path;
pub use table::{Settings, Sweep};
pub use worker::{TIMEOUT, Worker};

/// The exit code if runs did not come to an end of their own.
const LOST: u8 = 1;

/// Makes all runs of a sweep: a JSON object for each on the standard output, in order, and with `-o` a Parquet file.
pub(crate) fn sweep(file: &Path, options: &SweepOptions) -> Result<Exit, Failure> {
    let Sweep { settings, rows } = Sweep::read(file)?;
    if options.out.as_ref().is_some_and(|out| out.extension().is_none_or(|ending| ending != "parquet")) {
        return Err(Failure::Usage("-o writes a Parquet file: name it FILE.parquet".into()));
    }
    let numbered = rows.iter().enumerate().map(|(at, row)| (at + 1, row));
    let rows: Vec<_> = match options.shard {
        Some(shard) => numbered.filter(|(number, _)| (number - 1) % shard.count == shard.index).collect(),
        None => numbered.collect(),
    };
    let bundle = Bundle::new(&settings, rows.iter().map(|(_, row)| *row))?;
    let kept = if options.no_cache { Kept::nothing() } else { kept(&bundle, show::warning)? };
    let processes = options.jobs.map_or_else(cores, usize::from);
    // Better now than after a long run.
    let table = options.out.as_deref().map(|out| {
        ResultFile::new(out).map_err(|error| Failure::Usage(format!("cannot write {}: {error}", out.display())))
    });
    let table = table.transpose()?;
    let _left = interrupt::leave_to_the_program();
    let bar = bar(rows.len());
    let (mut all, mut lost, mut failed) = (Vec::new(), 0_usize, Ok(()));
    let work = Work {
        bundle: &bundle,
        rows: &rows,
        processes,
        timeout: settings.timeout,
        kept,
        is_enough: &interrupt::was_pressed,
    };
    let warn = |text: &str| bar.suspend(|| show::warning(text));
    let take = |row: Row| {
        if interrupt::was_pressed() {
            return ControlFlow::Break(());
        }
        lost += usize::from(!row.result.is_whole());
        failed = print_row(&row);
        bar.inc(1);
        if options.out.is_some() {
            all.push(row);
        }
        if failed.is_ok() { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
    };
    pool::run(work, warn, take).map_err(not_written)?;
    bar.finish_and_clear();
    failed?;
    if interrupt::was_pressed() {
        let kept =
            if options.no_cache { "no results are kept" } else { "finished runs are kept and will not be repeated" };
        let out = options.out.as_ref().map(|out| format!("; {} was not written", out.display()));
        show::warning(&format!("interrupted: {kept}{}", out.unwrap_or_default()));
        return Ok(Exit::INTERRUPTED);
    }
    if let Some(table) = table {
        let out = table.path().to_owned();
        parquet::write(table, &all)
            .map_err(|error| Failure::Other(format!("cannot write {}: {error}", out.display())))?;
    }
    if lost > 0 {
        let runs = if lost == 1 { "1 run".to_owned() } else { format!("{lost} runs") };
        show::warning(&format!("{runs} could not be completed: the rows say why"));
        return Ok(Exit::from(LOST));
    }
    Ok(Exit::SUCCESS)
}

fn print_row(row: &Row) -> Result<(), Failure> {
    let line = serde_json::to_string(row).map_err(|error| Failure::Other(error.to_string()))?;
    answer::write(&(line + "\n"))
}

/// How the runs of a sweep are made.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct SweepSettings {
    /// The number of processes; 0: one for each core.
    pub processes: usize,
    /// The time on the computer's clock after which a run is given up: s. `None`: [`TIMEOUT`].
    pub timeout: Option<f64>,
    /// Whether known results are reused, and new ones are kept.
    pub keeps: bool,
}

/// Makes runs for a host, as [`sweep`] does.
pub(crate) fn all(
    bundle: &Bundle,
    rows: &[Parameters],
    SweepSettings { processes, timeout, keeps }: SweepSettings,
    is_enough: &(dyn Fn() -> bool + Sync),
    take: &mut dyn FnMut(Row),
    warn: &mut dyn FnMut(&str),
) -> Result<(), Failure> {
    let rows: Vec<_> = rows.iter().enumerate().map(|(at, row)| (at + 1, row)).collect();
    let processes = if processes == 0 { cores() } else { processes };
    let kept = if keeps { kept(bundle, &mut *warn)? } else { Kept::nothing() };
    let take = |row| {
        take(row);
        ControlFlow::Continue(())
    };
    pool::run(Work { bundle, rows: &rows, processes, timeout, kept, is_enough }, warn, take).map_err(not_written)
}

/// The known results of this bundle. If results cannot be kept, the sweep continues without them.
fn kept(bundle: &Bundle, mut warn: impl FnMut(&str)) -> Result<Kept, Failure> {
    let mut nothing = |error: &dyn std::fmt::Display| {
        warn(&format!("results cannot be kept for the next sweep: {error}"));
        Kept::nothing()
    };
    match Cache::find() {
        Ok(cache) => Ok(Kept::open(&cache.results(&bundle.key())).unwrap_or_else(|error| nothing(&error))),
        Err(failure @ Failure::Usage(_)) => Err(failure),
        Err(failure) => Ok(nothing(&failure)),
    }
}

fn cores() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

fn bar(runs: usize) -> ProgressBar {
    if !show::is_watched() {
        return ProgressBar::hidden();
    }
    let bar = ProgressBar::new(runs as u64);
    if let Ok(style) = ProgressStyle::with_template("{bar:30} {pos}/{len} runs, {per_sec}, {eta} to go") {
        bar.set_style(style);
    }
    bar
}
