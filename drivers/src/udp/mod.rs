//! An arm that receives packets of set-points over UDP.

pub mod packet;

use std::hash::{BuildHasher, Hasher};
use std::io::ErrorKind;
use std::net::{ToSocketAddrs, UdpSocket};
use std::time::{Duration, Instant};

use arl_rt::motion::Joints;
use arl_rt::robot_driver::{DriverError, Drives, Feedback, Power, RobotDriver, Setpoint, Start};

use crate::patience::Patience;
use crate::readable;
use packet::{Command, STATE_LENGTH, State};

/// The longest time for the arm to answer at the start, and to switch its drives on.
const ANSWER: Duration = Duration::from_secs(3);
const COMING_ON: Duration = Duration::from_secs(5);
/// The interval of packets at the start.
const AGAIN: Duration = Duration::from_millis(20);
/// The number of packets at the end, as a packet may be lost.
const FAREWELLS: usize = 5;
/// The silence after which an arm no longer receives, as a time and as a least number of cycles.
const DEAF: Duration = Duration::from_millis(50);
const DEAF_CYCLES: f64 = 8.0;
/// The most packets taken in a cycle, so that a sender of more cannot keep it from ending.
const MOST: usize = 64;

/// An arm at an address. It has to answer each packet with its state.
///
/// ```no_run
/// use arl_drivers::udp::UdpArm;
///
/// let builder = arl_rt::Controller::builder()
///     .robot_driver(UdpArm::new("192.168.0.30:7447"))
///     .clock(arl_rt::clock::RealClock::new());
/// # let _ = builder;
/// ```
#[derive(Debug)]
pub struct UdpArm {
    address: String,
    link: Option<Link>,
    /// How long to wait for the robot, if the run uses the robot's time.
    patience: Option<Patience>,
}

impl UdpArm {
    /// A driver for the arm that listens at an address: host and port.
    pub fn new(address: impl Into<String>) -> Self {
        Self { address: address.into(), link: None, patience: None }
    }

    /// A driver for a simulated arm that sets the time: each exchange waits for its answer, at most two seconds. Thus a
    /// run is reproducible if the simulator is.
    pub fn in_its_own_time(self) -> Self {
        Self { patience: Some(Patience::default()), ..self }
    }
}

impl RobotDriver for UdpArm {
    fn start(&mut self, start: &Start<'_>) -> Result<Joints, DriverError> {
        let mut link = Link::open(&self.address, start)?;
        let state = link.meet(&self.address)?;
        let position = link.switch_on(start, state.position)?;
        self.link = Some(link);
        Ok(position)
    }

    fn exchange(&mut self, setpoint: &Setpoint) -> Feedback {
        let Some(link) = &mut self.link else { return Feedback::none() };
        link.send(setpoint, true);
        let received = match &mut self.patience {
            None => match link.newest() {
                // A fault is reported even if the state is outdated.
                Some(state) if !link.is_of_now(&state) => {
                    let fault = Some(state.drives).filter(|drives| matches!(drives, Drives::Fault(_)));
                    return fault.map_or_else(Feedback::none, |fault| Feedback::none().with_drives(fault));
                }
                state => state,
            },
            Some(patience) => {
                let sent = link.sent;
                let answer = link.answer(Instant::now() + patience.limit(), sent);
                patience.answered(answer.is_some());
                answer
            }
        };
        let Some(state) = received else { return Feedback::none() };
        let mut feedback = Feedback::at(state.position);
        (feedback.velocity, feedback.torque) = (state.velocity, state.torque);
        // Drives count as on only if the arm had received the command to switch them on.
        let is_early = state.drives == Drives::On && state.answers < link.powered;
        feedback.with_drives(if is_early { Drives::Off } else { state.drives })
    }

    fn switch(&mut self, power: Power) -> Drives {
        if let Some(link) = &mut self.link {
            link.switch(power);
        }
        // The arm reports whether they are on.
        Drives::Off
    }

    fn wants_torque(&self) -> bool {
        true
    }

    fn close(&mut self) {
        if let Some(mut link) = self.link.take() {
            link.let_go();
        }
    }
}

/// The connection to the arm.
#[derive(Debug)]
struct Link {
    /// Connected to the arm, so that the system drops packets from others. Packets that they sent before belong to
    /// another session.
    socket: UdpSocket,
    session: u32,
    axes: (u8, u8),
    power: Power,
    /// The number of the first command with this value of `power`.
    powered: u64,
    sent: u64,
    /// The number of the newest state.
    received: u64,
    /// The set-point sent last.
    last: Setpoint,
}

impl Link {
    fn open(address: &str, start: &Start<'_>) -> Result<Self, String> {
        let failed = |error: std::io::Error| format!("{address}: {error}");
        let to = address.to_socket_addrs().map_err(failed)?.next().ok_or_else(|| format!("{address}: no address"))?;
        let any = if to.is_ipv4() { "0.0.0.0:0" } else { "[::]:0" };
        let socket = UdpSocket::bind(any).map_err(failed)?;
        socket.connect(to).map_err(failed)?;
        socket.set_nonblocking(true).map_err(failed)?;
        let count = |axes: usize| u8::try_from(axes).unwrap_or(u8::MAX);
        let axes = (count(start.robot.own_axes().len()), count(start.robot.external_axes().len()));
        let last = Setpoint::resting(*start.home, start.period);
        Ok(Self { socket, session: session(), axes, power: Power::Off, powered: 0, sent: 0, received: 0, last })
    }

