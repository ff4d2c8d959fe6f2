//! The segments ahead, in order, and where they end.

use std::collections::VecDeque;
use std::sync::Arc;

use crate::follow::segment::Segment;
use crate::follow::shared_deque::SharedDeque;

/// All segments from the one that the robot is on. Times are nominal, in s.
#[derive(Clone, Debug, Default)]
pub(crate) struct Segments {
    deque: SharedDeque<Segment>,
    /// End of each segment, since the path began.
    ends: VecDeque<f64>,
    /// Segments at whose end the robot stops, counted from the first segment ever.
    stops: VecDeque<u64>,
    /// Number of segments left behind.
    gone: u64,
    /// Time before the first segment, since the path began.
    passed: f64,
}

impl Segments {
    pub(crate) fn len(&self) -> usize {
        self.deque.len()
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.deque.is_empty()
    }

    pub(crate) fn get(&self, index: usize) -> Option<&Arc<Segment>> {
        self.deque.get(index)
    }

    pub(crate) fn front(&self) -> Option<&Arc<Segment>> {
        self.deque.front()
    }

    pub(crate) fn back(&self) -> Option<&Arc<Segment>> {
        self.deque.back()
    }

    pub(crate) fn iter(&self) -> impl DoubleEndedIterator<Item = &Arc<Segment>> + Clone {
        self.deque.iter()
    }

    /// `count` segments from the index `from` on.
    pub(crate) fn range(&self, from: usize, count: usize) -> impl DoubleEndedIterator<Item = &Arc<Segment>> + Clone {
        self.deque.range(from, count)
    }

    /// The deque of the segments alone; both share the segments.
    pub(crate) fn shared(&self) -> SharedDeque<Segment> {
        self.deque.clone()
    }

    /// The number of segments, from the first one on, that this path shares with another one.
    pub(crate) fn shared_with(&self, other: &Self) -> usize {
        self.deque.shared_with(&other.deque)
    }

    /// The number of segments left behind.
    pub(crate) fn gone(&self) -> u64 {
        self.gone
    }

    /// The time before the first segment, since the path began.
    pub(crate) fn passed(&self) -> f64 {
        self.passed
    }

    /// Where the last segment ends, since the path began.
    pub(crate) fn end(&self) -> f64 {
        self.ends.back().copied().unwrap_or(self.passed)
    }

    /// Where the segment at `index` begins, since the path began.
    pub(crate) fn start_of(&self, index: usize) -> f64 {
        index.checked_sub(1).and_then(|before| self.ends.get(before).copied()).unwrap_or(self.passed)
    }

    /// Where each segment begins, since the path began, followed by the end of the last one.
    pub(crate) fn starts(&self) -> impl Iterator<Item = f64> {
        [self.passed].into_iter().chain(self.ends.iter().copied())
    }

    /// The index of the segment at `time`, which counts since the path began; an end belongs to the next segment.
    pub(crate) fn index_at(&self, time: f64) -> usize {
        self.ends.partition_point(|end| *end <= time)
    }

    /// The index of the first segment at whose end the robot stops.
    pub(crate) fn first_stop(&self) -> Option<usize> {
        self.stops.front().map(|stop| stop.saturating_sub(self.gone) as usize)
    }

    /// Where the robot has to stop next, since the path began.
    pub(crate) fn next_stop(&self) -> f64 {
        self.first_stop().and_then(|stop| self.ends.get(stop).copied()).unwrap_or(self.end())
    }

    pub(crate) fn push(&mut self, segment: Arc<Segment>) {
        self.ends.push_back(self.end() + segment.time);
        if segment.stops {
            self.stops.push_back(self.gone + self.deque.len() as u64);
        }
        self.deque.push_back(segment);
    }

    /// Removes the last segment.
    pub(crate) fn pop_back(&mut self) -> Option<Arc<Segment>> {
        let segment = self.deque.pop_back()?;
        self.ends.pop_back();
        if segment.stops {
            self.stops.pop_back();
        }
        Some(segment)
    }

    /// Leaves the first segment behind.
    pub(crate) fn pass(&mut self) -> Option<Arc<Segment>> {
        let segment = self.deque.pop_front()?;
        self.ends.pop_front();
        if segment.stops {
            self.stops.pop_front();
        }
        self.gone += 1;
        self.passed += segment.time;
        Some(segment)
    }

    /// Lets the path begin where the first segment does.
    pub(crate) fn begin(&mut self) {
        self.passed = 0.0;
        let mut end = 0.0;
        for (known, segment) in self.ends.iter_mut().zip(self.deque.iter()) {
            end += segment.time;
            *known = end;
        }
    }

    /// Drops the segments behind the next stop, or all where there is no stop.
    pub(crate) fn keep_to_stop(&mut self) {
        let kept = self.first_stop().map_or(0, |last| last + 1);
        self.deque.truncate(kept);
        self.ends.truncate(kept);
        self.stops.truncate(1);
    }
}
