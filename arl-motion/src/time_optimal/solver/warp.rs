//! A parameter in which motion from and to rest is smooth.

/// Share of the path that the warped part at an end at rest takes.
const SHARE: f64 = 0.25;
/// Length in the path parameter of a warped part of length 1.
const PART: f64 = 0.6;

/// The path parameter as a function of the warped one: its cube close to an end at rest, then, joined with three
/// continuous derivatives, equal to it except for an offset.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct Warp {
    from: f64,
    to: f64,
    /// Lengths of the warped parts at the start and the end; 0 where the motion is not at rest there.
    first: f64,
    last: f64,
}

/// A path parameter and its derivatives by the warped parameter.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct WarpedPoint {
    pub(crate) at: f64,
    pub(crate) first: f64,
    pub(crate) second: f64,
    pub(crate) third: f64,
}

impl Warp {
    /// Creates the warp of the path `from`..`to`, with the ends at which the motion is at rest.
    pub(crate) fn new(from: f64, to: f64, rests_first: bool, rests_last: bool) -> Self {
        let part = SHARE * (to - from) / PART;
        Self { from, to, first: if rests_first { part } else { 0.0 }, last: if rests_last { part } else { 0.0 } }
    }

    /// The end of the range of the warped parameter, which starts at 0.
    pub(crate) fn length(&self) -> f64 {
        self.to - self.from + (1.0 - PART) * (self.first + self.last)
    }

    pub(crate) fn place(&self, at: f64) -> WarpedPoint {
        let remaining = self.length() - at;
        if at < self.first {
            let place = part(at / self.first, self.first);
            WarpedPoint { at: self.from + place.at, ..place }
        } else if remaining < self.last {
            let place = part((remaining / self.last).max(0.0), self.last);
            WarpedPoint { at: self.to - place.at, second: -place.second, ..place }
        } else {
            WarpedPoint { at: self.from + at - (1.0 - PART) * self.first, first: 1.0, second: 0.0, third: 0.0 }
        }
    }

    /// The warped parameter of a path parameter.
    pub(crate) fn find(&self, at: f64) -> f64 {
        let (done, remaining) = (at - self.from, self.to - at);
        if done < PART * self.first {
            self.first * unpart(done / self.first)
        } else if remaining < PART * self.last {
            self.length() - self.last * unpart(remaining / self.last)
        } else {
            done + (1.0 - PART) * self.first
        }
    }
}

/// The warped part of length `length` at the share `u` from its rest.
fn part(u: f64, length: f64) -> WarpedPoint {
    WarpedPoint {
        at: length * u * u * u * (2.0 - 2.0 * u + PART * u * u),
        first: u * u * (6.0 - 8.0 * u + 3.0 * u * u),
        second: 12.0 * u * (1.0 - u) * (1.0 - u) / length,
        third: (12.0 - 48.0 * u + 36.0 * u * u) / (length * length),
    }
}

/// The share of a warped part of length 1 at which it has covered `distance`.
fn unpart(distance: f64) -> f64 {
    let distance = distance.max(0.0);
    // From above, where Newton's method approaches the root of a convex function without passing it.
    let mut u = libm::cbrt(distance / PART).min(1.0);
    for _ in 0..60 {
        let WarpedPoint { at, first, .. } = part(u, 1.0);
        let step = (at - distance) / first;
        // Also where the step is not a number, at 0.
        if step.is_nan() || step <= 1e-16 * u {
            break;
        }
        u -= step;
    }
    u
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_smooth_and_found_back() {
        for (first, last) in [(true, true), (true, false), (false, true), (false, false)] {
            let warp = Warp::new(-1.0, 2.0, first, last);
            let length = warp.length();
            assert!((warp.place(0.0).at + 1.0).abs() < 1e-12 && (warp.place(length).at - 2.0).abs() < 1e-12);
            for index in 1..1000 {
                let (at, step) = (length * f64::from(index) / 1000.0, 1e-5);
                let [before, here, after] = [at - step, at, at + step].map(|at| warp.place(at));
                let slope = |of: fn(&WarpedPoint) -> f64| (of(&after) - of(&before)) / (2.0 * step);
                assert!((slope(|place| place.at) - here.first).abs() < 1e-8, "{at}");
                assert!((slope(|place| place.first) - here.second).abs() < 1e-8, "{at}");
                assert!((slope(|place| place.second) - here.third).abs() < 1e-3, "{at}");
                assert!((warp.find(here.at) - at).abs() < 1e-9 * length, "{at}");
            }
        }
    }
}
