//! The first pass over a trace: how long, how far, which motions. The second pass draws.

use super::robot::AXES;
use super::trace::{Movement, ProgramLine, Row};
use arl_terminal::failure::Failure;
use std::collections::hash_map::Entry;
use std::collections::{HashMap, HashSet};

/// A motion, or a part of one between two standstills: the time in which its line was executed.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct Stretch {
    pub(super) place: ProgramLine,
    pub(super) motion: u64,
    /// s.
    pub(super) from: f64,
    pub(super) to: f64,
}

/// What a trace is about.
#[derive(Clone, PartialEq, Debug)]
pub(super) struct Outline {
    /// s of the first and of the last row.
    pub(super) time: [f64; 2],
    /// Lowest and highest x, y, z of the TCP while it moved, mm.
    pub(super) space: [[f64; 2]; 3],
    pub(super) stretches: Vec<Stretch>,
    /// The lines with motions, in the order of their first execution.
    pub(super) lines: Vec<ProgramLine>,
    /// The index of each line among them.
    places: HashMap<ProgramLine, usize>,
    /// The files that the trace names, and the one that has `main` where that is known.
    files: Vec<String>,
    main: Option<String>,
    /// The highest speed of the TCP, mm/s.
    pub(super) speed: f64,
    /// The highest speed of each axis, deg/s (mm/s).
    pub(super) axes: [f64; AXES],
}

impl Outline {
    /// Reads all rows; `None` if there is no motion among them.
    ///
    /// # Errors
    /// A row cannot be read.
    pub(super) fn of(rows: impl Iterator<Item = Result<Row, Failure>>) -> Result<Option<Self>, Failure> {
        let mut outline = Self {
            time: [f64::INFINITY, 0.0],
            space: [[f64::INFINITY, f64::NEG_INFINITY]; 3],
            stretches: Vec::new(),
            lines: Vec::new(),
            places: HashMap::new(),
            files: Vec::new(),
            main: None,
            speed: 0.0,
            axes: [0.0; AXES],
        };
        let mut movement = Movement::default();
        let mut before = 0.0;
        for row in rows {
            let row = row?;
            let moved = movement.next(row);
            outline.time = [outline.time[0].min(row.t), row.t];
            outline.speed = outline.speed.max(moved.speed.unwrap_or(0.0));
            for (most, speed) in outline.axes.iter_mut().zip(moved.axes) {
                *most = most.max(speed.abs());
            }
            if row.motion != 0 {
                // Nothing is known of the first row.
                outline.motion(&row, before, moved.stands() && row.t > outline.time[0]);
            }
            before = row.t;
        }
        Ok((!outline.stretches.is_empty()).then_some(outline))
    }

    fn motion(&mut self, row: &Row, before: f64, stands: bool) {
        for ([low, high], place) in self.space.iter_mut().zip(row.tcp) {
            (*low, *high) = (low.min(place), high.max(place));
        }
        if stands {
            return;
        }
        match self.stretches.last_mut() {
            Some(last) if last.to == before && last.motion == row.motion && last.place == row.place => last.to = row.t,
            _ => {
                let from = if row.t > self.time[0] { before } else { row.t };
                self.stretches.push(Stretch { place: row.place, motion: row.motion, from, to: row.t });
                if let Entry::Vacant(place) = self.places.entry(row.place) {
                    place.insert(self.lines.len());
                    self.lines.push(row.place);
                }
            }
        }
    }

    /// Names the files of its lines: those that the trace names, and the one that has `main`, where that is known.
    pub(super) fn with_files(self, files: &[String], main: Option<&str>) -> Self {
        Self { files: files.to_vec(), main: main.map(str::to_owned), ..self }
    }

    /// The file of a line, if the trace names it.
    pub(super) fn file(&self, line: ProgramLine) -> Option<&str> {
        self.files.get(line.file).map(String::as_str).filter(|name| !name.is_empty())
    }

    /// `12`, or `grips.arl:12` where it is not in the file that has `main`.
    pub(super) fn label(&self, line: ProgramLine) -> String {
        let number = line.line;
        // Where it is not known which file has `main`, the number is enough as long as there is one file.
        let is_in_main = |file: &str| self.main.as_deref().map_or(self.files.len() == 1, |main| main == file);
        match self.file(line) {
            Some(file) if !is_in_main(file) => format!("{file}:{number}"),
            _ => number.to_string(),
        }
    }

    /// How often a line was executed.
    pub(super) fn runs(&self, line: ProgramLine) -> usize {
        self.stretches
            .iter()
            .filter(|stretch| stretch.place == line)
            .map(|stretch| stretch.motion)
            .collect::<HashSet<_>>()
            .len()
    }