    /// Sends packets until the arm answers.
    fn meet(&mut self, address: &str) -> Result<State, String> {
        let until = Instant::now() + ANSWER;
        let hello = self.last;
        while Instant::now() < until {
            self.send(&hello, false);
            let Some(state) = self.answer(Instant::now() + AGAIN, 1) else { continue };
            if state.axes != self.axes {
                let axes_text = |(own, external): (u8, u8)| format!("{own} axes and {external} external ones");
                return Err(format!(
                    "the arm at {address} has {}, but the robot file has {}",
                    axes_text(state.axes),
                    axes_text(self.axes)
                ));
            }
            return Ok(state);
        }
        Err(format!("no arm answers at {address}: no valid answer within {} s", ANSWER.as_secs()))
    }

    /// Switches the motors on and waits until they are; returns the position of the arm then. Until then the arm is
    /// commanded to stay at its position.
    fn switch_on(&mut self, start: &Start<'_>, position: Joints) -> Result<Joints, String> {
        let mut here = start.begin_at(position)?;
        self.switch(Power::On);
        let until = Instant::now() + COMING_ON;
        let mut problem = format!("its drives have not come on within {} s", COMING_ON.as_secs());
        while Instant::now() < until {
            self.send(&Setpoint::resting(here, self.last.period), false);
            let Some(state) = self.answer(Instant::now() + AGAIN, self.powered) else { continue };
            here = match start.begin_at(state.position) {
                Ok(here) => here,
                Err(why) => {
                    problem = why;
                    break;
                }
            };
            match state.drives {
                Drives::On => return Ok(here),
                Drives::Fault(why) => problem = format!("its drives have a fault: {why}"),
                _ => {}
            }
            std::thread::sleep(AGAIN / 4);
        }
        self.let_go();
        Err(problem)
    }

    /// Releases the arm, with its motors off, until it has confirmed that or does not answer.
    fn let_go(&mut self) {
        if self.power == Power::On {
            self.power = Power::Off;
        }
        self.powered = self.sent + 1;
        let rest = self.last;
        for _ in 0..FAREWELLS {
            self.send(&rest, false);
            if self.answer(Instant::now() + AGAIN, self.powered).is_some_and(|state| state.drives != Drives::On) {
                return;
            }
        }
    }

    fn switch(&mut self, power: Power) {
        self.power = power;
        self.powered = self.sent + 1;
    }

    /// Whether the arm has received recent packets: an arm that only reports its position, but receives nothing, is as
    /// good as lost.
    fn is_of_now(&self, state: &State) -> bool {
        let late = (DEAF.as_secs_f64() / self.last.period).max(DEAF_CYCLES) as u64;
        state.answers.saturating_add(late) >= self.sent
    }

    fn send(&mut self, setpoint: &Setpoint, is_cyclic: bool) {
        self.sent += 1;
        self.last = *setpoint;
        let Self { session, sent: sequence, axes, power, .. } = *self;
        let command = Command { session, sequence, axes, power, is_cyclic, setpoint: *setpoint };
        // A packet that cannot be sent counts as lost in transit: the arm brakes and reports nothing new.
        let _ = self.socket.send(&command.to_bytes());
    }

    /// The newest state that has arrived.
    fn newest(&mut self) -> Option<State> {
        let mut newest = None;
        for _ in 0..MOST {
            match self.receive() {
                Ok(state) => newest = state.or(newest),
                Err(Empty) => break,
            }
        }
        newest
    }

    /// Waits for the answer to this command or to a later one.
    fn answer(&mut self, until: Instant, command: u64) -> Option<State> {
        loop {
            match self.receive() {
                Ok(Some(state)) if state.answers >= command => return Some(state),
                // An endless stream of packets that are not answers does not keep the wait from ending.
                Ok(_) if Instant::now() < until => {}
                Ok(_) => return None,
                Err(Empty) if readable::wait_until(&self.socket, until) => {}
                Err(Empty) => return None,
            }
        }
    }

    /// Receives a packet: a state that is newer than all before it, or `None` for one that does not count.
    fn receive(&mut self) -> Result<Option<State>, Empty> {
        let mut bytes = [0; STATE_LENGTH + 1];
        match self.socket.recv(&mut bytes) {
            Ok(length) => {
                let state = bytes.get(..length).and_then(State::from_bytes);
                let state = state.filter(|state| state.session == self.session && state.sequence > self.received);
                self.received = state.as_ref().map_or(self.received, |state| state.sequence);
                Ok(state)
            }
            // The system reports that no receiver is there (any more): the next packet may still arrive.
            Err(error) if matches!(error.kind(), ErrorKind::ConnectionRefused | ErrorKind::Interrupted) => Ok(None),
            Err(_) => Err(Empty),
        }
    }
}

/// There is nothing to receive.
struct Empty;

/// A number that differs from that of other runs; it is random and not from the time of day, as a clock that is set
/// back would repeat numbers.
fn session() -> u32 {
    let random = std::hash::RandomState::new().build_hasher().finish();
    ((random >> 32) as u32).max(1)
}
