//! The interior point method for the problem with jerk limits.
//!
//! Primal and dual unknowns take Newton steps together, each first without and then with a correction for the remainder
//! of the first (Mehrotra). A jerk limit enters with its tangent at the current point, which is stricter than the limit
//! itself: a step that keeps the tangent keeps the limit.
//!
//! Indices: there are two coefficients more than stretches, and the stretch i has those from i to i + 2; the ranges of
//! limits and prices are those that the program assigned when it was created.

use std::ops::Range;

use crate::time_optimal::solver::banded::Banded;
use crate::time_optimal::solver::guess::coarse;
use crate::time_optimal::solver::lanes::{LANES, Lanes};
use crate::time_optimal::solver::law::Law;
use crate::time_optimal::solver::program::{Beginning, Known, Program, Site, SiteLimits, dot};
use crate::time_optimal::solver::{BoundaryState, ConstrainedPath, Pace, Refusal};

/// Maximum number of steps; 10 to 30 are needed, up to 60 from a given state.
const STEPS: usize = 80;
/// Maximum number of times that limits which were left out are added.
const ROUNDS: usize = 4;
/// Factor by which a given speed and acceleration at an end may exceed the limits.
const TOLERANCE: f64 = 1.003;
/// The same factor where the motion is roughly known: whether its set-points keep the limits is checked anyway, and
/// otherwise there is no motion that is nearly as fast.
const TOLERANCE_OF_KNOWN: f64 = 1.006;
/// Tolerance of the duration relative to the shortest possible one, as a share; the second one where the law is then
/// found again over its own pace.
const GAP: f64 = 5e-4;
const ROUGH_GAP: f64 = 0.02;
/// Share by which limits may be exceeded.
const MOST_EXCESS: f64 = 1e-4;
/// The initial sum of slack times price, in units of the duration at an even speed, and the least slack.
const FIRST_GAP: f64 = 10.0;
const LEAST_SLACK: f64 = 0.1;
/// The same where the motion is roughly known; the sum as a share of its duration.
const KNOWN_GAP: f64 = 0.05;
const LEAST_KNOWN_SLACK: f64 = 0.003;
/// The same where the motion is known up to some place, and guessed from there on.
const EXPECTED_GAP: f64 = 1.0;
const LEAST_EXPECTED_SLACK: f64 = 0.03;
/// After this many steps in a row of less than this share, the search is stuck.
const STUCK_STEPS: u32 = 4;
const STUCK_SHARE: f64 = 0.01;
/// Relative difference from the coefficients given by the states at the ends that counts as zero.
const NO_MISS: f64 = 1e-6;

/// A law is found again over its own pace as long as its duration falls by at least this share, and at most this many
/// times.
const LEAST_GAIN: f64 = 0.003;
const MOST_APPROACHES: usize = 6;
/// The same values where the law is found roughly.
const LEAST_ROUGH_GAIN: f64 = 0.02;
const MOST_ROUGH_APPROACHES: usize = 4;
/// Over the pace of a rough law, a law gains less than this share of the duration where its own pace is as good: the
/// next one would gain a thirtieth of that.
const LEAST_GAIN_ON_ROUGH: f64 = 0.01;
/// A law that takes longer than the rough law by more than this factor is not good enough.
const MOST_ON_ROUGH: f64 = 1.05;
/// A law that takes longer than it could by more than this factor is rejected.
pub(crate) const CREEPING: f64 = 1.2;

/// The coefficients of the fastest motion, with all limits kept, whose duration is within `gap` of the shortest
/// possible one.
fn settle(program: &mut Program, gap: f64) -> Result<Vec<f64>, Refusal> {
    let free = program.given.is_empty();
    let tolerance = if program.beginning == Beginning::Known { TOLERANCE_OF_KNOWN } else { TOLERANCE };
    let mut coefficients = program.first.clone();
    let mut used = 0.0;
    for round in 0..=ROUNDS {
        // Where all else fails, the initial motion is used; from rest to rest, it is slowed down below as far as
        // necessary.
        coefficients.clone_from(&program.first);
        if round < ROUNDS {
            let mut climb = Climb::new(program);
            climb.run(gap);
            if climb.coefficients.iter().all(|value| value.is_finite()) {
                coefficients = climb.coefficients;
            }
        }
        let added;
        (used, added) = program.review(&coefficients);
        if !added {
            break;
        }
    }
    if free {
        // Everything slows down with x in this proportion, the jerk even more.
        let share = 1.0 / f64::max(used, 1.0);
        coefficients.iter_mut().for_each(|value| *value *= share);
    } else if used > tolerance || program.missed(&coefficients) > NO_MISS || program.stops(&coefficients) {
        return Err(Refusal::Fast);
    }
    Ok(coefficients)
}

