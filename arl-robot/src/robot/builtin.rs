//! The built-in robots.

use super::RobotError;
use crate::settings::nearest;

/// Name and text of every built-in robot; the first is the default.
pub(super) const ROBOTS: [(&str, &str); 7] = [
    ("kr10-r1420", include_str!("files/kr10-r1420.toml")),
    ("kr6-r700", include_str!("files/kr6-r700.toml")),
    ("irb2400-10", include_str!("files/irb2400-10.toml")),
    ("tx2-60", include_str!("files/tx2-60.toml")),
    ("six-10", include_str!("files/six-10.toml")),
    ("hsr065", include_str!("files/hsr065.toml")),
    ("cobra600", include_str!("files/cobra600.toml")),
];

pub(super) fn unknown(name: &str) -> RobotError {
    let names: Vec<&str> = ROBOTS.iter().map(|(name, _)| *name).collect();
    let hint = nearest(name, &names).map_or(String::new(), |near| format!("did you mean `{near}`? "));
    let all = names.join(", ");
    RobotError::of_file(
        name,
        format!("no robot of this name is built in, and no such file exists; {hint}built in: {all}"),
    )
}
