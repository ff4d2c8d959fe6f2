//! Inputs and outputs over time: a lane for each that changes.

use super::scale::Scale;
use super::svg::{Anchor, Area, Picture};

/// px from lane to lane, and the height of a lane.
const APART: f64 = 19.0;
const HEIGHT: f64 = 13.0;
/// px between two changes that are drawn apart.
const CLOSEST: f64 = 0.3;
/// More lanes than these are not drawn.
const DRAWN: usize = 24;

/// A signal that changes.
#[derive(Clone, PartialEq, Debug)]
pub struct Lane {
    /// Its name.
    pub(crate) label: String,
    /// Times in s, and the value from then on. Before the first change it is 0.
    pub(crate) changes: Vec<(f64, f64)>,
}

/// The height of the lanes in the picture, in px.
pub(super) fn height(lanes: &[Lane]) -> f64 {
    let more = usize::from(lanes.len() > DRAWN);
    if lanes.is_empty() { 0.0 } else { 34.0 + APART * (lanes.len().min(DRAWN) + more) as f64 }
}

/// Draws the lanes below each other, from the top of `area` on, which is as wide as the charts above.
pub(super) fn draw(lanes: &[Lane], time: [f64; 2], area: &Area, picture: &mut Picture) {
    if lanes.is_empty() {
        return;
    }
    picture.text([area.x, area.y], Anchor::Start, "head", "Inputs and outputs that change");
    let across = Scale::new(time, area.x, area.right());
    for (at, lane) in lanes.iter().take(DRAWN).enumerate() {
        let top = area.y + 14.0 + at as f64 * APART;
        picture.path(&outline(lane, time, &across, top), "curve", "#1f2328");
        picture.text([area.right() + 10.0, top + HEIGHT - 3.0], Anchor::Start, "tick", &lane.label);
    }
    if lanes.len() > DRAWN {
        let more = format!("and {} more", lanes.len() - DRAWN);
        let y = area.y + 14.0 + DRAWN as f64 * APART + HEIGHT - 3.0;
        picture.text([area.x, y], Anchor::Start, "tick", &more);
    }
}

/// The line of a lane: up and down between its lowest and its highest value. Changes that are closer together than a
/// fraction of a pixel are one stroke.
fn outline(lane: &Lane, [from, to]: [f64; 2], across: &Scale, top: f64) -> Vec<Option<[f64; 2]>> {
    let values = || lane.changes.iter().map(|(_, value)| *value);
    let (least, most) = (values().fold(0.0, f64::min), values().fold(0.0, f64::max));
    let upward = Scale::new([least, most.max(least + 1e-9)], top + HEIGHT, top);
    let before = lane.changes.iter().take_while(|(time, _)| *time <= from).last().map_or(0.0, |(_, value)| *value);
    let (mut x, mut y) = (across.at(from), upward.at(before));
    let mut line = vec![Some([x, y])];
    for (time, value) in lane.changes.iter().filter(|(time, _)| *time > from && *time <= to) {
        if across.at(*time) - x >= CLOSEST {
            x = across.at(*time);
            line.push(Some([x, y]));
        }
        y = upward.at(*value);
        line.push(Some([x, y]));
    }
    line.push(Some([across.at(to), y]));
    line
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_lane_goes_up_and_down_where_its_signal_does() {
        let lane = Lane {
            label: "di.1".into(),
            changes: vec![(-1.0, 1.0), (2.0, 0.0), (2.000_001, 1.0), (4.0, 0.0), (20.0, 1.0)],
        };
        let path = outline(&lane, [0.0, 10.0], &Scale::new([0.0, 10.0], 0.0, 100.0), 10.0);
        let path: Vec<[f64; 2]> = path.into_iter().flatten().collect();
        let expected = [[0, 10], [20, 10], [20, 23], [20, 10], [40, 10], [40, 23], [100, 23]];
        assert_eq!(path, expected.map(|point| point.map(f64::from)));
    }
}
