//! The files that the cells of a sweep name, which differ where rows name others: robots of channels, and shapes if
//! runs look at them.
//!
//! A cell names files from its own folder, also where the runs are made. So the files are as far from the cell there as
//! here.

use super::bundle::{SCRIPT, full, read, with_slashes};
use arl_robot::Robot;
use arl_robot::cell::Cell;
use arl_robot::changes::Changes;
use arl_runs::scenery;
use arl_terminal::failure::Failure;
use arl2rs::check::clean;
use std::path::{Path, PathBuf};

/// The folder of a cell in a bundle that is not in the program's.
const CELL: &str = "cell";

/// The files of a cell.
#[derive(Clone, Copy)]
pub(super) struct CellFiles<'a> {
    /// The cell file.
    pub(super) cell: &'a Path,
    /// The folder of the program.
    pub(super) script: &'a Path,
    /// Whether runs look at shapes.
    pub(super) looks: bool,
}

impl CellFiles<'_> {
    /// The place of a file in the bundle, as far from the cell's as on the disk.
    ///
    /// # Errors
    /// It is outside the folder that goes along: that of the program if the cell is in it, else that of the cell.
    pub(super) fn place(&self, file: &Path) -> Result<String, Failure> {
        let (folder, place) = match self.cell.parent() {
            Some(folder) if !self.cell.starts_with(self.script) => (folder, CELL),
            _ => (self.script, SCRIPT),
        };
        let outside = |_| {
            let (cell, file, folder) = (self.cell.display(), file.display(), folder.display());
            Failure::Usage(format!(
                "{cell} names {file}, which lies outside of {folder}, the folder that is copied for the runs"
            ))
        };
        file.strip_prefix(folder).map(|below| format!("{place}/{}", with_slashes(below))).map_err(outside)
    }

    /// The files of a cell as it is.
    fn named(&self, cell: &Cell) -> Vec<PathBuf> {
        let robots = cell.programs.channels.iter().filter_map(|channel| channel.robot.as_deref());
        let robots = robots.filter(|robot| Robot::text(robot).is_none()).map(PathBuf::from);
        let shapes = self.looks.then(|| scenery::files(cell));
        robots.chain(shapes.into_iter().flatten()).collect()
    }

    /// The files that the cell names with the changes of these words: their full paths, and their contents.
    ///
    /// # Errors
    /// A change is not valid, or a file cannot be read.
    pub(super) fn read(&self, words: &[String]) -> Result<Vec<(PathBuf, Vec<u8>)>, Failure> {
        let changes = words.chunks_exact(2).filter(|pair| pair.iter().any(|word| word == "--set"));
        let changes: Vec<&str> = changes.filter_map(|pair| pair.get(1).map(String::as_str)).collect();
        let changes = Changes::of(&changes).map_err(Failure::Usage)?;
        let cell = Cell::load_with(self.cell, &changes).map_err(|error| Failure::Usage(error.to_string()))?;
        let files = self.named(&cell).into_iter();
        files.map(|file| full(&file).and_then(|file| Ok((file.clone(), read(&file)?)))).collect()
    }

    /// Checks that the same cell in the folder of a worker names `count` files, all of that folder.
    ///
    /// # Errors
    /// The cell does not.
    pub(super) fn check(&self, there: &Cell, folder: &Path, count: usize) -> Result<(), Failure> {
        let found = self.named(there);
        if found.len() == count && found.iter().all(|file| clean(file).starts_with(folder)) {
            return Ok(());
        }
        let text = "a file is named by an absolute path or by a package: where the runs are made, it is found only by a path relative to the file that \
                    names it";
        Err(Failure::Usage(format!("{}: {text}", self.cell.display())))
    }
}
