//! Single bits of integers, and rotations.

use crate::fault::Fault;

fn mask(function: &'static str, pos: i32, width: u32) -> Result<u32, Fault> {
    match u32::try_from(pos) {
        Ok(at) if at < width => Ok(1 << at),
        _ => {
            let problem = format!("there is no bit {pos}, only bits 0 to {}", width - 1);
            Err(Fault::Domain { function, problem: problem.into() })
        }
    }
}

fn places(function: &'static str, n: i32, width: u32) -> Result<u32, Fault> {
    match u32::try_from(n) {
        Ok(places) => Ok(places % width),
        Err(_) => {
            let problem = format!("the number of places is {n}, but must be 0 or more");
            Err(Fault::Domain { function, problem: problem.into() })
        }
    }
}

macro_rules! bits {
    ($($ty:ty: $clear:ident $set:ident $check:ident $left:ident $right:ident)*) => { $(
        /// Sets bit `pos` to 0.
        ///
        /// # Errors
        /// [`Fault::Domain`] if the bit does not exist.
        pub fn $clear(data: &mut $ty, pos: i32) -> Result<(), Fault> {
            *data &= !(mask("bitclear", pos, <$ty>::BITS)? as $ty);
            Ok(())
        }

        /// Sets bit `pos` to 1.
        ///
        /// # Errors
        /// [`Fault::Domain`] if the bit does not exist.
        pub fn $set(data: &mut $ty, pos: i32) -> Result<(), Fault> {
            *data |= mask("bitset", pos, <$ty>::BITS)? as $ty;
            Ok(())
        }

        /// Whether bit `pos` is 1.
        ///
        /// # Errors
        /// [`Fault::Domain`] if the bit does not exist.
        pub fn $check(data: $ty, pos: i32) -> Result<bool, Fault> {
            Ok(data & mask("bitcheck", pos, <$ty>::BITS)? as $ty != 0)
        }

        /// Rotates the bits to the left; `n` wraps at the width.
        ///
        /// # Errors
        /// [`Fault::Domain`] for a negative `n`.
        pub fn $left(data: $ty, n: i32) -> Result<$ty, Fault> {
            Ok(data.rotate_left(places("bitlcs", n, <$ty>::BITS)?))
        }

        /// Rotates the bits to the right; `n` wraps at the width.
        ///
        /// # Errors
        /// [`Fault::Domain`] for a negative `n`.
        pub fn $right(data: $ty, n: i32) -> Result<$ty, Fault> {
            Ok(data.rotate_right(places("bitrcs", n, <$ty>::BITS)?))
        }
    )* };
}

bits! {
    u8: bitclear_byte bitset_byte bitcheck_byte bitlcs_byte bitrcs_byte
    i32: bitclear_int bitset_int bitcheck_int bitlcs_int bitrcs_int
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_manuals_examples() {
        let (mut byte, mut int) = (0b1111, 15);
        bitclear_byte(&mut byte, 2).unwrap();
        bitclear_int(&mut int, 2).unwrap();
        assert_eq!((byte, int), (0x0b, 11));
        let (mut byte, mut int) = (0b1000, 8);
        bitset_byte(&mut byte, 2).unwrap();
        bitset_int(&mut int, 2).unwrap();
        assert_eq!((byte, int), (0x0c, 12));
        assert_eq!(bitcheck_byte(0b1000, 2), Ok(false));
        assert_eq!(bitcheck_int(8, 3), Ok(true));
        assert_eq!(bitlcs_byte(0b1100_0000, 2), Ok(0x03));
        assert_eq!(bitlcs_byte(0b1100_0000, 1), Ok(0x81));
        assert_eq!(bitrcs_byte(0b0000_0011, 2), Ok(0xc0));
        assert_eq!(bitrcs_byte(0b0000_0011, 1), Ok(0x81));
    }

    #[test]
    fn edges() {
        let mut int = 0;
        bitset_int(&mut int, 31).unwrap();
        assert_eq!(int, i32::MIN);
        assert_eq!(bitcheck_int(int, 31), Ok(true));
        assert_eq!(bitlcs_int(int, 1), Ok(1));
        assert_eq!(bitrcs_int(1, 33), Ok(i32::MIN));
        assert_eq!(bitlcs_byte(0x12, 8), Ok(0x12));
        assert_eq!(bitset_byte(&mut 0, 8).unwrap_err().to_string(), "bitset: there is no bit 8, only bits 0 to 7");
        assert!(bitclear_int(&mut int, 32).is_err());
        assert!(bitcheck_int(int, -1).is_err());
        assert_eq!(
            bitlcs_int(1, -1).unwrap_err().to_string(),
            "bitlcs: the number of places is -1, but must be 0 or more"
        );
        assert!(bitrcs_byte(1, -1).is_err());
    }
}
