//! The receive buffer of a connection: what has come and was not read yet.

/// How many bytes wait at most, in each direction of a connection.
pub(crate) const CAPACITY: usize = 1 << 20;

/// What has come from the other side and was not read yet: bytes in their order, bounded by [`CAPACITY`].
#[derive(Default, Debug)]
pub(crate) struct Inbox {
    bytes: Vec<u8>,
    /// Where what is left begins in `bytes`.
    start: usize,
    /// How many of the bytes that are left are known not to be the start of `mark`.
    searched: usize,
    /// What was searched for last.
    mark: Vec<u8>,
}

impl Inbox {
    /// The bytes that wait.
    pub(crate) fn waiting(&self) -> &[u8] {
        self.bytes.get(self.start..).unwrap_or_default()
    }

    /// How many bytes have room.
    pub(crate) fn room(&self) -> usize {
        CAPACITY.saturating_sub(self.waiting().len())
    }

    /// Adds what came; the caller has looked for room.
    pub(crate) fn push(&mut self, bytes: &[u8]) {
        if self.start > 0 && self.start >= self.bytes.len() / 2 {
            self.bytes.drain(..self.start);
            self.start = 0;
        }
        self.bytes.extend_from_slice(bytes);
    }

    /// Takes exactly so many bytes, when so many have come.
    pub(crate) fn take(&mut self, count: usize) -> Option<Vec<u8>> {
        let taken = self.waiting().get(..count)?.to_vec();
        self.drop_front(count);
        Some(taken)
    }

    /// Takes what stands in front of the mark, when it has come; the mark goes, too. An empty mark stands in front of
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
                // The last bytes may be the start of a mark whose rest is still to come.
                self.searched = (waiting.len() + 1).saturating_sub(mark.len());
                None
            }
        }
    }

    /// Throws away what waits.
    pub(crate) fn clear(&mut self) {
        self.drop_front(self.waiting().len());
    }

    fn drop_front(&mut self, count: usize) {
        self.start += count;
        self.searched = 0;
        if self.start >= self.bytes.len() {
            // A flood has been: its memory is given back.
            if self.bytes.capacity() > CAPACITY / 16 {
                self.bytes = Vec::new();
            }
            self.bytes.clear();
            self.start = 0;
        }
    }
}

/// Where `mark` begins in `text`.
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
