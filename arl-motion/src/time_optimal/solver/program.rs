//! The problem with jerk limits, stated over the paced parameter.
//!
//! The square x of the speed is a quadratic spline: the acceleration, half its slope, is continuous and changes evenly
//! from place to place. Its coefficients are the corners of the spline's control polygon, one for each stretch, in whose
//! middle it lies, and one at either end of the path. The three that count in a stretch give x and the acceleration at its
//! ends, and its bend; every limit is a function of these.
//!
//! Indices: a path that is timed here has three places or more; there is one stretch less, and one coefficient more.

use crate::time_optimal::solver::guess::guess_speeds;
use crate::time_optimal::solver::lanes::{LANES, Lanes};
use crate::time_optimal::solver::paced_warp::PacedWarp;
use crate::time_optimal::solver::screen::Screen;
use crate::time_optimal::solver::warp::{Place, Warp};
use crate::time_optimal::solver::warped_row::WarpedRow;
use crate::time_optimal::solver::{Edge, Refusal, Row, Way, reach};

/// One end of a stretch: what of the stretch's three coefficients makes up x and the acceleration here.
#[derive(Clone, Copy, Default, Debug)]
pub(crate) struct Site {
    pub(crate) square: [f64; 3],
    pub(crate) slope: [f64; 3],
    /// The share of the path that counts with the speed here.
    pub(crate) weight: f64,
    /// Its limits on speed and acceleration, and those on the jerk, which stretches share: from where to where.
    pub(crate) limits: [(usize, usize); 2],
    /// Where the prices of its limits begin, one after the other.
    pub(crate) prices: usize,
}

impl Site {
    /// Whether there are limits here.
    pub(crate) fn is_limited(&self) -> bool {
        self.limits.iter().any(|(from, to)| to > from)
    }
}

/// A stretch between two places: its ends, and what of its three coefficients makes up the bend.
#[derive(Clone, Copy, Default, Debug)]
pub(crate) struct Stretch {
    pub(crate) sites: [Site; 3],
    pub(crate) bend: [f64; 3],
}

/// Limits of one site: `square` x + `slope` a + `bend` k may be 1 at most; for those on the jerk 1/sqrt(x). Those that
/// are not needed are zeros, which are within any limit.
#[derive(Clone, Copy, Default, Debug)]
pub(crate) struct Limits {
    pub(crate) square: Lanes,
    pub(crate) slope: Lanes,
    pub(crate) bend: Lanes,
}

/// The problem, in units of the path's length and of a speed at which everything is within its limits.
#[derive(Debug)]
pub(crate) struct Program {
    pub(crate) warp: PacedWarp,
    /// The paced places.
    pub(crate) places: Vec<f64>,
    pub(crate) stretches: Vec<Stretch>,
    pub(crate) limits: Vec<Limits>,
    /// How many prices there are.
    pub(crate) prices: usize,
    /// The square of the speed that is 1 in these units.
    pub(crate) unit: f64,
    /// The coefficients to begin with.
    pub(crate) first: Vec<f64>,
    /// Whether the first two coefficients, and the last two, are given.
    pub(crate) fixed: [bool; 2],
    edges: [Edge; 2],
    /// About how fast the paced parameter can go at the places, where a state at an end is given.
    guess: Vec<f64>,
    screen: Screen,
    /// The stretches with limits in the middle.
    middles: Vec<usize>,
    /// The places at which derivatives of the path jump.
    jumps: Vec<bool>,
}

/// Where the screen has the rows of a place for the side before it, and for the one behind; behind those of all places it
/// has those of the middles.
fn before(place: usize) -> usize {
    2 * place
}

fn behind(place: usize) -> usize {
    2 * place + 1
}

/// The motion to begin with, where a state at an end is given.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Beginning {
    /// No faster than is guessed at any place: near the optimum where places differ much.
    Guessed,
    /// Smoothly from end to end.
    Smooth,
}

/// Of the square of a guessed speed the first motion has this share: it may be too high a guess.
const SHARE_OF_GUESS: f64 = 0.5;

