//! A double-ended queue that is copied quickly: copies share what they have in common.
//!
//! Invariant: all chunks but the last one are full, and none is empty. The first `gone` elements of the first chunk,
//! fewer than it has, no longer count.

use std::collections::VecDeque;
use std::sync::Arc;

/// Number of elements in a chunk: copying the queue copies one pointer per chunk; the first change after that copies
/// the elements of one chunk.
const CHUNK: usize = 32;

/// Shared elements, in order.
#[derive(Debug)]
pub(crate) struct SharedDeque<T> {
    chunks: VecDeque<Arc<Vec<Arc<T>>>>,
    gone: usize,
    len: usize,
}

impl<T> Clone for SharedDeque<T> {
    fn clone(&self) -> Self {
        Self { chunks: self.chunks.clone(), ..*self }
    }
}

impl<T> Default for SharedDeque<T> {
    fn default() -> Self {
        Self { chunks: VecDeque::new(), gone: 0, len: 0 }
    }
}

impl<T> SharedDeque<T> {
    pub(crate) fn len(&self) -> usize {
        self.len
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.len == 0
    }

    pub(crate) fn get(&self, index: usize) -> Option<&Arc<T>> {
        let place = index.checked_add(self.gone)?;
        self.chunks.get(place / CHUNK)?.get(place % CHUNK)
    }

    pub(crate) fn front(&self) -> Option<&Arc<T>> {
        self.get(0)
    }

    pub(crate) fn back(&self) -> Option<&Arc<T>> {
        self.chunks.back()?.last()
    }

    pub(crate) fn iter(&self) -> impl DoubleEndedIterator<Item = &Arc<T>> + Clone {
        self.range(0, self.len)
    }

    /// `count` elements from the index `from` on.
    pub(crate) fn range(&self, from: usize, count: usize) -> impl DoubleEndedIterator<Item = &Arc<T>> + Clone {
        (from..from + count).filter_map(|index| self.get(index))
    }

    /// The number of first elements that this queue shares with another one.
    pub(crate) fn shared_with(&self, other: &Self) -> usize {
        let common = |index: &usize| match (self.get(*index), other.get(*index)) {
            (Some(own), Some(other)) => Arc::ptr_eq(own, other),
            _ => false,
        };
        let chunks = self.chunks.iter().zip(&other.chunks);
        let chunks = chunks.map(|(own, other)| Arc::ptr_eq(own, other)).take_while(|same| *same).count();
        // Where the numbers of gone elements differ, equal chunks prove nothing.
        let known = if self.gone == other.gone { (chunks * CHUNK).saturating_sub(self.gone).min(self.len) } else { 0 };
        known + (known..self.len.max(known)).take_while(common).count()
    }

    pub(crate) fn push_back(&mut self, element: Arc<T>) {
        match self.chunks.back_mut().filter(|last| last.len() < CHUNK) {
            Some(last) => Arc::make_mut(last).push(element),
            None => {
                let mut chunk = Vec::with_capacity(CHUNK);
                chunk.push(element);
                self.chunks.push_back(Arc::new(chunk));
            }
        }
        self.len += 1;
    }

    pub(crate) fn pop_back(&mut self) -> Option<Arc<T>> {
        if self.is_empty() {
            return None;
        }
        let last = self.chunks.back_mut()?;
        let element = Arc::make_mut(last).pop();
        let is_used = !last.is_empty();
        self.len -= 1;
        if self.is_empty() {
            self.chunks.clear();
            self.gone = 0;
        } else if !is_used {
            self.chunks.pop_back();
        }
        element
    }

    pub(crate) fn pop_front(&mut self) -> Option<Arc<T>> {
        let element = self.front().map(Arc::clone)?;
        (self.gone, self.len) = (self.gone + 1, self.len - 1);
        if self.is_empty() || self.gone == CHUNK {
            self.chunks.pop_front();
            self.gone = 0;
        }
        Some(element)
    }

    /// Keeps at most the first `count` elements.
    pub(crate) fn truncate(&mut self, count: usize) {
        while self.len > count {
            self.pop_back();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use arl_robot::kinematics::random::Random;

    #[test]
    fn copies_do_not_change_with_each_other() {
        let mut random = Random::new(17);
        let (mut queue, mut expected) = (SharedDeque::default(), VecDeque::new());
        let mut copies: Vec<(SharedDeque<u32>, VecDeque<u32>)> = Vec::new();
        for number in 0..20_000 {
            match random.between(0.0, 10.0) as u32 {
                0..5 => {
                    queue.push_back(Arc::new(number));
                    expected.push_back(number);
                }
                5 | 6 => assert_eq!(queue.pop_back().map(|last| *last), expected.pop_back()),
                7 | 8 => assert_eq!(queue.pop_front().map(|first| *first), expected.pop_front()),
                _ => {
                    copies.push((queue.clone(), expected.clone()));
                    if copies.len() > 5 {
                        (queue, expected) = copies.swap_remove(random.between(0.0, 5.0) as usize);
                    }
                }
            }
            assert_eq!(
                [queue.len(), usize::from(queue.is_empty())],
                [expected.len(), usize::from(expected.is_empty())]
            );
            assert_eq!(queue.front().map(|first| **first), expected.front().copied());
            assert_eq!(queue.back().map(|last| **last), expected.back().copied());
            if number % 16 == 0 {
                assert!(queue.iter().map(|element| **element).eq(expected.iter().copied()));
                assert!(queue.iter().rev().map(|element| **element).eq(expected.iter().rev().copied()));
                for (copy, numbers) in &copies {
                    assert!(copy.iter().map(|element| **element).eq(numbers.iter().copied()));
                    let common = queue.iter().zip(copy.iter()).take_while(|(a, b)| Arc::ptr_eq(a, b)).count();
                    assert_eq!(queue.shared_with(copy), common);
                }
            }
        }
        queue.truncate(3);
        assert!(queue.len() <= 3 && queue.get(3).is_none());
    }
}
