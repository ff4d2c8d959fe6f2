//! The driver over RSI against a robot that sends and waits as the documentation says. What an arm with masses does
//! stands in `tests/peers/arms`.

#![allow(clippy::unwrap_used, clippy::panic, reason = "these are tests")]

mod common;

use std::net::UdpSocket;
use std::thread::JoinHandle;
use std::time::Duration;

use arl_drivers::rsi::RsiArm;
use arl_rt::robot_driver::{Drives, Power, RobotDriver, Setpoint};
use arl_rt::{Cell, Controller, Outcome};
use common::{joints, program, start};

fn message(ipoc: u64, axis: f64, ready: u8) -> String {
    format!(
        "<Rob Type=\"KUKA\"><AIPos A1=\"{axis:.6}\" A2=\"0\" A3=\"0\" A4=\"0\" A5=\"0\" A6=\"0\"/>\
         <Ready>{ready}</Ready><IPOC>{ipoc}</IPOC></Rob>"
    )
}

/// What an answer says: correction of axis 1, whether to stop, the time.
#[derive(Clone, Copy, PartialEq, Debug)]
struct Answered {
    correction: f64,
    stop: bool,
    ipoc: u64,
}

fn answered(text: &str) -> Answered {
    let between = |from: &str, to: &str| {
        let rest = &text[text.find(from).unwrap() + from.len()..];
        rest[..rest.find(to).unwrap()].to_owned()
    };
    let correction = between("<AK A1=\"", "\"").parse().unwrap();
    Answered { correction, stop: between("<Stop>", "<") == "1", ipoc: between("<IPOC>", "<").parse().unwrap() }
}

/// A port that nobody listens at.
fn free() -> String {
    UdpSocket::bind("127.0.0.1:0").unwrap().local_addr().unwrap().to_string()
}

/// The same at all addresses of this computer: what to listen at, and what to send to.
#[cfg(target_os = "linux")]
fn free_everywhere() -> (String, String) {
    let to = free();
    (to.replace("127.0.0.1", "0.0.0.0"), to)
}

/// Sends a message, again until somebody listens; the answer, unless none comes.
fn ask(socket: &UdpSocket, to: &str, text: &str) -> Option<Answered> {
    socket.send_to(text.as_bytes(), to).ok()?;
    let mut bytes = [0; 1000];
    let length = socket.recv(&mut bytes).ok()?;
    Some(answered(std::str::from_utf8(&bytes[..length]).unwrap()))
}

/// A robot that begins at 20 deg, is where it was told to be, and sends every `step` ms of its time until it is told to
/// stop.
fn robot(to: String, step: u64, ready: u8) -> JoinHandle<Vec<Answered>> {
    std::thread::spawn(move || {
        let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
        socket.set_read_timeout(Some(Duration::from_millis(300))).unwrap();
        let (mut ipoc, mut got) = (1000, Vec::<Answered>::new());
        // Nobody listens at first; who listens no more has gone.
        let mut unanswered = 0;
        while unanswered < 10 {
            ipoc += step;
            let axis = 20.0 + got.last().map_or(0.0, |answer| answer.correction);
            match ask(&socket, &to, &message(ipoc, axis, ready)) {
                Some(answer) => (unanswered, _) = (0, got.push(answer)),
                None => unanswered += 1,
            }
            if got.last().is_some_and(|answer| answer.stop) {
                break;
            }
            assert!(got.last().is_none_or(|answer| answer.ipoc <= ipoc));
        }
        got
    })
}

