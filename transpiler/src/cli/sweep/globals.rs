//! The global variables that there are: a slip in a name is told before anything runs.

use super::parameter::{GLOBAL, Parameters};
use crate::cli::args::RunOptions;
use crate::cli::failure::Failure;
use crate::cli::program::check_options;
use crate::cli::several;
use crate::compile::check_program;
use crate::near::nearest;
use crate::sources::FileSystem;
use std::collections::BTreeSet;
use std::path::Path;

/// Refuses a sweep of which each run names a global variable that is not there. Where only some do, their rows say so.
///
/// # Errors
/// That is so, or a program cannot be checked.
pub(super) fn check<'p>(
    program: &Path,
    options: &RunOptions,
    rows: impl Iterator<Item = &'p Parameters> + Clone,
) -> Result<(), Failure> {
    if rows.clone().next().is_none() || rows.clone().any(|row| names(row).next().is_none()) {
        return Ok(());
    }
    let known = known(program, options)?;
    let is_known = |name: &str| known.contains(&name.rsplit("::").next().unwrap_or(name).to_lowercase());
    let mut unknown = rows.map(|row| names(row).find(|name| !is_known(name)));
    match unknown.next().flatten() {
        Some(first) if unknown.all(|unknown| unknown.is_some()) => {
            let near = nearest(first, known.iter().map(String::as_str));
            let near = near.map_or_else(String::new, |near| format!("; did you mean `{near}`?"));
            Err(Failure::Usage(format!("there is no global variable `{first}`{near}")))
        }
        _ => Ok(()),
    }
}

/// The global variables that a row names.
fn names(row: &Parameters) -> impl Iterator<Item = &str> {
    row.0.iter().filter_map(|(name, _)| name.strip_prefix(GLOBAL))
}

/// The names of all global variables of all programs, folded.
fn known(program: &Path, options: &RunOptions) -> Result<BTreeSet<String>, Failure> {
    let checking = options.checking();
    let mut all = vec![(program.to_path_buf(), checking.clone())];
    for other in several::named(options.cell.as_deref(), options.robot.as_deref())? {
        all.push((other.path.clone(), other.checking(&checking)));
    }
    let mut known = BTreeSet::new();
    for (path, checking) in all {
        let compiled = check_program(&path, &FileSystem, &check_options(&checking)?)?;
        let globals = compiled.checked.program.into_iter().flat_map(|program| program.globals);
        known.extend(globals.filter(|global| !global.constant).map(|global| global.name.to_lowercase()));
    }
    Ok(known)
}
