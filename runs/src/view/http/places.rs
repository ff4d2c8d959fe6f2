//! The places of connections: their number is limited, and those that have made sensible requests are closed last.

use std::collections::BTreeMap;
use std::net::{Shutdown, TcpStream};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// A page keeps a few connections, several pages some more; there are no other clients.
const MOST: usize = 128;

/// The rank of a connection: the lowest is closed first, and among equals the one whose last request is longest ago.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default, Debug)]
pub(in super::super) enum Rank {
    /// It has not yet made a request that was answered.
    #[default]
    Unknown,
    /// It reads.
    Reader,
    /// It gives orders: the buttons of the pendant.
    Orders,
}

/// All places, by the numbers of the visitors.
#[derive(Default)]
pub(super) struct Places(Mutex<Taken>);

#[derive(Default)]
struct Taken {
    /// Counts visitors and requests.
    counted: u64,
    by_number: BTreeMap<u64, Visitor>,
}

struct Visitor {
    rank: Rank,
    /// When it made its last request, or came, by that count.
    asked: u64,
    stream: Arc<TcpStream>,
}

/// A place, free again when it is dropped.
pub(super) struct Slot {
    number: u64,
    of: Arc<Places>,
}

impl Places {
    /// Gives a connection a place; where there are too many, another connection loses its own.
    pub(super) fn take(self: &Arc<Self>, stream: TcpStream) -> (Slot, Arc<TcpStream>) {
        let stream = Arc::new(stream);
        let mut taken = self.taken();
        if taken.by_number.len() >= MOST {
            taken.free_one();
        }
        let number = taken.count();
        taken.by_number.insert(number, Visitor { rank: Rank::Unknown, asked: number, stream: Arc::clone(&stream) });
        (Slot { number, of: Arc::clone(self) }, stream)
    }

    /// Ends the connection that matters least.
    pub(super) fn free_one(&self) {
        self.taken().free_one();
    }

    fn taken(&self) -> MutexGuard<'_, Taken> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Taken {
    fn count(&mut self) -> u64 {
        self.counted += 1;
        self.counted
    }

    fn free_one(&mut self) {
        let lowest = self.by_number.iter().min_by_key(|(_, visitor)| (visitor.rank, visitor.asked));
        let lowest = lowest.map(|(number, _)| *number);
        if let Some(visitor) = lowest.and_then(|number| self.by_number.remove(&number)) {
            // Its thread wakes up and ends. It may be closed already.
            let _ = visitor.stream.shutdown(Shutdown::Both);
        }
    }
}

impl Slot {
    /// Notes a request of the visitor, who keeps the highest rank so far.
    pub(super) fn rises_to(&self, rank: Rank) {
        let mut taken = self.of.taken();
        let now = taken.count();
        if let Some(visitor) = taken.by_number.get_mut(&self.number) {
            visitor.rank = rank.max(visitor.rank);
            visitor.asked = now;
        }
    }
}

impl Drop for Slot {
    fn drop(&mut self) {
        self.of.taken().by_number.remove(&self.number);
    }
}
