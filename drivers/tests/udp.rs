//! The driver over UDP against an arm that answers as the documentation says. What an arm with masses does stands in
//! `tests/peers/arms`.

#![allow(clippy::unwrap_used, clippy::panic, reason = "these are tests")]

mod common;

use std::net::UdpSocket;
use std::thread::JoinHandle;
use std::time::Duration;

use arl_drivers::udp::UdpArm;
use arl_drivers::udp::packet::{COMMAND_LENGTH, Command, STATE_LENGTH, State};
use arl_rt::motion::Joints;
use arl_rt::robot_driver::{Drives, Power, RobotDriver, Setpoint};
use arl_rt::{Cell, Controller, Foreground, Outcome};
use common::{joints, program, start};

/// The bytes of a state, by the offsets of the documentation.
fn state(session: [u8; 4], sequence: u64, answers: [u8; 8], drives: u32, axes: [u8; 2], position: &[u8]) -> Vec<u8> {
    let mut bytes = vec![0; STATE_LENGTH];
    let mut put = |at: usize, what: &[u8]| bytes[at..at + what.len()].copy_from_slice(what);
    put(0, b"ARLS");
    put(4, &1u16.to_le_bytes());
    put(6, &axes);
    put(8, &session);
    put(12, &drives.to_le_bytes());
    put(16, &sequence.to_le_bytes());
    put(24, &answers);
    put(40, position);
    if drives == 2 {
        put(36, &3u32.to_le_bytes());
        put(280, b"E07");
    }
    bytes
}

/// What an arm answers to a command: states, from the command's bytes and the number of the answer.
type Answers = fn(&[u8], u64) -> Vec<Vec<u8>>;

/// An arm that is where it shall be.
fn follows(command: &[u8], number: u64) -> Vec<Vec<u8>> {
    let power = u32::from_le_bytes(command[12..16].try_into().unwrap());
    let (session, sequence) = (command[8..12].try_into().unwrap(), command[16..24].try_into().unwrap());
    vec![state(session, number, sequence, u32::from(power == 1), [6, 0], &command[32..128])]
}

/// Answers commands until nothing has come for a while; all that it got.
fn arm(answers: Answers) -> (String, JoinHandle<Vec<Vec<u8>>>) {
    let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
    let address = socket.local_addr().unwrap().to_string();
    socket.set_read_timeout(Some(Duration::from_secs(1))).unwrap();
    let thread = std::thread::spawn(move || {
        let (mut got, mut bytes) = (Vec::new(), [0; 1000]);
        while let Ok((length, from)) = socket.recv_from(&mut bytes) {
            got.push(bytes[..length].to_vec());
            for answer in answers(&bytes[..length], got.len() as u64) {
                socket.send_to(&answer, from).unwrap();
            }
        }
        got
    });
    (address, thread)
}

#[test]
fn packets_are_as_documented() {
    let setpoint = Setpoint::resting(joints(7.5), 0.004);
    let command =
        Command { session: 0x0403_0201, sequence: 258, axes: (6, 2), power: Power::Cut, is_cyclic: true, setpoint };
    let bytes = command.to_bytes();
    assert_eq!(bytes.len(), COMMAND_LENGTH);
    assert_eq!(bytes[..32], *b"ARLC\x01\0\x06\x02\x01\x02\x03\x04\x02\0\0\0\x02\x01\0\0\0\0\0\0\xa0\x0f\0\0\x01\0\0\0");
    assert_eq!(bytes[32..40], 7.5f64.to_le_bytes());
    assert!(bytes[40..].iter().all(|byte| *byte == 0));
    let bytes = state([1, 2, 3, 4], 9, 258u64.to_le_bytes(), 2, [6, 2], &7.5f64.to_le_bytes());
    let found = State::from_bytes(&bytes).unwrap();
    assert_eq!((found.session, found.sequence, found.answers, found.axes), (0x0403_0201, 9, 258, (6, 2)));
    assert_eq!((found.drives, found.position), (Drives::Fault("E07".into()), joints(7.5)));
    assert_eq!((found.velocity, found.torque), (None, None));
    // Nothing else is a state.
    for wrong in [&bytes[1..], &bytes[..STATE_LENGTH - 1], &[0; STATE_LENGTH], &[]] {
        assert_eq!(State::from_bytes(wrong), None);
    }
    for (at, byte) in [(0, b'X'), (4, 2), (12, 3), (36, 65)] {
        let mut wrong = bytes.clone();
        wrong[at] = byte;
        assert_eq!(State::from_bytes(&wrong), None, "{at}");
    }
}

