//! Random programs do what an independent interpreter does.

use crate::{Case, compare, first_seed, times};
use arl_tests::grow::{Shape, program};

#[test]
fn programs_do_what_the_language_says() {
    let mut cases = Vec::new();
    let mut seed = first_seed();
    while cases.len() < 60 * times() as usize {
        seed += 1;
        let risk = if seed.is_multiple_of(4) { 3 } else { 0 };
        let shape = Shape { risk, jumps: seed.is_multiple_of(2), waits: seed.is_multiple_of(3) };
        cases.extend(program(seed, shape).and_then(|program| Case::new(seed, program)));
    }
    compare("arl-property-programs", &cases);
}
