//! A KUKA robot whose controller runs RobotSensorInterface (RSI): it sends the positions of the axes in each of its
//! cycles, 4 ms or 12 ms long, and accepts corrections of the axes in the answer. So it sets the pace: the runtime's
//! cycles are those of the robot.

mod clock;
mod link;
pub mod message;
mod sender;

use std::cell::RefCell;
use std::rc::Rc;
use std::time::Duration;

use arl_rt::motion::Joints;
use arl_rt::robot_driver::{DriverError, Drives, Feedback, Power, RobotDriver, Setpoint, Start};

pub use clock::RsiClock;
use link::Link;
use message::Message;

use crate::patience::Patience;
use crate::position::difference;

/// How long to wait at the start, as RSI has to be started on the robot's pendant.
const BEGIN: Duration = Duration::from_secs(30);
/// How long to wait for another message at the end, to tell the robot to stop.
const END: Duration = Duration::from_millis(50);
/// The number of messages examined before cycles begin, after the first one.
const FIRST: usize = 4;
/// A robot is at rest if its axes have moved by no more than this meanwhile, in deg (mm).
const STANDS: f64 = 0.1;
/// The number of answers that tell a robot to stop, as a packet may be lost.
const STOPS: u32 = 5;

/// A robot that uses RSI. Its [clock](RsiArm::clock) has to be the clock of the controller, whose cycles are as long as
/// those of the robot.
///
/// ```no_run
/// use arl_drivers::rsi::RsiArm;
///
/// let arm = RsiArm::new("0.0.0.0:49152");
/// let builder = arl_rt::Controller::builder().clock(arm.clock()).robot_driver(arm);
/// # let _ = builder;
/// ```
#[derive(Debug)]
pub struct RsiArm {
    link: Rc<RefCell<Link>>,
    /// The axis positions when RSI began, the origin of corrections.
    origin: Joints,
    /// The last correction sent.
    correction: Joints,
    external: usize,
    power: Power,
    /// The number of answers that have told the robot to stop.
    stops: u32,
    /// Messages were interrupted, or the robot was told to stop: no more answers are sent.
    ended: bool,
}

impl RsiArm {
    /// A driver for the first robot that sends to this address and port of the computer; a warning of the controller
    /// names the robot.
    pub fn new(listen: impl Into<String>) -> Self {
        Self::following(listen.into(), None)
    }

    /// A driver for the robot at an address, host or host and port, that sends to this address and port of the
    /// computer.
    pub fn of_robot(listen: impl Into<String>, address: impl Into<String>) -> Self {
        Self::following(listen.into(), Some(address.into()))
    }

    fn following(listen: String, address: Option<String>) -> Self {
        let origin = Joints { axes: [0.0; 6], external: [0.0; 6] };
        let link = Rc::new(RefCell::new(Link::new(listen, address)));
        Self { link, origin, correction: origin, external: 0, power: Power::On, stops: 0, ended: false }
    }

    /// A driver for a simulated robot that sets the time: each cycle waits for it, at most two seconds.
    pub fn in_its_own_time(self) -> Self {
        self.link.borrow_mut().patience = Some(Patience::default());
        self
    }

    /// The clock whose cycles begin when a message arrives.
    pub fn clock(&self) -> RsiClock {
        RsiClock::new(Rc::clone(&self.link))
    }

    /// The feedback of a message.
    fn feedback(&self, message: &Message) -> Feedback {
        let drives = match message.ready {
            _ if self.ended || self.stops > 0 => Drives::Fault("RSI has ended: start it and the run again".into()),
            Some(false) => Drives::Off,
            _ => Drives::On,
        };
        let mut feedback = Feedback::at(message.position).with_drives(drives);
        feedback.torque = message.torque;
        feedback
    }

    fn answer(&self, stop: bool) {
        self.link.borrow_mut().answer(&self.correction, self.external, stop);
    }
}

