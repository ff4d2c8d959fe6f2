//! The page of the alarms lists every number that the runtime raises, and no other.

#![allow(clippy::unwrap_used, reason = "a test")]

use std::collections::BTreeSet;

/// The numbers in `Fault::number`.
fn raised() -> Vec<u32> {
    let source = include_str!("../src/fault.rs");
    let body = source.split_once("pub fn number(&self)").unwrap().1;
    let body = body.split_once("impl fmt::Display for Fault").unwrap().0;
    let right_sides = body.lines().filter_map(|line| line.split_once("=> "));
    right_sides.filter_map(|(_, number)| number.trim_end_matches(',').parse().ok()).collect()
}

/// The rows of the table, cells without blanks around them.
fn rows() -> Vec<Vec<String>> {
    let page = include_str!("../../transpiler/docs/alarms.md");
    let lines = page.lines().filter(|line| line.starts_with("| ") && !line.starts_with("| number"));
    lines.map(|line| line.trim_matches('|').split('|').map(|cell| cell.trim().to_string()).collect()).collect()
}

#[test]
fn every_alarm_is_on_the_page() {
    let listed: Vec<u32> = rows().iter().map(|row| row[0].parse().unwrap()).collect();
    assert!(listed.windows(2).all(|pair| pair[0] < pair[1]), "the rows ascend: {listed:?}");
    let raised = raised();
    assert!(raised.len() > 10, "the numbers are found in the source: {raised:?}");
    assert_eq!(raised.iter().copied().collect::<BTreeSet<_>>(), listed.into_iter().collect());
}

#[test]
fn every_alarm_has_a_cause_and_a_remedy() {
    for row in rows() {
        assert_eq!(row.len(), 4, "{row:?}");
        assert!(row.iter().all(|cell| !cell.is_empty()), "{row:?}");
    }
}

#[test]
fn the_example_is_what_the_runtime_says() {
    let fault = arl_rt::fault::Fault::Index { index: 5, size: 5 };
    let alarm = arl_rt::fault::Alarm::new(fault, arl_rt::fault::File::new("stack.arl"), 12);
    assert!(include_str!("../../transpiler/docs/alarms.md").contains(&format!("\n{alarm}\n")));
}
