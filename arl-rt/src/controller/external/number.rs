//! Decodes a row of inputs as a program number.

/// The number that `bits` stand for in this coding (`$PGNO_TYPE`); the lowest bit is the first input's.
///
/// # Errors
/// The bits are not a number; the error, as a part of a sentence.
pub(super) fn decode(coding: i32, bits: u32, length: u32) -> Result<i32, String> {
    match coding {
        1 => bcd(bits, length),
        2 => one_out_of(bits, length),
        _ => Ok(bits.cast_signed()),
    }
}

/// Decodes BCD: four inputs per digit.
fn bcd(bits: u32, length: u32) -> Result<i32, String> {
    if !length.is_multiple_of(4) {
        return Err(format!("$PGNO_LENGTH is {length}, but for BCD it must be 4, 8, 12 or 16"));
    }
    let mut number = 0;
    for digit in (0..length / 4).rev().map(|place| bits >> (4 * place) & 15) {
        if digit > 9 {
            return Err(format!("{digit:04b} is not a BCD digit, which goes from 0000 to 1001"));
        }
        number = 10 * number + digit.cast_signed();
    }
    Ok(number)
}

/// Decodes one input per number.
fn one_out_of(bits: u32, length: u32) -> Result<i32, String> {
    match bits.count_ones() {
        1 => Ok(bits.trailing_zeros().cast_signed()),
        count => Err(format!("{count} of its {length} inputs are on, but exactly 1 of {length} must be")),
    }
}

/// Whether the number of inputs that are on, including the parity input, is odd or even as it should be.
pub(super) fn parity_fits(bits: u32, parity: bool, odd: bool) -> bool {
    (bits.count_ones() + u32::from(parity)) % 2 == u32::from(odd)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_examples_of_the_manual() {
        assert_eq!(decode(0, 0b0000_0111, 8), Ok(7));
        assert_eq!(decode(1, 0b0001_0100, 8), Ok(14));
        assert_eq!(decode(2, 0b0000_0001, 8), Ok(0));
        assert_eq!(decode(2, 0b0_0001_0000, 9), Ok(4));
    }

    #[test]
    fn all_numbers_of_all_lengths() {
        for length in 1..=16 {
            assert_eq!(decode(0, (1 << length) - 1, length), Ok((1 << length) - 1));
            assert_eq!(decode(2, 1 << (length - 1), length), Ok(length.cast_signed() - 1));
            assert!(decode(2, 0, length).unwrap_err().contains("0 of its"));
        }
        for number in 0..10_000_u32 {
            let digits = number.to_string().chars().fold(0, |bits, digit| bits << 4 | digit.to_digit(10).unwrap());
            assert_eq!(decode(1, digits, 16), Ok(number.cast_signed()));
        }
    }

    #[test]
    fn what_is_no_number_says_why() {
        assert!(decode(1, 0b1010, 4).unwrap_err().contains("1010 is not a BCD digit"));
        assert!(decode(1, 0b1100_0001, 8).unwrap_err().contains("1100 is not a BCD digit"));
        assert!(decode(1, 1, 5).unwrap_err().contains("$PGNO_LENGTH is 5"));
        assert!(decode(2, 0b11, 4).unwrap_err().contains("2 of its 4 inputs are on"));
    }

    #[test]
    fn parity_counts_the_inputs_that_are_on() {
        for (bits, parity, odd) in [(0b0, false, false), (0b1, true, false), (0b11, false, false), (0b11, true, true)] {
            assert!(parity_fits(bits, parity, odd));
            assert!(!parity_fits(bits, !parity, odd));
            assert!(!parity_fits(bits, parity, !odd));
        }
    }
}