#[test]
fn a_cell_file_drives_a_robot() {
    let listen = free();
    let robot = robot(listen.clone(), 4, 1);
    let text =
        format!("[controller]\ncycle = 4\n[driver]\nprotocol = \"rsi\"\nlisten = \"{listen}\"\ntime = \"robot\"\n");
    let cell = Cell::parse("cell.toml", &text).unwrap();
    let mut controller = Controller::builder().cell(cell).drivers(arl_drivers::connect).build(program()).unwrap();
    // It begins where the robot is.
    assert_eq!(controller.joints().axes[0], 20.0);
    assert_eq!(controller.run(), Outcome::Ended);
    assert!((controller.joints().axes[0] - 10.0).abs() < 1e-6);
    // The cell does not say which robot: the user hears which one it is.
    let warnings = controller.take_warnings();
    let count = warnings.iter().filter(|it| it.contains("is used, as it was the first to send to")).count();
    assert!(count == 1 && warnings.iter().any(|it| it.contains("`address = \"127.0.0.1\"`")), "{warnings:?}");
    drop(controller);
    let got = robot.join().unwrap();
    assert_eq!((got[0].correction, got[0].stop), (0.0, false));
    // From 20 to 10 deg; the last answer tells to stop.
    let last = got.last().unwrap();
    assert!((last.correction + 10.0).abs() < 1e-5 && last.stop, "{last:?}");
    assert!(got.windows(2).all(|pair| pair[0].ipoc < pair[1].ipoc));
    assert_eq!(got.iter().filter(|answer| answer.stop).count(), 1);
    assert!(got.len() > 50, "{}", got.len());
}

/// A driver that has begun with a robot, whose socket it is; the time of the robot then. It waits in real time.
fn begun(driver: &mut RsiArm, listen: &str, socket: &UdpSocket) -> u64 {
    let (sender, to) = (socket.try_clone().unwrap(), listen.to_owned());
    let begin = std::thread::spawn(move || {
        sender.set_read_timeout(Some(Duration::from_millis(300))).unwrap();
        let mut ipoc = 1000;
        let mut next = || {
            ipoc += 4;
            message(ipoc, 20.0, 1)
        };
        // Until somebody listens, and what the start looks at; the last one is for the first cycle.
        while ask(&sender, &to, &next()).is_none() {}
        (0..3).for_each(|_| assert_eq!(ask(&sender, &to, &next()).unwrap().correction, 0.0));
        sender.send_to(next().as_bytes(), &to).unwrap();
        ipoc
    });
    assert_eq!(start(driver).unwrap(), joints(20.0));
    begin.join().unwrap()
}

// Addresses of this computer beside the first one are not everywhere.
#[cfg(target_os = "linux")]
#[test]
fn only_the_robot_that_is_named_is_followed() {
    let (listen, to) = free_everywhere();
    let other = UdpSocket::bind("127.0.0.2:0").unwrap();
    let from = other.local_addr().unwrap();
    let to_both = to.clone();
    let is_over = std::sync::Arc::new(std::sync::atomic::AtomicBool::new(false));
    let ends = std::sync::Arc::clone(&is_over);
    // It sends all the time, and before the robot.
    let sends = std::thread::spawn(move || {
        let mut ipoc = 0;
        while !ends.load(std::sync::atomic::Ordering::Relaxed) {
            ipoc += 4;
            let _ = other.send_to(message(ipoc, 77.0, 1).as_bytes(), &to_both);
            std::thread::sleep(Duration::from_millis(1));
        }
    });
    std::thread::sleep(Duration::from_millis(100));
    let robot = robot(to, 4, 1);
    let text = format!(
        "[controller]\ncycle = 4\n[driver]\nprotocol = \"rsi\"\nlisten = \"{listen}\"\n\
         address = \"127.0.0.1\"\ntime = \"robot\"\n"
    );
    let cell = Cell::parse("cell.toml", &text).unwrap();
    let mut controller = Controller::builder().cell(cell).drivers(arl_drivers::connect).build(program()).unwrap();
    assert_eq!(controller.joints().axes[0], 20.0);
    assert_eq!(controller.run(), Outcome::Ended);
    let warnings = controller.take_warnings();
    assert!(
        warnings.iter().any(|it| it.starts_with(&format!("{from} sends to {listen}, too, and is ignored"))),
        "{warnings:?}"
    );
    assert!(!warnings.iter().any(|it| it.contains("is used, as it")), "{warnings:?}");
    drop(controller);
    assert!(robot.join().unwrap().last().unwrap().stop);
    is_over.store(true, std::sync::atomic::Ordering::Relaxed);
    sends.join().unwrap();
}