    /// How many motions there were.
    pub(super) fn motions(&self) -> usize {
        self.stretches.iter().map(|stretch| (stretch.place, stretch.motion)).collect::<HashSet<_>>().len()
    }

    /// The index of a line among the lines with motions.
    pub(super) fn place(&self, line: ProgramLine) -> Option<usize> {
        self.places.get(&line).copied()
    }

    /// The colour of a line's motions.
    pub(super) fn colour(&self, line: ProgramLine) -> &'static str {
        colour(self.place(line).unwrap_or(0))
    }
}

/// Colours that can be told apart on white, also by people who distinguish few colours.
const COLOURS: [&str; 10] =
    ["#0969da", "#d1570a", "#1a7f37", "#a0447a", "#8a6d00", "#0a8a9a", "#cf222e", "#6639ba", "#57606a", "#3fa34d"];

/// The colour with this number; they repeat after ten.
pub(super) fn colour(at: usize) -> &'static str {
    COLOURS.get(at % COLOURS.len()).copied().unwrap_or("#57606a")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn place(line: u32) -> ProgramLine {
        ProgramLine { file: 0, line }
    }

    fn row(t: f64, line: u32, motion: u64, x: f64) -> Row {
        Row { t, place: place(line), motion, axes: [f64::NAN; AXES], tcp: [x, 1.0, 2.0] }
    }

    #[test]
    fn stretches_are_motions_and_lines_come_once() {
        let rows = [(0.0, 0, 0, 0.0), (0.001, 7, 1, 1.0), (0.002, 7, 1, 3.0), (0.003, 9, 2, 4.0), (0.004, 0, 0, 4.0)];
        let again = [(0.005, 7, 3, 5.0), (0.006, 7, 3, 6.0)];
        let rows = rows.into_iter().chain(again).map(|(t, line, motion, x)| Ok(row(t, line, motion, x)));
        let outline = Outline::of(rows).unwrap().unwrap();
        assert_eq!(outline.lines, [7, 9].map(place));
        let stretches: Vec<_> = outline.stretches.iter().map(|it| (it.place.line, it.from, it.to)).collect();
        assert_eq!(stretches, [(7, 0.0, 0.002), (9, 0.002, 0.003), (7, 0.004, 0.006)]);
        assert_eq!((outline.time, outline.space[0]), ([0.0, 0.006], [1.0, 6.0]));
        assert!((outline.speed - 2000.0).abs() < 1e-6);
        assert_ne!(outline.colour(place(7)), outline.colour(place(9)));
    }

    #[test]
    fn a_motion_that_stands_is_not_executed() {
        let rows = [(0.0, 0.0), (0.001, 1.0), (0.002, 2.0), (0.003, 2.0), (0.004, 2.0), (0.005, 3.0), (0.006, 4.0)];
        let outline = Outline::of(rows.into_iter().map(|(t, x)| Ok(row(t, 7, 1, x)))).unwrap().unwrap();
        let stretches: Vec<_> = outline.stretches.iter().map(|it| (it.place.line, it.from, it.to)).collect();
        assert_eq!(stretches, [(7, 0.0, 0.002), (7, 0.004, 0.006)]);
        assert_eq!((outline.runs(place(7)), outline.motions()), (1, 1));
    }

    #[test]
    fn lines_of_other_files_are_lines_of_their_own() {
        let at = |t: f64, file: usize| Row { place: ProgramLine { file, line: 7 }, ..row(t, 7, 1, t) };
        let rows = [(0.0, 0), (0.001, 0), (0.002, 1), (0.003, 1)].map(|(t, file)| Ok(at(t, file)));
        let outline = Outline::of(rows.into_iter()).unwrap().unwrap();
        let names = ["a.arl".to_owned(), "b.arl".to_owned()];
        let labels = |main| {
            let outline = outline.clone().with_files(&names, main);
            outline.lines.iter().map(|line| outline.label(*line)).collect::<Vec<_>>()
        };
        assert_eq!(
            (labels(Some("a.arl")), labels(None)),
            (vec!["7".into(), "b.arl:7".into()], vec!["a.arl:7".into(), "b.arl:7".into()])
        );
        assert_ne!(outline.colour(outline.lines[0]), outline.colour(outline.lines[1]));
    }

    #[test]
    fn without_a_motion_there_is_nothing() {
        assert_eq!(Outline::of([Ok(row(0.0, 0, 0, 0.0))].into_iter()).unwrap(), None);
    }
}
