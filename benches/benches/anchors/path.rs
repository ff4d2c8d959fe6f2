//! A path and limits, timed by our solver and by the crate copp: TOPP2 without jerk limits, TOPP3-SOCP with them.

use std::error::Error;
use std::hint::black_box;

use arl_benches::statistics::{Times, processor_time};
use arl_rt::motion::time_optimal::solver::{BoundaryState, ConstrainedPath, Row, fastest};
use copp::robot::Robot;
use copp::solver::topp2_ra::{ReachSet2OptionsBuilder, Topp2ProblemBuilder, s_to_t_topp2, topp2_ra};
use copp::solver::topp3_socp::{ClarabelOptionsBuilder, Topp3ProblemBuilder, s_to_t_topp3, topp3_socp};
use nalgebra::DMatrix;

/// Convex problems of TOPP3 are made one from the result of the other until the duration changes by less than this
/// part.
const SETTLED: f64 = 1e-3;
const MOST_ROUNDS: usize = 8;
/// Our solver's time is the least of so many runs.
const RUNS: usize = 10;

/// A path as places along its parameter, from rest to rest.
#[derive(Clone, Default)]
pub(crate) struct Path {
    pub(crate) places: Vec<f64>,
    /// At each place, each quantity and its first three derivatives by the parameter, in rad or m.
    pub(crate) jets: Vec<Vec<[f64; 4]>>,
    /// The limits of each quantity: speed, acceleration, jerk.
    pub(crate) limits: Vec<[f64; 3]>,
}

/// A motion's duration and what computing it took, both in s.
#[derive(Clone, Copy)]
pub(crate) struct Timed {
    pub(crate) duration: f64,
    pub(crate) time: f64,
}

impl Path {
    /// What our solver finds, with or without jerk limits.
    pub(crate) fn ours(&self, jerk: bool) -> Result<Timed, Box<dyn Error>> {
        let mut path = ConstrainedPath::new();
        for (at, jet) in self.places.iter().zip(&self.jets) {
            path.push(
                *at,
                jet.iter().zip(&self.limits).map(|([_, first, second, third], [vel, acc, most])| Row {
                    first: *first,
                    second: *second,
                    third: *third,
                    vel: *vel,
                    acc: *acc,
                    jerk: if jerk { *most } else { f64::INFINITY },
                }),
            );
        }
        let mut times = Times::default();
        let mut duration = 0.0;
        for _ in 0..RUNS {
            let start = processor_time();
            let law = black_box(fastest(black_box(&path), BoundaryState::REST, BoundaryState::REST)?);
            times.push(processor_time() - start);
            duration = law.duration();
        }
        Ok(Timed { duration, time: times.least() })
    }

    fn robot(&self) -> Result<Robot<usize>, Box<dyn Error>> {
        let (quantities, count) = (self.limits.len(), self.places.len());
        let matrix = |order: usize| DMatrix::from_fn(quantities, count, |row, index| self.jets[index][row][order]);
        let [q, first, second, third] = [0, 1, 2, 3].map(matrix);
        let both = |order: usize| -> (Vec<f64>, Vec<f64>) {
            self.limits.iter().map(|limits| (limits[order], -limits[order])).unzip()
        };
        let [vel, acc, jerk] = [0, 1, 2].map(both);
        let mut robot = Robot::with_capacity(quantities, count);
        robot
            .with_s(self.places.as_slice())?
            .with_q(&q.as_view(), &first.as_view(), &second.as_view(), Some(&third.as_view()), 0)?
            .with_axial_velocity((vel.0.as_slice(), count), (vel.1.as_slice(), count), 0)?
            .with_axial_acceleration((acc.0.as_slice(), count), (acc.1.as_slice(), count), 0)?
            .with_axial_jerk((jerk.0.as_slice(), count), (jerk.1.as_slice(), count), 0)?;
        Ok(robot)
    }

    /// What copp finds without jerk limits.
    pub(crate) fn topp2(&self) -> Result<Timed, Box<dyn Error>> {
        let robot = self.robot()?;
        let start = processor_time();
        let problem = Topp2ProblemBuilder::new(&robot, (0, self.places.len() - 1), (0.0, 0.0)).build()?;
        let profile = topp2_ra(&problem, &ReachSet2OptionsBuilder::new().build()?)?;
        let time = (processor_time() - start).as_secs_f64();
        Ok(Timed { duration: s_to_t_topp2(&self.places, &profile, 0.0)?.0, time })
    }

    /// What copp finds with jerk limits: after its first convex problem, and when further ones change little.
    pub(crate) fn topp3(&self) -> Result<[Timed; 2], Box<dyn Error>> {
        let mut robot = self.robot()?;
        let start = processor_time();
        let mut profile = {
            let problem = Topp2ProblemBuilder::new(&robot, (0, self.places.len() - 1), (0.0, 0.0)).build()?;
            topp2_ra(&problem, &ReachSet2OptionsBuilder::new().build()?)?
        };
        robot.constraints.amax_substitute(&profile, 0)?;
        let options = ClarabelOptionsBuilder::new().allow_almost_solved(true).build()?;
        let mut rounds: Vec<Timed> = Vec::new();
        while rounds.len() < MOST_ROUNDS {
            let next = {
                let builder = Topp3ProblemBuilder::new(&mut robot, 0, &profile, (0.0, 0.0), (0.0, 0.0));
                topp3_socp(&builder.build_with_linearization()?, &options)
            };
            // Later problems may be too flat for it: what was found before is safe, too.
            let next = match next {
                Err(_) if !rounds.is_empty() => break,
                next => next?,
            };
            let duration = s_to_t_topp3(&self.places, next.as_parts(), 0.0)?.0;
            let time = (processor_time() - start).as_secs_f64();
            let settled = rounds.last().is_some_and(|last| duration > last.duration * (1.0 - SETTLED));
            rounds.push(Timed { duration, time });
            if settled {
                break;
            }
            profile = next.a;
        }
        match rounds.as_slice() {
            [first, .., last] => Ok([*first, *last]),
            [only] => Ok([*only; 2]),
            [] => Err("TOPP3 has no rounds".into()),
        }
    }
}
