//! A DeviceNet bus that does not work: a driver's codes go to the program, which goes on.

use std::cell::Cell;
use std::rc::Rc;

use arl_rt::Controller;
use arl_rt::devicenet::{DeviceNet, ErrorCode};
use arl_rt::emit::*;

use crate::common::{FILE, say};
use crate::watch::{Robot, watched};

/// A bus whose cable somebody pulls out: then it has no bytes, and tells so.
struct Pulled(Rc<Cell<Option<i32>>>);

impl DeviceNet for Pulled {
    fn size(&self) -> usize {
        8
    }

    fn write(&mut self, _: usize, _: &[u8]) -> Result<(), ErrorCode> {
        self.0.get().map_or(Ok(()), |code| Err(ErrorCode::new(code)))
    }

    fn read(&mut self, _: usize, data: &mut [u8]) -> Result<(), ErrorCode> {
        data.fill(7);
        self.0.get().map_or(Ok(()), |code| Err(ErrorCode::new(code)))
    }
}

#[test]
fn the_codes_of_a_bus_go_to_the_program() {
    watched(|| {
        let error_code = Rc::new(Cell::new(None));
        let bus = Pulled(Rc::clone(&error_code));
        let mut robot = Robot::new(Controller::builder().devicenet(bus), move |cx: &Cx| {
            let error_code = Rc::clone(&error_code);
            Box::pin(async move {
                // Codes below 100 are the runtime's own.
                for code in [None, Some(250), Some(3), None] {
                    error_code.set(code);
                    let mut data = [0; 8];
                    say(cx, &devicenet::dnwrite(cx, 0, 8, &data).await.at(FILE, 1)?)?;
                    say(cx, &devicenet::dnread(cx, 0, 8, &mut data).await.at(FILE, 2)?)?;
                    say(cx, &devicenet::dnread(cx, 1, 8, &mut data).await.at(FILE, 3)?)?;
                }
                Ok(())
            })
        });
        assert_eq!(robot.run().text(), "0\n0\n1\n250\n250\n1\n100\n100\n1\n0\n0\n1\n");
    });
}
