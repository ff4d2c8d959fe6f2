//! The governor alone, on random courses.

use crate::follow::governor::*;
use crate::follow::timing::Timing;
use arl_robot::kinematics::random::Random;

fn timing(cells: &[(f64, Limits)]) -> Timing {
    let mut timing = Timing::default();
    for (index, (length, limits)) in cells.iter().enumerate() {
        timing.push(Cell { length: *length, limits: *limits }, index + 1 == cells.len(), true);
    }
    timing.find_entries(LOOK_AHEAD_MARGIN, 0.001);
    timing
}

/// Runs until the end; every cycle the state must keep to the limits where it is. Returns the cycles.
fn run(cells: &[(f64, Limits)], pacing: impl Fn(u32) -> Pacing) -> u32 {
    let mut timing = timing(cells);
    let (mut state, mut backup, mut cycle, mut done) = (State::default(), Change::default(), 0, 0.0);
    let whole: f64 = cells.iter().map(|(length, _)| length).sum();
    loop {
        let before = state;
        let pace = pacing(cycle);
        state = Governor { stretches: &timing.stretches, cycle: 0.001 }.next(&state, &mut backup, pace);
        cycle += 1;
        let context = format!("{cycle}: {done} {before:?} {state:?} {cells:?}");
        assert!(cycle < 100_000, "{context}");
        done += state.at - before.at;
        let stop_scale = if let Pacing::Stop(stop_scale) = pace { stop_scale } else { 1.0 };
        let mut end = 0.0;
        let here = cells.iter().position(|(length, _)| {
            end += length;
            done - state.vel * 0.001 < end
        });
        let Some((_, Limits { vel, acc, jerk })) = here.and_then(|here| cells.get(here)) else {
            assert!(state.rests(), "{context}");
            return cycle;
        };
        let before_end = done < end;
        if before_end {
            assert!(state.vel >= 0.0 && state.vel <= vel * 1.000_2, "{context}");
            assert!(state.acc.abs() <= acc * stop_scale * 1.001, "{context}");
            let change = (state.acc - before.acc).abs() / 0.001;
            assert!(change <= jerk * stop_scale * 1.02, "{change} {context}");
        }
        let mut rest = state;
        if timing.pass(&mut rest) {
            assert!(state.rests() && (done - whole).abs() < 1e-9, "{context}");
            return cycle;
        }
        state = rest;
    }
}

#[test]
fn rest_to_rest_takes_hardly_longer_than_the_shortest() {
    let mut random = Random::new(81);
    for _ in 0..100 {
        let (acc, time) = (random.between(1.0, 20.0), 10.0_f64.powf(random.between(-2.0, 0.5)));
        let limits = Limits { vel: 1.0, acc, jerk: acc * random.between(2.0, 60.0) };
        let cycles = run(&[(time, limits)], |_| Pacing::Go(1.0));
        let shortest = limits.duration(time);
        // Slowing down counts on a little less than the limits.
        let braking = limits.duration_braking(time, LOOK_AHEAD_MARGIN);
        assert!((f64::from(cycles) * 0.001 - braking - 0.0005).abs() <= 0.0015, "{cycles} {braking} {limits:?}");
        assert!(f64::from(cycles) * 0.001 <= shortest * 1.002 + 0.002, "{cycles} {shortest} {limits:?}");
        assert!(f64::from(cycles) * 0.001 >= shortest - 0.001, "{cycles} {shortest}");
    }
}

#[test]
fn a_speed_that_is_reached_is_kept_without_acceleration() {
    let mut random = Random::new(86);
    for _ in 0..200 {
        let acc = random.between(0.5, 60.0);
        let limits = Limits { vel: random.between(0.01, 1.0), acc, jerk: acc * random.between(2.0, 250.0) };
        let share = random.between(0.2, 1.0);
        let timing = timing(&[(1e3, limits)]);
        let (mut state, mut backup) = (State::default(), Change::default());
        let mut kept = 0;
        for _ in 0..200_000 {
            let governor = Governor { stretches: &timing.stretches, cycle: 0.001 };
            state = governor.next(&state, &mut backup, Pacing::Go(share));
            let reached = state.vel >= limits.vel * share * (1.0 - 1e-6);
            kept += u32::from(reached);
            assert!(kept <= 2 || state.acc.abs() <= 1e-6 * acc, "{kept} {state:?} {limits:?} {share}");
            if kept == 50 {
                break;
            }
        }
        assert_eq!(kept, 50, "{state:?} {limits:?} {share}");
    }
}

