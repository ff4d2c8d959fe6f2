//! Reads a recording. A recording that is cut off is read as far as it goes.

use std::collections::HashMap;
use std::io::Read;
use std::path::Path;

use arl_robot::regular_file;
use mcap::McapError;
use mcap::records::Record;
use mcap::sans_io::{LinearReadEvent, LinearReader, LinearReaderOptions};

use super::store::Store;
use crate::texts::Text;
use arl_terminal::failure::Failure;
use arl_terminal::show;

/// The greatest length of a record, in bytes; no record is longer than its file either, whatever length it states.
const LONGEST_RECORD: usize = 1 << 30;

/// Each record begins with its kind and its length.
const RECORD_HEAD: usize = 1 + 8;

/// Reads the run of a recording; says where its end is missing.
///
/// # Errors
/// The file does not exist, or is not a recording of a run.
pub(crate) fn read(path: &Path) -> Result<Store, Failure> {
    let cannot = |error: std::io::Error| Failure::io("read", path, &error);
    let mut file = regular_file::expect(path).and_then(|()| std::fs::File::open(path)).map_err(cannot)?;
    let size = file.metadata().map_err(cannot)?.len();
    let store = of(&mut file, size)
        .map_err(|why| Failure::Other(format!("{} is not a recording of a run: {why}", path.display())))?;
    if let Some(problem) = &store.problem {
        show::warning(&format!("{}: {problem}", path.display()));
    }
    Ok(store)
}

/// Reads the run of a recording of `size` bytes.
///
/// # Errors
/// It is not a recording of a run.
pub(crate) fn of(file: &mut impl Read, size: u64) -> Result<Store, String> {
    let mut store = Store::default();
    let mut reading = Reading { store: &mut store, topics: HashMap::new() };
    let problem = reading.read_all(file, size).err();
    if store.cell.channels.is_empty() {
        return Err(problem.unwrap_or_else(|| "it has no data about robots or programs (topic /arl/cell)".to_owned()));
    }
    store.problem = problem.map(|why| format!("the recording ends after {:.3} s: {why}", store.end));
    Ok(store)
}

/// Why a file cannot be read any further.
fn broken(error: &McapError) -> String {
    match error {
        McapError::UnexpectedEof | McapError::RecordTooLarge { .. } => "the rest is missing".to_owned(),
        error => error.to_string(),
    }
}

/// The record with this kind and content.
fn parsed(opcode: u8, data: &[u8]) -> Result<Record<'_>, String> {
    // The library takes for granted that there is room for a checksum behind the head of an attachment.
    if opcode == mcap::records::op::ATTACHMENT && !has_room_for_checksum(data) {
        return Err("an attachment is shorter than it says".to_owned());
    }
    mcap::parse_record(opcode, data).map_err(|error| error.to_string())
}

/// Whether an attachment has 4 bytes behind its head: two times, name and type, each with its length, and the length of
/// the content.
fn has_room_for_checksum(data: &[u8]) -> bool {
    let rest = |data: &'_ [u8]| -> Option<usize> {
        let mut rest = data.get(2 * size_of::<u64>()..)?;
        for _ in 0..2 {
            let (length, behind) = rest.split_first_chunk::<{ size_of::<u32>() }>()?;
            rest = behind.get(usize::try_from(u32::from_le_bytes(*length)).ok()?..)?;
        }
        Some(rest.len())
    };
    rest(data).is_some_and(|rest| rest >= size_of::<u64>() + size_of::<u32>())
}

/// A file that is being read.
struct Reading<'a> {
    store: &'a mut Store,
    topics: HashMap<u16, String>,
}

impl Reading<'_> {
    fn read_all(&mut self, file: &mut impl Read, size: u64) -> Result<(), String> {
        let longest = usize::try_from(size).unwrap_or(usize::MAX).min(LONGEST_RECORD);
        let options = LinearReaderOptions::default().with_record_length_limit(longest).with_emit_chunks(true);
        let mut reader = LinearReader::new_with_options(options);
        while let Some(event) = reader.next_event() {
            match event.map_err(|error| broken(&error))? {
                LinearReadEvent::ReadRequest(wanted) => {
                    let read = file.read(reader.insert(wanted)).map_err(|error| error.to_string())?;
                    reader.notify_read(read);
                }
                LinearReadEvent::Record { data, opcode } => match parsed(opcode, data)? {
                    Record::Chunk { header, data } => self.chunk(&header.compression, &data)?,
                    record => self.record(record)?,
                },
            }
        }
        Ok(())
    }

    /// Reads the records of a chunk. None of them reaches beyond it, whatever length it states.
    fn chunk(&mut self, compression: &str, mut rest: &[u8]) -> Result<(), String> {
        if !compression.is_empty() {
            return Err(format!(
                "it is compressed with {compression}, which is not supported: save it without compression"
            ));
        }
        while let Some((head, behind)) = rest.split_first_chunk::<RECORD_HEAD>() {
            let [opcode, length @ ..] = *head;
            let length = usize::try_from(u64::from_le_bytes(length)).unwrap_or(usize::MAX);
            let Some((data, behind)) = behind.split_at_checked(length) else { break };
            self.record(parsed(opcode, data)?)?;
            rest = behind;
        }
        if rest.is_empty() { Ok(()) } else { Err("a record reaches beyond its chunk".to_owned()) }
    }

    fn record(&mut self, record: Record<'_>) -> Result<(), String> {
        match record {
            Record::Channel(channel) => {
                self.topics.insert(channel.id, channel.topic);
            }
            Record::Message { header, data } => {
                if let Some(topic) = self.topics.get(&header.channel_id) {
                    let taken = self.store.take(topic, header.log_time, &data);
                    taken.map_err(|error| format!("a message of {topic} cannot be read ({error})"))?;
                }
            }
            Record::Attachment { header, data, .. } if header.media_type.starts_with("text/") => {
                let text = String::from_utf8_lossy(&data).into_owned();
                self.store.sources.push(Text { name: header.name, text });
            }
            _ => {}
        }
        Ok(())
    }
}