#[test]
fn a_cell_file_drives_an_arm() {
    let (address, arm) = arm(follows);
    let text = format!("[driver]\nprotocol = \"udp\"\naddress = \"{address}\"\ntime = \"robot\"\n");
    let cell = Cell::parse("cell.toml", &text).unwrap();
    let mut controller = Controller::builder().cell(cell).drivers(arl_drivers::connect).build(program()).unwrap();
    assert_eq!(controller.run(), Outcome::Ended);
    assert!((controller.joints().axes[0] - 10.0).abs() < 1e-6);
    drop(controller);
    let got = arm.join().unwrap();
    let flags = |bytes: &Vec<u8>| u32::from_le_bytes(bytes[28..32].try_into().unwrap());
    let power = |bytes: &Vec<u8>| bytes[12];
    // Hello, then on, then one a cycle, with torques; farewell, off.
    assert_eq!((power(&got[0]), flags(&got[0])), (0, 0));
    let first = got.iter().find(|bytes| power(bytes) == 1).unwrap();
    assert_eq!(flags(first), 0);
    assert!(got.iter().filter(|bytes| flags(bytes) == 3).count() > 200);
    let last = got.last().unwrap();
    assert_eq!((power(last), flags(last) & 1), (0, 0));
    let numbers = got.iter().map(|bytes| u64::from_le_bytes(bytes[16..24].try_into().unwrap()));
    assert!(numbers.eq(1..=got.len() as u64));
}

#[test]
fn without_being_commanded_to_nothing_is_driven() {
    let text = "[driver]\nprotocol = \"udp\"\naddress = \"127.0.0.1:9\"\n";
    let cell = Cell::parse("cell.toml", text).unwrap();
    let mut controller = Controller::builder().cell(cell).build(program()).unwrap();
    assert_eq!(controller.run(), Outcome::Ended);
    // Who wants to drive has to have something to drive.
    let error = Controller::builder().drivers(arl_drivers::connect).build(program()).unwrap_err();
    assert_eq!(error.to_string(), "robots are to be driven, but the cell has no [driver]");
}

#[test]
fn no_robot_is_driven_in_the_time_of_another_one() {
    let cell = |time: &str| {
        let text = format!("[driver]\nprotocol = \"udp\"\naddress = \"127.0.0.1:9\"\ntime = \"{time}\"\n");
        Cell::parse("cell.toml", &text).unwrap()
    };
    let second = Foreground::new(program()).driver_settings(cell("world").driver.unwrap());
    let builder = Controller::builder().cell(cell("robot")).drivers(arl_drivers::connect).foreground(second);
    let error = builder.build(program()).unwrap_err();
    assert!(error.to_string().contains("together with one that has `time = \"world\"`"), "{error}");
}

#[test]
fn an_arm_that_does_not_fit_is_refused() {
    let seven: Answers = |command, number| {
        let (session, sequence) = (command[8..12].try_into().unwrap(), command[16..24].try_into().unwrap());
        vec![state(session, number, sequence, 0, [7, 0], &command[32..128])]
    };
    let (address, _arm) = arm(seven);
    let error = start(&mut UdpArm::new(&address)).unwrap_err();
    let right = "has 7 axes and 0 external ones, but the robot file has 6 axes and 0 external ones";
    assert_eq!(error, format!("the arm at {address} {right}"));
}

#[test]
fn drives_with_a_fault_do_not_start() {
    let broken: Answers = |command, number| {
        let (session, sequence) = (command[8..12].try_into().unwrap(), command[16..24].try_into().unwrap());
        vec![state(session, number, sequence, 2, [6, 0], &command[32..128])]
    };
    let (address, _arm) = arm(broken);
    assert_eq!(start(&mut UdpArm::new(&address)).unwrap_err(), "its drives have a fault: E07");
}

#[test]
fn only_the_newest_state_of_this_run_counts() {
    let odd: Answers = |command, number| {
        let [answer] = &follows(command, 10 * number)[..] else { panic!("one") };
        let change = |at: usize, bytes: &[u8]| {
            let mut answer = answer.clone();
            answer[at..at + bytes.len()].copy_from_slice(bytes);
            answer
        };
        // One of another run, an older one, one that is none, and after the right one it again with another position.
        let wrong = 99.0f64.to_le_bytes();
        let other_run = [&change(8, &[0; 4])[..40], &wrong, &answer[48..]].concat();
        let mut older = change(16, &(10 * number - 10).to_le_bytes());
        older[40..48].copy_from_slice(&wrong);
        let again = change(40, &wrong);
        vec![other_run, older, vec![1, 2, 3], answer.clone(), again]
    };
    let (address, _arm) = arm(odd);
    let mut driver = UdpArm::new(&address).in_its_own_time();
    start(&mut driver).unwrap();
    for cycle in 1..50 {
        let at = joints(f64::from(cycle) * 0.1);
        let feedback = driver.exchange(&Setpoint::resting(at, 0.001));
        assert_eq!((feedback.position, feedback.drives), (Some(at), Some(Drives::On)));
    }
    driver.close();
}

