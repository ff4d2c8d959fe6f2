//! Whether blending is ever slower than stopping: chains of motions with zones beside the same with exact stops.
//!
//! `cargo bench -p arl-benches --bench promise [-- CHAINS [SEED [ONE OF THEM]]]`
//!
//! The promise: with zones at most 1.003 times the time with exact stops, and two cycles, in T and S; O is S by
//! another name. Times are those of the robot, so they do not depend on the machine. Of the chains, some 3200 unless
//! told, the robot can go two thirds.

#![allow(clippy::disallowed_methods)]

mod chain;

use std::error::Error;

use arl_rt::motion::{Cycle, Override, Queue, Recorder, Settings};
use arl_rt::robot::VelocityProfile;
use chain::{Chain, robots};

const CYCLE: f64 = 0.001;
const PROFILES: [VelocityProfile; 2] = [VelocityProfile::T, VelocityProfile::S];
/// What is promised: so many times the time with exact stops, and so many s.
const PROMISED_FACTOR: f64 = 1.003;
const PROMISED_S: f64 = 2.0 * CYCLE;
/// Zones of so many mm and more are told of by themselves.
const LARGE_ZONE_MM: f64 = 5.0;
/// So many chains that are farthest from the promise are printed.
const WORST: usize = 10;
/// What takes longer, in s, is not waited for.
const LONGEST_S: f64 = 300.0;

/// What became of a chain in a profile.
struct Outcome {
    chain: usize,
    profile: VelocityProfile,
    zones: f64,
    stops: f64,
    /// The kept share of each zone.
    kept: Vec<f64>,
}

impl Outcome {
    /// By how much the promise is missed, as a share of the time with stops; below 0 it is kept.
    fn excess(&self) -> f64 {
        (self.zones - PROMISED_FACTOR * self.stops - PROMISED_S) / self.stops
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let numbers: Vec<u64> = std::env::args().skip(1).filter_map(|word| word.parse().ok()).collect();
    let count = numbers.first().map_or(3200, |count| *count as usize);
    let seed = numbers.get(1).copied().unwrap_or(1);
    let only = numbers.get(2).map(|index| *index as usize);
    let robots = robots()?;
    let chains: Vec<Chain> = (0..count).map(|index| Chain::new(&robots, index, seed)).collect();
    let mut results = Vec::new();
    let mut refused = 0;
    for (index, chain) in chains.iter().enumerate().filter(|(index, _)| only.is_none_or(|only| only == *index)) {
        for profile in PROFILES {
            let settings = Settings { profile, ..Settings::default() };
            let (Some((zones, kept)), Some((stops, _))) = (run(chain, true, &settings), run(chain, false, &settings))
            else {
                refused += 1;
                break;
            };
            results.push(Outcome { chain: index, profile, zones, stops, kept });
        }
    }
    println!("{} chains, {refused} more that the robot cannot go", results.len() / PROFILES.len());
    table(&chains, &results);
    println!();
    kept(&chains, &results);
    results.sort_by(|a, b| b.excess().total_cmp(&a.excess()));
    for result in results.iter().take(WORST).filter(|result| result.excess() > 0.0 || only.is_some()) {
        let Outcome { chain, profile, zones, stops, kept } = result;
        let kept: Vec<String> = kept.iter().map(|share| format!("{share:.2}")).collect();
        println!(
            "\nchain {chain}, profile {profile:?}: {zones:.3} s with zones, {stops:.3} s with stops, {:.3} times; kept {}",
            zones / stops,
            kept.join(" ")
        );
        print!("{}", chains[*chain].program());
    }
    Ok(())
}

/// How long the chain takes in s, [`LONGEST_S`] at most, and the kept share of each zone that was asked for. `None`
/// where the robot cannot go it, whatever the profile.
fn run(chain: &Chain, zones: bool, settings: &Settings) -> Option<(f64, Vec<f64>)> {
    let mut queue = Queue::repeatable(chain.robot.clone(), chain.start);
    let mut recorder = Recorder::new(chain.robot.clone(), &mut queue);
    for command in chain.commands(zones) {
        let number = queue.add(&command, settings).ok()?;
        recorder.planned(&mut queue, number, &command, settings);
    }
    queue.conclude().ok()?;
    let mut cycles = 0_u32;
    while !queue.idle() && f64::from(cycles) * CYCLE < LONGEST_S {
        let step = queue.step(Cycle::MS, Override::FULL);
        recorder.step(&mut queue, &step);
        cycles += 1;
    }
    let records = recorder.records();
    let asked = records.iter().take(records.len() - 1).filter_map(|record| record.zone());
    Some((f64::from(cycles) * CYCLE, asked.map(|rounding| rounding.used / rounding.asked).collect()))
}

/// How many chains keep the promise, and how much time blending saves.
fn table(chains: &[Chain], results: &[Outcome]) {
    println!("profile kind       chains  slower  by 5 %   worst    mean of the time with stops");
    for profile in PROFILES {
        for kind in [None].into_iter().chain(chain::ALL.map(Some)) {
            let of: Vec<&Outcome> = results
                .iter()
                .filter(|result| result.profile == profile && kind.is_none_or(|kind| chains[result.chain].kind == kind))
                .collect();
            if of.is_empty() {
                continue;
            }
            let slower = of.iter().filter(|result| result.excess() > 0.0).count();
            let much = of.iter().filter(|result| result.excess() > 0.05).count();
            let ratio = |result: &&Outcome| result.zones / result.stops;
            let worst = of.iter().map(ratio).fold(0.0, f64::max);
            let mean = of.iter().map(ratio).sum::<f64>() / of.len() as f64;
            let name = kind.map_or("all".to_owned(), |kind| format!("{kind:?}").to_lowercase());
            println!(
                "{:<7} {name:<10} {:>6} {slower:>7} {much:>7} {worst:>7.3} {mean:>7.3}",
                format!("{profile:?}"),
                of.len()
            );
        }
    }
}

/// How much of their zones motions keep.
fn kept(chains: &[Chain], results: &[Outcome]) {
    println!("kept of the zones asked for, which are half of a motion at most: all, half or more, less, none");
    for profile in PROFILES {
        let of = || results.iter().filter(move |result| result.profile == profile);
        for (name, large) in [("small", false), ("5 mm and more", true)] {
            let is_large = |chain: &Chain| !chain.is_percent && chain.zone >= LARGE_ZONE_MM;
            let shares: Vec<f64> = of()
                .filter(|result| is_large(&chains[result.chain]) == large)
                .flat_map(|result| result.kept.iter().copied())
                .collect();
            let count = |from: f64, to: f64| shares.iter().filter(|share| **share >= from && **share < to).count();
            println!(
                "{:<3} {name:<14} {:>6} {:>6} {:>6} {:>6}",
                format!("{profile:?}"),
                count(0.999, f64::INFINITY),
                count(0.5, 0.999),
                count(1e-9, 0.5),
                count(f64::NEG_INFINITY, 1e-9)
            );
        }
    }
}
