//! What a check costs of texts that no one should write: at most 3 s of processor time and 500 MB each, and ten times
//! as much for ten times the text.
//!
//! `cargo bench -p arl-benches --bench input [-- WORDS OF A NAME]`. Builds the command first. What is emitted is
//! measured, too, where the text is a program.

use std::path::Path;
use std::process::Stdio;

use arl_benches::command;
use arl_benches::cost::{Cost, cost, measures};
use arl_benches::inputs::{Amount, all};

/// Seconds and MB.
const GOALS: (f64, f64) = (3.0, 500.0);

fn main() -> Result<(), String> {
    if measures()? {
        return Ok(());
    }
    let wanted: Vec<String> = std::env::args().skip(1).filter(|word| !word.starts_with('-')).collect();
    let command = command::build()?;
    let folder = std::env::temp_dir().join("arl-benches-input");
    std::fs::create_dir_all(&folder).map_err(|error| error.to_string())?;
    println!("{:<48}     s   MB  of a tenth  as JSON s   MB  emitted s   MB", "");
    let wholes = all(Amount::WHOLE).into_iter().zip(all(Amount::WHOLE.tenth()));
    for ((name, whole), (_, tenth)) in wholes.filter(|((name, _), _)| wanted.iter().all(|word| name.contains(word))) {
        let (whole, tenth) = (written(&folder, "whole", &whole)?, written(&folder, "tenth", &tenth)?);
        let run = |words: &[&str]| cost(&command, words, &folder.join("cache"), Stdio::null());
        let people = run(&["check", &whole])?;
        let part = run(&["check", &tenth])?;
        let json = run(&["check", "--format", "json", &whole])?;
        let emitted = if people.code == 0 { Some(run(&["emit", &whole])?) } else { None };
        let missed = [Some(people), Some(json)].into_iter().flatten().any(misses);
        println!(
            "{name:<48} {} {:>11.1}  {} {}{}",
            shown(people),
            people.seconds / part.seconds,
            shown(json),
            emitted.map(shown).unwrap_or_default(),
            if missed { "  missed" } else { "" }
        );
    }
    Ok(())
}

fn misses(cost: Cost) -> bool {
    cost.seconds > GOALS.0 || cost.megabytes > GOALS.1 || !matches!(cost.code, 0 | 1)
}

fn shown(cost: Cost) -> String {
    format!("{:>5.2} {:>4.0}    ", cost.seconds, cost.megabytes)
}

fn written(folder: &Path, name: &str, text: &str) -> Result<String, String> {
    let path = folder.join(name).with_extension("arl");
    std::fs::write(&path, text).map_err(|error| error.to_string())?;
    Ok(path.display().to_string())
}