/// Slacks and prices of limits, with their changes in a step.
#[derive(Clone, Copy, Default, Debug)]
struct Prices {
    slack: Lanes,
    price: Lanes,
    slack_step: Lanes,
    price_step: Lanes,
}

/// Finds the fastest motion within all limits of `path`, behind a law if there is one.
///
/// Between two places, only the acceleration's slope is free. With a parameter that runs as time does, that is enough;
/// a guess is not that close. So a law is found over the pace of another one, until that is as good as its own.
pub(crate) fn solve(path: &ConstrainedPath, edges: [BoundaryState; 2], before: Option<&Law>) -> Result<Law, Refusal> {
    let Some(before) = before else { return solve_alone(path, edges) };
    // A few places give the pace sooner, but not always where the start leaves hardly any possible motion. And where it
    // has to slow down for what the law before has not covered, the pace of that law may fail.
    let coarse = coarse(path, edges);
    let mut best: Result<Law, Refusal> = Err(Refusal::Fast);
    let mut quickest = f64::INFINITY;
    for sparse in coarse.iter().chain([path]) {
        match solve_behind(path, edges, before, sparse) {
            Ok((law, rough)) => {
                let is_as_good = law.duration() < MOST_ON_ROUGH * rough.duration();
                (best, quickest) = (faster(best, Ok(law)), quickest.min(rough.duration()));
                if is_as_good {
                    return best;
                }
            }
            Err(Refusal::Fast) => {}
            Err(refusal) => return Err(refusal),
        }
    }
    best = faster(best, solve_alone(path, edges));
    // The law before leads to rest: searching again from a later state is better than creeping.
    if best.as_ref().is_ok_and(|law| law.duration() > CREEPING * quickest) { Err(Refusal::Fast) } else { best }
}

/// The faster one of two laws, as far as they were found.
fn faster(one: Result<Law, Refusal>, other: Result<Law, Refusal>) -> Result<Law, Refusal> {
    match (one, other) {
        (Ok(one), Ok(other)) if other.duration() < one.duration() => Ok(other),
        (Ok(one), _) => Ok(one),
        (Err(_), other) => other,
    }
}

/// Finds a law from a guess.
fn solve_alone(path: &ConstrainedPath, edges: [BoundaryState; 2]) -> Result<Law, Refusal> {
    let mut program = program(path, edges, Known::Nothing)?;
    let gap = if program.warp.is_even() { GAP } else { ROUGH_GAP };
    Ok(approach(path, edges, find(&mut program, gap)?))
}

/// Finds a law from the pace of the law before, as far as that is known; also returns the rough law, over a path with
/// fewer places, whose pace was used.
fn solve_behind(
    path: &ConstrainedPath,
    edges: [BoundaryState; 2],
    before: &Law,
    sparse: &ConstrainedPath,
) -> Result<(Law, Law), Refusal> {
    let rough = solve_roughly(sparse, edges, before)?;
    let pace = rough.pace_at(path.places()).ok_or(Refusal::Fast)?;
    let law = solve_near(path, edges, &pace)?;
    let law = if gain(&rough, &law).abs() < LEAST_GAIN_ON_ROUGH { law } else { approach(path, edges, law) };
    Ok((law, rough))
}

/// Finds a law for its pace alone.
fn solve_roughly(path: &ConstrainedPath, edges: [BoundaryState; 2], before: &Law) -> Result<Law, Refusal> {
    let mut rough = find_roughly(program(path, edges, Known::Before(before))?)?;
    for _ in 0..MOST_ROUGH_APPROACHES {
        let pace = rough.pace().ok_or(Refusal::Fast)?;
        let nearer = find_roughly(program(path, edges, Known::Pace(&pace))?)?;
        let gain = gain(&rough, &nearer);
        rough = nearer;
        if gain < LEAST_ROUGH_GAIN {
            break;
        }
    }
    Ok(rough)
}

