//! The problem with jerk limits, stated over the paced parameter.
//!
//! The square x of the speed is a quadratic spline: the acceleration, half its slope, is continuous and changes
//! linearly from place to place. Its coefficients are the corners of the spline's control polygon: one for each
//! stretch, located in its middle, and one at either end of the path. The three that act on a stretch determine x and
//! the acceleration at its ends, and its bend; every limit is a function of these.
//!
//! Indices: a path that is timed here has at least three places; there is one stretch fewer, and one coefficient more.

use crate::time_optimal::solver::guess::guess_speeds;
use crate::time_optimal::solver::lanes::{LANES, Lanes};
use crate::time_optimal::solver::law::Law;
use crate::time_optimal::solver::pace::Pace;
use crate::time_optimal::solver::paced_warp::PacedWarp;
use crate::time_optimal::solver::screen::{Screen, highest_square};
use crate::time_optimal::solver::warp::{Warp, WarpedPoint};
use crate::time_optimal::solver::warped_row::WarpedRow;
use crate::time_optimal::solver::{BoundaryState, ConstrainedPath, Refusal, Row, reach};

/// One end of a stretch, or its middle: factors of the stretch's three coefficients in x and the acceleration here.
#[derive(Clone, Copy, Default, Debug)]
pub(crate) struct Site {
    pub(crate) square: [f64; 3],
    pub(crate) slope: [f64; 3],
    /// Share of the path that counts with the speed here.
    pub(crate) weight: f64,
    /// Ranges of its limits on speed and acceleration, and of those on the jerk, which stretches share.
    pub(crate) limits: [(usize, usize); 2],
    /// Index of the first price of its limits, which are consecutive.
    pub(crate) prices: usize,
}

impl Site {
    /// Whether there are limits here.
    pub(crate) fn is_limited(&self) -> bool {
        self.limits.iter().any(|(from, to)| to > from)
    }
}

/// A stretch between two places: its ends and its middle, and the factors of its three coefficients in the bend.
#[derive(Clone, Copy, Default, Debug)]
pub(crate) struct Interval {
    pub(crate) sites: [Site; 3],
    pub(crate) bend: [f64; 3],
}

/// Limits of one site: `square` x + `slope` a + `bend` k may be at most 1, or 1/sqrt(x) for limits on the jerk. Unused
/// entries are zeros, which are within any limit.
#[derive(Clone, Copy, Default, Debug)]
pub(crate) struct SiteLimits {
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
    pub(crate) stretches: Vec<Interval>,
    pub(crate) limits: Vec<SiteLimits>,
    /// Number of prices.
    pub(crate) prices: usize,
    /// The square of the speed that is 1 in these units.
    pub(crate) unit: f64,
    /// The initial coefficients.
    pub(crate) first: Vec<f64>,
    /// How the initial coefficients were chosen.
    pub(crate) beginning: Beginning,
    /// The beginning to use where the paced parameter runs roughly as time does along a known motion.
    known: Option<Beginning>,
    /// The coefficients given by the states at the ends, two for each.
    pub(crate) given: Vec<(usize, f64)>,
    edges: [BoundaryState; 2],
    screen: Screen,
    /// The stretches with limits in the middle, in order.
    middles: Vec<usize>,
    /// The places at which derivatives of the path jump.
    jumps: Vec<bool>,
}

/// The index in the screen of the rows of a place for the side before it, and for the side behind it. The rows of the
/// middles come after those of all places.
fn before(place: usize) -> usize {
    2 * place
}

fn behind(place: usize) -> usize {
    2 * place + 1
}

/// The initial motion.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Beginning {
    /// At an even speed that all limits permit everywhere, whatever is chosen; the states at the ends are approached
    /// during the climb.
    Even,
    /// Smoothly from end to end.
    Smooth,
    /// About as known.
    Known,
    /// About as known up to some place, and guessed from there on.
    Expected,
}