#[test]
fn an_arm_that_falls_silent_says_nothing() {
    let silent: Answers = |command, number| match command[28] & 1 {
        0 => follows(command, number),
        _ => Vec::new(),
    };
    let (address, _arm) = arm(silent);
    let mut driver = UdpArm::new(&address);
    let position: Joints = start(&mut driver).unwrap();
    let feedback = driver.exchange(&Setpoint::resting(position, 0.001));
    assert_eq!((feedback.position, feedback.drives), (None, None));
    assert_eq!(driver.switch(Power::Off), Drives::Off);
}

#[test]
fn an_arm_that_hears_nothing_is_as_good_as_silent() {
    // It says where it is, again and again, and that the first commands are all that it had.
    let deaf: Answers = |command, number| {
        let mut answer = follows(command, number).remove(0);
        let had = u64::from_le_bytes(command[16..24].try_into().unwrap());
        answer[24..32].copy_from_slice(&had.min(3).to_le_bytes());
        vec![answer]
    };
    let (address, _arm) = arm(deaf);
    let mut driver = UdpArm::new(&address);
    let position: Joints = start(&mut driver).unwrap();
    let mut heard = Vec::new();
    for _ in 0..100 {
        let feedback = driver.exchange(&Setpoint::resting(position, 0.001));
        std::thread::sleep(Duration::from_millis(1));
        heard.push(feedback.position.is_some());
    }
    assert!(heard[..50].contains(&true) && !heard[80..].contains(&true), "{heard:?}");
}

#[test]
fn what_is_no_number_does_not_start() {
    let odd: Answers = |command, number| {
        let mut answer = follows(command, number).remove(0);
        answer[40..48].copy_from_slice(&f64::NAN.to_le_bytes());
        vec![answer]
    };
    let (address, arm) = arm(odd);
    let error = start(&mut UdpArm::new(&address)).unwrap_err();
    assert!(error.starts_with("the position that the robot reports for j1 is not a number"), "{error}");
    // Its motors were never told to be on.
    assert!(arm.join().unwrap().iter().all(|command| command[12] == 0));
}

#[test]
fn an_arm_outside_of_its_ranges_is_not_moved() {
    let far: Answers = |command, number| {
        let mut answer = follows(command, number).remove(0);
        (0..6).for_each(|axis| answer[40 + 8 * axis..48 + 8 * axis].copy_from_slice(&500.0f64.to_le_bytes()));
        vec![answer]
    };
    let (address, arm) = arm(far);
    let text = format!("[driver]\nprotocol = \"udp\"\naddress = \"{address}\"\ntime = \"robot\"\n");
    let cell = Cell::parse("cell.toml", &text).unwrap();
    let error = Controller::builder().cell(cell).drivers(arl_drivers::connect).build(program()).unwrap_err();
    let why = "the robot of channel 1 cannot be started: the robot reports j1 at 500.000 deg, outside of its range";
    assert!(error.to_string().starts_with(why), "{error}");
    // Its motors were never told to be on, and no set-point was cyclic.
    assert!(arm.join().unwrap().iter().all(|command| command[12] == 0 && command[28] & 1 == 0));
}

#[test]
fn an_arm_that_floods_without_answering_holds_nobody_up() {
    let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
    let address = socket.local_addr().unwrap().to_string();
    let is_over = std::sync::Arc::new(std::sync::atomic::AtomicBool::new(false));
    let ends = std::sync::Arc::clone(&is_over);
    let flood = std::thread::spawn(move || {
        let (_, to) = socket.recv_from(&mut [0; 1000]).unwrap();
        while !ends.load(std::sync::atomic::Ordering::Relaxed) {
            let _ = socket.send_to(&[1, 2, 3], to);
        }
    });
    let error = start(&mut UdpArm::new(&address)).unwrap_err();
    assert_eq!(error, format!("no arm answers at {address}: no valid answer within 3 s"));
    is_over.store(true, std::sync::atomic::Ordering::Relaxed);
    flood.join().unwrap();
}
