//! Kinematics, dynamics and motion beside the best that is known for each job, in one run and one table.
//!
//! `cargo bench -p arl-benches --bench anchors [-- JOB...]`, where a job is one of `kinematics`, `changes`, `replans`,
//! `durations`, `corners`, `dense`. Without any all are measured, which takes some minutes. Times are processor time,
//! the least of rounds in which the contenders take turns; the references run in the same process, so that ratios
//! count. `scripts/anchors-python.py` measures what is not to be had from crates.io.

#![allow(clippy::disallowed_methods)]

mod changes;
mod corners;
mod dense;
mod durations;
mod executed;
mod kinematics;
mod path;
mod pilz;
mod replans;
mod table;

use std::error::Error;

use table::Row;

/// What a job gives.
type Rows = Result<Vec<Row>, Box<dyn Error>>;

/// A job and its name.
type Job = (&'static str, fn() -> Rows);

const JOBS: [Job; 6] = [
    ("kinematics", kinematics::rows),
    ("changes", changes::rows),
    ("replans", replans::rows),
    ("durations", durations::rows),
    ("corners", corners::rows),
    ("dense", dense::rows),
];

fn main() -> Result<(), Box<dyn Error>> {
    let words: Vec<String> = std::env::args().skip(1).filter(|word| !word.starts_with('-')).collect();
    if let Some(word) = words.iter().find(|word| JOBS.iter().all(|(name, _)| name != word)) {
        return Err(format!("no job `{word}`").into());
    }
    let mut rows = Vec::new();
    for (name, job) in JOBS {
        if words.is_empty() || words.iter().any(|word| word == name) {
            rows.extend(job()?);
        }
    }
    table::print(&rows);
    Ok(())
}