/// What is known about a motion.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Known<'a> {
    Nothing,
    /// The pace of the whole motion.
    Pace(&'a Pace),
    /// The law that leads to its start, and on along the same path. There is no program if that gives no pace.
    Before(&'a Law),
}

/// A state at an end is approached from an even speed if the square of its own speed is higher by no more than this
/// factor.
const HIGHEST_FROM_EVEN: f64 = 6.0;
/// A known motion begins with this share of the square of the speed, except for this time near a given state, in s.
const SHARE_OF_KNOWN: f64 = 0.97;
const GIVEN_STATE_S: f64 = 0.1;

/// Factor by which acceleration and jerk are limited more strictly, for what happens between the places, and to leave
/// room for a motion that starts on the path of another; that one has no such reserve.
const RESERVE: f64 = 1.005;
/// The same factor for the square of the speed, whatever the states at the ends.
const RESERVE_OF_SPEED: f64 = 1.0008;
/// At a given start, limits are raised as far as the state there requires, and by this share more; this fades out over
/// `START_PLACES` places. The law before was found over other places, where it may have used everything available. The
/// limit of the square of the speed, which is programmed, is raised by much less.
const START_RESERVE: f64 = 0.003;
const START_RESERVE_OF_SPEED: f64 = 2e-4;
/// No state that a law leads to uses more than this of the limits.
const MOST_USED_AT_START: f64 = 1.01;
const START_PLACES: usize = 50;
/// Factor by which the square of the speed at the start may exceed what is possible without jerk limits.
const MOST_EXCESS_AT_START: f64 = 1.02;
/// Number of stretches next to rest that have all limits in the middle.
const MIDDLES: usize = 4;
/// A stretch has speed limits in its middle where the square of the speed may reach this share of them: a motion as
/// fast as permitted at all places would be faster between them.
const NEAR_SPEED_LIMIT: f64 = 0.8;

/// A share of the highest square of the paced parameter's speed below which a motion counts as failed.
const ALMOST_REST: f64 = 1e-9;

/// Paces the parameter, as known or by a guess of the speeds along the path; also returns what the search begins with.
fn pace_from(
    known: Known,
    path: &ConstrainedPath,
    warp: Warp,
    places: &[f64],
    edges: [BoundaryState; 2],
) -> Result<(PacedWarp, Option<Beginning>), Refusal> {
    let guess = || guess_speeds(path, &warp, places, edges);
    let (along, beginning) = match known {
        Known::Nothing => (None, None),
        Known::Pace(pace) => (PacedWarp::along(warp, places, pace), Some(Beginning::Known)),
        Known::Before(law) => {
            let pace = Pace::behind(law, path.places(), places, &warp, &guess());
            let along = pace.and_then(|pace| PacedWarp::along(warp, places, &pace));
            (Some(along.ok_or(Refusal::Fast)?), Some(Beginning::Expected))
        }
    };
    let beginning = beginning.filter(|_| along.is_some());
    Ok((along.unwrap_or_else(|| PacedWarp::guessed(warp, places, guess())), beginning))
}

/// The rows over the paced parameter, those before and behind each place and those of the middles, and where each of
/// these groups ends.
fn warped_rows(
    path: &ConstrainedPath,
    warp: &PacedWarp,
    places: &[f64],
    middles: &[Middle],
) -> (Vec<WarpedRow>, Vec<usize>) {
    let mut rows = Vec::new();
    let mut ends = vec![0];
    let mut push = |all: &mut dyn Iterator<Item = Row>, place: WarpedPoint| {
        rows.extend(all.filter(Row::moves).map(|row| WarpedRow::new(&row, place)));
        ends.push(rows.len());
    };
    for (index, at) in places.iter().enumerate() {
        push(&mut path.rows_before(index).iter().copied(), warp.place(index.saturating_sub(1), *at));
        push(&mut path.rows_behind(index).iter().copied(), warp.place(index, *at));
    }
    for Middle { stretch, place, limits } in middles {
        let of_both = path.rows_behind(*stretch).iter().chain(path.rows_before(stretch + 1));
        match limits {
            Counting::All => push(&mut of_both.copied(), *place),
            Counting::Speed => push(&mut of_both.map(Row::of_speed), *place),
        }
    }
    (rows, ends)
}

impl Program {
    pub(crate) fn new(path: &ConstrainedPath, [start, end]: [BoundaryState; 2], known: Known) -> Result<Self, Refusal> {
        let (from, to) = path.span()?;
        let warp = Warp::new(from, to, start.rests(), end.rests());
        let last = path.places().len() - 1;
        let place = |(index, at): (usize, &f64)| match index {
            0 => 0.0,
            _ if index == last => warp.length(),
            _ => warp.find(*at),
        };
        let places: Vec<f64> = path.places().iter().enumerate().map(place).collect();
        // Without jerk limits it is faster everywhere, except at the start, where a law may have used more than is
        // available.
        let edges = [start, end];
        let most = reach::squares(path, edges, MOST_EXCESS_AT_START)?;
        let (warp, beginning) = pace_from(known, path, warp, &places, edges)?;
        let is_known = beginning == Some(Beginning::Known);
        let places: Vec<f64> = warp.places().collect();
        let middles = middles(path, &warp, &places, edges, &most);
        let (mut rows, ends) = warped_rows(path, &warp, &places, &middles);
        let by_jerk = highest_square(rows.iter().map(|row| row.jerk[2]));
        let unit = rows.iter().fold(by_jerk, |unit, row| unit.min(1.0 / row.vel).min(1.0 / row.acc[1].abs()));
        if !(unit.is_finite() && unit > 0.0) {
            return Err(Refusal::Still);
        }
        let unit = 0.8 * unit;
        let reserve = if start.rests() && end.rests() { RESERVE } else { 1.0 };
        rows.iter_mut().for_each(|row| row.scale(unit, [RESERVE_OF_SPEED, reserve]));
        let given = given(&warp, &places, edges, unit);
        if !start.rests() {
            let (square, slope) = given_state(start, warp.place(0, 0.0), unit);
            ease(&mut rows, &ends, &middles, square, slope)?;
        }
        let most = most.iter().zip(&places).enumerate().flat_map(|(index, (square, at))| {
            let slope = warp.place(index, *at).first;
            [square / (slope * slope * unit); 2]
        });
        let screen =
            Screen::new(rows, ends, most.chain(middles.iter().map(|_| f64::INFINITY)), is_known.then_some(1.0 / unit));
        let mut program = Self {
            warp,
            places,
            stretches: Vec::with_capacity(last),
            limits: Vec::new(),
            prices: 0,
            unit,
            first: vec![1.0; last + 2],
            beginning: Beginning::Even,
            known: beginning,
            given,
            edges,
            screen,
            middles: middles.iter().map(|middle| middle.stretch).collect(),
            jumps: (0..=last).map(|index| path.jumps(index)).collect(),
        };
        program.lay(last);
        program.limit();
        Ok(program)
    }

    /// Builds the spline.
    fn lay(&mut self, last: usize) {
        let places = &self.places;
        let length = self.warp.length();
        let corners: Vec<f64> = self.corners().collect();
        // Factors of the coefficients `index` and `index` + 1 in x and the acceleration at a place.
        let shares = |index: usize| {
            let (before, after) = (corners[index], corners[index + 1]);
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
            self.stretches.push(Interval {
                sites: [
                    site([a, b, 0.0], [-slope, slope, 0.0], 1.0 / 6.0),
                    site([0.0, c, d], [0.0, -next, next], 1.0 / 6.0),
                    site(middle, [-0.5 * slope, 0.5 * (slope - next), 0.5 * next], 4.0 / 6.0),
                ],
                bend: [slope / width, -(slope + next) / width, next / width],
            });
        }
    }

    /// Collects the limits that may count.
    fn limit(&mut self) {
        let Self { stretches, limits, prices, screen, middles, jumps, .. } = self;
        limits.clear();
        *prices = 0;
        let last = stretches.len() - 1;
        let place = |limits: &mut Vec<SiteLimits>, place: usize| {
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
            // Limits that do not depend on the bend are set once per place, unless derivatives jump there.
            right.limits = if index == last || jumps[index + 1] { next } else { [(0, 0), next[1]] };
            if let Ok(extra) = middles.binary_search(&index) {
                middle.limits = place(limits, before(last + 2) + extra);
            }
            for site in [left, right, middle] {
                site.prices = *prices;
                *prices += site.limits.iter().map(|(from, to)| to - from).sum::<usize>();
            }
        }
    }

    /// The largest share of all limits that the solution `coefficients` uses, and whether limits were added because the
    /// solution exceeds them.
    pub(crate) fn review(&mut self, coefficients: &[f64]) -> (f64, bool) {
        let (mut used, mut added) = (0.0, false);
        let last = self.stretches.len() - 1;
        for (index, (stretch, three)) in self.stretches.iter().zip(coefficients.windows(3)).enumerate() {
            let bend = dot(&stretch.bend, three);
            let middle = self.middles.binary_search(&index).ok().map(|extra| before(last + 2) + extra);
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

    /// The largest relative difference between coefficients and those given by the states at the ends.
    pub(crate) fn missed(&self, coefficients: &[f64]) -> f64 {
        let off = |(index, value): &(usize, f64)| ((value - coefficients[*index]) / value).abs();
        self.given.iter().map(off).fold(0.0, f64::max)
    }

    /// Whether the motion would come to rest, or almost, along the path.
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
            // The ends and the corner in the middle form a parabola that stays above zero.
            from < 0.0 || to < 0.0 || three[1] + (from * to).sqrt() < 0.0
        })
    }

    /// The beginnings to try in order until one leads to a motion.
    pub(crate) fn beginnings(&self) -> Vec<Beginning> {
        let is_high = self.given.iter().any(|(_, value)| *value > HIGHEST_FROM_EVEN);
        let even = (!is_high).then_some(Beginning::Even);
        let smooth = (!self.given.is_empty()).then_some(Beginning::Smooth);
        [self.known, even, smooth].into_iter().flatten().collect()
    }

    /// Sets the initial coefficients.
    pub(crate) fn begin(&mut self, beginning: Beginning) {
        self.beginning = beginning;
        self.first = match beginning {
            Beginning::Even => vec![1.0; self.first.len()],
            Beginning::Smooth => self.smooth(),
            Beginning::Known | Beginning::Expected => self.at_pace(),
        };
        if beginning != Beginning::Even {
            for (index, value) in &self.given {
                self.first[*index] = *value;
            }
        }
    }

    /// Where the coefficients are located.
    fn corners(&self) -> impl Iterator<Item = f64> {
        let ends = [self.places.first(), self.places.last()].map(|end| end.copied());
        let middles = self.places.windows(2).map(|pair| f64::midpoint(pair[0], pair[1]));
        ends[0].into_iter().chain(middles).chain(ends[1])
    }

    /// From end to end, with the slopes of x given by the states there.
    fn smooth(&self) -> Vec<f64> {
        let length = self.warp.length();
        let last = self.places.len() - 1;
        // x and its slope at both ends; and the distance over which the slope fades out.
        let state = |edge: BoundaryState, at: usize| {
            let (square, slope) = if edge.rests() {
                (1.0, 0.0)
            } else {
                given_state(edge, self.warp.place(at, self.places[at]), self.unit)
            };
            let fading = (0.5 * square / slope.abs().max(f64::MIN_POSITIVE)).min(length / 3.0);
            (square, slope, fading)
        };
        let [start, end] = self.edges;
        let (from, to) = (state(start, 0), state(end, last));
        let least = 0.1 * f64::min(from.0, to.0);
        let at = |at: f64| {
            let (share, remaining) = (at / length, length - at);
            let blend = share * share * (3.0 - 2.0 * share);
            let faded = from.1 * at * libm::exp(-at / from.2) - to.1 * remaining * libm::exp(-remaining / to.2);
            (from.0 + (to.0 - from.0) * blend + faded).max(least)
        };
        self.corners().map(at).collect()
    }

    /// Coefficients with which the paced parameter runs as time does.
    fn at_pace(&self) -> Vec<f64> {
        let length = self.warp.length();
        let by_edge = |edge: &BoundaryState, away: f64| {
            if edge.rests() { 1.0 } else { 1.0 - libm::exp(-(away / GIVEN_STATE_S) * (away / GIVEN_STATE_S)) }
        };
        let [start, end] = &self.edges;
        let slower = |at: f64| (1.0 - SHARE_OF_KNOWN) * by_edge(start, at) * by_edge(end, length - at);
        self.corners().map(|at| (1.0 - slower(at)) / self.unit).collect()
    }
}

