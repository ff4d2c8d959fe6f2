//! Serial lines.

use std::cell::Cell;
use std::io::Write;
use std::rc::Rc;
use std::time::{Duration, Instant};

use arl_rt::emit::*;
use arl_rt::{Controller, Outcome};

use crate::common::{FILE, say};
use crate::manners::{Manner, until_it_goes};
use crate::terminal::{Outlet, Plug};
use crate::watch::{Robot, TIMES, again_and_again, watched};

const QUESTION: Str = Str::literal("question\n");
const ANSWER: &[u8] = b"the whole message\n";

async fn open(cx: &Cx, line: &Iodev, name: &Str) -> Done<bool> {
    serial::open(cx, line, name, 115_200, 8, Stopbits::One, Parity::None).await.at(FILE, 1)
}

/// Asks, and prints what comes back in so many cycles, if it is a line.
async fn ask(cx: &Cx, line: &Iodev, patience: u64) -> Done<()> {
    let mut answer = Str::literal("-");
    serial::write_string(cx, line, &QUESTION).await.at(FILE, 2)?;
    let until = cx.cycle() + patience;
    while cx.cycle() < until && !serial::readuntil(cx, line, &mut answer, &Str::literal("\n")).await.at(FILE, 3)? {
        cx.next_cycle().await;
    }
    say(cx, &answer)
}

/// Answers the next question as it should.
fn behave(mut plug: Plug) {
    let mut asked = Vec::new();
    while asked.len() < QUESTION.as_bytes().len() {
        asked.extend(plug.hears());
    }
    plug.write_all(ANSWER).unwrap();
    until_it_goes(plug);
}

/// Runs a program that asks on a line of this manner, and then, from its beginning again, on a new one that answers as
/// it should.
fn ask_twice(manner: Manner) -> String {
    watched(|| {
        let outlet = Outlet::new();
        let name = outlet.name();
        let patience = Rc::new(Cell::new(manner.patience()));
        let given = Rc::clone(&patience);
        let mut robot = Robot::new(Controller::builder(), move |cx: &Cx| {
            let (name, patience) = (name.clone(), given.get());
            Box::pin(async move {
                let line = Iodev::default();
                say(cx, &open(cx, &line, &name).await?)?;
                ask(cx, &line, patience).await
            })
        });
        let plug = outlet.plug();
        let peer = std::thread::spawn(move || manner.play(plug, QUESTION.as_bytes().len(), ANSWER));
        let output = robot.run().text();
        peer.join().unwrap();
        let plug = outlet.plug();
        let peer = std::thread::spawn(move || behave(plug));
        patience.set(Manner::ByteByByte.patience());
        assert_eq!(robot.run().text(), "true\nthe whole message\n", "the program goes on after {manner:?}");
        peer.join().unwrap();
        output
    })
}

#[test]
fn whatever_the_other_end_does_the_program_is_informed_and_goes_on() {
    for manner in Manner::ALL {
        let output = ask_twice(manner);
        match manner {
            // Of a line that is unplugged the system says so, or it ends: as it comes.
            Manner::LeavesHalfway | Manner::Resets => {
                let (start, end) = ("true\nalarm 20050: readuntil: the line is lost: ", " (t.arl:3)");
                assert!(output.starts_with(start) && output.ends_with(end), "{manner:?}: {output}");
            }
            Manner::Silent | Manner::Garbage => assert_eq!(output, "true\n-\n", "{manner:?}"),
            Manner::ByteByByte => assert_eq!(output, "true\nthe whole message\n"),
            // A pseudo terminal is slow: not every flood reaches 1 MiB in 0.3 s.
            Manner::Floods => {
                assert!(output == "true\n-\n" || output.contains("1048576 bytes have been received"), "{output}")
            }
        }
    }
}

/// A program reads a flood line by line.
fn flooded(seconds: u64) {
    watched(|| {
        let outlet = Outlet::new();
        let name = outlet.name();
        let lines = Rc::new(Cell::new(0_usize));
        let counted = Rc::clone(&lines);
        let mut robot = Robot::new(Controller::builder(), move |cx: &Cx| {
            let (name, counted) = (name.clone(), Rc::clone(&counted));
            Box::pin(async move {
                let line = Iodev::default();
                say(cx, &open(cx, &line, &name).await?)?;
                serial::write_string(cx, &line, &Str::literal("go\n")).await.at(FILE, 2)?;
                let mut text = Str::new();
                while text != "end" {
                    for _ in 0..100 {
                        if serial::readuntil(cx, &line, &mut text, &Str::literal("\n")).await.at(FILE, 3)? {
                            counted.set(counted.get() + usize::from(text == "0123456789abcde"));
                        }
                    }
                    cx.next_cycle().await;
                }
                Ok(())
            })
        });
        let mut plug = outlet.plug();
        let peer = std::thread::spawn(move || {
            plug.hears();
            let lines = b"0123456789abcde\n".repeat(64);
            let (mut sent, start) = (0, Instant::now());
            while start.elapsed() < Duration::from_secs(seconds) {
                plug.write_all(&lines).unwrap();
                sent += 64;
            }
            plug.write_all(b"end\n").unwrap();
            until_it_goes(plug);
            sent
        });
        let end = robot.run();
        assert_eq!((end.outcome, end.out.as_str()), (Outcome::Ended, "true\n"));
        assert_eq!(lines.get(), peer.join().unwrap(), "lines were lost");
    });
}