#[test]
fn stops_and_overrides_keep_to_the_limits_and_the_end() {
    let mut random = Random::new(82);
    for round in 0..60 {
        let acc = random.between(1.0, 20.0);
        let limits = Limits { vel: 1.0, acc, jerk: acc * random.between(2.0, 60.0) };
        let cells = [(random.between(0.05, 2.0), limits)];
        let (stop, stop_scale) = (random.between(1.0, 1500.0) as u32, if round % 2 == 0 { 1.0 } else { 5.0 });
        let share = random.between(0.01, 1.0);
        run(
            &cells,
            |cycle| if cycle >= stop && cycle < stop + 1500 { Pacing::Stop(stop_scale) } else { Pacing::Go(1.0) },
        );
        run(&cells, |cycle| if cycle >= stop { Pacing::Settle(share) } else { Pacing::Go(1.0) });
        // A slider that moves all the time.
        let shares: Vec<f64> = (0..100).map(|_| random.between(0.01, 1.0)).collect();
        run(&cells, |cycle| Pacing::Settle(shares[(cycle as usize / (1 + round % 7)) % shares.len()]));
    }
}

#[test]
fn slower_cells_are_entered_at_their_speed() {
    let mut random = Random::new(83);
    for round in 0..60 {
        let mut some = || {
            let vel = random.between(0.1, 1.0);
            let acc = if round % 2 == 0 { random.between(1.0, 20.0) } else { random.between(5.0, 8.0) };
            let limits = Limits { vel, acc, jerk: acc * random.between(5.0, if round % 4 < 2 { 60.0 } else { 8.0 }) };
            (10.0_f64.powf(random.between(-2.5, 0.0)), limits)
        };
        let cells: Vec<_> = (0..8).map(|_| some()).collect();
        run(&cells, |_| Pacing::Go(1.0));
        let stop = 100 + round * 3;
        run(&cells, |cycle| if cycle >= stop && cycle < stop + 900 { Pacing::Stop(1.0) } else { Pacing::Go(1.0) });
    }
}

/// A path that grows while a robot is on it, and what somebody does at the pendant meanwhile.
struct Ride {
    random: Random,
    timing: Timing,
    /// What has not been appended yet, and what was appended last.
    waiting: Vec<Cell>,
    last: Cell,
    state: State,
    backup: Change,
    /// The share of the speed that is asked for, 0 for a stop, how many cycles for, and the one that was settled to.
    wanted: f64,
    lasts: u32,
    share: f64,
}

const CYCLE: f64 = 0.001;

impl Ride {
    /// On random cells: speeds, accelerations and jerks over two orders of magnitude, lengths from less than a cycle
    /// on.
    fn new(seed: u64, grows: bool) -> Self {
        let mut random = Random::new(seed);
        let lengths = [(-3.3, 0.0), (-3.0, -1.0), (-2.0, -1.0), (-2.5, -0.5), (-2.0, 0.0)][seed as usize % 5];
        let mut some = || {
            let vel = match seed % 3 {
                0 => 1.0,
                1 => random.between(0.3, 1.0),
                _ => 10.0_f64.powf(random.between(-1.5, 0.0)),
            };
            let (least, most) = if seed.is_multiple_of(2) { (0.0, 2.5) } else { (0.7, 1.5) };
            let acc = 10.0_f64.powf(random.between(least, most));
            let jerk = (acc * 10.0_f64.powf(random.between(0.7, 2.4))).min(acc / (4.0 * CYCLE));
            Cell { length: 10.0_f64.powf(random.between(lengths.0, lengths.1)), limits: Limits { vel, acc, jerk } }
        };
        let mut waiting: Vec<Cell> = (0..4 + seed % 20).map(|_| some()).collect();
        let mut timing = Timing::default();
        let mut last = waiting.pop().unwrap();
        timing.push(last, true, true);
        while !grows && let Some(next) = waiting.pop() {
            timing.pop();
            timing.push(last, false, true);
            timing.push(next, true, true);
            last = next;
        }
        timing.find_entries(LOOK_AHEAD_MARGIN, CYCLE);
        let (state, backup) = (State::default(), Change::default());
        Self { random, timing, waiting, last, state, backup, wanted: 1.0, lasts: 0, share: 0.0 }
    }

