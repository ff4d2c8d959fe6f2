//! Runs ARL programs that the build script compiled, and plays the outside from Rust.

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

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // ARL functions that do not wait are plain Rust functions.
    println!("in 3 s: {} litres", filling::valves::litres(3.0, 2.5));

    let (messages, mut controller) = ready(filling::Globals::new())?;
    controller.run_for(4.0);
    println!("inlet open: {}", controller.dout(1)?);
    controller.set_di(1, true)?;
    println!("fill: {:?}, {}", controller.run(), messages.text().trim());

    let (messages, mut controller) = ready(draining::Globals::new())?;
    let outcome = controller.run();
    println!("drain: {outcome:?} after {} s, {}", controller.time().round(), messages.text().trim());
    if outcome == Outcome::Ended { Ok(()) } else { Err("drain did not end".into()) }
}

type Ready = (Captured, Controller);

/// A controller on the virtual clock, and the messages of its program.
fn ready(program: impl Program + 'static) -> Result<Ready, Box<dyn std::error::Error>> {
    let messages = Captured::new();
    let controller = Controller::builder().output(messages.clone()).build(Box::new(program))?;
    Ok((messages, controller))
}
