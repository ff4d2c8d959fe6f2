//! Reads the trace that a run wrote.

use super::robot::AXES;
use arl_robot::regular_file;
use arl_terminal::failure::Failure;
use std::fs::File;
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};

const HEADER: &str = "t,line,motion,j1,j2,j3,j4,j5,j6,ej1,ej2,ej3,ej4,ej5,ej6,x,y,z,a,b,c";

/// The column that follows where the trace tells which file a line is in.
const FILE_COLUMN: &str = ",file";
/// The number of columns before that.
const COLUMNS: usize = 21;

/// A line of a program.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub(super) struct ProgramLine {
    /// Its file, by its index among those that the trace names ([`Rows::files`]).
    pub(super) file: usize,
    pub(super) line: u32,
}

/// One control cycle.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct Row {
    /// s.
    pub(super) t: f64,
    /// The line of the motion that is executed; 0: none.
    pub(super) place: ProgramLine,
    /// The running number of the motion; 0: none.
    pub(super) motion: u64,
    /// deg (mm); NaN for axes that are not there.
    pub(super) axes: [f64; AXES],
    /// The TCP in the world, in mm.
    pub(super) tcp: [f64; 3],
}

/// The rows of a trace file, one after the other.
pub(super) struct Rows {
    path: PathBuf,
    lines: BufReader<File>,
    number: usize,
    /// Whether rows name the file of their line.
    has_files: bool,
    files: Vec<String>,
}

impl Rows {
    /// Opens a trace file and checks its header.
    ///
    /// # Errors
    /// The file cannot be read, or is not a trace.
    pub(super) fn open(path: &Path) -> Result<Self, Failure> {
        let opened = regular_file::expect(path).and_then(|()| File::open(path));
        let file = opened.map_err(|error| Failure::io("read the trace", path, &error))?;
        let mut lines = BufReader::with_capacity(1 << 16, file);
        let mut header = String::new();
        lines.read_line(&mut header).map_err(|error| Failure::io("read the trace", path, &error))?;
        let header = header.trim_end();
        match header.strip_prefix(HEADER) {
            Some(more @ ("" | FILE_COLUMN)) => {
                Ok(Self { path: path.to_path_buf(), lines, number: 1, has_files: !more.is_empty(), files: Vec::new() })
            }
            _ => Err(Failure::Usage(format!(
                "{} is not a trace of a run: its first line must be `{HEADER}`, with or without `{FILE_COLUMN}` after it",
                path.display()
            ))),
        }
    }

    /// The names of the files that rows have named so far; an empty name where the trace names none.
    pub(super) fn files(&self) -> &[String] {
        &self.files
    }
}

impl Iterator for Rows {
    type Item = Result<Row, Failure>;

    fn next(&mut self) -> Option<Self::Item> {
        let mut line = String::new();
        if let Err(error) = self.lines.read_line(&mut line) {
            return Some(Err(Failure::io("read the trace", &self.path, &error)));
        }
        // The last row of a run that was killed may be cut: in its last column, if none is missing. The name of a file
        // would be another one then.
        let is_cut = !line.ends_with('\n');
        if is_cut && (self.has_files || line.split(',').count() < COLUMNS) {
            return None;
        }
        self.number += 1;
        match row(line.trim_end(), &mut self.files) {
            None if is_cut => None,
            None => Some(Err(Failure::Usage(format!(
                "{}:{}: this is not a row of a trace",
                self.path.display(),
                self.number
            )))),
            read => read.map(Ok),
        }
    }
}

/// Reads a row; a new file is added after the others.
fn row(text: &str, files: &mut Vec<String>) -> Option<Row> {
    let mut fields = text.splitn(COLUMNS + 1, ',');
    let t = fields.next()?.parse().ok()?;
    let line = fields.next()?.parse().ok()?;
    let motion = fields.next()?.parse().ok()?;
    let mut axes = [f64::NAN; AXES];
    for axis in &mut axes {
        let field = fields.next()?;
        if !field.is_empty() {
            *axis = field.parse().ok()?;
        }
    }
    let mut tcp = [0.0; 3];
    for component in &mut tcp {
        *component = fields.next()?.parse().ok()?;
    }
    let file = match (motion, fields.nth(COLUMNS - 18).map(unquoted)) {
        (0, _) => 0,
        (_, file) => place(files, &file.unwrap_or_default()),
    };
    Some(Row { t, place: ProgramLine { file, line }, motion, axes, tcp })
}

/// The index of a file among the known ones, to which a new one is added.
fn place(files: &mut Vec<String>, name: &str) -> usize {
    let known = files.iter().position(|known| known == name);
    known.unwrap_or_else(|| {
        files.push(name.to_owned());
        files.len() - 1
    })
}

