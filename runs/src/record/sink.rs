//! The destination of a run's messages: a file, or code that shows them.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::io::{self, Seek, Write};

use mcap::records::MessageHeader;
use mcap::{Attachment, McapResult, WriteOptions, Writer};

use super::message::RunMessage;

/// A file is written in chunks that readers can look up, of at most so many bytes and ns of the run: this much is lost
/// if the run is cut off.
const CHUNK_BYTES: u64 = 1 << 20;
const CHUNK_TIME: u64 = 1_000_000_000;

/// Takes messages.
pub(crate) trait Sink {
    /// Takes a message at a time in ns.
    fn message(&mut self, time: u64, message: RunMessage) -> McapResult<()>;

    /// Takes notice that the run has reached a time in ns, with a message or without.
    fn reach(&mut self, _time: u64) -> McapResult<()> {
        Ok(())
    }

    /// Takes a text of the program.
    fn source(&mut self, name: &str, text: &str) -> McapResult<()>;

    /// Called once no more messages come.
    fn finish(&mut self) -> McapResult<()>;
}

/// An MCAP file.
pub(super) struct File<W: Write + Seek> {
    stage: Stage<W>,
    topics: BTreeMap<String, Topic>,
    /// When the messages that are not written yet are written at the latest, in ns of the run; `None`: there are none.
    chunk_due: Option<u64>,
    /// Whether a chunk was written. The first message is written at once, so that the file is that of its run.
    is_begun: bool,
}

enum Stage<W: Write + Seek> {
    /// Nothing was written; without a stream if it could not be begun.
    Waiting(Option<W>),
    Writing(Box<Writer<W>>),
}

struct Topic {
    id: u16,
    sequence: u32,
}

impl<W: Write + Seek> File<W> {
    /// A file that is begun with the first message.
    pub(super) fn new(stream: W) -> Self {
        Self { stage: Stage::Waiting(Some(stream)), topics: BTreeMap::new(), chunk_due: None, is_begun: false }
    }

    /// The writer, which begins the file.
    fn writer(&mut self) -> McapResult<&mut Writer<W>> {
        if let Stage::Waiting(stream) = &mut self.stage {
            let stream = stream.take().ok_or_else(|| io::Error::other("it could not be begun"))?;
            // Whole chunks are written, so that a file that is cut off can be read up to its last chunk.
            let options = WriteOptions::new().compression(None).disable_seeking(true);
            let options = options.chunk_size(Some(CHUNK_BYTES)).library("arl2rs");
            self.stage = Stage::Writing(Box::new(options.create(stream)?));
        }
        match &mut self.stage {
            Stage::Writing(writer) => Ok(writer),
            Stage::Waiting(_) => Err(io::Error::other("it could not be begun").into()),
        }
    }

    /// The channel of a topic, with one more message on it.
    fn topic(&mut self, message: &RunMessage) -> McapResult<(u16, u32)> {
        let topic = &*message.topic();
        if !self.topics.contains_key(topic) {
            let schema = message.schema();
            let writer = self.writer()?;
            let of = writer.add_schema(&schema.full_name(), "protobuf", &schema.descriptors())?;
            let id = writer.add_channel(of, topic, "protobuf", &BTreeMap::new())?;
            self.topics.insert(topic.to_owned(), Topic { id, sequence: 0 });
        }
        let known = self.topics.get_mut(topic).ok_or_else(|| io::Error::other("the topic is not known"))?;
        known.sequence = known.sequence.wrapping_add(1);
        Ok((known.id, known.sequence))
    }
}

impl<W: Write + Seek> Sink for File<W> {
    fn message(&mut self, time: u64, message: RunMessage) -> McapResult<()> {
        let (channel_id, sequence) = self.topic(&message)?;
        let header = MessageHeader { channel_id, sequence, log_time: time, publish_time: time };
        self.writer()?.write_to_known_channel(&header, &message.encoded())?;
        let wait = if std::mem::replace(&mut self.is_begun, true) { CHUNK_TIME } else { 0 };
        self.chunk_due.get_or_insert(time + wait);
        self.reach(time)
    }

    fn reach(&mut self, time: u64) -> McapResult<()> {
        match self.chunk_due {
            Some(due) if time >= due => {
                self.chunk_due = None;
                self.writer()?.flush()
            }
            _ => Ok(()),
        }
    }

    fn source(&mut self, name: &str, text: &str) -> McapResult<()> {
        // Without the time of the day, the same run gives the same file.
        self.writer()?.attach(&Attachment {
            log_time: 0,
            create_time: 0,
            name: name.to_owned(),
            media_type: "text/plain".to_owned(),
            data: Cow::Borrowed(text.as_bytes()),
        })
    }

    /// Writes the summary that readers use to find their way.
    fn finish(&mut self) -> McapResult<()> {
        self.writer()?.finish().map(drop)
    }
}
