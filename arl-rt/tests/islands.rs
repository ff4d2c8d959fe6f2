//! Programs whose inputs and outputs are on an island: here another controller's registers and coils.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test")]

mod common;

use std::net::SocketAddr;
use std::time::{Duration, Instant};

use arl_rt::emit::*;
use arl_rt::io::Pendant;
use arl_rt::{Cell, Controller, Outcome, SetupError, State};
use common::{FILE, controller};

/// A controller that serves registers and coils, and does nothing else.
fn plc() -> (Controller, SocketAddr) {
    let cell = Cell::parse("plc.toml", "[modbus_tcp]\nport = 0\n").unwrap();
    let (controller, _) = controller(Controller::builder().cell(cell), |_| Box::pin(async { Ok(()) }));
    let address = controller.modbus_tcp_address().unwrap();
    (controller, address)
}

fn cell(address: SocketAddr, more: &str) -> Cell {
    let text = format!(
        "[[island]]\nname = \"plc\"\naddress = \"127.0.0.1\"\nport = {}\npoll = 1\n\
         di = [{{ channel = 1, coil = 10 }}]\ndo = [{{ channel = 1, coil = 10 }}]\n{more}",
        address.port()
    );
    Cell::parse("cell.toml", &text).unwrap()
}

/// Steps until something is so.
fn until(controller: &mut Controller, mut so: impl FnMut(&mut Controller) -> bool) {
    let start = Instant::now();
    while !so(controller) {
        assert!(start.elapsed() < Duration::from_secs(20), "at {} s: {:?}", controller.time(), controller.state());
        controller.step();
    }
}

#[test]
fn an_output_comes_back_as_an_input() {
    let (_plc, address) = plc();
    let (mut controller, messages) = controller(Controller::builder().cell(cell(address, "")), |cx| {
        Box::pin(async move {
            io::setdo(cx, 1, true).await.at(FILE, 1)?;
            while !io::getdi(cx, 1).await.at(FILE, 2)? {
                cx.next_cycle().await;
            }
            text::print().argtoprint(&"heard").run(cx).at(FILE, 3)
        })
    });
    until(&mut controller, |controller| controller.outcome().is_some());
    assert_eq!((controller.outcome(), messages.text().as_str()), (Some(&Outcome::Ended), "heard\n"));
    assert_eq!(controller.take_warnings(), [""; 0]);
}

/// A program that runs for ever.
fn endless(cx: &Cx) -> BoxFuture<'_> {
    Box::pin(async move {
        loop {
            cx.line(FILE, 7);
            cx.next_cycle().await;
        }
    })
}

#[test]
fn no_program_with_a_robot_runs_on_without_its_island() {
    let (first, address) = plc();
    let background = Box::new(common::script(endless));
    let builder = Controller::builder().cell(cell(address, "")).background(background);
    let (mut controller, _) = controller(builder, endless);
    controller.run_for(0.01);
    assert_eq!(controller.state(), State::Running);
    drop(first);
    until(&mut controller, |controller| controller.outcome().is_some());
    let Some(Outcome::Alarm(alarm)) = controller.outcome() else { panic!("no alarm") };
    let text = alarm.to_string();
    assert!(text.starts_with(&format!("alarm 20051: the island plc ({address}) is lost: ")), "{text}");
    assert!(text.ends_with("(t.arl:7)"), "{text}");
    assert_eq!(controller.take_alarms().len(), 1, "the program in the background goes on");
    // It does not begin again either.
    controller.press(Pendant::Clear);
    controller.press(Pendant::Reset);
    controller.step();
    assert_eq!(controller.take_alarms().len(), 1);
}

#[test]
fn with_a_warning_programs_go_on() {
    let (first, address) = plc();
    let builder = Controller::builder().cell(cell(address, "lost = \"warning\"\n"));
    let (mut controller, _) = controller(builder, endless);
    controller.run_for(0.01);
    drop(first);
    let mut warnings = Vec::new();
    until(&mut controller, |controller| {
        warnings.extend(controller.take_warnings());
        !warnings.is_empty()
    });
    assert!(warnings[0].contains("the island plc") && warnings[0].contains("is lost"), "{warnings:?}");
    assert_eq!(controller.state(), State::Running);
}

#[test]
fn without_its_island_no_controller_starts() {
    let (plc, address) = plc();
    drop(plc);
    let error = Controller::builder().cell(cell(address, "")).build(Box::new(common::script(endless))).err();
    let Some(SetupError::Outside(text)) = error else { panic!("it starts") };
    assert!(text.contains("the island plc") && text.contains("is not available"), "{text}");
}

/// A driver whose outputs take five cycles.
#[derive(Default)]
struct Slow(u64);

impl arl_rt::io::IoDriver for Slow {
    fn read(&mut self, _: arl_rt::io::Inputs<'_>) {}

    fn write(&mut self, outputs: arl_rt::io::Outputs<'_>) {
        self.0 = outputs.cycle();
    }

    fn has_reached(&self, output: arl_rt::io::OutputSignal, cycle: u64) -> bool {
        output == arl_rt::io::OutputSignal::Digital(9) || self.0 >= cycle + 5
    }
}

#[test]
fn synchronous_outputs_wait_until_they_are_out() {
    let (mut controller, messages) = controller(Controller::builder().io_driver(Slow::default()), |cx| {
        Box::pin(async move {
            let cycles = |cx: &Cx, start: f64| ((cx.time() - start) * 1000.0).round();
            let start = cx.time();
            io::setdo(cx, 1, true).await.at(FILE, 1)?;
            let set = cycles(cx, start);
            io::syncdo(cx, 1, true).await.at(FILE, 1)?;
            let sync = cycles(cx, start);
            io::syncdo_group(cx, 1, 32, 0).await.at(FILE, 2)?;
            let group = cycles(cx, start);
            io::syncao(cx, 3, 5.0).await.at(FILE, 3)?;
            let analog = cycles(cx, start);
            io::syncdo(cx, 9, true).await.at(FILE, 4)?;
            let other = cycles(cx, start);
            let steps = [set, sync, group, analog, other];
            text::print().argtoprint(&Str::from(format!("{steps:?}"))).run(cx).at(FILE, 5)
        })
    });
    assert_eq!(controller.run(), Outcome::Ended);
    assert_eq!(messages.text(), "[0.0, 6.0, 12.0, 18.0, 19.0]\n");
}

/// A driver whose inputs are lost from its tenth cycle on.
struct Broken(u32);

impl arl_rt::io::IoDriver for Broken {
    fn read(&mut self, _: arl_rt::io::Inputs<'_>) {
        self.0 += 1;
    }

    fn write(&mut self, _: arl_rt::io::Outputs<'_>) {}

    fn take_warning(&mut self) -> Option<String> {
        (self.0 == 5).then(|| {
            self.0 += 1;
            "the cable is loose".into()
        })
    }

    fn fault(&self) -> Option<&str> {
        (self.0 >= 10).then_some("the cable is off")
    }
}

#[test]
fn a_driver_of_ones_own_warns_and_stops_robots() {
    let (mut controller, _) = controller(Controller::builder().io_driver(Broken(0)), endless);
    assert_eq!(common::alarm(controller.run()), "alarm 20051: the cable is off (t.arl:7)");
    assert_eq!(controller.take_warnings(), ["the cable is loose"]);
}
