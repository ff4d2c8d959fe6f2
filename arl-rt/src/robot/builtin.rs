use super::RobotError;
use super::near::nearest;

/// Name and file of every robot that is built in; the first is the default.
pub(super) const ROBOTS: [(&str, &str); 7] = [
    ("kr10-r1420", include_str!("builtin/kr10-r1420.toml")),
    ("kr6-r700", include_str!("builtin/kr6-r700.toml")),
    ("irb2400-10", include_str!("builtin/irb2400-10.toml")),
    ("tx2-60", include_str!("builtin/tx2-60.toml")),
    ("six-10", include_str!("builtin/six-10.toml")),
    ("hsr065", include_str!("builtin/hsr065.toml")),
    ("cobra600", include_str!("builtin/cobra600.toml")),
];

pub(super) fn unknown(name: &str) -> RobotError {
    let names = || ROBOTS.iter().map(|(name, _)| *name);
    let hint = nearest(name, names()).map_or(String::new(), |near| format!("did you mean `{near}`? "));
    let all = names().collect::<Vec<_>>().join(", ");
    RobotError::of_file(
        name,
        format!("no robot of this name is built in, and no such file exists; {hint}built in: {all}"),
    )
}