/// Finds the law again over its own pace, repeatedly.
fn approach(path: &ConstrainedPath, edges: [BoundaryState; 2], mut law: Law) -> Law {
    for _ in 0..MOST_APPROACHES {
        let nearer = law.pace().and_then(|pace| solve_near(path, edges, &pace).ok());
        let Some(nearer) = nearer.filter(|nearer| nearer.duration() < law.duration()) else { break };
        let gain = gain(&law, &nearer);
        law = nearer;
        if gain < LEAST_GAIN {
            break;
        }
    }
    law
}

/// The share of the duration that a law saves compared with another one.
fn gain(law: &Law, nearer: &Law) -> f64 {
    1.0 - nearer.duration() / law.duration()
}

/// Finds a law where the pace is roughly known.
pub(crate) fn solve_near(path: &ConstrainedPath, edges: [BoundaryState; 2], pace: &Pace) -> Result<Law, Refusal> {
    find(&mut program(path, edges, Known::Pace(pace))?, GAP)
}

fn program(path: &ConstrainedPath, edges: [BoundaryState; 2], known: Known) -> Result<Program, Refusal> {
    if path.places().len() < 3 { Err(Refusal::Short) } else { Program::new(path, edges, known) }
}

/// Finds the fastest motion, from the first beginning that leads to one, whose duration is within `gap` of the shortest
/// possible one.
fn find(program: &mut Program, gap: f64) -> Result<Law, Refusal> {
    for beginning in program.beginnings() {
        program.begin(beginning);
        if let Ok(coefficients) = settle(program, gap) {
            return Ok(law(program, &coefficients));
        }
    }
    Err(Refusal::Fast)
}

/// Finds the motion roughly, for its pace alone: limits that were left out are not checked, so it may exceed them.
fn find_roughly(mut program: Program) -> Result<Law, Refusal> {
    for beginning in program.beginnings() {
        program.begin(beginning);
        let mut climb = Climb::new(&program);
        climb.run(ROUGH_GAP);
        let Climb { coefficients, .. } = climb;
        let is_sound = coefficients.iter().all(|value| value.is_finite()) && program.missed(&coefficients) < NO_MISS;
        if is_sound && !program.stops(&coefficients) {
            return Ok(law(&program, &coefficients));
        }
    }
    Err(Refusal::Fast)
}

/// The motion with these coefficients.
fn law(program: &Program, coefficients: &[f64]) -> Law {
    let mut squares = Vec::with_capacity(program.places.len());
    let mut laws = Vec::with_capacity(program.stretches.len());
    for (stretch, three) in program.stretches.iter().zip(coefficients.windows(3)) {
        let [from, to, _] = stretch.sites.map(|site| (dot(&site.square, three), dot(&site.slope, three)));
        let bend = dot(&stretch.bend, three);
        laws.push((from.1 * program.unit, bend * program.unit));
        if squares.is_empty() {
            squares.push(from.0 * program.unit);
        }
        squares.push(to.0 * program.unit);
    }
    Law::new(program.warp.clone(), &program.places, &squares, laws.into_iter())
}

/// The climb to the optimum.
struct Climb<'a> {
    program: &'a Program,
    coefficients: Vec<f64>,
    prices: Vec<Prices>,
    matrix: Banded,
    /// Right hand sides: the pull towards the optimum, the push away from the limits, and the correction.
    pull: Vec<f64>,
    push: Vec<f64>,
    correction: Vec<f64>,
    step: Vec<f64>,
}

/// x, the acceleration and the bend at a site, or their changes.
#[derive(Clone, Copy)]
struct Here {
    square: f64,
    slope: f64,
    bend: f64,
}

impl Here {
    fn new(site: &Site, bend: f64, three: &[f64]) -> Self {
        Self { square: dot(&site.square, three), slope: dot(&site.slope, three), bend }
    }

    /// The left hand side of a limit.
    #[inline(always)]
    fn of(self, limits: &SiteLimits) -> Lanes {
        let Self { square, slope, bend } = self;
        limits.square * Lanes::all(square) + limits.slope * Lanes::all(slope) + limits.bend * Lanes::all(bend)
    }
}

/// The right hand side of a limit, and its slope by x.
#[derive(Clone, Copy)]
struct Most {
    value: f64,
    slope: f64,
}

/// The limits of a site and their prices, in two parts with their right hand sides.
fn parts(site: &Site, square: f64) -> [(Range<usize>, Range<usize>, Most); 2] {
    let [(first, middle), (from, to)] = site.limits;
    let prices = site.prices;
    let between = prices + middle - first;
    let value = 1.0 / square.sqrt();
    let jerk = Most { value, slope: -0.5 * value / square };
    [(first..middle, prices..between, Most { value: 1.0, slope: 0.0 }), (from..to, between..between + to - from, jerk)]
}

