//! Traces, read back.

use super::vector::Vector;

/// What the robot did in a cycle.
#[derive(Clone, Debug)]
pub(crate) struct Row {
    /// s
    pub(crate) t: f64,
    /// Of the motion being executed; 0 for none.
    pub(crate) line: usize,
    /// Own axes, in deg (mm).
    pub(crate) axes: Vec<f64>,
    /// TCP in mm.
    pub(crate) tcp: Vector,
    /// Its turns about z, the new y and the new x in deg.
    pub(crate) turns: Vector,
}

/// The rows of a trace.
pub(crate) fn read(text: &str) -> Vec<Row> {
    let mut lines = text.lines();
    let header: Vec<&str> = lines.next().expect("a header").split(',').collect();
    let column = |name: &str| header.iter().position(|known| *known == name).expect("a column");
    let (t, line, first_axis, x) = (column("t"), column("line"), column("j1"), column("x"));
    let row = |text: &str| {
        let fields: Vec<&str> = text.split(',').collect();
        assert_eq!(fields.len(), header.len(), "{text}");
        let number = |at: usize| -> f64 { fields[at].parse().unwrap_or_else(|_| panic!("column {at} of {text}")) };
        let axes = (first_axis..first_axis + 6).filter(|at| !fields[*at].is_empty()).map(number).collect();
        Row {
            t: number(t),
            line: fields[line].parse().expect("a line"),
            axes,
            tcp: [x, x + 1, x + 2].map(number),
            turns: [x + 3, x + 4, x + 5].map(number),
        }
    };
    lines.map(row).collect()
}
