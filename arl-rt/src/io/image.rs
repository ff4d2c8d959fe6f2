//! The controller's process image: the inputs and outputs that programs read and write between two exchanges with the
//! outside.

use std::collections::VecDeque;

use super::Channels;
use super::analog_row::AnalogRow;
use super::bits::Bits;
use super::channel::{OutputSignal, channel_fault, place};
use crate::fault::Fault;

/// The most channels that one call may name.
const MAX_GROUP_CHANNELS: i64 = 32;

/// The inputs and outputs as the program sees them. Channels count from 1.
#[derive(Debug)]
pub struct Image {
    di: Bits,
    dout: Bits,
    ai: AnalogRow,
    ao: AnalogRow,
    internal_in: Bits,
    internal_out: Bits,
    /// The running pulse of each digital output.
    pulses: Vec<Option<Pulse>>,
    running_pulses: usize,
    pwm: [Pwm; PWM_CHANNELS],
    /// Outputs that a program waits for, with the cycle in which it set them.
    awaited: Vec<(OutputSignal, u64)>,
    /// Outputs that change when a motion has ended: for each channel, in the order of its motions.
    after_motion: Vec<VecDeque<AfterMotion>>,
}

/// The number of PWM outputs of a controller.
pub(crate) const PWM_CHANNELS: usize = 3;

/// The setting of a PWM output. An output that no program has set yet is off: 0 Hz, 0 %.
#[derive(Clone, Copy, PartialEq, Eq, Default, Debug)]
pub struct Pwm {
    /// The frequency in Hz, 10 to 10000.
    pub frequency: u16,
    /// The duty cycle in %, 0 to 100.
    pub duty: u8,
}

/// A running pulse.
#[derive(Clone, Copy, Debug)]
struct Pulse {
    /// The level during the pulse.
    level: bool,
    /// The cycle at whose start the pulse ends.
    ends: u64,
    /// The index of the channel whose program started the pulse.
    owner: usize,
}

/// `setdoimv`: an output that waits for the end of a motion.
#[derive(Clone, Copy, Debug)]
struct AfterMotion {
    motion: u64,
    channel: usize,
    level: bool,
}

/// A kind of digital signal.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Digital {
    /// Inputs.
    Di,
    /// Outputs.
    Do,
    /// Internal inputs.
    InternalIn,
    /// Internal outputs.
    InternalOut,
}

impl Digital {
    fn name(self) -> &'static str {
        match self {
            Digital::Di => "DI",
            Digital::Do => "DO",
            Digital::InternalIn => "internal DI",
            Digital::InternalOut => "internal DO",
        }
    }
}

impl Image {
    /// An image with all channels off and without signal.
    pub(crate) fn new(channels: &Channels) -> Self {
        Self {
            di: Bits::new(channels.di),
            dout: Bits::new(channels.dout),
            ai: AnalogRow::new("AI", &channels.ai),
            ao: AnalogRow::new("AO", &channels.ao),
            internal_in: Bits::new(channels.internal),
            internal_out: Bits::new(channels.internal),
            pulses: vec![None; channels.dout as usize],
            running_pulses: 0,
            pwm: [Pwm::default(); PWM_CHANNELS],
            awaited: Vec::with_capacity(channels.dout as usize + channels.ao.len()),
            after_motion: vec![VecDeque::with_capacity(64)],
        }
    }

    /// The same image for `count` channels with programs.
    pub(crate) fn for_programs(mut self, count: usize) -> Self {
        self.after_motion.resize_with(count, || VecDeque::with_capacity(64));
        self
    }

    /// Ends all pulses of a program's channel immediately.
    pub(crate) fn end_pulses(&mut self, owner: usize) {
        for at in 0..self.pulses.len() {
            if self.pulses.get(at).copied().flatten().is_some_and(|pulse| pulse.owner == owner) {
                self.end_pulse(at);
            }
        }
    }

    /// Sets a PWM output.
    pub(crate) fn set_pwm(&mut self, channel: i32, pwm: Pwm) -> Result<(), Fault> {
        let at = place("PWM", channel, PWM_CHANNELS)?;
        self.pwm.get_mut(at).into_iter().for_each(|output| *output = pwm);
        Ok(())
    }

