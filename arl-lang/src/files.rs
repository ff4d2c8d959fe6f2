//! Files of programs.

use std::path::{Path, PathBuf};

/// The end of a data file's name.
const DATA: &str = "_data";

/// Whether a file holds the data of the program beside it: `NAME_data.arl`, in any case.
pub fn is_data(path: &Path) -> bool {
    path.file_stem().is_some_and(|stem| stem.to_string_lossy().to_ascii_lowercase().ends_with(DATA))
}

/// The program whose data a file holds: `NAME.arl` of `NAME_data.arl`, in any case. `None` if it is not a data file.
///
/// ```
/// use std::path::Path;
/// assert_eq!(arl_lang::files::owner(Path::new("a/pick_data.arl")).as_deref(), Some(Path::new("a/pick.arl")));
/// assert_eq!(arl_lang::files::owner(Path::new("a/pick.arl")), None);
/// ```
pub fn owner(path: &Path) -> Option<PathBuf> {
    let stem = path.file_stem()?.to_string_lossy().into_owned();
    let name = stem.get(..stem.len().checked_sub(DATA.len())?).filter(|name| !name.is_empty())?;
    is_data(path).then(|| path.with_file_name(format!("{name}.arl")))
}
