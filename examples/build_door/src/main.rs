//! Runs ARL programs that the build script compiled, and plays the outside from Rust.

use std::sync::mpsc;

use arl_rt::clock::RealClock;
use arl_rt::output::Event;
use arl_rt::{Captured, Controller, Outcome, Program};

/// `robot/fill.arl` and what it imports.
#[allow(dead_code, unreachable_pub, reason = "emitted: what is not used here is there all the same")]
mod filling {
    arl_rt::include_arl!("fill");
}

/// `robot/drain.arl` and what it imports.
#[allow(dead_code, unreachable_pub, reason = "emitted: what is not used here is there all the same")]
mod draining {
    arl_rt::include_arl!("drain");
}

type Failure = Box<dyn std::error::Error>;

fn main() -> Result<(), Failure> {
    // ARL functions that do not wait are plain Rust functions.
    println!("in 3 s: {} litres", filling::valves::litres(3.0, 2.5));

    let (messages, mut controller) = ready(filling::Globals::new())?;
    controller.run_for(4.0);
    println!("inlet open: {}", controller.digital_output(1)?);
    controller.set_digital_input(1, true)?;
    println!("fill: {:?}, {}", controller.run(), messages.text().trim());

    let (messages, mut controller) = ready(draining::Globals::new())?;
    let outcome = controller.run();
    println!("drain: {outcome:?} after {} s, {}", controller.time().round(), messages.text().trim());

    println!("at half the rate: {}", fill_at(1.25)?.trim());
    println!("from another thread: {}", fill_from_outside()?);
    if outcome == Outcome::Ended { Ok(()) } else { Err("drain did not end".into()) }
}

type Ready = (Captured, Controller);

/// A controller on the virtual clock, and the messages of its program.
fn ready(program: impl Program + 'static) -> Result<Ready, Failure> {
    let messages = Captured::new();
    let controller = Controller::builder().output(messages.clone()).build(Box::new(program))?;
    Ok((messages, controller))
}

/// Fills with another rate than the program says; the message of the program.
fn fill_at(rate: f64) -> Result<String, Failure> {
    let messages = Captured::new();
    let mut controller = Controller::builder()
        .output(messages.clone())
        .on_init(move |globals: &filling::Globals| globals.fill.rate.set(rate))
        .build(Box::new(filling::Globals::new()))?;
    controller.run_for(2.0);
    controller.set_digital_input(1, true)?;
    controller.run();
    let switched = controller.globals::<filling::Globals>().map(|globals| globals.valves.switched.get());
    if switched == Some(2) { Ok(messages.text()) } else { Err("the valve was not switched twice".into()) }
}

/// Fills in real time, on a thread of its own, while this one plays the sensor; the last message of the program.
fn fill_from_outside() -> Result<String, Failure> {
    let (tell, events) = mpsc::channel();
    let running = Controller::spawn(move || {
        let builder = Controller::builder().clock(RealClock::new()).events(tell);
        builder.build(Box::new(filling::Globals::new()))
    })?;
    let handle = running.handle();
    while !handle.digital_output(1)? {} // asks once a cycle
    handle.set_digital_input(1, true)?;
    println!("fill: {}", running.join());
    let texts = events.iter().filter_map(|event| match event {
        Event::Message { text, .. } => Some(text),
        _ => None,
    });
    texts.last().ok_or_else(|| "the program said nothing".into())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn global_variables_are_set_and_read() -> Result<(), Failure> {
        assert_eq!(fill_at(1.25)?, "2.5 litres, valves switched 2 times\n");
        Ok(())
    }

    #[test]
    fn a_thread_plays_the_sensor() -> Result<(), Failure> {
        assert!(fill_from_outside()?.ends_with(" litres, valves switched 2 times"));
        Ok(())
    }

    /// docs/embedding.md shows these two, word for word.
    #[test]
    fn the_book_shows_what_is_compiled_here() {
        let (book, code) = (include_str!("../../../docs/embedding.md"), include_str!("main.rs"));
        for name in ["fn fill_at", "fn fill_from_outside"] {
            let shown = book.split("```rust,ignore\n").find(|block| block.contains(name));
            let shown = shown.and_then(|block| block.split("```").next());
            assert!(shown.is_some_and(|shown| code.contains(shown)), "{name}: {shown:?}");
        }
    }
}
