//! A Modbus RTU slave, whose master does wrong.

use std::cell::Cell;
use std::io::Write;
use std::rc::Rc;
use std::time::{Duration, Instant};

use arl_rt::Controller;
use arl_rt::emit::*;

use crate::common::{FILE, say};
use crate::manners::{noise, until_it_goes};
use crate::terminal::{Outlet, Plug};
use crate::watch::{Robot, TIMES, again_and_again, soon, watched};

/// The master reads register 50 of station 17.
const REQUEST: [u8; 8] = [17, 3, 0, 50, 0, 1, 0x27, 0x55];
const ANSWER: [u8; 7] = [17, 3, 2, 1, 2, 0xf9, 0xd6];
/// The master writes 7 into register 0.
const DONE: [u8; 8] = [17, 6, 0, 0, 0, 7, 0xca, 0x98];

async fn open(cx: &Cx, dev: &ModbusDev, name: &Str) -> Done<bool> {
    modbus_rtu::open(cx, dev, name, 17, 115_200, Parity::None, 8, Stopbits::One).await.at(FILE, 1)
}

/// Asks until the answer comes: a damaged request has none, and neither has one that follows noise too closely.
fn is_answered(plug: &mut Plug) {
    soon("no answer", || {
        std::thread::sleep(Duration::from_millis(60));
        plug.write_all(&REQUEST).ok()?;
        let mut answer = [0; ANSWER.len()];
        // What is left from before goes first.
        std::thread::sleep(Duration::from_millis(60));
        let mut come = plug.comes();
        let at = come.len().checked_sub(answer.len())?;
        answer.copy_from_slice(&come.split_off(at));
        (answer == ANSWER).then_some(())
    });
}

/// Runs a program that serves registers until the master says that it is done, while the master does wrong.
fn serves(wrong: impl FnOnce(&mut Plug) + Send + 'static) {
    watched(|| {
        let outlet = Outlet::new();
        let name = outlet.name();
        let mut robot = Robot::new(Controller::builder(), move |cx: &Cx| {
            let name = name.clone();
            Box::pin(async move {
                let dev = ModbusDev::default();
                say(cx, &open(cx, &dev, &name).await?)?;
                modbus_rtu::write_bytes(cx, &dev, &[1, 2], 100, 2).await.at(FILE, 2)?;
                let mut done = [0; 2];
                while done[1] != 7 {
                    modbus_rtu::read_bytes(cx, &dev, &mut done, 0, 2).await.at(FILE, 3)?;
                    cx.next_cycle().await;
                }
                modbus_rtu::close(cx, &dev).await;
                Ok(())
            })
        });
        let mut plug = outlet.plug();
        let master = std::thread::spawn(move || {
            is_answered(&mut plug);
            wrong(&mut plug);
            is_answered(&mut plug);
            std::thread::sleep(Duration::from_millis(60));
            plug.write_all(&DONE).unwrap();
            until_it_goes(plug);
        });
        assert_eq!(robot.run().text(), "true\n");
        master.join().unwrap();
    });
}

#[test]
fn a_master_that_is_silent_is_waited_for() {
    serves(|_| std::thread::sleep(Duration::from_millis(300)));
}

#[test]
fn a_master_that_stops_in_the_middle_is_forgotten() {
    serves(|plug| {
        for end in 1..REQUEST.len() {
            plug.write_all(&REQUEST[..end]).unwrap();
            is_answered(plug);
        }
    });
}

#[test]
fn a_request_a_byte_at_a_time_is_answered() {
    serves(|plug| {
        soon("no answer", || {
            std::thread::sleep(Duration::from_millis(60));
            for byte in REQUEST {
                plug.write_all(&[byte]).unwrap();
                // Longer than 3.5 characters, as adapters do.
                std::thread::sleep(Duration::from_millis(4));
            }
            std::thread::sleep(Duration::from_millis(60));
            (plug.comes() == ANSWER).then_some(())
        });
    });
}

#[test]
fn noise_is_not_answered() {
    serves(|plug| {
        plug.write_all(&noise(4096)).unwrap();
        std::thread::sleep(Duration::from_millis(200));
        assert_eq!(plug.comes(), b"");
    });
}

/// Noise at full speed, and requests at full speed whose answers nobody takes.
fn flooded(seconds: u64) {
    for piece in [noise(4096), REQUEST.repeat(512)] {
        serves(move |plug| {
            let start = Instant::now();
            while start.elapsed() < Duration::from_secs(seconds) {
                // A line that is full takes no more until the slave has read.
                let _ = plug.write_all(&piece);
            }
            while !plug.comes().is_empty() {}
        });
    }
}

#[test]
fn a_flood_is_survived() {
    flooded(1);
}

#[test]
#[ignore = "long"]
fn a_long_flood_is_survived() {
    flooded(10);
}

#[test]
fn a_slave_is_opened_and_closed_a_thousand_times() {
    watched(|| {
        let outlet = Outlet::new();
        let name = outlet.name();
        let mut robot = Robot::new(Controller::builder(), move |cx: &Cx| {
            let name = name.clone();
            Box::pin(async move {
                let (dev, other) = (ModbusDev::default(), ModbusDev::default());
                let opened =
                    again_and_again(async || open(cx, &dev, &name).await, async || modbus_rtu::close(cx, &dev).await);
                say(cx, &opened.await?)?;
                // A line that is taken is false until it is free.
                say(cx, &open(cx, &dev, &name).await?)?;
                say(cx, &open(cx, &other, &name).await?)?;
                modbus_rtu::close(cx, &dev).await;
                say(cx, &open(cx, &other, &name).await?)
            })
        });
        let _plug = outlet.plug();
        assert_eq!(robot.run().text(), format!("{TIMES}\ntrue\nfalse\ntrue\n"));
    });
}

#[test]
fn a_slave_that_is_unplugged_is_an_alarm_and_opens_again_when_it_is_back() {
    watched(|| {
        let outlet = Outlet::new();
        let (name, plug) = (outlet.name(), Rc::new(Cell::new(Some(outlet.plug()))));
        let mut robot = Robot::new(Controller::builder(), move |cx: &Cx| {
            let (name, plug) = (name.clone(), Rc::clone(&plug));
            Box::pin(async move {
                let dev = ModbusDev::default();
                say(cx, &open(cx, &dev, &name).await?)?;
                if plug.take().is_some() {
                    loop {
                        modbus_rtu::write_bytes(cx, &dev, &[5, 6], 8, 2).await.at(FILE, 2)?;
                        cx.next_cycle().await;
                    }
                }
                // The second run.
                let mut data = [0; 2];
                modbus_rtu::write_bytes(cx, &dev, &[5, 6], 8, 2).await.at(FILE, 3)?;
                say(cx, &modbus_rtu::clearbuff(cx, &dev).await.at(FILE, 4)?)?;
                modbus_rtu::read_bytes(cx, &dev, &mut data, 8, 2).await.at(FILE, 5)?;
                say(cx, &(data == [0, 0]))?;
                Ok(())
            })
        });
        let output = robot.run().text();
        let (start, end) = ("true\nalarm 20050: write: the line is lost: ", " (t.arl:2)");
        assert!(output.starts_with(start) && output.ends_with(end), "{output}");
        let new = outlet.plug();
        assert_eq!(robot.run().text(), "true\ntrue\ntrue\n");
        drop(new);
    });
}
