//! The table of all jobs: what the reference takes in this run, what we take, and whether that is good enough.

/// What is asked of a figure.
#[derive(Clone, Copy)]
pub(crate) enum Goal {
    /// At most so many times the reference's.
    Ratio(f64),
    /// At most so much.
    AtMost(f64),
    /// At least so much.
    AtLeast(f64),
    /// Nothing: it stands there to be compared.
    None,
}

/// A line of the table.
pub(crate) struct Row {
    pub(crate) job: String,
    pub(crate) reference: &'static str,
    /// The reference's figure, as measured in this run; nan where there is none.
    pub(crate) theirs: f64,
    pub(crate) ours: f64,
    pub(crate) unit: &'static str,
    pub(crate) goal: Goal,
}

impl Row {
    /// A line whose goal is a ratio to the reference.
    pub(crate) fn beside(
        job: impl Into<String>,
        reference: &'static str,
        (theirs, ours): (f64, f64),
        unit: &'static str,
        goal: f64,
    ) -> Self {
        Self { job: job.into(), reference, theirs, ours, unit, goal: Goal::Ratio(goal) }
    }

    /// A line without a reference.
    pub(crate) fn alone(job: impl Into<String>, ours: f64, unit: &'static str, goal: Goal) -> Self {
        Self { job: job.into(), reference: "", theirs: f64::NAN, ours, unit, goal }
    }

    fn met(&self) -> Option<bool> {
        match self.goal {
            Goal::Ratio(most) => Some(self.ours <= most * self.theirs),
            Goal::AtMost(most) => Some(self.ours <= most),
            Goal::AtLeast(least) => Some(self.ours >= least),
            Goal::None => None,
        }
    }

    fn print(&self) {
        let ratio = self.ours / self.theirs;
        let goal = match self.goal {
            Goal::Ratio(most) => format!("{}x", figure(most)),
            Goal::AtMost(most) => format!("<= {}", figure(most)),
            Goal::AtLeast(least) => format!(">= {}", figure(least)),
            Goal::None => String::new(),
        };
        println!(
            "| {:<55} | {:<27} | {:>9} | {:>9} | {:<4} | {:>8} | {:>9} | {:<3} |",
            self.job,
            self.reference,
            figure(self.theirs),
            figure(self.ours),
            self.unit,
            figure(ratio),
            goal,
            self.met().map_or("", |met| if met { "yes" } else { "no" }),
        );
    }
}

/// Prints the table as Markdown.
pub(crate) fn print(rows: &[Row]) {
    println!();
    println!(
        "| {:<55} | {:<27} | {:>9} | {:>9} | {:<4} | {:>8} | {:>9} | met |",
        "job", "reference", "reference", "ours", "unit", "ratio", "goal"
    );
    let dashes = |count: usize| "-".repeat(count);
    println!("|{0}|{1}|{2}:|{2}:|{3}|{4}:|{2}:|-----|", dashes(57), dashes(29), dashes(10), dashes(6), dashes(9),);
    rows.iter().for_each(Row::print);
}

/// Four digits that count.
fn figure(value: f64) -> String {
    match value.abs() {
        _ if !value.is_finite() => String::new(),
        0.0 => "0".into(),
        size if !(1e-3..1e7).contains(&size) => format!("{value:.1e}"),
        size if size >= 1000.0 => format!("{value:.0}"),
        size if size >= 100.0 => format!("{value:.1}"),
        size if size >= 10.0 => format!("{value:.2}"),
        size if size >= 0.1 => format!("{value:.3}"),
        _ => format!("{value:.4}"),
    }
}