/// By so much acceleration and jerk are limited more strictly, for what happens between the places, and to leave room for
/// a motion that starts on the way of another; that one has no such reserve.
const RESERVE: f64 = 1.005;
/// How many stretches next to rest have limits in the middle.
const MIDDLES: usize = 4;

/// A share of the highest square of the paced parameter's speed that no motion comes down to, but for one that fails.
const ALMOST_REST: f64 = 1e-9;

impl Program {
    /// With what the warped parameter's speeds are about, where that is known.
    pub(crate) fn new(way: &Way, [start, end]: [Edge; 2], known: Option<&[f64]>) -> Result<Self, Refusal> {
        let (from, to) = way.span()?;
        let warp = Warp::new(from, to, start.rests(), end.rests());
        let last = way.places().len() - 1;
        let place = |(index, at): (usize, &f64)| match index {
            0 => 0.0,
            _ if index == last => warp.length(),
            _ => warp.find(*at),
        };
        let places: Vec<f64> = way.places().iter().enumerate().map(place).collect();
        // Without jerk limits it is faster everywhere.
        let most = reach::squares(way, start, end)?;
        let edges = [start, end];
        let fixed = edges.map(|edge| !edge.rests());
        let guess =
            if known.is_none() || fixed != [false; 2] { guess_speeds(way, &warp, &places, edges) } else { Vec::new() };
        let warp = match known {
            Some(speeds) => PacedWarp::near(warp, &places, speeds.to_vec()),
            None => PacedWarp::guessed(warp, &places, guess.clone()),
        };
        let guess: Vec<f64> = warp.own_speeds(&guess).collect();
        let places: Vec<f64> = warp.places().collect();
        let mut rows = Vec::new();
        let mut ends = vec![0];
        let mut push = |all: &mut dyn Iterator<Item = &Row>, place: Place| {
            rows.extend(all.filter(|row| row.moves()).map(|row| WarpedRow::new(row, place)));
            ends.push(rows.len());
        };
        for (index, at) in places.iter().enumerate() {
            push(&mut way.rows_before(index).iter(), warp.place(index.saturating_sub(1), *at));
            push(&mut way.rows_behind(index).iter(), warp.place(index, *at));
        }
        // Close to rest the rows change so much that a stretch has limits in its middle as well.
        let count = MIDDLES.min(last / 2);
        let from = if start.rests() { 0..count } else { 0..0 };
        let to = if end.rests() { last - count..last } else { 0..0 };
        let middles: Vec<usize> = from.chain(to).collect();
        for index in &middles {
            let mut of_both = way.rows_behind(*index).iter().chain(way.rows_before(index + 1));
            push(&mut of_both, warp.place(*index, 0.5 * (places[*index] + places[index + 1])));
        }
        let unit = rows.iter().fold(f64::INFINITY, |unit, row| {
            let jerk = row.jerk[2];
            unit.min(1.0 / row.vel).min(1.0 / row.acc[1].abs()).min(1.0 / (jerk * jerk).cbrt())
        });
        if !(unit.is_finite() && unit > 0.0) {
            return Err(Refusal::Still);
        }
        let unit = 0.8 * unit;
        let hold = if start.rests() && end.rests() { RESERVE } else { 1.0 };
        rows.iter_mut().for_each(|row| row.scale(unit, hold));
        let most = most.iter().zip(&places).enumerate().flat_map(|(index, (square, at))| {
            let slope = warp.place(index, *at).first;
            [square / (slope * slope * unit); 2]
        });
        let screen = Screen::new(rows, ends, most.chain(middles.iter().map(|_| f64::INFINITY)));
        let mut program = Self {
            warp,
            places,
            stretches: Vec::with_capacity(last),
            limits: Vec::new(),
            prices: 0,
            unit,
            first: vec![1.0; last + 2],
            fixed,
            edges,
            guess,
            screen,
            middles,
            jumps: (0..=last).map(|index| way.jumps(index)).collect(),
        };
        program.lay(last);
        program.limit();
        Ok(program)
    }