/// A stretch with limits in its middle.
struct Middle {
    stretch: usize,
    /// The path parameter there.
    place: WarpedPoint,
    limits: Counting,
}

/// Which limits count.
enum Counting {
    All,
    Speed,
}

/// The stretches with limits in their middles: those close to rest, where rows change very much, and those of the
/// highest speed; `most` is the highest square of the speed at each place.
fn middles(
    path: &ConstrainedPath,
    warp: &PacedWarp,
    places: &[f64],
    [start, end]: [BoundaryState; 2],
    most: &[f64],
) -> Vec<Middle> {
    let last = places.len() - 1;
    let count = MIDDLES.min(last / 2);
    let is_near_rest = |stretch: usize| (start.rests() && stretch < count) || (end.rests() && stretch + count >= last);
    // The highest square of the speed by speed limits alone.
    let square = |row: &Row| (row.vel / row.first) * (row.vel / row.first);
    let highest = |rows: &[Row]| rows.iter().map(square).fold(f64::INFINITY, f64::min);
    let middle = |stretch: usize| {
        let [from, to] = [places[stretch], places[stretch + 1]];
        let place = warp.place(stretch, f64::midpoint(from, to));
        if is_near_rest(stretch) {
            return Some(Middle { stretch, place, limits: Counting::All });
        }
        let ends = [highest(path.rows_behind(stretch)), highest(path.rows_before(stretch + 1))];
        let is_fast = |(end, most): (&f64, &f64)| *most > NEAR_SPEED_LIMIT * end;
        let may_exceed = ends.iter().zip(&most[stretch..]).all(is_fast);
        may_exceed.then_some(Middle { stretch, place, limits: Counting::Speed })
    };
    (0..last).filter_map(middle).collect()
}

