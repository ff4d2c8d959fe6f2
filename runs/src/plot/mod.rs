//! Draws what a run did: the path of the TCP in three views, its speed, and the axes' speeds against their limits.
//!
//! The plot is made from the trace, so the compiled program need not know of it.

mod lanes;
mod outline;
mod robot;
mod scale;
mod svg;
mod thin;
mod times;
mod trace;
mod views;

use crate::texts::Text;
use arl_lang::files::is_data;
use arl_robot::result_file::ResultFile;
use arl_terminal::failure::Failure;
pub use lanes::Lane;
use outline::Outline;
use robot::Robot;
use std::path::Path;
use svg::{Anchor, Area, Picture};
use times::Times;
use trace::{Movement, Rows};
use views::Views;

const WIDTH: f64 = 1200.0;
const LEFT_MARGIN: f64 = 62.0;
const VIEWS_HEIGHT: f64 = 330.0;
/// px for the legends to the right of the charts.
const LEGENDS: f64 = 158.0;
/// No more lines than this are listed.
const LISTED: usize = 30;
const COLUMNS: usize = 3;

/// The program that ran, for the title and the list of lines.
#[derive(Clone, Default, Debug)]
pub struct Ran {
    /// The text above the picture.
    pub title: String,
    /// The file that has `main`, where that is known.
    pub main: Option<String>,
    /// The texts of the files.
    pub sources: Vec<Text>,
    /// The signals that changed.
    pub lanes: Vec<Lane>,
}

impl Ran {
    /// The text of a line of a file. Where the trace does not name the file, `None` unless the whole program is one
    /// file; data files do not count.
    fn text(&self, file: Option<&str>, line: u32) -> Option<&str> {
        let mut programs = self.sources.iter().filter(|one| !is_data(Path::new(&one.name)));
        let source = match file {
            Some(file) => self.sources.iter().find(|one| one.name == file),
            None => programs.next().filter(|_| programs.next().is_none()),
        };
        let number = usize::try_from(line).ok()?.checked_sub(1)?;
        source?.text.lines().nth(number).map(str::trim)
    }
}

/// Draws the trace at `trace` to the file `plot`; returns whether there was a motion to draw. Without one the file
/// stays as it is.
///
/// # Errors
/// The trace cannot be read or has a malformed line, or the plot cannot be written.
pub fn plot(trace: &Path, plot: ResultFile, robot: arl_robot::Robot, ran: &Ran) -> Result<bool, Failure> {
    let robot = Robot::of(robot);
    let mut rows = Rows::open(trace)?;
    let Some(outline) = Outline::of(rows.by_ref())? else { return Ok(false) };
    let outline = outline.with_files(rows.files(), ran.main.as_deref());
    let text = draw(&outline, &robot, ran, Rows::open(trace)?)?;
    let path = plot.path().to_owned();
    plot.replace(text.as_bytes()).map_err(|error| Failure::io("write", &path, &error))?;
    Ok(true)
}

fn draw(outline: &Outline, robot: &Robot, ran: &Ran, rows: Rows) -> Result<String, Failure> {
    let whole = WIDTH - LEFT_MARGIN - 24.0;
    let views = Area { x: LEFT_MARGIN, y: 92.0, width: whole, height: VIEWS_HEIGHT };
    let charts = |y: f64, height: f64| Area { x: LEFT_MARGIN, y, width: whole - LEGENDS, height };
    let band = charts(views.bottom() + 46.0, 16.0);
    let speed = charts(band.bottom() + 28.0, 150.0);
    let axes = charts(speed.bottom() + 34.0, 240.0);

    let mut picture = Picture::default();
    let mut paths = Views::new(outline, &views, 46.0);
    let mut times = Times::new(outline, robot, band, speed, axes);
    let mut movement = Movement::default();
    for row in rows {
        let moved = movement.next(row?);
        paths.push(outline, &moved);
        times.push(&moved);
    }
    head(outline, robot, ran, &mut picture);
    paths.draw(outline, &mut picture);
    times.draw(&mut picture);
    let signals = charts(axes.bottom() + 60.0, lanes::height(&ran.lanes));
    lanes::draw(&ran.lanes, outline.time, &signals, &mut picture);
    let height = lines(outline, ran, signals.bottom(), &mut picture);
    Ok(picture.finish(WIDTH, height, &ran.title))
}

fn head(outline: &Outline, robot: &Robot, ran: &Ran, picture: &mut Picture) {
    picture.text([LEFT_MARGIN, 36.0], Anchor::Start, "title", &ran.title);
    let count = outline.motions();
    let motions = if count == 1 { "1 motion".to_owned() } else { format!("{count} motions") };
    let about = format!("{} \u{b7} {motions} \u{b7} {:.3} s", robot.name, outline.time[1] - outline.time[0]);
    picture.text([LEFT_MARGIN, 56.0], Anchor::Start, "", &about);
}

/// The lines with motions and their colours; returns where the picture ends.
fn lines(outline: &Outline, ran: &Ran, top: f64, picture: &mut Picture) -> f64 {
    const APART: f64 = 19.0;
    picture.text([LEFT_MARGIN, top], Anchor::Start, "head", "Lines of the program");
    let width = (WIDTH - LEFT_MARGIN - 24.0) / COLUMNS as f64;
    let listed = outline.lines.len().min(LISTED);
    let rows = listed.div_ceil(COLUMNS);
    for (at, line) in outline.lines.iter().take(listed).enumerate() {
        let x = LEFT_MARGIN + (at / rows) as f64 * width;
        let y = top + 22.0 + (at % rows) as f64 * APART;
        picture.rect(&Area { x, y: y - 9.0, width: 12.0, height: 10.0 }, "", Some(outline.colour(*line)));
        let times = outline.runs(*line);
        let times = if times > 1 { format!("  ({times}\u{d7})") } else { String::new() };
        let text = ran.text(outline.file(*line), line.line).unwrap_or_default();
        let text = format!("{:>4}  {text}", outline.label(*line));
        let text = shortened(&text, 51 - times.chars().count()) + &times;
        picture.text([x + 18.0, y], Anchor::Start, "code", &text);
    }
    let mut bottom = top + 22.0 + rows as f64 * APART;
    if outline.lines.len() > listed {
        let more = format!("and {} more lines", outline.lines.len() - listed);
        picture.text([LEFT_MARGIN, bottom + 4.0], Anchor::Start, "tick", &more);
        bottom += APART;
    }
    bottom + 10.0
}

fn shortened(text: &str, most: usize) -> String {
    if text.chars().count() <= most {
        return text.to_owned();
    }
    text.chars().take(most.saturating_sub(1)).chain(['\u{2026}']).collect()
}
