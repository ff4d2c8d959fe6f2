//! Junctions that were found before, for programs that repeat the same motions.
//!
//! A junction is a function of its pair of motions, so a remembered one is the one that would be found.

use std::collections::VecDeque;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::sync::Arc;

use crate::junction::blend_thread::Prepared;
use crate::junction::{Junction, MotionPair};
use crate::plan::motion::Motion;
use arl_robot::robot::Robot;

/// Number of junctions that are remembered.
const MOST_JUNCTIONS: usize = 128;

/// The last junctions that were found.
#[derive(Debug, Default)]
pub(crate) struct JunctionMemory {
    known: VecDeque<Remembered>,
}

#[derive(Debug)]
struct Remembered {
    /// Equal pairs have equal fingerprints.
    fingerprint: u64,
    robot: Arc<Robot>,
    prepared: Prepared,
}

impl JunctionMemory {
    /// The junction of a pair, which is found if it is not remembered.
    pub(crate) fn recall(&self, robot: &Arc<Robot>, pair: MotionPair) -> Junction {
        let fingerprint = fingerprint(&pair);
        let mut alike = self.known.iter().filter(|known| known.fingerprint == fingerprint && known.robot == *robot);
        let known = alike.find_map(|known| known.prepared.junction().filter(|junction| junction.pair == pair));
        match known {
            Some(known) => known.of(pair),
            None => Junction::find(robot, pair),
        }
    }

    /// Remembers a junction that was found; returns one that is forgotten in exchange.
    pub(crate) fn remember(&mut self, robot: &Arc<Robot>, prepared: &Prepared) -> Option<Prepared> {
        let junction = prepared.junction()?;
        let fingerprint = fingerprint(&junction.pair);
        let is_same = |known: &Remembered| {
            known.fingerprint == fingerprint
                && known.prepared.junction().is_some_and(|known| known.pair == junction.pair)
        };
        let forgotten = match self.known.iter().position(is_same) {
            Some(same) => self.known.remove(same),
            None if self.known.len() == MOST_JUNCTIONS => self.known.pop_front(),
            None => None,
        };
        self.known.push_back(Remembered { fingerprint, robot: Arc::clone(robot), prepared: prepared.clone() });
        forgotten.map(|forgotten| forgotten.prepared)
    }
}

/// The fingerprint of where the motions of a pair start and end.
fn fingerprint(pair: &MotionPair) -> u64 {
    let MotionPair { from, to, .. } = pair;
    let mut hasher = DefaultHasher::new();
    let mut note = |motion: &Motion| {
        for joints in [&motion.start, &motion.end] {
            // Zero is the same with either sign.
            joints.axes.iter().chain(&joints.external).for_each(|axis| (axis + 0.0).to_bits().hash(&mut hasher));
        }
    };
    note(from);
    note(to);
    hasher.finish()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::blend::corner::FOUND_HERE;
    use crate::blend::mid_curvature::MidCurvature;
    use crate::command::joints::Joints;
    use crate::command::{Command, Settings, Speed, Target, Zone};
    use crate::plan::planner::plan;
    use crate::tests::{axes, command};

    /// Two motions of the axes with a zone between them, planned again, the second one at a share of the speed.
    fn pair(robot: &Robot, percent: f64) -> MotionPair {
        let [start, corner, end] = [
            [0.0, -90.0, 90.0, 0.0, 45.0, 0.0],
            [20.0, -80.0, 80.0, 10.0, 60.0, 0.0],
            [30.0, -95.0, 70.0, 30.0, 40.0, 9.0],
        ]
        .map(axes);
        let motion = |from: &Joints, to: Joints, percent: f64| {
            let zone = Zone { percent: 80.0, ..Zone::NONE };
            let plain: Command = command(Target::Joints(to));
            let speed = Speed { percent, ..plain.speed };
            Arc::new(plan(robot, from, &Command { zone, speed, ..plain }, &Settings::default()).unwrap())
        };
        MotionPair { before: None, from: motion(&start, corner, 50.0), to: motion(&corner, end, percent) }
    }

    #[test]
    fn the_same_is_found_once_and_everything_counts() {
        let robot = Arc::new(Robot::builtin("kr10-r1420").unwrap());
        let mut memory = JunctionMemory::default();
        let mut blends = |pair: MotionPair, robot: &Arc<Robot>| {
            let before = FOUND_HERE.get();
            let [from, to] = [&pair.from, &pair.to].map(Arc::clone);
            let prepared = Prepared::from(memory.recall(robot, pair));
            memory.remember(robot, &prepared);
            let junction = prepared.junction().unwrap();
            assert!(junction.is_of(&from, &to));
            let blended = junction.blended.as_ref().unwrap().as_ref().unwrap();
            assert!(Arc::ptr_eq(&blended.from, &from) && Arc::ptr_eq(&blended.to, &to));
            (FOUND_HERE.get() - before, blended.blend.clone())
        };
        let (found, first) = blends(pair(&robot, 50.0), &robot);
        assert!(found > 0);
        assert_eq!(blends(pair(&robot, 50.0), &robot), (0, first));
        assert!(blends(pair(&robot, 40.0), &robot).0 > 0);
        let bent = MotionPair { before: Some((pair(&robot, 50.0).from, MidCurvature::NONE)), ..pair(&robot, 50.0) };
        assert!(memory.known.iter().all(|known| known.prepared.junction().unwrap().pair != bent));
        let mut slower = Robot::clone(&robot).into_description();
        slower.axes[0].vel *= 0.9;
        let slower = Arc::new(Robot::new(slower).unwrap());
        assert!(memory.known.iter().all(|known| known.robot != slower));
    }

    #[test]
    fn the_oldest_go() {
        let robot = Arc::new(Robot::builtin("kr10-r1420").unwrap());
        let mut memory = JunctionMemory::default();
        for index in 0..MOST_JUNCTIONS + 2 {
            // The same pair again takes no space.
            let percent = if index == 1 { 10.0 } else { 10.0 + index as f64 / 4.0 };
            let pair = pair(&robot, percent);
            memory.remember(&robot, &Prepared::from(memory.recall(&robot, pair)));
        }
        assert_eq!(memory.known.len(), MOST_JUNCTIONS);
        let first = memory.known.front().unwrap().prepared.junction().unwrap();
        assert!(first.pair == pair(&robot, 10.0 + 2.0 / 4.0));
    }
}