    fn governor(&self) -> Governor<'_> {
        Governor { stretches: &self.timing.stretches, cycle: CYCLE }
    }

    /// Appends the next cell without a stop before it, if that is still possible; behind the stop, where the robot is
    /// there.
    fn grow(&mut self) {
        if self.timing.stretches.is_empty()
            && let Some(next) = self.waiting.pop()
        {
            self.timing.push(next, true, false);
            self.last = next;
        } else if self.random.between(0.0, 1.0) < 0.03
            && let Some(next) = self.waiting.pop()
        {
            let began = self.timing.pop();
            self.timing.push(self.last, false, true);
            self.timing.push(next, true, true);
            self.timing.find_entries(LOOK_AHEAD_MARGIN, CYCLE);
            match self.governor().holds(&self.state) {
                Some(backup) => (self.backup, self.last) = (backup, next),
                None => {
                    self.timing.pop();
                    self.timing.pop();
                    self.timing.push(self.last, true, !began);
                    self.waiting.push(next);
                }
            }
        }
        self.timing.find_entries(LOOK_AHEAD_MARGIN, CYCLE);
    }

    /// Somebody stops, goes on, or changes the override.
    fn disturb(&mut self) {
        self.lasts = self.lasts.saturating_sub(1);
        if self.lasts == 0 {
            let random = &mut self.random;
            self.wanted = match random.between(0.0, 10.0) as u32 {
                0..3 => 0.0,
                3..5 => random.between(0.01, 0.1),
                5..8 => random.between(0.1, 1.0),
                _ => 1.0,
            };
            let most = if random.between(0.0, 1.0) < 0.5 { 30.0 } else { 400.0 };
            self.lasts = random.between(1.0, most) as u32;
        }
    }

    /// The pacing, as the path finds it.
    fn pacing(&mut self) -> Pacing {
        if self.wanted == 0.0 {
            self.share = 0.0;
            return Pacing::Stop(1.0);
        }
        if self.wanted != self.share {
            if !self.governor().settled(&self.state, self.wanted) {
                return Pacing::Settle(self.wanted);
            }
            self.share = self.wanted;
        }
        Pacing::Go(self.wanted)
    }

    /// The highest speed, acceleration and jerk of all cells and stretches between two places, and whether there is a
    /// stop.
    fn most(&self, from: f64, to: f64) -> (Limits, bool) {
        let mut most = Limits { vel: 0.0, acc: 0.0, jerk: 0.0 };
        let mut end = 0.0;
        for stretch in &self.timing.stretches {
            for cell in &stretch.cells {
                let start = end;
                end += cell.length;
                if end > from - 1e-9 && start <= to + 1e-9 {
                    let Limits { vel, acc, jerk } = most;
                    most = Limits {
                        vel: vel.max(cell.limits.vel),
                        acc: acc.max(stretch.acc),
                        jerk: jerk.max(stretch.jerk),
                    };
                }
            }
            if stretch.stops {
                return (most, to >= end - 1e-12);
            }
        }
        (most, false)
    }

    /// Goes on for a cycle; the robot must keep to the limits where it is.
    fn go(&mut self) {
        let pacing = self.pacing();
        let (before, mut backup) = (self.state, self.backup);
        let next = self.governor().next(&before, &mut backup, pacing);
        let context = || format!("{before:?} {next:?} {pacing:?} {:?}", self.timing.stretches);
        let (most, stops) = self.most(before.at, next.at);
        assert!(next.at >= before.at && next.vel >= 0.0 && next.vel <= most.vel * 1.000_02, "{}", context());
        assert!(stops || next.acc.abs() <= most.acc * 1.001, "{}", context());
        assert!(stops || (next.acc - before.acc).abs() <= most.jerk * CYCLE * 1.003, "{}", context());
        (self.state, self.backup) = (next, backup);
        if self.timing.pass(&mut self.state) {
            self.backup = Change::default();
        }
    }

    /// Whether everything has been passed.
    fn is_over(&self) -> bool {
        self.timing.stretches.is_empty() && self.waiting.is_empty()
    }
}

#[test]
fn whatever_comes_up_on_whatever_course_every_limit_is_kept() {
    for seed in 0..120 {
        let mut ride = Ride::new(seed, seed % 4 == 3);
        let mut cycle = 0;
        while !ride.is_over() {
            ride.grow();
            if cycle < 3000 && seed % 3 > 0 {
                ride.disturb();
            } else {
                ride.wanted = 1.0;
            }
            ride.go();
            cycle += 1;
            assert!(cycle < 200_000, "{seed} does not end: {:?}", ride.state);
        }
    }
}

#[test]
fn the_hardest_braking_leads_neither_back_nor_below_rest() {
    let mut random = Random::new(84);
    let mut found = [0, 0];
    for _ in 0..20_000 {
        let acc = 10.0_f64.powf(random.between(0.0, 2.5));
        let limits = Limits { vel: 1.0, acc, jerk: acc * 10.0_f64.powf(random.between(0.7, 2.4)) };
        let vel = 10.0_f64.powf(random.between(-7.0, 0.0));
        // An acceleration that can fade before the speed does, or hardly not.
        let state = State { at: 0.0, vel, acc: random.between(-1.1, 0.5) * (2.0 * vel * limits.jerk).sqrt().min(acc) };
        let Some(jerk) = lowest_jerk(&state, CYCLE, &limits) else {
            found[0] += 1;
            continue;
        };
        found[1] += 1;
        let next = state.after(jerk, CYCLE);
        let fades = next.vel - next.acc.min(0.0).powi(2) / (2.0 * limits.jerk);
        assert!(next.at >= -1e-18 && fades >= -1e-12 && jerk.abs() <= limits.jerk, "{state:?} {next:?} {limits:?}");
    }
    assert!(found[0] > 100 && found[1] > 1000, "{found:?}");
}
