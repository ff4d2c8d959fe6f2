//! Entry points for `fuzz/` to internal code that reads bytes from outside. Each panics where something is wrong.

use crate::builtins::communication::melsec_answer;
use crate::communication::Inbox;
use crate::fieldbus::modbus::rtu::ReceiveBuffer;
use crate::fieldbus::modbus::{Tables, client, mbap, pdu};
use crate::storage::data::{DataFile, teach_file};
use arl_robot::islands::Table;

/// What a client sends to the Modbus TCP server: each frame is served, and its answer fits into a frame.
pub fn modbus_tcp(mut bytes: &[u8]) {
    let (mut tables, mut answer, mut out) = (Tables::default(), pdu::Answer::new(), Vec::new());
    while let mbap::Received::Frame(frame, size) = mbap::first(bytes) {
        assert!(size <= mbap::LONGEST_FRAME && !frame.pdu.is_empty());
        pdu::serve(frame.pdu, &mut tables, &mut answer);
        assert!((2..=pdu::LONGEST).contains(&answer.bytes().len()));
        out.clear();
        mbap::append(&mut out, &mbap::ModbusFrame { pdu: answer.bytes(), ..frame });
        assert!(matches!(mbap::first(&out), mbap::Received::Frame(_, size) if size == out.len()));
        bytes = bytes.get(size..).unwrap_or_default();
    }
}

/// What an island answers to a request for `count` coils or registers: the data that is taken from it has their size.
pub fn island(table: u8, count: u16, bytes: &[u8]) {
    let tables = [Table::Coil, Table::DiscreteInput, Table::HoldingRegister, Table::InputRegister];
    let table = tables.get(usize::from(table % 4)).copied().unwrap_or(Table::Coil);
    let count = usize::from(count) % client::most_read(table) + 1;
    let mut request = Vec::new();
    client::read_request(&mut request, table, 0, count as u16);
    if let mbap::Received::Frame(frame, _) = mbap::first(bytes)
        && let Ok(data) = client::read_answer(table, request.first().copied().unwrap_or_default(), count, frame.pdu)
    {
        assert_eq!(data.len(), client::size(table, count));
    }
}

/// What arrives over the line of a Modbus RTU slave, in pieces, some of them after a silence.
pub fn modbus_rtu(pieces: &[(bool, &[u8])]) {
    let (mut buffer, mut tables, mut answer) = (ReceiveBuffer::default(), Tables::default(), pdu::Answer::new());
    for (after_silence, piece) in pieces {
        buffer.push(piece, *after_silence);
        while let Some(request) = buffer.take() {
            pdu::serve(&request.pdu, &mut tables, &mut answer);
            assert!((2..=pdu::LONGEST).contains(&answer.bytes().len()));
        }
    }
}

/// What a PLC answers over the MC protocol.
pub fn melsec(mut bytes: &[u8]) {
    while let Some(size) = melsec_answer(bytes) {
        assert!(size > 0 && size <= bytes.len());
        bytes = bytes.get(size..).unwrap_or_default();
    }
}

/// What arrives over a socket, in pieces, while a program reads up to a mark: what is taken, the marks and what is left
/// are together all that arrived.
pub fn read_until(mark: &[u8], pieces: &[&[u8]]) {
    if mark.is_empty() {
        return;
    }
    let (mut inbox, mut came, mut taken) = (Inbox::default(), Vec::new(), Vec::new());
    for piece in pieces {
        inbox.push(piece);
        came.extend_from_slice(piece);
        while let Some(text) = inbox.take_until(mark) {
            assert!(!text.windows(mark.len()).any(|window| window == mark));
            taken.extend_from_slice(&text);
            taken.extend_from_slice(mark);
        }
        assert!(!inbox.waiting().windows(mark.len()).any(|window| window == mark));
    }
    taken.extend_from_slice(inbox.waiting());
    assert_eq!(taken, came);
}

/// The content of a data file that was edited by hand.
pub fn data_file(data: &DataFile<'_>, content: &[u8]) {
    for alarm in teach_file(data, content) {
        assert!(!alarm.to_string().is_empty());
    }
}
