//! The outputs that report the controller's state to a PLC.

use crate::context::system::System;
use crate::controller::State;
use crate::io::Image;
use crate::values::Controlmode;

/// The longest program number, in bits.
const NUMBER_BITS: usize = 16;
/// The number of outputs that [`StatusOutputs::show`] drives.
const STATUS_OUTPUTS: usize = 6 + 5 + 2 + NUMBER_BITS;

/// The outputs that the controller drives, in the order in which it drives them; 0: none.
#[derive(Debug)]
pub(super) struct StatusOutputs([i32; STATUS_OUTPUTS]);

impl Default for StatusOutputs {
    fn default() -> Self {
        Self([0; STATUS_OUTPUTS])
    }
}

impl StatusOutputs {
    /// Drives all outputs that are wired. An output that does not exist means that the cell does not use it.
    pub(super) fn show(&mut self, io: &mut Image, system: &System, state: State, servo_on: bool, number: u32) {
        let mode = system.ctl_mode.get();
        let mut board = Board { io, driven: self.0.iter_mut() };
        board.show(system.ext_ctl_act_conf_do.get(), system.ext_ctl_act.get());
        board.show(system.servo_on_do.get(), servo_on);
        board.show(system.pgno_req_do.get(), system.pgno_req.get());
        board.show(system.at_t1_do.get(), mode == Controlmode::Manual);
        board.show(system.at_t2_do.get(), mode == Controlmode::Manufast);
        board.show(system.at_aut_do.get(), mode == Controlmode::Auto);
        system.at_home_do.with(|channels| {
            system.at_home.with(|at_home| {
                for (channel, at) in channels.iter().zip(at_home.iter()) {
                    board.show(*channel, *at);
                }
            });
        });
        let (first, second) = channel_state(state);
        board.show_row(system.chan_state_do.get(), [first, second].into_iter());
        let length = usize::try_from(system.pgno_length.get()).unwrap_or(0).min(NUMBER_BITS);
        board.show_row(system.pgno_ack_fbit_do.get(), (0..length).map(|bit| number >> bit & 1 == 1));
        board.end();
    }
}

/// The levels of `$CHAN_STATE_DO` and the output behind it.
fn channel_state(state: State) -> (bool, bool) {
    match state {
        State::Running => (true, false),
        State::Paused => (false, true),
        State::Ended => (true, true),
    }
}

/// Outputs that are driven one after the other.
struct Board<'a> {
    io: &'a mut Image,
    driven: std::slice::IterMut<'a, i32>,
}

impl Board<'_> {
    /// Drives an output. Where another output was used for this before, that one goes off.
    fn show(&mut self, channel: i32, on: bool) {
        let Some(driven) = self.driven.next() else { return };
        if *driven != channel {
            self.io.drive_output(*driven, false);
            *driven = channel;
        }
        self.io.drive_output(channel, on);
    }

    /// Drives successive outputs, if all of them exist.
    fn show_row(&mut self, first: i32, levels: impl ExactSizeIterator<Item = bool>) {
        let last = i64::from(first) + levels.len() as i64 - 1;
        let fits = first > 0 && last <= self.io.outputs().len() as i64;
        for (at, on) in levels.enumerate() {
            self.show(if fits { first + at as i32 } else { 0 }, on);
        }
    }

    /// Switches off the outputs that are no longer used.
    fn end(mut self) {
        while self.driven.len() > 0 {
            self.show(0, false);
        }
    }
}
