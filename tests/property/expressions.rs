//! Random expressions give what an independent evaluator gives.

use crate::{Case, compare, first_seed, times};
use arl_tests::grow::linear;

#[test]
fn expressions_give_what_the_language_says() {
    let mut cases = Vec::new();
    for seed in first_seed()..first_seed() + 2 * times() {
        let (program, alarms) = linear(seed, 400);
        cases.extend(Case::new(seed, program));
        cases.extend(alarms.into_iter().take(40).filter_map(|program| Case::new(seed, program)));
    }
    compare("arl-property-expressions", &cases);
}