#[cfg(target_os = "linux")]
#[test]
fn nobody_takes_over_where_the_robot_falls_silent() {
    let (listen, to) = free_everywhere();
    let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
    let mut driver = RsiArm::new(&listen);
    let mut clock = driver.clock();
    let ipoc = begun(&mut driver, &to, &socket);
    let warning = driver.take_warning().unwrap();
    assert!(warning.contains("is used, as it was the first") && driver.take_warning().is_none(), "{warning}");
    let mut cycle = || {
        arl_rt::clock::Clock::wait_for(&mut clock, 0, 0.004);
        driver.exchange(&Setpoint::resting(joints(20.0), 0.004))
    };
    assert_eq!(cycle().position, Some(joints(20.0)));
    // Longer than after which RSI may begin anew.
    std::thread::sleep(Duration::from_millis(600));
    let other = UdpSocket::bind("127.0.0.2:0").unwrap();
    for at in 1..5 {
        other.send_to(message(ipoc + 4 * at, 77.0, 1).as_bytes(), &to).unwrap();
        assert_eq!(cycle().position, None);
    }
    // Of the robot itself it is heard that its RSI has begun anew.
    socket.send_to(message(4, 21.0, 1).as_bytes(), &to).unwrap();
    let feedback = cycle();
    assert_eq!(feedback.position, Some(joints(21.0)));
    assert!(matches!(feedback.drives, Some(Drives::Fault(_))), "{feedback:?}");
}

#[test]
fn a_robot_outside_of_its_ranges_is_not_moved() {
    let listen = free();
    let to = listen.clone();
    let sends = std::thread::spawn(move || {
        let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
        socket.set_read_timeout(Some(Duration::from_millis(10))).unwrap();
        (1..300).filter_map(|at| ask(&socket, &to, &message(4 * at, 500.0, 1))).count()
    });
    let error = start(&mut RsiArm::new(&listen)).unwrap_err();
    assert!(error.starts_with("the robot reports j1 at 500.000 deg, outside of its range"), "{error}");
    assert_eq!(sends.join().unwrap(), 0, "it is answered");
}

#[test]
fn messages_that_were_never_sent_are_distinguished_from_those_that_waited() {
    let listen = free();
    let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
    let mut driver = RsiArm::new(&listen);
    let mut clock = driver.clock();
    let ipoc = begun(&mut driver, &listen, &socket);
    let mut cycle = |driver: &mut RsiArm| {
        arl_rt::clock::Clock::wait_for(&mut clock, 0, 0.004);
        driver.exchange(&Setpoint::resting(joints(20.0), 0.004));
        let lateness = arl_rt::clock::Clock::lateness(&clock).unwrap();
        (lateness.lost(), lateness.missing())
    };
    let send = |at: u64| socket.send_to(message(ipoc + 4 * at, 20.0, 1).as_bytes(), &listen).unwrap();
    assert_eq!(cycle(&mut driver), (0, 0));
    // Ten are not sent.
    send(11);
    assert_eq!(cycle(&mut driver), (10, 10));
    // Three are there when the cycle begins: two were lost here. One more is not sent.
    (13..16).for_each(|at| _ = send(at));
    assert_eq!(cycle(&mut driver), (13, 11));
}

#[test]
fn what_does_not_fit_is_refused() {
    let listen = free();
    let _robot = robot(listen.clone(), 12, 1);
    let error = start(&mut RsiArm::new(&listen)).unwrap_err();
    assert_eq!(error, "the robot has cycles of 12 ms, but the cell has 4 ms: set `cycle = 12` in [controller]");
    let listen = free();
    let _robot = robot(listen.clone(), 4, 0);
    let error = start(&mut RsiArm::new(&listen)).unwrap_err();
    assert_eq!(error, "its drives are off: switch them on, and start RSI again");
    let error = start(&mut RsiArm::new("192.0.2.1:49152")).unwrap_err();
    assert!(error.starts_with("192.0.2.1:49152: "), "{error}");
}

