//! Two robots in one process: one brings parts, the other takes them. They agree through outputs that both can read.

use arl_rt::{Captured, Controller, Foreground, Outcome, Robot};

/// `robot/giver.arl`
#[allow(dead_code, unreachable_pub, reason = "emitted: what is not used here is there all the same")]
mod giving {
    arl_rt::include_arl!("giver");
}

/// `robot/taker.arl`
#[allow(dead_code, unreachable_pub, reason = "emitted: what is not used here is there all the same")]
mod taking {
    arl_rt::include_arl!("taker");
}

/// `robot/watcher.arl`
#[allow(dead_code, unreachable_pub, reason = "emitted: what is not used here is there all the same")]
mod watching {
    arl_rt::include_arl!("watcher");
}

type Failure = Box<dyn std::error::Error>;

/// A controller with both robots.
fn cell() -> Result<(Captured, Controller), Failure> {
    let messages = Captured::new();
    let taker = Foreground::new(Box::new(taking::Globals::new())).robot(Robot::builtin("six-10")?);
    let controller = Controller::builder()
        .output(messages.clone())
        .robot(Robot::builtin("six-10")?)
        .foreground(taker) // channel 2, with a robot of its own
        .background(Box::new(watching::Globals::new())) // no robot
        .loadable("giver.arl", || Box::new(giving::Globals::new())) // what switcharl can load
        .build(Box::new(giving::Globals::new()))?; // channel 1
    Ok((messages, controller))
}

fn main() -> Result<(), Failure> {
    let (messages, mut controller) = cell()?;
    while controller.outcome().is_none() {
        controller.run_for(2.0);
        for channel in controller.status().channels {
            let (file, line) = channel.place;
            println!("{:5.1} s, {}: {:?} at {}:{line}", controller.time(), channel.channel, channel.state, file.name());
        }
        print!("{}", messages.take());
        for alarm in controller.take_alarms() {
            println!("{alarm}");
        }
    }
    match controller.outcome() {
        Some(Outcome::Ended) => Ok(()),
        outcome => Err(format!("{outcome:?}").into()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_parts_are_handed_over() -> Result<(), Failure> {
        let (messages, mut controller) = cell()?;
        let mut offered = 0;
        let mut before = false;
        while controller.outcome().is_none() {
            controller.step();
            let now = controller.digital_output(1)?;
            offered += u32::from(now && !before);
            before = now;
            assert!(controller.time() < 120.0, "{}", messages.text());
        }
        assert_eq!(controller.outcome(), Some(&Outcome::Ended));
        assert_eq!(offered, 3);
        let text = messages.text();
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines.len(), 6, "{text}");
        let of = |words: &'static str| lines.iter().filter(move |line| line.starts_with(words));
        for (part, line) in (1..).zip(of("part ")) {
            assert!(line.starts_with(&format!("part {part} placed")), "{line}");
        }
        for (part, line) in (1..).zip(of("handed over: ")) {
            assert_eq!(**line, format!("handed over: {part}"));
        }
        Ok(())
    }

    /// docs/embedding.md shows `cell`, word for word.
    #[test]
    fn the_book_shows_what_is_compiled_here() {
        let (book, code) = (include_str!("../../../docs/embedding.md"), include_str!("main.rs"));
        let shown = book
            .split("```rust,ignore\n")
            .find(|block| block.starts_with("fn cell()"))
            .and_then(|block| block.split("```").next());
        let shown = shown.unwrap_or("nothing");
        assert!(code.contains(shown), "{shown}");
    }
}
