//! What motions did, said once each has ended.

use super::line_writer::LineWriter;
use crate::command::report;
use crate::controller::Controller;

/// How many motions of each robot were said already. Where none are recorded, there is nothing to say.
#[derive(Default)]
pub(super) struct EndedMotions(Vec<usize>);

impl EndedMotions {
    /// Says those that have ended since.
    pub(super) fn say(&mut self, controller: &Controller, voice: &LineWriter) {
        let mut channel = 0;
        controller.each_record(|robot, records, moves| {
            channel += 1;
            self.0.resize(self.0.len().max(channel), 0);
            let Some(said) = self.0.get_mut(channel - 1) else { return };
            let begun = records.iter().rposition(|record| record.start.is_some()).map_or(0, |last| last + 1);
            // The last one that began goes on. What was said while the robot stood within it is said again at its end.
            let ended = begun.saturating_sub(usize::from(moves));
            let new = records.get(*said..ended).unwrap_or_default();
            let executed = new.iter().filter(|record| record.start.is_some());
            executed.for_each(|record| voice.report(report::motion_json(channel, record, robot).trim_end()));
            *said = ended;
        });
    }
}