/// The text of a field of CSV.
fn unquoted(field: &str) -> String {
    let quoted = field.strip_prefix('"').and_then(|field| field.strip_suffix('"'));
    quoted.map_or_else(|| field.to_owned(), |text| text.replace("\"\"", "\""))
}

/// How the robot moved in one cycle.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct RobotMotion {
    /// The row at the end of the cycle.
    pub(super) row: Row,
    /// Speeds of the axes in deg/s (mm/s); NaN for axes that are not there.
    pub(super) axes: [f64; AXES],
    /// Speed of the TCP in mm/s; `None` where another tool took over.
    pub(super) speed: Option<f64>,
}

impl RobotMotion {
    /// Whether nothing moved.
    pub(super) fn stands(&self) -> bool {
        self.speed == Some(0.0) && self.axes.iter().all(|speed| speed.is_nan() || *speed == 0.0)
    }
}

/// A TCP that accelerates by more than this, mm/s2, when a motion begins is that of another tool.
const TOOL_CHANGE: f64 = 5e5;

/// Turns rows into movements.
#[derive(Clone, Copy, Default, Debug)]
pub(super) struct Movement {
    last: Option<(Row, f64)>,
}

impl Movement {
    /// How the robot moved from the row before to this one; in the first row it is at rest.
    pub(super) fn next(&mut self, row: Row) -> RobotMotion {
        let Some((before, speed_before)) = self.last else {
            self.last = Some((row, 0.0));
            return RobotMotion { row, axes: row.axes.map(|axis| axis * 0.0), speed: Some(0.0) };
        };
        let period = (row.t - before.t).max(1e-9);
        let mut axes = row.axes;
        for (axis, before) in axes.iter_mut().zip(before.axes) {
            *axis = (*axis - before) / period;
        }
        let distance =
            row.tcp.iter().zip(before.tcp).map(|(now, before)| (now - before) * (now - before)).sum::<f64>().sqrt();
        let speed = distance / period;
        let other_tool = row.motion != before.motion && speed - speed_before > TOOL_CHANGE * period;
        self.last = Some((row, if other_tool { speed_before } else { speed }));
        RobotMotion { row, axes, speed: (!other_tool).then_some(speed) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_read_and_empty_axes_are_absent() {
        let files = &mut Vec::new();
        let found = row("0.001000,12,3,1,2,3,4,,,9,,,,,,100,200,300,0,0,0", files).unwrap();
        let place = |file| ProgramLine { file, line: 12 };
        assert_eq!((found.t, found.place, found.motion, found.tcp), (0.001, place(0), 3, [100.0, 200.0, 300.0]));
        assert_eq!((found.axes[3], found.axes[6]), (4.0, 9.0));
        assert!(found.axes[4].is_nan() && found.axes[11].is_nan());
        assert_eq!(row("0.001,12,3,1,2", files), None);
        assert_eq!(row("0.001,twelve,3,1,2,3,4,,,9,,,,,,100,200,300,0,0,0", files), None);
    }

    #[test]
    fn the_column_of_files_is_read() {
        let files = &mut Vec::new();
        let found = [("3", "a.arl"), ("4", "\"b, \"\"c\"\".arl\""), ("0", ""), ("5", "a.arl")].map(|(motion, file)| {
            row(&format!("0.001,12,{motion},1,2,3,4,,,9,,,,,,100,200,300,0,0,0,{file}"), files).unwrap().place.file
        });
        assert_eq!((found, &files[..]), ([0, 1, 0, 0], &["a.arl".to_owned(), "b, \"c\".arl".to_owned()][..]));
    }

    #[test]
    fn speeds_are_differences_and_another_tool_is_no_speed() {
        let at = |t: f64, motion: u64, x: f64, j1: f64| {
            let mut axes = [f64::NAN; AXES];
            axes[0] = j1;
            Row { t, place: ProgramLine { file: 0, line: 1 }, motion, axes, tcp: [x, 0.0, 0.0] }
        };
        let mut movement = Movement::default();
        assert_eq!(movement.next(at(0.0, 1, 5.0, 1.0)).speed, Some(0.0));
        let moved = movement.next(at(0.001, 1, 5.2, 1.1));
        assert!((moved.speed.unwrap() - 200.0).abs() < 1e-6 && (moved.axes[0] - 100.0).abs() < 1e-6);
        assert!(moved.axes[1].is_nan());
        assert_eq!(movement.next(at(0.002, 2, 105.4, 1.2)).speed, None);
        let moved = movement.next(at(0.003, 2, 105.6, 1.3));
        assert!((moved.speed.unwrap() - 200.0).abs() < 1e-6);
    }
}
