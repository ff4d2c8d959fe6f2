//! Two lines of 300 mm with a corner between them: how long the robot takes, beside the shortest time on the very path
//! that it follows, and beside two motions from rest to rest that are blended as MoveIt's Pilz planner does it.

use std::error::Error;
use std::sync::Arc;

use arl_rt::motion::{Command, Settings, Zone};
use arl_rt::robot::{Robot, VelocityProfile};

use crate::Rows;
use crate::executed::{Track, duration, lines};
use crate::pilz;
use crate::table::Row;

/// mm, and mm/s.
pub(crate) const SIDE: f64 = 300.0;
pub(crate) const SPEED: f64 = 1000.0;
const ANGLES: [f64; 5] = [30.0, 60.0, 90.0, 120.0, 150.0];
const ZONES: [f64; 5] = [5.0, 10.0, 20.0, 50.0, 100.0];
const PROFILES: [VelocityProfile; 3] = [VelocityProfile::T, VelocityProfile::S, VelocityProfile::O];
/// A path is sampled every so many mm.
const SAMPLING: f64 = 0.05;
/// Places along the path, and across the blend.
const PLACES: usize = 600;
const BLEND: usize = 160;

/// How much longer than the optimum, at its worst and at the corner of 90 deg with a zone of 20 mm.
#[derive(Clone, Copy, Default)]
struct Excess {
    worst: f64,
    usual: f64,
}

pub(crate) fn rows() -> Rows {
    let robot = Arc::new(Robot::builtin("kr10-r1420")?);
    println!();
    println!(
        "corners: two lines of {SIDE} mm at {SPEED} mm/s, from rest to rest; s, and by the optimum on the same path"
    );
    println!("(T by copp's TOPP2; S and O by the better of copp's TOPP3-SOCP and our solver, whose duration by copp's");
    println!("stands behind); stop: with a stop at the corner; Pilz: slowed until it honours speeds and accelerations");
    println!(
        "angle zone      TOPP2      T            stop  TOPP3      S            O            stop S/O  solver    Pilz"
    );
    let mut excess = [Excess::default(); 3];
    let mut pilz_excess = [f64::INFINITY, 0.0];
    for angle in ANGLES {
        let [stop_t, stop_s, stop_o] = each_profile(|profile| corner(&robot, angle, Zone::NONE, profile))?;
        for zone in ZONES {
            let at = Zone { tcp: zone, ..Zone::NONE };
            let taken = each_profile(|profile| corner(&robot, angle, at, profile))?;
            let sampled = Settings { profile: VelocityProfile::S, ..Settings::default() };
            let track = Track::followed(&robot, commands(&robot, angle, at), &sampled, (SAMPLING, SPEED))?;
            let path = track.path(&robot, &corner_places(track.length(), zone), SPEED);
            let second = path.topp2()?.duration;
            let [_, third] = path.topp3()?;
            let solver = path.ours(true)?;
            let best = third.duration.min(solver.duration);
            let pilz = pilz::excess(&robot, angle, zone)?;
            let by = [taken[0] / second, taken[1] / best, taken[2] / best];
            for (excess, by) in excess.iter_mut().zip(by) {
                excess.worst = excess.worst.max(by);
                excess.usual = if angle == 90.0 && zone == 20.0 { by } else { excess.usual };
            }
            pilz_excess = [pilz_excess[0].min(pilz), pilz_excess[1].max(pilz)];
            println!(
                "{angle:>5} {zone:>4} {second:>10.3} {:>6.3} {:>5.3} {stop_t:>10.3} {best:>6.3} {:>6.3} {:>5.3} {:>6.3} {:>5.3} \
                 {stop_s:>7.3} {stop_o:>5.3} {:>7.4} {pilz:>7.3}",
                taken[0],
                by[0],
                taken[1],
                by[1],
                taken[2],
                by[2],
                solver.duration / third.duration,
            );
        }
    }
    println!("Pilz takes {:.2} to {:.2} times as long as TOPP2 on its path", pilz_excess[0], pilz_excess[1]);
    let names = [("T", "copp TOPP2"), ("S", "TOPP3, same path"), ("O", "TOPP3, same path")];
    let rows = names.into_iter().zip(excess).flat_map(|((name, reference), excess)| {
        [
            Row::beside(
                format!("corner of 90 deg, zone 20 mm, profile {name}, by the optimum"),
                reference,
                (1.0, excess.usual),
                "",
                1.05,
            ),
            Row::beside(
                format!("the worst of {} corners", ANGLES.len() * ZONES.len()),
                reference,
                (1.0, excess.worst),
                "",
                1.05,
            ),
        ]
    });
    Ok(rows.collect())
}

fn each_profile(take: impl Fn(VelocityProfile) -> Result<f64, Box<dyn Error>>) -> Result<[f64; 3], Box<dyn Error>> {
    let [t, s, o] = PROFILES;
    Ok([take(t)?, take(s)?, take(o)?])
}

fn commands(robot: &Robot, angle: f64, zone: Zone) -> impl Iterator<Item = Command> + use<> {
    lines(robot, points(angle), zone, SPEED)
}

/// The corner and the end, in mm from the start.
pub(crate) fn points(angle: f64) -> [[f64; 3]; 2] {
    let (sine, cosine) = angle.to_radians().sin_cos();
    [[0.0, SIDE, 0.0], [0.0, SIDE + SIDE * cosine, -SIDE * sine]]
}

fn corner(robot: &Arc<Robot>, angle: f64, zone: Zone, profile: VelocityProfile) -> Result<f64, Box<dyn Error>> {
    duration(robot, commands(robot, angle, zone), &Settings { profile, ..Settings::default() })
}

/// Places along a path whose corner is in its middle, close together in the blend.
pub(crate) fn corner_places(length: f64, zone: f64) -> Vec<f64> {
    let mut all: Vec<f64> = (0..PLACES).map(|index| length * index as f64 / (PLACES - 1) as f64).collect();
    let inside = |index: usize| 0.5 * length + zone * 1.1 * (2.0 * index as f64 / (BLEND - 1) as f64 - 1.0);
    let blend: Vec<f64> = (0..BLEND).map(inside).collect();
    let (first, last) = (inside(0), inside(BLEND - 1));
    all.retain(|at| *at < first - 0.1 || *at > last + 0.1);
    all.extend(blend);
    all.sort_by(f64::total_cmp);
    all
}
