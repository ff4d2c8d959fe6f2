//! Doubles print as C prints them: against a table that another implementation made (`data/general_format.py`).

use arl_rt::values::text::{Print, Style};

#[test]
fn doubles_print_as_in_c() {
    let table = include_str!("data/general_format.txt");
    let mut count = 0;
    for line in table.lines() {
        let mut columns = line.split(' ');
        let mut column = || columns.next().unwrap();
        let value = f64::from_bits(u64::from_str_radix(column(), 16).unwrap());
        let precision = column().parse().unwrap();
        let expected = column();
        let text = value.printed(&Style { precision, base: None });
        let expected = if expected == "-0" { "0" } else { expected };
        assert_eq!(text, expected, "{line}");
        count += 1;
    }
    assert!(count > 5000);
}