/// The prediction for a step without correction: the rates at which it uses up slacks and prices, and sums for the
/// remaining slack times price.
#[derive(Default)]
struct Forecast {
    primal: Lanes,
    dual: Lanes,
    gap: Lanes,
    /// The largest excess of a limit.
    excess: Lanes,
    /// Slack times change of price, price times change of slack, and change times change.
    sums: [Lanes; 3],
}

impl<'a> Climb<'a> {
    fn new(program: &'a Program) -> Self {
        let size = program.first.len();
        Self {
            program,
            coefficients: program.first.clone(),
            prices: vec![Prices::default(); program.prices],
            matrix: Banded::default(),
            pull: vec![0.0; size],
            push: vec![0.0; size],
            correction: vec![0.0; size],
            step: vec![0.0; size],
        }
    }

    fn run(&mut self, most_gap: f64) {
        self.price();
        let count = (self.prices.len() * LANES) as f64;
        let (mut before, mut stuck) = (f64::INFINITY, 0);
        for _ in 0..STEPS {
            self.assemble();
            self.matrix.factor();
            self.step.clone_from(&self.pull);
            self.matrix.solve(&mut self.step);
            let forecast = self.predict();
            let gap = forecast.gap.sum();
            let duration = self.duration();
            // A given state at an end may exceed the limits.
            let keeps = !self.program.given.is_empty() || forecast.excess.most() < MOST_EXCESS;
            let is_near = gap < most_gap * duration && (before - duration).abs() < 0.5 * most_gap * duration;
            if keeps && is_near && self.program.missed(&self.coefficients) < NO_MISS {
                break;
            }
            before = duration;
            let (primal, dual) = (length(forecast.primal).min(1.0), length(forecast.dual).min(1.0));
            let [by_price, by_slack, both] = forecast.sums.map(Lanes::sum);
            let ahead = gap + dual * by_price + primal * by_slack + primal * dual * both;
            let centre = (ahead / gap).clamp(1e-6, 1.0).sqrt() * gap / count;
            let sides = self.pull.iter().zip(&self.push).zip(&self.correction);
            for (step, ((pull, push), correction)) in self.step.iter_mut().zip(sides) {
                *step = pull + centre * push - correction;
            }
            self.matrix.solve(&mut self.step);
            let (primal, dual) = self.correct(centre);
            stuck = if primal < STUCK_SHARE { stuck + 1 } else { 0 };
            if stuck == STUCK_STEPS || !self.take(primal, dual) {
                break;
            }
        }
    }

    /// Initialises the slacks from the limits, and prices with equal weights.
    fn price(&mut self) {
        let (gap, least) = match self.program.beginning {
            Beginning::Known => (KNOWN_GAP * self.duration(), LEAST_KNOWN_SLACK),
            Beginning::Expected => (EXPECTED_GAP * self.duration(), LEAST_EXPECTED_SLACK),
            Beginning::Even | Beginning::Smooth => (FIRST_GAP, LEAST_SLACK),
        };
        let Self { program, coefficients, prices, .. } = self;
        let weight = gap / (prices.len() * LANES) as f64;
        for (stretch, three) in program.stretches.iter().zip(coefficients.windows(3)) {
            let bend = dot(&stretch.bend, three);
            for site in &stretch.sites {
                let here = Here::new(site, bend, three);
                for (range, bought, most) in parts(site, here.square) {
                    for (limits, prices) in program.limits[range].iter().zip(&mut prices[bought]) {
                        let room = Lanes::all(most.value) - here.of(limits);
                        // A limit that is exceeded needs a slack of the size of the excess.
                        prices.slack = room.more(Lanes::all(least)).more(-room);
                        prices.price = Lanes::all(weight) * prices.slack.inverse();
                    }
                }
            }
        }
    }

    /// The duration, in units of the path's length and the speed that is 1.
    fn duration(&self) -> f64 {
        let of = |site: &Site, three: &[f64]| site.weight / dot(&site.square, three).sqrt();
        let stretches = self.program.stretches.iter().zip(self.coefficients.windows(3));
        stretches.map(|(stretch, three)| stretch.sites.iter().map(|site| of(site, three)).sum::<f64>()).sum()
    }

