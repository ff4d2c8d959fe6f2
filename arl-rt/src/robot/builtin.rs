use super::RobotError;
use super::near::nearest;

pub(super) use arl_lang::robots::ROBOTS;

pub(super) fn unknown(name: &str) -> RobotError {
    let names = || ROBOTS.iter().map(|(name, _)| *name);
    let hint = nearest(name, names()).map_or(String::new(), |near| format!("did you mean `{near}`? "));
    let all = names().collect::<Vec<_>>().join(", ");
    RobotError::of_file(
        name,
        format!("no robot of this name is built in, and no such file exists; {hint}built in: {all}"),
    )
}
