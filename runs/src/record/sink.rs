//! The destination of a run's messages: a file, or code that shows them.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::io::{Seek, Write};

use mcap::records::MessageHeader;
use mcap::{Attachment, McapResult, WriteOptions, Writer};

use super::message::RunMessage;

/// The bytes that a file gathers before they are written as one chunk that readers can look up: this much is lost if a
/// run is cut off.
const CHUNK_BYTES: u64 = 1 << 20;

/// Takes messages.
pub(crate) trait Sink {
    /// Takes a message at a time in ns.
    fn message(&mut self, time: u64, message: RunMessage) -> McapResult<()>;

    /// Takes a text of the program.
    fn source(&mut self, name: &str, text: &str) -> McapResult<()>;

    /// Called once no more messages come.
    fn finish(&mut self) -> McapResult<()>;
}

/// An MCAP file.
pub(super) struct File<W: Write + Seek> {
    writer: Writer<W>,
    topics: BTreeMap<String, Topic>,
}

struct Topic {
    id: u16,
    sequence: u32,
}

impl<W: Write + Seek> File<W> {
    /// An empty file.
    pub(super) fn new(stream: W) -> McapResult<Self> {
        let options = WriteOptions::new().compression(None).chunk_size(Some(CHUNK_BYTES)).library("arl2rs");
        Ok(Self { writer: options.create(stream)?, topics: BTreeMap::new() })
    }
}

impl<W: Write + Seek> Sink for File<W> {
    fn message(&mut self, time: u64, message: RunMessage) -> McapResult<()> {
        let topic = &*message.topic();
        if !self.topics.contains_key(topic) {
            let schema = message.schema();
            let of = self.writer.add_schema(&schema.full_name(), "protobuf", &schema.descriptors())?;
            let id = self.writer.add_channel(of, topic, "protobuf", &BTreeMap::new())?;
            self.topics.insert(topic.to_owned(), Topic { id, sequence: 0 });
        }
        let Some(known) = self.topics.get_mut(topic) else { return Ok(()) };
        known.sequence = known.sequence.wrapping_add(1);
        let header =
            MessageHeader { channel_id: known.id, sequence: known.sequence, log_time: time, publish_time: time };
        self.writer.write_to_known_channel(&header, &message.encoded())
    }

    fn source(&mut self, name: &str, text: &str) -> McapResult<()> {
        // Without the time of the day, the same run gives the same file.
        self.writer.attach(&Attachment {
            log_time: 0,
            create_time: 0,
            name: name.to_owned(),
            media_type: "text/plain".to_owned(),
            data: Cow::Borrowed(text.as_bytes()),
        })
    }

    /// Writes the summary that readers use to find their way.
    fn finish(&mut self) -> McapResult<()> {
        self.writer.finish().map(drop)
    }
}