    /// The setting of a PWM output.
    pub(crate) fn pwm(&self, channel: i32) -> Result<Pwm, Fault> {
        let at = place("PWM", channel, PWM_CHANNELS)?;
        Ok(self.pwm.get(at).copied().unwrap_or_default())
    }

    /// Notes that a program waits until outputs that were set in this cycle have reached their destination.
    pub(crate) fn await_outputs(&mut self, outputs: impl Iterator<Item = OutputSignal>, cycle: u64) {
        for output in outputs {
            match self.awaited.iter_mut().find(|(known, _)| *known == output) {
                Some((_, since)) => *since = cycle,
                None => self.awaited.push((output, cycle)),
            }
        }
    }

    /// Whether a program waits for one of these outputs.
    pub(crate) fn awaits(&self, mut outputs: impl Iterator<Item = OutputSignal>) -> bool {
        !self.awaited.is_empty() && outputs.any(|output| self.awaited.iter().any(|(awaited, _)| *awaited == output))
    }

    /// Ends the wait for outputs that have reached their destination.
    pub(crate) fn outputs_reached(&mut self, has: impl Fn(OutputSignal, u64) -> bool) {
        self.awaited.retain(|(output, since)| !has(*output, *since));
    }

    /// The settings of all PWM outputs.
    pub(crate) fn pwms(&self) -> [Pwm; PWM_CHANNELS] {
        self.pwm
    }

    /// Drops the outputs that wait for the end of a motion of a program's channel.
    pub(crate) fn forget_motion(&mut self, owner: usize) {
        self.after_motion.get_mut(owner).into_iter().for_each(VecDeque::clear);
    }

    fn bits(&self, what: Digital) -> &Bits {
        match what {
            Digital::Di => &self.di,
            Digital::Do => &self.dout,
            Digital::InternalIn => &self.internal_in,
            Digital::InternalOut => &self.internal_out,
        }
    }

    fn bits_mut(&mut self, what: Digital) -> &mut Bits {
        match what {
            Digital::Di => &mut self.di,
            Digital::Do => &mut self.dout,
            Digital::InternalIn => &mut self.internal_in,
            Digital::InternalOut => &mut self.internal_out,
        }
    }

    fn place(&self, what: Digital, channel: i32) -> Result<usize, Fault> {
        place(what.name(), channel, self.bits(what).len())
    }

    /// The level of a channel.
    pub(crate) fn digital(&self, what: Digital, channel: i32) -> Result<bool, Fault> {
        Ok(self.bits(what).get(self.place(what, channel)?))
    }

    /// The levels of a range of channels; the first is the lowest bit.
    pub(crate) fn digitals(&self, what: Digital, from: i32, to: i32) -> Result<i32, Fault> {
        let range = self.range(what, from, to)?;
        let bits = self.bits(what);
        let levels = range.enumerate().fold(0_u32, |levels, (bit, at)| levels | (u32::from(bits.get(at)) << bit));
        Ok(levels.cast_signed())
    }

    /// Sets a channel. This ends a pulse that runs on it.
    pub(crate) fn set_digital(&mut self, what: Digital, channel: i32, level: bool) -> Result<(), Fault> {
        let at = self.place(what, channel)?;
        self.drive(what, at, level);
        Ok(())
    }

    /// Sets a range of channels; the first takes the lowest bit. Surplus bits are ignored.
    pub(crate) fn set_digitals(&mut self, what: Digital, from: i32, to: i32, levels: i32) -> Result<(), Fault> {
        for (bit, at) in self.range(what, from, to)?.enumerate() {
            self.drive(what, at, levels.cast_unsigned() >> bit & 1 == 1);
        }
        Ok(())
    }

    fn drive(&mut self, what: Digital, at: usize, level: bool) {
        if what == Digital::Do {
            self.forget_pulse(at);
        }
        self.bits_mut(what).set(at, level);
    }

