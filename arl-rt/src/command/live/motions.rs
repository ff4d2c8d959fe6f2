//! What motions did, said once each has ended.

use super::line_writer::LineWriter;
use crate::command::report;
use crate::controller::Controller;
use crate::motion::MotionRecord;

/// What was said of the motions of each robot. Where none are recorded, there is nothing to say.
#[derive(Default)]
pub(super) struct EndedMotions(Vec<Robot>);

#[derive(Default)]
struct Robot {
    /// How many records were looked at.
    seen: usize,
    /// Those that were not said: some of them may never be executed.
    unsaid: Vec<usize>,
    /// The last one that was said, and how long it had taken then: it may have gone on since.
    last: Option<(usize, f64)>,
}

/// So many motions that were never executed are kept in mind.
const MOST_UNSAID: usize = 4096;

impl EndedMotions {
    /// Says those that have ended since.
    pub(super) fn say(&mut self, controller: &Controller, voice: &LineWriter) {
        let mut channel = 0;
        controller.each_record(|robot, records, moves| {
            channel += 1;
            self.0.resize_with(self.0.len().max(channel), Robot::default);
            let Some(of_robot) = self.0.get_mut(channel - 1) else { return };
            for at in of_robot.ended(records, moves) {
                if let Some(record) = records.get(at) {
                    voice.report(report::motion_json(channel, record, robot).trim_end());
                }
            }
        });
    }
}

impl Robot {
    /// The motions that have ended and were not said, or have gone on since they were.
    fn ended(&mut self, records: &[MotionRecord], moves: bool) -> Vec<usize> {
        if records.len() < self.seen {
            *self = Self::default();
        }
        self.unsaid.extend(self.seen..records.len());
        self.seen = records.len();
        let start = |at: &usize| records.get(*at).and_then(|record| record.start);
        let last = self.last.map(|(at, _)| at);
        let began = |at: &usize| start(at).unwrap_or(f64::NEG_INFINITY);
        // The one that began last goes on while the robot moves.
        let executed = self.unsaid.iter().copied().chain(last).filter(|at| start(at).is_some());
        let running = executed.max_by(|one, other| began(one).total_cmp(&began(other))).filter(|_| moves);
        let mut ended = Vec::new();
        if let Some((at, duration)) = self.last
            && running != Some(at)
            && records.get(at).is_some_and(|record| record.duration != duration)
        {
            ended.push(at);
        }
        self.unsaid.retain(|at| {
            let has_ended = start(at).is_some() && running != Some(*at);
            if has_ended {
                ended.push(*at);
            }
            !has_ended
        });
        if self.unsaid.len() > MOST_UNSAID {
            self.unsaid.drain(..MOST_UNSAID / 2);
        }
        if let Some(at) = ended.iter().copied().max_by(|one, other| began(one).total_cmp(&began(other))) {
            self.last = records.get(at).map(|record| (at, record.duration));
        }
        ended
    }
}
