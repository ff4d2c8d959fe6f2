//! The times of a motion at the places of a path, as far as they are known before the motion is found.

use crate::time_optimal::solver::guess::smooth;
use crate::time_optimal::solver::law::Law;
use crate::time_optimal::solver::warp::Warp;

/// The times of a motion at places, in s, and the speed of the warped parameter at the first and the last of them.
#[derive(Clone, PartialEq, Debug)]
pub(crate) struct Pace {
    pub(crate) times: Vec<f64>,
    pub(crate) ends: [f64; 2],
}

/// Number of places behind a law within which speeds change to the guessed ones.
const FADING_PLACES: f64 = 20.0;

impl Pace {
    /// The pace of a motion with these speeds of the warped parameter at the warped places.
    pub(crate) fn at_speeds(places: &[f64], speeds: &[f64]) -> Option<Self> {
        let mut times = vec![0.0];
        add_times(&mut times, places, speeds);
        Some(Self { times, ends: [*speeds.first()?, *speeds.last()?] })
    }

    /// The pace of a motion that continues along a law from the first of the places, `at` in the path parameter: that
    /// of the law until it slows down for its end, then as guessed.
    pub(crate) fn behind(law: &Law, at: &[f64], places: &[f64], warp: &Warp, guess: &[f64]) -> Option<Self> {
        let times: Vec<f64> = at.iter().map(|at| law.time_at(*at)).collect();
        let on = |index: usize| Some(law.at(*times.get(index)?).vel / warp.place(*places.get(index)?).first);
        let end = times.iter().position(|time| *time >= law.duration()).unwrap_or(times.len());
        let mut exit = end.min(times.len().checked_sub(1)?);
        while exit > 1 && on(exit - 1)? >= on(exit)? {
            exit -= 1;
        }
        let off = on(exit)? / guess.get(exit)?;
        let faded =
            |(index, guess): (u32, &f64)| guess * libm::pow(off, (1.0 - f64::from(index) / FADING_PLACES).max(0.0));
        let speeds = smooth((0..).zip(guess.get(exit..)?).map(faded).collect());
        let begun = times.first()?;
        let mut paced: Vec<f64> = times.get(..=exit)?.iter().map(|time| time - begun).collect();
        add_times(&mut paced, places.get(exit..)?, &speeds);
        Some(Self { times: paced, ends: [on(0)?, *speeds.last()?] })
    }
}

/// Continues from the last of the times along places at speeds.
fn add_times(times: &mut Vec<f64>, places: &[f64], speeds: &[f64]) {
    let mut time = times.last().copied().unwrap_or_default();
    for (place, speed) in places.windows(2).zip(speeds.windows(2)) {
        time += (place[1] - place[0]) / f64::midpoint(speed[0], speed[1]);
        times.push(time);
    }
}