    fn range(&self, what: Digital, from: i32, to: i32) -> Result<std::ops::Range<usize>, Fault> {
        let (first, last) = (self.place(what, from)?, self.place(what, to)?);
        let name = what.name();
        if first > last {
            return Err(channel_fault(format!(
                "{name} {from} to {to} is a reversed range: the lower number comes first, {to} to {from}"
            )));
        }
        if i64::from(to) - i64::from(from) >= MAX_GROUP_CHANNELS {
            return Err(channel_fault(format!(
                "{name} {from} to {to} are more than {MAX_GROUP_CHANNELS} channels, which is the most that one int holds"
            )));
        }
        Ok(first..last + 1)
    }

    /// The value of an analog input in V or mA.
    pub(crate) fn analog_input(&self, channel: i32) -> Result<f64, Fault> {
        self.ai.get(channel)
    }

    /// Whether an analog input can have this value.
    pub(crate) fn check_ai(&self, channel: i32, value: f64) -> Result<(), Fault> {
        self.ai.check(channel, value).map(drop)
    }

    /// Sets an analog input, in V or mA.
    pub(crate) fn set_analog_input(&mut self, channel: i32, value: f64) -> Result<(), Fault> {
        self.ai.set(channel, value)
    }

    /// The value of an analog output in V or mA.
    pub(crate) fn analog_output(&self, channel: i32) -> Result<f64, Fault> {
        self.ao.get(channel)
    }

    /// Sets an analog output, in V or mA.
    pub(crate) fn set_analog_output(&mut self, channel: i32, value: f64) -> Result<(), Fault> {
        self.ao.set(channel, value)
    }

    /// Starts a pulse of `level` that ends at the start of cycle `ends`, for the program of the channel `owner`.
    pub(crate) fn pulse(&mut self, owner: usize, channel: i32, level: bool, ends: u64) -> Result<(), Fault> {
        let at = self.place(Digital::Do, channel)?;
        self.drive(Digital::Do, at, level);
        if let Some(place) = self.pulses.get_mut(at) {
            *place = Some(Pulse { level, ends, owner });
            self.running_pulses += 1;
        }
        Ok(())
    }

    fn forget_pulse(&mut self, at: usize) -> Option<Pulse> {
        let pulse = self.pulses.get_mut(at)?.take()?;
        self.running_pulses -= 1;
        Some(pulse)
    }

    fn end_pulse(&mut self, at: usize) {
        if let Some(pulse) = self.forget_pulse(at) {
            self.dout.set(at, !pulse.level);
        }
    }

    /// Ends the pulses whose time is over at the start of `cycle`.
    pub(crate) fn end_pulses_of(&mut self, cycle: u64) {
        if self.running_pulses == 0 {
            return;
        }
        for at in 0..self.pulses.len() {
            if self.pulses.get(at).copied().flatten().is_some_and(|pulse| pulse.ends <= cycle) {
                self.end_pulse(at);
            }
        }
    }

    /// Whether a pulse is running, or a program waits for outputs to reach their destination.
    pub(crate) fn has_pulses(&self) -> bool {
        self.running_pulses > 0 || !self.awaited.is_empty()
    }

    /// Whether a pulse of the program's channel `owner` is on.
    pub(crate) fn pulsing(&self, owner: usize) -> bool {
        self.running_pulses > 0 && self.pulses.iter().flatten().any(|pulse| pulse.owner == owner)
    }

    /// Sets a channel as soon as the motion with this running number, of the program's channel `owner`, has ended.
    pub(crate) fn set_after(&mut self, owner: usize, motion: u64, channel: i32, level: bool) -> Result<(), Fault> {
        let at = self.place(Digital::Do, channel)?;
        if let Some(waiting) = self.after_motion.get_mut(owner) {
            waiting.push_back(AfterMotion { motion, channel: at, level });
        }
        Ok(())
    }

    /// Sets the channels that waited for motions of the program's channel `owner` that have ended, in the order of the
    /// calls.
    pub(crate) fn motions_ended(&mut self, owner: usize, ended: impl Fn(u64) -> bool) {
        let mut at = 0;
        while let Some(waiting) = self.after_motion.get_mut(owner)
            && let Some(next) = waiting.get(at)
        {
            if !ended(next.motion) {
                at += 1;
            } else if let Some(due) = waiting.remove(at) {
                self.drive(Digital::Do, due.channel, due.level);
            }
        }
    }