impl RobotDriver for RsiArm {
    fn start(&mut self, start: &Start<'_>) -> Result<Joints, DriverError> {
        self.external = start.robot.external_axes().len();
        let mut link = self.link.borrow_mut();
        link.open()?;
        let first = link.wait(BEGIN)?;
        if first.delay > 0 {
            return Err(
                "RSI is already running and may hold a correction from an earlier run: start it again, after arl2rs"
                    .into(),
            );
        }
        let (mut last, mut steps) = (first, [0; FIRST]);
        self.origin = start.begin_at(first.position)?;
        link.given_up_ms = given_up_ms(start.period);
        for step in &mut steps {
            link.answer(&self.correction, self.external, false);
            let next = link.wait(BEGIN)?;
            if link.take_interruption() {
                return Err("RSI was interrupted while the run began: start both again".into());
            }
            *step = next.ipoc.saturating_sub(last.ipoc);
            last = next;
        }
        fits(&steps, start.period)?;
        if last.external < self.external {
            let (has, needs) = (last.external, self.external);
            return Err(
                format!("its messages have {has} external axes in `EIPos`, but the robot file has {needs}").into()
            );
        }
        if last.ready == Some(false) {
            return Err("its drives are off: switch them on, and start RSI again".into());
        }
        let moved = difference(&start.begin_at(last.position)?, &self.origin);
        if moved.axes.iter().chain(&moved.external).any(|by| by.abs() > STANDS) {
            return Err("the robot is moving, though it was not commanded to".into());
        }
        // The first cycle answers.
        link.give_back(last);
        Ok(last.position)
    }

    fn exchange(&mut self, setpoint: &Setpoint) -> Feedback {
        let Some(message) = self.link.borrow_mut().take() else { return Feedback::none() };
        self.ended |= self.link.borrow_mut().take_interruption();
        if self.ended {
            // The origin of corrections is no longer known: without an answer the robot ends RSI.
            return self.feedback(&message);
        }
        // While it is off, the robot's own controller holds it at its last set-point.
        if self.power == Power::On {
            self.correction = difference(&setpoint.position, &self.origin);
        }
        let stops = self.power == Power::Cut;
        self.answer(stops);
        // A robot that continues to send after that has restarted.
        self.stops += u32::from(stops);
        self.ended = self.stops >= STOPS;
        self.feedback(&message)
    }

    fn switch(&mut self, power: Power) -> Drives {
        // A robot that was told to stop ends RSI.
        if self.power != Power::Cut {
            self.power = power;
        }
        // The drives are on if the robot reports so, or does not report their state.
        let is_on = self.power == Power::On && !self.ended && self.link.borrow().is_ready();
        if is_on { Drives::On } else { Drives::Off }
    }

    fn take_warning(&mut self) -> Option<String> {
        self.link.borrow_mut().take_warning()
    }

    fn close(&mut self) {
        // If the run took long to end, messages of several cycles are waiting: the newest one is answered.
        let has_message = self.link.borrow_mut().wait(END).is_ok();
        self.ended |= self.link.borrow_mut().take_interruption();
        if has_message && !self.ended {
            self.answer(true);
        }
    }
}

/// The longest time, in ms, between the message answered last and the next one. A robot without an answer for longer
/// than the clock waits for a message has given up.
fn given_up_ms(period: f64) -> u64 {
    ((clock::longest_wait(period).as_secs_f64() + period) * 1e3).ceil() as u64
}

/// Checks that the cycles of the robot, whose time counts in ms, are as long as those of the controller. Messages may
/// be lost: then a step is longer.
fn fits(steps: &[u64], period: f64) -> Result<(), String> {
    let step = steps.iter().min().copied().unwrap_or_default();
    let own = period * 1e3;
    if (step as f64 - own).abs() < 1e-6 {
        return Ok(());
    }
    Err(format!("the robot has cycles of {step} ms, but the cell has {own} ms: set `cycle = {step}` in [controller]"))
}
