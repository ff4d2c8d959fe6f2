//! The receive buffer of a connection: received bytes that have not been read yet.

/// How many bytes may wait, in each direction of a connection.
pub(crate) const CAPACITY: usize = 1 << 20;

/// Bytes from the other side that have not been read yet, in their order, bounded by [`CAPACITY`].
#[derive(Default, Debug)]
pub(crate) struct Inbox {
    bytes: Vec<u8>,
    /// The index in `bytes` of the first one not read.
    start: usize,
    /// At how many of the bytes not read `mark` is known not to begin.
    searched: usize,
    /// The mark that was searched for last.
    mark: Vec<u8>,
}

impl Inbox {
    /// The bytes not read yet.
    pub(crate) fn waiting(&self) -> &[u8] {
        self.bytes.get(self.start..).unwrap_or_default()
    }

    /// How many more bytes there is room for.
    pub(crate) fn room(&self) -> usize {
        CAPACITY.saturating_sub(self.waiting().len())
    }

    /// Adds received bytes; the caller has checked that there is room.
    pub(crate) fn push(&mut self, bytes: &[u8]) {
        if self.start > 0 && self.start >= self.bytes.len() / 2 {
            self.bytes.drain(..self.start);
            self.start = 0;
        }
        self.bytes.extend_from_slice(bytes);
    }

    /// Takes exactly `count` bytes, once that many have arrived.
    pub(crate) fn take(&mut self, count: usize) -> Option<Vec<u8>> {
        let taken = self.waiting().get(..count)?.to_vec();
        self.drop_front(count);
        Some(taken)
    }

    /// Takes the bytes before the mark, once it has arrived, and drops the mark. An empty mark is found before
    /// everything.
    pub(crate) fn take_until(&mut self, mark: &[u8]) -> Option<Vec<u8>> {
        if self.mark != mark {
            self.mark.clear();
            self.mark.extend_from_slice(mark);
            self.searched = 0;
        }
        let waiting = self.waiting();
        let unknown = waiting.get(self.searched..).unwrap_or_default();
        match find(unknown, mark) {
            Some(at) => {
                let at = self.searched + at;
                let taken = waiting.get(..at)?.to_vec();
                self.drop_front(at + mark.len());
                Some(taken)
            }
            None => {
                // The last bytes may be the start of a mark whose rest has not arrived yet.
                self.searched = (waiting.len() + 1).saturating_sub(mark.len());
                None
            }
        }
    }

    /// Discards the bytes not read yet.
    pub(crate) fn clear(&mut self) {
        self.drop_front(self.waiting().len());
    }

    fn drop_front(&mut self, count: usize) {
        self.start += count;
        self.searched = 0;
        if self.start >= self.bytes.len() {
            // After a flood of bytes its memory is released.
            if self.bytes.capacity() > CAPACITY / 16 {
                self.bytes = Vec::new();
            }
            self.bytes.clear();
            self.start = 0;
        }
    }
}

/// The position of `mark` in `text`.
fn find(text: &[u8], mark: &[u8]) -> Option<usize> {
    let Some(first) = mark.first() else { return Some(0) };
    let mut from = 0;
    while let Some(at) = text.get(from..)?.iter().position(|byte| byte == first) {
        if text.get(from + at..)?.starts_with(mark) {
            return Some(from + at);
        }
        from += at + 1;
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exactly_so_many_bytes_are_taken() {
        let mut inbox = Inbox::default();
        inbox.push(b"hel");
        assert_eq!(inbox.take(5), None);
        inbox.push(b"lo!");
        assert_eq!(inbox.take(5).as_deref(), Some(&b"hello"[..]));
        assert_eq!(inbox.take(0), Some(Vec::new()));
        assert_eq!(inbox.waiting(), b"!");
        inbox.clear();
        assert_eq!((inbox.waiting(), inbox.room()), (&b""[..], CAPACITY));
    }

    #[test]
    fn marks_are_found_however_they_come_in_pieces() {
        let text = b"ab\r\r\nc\xff\xfe\r\n\r\nrest";
        for piece in 1..text.len() {
            let (mut inbox, mut lines) = (Inbox::default(), Vec::new());
            for bytes in text.chunks(piece) {
                inbox.push(bytes);
                while let Some(line) = inbox.take_until(b"\r\n") {
                    lines.push(line);
                }
            }
            assert_eq!(lines, [&b"ab\r"[..], b"c\xff\xfe", b""], "pieces of {piece}");
            assert_eq!(inbox.waiting(), b"rest");
        }
    }

    #[test]
    fn another_mark_is_looked_for_from_the_start() {
        let mut inbox = Inbox::default();
        inbox.push(b"a;b,c");
        assert_eq!(inbox.take_until(b"\n"), None);
        assert_eq!(inbox.take_until(b",").as_deref(), Some(&b"a;b"[..]));
        assert_eq!(inbox.take_until(b"").as_deref(), Some(&b""[..]));
        assert_eq!(inbox.take_until(b"c").as_deref(), Some(&b""[..]));
    }

    #[test]
    fn a_full_buffer_is_searched_once_only() {
        let mut inbox = Inbox::default();
        inbox.push(&vec![b'x'; CAPACITY]);
        assert_eq!((inbox.room(), inbox.take_until(b"xy")), (0, None));
        assert_eq!(inbox.searched, CAPACITY - 1);
    }
}
