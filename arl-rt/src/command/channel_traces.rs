//! Trace files for several robots, one for each.

use std::path::{Path, PathBuf};

use crate::command::options::Options;
use crate::command::results;
use crate::controller::Builder;
use arl_robot::result_file;

/// Gives each foreground channel beyond the first a trace file next to that of the first one.
pub(super) fn trace(mut builder: Builder, options: &Options) -> Result<Builder, String> {
    let Some(first) = options.trace.as_deref() else { return Ok(builder) };
    for number in 2..=builder.foreground_count() {
        let path = numbered(first, number);
        let all = [options.results(), vec![("--trace", path.as_path())]].concat();
        result_file::expect_apart(&all, &options.inputs())?;
        let file = results::file(&path)?;
        builder = builder.trace_of(number, file);
    }
    Ok(builder)
}

/// The trace of a further channel, beside that of the first one: `trace.csv` for channel 2 is `trace.2.csv`.
pub fn numbered(path: &Path, number: u8) -> PathBuf {
    let extension = path.extension().map_or_else(String::new, |extension| format!(".{}", extension.to_string_lossy()));
    path.with_extension(format!("{number}{extension}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_channel_has_a_trace_of_its_own() {
        assert_eq!(numbered(Path::new("a/t.csv"), 2), Path::new("a/t.2.csv"));
        assert_eq!(numbered(Path::new("trace"), 3), Path::new("trace.3"));
    }
}
