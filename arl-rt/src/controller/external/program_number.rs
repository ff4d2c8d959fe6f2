//! The program number that a PLC gives.

use super::edge_detector::EdgeDetector;
use super::number;
use crate::context::system::System;
use crate::fault::Fault;
use crate::io::Image;

/// The `$PGNO_TYPE` with one input per number, which has no parity.
const ONE_OUT_OF: i32 = 2;

/// The program number that a PLC gives.
#[derive(Debug, Default)]
pub(super) struct ProgramNumber {
    valid: EdgeDetector,
    /// The inputs of the number that was taken over last, lowest bit first.
    taken: u32,
}

impl ProgramNumber {
    /// Takes the number over when the PLC signals that it is valid.
    ///
    /// # Errors
    /// The inputs are not a valid number. `$PGNO` keeps its value then.
    pub(super) fn listen(&mut self, io: &Image, system: &System, cycle: u64, active: bool) -> Result<(), Fault> {
        if !self.valid.look(io, system.pgno_valid_di.get(), cycle, active).rises {
            return Ok(());
        }
        self.taken = 0;
        let (bits, number) = read(io, system).map_err(|problem| Fault::ProgramNumber(problem.into()))?;
        system.pgno.set(number);
        self.taken = bits;
        Ok(())
    }

    /// The inputs of the number that was taken over, as the acknowledgement outputs repeat them.
    pub(super) fn taken(&self) -> u32 {
        self.taken
    }
}

/// Reads the inputs of the number, and decodes them.
fn read(io: &Image, system: &System) -> Result<(u32, i32), String> {
    let (first, length) = (system.pgno_fbit_di.get(), system.pgno_length.get());
    let last = first.saturating_add(length - 1);
    let mut bits = 0;
    for (place, channel) in (first..=last).enumerate() {
        match io.input(channel) {
            Some(on) => bits |= u32::from(on) << place,
            None => {
                let count = io.inputs().len();
                return Err(format!(
                    "the program number is wired to DI {first} to {last} ($PGNO_FBIT_DI, $PGNO_LENGTH), but the cell has DI 1 \
                     to {count}"
                ));
            }
        }
    }
    let (coding, length) = (system.pgno_type.get(), length.cast_unsigned());
    let what = format!("the program number at DI {first} to {last}, {bits:0width$b}", width = length as usize);
    let parity = system.pgno_parity_di.get();
    let parity_input = if coding == ONE_OUT_OF { None } else { io.input(parity.saturating_abs()) };
    if let Some(on) = parity_input {
        let odd = parity < 0;
        if !number::parity_fits(bits, on, odd) {
            let (kind, channel) = (if odd { "odd" } else { "even" }, parity.saturating_abs());
            let level = if on { "on" } else { "off" };
            return Err(format!("{what}, does not have {kind} parity: DI {channel} is {level}"));
        }
    }
    let number = number::decode(coding, bits, length).map_err(|problem| format!("{what}, is not valid: {problem}"))?;
    Ok((bits, number))
}
