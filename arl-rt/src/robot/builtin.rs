use super::RobotError;
use crate::settings::nearest;

pub(super) use arl_lang::robots::ROBOTS;

pub(super) fn unknown(name: &str) -> RobotError {
    let names: Vec<&str> = ROBOTS.iter().map(|(name, _)| *name).collect();
    let hint = nearest(name, &names).map_or(String::new(), |near| format!("did you mean `{near}`? "));
    let all = names.join(", ");
    RobotError::of_file(
        name,
        format!("no robot of this name is built in, and no such file exists; {hint}built in: {all}"),
    )
}
