//! Reports of motions, sent once each has ended.

use super::line_writer::LineWriter;
use crate::command::report;
use crate::controller::Controller;

/// The state of the reports for each robot. Where no motions are recorded, nothing is reported.
#[derive(Default)]
pub(super) struct EndedMotions(Vec<OfRobot>);

#[derive(Default)]
struct OfRobot {
    /// How many records have been seen.
    seen: usize,
    /// Those not reported yet: some of them may never be executed.
    unsaid: Vec<usize>,
    /// Those reported last, and how long each had taken then: they may have gone on since.
    last: Vec<(usize, f64)>,
}

/// How many of those reported last are checked again.
const LOOKED_AT: usize = 8;
/// How many motions that were never executed are remembered.
const MOST_UNSAID: usize = 4096;

impl EndedMotions {
    /// Reports the motions that have ended since the last call.
    pub(super) fn say(&mut self, controller: &Controller, writer: &LineWriter) {
        let mut channel = 0;
        controller.each_unit(|unit| {
            let (records, moves) = (unit.records(), unit.executing().1 != 0);
            channel += 1;
            self.0.resize_with(self.0.len().max(channel), OfRobot::default);
            let Some(of_robot) = self.0.get_mut(channel - 1) else { return };
            let begin = |at: usize| records.get(at).map_or((None, 0.0), |record| (record.start, record.duration));
            for at in of_robot.ended(records.len(), begin, moves) {
                if let Some((record, file)) = records.get(at).and_then(|it| Some((it, unit.recorded_file(it.number)?)))
                {
                    writer.report(report::motion_json(channel, file, record, unit.robot()).trim_end());
                }
            }
        });
    }
}

impl OfRobot {
    /// The motions that have ended and were not reported, or have gone on since they were. There are `count`; `of`
    /// returns when a motion began, if it has, and how long it has taken so far.
    fn ended(&mut self, count: usize, of: impl Fn(usize) -> (Option<f64>, f64), moves: bool) -> Vec<usize> {
        if count < self.seen {
            *self = Self::default();
        }
        self.unsaid.extend(self.seen..count);
        self.seen = count;
        let began = |at: usize| of(at).0.unwrap_or(f64::NEG_INFINITY);
        let latest = |all: &mut dyn Iterator<Item = usize>| {
            let begun = all.filter(|at| of(*at).0.is_some());
            begun.max_by(|one, other| began(*one).total_cmp(&began(*other)))
        };
        // The motion that began last goes on while the robot moves.
        let last = self.last.iter().map(|(at, _)| *at);
        let running = latest(&mut self.unsaid.iter().copied().chain(last)).filter(|_| moves);
        let mut ended = Vec::new();
        if !moves {
            ended.extend(self.last.iter().filter(|(at, duration)| of(*at).1 != *duration).map(|(at, _)| *at));
            self.last.retain(|(at, _)| !ended.contains(at));
        }
        self.unsaid.retain(|at| {
            let has_ended = of(*at).0.is_some() && running != Some(*at);
            if has_ended {
                ended.push(*at);
            }
            !has_ended
        });
        if self.unsaid.len() > MOST_UNSAID {
            self.unsaid.drain(..MOST_UNSAID / 2);
        }
        self.last.extend(ended.iter().map(|at| (*at, of(*at).1)));
        let old = self.last.len().saturating_sub(LOOKED_AT);
        self.last.drain(..old);
        ended
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The reported motions, by when each began and how long it has taken.
    fn ended(reported: &mut OfRobot, motions: &[(Option<f64>, f64)], moves: bool) -> Vec<usize> {
        reported.ended(motions.len(), |at| motions[at], moves)
    }

    #[test]
    fn motions_are_reported_as_they_end_whatever_comes_between() {
        let mut reported = OfRobot::default();
        // The first one runs, the second one waits.
        let mut motions = vec![(Some(0.0), 0.2), (None, 0.0)];
        assert_eq!(ended(&mut reported, &motions, true), []);
        // The program is paused within the first one, and the robot jogged.
        assert_eq!(ended(&mut reported, &motions, false), [0]);
        motions.push((Some(1.0), 0.3));
        assert_eq!(ended(&mut reported, &motions, true), []);
        assert_eq!(ended(&mut reported, &motions, false), [2]);
        // Then the first one goes on, which was reported before its end, and then the second one, which was planned
        // before the jogging.
        motions[0].1 = 0.6;
        assert_eq!(ended(&mut reported, &motions, true), []);
        motions[1] = (Some(2.0), 0.4);
        assert_eq!(ended(&mut reported, &motions, true), []);
        assert_eq!(ended(&mut reported, &motions, false), [0, 1]);
        assert_eq!(ended(&mut reported, &motions, false), []);
        // When records begin again, motions are reported again.
        assert_eq!(ended(&mut reported, &[(Some(0.0), 0.1)], false), [0]);
    }
}
