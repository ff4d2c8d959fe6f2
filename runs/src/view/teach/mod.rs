//! Teaching: the points of a program's data files, how the robot would reach them, and writing them.
//!
//! Only data files of the program that is shown are written, by the code of `savefilepose`.

pub(super) mod place;
pub(super) mod points;
#[cfg(test)]
mod tests;

use std::path::PathBuf;
use std::sync::{Mutex, PoisonError};

use arl_robot::{Family, Robot};
use serde::de::DeserializeOwned;

use super::serve::Answer;
use place::{AskedPose, Map};
use points::{Change, Files};

/// Teaches the points of a program.
pub(super) struct Teacher {
    /// By channels, from 1.
    robots: Vec<Robot>,
    files: Mutex<Files>,
}

impl Teacher {
    /// For the data files of a program and the robots of its channels.
    pub(super) fn new(robots: Vec<Robot>, sources: &[PathBuf]) -> Self {
        let family = robots.first().map_or(Family::SixAxis, |robot| robot.family);
        Self { robots, files: Mutex::new(Files::of(sources, family)) }
    }

    fn robot(&self, channel: usize) -> Result<&Robot, String> {
        let robot = channel.checked_sub(1).and_then(|at| self.robots.get(at));
        robot.ok_or_else(|| format!("channel {channel} has no robot"))
    }

    /// Answers a request of the page; `order` is what the page sends.
    pub(super) fn answer(&self, path: &[&str], order: Option<&str>) -> Answer {
        let mut files = self.files.lock().unwrap_or_else(PoisonError::into_inner);
        let answer = match (path, order) {
            (["points"], None) => Ok(Answer::json(&points::read_all(&files))),
            (["place"], Some(order)) => read::<AskedPose>(order)
                .and_then(|asked| place::place(self.robot(asked.channel)?, &asked))
                .map(|place| Answer::json(&place)),
            (["map"], Some(order)) => read::<Map>(order)
                .and_then(|map| place::map(self.robot(map.channel)?, &map))
                .map(|map| Answer::json(&map)),
            (["save"], Some(order)) => read::<Vec<Change>>(order)
                .and_then(|changes| files.save(&changes))
                .map(|()| Answer::json(&points::read_all(&files))),
            (["undo"], Some(_)) => files.undo().map(|()| Answer::json(&points::read_all(&files))),
            _ => return Answer::NotFound,
        };
        answer.unwrap_or_else(Answer::Refused)
    }
}

fn read<T: DeserializeOwned>(order: &str) -> Result<T, String> {
    serde_json::from_str(order).map_err(|error| format!("the request cannot be read: {error}"))
}
