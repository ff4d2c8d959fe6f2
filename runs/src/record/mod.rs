//! `arl2rs run --record FILE.mcap`: writes what the program reports into a file that viewers of robot data open, and a
//! description of the robots beside it. `docs/recordings.md` describes what the recording holds.

mod links;
pub(crate) mod message;
pub(crate) mod messages;
mod parts;
mod recorder;
mod scene;
mod schemas;
mod sink;
#[cfg(test)]
mod tests;
mod urdf;

use std::error::Error;
use std::io::BufWriter;
use std::path::{Path, PathBuf};

use crate::listen::Subscriber;
use crate::result_file;
use crate::scenery::Scenery;
use crate::texts::{self, Text};
use arl_robot::result_file::ResultFile;
use arl_terminal::failure::Failure;
use arl_terminal::show;
use arl_wire::Line;
pub(crate) use message::RunMessage;
pub(crate) use recorder::Recorder;
pub(crate) use sink::Sink;

/// The description of the robots, beside a recording.
const DESCRIPTION: &str = "cell.urdf";

/// A recording that is being made.
pub struct Recording {
    path: PathBuf,
    /// The texts of the program, until they are written.
    sources: Vec<Text>,
    recorder: Recorder<sink::File<BufWriter<ResultFile>>>,
    /// Where the description goes; nowhere if a file is there that no recording has written.
    description: Option<PathBuf>,
}

impl Recording {
    /// Checks that the file can be written: better to fail now than after a long run. It is begun with the run. A
    /// `cell.urdf` beside it that is the user's own stays as it is.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn create(path: &Path, scenery: &Scenery, sources: &[PathBuf]) -> Result<Self, Failure> {
        let file = result_file(path)?;
        let recorder = Recorder::new(sink::File::new(BufWriter::new(file)), scenery);
        let sources = texts::read(sources);
        let description = path.with_file_name(DESCRIPTION);
        let is_own =
            !description.exists() || std::fs::read(&description).is_ok_and(|text| urdf::is_written_here(&text));
        if !is_own {
            let file = description.display();
            show::warning(&format!("{file} is not of a recording: it stays, and the robots are not described in it"));
        }
        Ok(Self { path: path.to_owned(), sources, recorder, description: is_own.then_some(description) })
    }
}

impl Recording {
    /// Writes the description of the cell. A recording is complete without it.
    fn describe(&self) {
        let Some(description) = &self.description else { return };
        if let Err(error) = std::fs::write(description, urdf::urdf(self.recorder.arms(), self.recorder.scenery())) {
            show::warning(&format!("cannot write {}: {error}", description.display()));
        }
    }
}

impl Subscriber for Recording {
    fn wants_each_motion(&self) -> bool {
        true
    }

    fn receive(&mut self, line: &Line) -> Result<Vec<Line>, Box<dyn Error>> {
        for Text { name, text } in std::mem::take(&mut self.sources) {
            self.recorder.source(&name, &text)?;
        }
        self.recorder.receive(line)?;
        if matches!(line, Line::Hello(_)) {
            self.describe();
        }
        Ok(Vec::new())
    }

    fn end(mut self: Box<Self>) -> Result<(), Box<dyn Error>> {
        self.recorder.finish()?;
        // The places of robots are known once they have moved.
        self.describe();
        Ok(())
    }

    fn broken(&self) -> String {
        format!("the recording {} is incomplete", self.path.display())
    }
}