    /// The analog inputs or outputs.
    pub(crate) fn analogs(&self, output: bool) -> &[f64] {
        let row = if output { &self.ao } else { &self.ai };
        row.values()
    }

    /// The level of a digital input; `None` if the channel does not exist.
    pub(crate) fn input(&self, channel: i32) -> Option<bool> {
        let at = usize::try_from(channel).ok()?.checked_sub(1)?;
        (at < self.di.len()).then(|| self.di.get(at))
    }

    /// Sets a digital output if it exists.
    pub(crate) fn drive_output(&mut self, channel: i32, level: bool) {
        let place = usize::try_from(channel).ok().and_then(|channel| channel.checked_sub(1));
        if let Some(at) = place.filter(|at| *at < self.dout.len()) {
            self.drive(Digital::Do, at, level);
        }
    }

    /// The digital outputs, for edge detection.
    pub(crate) fn outputs(&self) -> &Bits {
        &self.dout
    }

    /// The digital inputs, for edge detection.
    pub(crate) fn inputs(&self) -> &Bits {
        &self.di
    }

    /// The inputs, for the driver to fill.
    pub(crate) fn inputs_mut(&mut self) -> Inputs<'_> {
        Inputs {
            di: &mut self.di,
            ai: &mut self.ai,
            internal: &mut self.internal_in,
            internal_outputs: &mut self.internal_out,
        }
    }

    /// The outputs of a cycle, for the driver to pass on.
    pub(crate) fn outputs_all(&self, cycle: u64) -> Outputs<'_> {
        Outputs { cycle, dout: &self.dout, ao: self.ao.values(), internal: &self.internal_out, pwm: &self.pwm }
    }
}

/// The inputs of a cycle, as an [`IoDriver`](super::IoDriver) fills them. Channels count from 1 here, too.
#[derive(Debug)]
pub struct Inputs<'a> {
    di: &'a mut Bits,
    ai: &'a mut AnalogRow,
    internal: &'a mut Bits,
    internal_outputs: &'a mut Bits,
}

impl Inputs<'_> {
    /// Sets a digital input; channels that do not exist are ignored.
    pub fn set_digital_input(&mut self, channel: usize, level: bool) {
        self.di.set(channel.wrapping_sub(1), level);
    }

    /// Sets an analog input in V or mA to any measured value; channels that do not exist are ignored.
    pub fn set_analog_input(&mut self, channel: usize, value: f64) {
        self.ai.put(channel.wrapping_sub(1), value);
    }

    /// Sets an internal input; channels that do not exist are ignored.
    pub fn set_internal_input(&mut self, channel: usize, level: bool) {
        self.internal.set(channel.wrapping_sub(1), level);
    }

    /// Sets an internal output, which programs can only read, as the internal PLC sets it; channels that do not exist
    /// are ignored.
    pub fn set_internal_output(&mut self, channel: usize, level: bool) {
        self.internal_outputs.set(channel.wrapping_sub(1), level);
    }
}

/// The outputs of a cycle, as an [`IoDriver`](super::IoDriver) gets them. Channels count from 1 here, too.
#[derive(Clone, Copy, Debug)]
pub struct Outputs<'a> {
    cycle: u64,
    dout: &'a Bits,
    ao: &'a [f64],
    internal: &'a Bits,
    pwm: &'a [Pwm],
}