/// x and its slope at a given state at a place.
fn given_state(edge: BoundaryState, place: WarpedPoint, unit: f64) -> (f64, f64) {
    let square = edge.vel * edge.vel / (place.first * place.first);
    let slope = 2.0 * (edge.acc - place.second * square) / place.first;
    (square / unit, slope / unit)
}

/// The coefficients given by the states at the ends.
fn given(warp: &PacedWarp, places: &[f64], [start, end]: [BoundaryState; 2], unit: f64) -> Vec<(usize, f64)> {
    let last = places.len() - 1;
    let two = |edge: BoundaryState, at: usize, beside: usize, [first, next]: [usize; 2]| {
        let (square, slope) = given_state(edge, warp.place(at, places[at]), unit);
        let there = square + 0.5 * slope * (places[beside] - places[at]);
        if edge.rests() { None } else { Some([(first, square), (next, there)]) }
    };
    let both = [two(start, 0, 1, [0, 1]), two(end, last, last - 1, [last + 1, last])];
    both.into_iter().flatten().flatten().collect()
}

/// Raises the limits of the first places, and of the stretches between them, for the state at the start, x and its
/// slope; refuses a state that is far beyond them.
fn ease(rows: &mut [WarpedRow], ends: &[usize], middles: &[Middle], square: f64, slope: f64) -> Result<(), Refusal> {
    let range = |rows: &[WarpedRow], from: usize, to: usize| {
        let [from, to] = [from, to].map(|side| ends.get(side).copied().unwrap_or(rows.len()));
        from..to
    };
    let first = rows.get(range(rows, behind(0), behind(0) + 1)).unwrap_or_default();
    let by_speed = first.iter().map(|row| row.vel * square).fold(1.0, f64::max);
    let by_rest = first.iter().map(|row| (0.5 * row.acc[0] * slope + row.acc[1] * square).abs()).fold(1.0, f64::max);
    if by_speed.max(by_rest) > MOST_USED_AT_START {
        return Err(Refusal::Fast);
    }
    let most = [by_speed - 1.0 + START_RESERVE_OF_SPEED, by_rest.max(by_speed) - 1.0 + START_RESERVE];
    let raise = |rows: std::ops::Range<usize>, all: &mut [WarpedRow], place: usize| {
        let fading = 1.0 - place as f64 / START_PLACES as f64;
        let [speed, rest] = most.map(|most| 1.0 / (1.0 + most * fading));
        all.get_mut(rows).unwrap_or_default().iter_mut().for_each(|row| row.ease(speed, rest));
    };
    let places = (ends.len() - 1 - middles.len()) / 2;
    for place in 0..START_PLACES.min(places) {
        raise(range(rows, before(place), behind(place) + 1), rows, place);
    }
    for (index, middle) in middles.iter().enumerate().filter(|(_, middle)| middle.stretch < START_PLACES) {
        let side = before(places) + index;
        raise(range(rows, side, side + 1), rows, middle.stretch);
    }
    Ok(())
}

/// The sum of three coefficients with these factors.
pub(crate) fn dot(shares: &[f64; 3], three: &[f64]) -> f64 {
    shares.iter().zip(three).map(|(share, value)| share * value).sum()
}

/// A limit upwards and downwards, where kept.
fn signs(limit: [f64; 3], kept: [bool; 2]) -> impl Iterator<Item = [f64; 3]> {
    [limit, limit.map(|value| -value)].into_iter().zip(kept).filter_map(|(limit, kept)| kept.then_some(limit))
}

/// Adds the limits of one kind at one site.
fn pack(all: &mut Vec<SiteLimits>, limits: impl Iterator<Item = [f64; 3]>) {
    let mut lane = LANES;
    for [square, slope, bend] in limits {
        if lane == LANES {
            all.push(SiteLimits::default());
            lane = 0;
        }
        if let Some(last) = all.last_mut() {
            (last.square.0[lane], last.slope.0[lane], last.bend.0[lane]) = (square, slope, bend);
        }
        lane += 1;
    }
}
