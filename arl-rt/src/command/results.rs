//! The files and figures that a run leaves.

use std::io::Write;
use std::path::Path;

use crate::command::options::Report;
use crate::command::report;
use crate::command::say::warn;
use crate::controller::Controller;
use arl_robot::result_file::ResultFile;

/// Writes the requested figures of a finished run; reports where that fails.
pub(super) fn write_figures(controller: &Controller, report: Option<WriteReport>, cycle_time: Option<&Path>) {
    if let Some(report) = report
        && let Err(error) = report(controller)
    {
        warn(&format!("the report cannot be written: {error}"));
    }
    if let Some(file) = cycle_time
        && let Err(error) = std::fs::write(file, format!("{}\n", controller.time()))
    {
        warn(&format!("cannot write {}: {error}", file.display()));
    }
}

/// Writes the report at the end of a run.
pub(super) type WriteReport = Box<dyn FnOnce(&Controller) -> std::io::Result<()>>;

/// Makes the function that writes the report. Whether its file can be written is checked at the start: better to fail
/// now than after a long run.
pub(super) fn report_to(report: Report) -> Result<WriteReport, String> {
    Ok(match report {
        Report::Table => Box::new(|controller| {
            let text = report::tables(&controller.recorded_motions());
            let lateness = controller.lateness().map(ToString::to_string).unwrap_or_default();
            std::io::stderr().write_all((text + &lateness).as_bytes())
        }),
        Report::File(path) => {
            let file = file(&path)?;
            Box::new(move |controller| {
                let text = report::all_json(&controller.recorded_motions());
                let clock = controller.lateness().map(report::clock_json).unwrap_or_default();
                file.replace((text + &clock).as_bytes())
            })
        }
    })
}

/// A file for a result of the run.
pub(super) fn file(path: &Path) -> Result<ResultFile, String> {
    ResultFile::new(path).map_err(|error| format!("{}: {error}", path.display()))
}
