//! Traces, read back.

use super::geometry::{Frame, frame};

/// What the robot did in a cycle.
#[derive(Clone, Debug)]
pub(crate) struct Row {
    /// s
    pub(crate) t: f64,
    /// Of the motion being executed; 0 for none, and for motion beside the program.
    pub(crate) line: usize,
    /// Its running number; 0 for none.
    pub(crate) motion: u64,
    /// The robot's own axes, then external ones, in deg (mm).
    pub(crate) axes: Vec<f64>,
    /// In the world, mm.
    pub(crate) tcp: Frame,
}

/// The rows of a trace.
pub(crate) fn read(text: &str) -> Vec<Row> {
    let mut lines = text.lines();
    let header: Vec<&str> = lines.next().expect("a header").split(',').collect();
    let column = |name: &str| header.iter().position(|known| *known == name).expect("a column");
    let (t, line, motion) = (column("t"), column("line"), column("motion"));
    let (first_axis, x) = (column("j1"), column("x"));
    let row = |text: &str| {
        let fields: Vec<&str> = text.split(',').collect();
        assert_eq!(fields.len(), header.len(), "{text}");
        let number = |at: usize| -> f64 { fields[at].parse().unwrap_or_else(|_| panic!("column {at} of {text}")) };
        Row {
            t: number(t),
            line: fields[line].parse().expect("a line"),
            motion: fields[motion].parse().expect("a number"),
            axes: (first_axis..x).filter(|at| !fields[*at].is_empty()).map(number).collect(),
            tcp: frame(std::array::from_fn(|i| number(x + i))),
        }
    };
    lines.map(row).collect()
}