    /// Assembles the equations of the Newton step.
    fn assemble(&mut self) {
        let Self { program, coefficients, prices, matrix, pull, push, correction, .. } = self;
        let size = coefficients.len();
        matrix.reset(size);
        for side in [&mut *pull, &mut *push, &mut *correction] {
            side.clear();
            side.resize(size, 0.0);
        }
        for (index, (stretch, three)) in program.stretches.iter().zip(coefficients.windows(3)).enumerate() {
            let bend = dot(&stretch.bend, three);
            for site in &stretch.sites {
                let here = Here::new(site, bend, three);
                // The matrix in x, a and k, row by row from its diagonal on; and the two right hand sides.
                let mut inner = [Lanes::default(); 6];
                let (mut to, mut off) = ([Lanes::default(); 3], [Lanes::default(); 3]);
                let mut paid = Lanes::default();
                for (range, bought, most) in parts(site, here.square) {
                    paid = Lanes::default();
                    let (value, slope) = (Lanes::all(most.value), Lanes::all(most.slope));
                    for (limits, prices) in program.limits[range].iter().zip(&mut prices[bought]) {
                        let room = value - here.of(limits);
                        let slack = prices.slack.more(room);
                        let each = slack.inverse();
                        prices.slack = slack;
                        paid += prices.price;
                        let weight = prices.price * each;
                        let short = weight * (slack - room);
                        let by = [slope - limits.square, -limits.slope, -limits.bend];
                        let [a, b, c] = [by[0] * weight, by[1] * weight, by[2] * weight];
                        inner[0] += a * by[0];
                        inner[1] += a * by[1];
                        inner[2] += a * by[2];
                        inner[3] += b * by[1];
                        inner[4] += b * by[2];
                        inner[5] += c * by[2];
                        for axis in 0..3 {
                            to[axis] += by[axis] * short;
                            off[axis] += by[axis] * each;
                        }
                    }
                }
                let mut inner = inner.map(Lanes::sum);
                let (mut to, off) = (to.map(Lanes::sum), off.map(Lanes::sum));
                let fall = 0.5 * site.weight / (here.square * here.square.sqrt());
                // The curvature of the jerk limits counts against that of the duration. It must not outweigh it.
                inner[0] += 1.5 * fall / here.square * (1.0 - paid.sum() / site.weight).max(0.1);
                to[0] += fall;
                let three = [site.square, site.slope, stretch.bend];
                add(matrix.from(index), &three, &inner);
                gather(&mut pull[index..], &three, to);
                gather(&mut push[index..], &three, off);
            }
        }
        for (index, value) in &program.given {
            matrix.shift(*index, value - coefficients[*index], pull);
        }
        for (index, value) in &program.given {
            matrix.pin(*index);
            pull[*index] = value - coefficients[*index];
            push[*index] = 0.0;
        }
    }

    /// Predicts the result of the step that only pulls, and finds the correction for it.
    fn predict(&mut self) -> Forecast {
        let Self { program, coefficients, prices, correction, step, .. } = self;
        let mut forecast = Forecast::default();
        let one = Lanes::all(1.0);
        for (index, (stretch, three)) in program.stretches.iter().zip(coefficients.windows(3)).enumerate() {
            let change = &step[index..index + 3];
            let (bend, bend_step) = (dot(&stretch.bend, three), dot(&stretch.bend, change));
            for site in stretch.sites.iter().filter(|site| site.is_limited()) {
                let (here, by) = (Here::new(site, bend, three), Here::new(site, bend_step, change));
                let mut to = [Lanes::default(); 3];
                for (range, bought, most) in parts(site, here.square) {
                    let (value, slope) = (Lanes::all(most.value), Lanes::all(most.slope));
                    let rise = slope * Lanes::all(by.square);
                    for (limits, prices) in program.limits[range].iter().zip(&mut prices[bought]) {
                        let Prices { slack, price, .. } = *prices;
                        let each = slack.inverse();
                        let slack_step = rise - by.of(limits) + (value - here.of(limits) - slack);
                        let rate = -(slack_step * each);
                        let less = one - rate;
                        let price_step = -(price * less);
                        let product = slack_step * price_step;
                        prices.slack_step = slack_step;
                        forecast.primal = forecast.primal.more(rate);
                        forecast.dual = forecast.dual.more(less);
                        forecast.gap += slack * price;
                        forecast.excess = forecast.excess.more(here.of(limits) - value);
                        forecast.sums[0] += slack * price_step;
                        forecast.sums[1] += price * slack_step;
                        forecast.sums[2] += product;
                        let product = product * each;
                        to[0] += (slope - limits.square) * product;
                        to[1] += limits.slope * product;
                        to[2] += limits.bend * product;
                    }
                }
                let to = [to[0].sum(), -to[1].sum(), -to[2].sum()];
                let three = [site.square, site.slope, stretch.bend];
                gather(&mut correction[index..], &three, to);
            }
        }
        for (index, _) in &program.given {
            correction[*index] = 0.0;
        }
        forecast
    }

