//! Two runs compared with each other, and one as a page.

use super::compare::Differences;
use super::html;
use super::summary::{OfChannel, OfContact, OfLine, OfSignal, Summary, TimedText};

fn line(line: u32, moving: f64, standing: f64, way: f64) -> OfLine {
    OfLine {
        file: "a.arl".into(),
        line,
        moving,
        standing,
        way,
        motions: 1,
        kinds: vec!["lin".into()],
        ..OfLine::default()
    }
}

fn run() -> Summary {
    let timed = |text: &str| TimedText { time: 1.0, text: text.into() };
    let lines = vec![line(3, 1.0, 0.0, 100.0), line(4, 0.0, 0.5, 0.0)];
    let channel =
        OfChannel { channel: 1, program: "a.arl".into(), state: "ended".into(), lines, ..OfChannel::default() };
    let signal = OfSignal { signal: "do.1".into(), changes: 2, on: 0.5, ..OfSignal::default() };
    Summary {
        version: 1,
        time: 1.5,
        channels: vec![channel],
        signals: vec![signal],
        messages: vec![timed("one"), timed("two")],
        ..Summary::default()
    }
}

#[test]
fn the_same_run_does_not_differ() {
    let differences = Differences::between(&run(), &run());
    assert!(differences.is_empty());
    assert_eq!(differences.to_string(), "nothing differs: 1.500 s\n");
}

#[test]
fn what_differs_is_reported_by_line_and_in_words() {
    let mut now = run();
    now.time = 1.7;
    now.channels[0].state = "alarm".into();
    now.channels[0].lines = vec![line(3, 1.2, 0.0, 150.0), line(9, 0.0, 0.5, 0.0)];
    now.signals[0].changes = 3;
    now.messages[1].text = "three".into();
    now.alarms.push(TimedText { time: 1.0, text: "alarm 20001".into() });
    now.contacts.push(OfContact { one: "arm 1".into(), other: "post".into(), ..OfContact::default() });
    let text = Differences::between(&run(), &now).to_string();
    assert_eq!(
        text.lines().collect::<Vec<_>>(),
        [
            "the run took 1.500 s, now 1.700 s (+0.200 s, +13.3 %)",
            "state at the end of channel 1: `ended` became `alarm`",
            "message 2: `two` became `three`",
            "alarm 1 is new: `alarm 20001`",
            "do.1 changed 2 times, now 3 times",
            "arm 1 now comes near post",
            "line       before s       now s        by s     way by mm",
            "a.arl:3       1.000       1.200      +0.200       +50.000",
            "a.arl:4       0.500           -      -0.500",
            "a.arl:9           -       0.500      +0.500",
        ]
    );
}

#[test]
fn a_pair_that_touches_more_often_is_reported() {
    let contact = || OfContact { one: "arm 1".into(), other: "post".into(), ..OfContact::default() };
    let of = |times: usize| Summary { contacts: vec![contact(); times], ..run() };
    let text = |before, now| Differences::between(&of(before), &of(now)).to_string();
    assert!(text(3, 1).contains("arm 1 came near post 3 times, now once"), "{}", text(3, 1));
    assert!(text(3, 0).contains("arm 1 no longer comes near post"));
    assert_eq!(text(2, 2), "nothing differs: 1.500 s\n");
}

#[test]
fn a_report_is_read_as_it_was_written() {
    let text = serde_json::to_string(&run()).unwrap();
    assert_eq!(serde_json::from_str::<Summary>(&text).unwrap(), run());
}

#[test]
fn texts_of_a_page_are_no_markup() {
    let mut run = run();
    run.messages[0].text = "<script>&\"".into();
    let page = html::page(&run);
    assert!(page.contains("&lt;script&gt;&amp;&quot;") && !page.contains("<script>"), "{page}");
    assert!(page.contains("a.arl:3") && page.contains("do.1"));
}
