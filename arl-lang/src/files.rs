//! Files of programs.

use std::path::Path;

/// Whether a file holds the data of the program beside it: `NAME_data.arl`, in any case.
pub fn is_data(path: &Path) -> bool {
    path.file_stem().is_some_and(|stem| stem.to_string_lossy().to_ascii_lowercase().ends_with("_data"))
}