impl Outputs<'_> {
    /// The running number of the cycle, for [`IoDriver::has_reached`](super::IoDriver::has_reached).
    pub fn cycle(&self) -> u64 {
        self.cycle
    }

    /// The level of a digital output; false if it does not exist.
    pub fn digital_output(&self, channel: usize) -> bool {
        self.dout.get(channel.wrapping_sub(1))
    }

    /// An analog output in V or mA; 0 if it does not exist.
    pub fn analog_output(&self, channel: usize) -> f64 {
        self.ao.get(channel.wrapping_sub(1)).copied().unwrap_or_default()
    }

    /// A PWM output; off if it does not exist.
    pub fn pwm(&self, channel: usize) -> Pwm {
        self.pwm.get(channel.wrapping_sub(1)).copied().unwrap_or_default()
    }

    /// The level of an internal output; false if it does not exist.
    pub fn internal_output(&self, channel: usize) -> bool {
        self.internal.get(channel.wrapping_sub(1))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn image() -> Image {
        Image::new(&Channels::default())
    }

    #[test]
    fn ranges_have_their_lowest_bit_first() {
        let mut image = image();
        image.set_digitals(Digital::Do, 5, 8, 0b1100).unwrap();
        assert!(!image.digital(Digital::Do, 6).unwrap());
        assert!(image.digital(Digital::Do, 7).unwrap());
        assert_eq!(image.digitals(Digital::Do, 5, 8).unwrap(), 0b1100);
        image.set_digitals(Digital::Do, 33, 64, -1).unwrap();
        assert_eq!(image.digitals(Digital::Do, 33, 64).unwrap(), -1);
        image.set_digitals(Digital::Do, 1, 2, 0b111).unwrap();
        assert_eq!(image.digitals(Digital::Do, 1, 4).unwrap(), 0b11, "bits left over are ignored");
    }

    #[test]
    fn channels_that_do_not_exist_are_faults() {
        let mut image = image();
        let texts = [
            image.digital(Digital::Di, 0).unwrap_err().to_string(),
            image.digital(Digital::Do, 65).unwrap_err().to_string(),
            image.digitals(Digital::Di, 8, 5).unwrap_err().to_string(),
            image.set_digitals(Digital::Do, 1, 33, 0).unwrap_err().to_string(),
            image.analog_output(9).unwrap_err().to_string(),
        ];
        assert_eq!(texts[0], "DI 0 does not exist: this cell has channels 1 to 64");
        assert_eq!(texts[1], "DO 65 does not exist: this cell has channels 1 to 64");
        assert!(texts[2].contains("reversed"), "{}", texts[2]);
        assert!(texts[3].contains("more than 32"), "{}", texts[3]);
        assert_eq!(texts[4], "AO 9 does not exist: this cell has channels 1 to 8");
    }

    #[test]
    fn pwm_outputs_are_off_until_they_are_set() {
        let mut image = image();
        assert_eq!(image.outputs_all(0).pwm(2), Pwm::default());
        let pwm = Pwm { frequency: 20, duty: 50 };
        image.set_pwm(2, pwm).unwrap();
        assert_eq!(image.outputs_all(0).pwm(2), pwm);
        assert_eq!(image.outputs_all(0).pwm(4), Pwm::default());
        assert!(image.set_pwm(0, pwm).is_err() && image.set_pwm(4, pwm).is_err());
    }

    #[test]
    fn a_pulse_ends_with_the_opposite_level() {
        let mut image = image();
        image.pulse(0, 5, true, 30).unwrap();
        image.pulse(0, 6, false, 31).unwrap();
        image.end_pulses_of(29);
        assert_eq!(image.digitals(Digital::Do, 5, 6).unwrap(), 0b01);
        image.end_pulses_of(30);
        assert_eq!(image.digitals(Digital::Do, 5, 6).unwrap(), 0b00);
        assert!(image.pulsing(0));
        image.end_pulses_of(31);
        assert_eq!(image.digitals(Digital::Do, 5, 6).unwrap(), 0b10);
        assert!(!image.pulsing(0));
    }

    #[test]
    fn a_new_pulse_ends_the_old_one() {
        let mut image = image();
        image.pulse(0, 5, true, 3000).unwrap();
        image.pulse(0, 5, false, 3000).unwrap();
        image.end_pulses_of(3000);
        assert!(image.digital(Digital::Do, 5).unwrap());
        assert!(!image.pulsing(0));
    }

    #[test]
    fn outputs_wait_for_the_end_of_their_motion() {
        let mut image = image();
        image.set_after(0, 3, 1, true).unwrap();
        image.set_after(0, 4, 2, true).unwrap();
        image.motions_ended(0, |motion| motion <= 2);
        assert_eq!(image.digitals(Digital::Do, 1, 2).unwrap(), 0);
        image.motions_ended(0, |motion| motion == 3);
        assert_eq!(image.digitals(Digital::Do, 1, 2).unwrap(), 1);
        image.motions_ended(0, |motion| motion <= 9);
        assert_eq!(image.digitals(Digital::Do, 1, 2).unwrap(), 3);
    }
}