    /// The spline.
    fn lay(&mut self, last: usize) {
        let places = &self.places;
        let length = self.warp.length();
        let corner = |index: usize| match index {
            0 => places[0],
            _ if index > last => places[last],
            _ => 0.5 * (places[index - 1] + places[index]),
        };
        // What of the coefficients `index` and `index` + 1 makes up x and the acceleration at a place.
        let shares = |index: usize| {
            let (before, after) = (corner(index), corner(index + 1));
            let share = (places[index] - before) / (after - before);
            ([1.0 - share, share], 0.5 / (after - before))
        };
        for index in 0..last {
            let width = places[index + 1] - places[index];
            let ([a, b], slope) = shares(index);
            let ([c, d], next) = shares(index + 1);
            let site = |square, slope, weight: f64| Site {
                square,
                slope,
                weight: weight * width / length,
                limits: [(0, 0); 2],
                prices: 0,
            };
            let middle = [0.25 * a, 0.25 * (b + c) + 0.5, 0.25 * d];
            self.stretches.push(Stretch {
                sites: [
                    site([a, b, 0.0], [-slope, slope, 0.0], 1.0 / 6.0),
                    site([0.0, c, d], [0.0, -next, next], 1.0 / 6.0),
                    site(middle, [-0.5 * slope, 0.5 * (slope - next), 0.5 * next], 4.0 / 6.0),
                ],
                bend: [slope / width, -(slope + next) / width, next / width],
            });
        }
    }

    /// The limits that may count.
    fn limit(&mut self) {
        let Self { stretches, limits, prices, screen, middles, jumps, .. } = self;
        limits.clear();
        *prices = 0;
        let last = stretches.len() - 1;
        let place = |limits: &mut Vec<Limits>, place: usize| {
            let first = limits.len();
            let speed = [screen.speed(place), 0.0, 0.0];
            let rows = screen.rows(place).flat_map(|(row, kept)| signs([row.acc[1], row.acc[0], 0.0], kept.acc));
            pack(limits, std::iter::once(speed).chain(rows));
            let middle = limits.len();
            let rows = screen.rows(place).flat_map(|(row, kept)| {
                let [bend, slope, square] = row.jerk;
                signs([square, slope, bend], kept.jerk)
            });
            pack(limits, rows);
            [(first, middle), (middle, limits.len())]
        };
        for (index, stretch) in stretches.iter_mut().enumerate() {
            let [left, right, middle] = &mut stretch.sites;
            left.limits = place(limits, behind(index));
            let next = place(limits, before(index + 1));
            // What does not depend on the bend is limited once a place, if it does not jump there.
            right.limits = if index == last || jumps[index + 1] { next } else { [(0, 0), next[1]] };
            if let Some(extra) = middles.iter().position(|middle| *middle == index) {
                middle.limits = place(limits, before(last + 2) + extra);
            }
            for site in [left, right, middle] {
                site.prices = *prices;
                *prices += site.limits.iter().map(|(from, to)| to - from).sum::<usize>();
            }
        }
    }

    /// The share of the limits that the solution `coefficients` takes up at most, all of them, and whether limits were
    /// added because of those that it exceeds.
    pub(crate) fn review(&mut self, coefficients: &[f64]) -> (f64, bool) {
        let (mut used, mut added) = (0.0, false);
        let last = self.stretches.len() - 1;
        for (index, (stretch, three)) in self.stretches.iter().zip(coefficients.windows(3)).enumerate() {
            let bend = dot(&stretch.bend, three);
            let extra = self.middles.iter().position(|middle| *middle == index);
            let middle = extra.map(|extra| before(last + 2) + extra);
            for (site, place) in stretch.sites.iter().zip([behind(index), before(index + 1)].into_iter().chain(middle))
            {
                let (share, more) = self.screen.review(place, dot(&site.square, three), dot(&site.slope, three), bend);
                used = f64::max(used, share);
                added |= more;
            }
        }
        if added {
            self.limit();
        }
        (used, added)
    }

