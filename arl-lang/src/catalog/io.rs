//! 5.5: inputs and outputs. Channels count from 1.

use super::declare::{base, entries, folded, kind, param_type};
use super::facts::Space;
use crate::ast::Unit;

entries! { pub(super) IO =
    /// Sets a digital output. A channel that does not exist: alarm.
    fn setdo(chan: int [addresses(Space::DigitalOutput)] "the output", value: bool "its level")
        { "5.5.1", io::setdo, waits, fails; "setdo(3,true)\nprint getdo(3)" }
    /// Sets up to 32 neighbouring digital outputs. Channels that do not exist, in the wrong order or more than 32:
    /// alarm.
    fn setdo(
        from_chan: int [addresses(Space::DigitalOutput)] "the first output",
        to_chan: int [addresses(Space::DigitalOutput)] "the last output",
        value: int "their levels, lowest bit for the first output; bits beyond the last one are ignored",
    )
        { "5.5.2", io::setdo_group, waits, fails; "setdo(5,8,1100b)\nprint getdo(5,8)" }
    /// Sets a digital output when the motion before it has ended and the next one starts, without stopping the
    /// robot.
    instr setdoimv(channel: int [alias(&["chan"]), addresses(Space::DigitalOutput)] "the output", value: bool "its level")
        { "5.5.3", io::setdoimv, acts, fails; "setdoimv channel:3,value:true" }
    /// Sets a digital output and goes on when it has been sent.
    fn syncdo(chan: int [addresses(Space::DigitalOutput)] "the output", value: bool "its level")
        { "5.5.4", io::syncdo, waits, fails; "syncdo(3,true)\nprint getdo(3)" }
    /// Sets up to 32 neighbouring digital outputs and goes on when they have been sent.
    fn syncdo(
        from_chan: int [addresses(Space::DigitalOutput)] "the first output",
        to_chan: int [addresses(Space::DigitalOutput)] "the last output",
        value: int "their levels, lowest bit for the first output; bits beyond the last one are ignored",
    )
        { "5.5.5", io::syncdo_group, waits, fails; "syncdo(5,8,1100b)\nprint getdo(5,8)" }
    /// Puts a pulse on a digital output while the program goes on: the level for the width, then the opposite. A new
    /// pulse on the channel ends the old one.
    fn pulsedo(
        chan: int [addresses(Space::DigitalOutput)] "the output",
        value: bool "true for a high pulse, false for a low one",
        width: double [units(&[Unit::Second])] "length of the pulse, s, 0 or more; the pulse lasts at least 0.025",
    )
        { "5.5.6", io::pulsedo, waits, fails; "pulsedo(5,true,0.2)\nwaittime 0.1\nprint getdo(5)" }
    /// Level of a digital output.
    fn getdo(chan: int [addresses(Space::DigitalOutput)] "the output") -> bool
        { "5.5.7", io::getdo, waits, looks, fails; "setdo(3,true)\nprint getdo(3)" }
    /// Levels of up to 32 neighbouring digital outputs, lowest bit for the first.
    fn getdo(from_chan: int [addresses(Space::DigitalOutput)] "the first output", to_chan: int [addresses(Space::DigitalOutput)] "the last output") -> int
        { "5.5.8", io::getdo_group, waits, looks, fails; "setdo(5,8,1001b)\nprint getdo(5,8)" }
    /// Level of a digital input.
    fn getdi(chan: int [addresses(Space::DigitalInput)] "the input") -> bool
        { "5.5.9", io::getdi, waits, looks, fails; "print getdi(4)" }
    /// Levels of up to 32 neighbouring digital inputs, lowest bit for the first.
    fn getdi(from_chan: int [addresses(Space::DigitalInput)] "the first input", to_chan: int [addresses(Space::DigitalInput)] "the last input") -> int
        { "5.5.10", io::getdi_group, waits, looks, fails; "print getdi(6,9)" }
    /// Value of an analog input: V or mA, as the channel is configured.
    fn getai(chan: int [addresses(Space::AnalogInput)] "the input") -> double
        { "5.5.11", io::getai, waits, looks, fails; "print getai(2)" }
    /// Level of a digital input now, without waiting for motion: the program may be far ahead of the robot.
    fn getnostopdi(chan: int [addresses(Space::DigitalInput)] "the input") -> bool
        { "5.5.12", io::getnostopdi, acts, looks, fails; "print getnostopdi(4)" }
    /// Sets an analog output. A value outside the channel's type: alarm.
    fn setao(chan: int [addresses(Space::AnalogOutput)] "the output", value: double [content] "-10 to 10 V, or 4 to 20 mA, as the channel is configured")
        { "5.5.13", io::setao, waits, fails; "setao(2,5.2)" }
    /// Sets an analog output and goes on when it has been sent.
    fn syncao(chan: int [addresses(Space::AnalogOutput)] "the output", value: double [content] "-10 to 10 V, or 4 to 20 mA, as the channel is configured")
        { "5.5.14", io::syncao, waits, fails; "syncao(2,5.2)" }
    /// Value of an analog output: V or mA, as the channel is configured.
    fn getao(chan: int [addresses(Space::AnalogOutput)] "the output") -> double
        { "5.5.15", io::getao, waits, looks, fails; "setao(1,5.2)\nprint getao(1)" }
    /// Level of an internal output signal.
    fn getintdo(chan: int [addresses(Space::InternalSignal)] "the signal") -> bool
        { "5.5.16", io::getintdo, waits, looks, fails; "print getintdo(1)" }
    /// Level of an internal input signal.
    fn getintdi(chan: int [addresses(Space::InternalSignal)] "the signal") -> bool
        { "5.5.17", io::getintdi, waits, looks, fails; "print getintdi(1)" }
    /// Sets frequency and duty cycle of a PWM output; true: it has been set. Another channel, frequency or duty cycle
    /// than the controller has: alarm.
    fn setpwm(
        channel: int [range(1.0, 3.0)] "the PWM output, 1 to 3",
        freq: int [range(10.0, 10000.0)] "frequency, Hz, 10 to 10000",
        ratio: int [range(0.0, 100.0)] "duty cycle, %, 0 to 100",
    ) -> bool
        { "5.5.18", io::setpwm, waits, fails; "print setpwm(1,20,50)" }
}
