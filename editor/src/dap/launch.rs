//! The editor's launch configuration.

use arl_project::arl_toml;
use arl_project::options::{Clock, Mode, RunOptions};
use arl_robot::regular_file;
use arl_robot::result_file::ResultFile;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::path::{Path, PathBuf};

/// The arguments of `launch`. Relative paths start from `cwd`, or the program's folder.
#[derive(Clone, PartialEq, Default, Deserialize, Serialize, Debug)]
#[serde(rename_all = "camelCase", default)]
pub(super) struct Launch {
    pub(super) program: PathBuf,
    pub(super) cwd: Option<PathBuf>,
    pub(super) robot: Option<String>,
    pub(super) cell: Option<PathBuf>,
    pub(super) io: Option<PathBuf>,
    pub(super) script_dir: Option<PathBuf>,
    pub(super) state_dir: Option<PathBuf>,
    pub(super) trace: Option<PathBuf>,
    /// `virtual` or `real`.
    pub(super) clock: Option<String>,
    /// `auto`, `manual` or `manufast`.
    pub(super) mode: Option<String>,
    #[serde(rename = "override")]
    pub(super) override_percent: Option<f64>,
    pub(super) max_time: Option<f64>,
    pub(super) seed: Option<u64>,
    #[serde(rename = "loop")]
    pub(super) repeats: bool,
    pub(super) stop_on_entry: bool,
    pub(super) no_debug: bool,
}

/// The keys that editors add to a launch configuration for their own use, apart from those with an underscore.
const OF_EDITORS: [&str; 15] = [
    "type",
    "request",
    "name",
    "env",
    "restart",
    "preLaunchTask",
    "postDebugTask",
    "internalConsoleOptions",
    "debugServer",
    "presentation",
    "serverReadyAction",
    "suppressMultipleSessionWarning",
    "windows",
    "linux",
    "osx",
];

/// The keys of a launch configuration that mean nothing here, nor to an editor.
pub(super) fn unknown(arguments: &Value) -> Vec<String> {
    let known = serde_json::to_value(Launch::default()).unwrap_or_default();
    let means_nothing = |key: &&String| {
        !key.starts_with('_') && known.get(key.as_str()).is_none() && !OF_EDITORS.contains(&key.as_str())
    };
    arguments.as_object().iter().flat_map(|object| object.keys()).filter(means_nothing).cloned().collect()
}

impl Launch {
    /// The options of the run.
    ///
    /// # Errors
    /// A word is not known, a number is out of its range, there is no such scenario, or the trace cannot be written.
    pub(super) fn options(&self) -> Result<RunOptions, String> {
        let clock = match self.clock.as_deref() {
            None => None,
            Some("virtual") => Some(Clock::Virtual),
            Some("real") => Some(Clock::Real),
            Some(other) => return Err(format!("clock `{other}`: expected virtual or real")),
        };
        let mode = match self.mode.as_deref() {
            None => None,
            Some("auto") => Some(Mode::Auto),
            Some("manual") => Some(Mode::Manual),
            Some("manufast") => Some(Mode::Manufast),
            Some(other) => return Err(format!("mode `{other}`: expected auto, manual or manufast")),
        };
        if let Some(percent) = self.override_percent.filter(|percent| !(0.0..=100.0).contains(percent)) {
            return Err(format!("override {percent}: expected a number of percent, 0 to 100"));
        }
        if let Some(time) = self.max_time.filter(|time| *time < 0.0) {
            return Err(format!("maxTime {time}: expected a time in s, 0 or more"));
        }
        let robot = self.robot.as_ref().map(|robot| match robot.ends_with(".toml") {
            true => self.found(Path::new(robot)).display().to_string(),
            false => robot.clone(),
        });
        let io = self.io.as_ref().map(|io| if arl_toml::is_no_scenario(io) { io.clone() } else { self.found(io) });
        if let Some(io) = io.as_ref().filter(|io| !arl_toml::is_no_scenario(io)) {
            regular_file::expect(io).map_err(|error| format!("io: {}: {error}", io.display()))?;
        }
        let found = |path: &Option<PathBuf>| path.as_ref().map(|path| self.found(path));
        if let Some(trace) = found(&self.trace) {
            ResultFile::new(&trace).map_err(|error| format!("trace: {}: {error}", trace.display()))?;
        }
        Ok(RunOptions {
            robot,
            cell: found(&self.cell),
            clock,
            script_dir: found(&self.script_dir),
            state_dir: found(&self.state_dir),
            io,
            trace: found(&self.trace),
            repeats: self.repeats,
            max_time: self.max_time,
            mode,
            override_percent: self.override_percent,
            seed: self.seed,
            ..RunOptions::default()
        })
    }

    /// The main file.
    pub(super) fn main(&self) -> PathBuf {
        match &self.cwd {
            Some(cwd) => cwd.join(&self.program),
            None => self.program.clone(),
        }
    }

    fn found(&self, path: &Path) -> PathBuf {
        let folder = self.cwd.clone().or_else(|| self.program.parent().map(Path::to_path_buf));
        folder.map_or_else(|| path.to_path_buf(), |folder| folder.join(path))
    }
}
