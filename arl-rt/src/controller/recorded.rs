//! What the motions of the robots did, where records of them are kept.

use std::cmp::Ordering;
use std::sync::Arc;

use super::Controller;
use crate::cycle::channel_id::ChannelId;
use crate::fault::File;
use crate::motion::MotionRecord;
use crate::unit::Unit;
use arl_robot::robot::Robot;

/// What the motions of a foreground channel did.
#[derive(Clone, Debug)]
pub(crate) struct RecordedMotions {
    pub(crate) robot: Arc<Robot>,
    /// The file that has the `main` of the channel's program.
    pub(crate) program: File,
    /// When its program ended, in s of controller time, or the present time where it has not; later where the robot was
    /// jogged after that.
    pub(crate) ended: f64,
    /// The motions, each with the file that its line belongs to.
    pub(crate) motions: Vec<(File, MotionRecord)>,
}

impl Controller {
    /// What the motions of the first channel planned so far did, in order; empty unless the controller was built with
    /// [`Builder::record_motions`](super::Builder::record_motions).
    pub fn motions(&self) -> Vec<MotionRecord> {
        self.unit.borrow().records().to_vec()
    }

    /// The robots of the foreground channels by their numbers, each with what its motions did, like
    /// [`motions`](Controller::motions).
    pub fn all_motions(&self) -> Vec<(Arc<Robot>, Vec<MotionRecord>)> {
        let of_unit = |unit: &Unit| (unit.shared_robot(), unit.records().to_vec());
        self.channels.units().map(|unit| of_unit(&unit.borrow())).collect()
    }

    /// The file that the line of a motion belongs to: [`MotionRecord::line`] is a line of this file. `None`: the
    /// channel has no robot, or no motion with this running number is recorded for it.
    pub fn file_of_motion(&self, channel: ChannelId, motion: u64) -> Option<File> {
        let channel = self.channels.iter().find(|it| it.channel_state().id == channel)?;
        channel.channel_state().robot()?.recorded_file(motion)
    }

    /// The records of all foreground channels for reports, with the files.
    pub(crate) fn recorded_motions(&self) -> Vec<RecordedMotions> {
        let of_channel = |channel: &super::channel::Channel| {
            let unit = channel.channel_state().robot()?;
            let program = channel.cx().program();
            let motion = |record: &MotionRecord| (unit.recorded_file(record.number).unwrap_or(program), record.clone());
            let mut motions: Vec<_> = unit.records().iter().map(motion).collect();
            // A motion back to the path, or a jog, is planned after earlier motions, but may start before them.
            motions.sort_by(|(_, one), (_, other)| one.start.partial_cmp(&other.start).unwrap_or(Ordering::Equal));
            let program_ended =
                channel.ended_after().map_or_else(|| self.time(), |cycles| self.shared.rate.time(cycles));
            // Jogging after the end of the program moves the robot, too.
            let ends = motions.iter().filter_map(|(_, record)| Some(record.start? + record.duration));
            let ended = ends.fold(program_ended, f64::max);
            Some(RecordedMotions { robot: unit.shared_robot(), program, ended, motions })
        };
        self.channels.foreground().filter_map(of_channel).collect()
    }

    /// Calls `each` with the robots of the foreground channels, by their numbers.
    pub(crate) fn each_unit(&self, mut each: impl FnMut(&Unit)) {
        self.channels.units().for_each(|unit| each(&unit.borrow()));
    }
}
