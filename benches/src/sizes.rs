//! Programs of any size: motions in a row, points, long functions, many functions.

use std::fmt::Write;

/// A kind of program, of any number of lines or points.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Sized {
    /// `lin` with literal poses, speeds and zones, in `main`.
    Motions,
    /// Points in global variables, 200 of which motions go to.
    Points,
    /// One function of ordinary lines: branches, waits, io, motions, output.
    Function,
    /// The same lines in functions of some 30.
    Functions,
}

/// So many of the points are used.
const USED_POINTS: usize = 200;

impl Sized {
    /// The program with so many lines, or points.
    pub fn program(self, size: usize) -> String {
        let mut text = String::new();
        match self {
            Sized::Motions => {
                text += "func void main()\n  movej j:{0,-90,90,0,60,0}\n";
                (0..size).for_each(|at| motion(&mut text, at));
                text += "endfunc\n";
            }
            Sized::Points => {
                for at in 0..size {
                    let (x, y) = spiral(at);
                    line(&mut text, format_args!("pose p{at} = {{{x:.3},{y:.3},900,0,150,0}}"));
                }
                text += "func void main()\n  movej j:{0,-90,90,0,60,0}\n";
                let step = (size / USED_POINTS).max(1);
                for at in (0..size).step_by(step) {
                    line(&mut text, format_args!("  lin p{at},vl:200mm/s,sl:0.5mm"));
                }
                text += "endfunc\n";
            }
            Sized::Function => {
                text += "func void main()\n  int count = 0\n  bool late\n  double x = 100\n";
                (0..size.div_ceil(BLOCK_LINES)).for_each(|at| block(&mut text, at));
                text += "endfunc\n";
            }
            Sized::Functions => {
                const BLOCKS: usize = 2;
                let functions = size.div_ceil(BLOCKS * BLOCK_LINES + 5);
                for at in 0..functions {
                    line(&mut text, format_args!("func void step{at}(int count)\n  bool late\n  double x = 100"));
                    (0..BLOCKS).for_each(|block_at| block(&mut text, at * BLOCKS + block_at));
                    text += "endfunc\n";
                }
                text += "func void main()\n";
                (0..functions).for_each(|at| line(&mut text, format_args!("  step{at}({at})")));
                text += "endfunc\n";
            }
        }
        text
    }
}

/// How many lines a block of ordinary ones has.
const BLOCK_LINES: usize = 12;

fn line(text: &mut String, what: std::fmt::Arguments<'_>) {
    // A string takes all that is written to it.
    let _ = writeln!(text, "{what}");
}

/// A point of a spiral, in mm.
fn spiral(at: usize) -> (f64, f64) {
    let angle = at as f64 / 100.0;
    let radius = 20.0 + at as f64 * 0.0004;
    (900.0 + radius * angle.cos(), radius * angle.sin())
}

fn motion(text: &mut String, at: usize) {
    let (x, y) = spiral(at);
    let (speed, zone) = (200 + at % 7 * 10, (at % 3) as f64 / 10.0 + 0.05);
    line(text, format_args!("  lin p:{{{x:.3},{y:.3},900,0,150,0}},vl:{speed}mm/s,sl:{zone:.2}mm"));
}

fn block(text: &mut String, at: usize) {
    let (input, output, wait) = (at % 30 + 1, at % 20 + 1, at % 9 + 1);
    line(text, format_args!("  if(getdi({input}))"));
    line(text, format_args!("    setdo({output},true)"));
    line(text, format_args!("    count = count + {at}"));
    line(text, format_args!("  else"));
    line(text, format_args!("    setdo({output},false)"));
    line(text, format_args!("    waittime 0.{wait}"));
    line(text, format_args!("  endif"));
    line(text, format_args!("  waituntil getdi({input}),maxtime:{wait},timeoutflag:late"));
    motion(text, at);
    line(text, format_args!("  movej j:{{{input},-90,90,0,60,0}},vp:{}%", wait * 10));
    line(text, format_args!("  print \"block {at}\",count,x"));
    line(text, format_args!("  x = x * 1.5 + count"));
}
