//! The registers and coils that a Modbus server offers.

/// The number of registers, and of coils: all that the protocol can address.
pub(crate) const SIZE: usize = 1 << 16;

/// Holding registers and coils. Both are kept as transmitted on the wire: registers with their high byte first, coils
/// with the lowest bit of a byte first.
pub(crate) struct Tables {
    registers: Box<[u8]>,
    coils: Box<[u8]>,
}

impl Default for Tables {
    fn default() -> Self {
        Self { registers: vec![0; 2 * SIZE].into(), coils: vec![0; SIZE / 8].into() }
    }
}

impl Tables {
    /// The bytes of `count` registers from `start` on; `None` unless all of them exist.
    pub(crate) fn registers(&self, start: usize, count: usize) -> Option<&[u8]> {
        self.registers.get(start.checked_mul(2)?..start.checked_add(count)?.checked_mul(2)?)
    }

    /// The bytes of `count` registers from `start` on, for writing; `None` unless all of them exist.
    pub(crate) fn registers_mut(&mut self, start: usize, count: usize) -> Option<&mut [u8]> {
        self.registers.get_mut(start.checked_mul(2)?..start.checked_add(count)?.checked_mul(2)?)
    }

    /// Packs `count` coils from `start` on into bytes, the surplus bits 0. `None` unless all of them exist and fit.
    #[must_use]
    pub(crate) fn read_coils(&self, start: usize, count: usize, into: &mut [u8]) -> Option<()> {
        let end = start.checked_add(count).filter(|end| *end <= SIZE)?;
        let into = into.get_mut(..count.div_ceil(8))?;
        into.fill(0);
        for (at, coil) in (start..end).enumerate() {
            let on = self.coils.get(coil / 8)? >> (coil % 8) & 1;
            *into.get_mut(at / 8)? |= on << (at % 8);
        }
        Some(())
    }

    /// Sets `count` coils from `start` on to the bits of `from`. `None`, and nothing is set, unless all of them exist
    /// and `from` has enough bits.
    #[must_use]
    pub(crate) fn write_coils(&mut self, start: usize, count: usize, from: &[u8]) -> Option<()> {
        let end = start.checked_add(count).filter(|end| *end <= SIZE)?;
        let from = from.get(..count.div_ceil(8))?;
        for (at, coil) in (start..end).enumerate() {
            let on = from.get(at / 8)? >> (at % 8) & 1;
            let byte = self.coils.get_mut(coil / 8)?;
            *byte = *byte & !(1 << (coil % 8)) | on << (coil % 8);
        }
        Some(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coils_are_packed_from_their_first() {
        let mut tables = Tables::default();
        tables.write_coils(100, 16, &[1, 2]).unwrap();
        let mut bytes = [0xff; 3];
        tables.read_coils(100, 16, &mut bytes).unwrap();
        assert_eq!(bytes, [1, 2, 0xff]);
        tables.read_coils(97, 13, &mut bytes).unwrap();
        assert_eq!(bytes[..2], [0b0000_1000, 0b0001_0000]);
        tables.write_coils(101, 3, &[0xff]).unwrap();
        tables.read_coils(96, 24, &mut bytes).unwrap();
        assert_eq!(bytes, [0b1111_0000, 0b0010_0000, 0]);
    }

    #[test]
    fn the_last_ones_are_there_and_no_more() {
        let mut tables = Tables::default();
        let mut byte = [0];
        assert!(tables.registers(65535, 1).is_some() && tables.registers(65535, 2).is_none());
        assert!(tables.registers_mut(usize::MAX, 1).is_none());
        assert!(tables.write_coils(65528, 8, &[0x80]).is_some());
        assert!(tables.read_coils(65535, 1, &mut byte).is_some() && byte == [1]);
        assert!(tables.read_coils(65535, 2, &mut byte).is_none());
        assert!(tables.write_coils(0, 9, &[0]).is_none(), "too few bits");
        assert!(tables.read_coils(0, 9, &mut byte).is_none(), "too little room");
    }
}
