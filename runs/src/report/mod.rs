//! What a run took and what happened in it: as JSON, as a page, and compared with another run.

pub(crate) mod compare;
mod html;
mod summary;
#[cfg(test)]
mod tests;

use arl_terminal::exit::Exit;
use std::error::Error;
use std::fs::File;
use std::io::{Read, Write};
use std::path::Path;

use arl_robot::regular_file;
use arl_robot::result_file::ResultFile;

use crate::listen::Subscriber;
use crate::playback::{self, Store};
use crate::record::Recorder;
use crate::result_file;
use crate::scenery::Scenery;
use arl_terminal::answer;
use arl_terminal::answer::{Format, ReportFormat};
use arl_terminal::failure::Failure;
use arl_wire::Line;
pub(crate) use compare::Differences;
pub(crate) use summary::Summary;

/// The file name that stands for the standard error.
const STANDARD_ERROR: &str = "-";

/// A report that is being made while a program runs.
pub struct Reporting {
    /// `None` for the standard error.
    file: Option<ResultFile>,
    format: ReportFormat,
    recorder: Recorder<Store>,
}

impl Reporting {
    /// Checks that the file can be written: better to fail now than after a long run.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn create(file: &Path, format: ReportFormat, scenery: &Scenery) -> Result<Self, Failure> {
        let file = (file != Path::new(STANDARD_ERROR)).then(|| result_file(file)).transpose()?;
        Ok(Self { file, format, recorder: Recorder::new(Store::default(), scenery) })
    }
}

impl Subscriber for Reporting {
    fn wants_each_motion(&self) -> bool {
        true
    }

    fn receive(&mut self, line: &Line) -> Result<Vec<Line>, Box<dyn Error>> {
        self.recorder.receive(line)?;
        Ok(Vec::new())
    }

    fn end(self: Box<Self>) -> Result<(), Box<dyn Error>> {
        let summary = Summary::of(&self.recorder.ended()?);
        let text = match self.format {
            ReportFormat::Html => html::page(&summary),
            _ => format!("{}\n", serde_json::to_string_pretty(&summary)?),
        };
        match self.file {
            Some(file) => file.replace(text.as_bytes())?,
            None => std::io::stderr().write_all(text.as_bytes())?,
        }
        Ok(())
    }

    fn broken(&self) -> String {
        "the report could not be written".to_owned()
    }
}

/// Prints what differs between two runs; the exit code is 1 if anything does.
///
/// # Errors
/// One of them cannot be read, or is neither a recording nor a summary.
pub fn compare(one: &Path, other: &Path, format: Format) -> Result<Exit, Failure> {
    let differences = Differences::between(&summary(one)?, &summary(other)?);
    let text = match format {
        Format::Human => differences.to_string(),
        Format::Json => format!("{}\n", serde_json::json!(differences)),
    };
    answer::write(&text)?;
    Ok(Exit::from(u8::from(!differences.is_empty())))
}

/// The summary of a recording, or the one that a file holds.
fn summary(file: &Path) -> Result<Summary, Failure> {
    let fail = |error| Failure::io("read", file, &error);
    // A recording may be long: the first bytes tell what it is.
    let mut first = [0; 64];
    let opened = regular_file::expect(file).and_then(|()| File::open(file)).map_err(fail)?;
    let length = (&opened).read(&mut first).map_err(fail)?;
    if !first.get(..length).unwrap_or_default().trim_ascii_start().starts_with(b"{") {
        return Ok(Summary::of(&playback::read(file)?));
    }
    let bytes = regular_file::read(file).map_err(fail)?;
    serde_json::from_slice(&bytes).map_err(|error| {
        let what = "not a report of a whole run as `arl2rs run --report=FILE --format json` writes it";
        Failure::Other(format!("{} is {what}: {error}", file.display()))
    })
}