    /// Whether the motion would come to rest, or almost, on the way.
    pub(crate) fn stops(&self, coefficients: &[f64]) -> bool {
        let squares = || {
            let stretches = self.stretches.iter().zip(coefficients.windows(3));
            stretches.flat_map(|(stretch, three)| stretch.sites.iter().map(move |site| dot(&site.square, three)))
        };
        let highest = squares().fold(0.0, f64::max);
        if squares().any(|square| square.is_nan() || square < ALMOST_REST * highest) {
            return true;
        }
        self.stretches.iter().zip(coefficients.windows(3)).any(|(stretch, three)| {
            let [from, to, _] = stretch.sites.map(|site| dot(&site.square, three));
            // The ends and the corner in the middle make a parabola that stays above zero.
            from < 0.0 || to < 0.0 || three[1] + (from * to).sqrt() < 0.0
        })
    }

    /// The coefficients to begin with: those that the edges give, and others that lead away from them. From rest to rest, what all
    /// limits allow everywhere, whatever is chosen.
    pub(crate) fn begin(&mut self, beginning: Beginning) {
        let Self { first, fixed, places, unit, warp, edges: [start, end], guess, .. } = self;
        if *fixed == [false; 2] {
            return;
        }
        let last = places.len() - 1;
        let length = places[last];
        // x and its slope at both ends; and the way over which the slope fades out.
        let state = |edge: Edge, at: usize, fixed: bool| {
            let place = warp.place(at, places[at]);
            let square = edge.vel * edge.vel / (place.first * place.first);
            let slope = 2.0 * (edge.acc - place.second * square) / place.first;
            let (square, slope) = if fixed { (square / *unit, slope / *unit) } else { (1.0, 0.0) };
            let fading = (0.5 * square / slope.abs().max(f64::MIN_POSITIVE)).min(length / 3.0);
            (square, slope, fading)
        };
        let (from, to) = (state(*start, 0, fixed[0]), state(*end, last, fixed[1]));
        let least = 0.1 * f64::min(from.0, to.0);
        for (index, slot) in first.iter_mut().enumerate() {
            let at = match index {
                0 => 0.0,
                _ if index > last => length,
                _ => 0.5 * (places[index - 1] + places[index]),
            };
            let (share, left) = (at / length, length - at);
            let blend = share * share * (3.0 - 2.0 * share);
            let faded = from.1 * at * (-at / from.2).exp() - to.1 * left * (-left / to.2).exp();
            *slot = (from.0 + (to.0 - from.0) * blend + faded).max(least);
            if beginning == Beginning::Guessed {
                let beside = [index.saturating_sub(1), index.min(last)].map(|at| guess.get(at).copied());
                let speed = beside.into_iter().flatten().fold(f64::INFINITY, f64::min);
                *slot = slot.min(SHARE_OF_GUESS * speed * speed / *unit);
            }
        }
        let widths = [places[1], places[last - 1] - length];
        let size = first.len();
        for ((state, width), (at, next)) in [from, to].iter().zip(widths).zip([(0, 1), (size - 1, size - 2)]) {
            if fixed[usize::from(at > 0)] {
                first[at] = state.0;
                first[next] = state.0 + 0.5 * state.1 * width;
            }
        }
    }
}

/// The sum of what three coefficients make up.
pub(crate) fn dot(shares: &[f64; 3], three: &[f64]) -> f64 {
    shares.iter().zip(three).map(|(share, value)| share * value).sum()
}

/// A limit upwards and downwards, where kept.
fn signs(limit: [f64; 3], kept: [bool; 2]) -> impl Iterator<Item = [f64; 3]> {
    [limit, limit.map(|value| -value)].into_iter().zip(kept).filter_map(|(limit, kept)| kept.then_some(limit))
}

/// Adds limits of one kind at one site.
fn pack(all: &mut Vec<Limits>, limits: impl Iterator<Item = [f64; 3]>) {
    let mut lane = LANES;
    for [square, slope, bend] in limits {
        if lane == LANES {
            all.push(Limits::default());
            lane = 0;
        }
        if let Some(last) = all.last_mut() {
            (last.square.0[lane], last.slope.0[lane], last.bend.0[lane]) = (square, slope, bend);
        }
        lane += 1;
    }
}