#[test]
fn a_flood_that_the_program_reads_loses_nothing() {
    flooded(1);
}

#[test]
#[ignore = "long"]
fn a_long_flood_that_the_program_reads_loses_nothing() {
    flooded(10);
}

#[test]
fn a_line_is_opened_and_closed_a_thousand_times() {
    watched(|| {
        let outlet = Outlet::new();
        let name = outlet.name();
        let mut robot = Robot::new(Controller::builder(), move |cx: &Cx| {
            let name = name.clone();
            Box::pin(async move {
                let line = Iodev::default();
                let opened =
                    again_and_again(async || open(cx, &line, &name).await, async || serial::close(cx, &line).await);
                say(cx, &opened.await?)?;
                open(cx, &line, &name).await?;
                ask(cx, &line, Manner::ByteByByte.patience()).await
            })
        });
        let plug = outlet.plug();
        let peer = std::thread::spawn(move || behave(plug));
        assert_eq!(robot.run().text(), format!("{TIMES}\nthe whole message\n"));
        peer.join().unwrap();
    });
}

#[test]
fn a_line_that_is_taken_is_false_until_it_is_free() {
    watched(|| {
        let outlet = Outlet::new();
        let name = outlet.name();
        let mut robot = Robot::new(Controller::builder(), move |cx: &Cx| {
            let name = name.clone();
            Box::pin(async move {
                let (first, second) = (Iodev::default(), Iodev::default());
                say(cx, &open(cx, &first, &name).await?)?;
                say(cx, &open(cx, &second, &name).await?)?;
                serial::close(cx, &first).await;
                say(cx, &open(cx, &second, &name).await?)?;
                ask(cx, &second, Manner::ByteByByte.patience()).await
            })
        });
        let plug = outlet.plug();
        let peer = std::thread::spawn(move || behave(plug));
        assert_eq!(robot.run().text(), "true\nfalse\ntrue\nthe whole message\n");
        peer.join().unwrap();
    });
}

/// A program that does not read is told by `clearbuff`, and opens the line again when it is back.
#[test]
fn a_line_that_is_unplugged_is_opened_again_when_it_is_back() {
    watched(|| {
        let outlet = Rc::new(Outlet::new());
        let plug = Rc::new(Cell::new(Some(outlet.plug())));
        let mut robot = Robot::new(Controller::builder(), move |cx: &Cx| {
            let (outlet, plug, name) = (Rc::clone(&outlet), Rc::clone(&plug), outlet.name());
            Box::pin(async move {
                let line = Iodev::default();
                say(cx, &open(cx, &line, &name).await?)?;
                say(cx, &serial::clearbuff(cx, &line).await.at(FILE, 4)?)?;
                drop(plug.take());
                while serial::clearbuff(cx, &line).await.at(FILE, 4)? {
                    cx.next_cycle().await;
                }
                serial::close(cx, &line).await;
                say(cx, &open(cx, &line, &name).await?)?;
                let new = outlet.plug();
                std::thread::spawn(move || behave(new));
                say(cx, &open(cx, &line, &name).await?)?;
                ask(cx, &line, Manner::ByteByByte.patience()).await
            })
        });
        assert_eq!(robot.run().text(), "true\ntrue\nfalse\ntrue\nthe whole message\n");
    });
}

/// Nobody reads what the program writes, so that its thread waits for room when the line goes.
#[test]
fn a_line_that_vanishes_while_the_program_writes_is_an_alarm() {
    watched(|| {
        let outlet = Outlet::new();
        let (name, plug) = (outlet.name(), Rc::new(Cell::new(Some(outlet.plug()))));
        let mut robot = Robot::new(Controller::builder(), move |cx: &Cx| {
            let (name, plug) = (name.clone(), Rc::clone(&plug));
            Box::pin(async move {
                let line = Iodev::default();
                say(cx, &open(cx, &line, &name).await?)?;
                let much = Str::from("x".repeat(1 << 16));
                // As much as there is room for, here and in the system.
                while serial::write_string(cx, &line, &much).await.at(FILE, 2)? {}
                drop(plug.take());
                loop {
                    serial::write_string(cx, &line, &much).await.at(FILE, 3)?;
                    cx.next_cycle().await;
                }
            })
        });
        let output = robot.run().text();
        assert!(output.starts_with("true\nalarm 20050: write: the line is lost: "), "{output}");
    });
}

/// What is there has another name's place: a file, a folder, nothing, and a terminal whose other end has gone.
#[test]
fn what_is_no_line_any_more_does_not_open_and_holds_nobody_up() {
    watched(|| {
        let outlet = Outlet::new();
        drop(outlet.plug());
        let mut robot = Robot::new(Controller::builder(), move |cx: &Cx| {
            let gone = outlet.name();
            Box::pin(async move {
                for name in [gone.clone(), "/dev/null".into(), "/".into(), "/no/such/line".into()] {
                    say(cx, &open(cx, &Iodev::default(), &name).await?)?;
                }
                Ok(())
            })
        });
        assert_eq!(robot.run().text(), "false\nfalse\nfalse\nfalse\n");
        let warnings = robot.warnings();
        assert_eq!(warnings.len(), 4, "{warnings:?}");
        assert!(warnings.iter().all(|warning| warning.starts_with("open ")), "{warnings:?}");
    });
}
