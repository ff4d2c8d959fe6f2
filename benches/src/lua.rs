//! Runs the kernels in Lua.

use std::path::Path;
use std::process::Command;

/// What a run gave.
#[derive(Clone, Copy, Debug)]
pub struct LuaRun {
    /// The checksum of the kernel.
    pub checksum: f64,
    /// The shortest time of all rounds in s.
    pub least: f64,
    /// The time in the middle in s.
    pub median: f64,
}

/// Whether there is a Lua 5.4.
pub fn is_there() -> bool {
    Command::new("lua5.4").arg("-v").output().is_ok_and(|out| out.status.success())
}

/// Runs a kernel so many times; the start of Lua is not part of the times.
///
/// # Errors
/// What Lua said.
pub fn run(name: &str, size: i32, rounds: usize) -> Result<LuaRun, String> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"));
    let out = Command::new("lua5.4")
        .arg(folder.join("src/rounds.lua"))
        .arg(folder.join(format!("kernels/{name}.lua")))
        .args([size.to_string(), rounds.to_string()])
        .output()
        .map_err(|error| error.to_string())?;
    let text = String::from_utf8_lossy(&out.stdout);
    let words: Vec<f64> = text.split_whitespace().filter_map(|word| word.parse().ok()).collect();
    match words.as_slice() {
        &[checksum, least, median] => Ok(LuaRun { checksum, least, median }),
        _ => Err(format!("{name}.lua: {text}{}", String::from_utf8_lossy(&out.stderr))),
    }
}