#[test]
fn who_waits_in_vain_hears_why() {
    let listen = free();
    let to = listen.clone();
    let sends = std::thread::spawn(move || {
        let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
        // A robot that runs already, and has not been answered.
        let late = message(8, 20.0, 1).replace("<Ready>", "<Delay D=\"7\"/><Ready>");
        for _ in 0..1000 {
            let _ = socket.send_to(late.as_bytes(), &to);
            std::thread::sleep(Duration::from_millis(2));
        }
    });
    let error = start(&mut RsiArm::new(&listen)).unwrap_err();
    assert!(error.starts_with("RSI is already running"), "{error}");
    drop(sends);
    let two = "[driver]\nprotocol = \"rsi\"\nlisten = \"127.0.0.1:0\"\n";
    let cell = || Cell::parse("cell.toml", two).unwrap();
    let second = arl_rt::Foreground::new(program()).driver_settings(cell().driver.unwrap());
    let error = Controller::builder().cell(cell()).drivers(arl_drivers::connect).foreground(second).build(program());
    let error = error.unwrap_err().to_string();
    assert!(error.contains("needs a controller of its own"), "{error}");
    let text = two.to_owned() + "time = \"robot\"\n";
    let builder = Controller::builder().cell(Cell::parse("cell.toml", &text).unwrap()).drivers(arl_drivers::connect);
    let error = builder.clock(arl_rt::clock::RealClock::new()).build(program()).unwrap_err();
    assert!(error.to_string().contains("neither in real time"), "{error}");
}

#[test]
fn only_new_messages_are_answered_and_count() {
    let listen = free();
    let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
    let mut driver = RsiArm::new(&listen).in_its_own_time();
    let mut clock = driver.clock();
    let mut cycle = |driver: &mut RsiArm, target: f64| {
        arl_rt::clock::Clock::wait_for(&mut clock, 0, 0.004);
        driver.exchange(&Setpoint::resting(joints(target), 0.004))
    };
    let base = begun(&mut driver, &listen, &socket) - 400;
    assert_eq!(cycle(&mut driver, 20.0).position, Some(joints(20.0)));
    let send = |text: &str| socket.send_to(text.as_bytes(), &listen).unwrap();
    // Three at once: the newest counts. One that is older, or none, or somebody else's, does not.
    send(&message(base + 404, 1.0, 1));
    send(&message(base + 412, 3.0, 1));
    send(&message(base + 408, 2.0, 1));
    let other = UdpSocket::bind("127.0.0.1:0").unwrap();
    other.send_to(message(base + 416, 9.0, 1).as_bytes(), &listen).unwrap();
    send("<Rob>");
    assert_eq!(cycle(&mut driver, 21.0).position, Some(joints(3.0)));
    send(&message(base + 412, 4.0, 1));
    send(&message(base + 416, 5.0, 0));
    let feedback = cycle(&mut driver, 22.0);
    assert_eq!((feedback.position, feedback.drives), (Some(joints(5.0)), Some(Drives::Off)));
    // While it is not told to be on, the correction stays.
    assert_eq!(driver.switch(Power::Off), Drives::Off);
    send(&message(base + 420, 6.0, 1));
    cycle(&mut driver, 50.0);
    driver.switch(Power::Cut);
    send(&message(base + 424, 6.0, 1));
    cycle(&mut driver, 50.0);
    // Nothing comes: no position. What comes behind that is heard, but answered no more.
    assert_eq!(cycle(&mut driver, 50.0).position, None);
    send(&message(base + 428, 7.0, 1));
    let feedback = cycle(&mut driver, 50.0);
    let fault = Drives::Fault("RSI has ended: start it and the run again".into());
    assert_eq!((feedback.position, feedback.drives), (Some(joints(7.0)), Some(fault)));
    assert_eq!(driver.switch(Power::On), Drives::Off);
    send(&message(base + 432, 7.0, 1));
    cycle(&mut driver, 50.0);
    socket.set_read_timeout(Some(Duration::from_millis(200))).unwrap();
    let mut bytes = [0; 1000];
    let mut got = Vec::new();
    while let Ok(length) = socket.recv(&mut bytes) {
        got.push(answered(std::str::from_utf8(&bytes[..length]).unwrap()));
    }
    let tail: Vec<_> = got[got.len() - 4..].iter().map(|it| (it.ipoc - base, it.correction, it.stop)).collect();
    assert_eq!(tail, [(412, 1.0, false), (416, 2.0, false), (420, 2.0, false), (424, 2.0, true)]);
}
