//! The speed that a motion reached on its own path.

/// The highest speed outside the zones at both ends of a motion. Where the zones take all of it, the speed where one
/// ends and the other begins: there the motion follows its own path for a moment.
#[derive(Clone, Copy, PartialEq, Default, Debug)]
pub(super) struct Reached {
    outside: Option<f64>,
    between: Option<f64>,
    leaves: bool,
}

impl Reached {
    /// Notes the speed in a cycle outside the zones.
    pub(super) fn outside(&mut self, speed: f64) {
        self.outside = Some(self.outside.map_or(speed, |highest| highest.max(speed)));
    }

    /// Notes the speed in a cycle within the zone at the start, or, with `leaves`, within the zone at the end.
    pub(super) fn within(&mut self, speed: f64, leaves: bool) {
        match (self.leaves, leaves) {
            (_, false) => self.between = Some(speed),
            (false, true) => {
                self.leaves = true;
                self.between = Some(self.between.map_or(speed, |entered| entered.min(speed)));
            }
            (true, true) => {}
        }
    }

    /// The highest speed.
    pub(super) fn highest(&self) -> f64 {
        self.outside.or(self.between).unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn zones_do_not_count_unless_there_is_nothing_else() {
        let mut reached = Reached::default();
        assert_eq!(reached.highest(), 0.0);
        [300.0, 120.0].into_iter().for_each(|speed| reached.within(speed, false));
        [110.0, 290.0].into_iter().for_each(|speed| reached.within(speed, true));
        assert_eq!(reached.highest(), 110.0);
        [90.0, 100.0, 95.0].into_iter().for_each(|speed| reached.outside(speed));
        reached.within(290.0, true);
        assert_eq!(reached.highest(), 100.0);
    }
}