    /// Finds the changes of slacks and prices in the corrected step, and the possible shares of it.
    fn correct(&mut self, centre: f64) -> (f64, f64) {
        let Self { program, coefficients, prices, step, .. } = self;
        let (centre, one) = (Lanes::all(centre), Lanes::all(1.0));
        let (mut primal, mut dual) = (Lanes::all(NEAR), Lanes::all(NEAR));
        for (index, (stretch, three)) in program.stretches.iter().zip(coefficients.windows(3)).enumerate() {
            let change = &step[index..index + 3];
            let (bend, bend_step) = (dot(&stretch.bend, three), dot(&stretch.bend, change));
            for site in &stretch.sites {
                let (here, by) = (Here::new(site, bend, three), Here::new(site, bend_step, change));
                // The square may not even come close to zero: the tangents would be useless there.
                primal = primal.more(Lanes::all(-by.square / here.square * (NEAR / 0.9)));
                for (range, bought, most) in parts(site, here.square) {
                    let (value, rise) = (Lanes::all(most.value), Lanes::all(most.slope * by.square));
                    for (limits, prices) in program.limits[range].iter().zip(&mut prices[bought]) {
                        let Prices { slack, price, slack_step, .. } = *prices;
                        let each = slack.inverse();
                        // What the uncorrected step leaves of slack times price.
                        let product = -(slack_step * price * (one + slack_step * each));
                        let slack_step = rise - by.of(limits) + (value - here.of(limits) - slack);
                        let price_step = (centre - product - price * slack_step) * each - price;
                        prices.slack_step = slack_step;
                        prices.price_step = price_step;
                        primal = primal.more(-(slack_step * each));
                        dual = dual.more(-(price_step * price.inverse()));
                    }
                }
            }
        }
        ((NEAR * length(primal)).min(1.0), (NEAR * length(dual)).min(1.0))
    }

    /// Takes the step, unless it is not a number.
    fn take(&mut self, primal: f64, dual: f64) -> bool {
        if !(primal > 1e-9 && dual > 0.0 && self.step.iter().all(|step| step.is_finite())) {
            return false;
        }
        for (value, step) in self.coefficients.iter_mut().zip(&self.step) {
            *value += primal * step;
        }
        let (primal, dual) = (Lanes::all(primal), Lanes::all(dual));
        for prices in &mut self.prices {
            prices.slack += primal * prices.slack_step;
            prices.price += dual * prices.price_step;
        }
        true
    }
}

/// Share of the longest possible step that is taken.
const NEAR: f64 = 0.99;

/// The longest possible share of a step that uses slacks or prices up at these rates, at most 1/[`NEAR`].
fn length(rates: Lanes) -> f64 {
    1.0 / rates.most().max(NEAR)
}

/// Adds W' M W, with the rows of W and the upper rows of M, to the first three columns.
fn add(columns: &mut [[f64; 3]], rows: &[[f64; 3]; 3], inner: &[f64; 6]) {
    let [xx, xa, xk, aa, ak, kk] = *inner;
    for (index, column) in columns.iter_mut().take(3).enumerate() {
        let [x, a, k] = [rows[0][index], rows[1][index], rows[2][index]];
        let by = [xx * x + xa * a + xk * k, xa * x + aa * a + ak * k, xk * x + ak * a + kk * k];
        for (below, slot) in column.iter_mut().enumerate().take(3 - index) {
            let other = index + below;
            *slot += by[0] * rows[0][other] + by[1] * rows[1][other] + by[2] * rows[2][other];
        }
    }
}

/// Adds W' v to the first three values.
fn gather(values: &mut [f64], rows: &[[f64; 3]; 3], inner: [f64; 3]) {
    for (index, value) in values.iter_mut().take(3).enumerate() {
        *value += inner[0] * rows[0][index] + inner[1] * rows[1][index] + inner[2] * rows[2][index];
    }
}
