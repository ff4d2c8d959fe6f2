//! How late cycles begin.

use std::fmt;
use std::time::Duration;

/// The upper ends of the steps of the histogram, in us.
const STEPS_US: [u64; 18] =
    [1, 2, 5, 10, 20, 50, 100, 200, 500, 1_000, 2_000, 5_000, 10_000, 20_000, 50_000, 100_000, 200_000, 500_000];

/// How late the cycles of a run began, in real time.
///
/// ```
/// use arl_rt::clock::Lateness;
/// use std::time::Duration;
///
/// let mut lateness = Lateness::default();
/// for micros in [3, 40, 45, 1700] {
///     lateness.note(Duration::from_micros(micros));
/// }
/// assert_eq!((lateness.cycles(), lateness.longest()), (4, Duration::from_micros(1700)));
/// let steps: Vec<(u128, u64)> = lateness.histogram().map(|(within, count)| (within.as_micros(), count)).collect();
/// assert_eq!(steps, [(5, 1), (50, 2), (2000, 1)]);
/// ```
#[derive(Clone, PartialEq, Eq, Default, Debug)]
pub struct Lateness {
    /// The counts of the steps, and of those beyond the last one.
    counts: [u64; STEPS_US.len() + 1],
    late: u64,
    lost: u64,
    missing: u64,
    longest: Duration,
}

impl Lateness {
    /// Notes that a cycle began this long after its point.
    pub fn note(&mut self, behind: Duration) {
        let micros = behind.as_nanos().div_ceil(1000);
        let step = STEPS_US.partition_point(|most| u128::from(*most) < micros);
        if let Some(count) = self.counts.get_mut(step) {
            *count += 1;
        }
        self.longest = self.longest.max(behind);
    }

    /// Notes that the last cycle was too late, and how many cycles were lost by that.
    pub fn note_lost(&mut self, cycles: u64) {
        self.late += 1;
        self.lost = self.lost.saturating_add(cycles);
    }

    /// Notes cycles that their source (a robot that sends, a bus) never began: they are lost, and the computer
    /// is not to blame.
    pub fn note_missing(&mut self, cycles: u64) {
        self.missing = self.missing.saturating_add(cycles);
        self.lost = self.lost.saturating_add(cycles);
    }

    /// How many cycles began.
    pub fn cycles(&self) -> u64 {
        self.counts.iter().sum()
    }

    /// How many cycles began a whole cycle late, or more.
    pub fn late(&self) -> u64 {
        self.late
    }

    /// How many cycles were lost, as a cycle was late or as their beats never came.
    pub fn lost(&self) -> u64 {
        self.lost
    }

    /// How many of the lost cycles had no beat.
    pub fn missing(&self) -> u64 {
        self.missing
    }

    /// How late the latest cycle began.
    pub fn longest(&self) -> Duration {
        self.longest
    }

    /// How many cycles began within the time of each step, but not within that of the step before; steps without any
    /// are left out. Cycles more than half a second late are in the last step, whose time is that of the latest cycle.
    pub fn histogram(&self) -> impl Iterator<Item = (Duration, u64)> {
        let steps = STEPS_US.iter().map(|most| Duration::from_micros(*most)).chain([self.longest]);
        steps.zip(self.counts).filter(|(_, count)| *count > 0)
    }
}

impl fmt::Display for Lateness {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (longest, late, lost) = (self.longest.as_secs_f64() * 1e3, self.late, self.lost);
        write!(f, "cycles: {}, the latest began {longest:.3} ms late; {late} too late, {lost} lost", self.cycles())?;
        match self.missing {
            0 => writeln!(f)?,
            missing => writeln!(f, ", {missing} of them without a message from the robot")?,
        }
        for (within, count) in self.histogram() {
            writeln!(f, "{:>10} us late at most: {count}", within.as_micros())?;
        }
        Ok(())
    }
}
