//! The client's settings: the robot and the cell that programs are for.

use arl_project::arl_toml::ArlToml;
use arl_project::options::Checking;
use arl_project::program::check_options;
use arl_project::robots;
use arl2rs::CheckOptions;
use serde::Deserialize;
use std::path::{Path, PathBuf};

/// Settings of the client, also as `arl2rs` in the settings of its workspace. Names are those of the command's options.
#[derive(Deserialize, Clone, Default, PartialEq, Debug)]
#[serde(default, rename_all = "camelCase")]
pub(super) struct Settings {
    /// A built-in robot or a robot file.
    robot: Option<String>,
    /// A cell file.
    cell: Option<PathBuf>,
    /// The folder that `/home/ae/script/` in an import means.
    script_dir: Option<PathBuf>,
    /// Whether to warn of what the controller would not accept.
    strict: bool,
}

/// The names of the settings.
const NAMES: [&str; 4] = ["robot", "cell", "scriptDir", "strict"];

impl Settings {
    /// The settings in what a client sends: by themselves, or under `arl2rs`. `None` if there are none: clients send
    /// the settings of others, too, or nothing at all.
    pub(super) fn read(value: &serde_json::Value) -> Result<Option<Self>, String> {
        let own = match value.get("arl2rs") {
            Some(own) => own,
            None if NAMES.iter().any(|name| value.get(name).is_some()) => value,
            None => return Ok(None),
        };
        let read = serde_json::from_value(own.clone());
        read.map(Some).map_err(|error| format!("invalid settings of arl2rs: {error}"))
    }

    /// How to check with the settings. Relative paths start from the workspace's folder. `beside` gives what the
    /// settings do not.
    pub(super) fn options(&self, folder: Option<&Path>, beside: Option<&ArlToml>) -> Result<CheckOptions, String> {
        let below = |path: &PathBuf| folder.map_or_else(|| path.clone(), |folder| folder.join(path));
        let given = |text: &&String| !text.trim().is_empty();
        let robot = self.robot.as_ref().filter(given).map(|robot| {
            let file = below(&PathBuf::from(robot));
            if file.is_file() { file.display().to_string() } else { robot.clone() }
        });
        let path = |path: &Option<PathBuf>| path.as_ref().filter(|path| !path.as_os_str().is_empty()).map(below);
        let checking = Checking {
            strict: self.strict,
            robot,
            background: false,
            cell: path(&self.cell),
            script_dir: path(&self.script_dir),
            verbose: false,
        };
        let checking = match beside {
            Some(file) => checking.with(file).map_err(|failure| failure.to_string())?,
            None => checking,
        };
        let mut options = check_options(&checking).map_err(|failure| failure.to_string())?;
        if let Some(name) = &checking.robot {
            options.robot = Some(robots::load(Some(name)).map_err(|failure| failure.to_string())?);
        }
        Ok(options)
    }
}
