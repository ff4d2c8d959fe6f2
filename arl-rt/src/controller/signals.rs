//! Inputs and outputs, for who drives the controller.

use super::Controller;
use crate::fault::Fault;
use crate::io::{Digital, Pwm};

impl Controller {
    /// Sets a digital input, from 1.
    ///
    /// # Errors
    /// There is no such channel.
    pub fn set_digital_input(&mut self, channel: i32, level: bool) -> Result<(), Fault> {
        self.shared.io.borrow_mut().set_digital(Digital::Di, channel, level)
    }

    /// The level of a digital input, from 1.
    ///
    /// # Errors
    /// There is no such channel.
    pub fn digital_input(&self, channel: i32) -> Result<bool, Fault> {
        self.shared.io.borrow().digital(Digital::Di, channel)
    }

    /// The level of a digital output, from 1.
    ///
    /// # Errors
    /// There is no such channel.
    pub fn digital_output(&self, channel: i32) -> Result<bool, Fault> {
        self.shared.io.borrow().digital(Digital::Do, channel)
    }

    /// Sets an analog input, from 1, in V or mA.
    ///
    /// # Errors
    /// There is no such channel, or its type cannot carry the value.
    pub fn set_analog_input(&mut self, channel: i32, value: f64) -> Result<(), Fault> {
        self.shared.io.borrow_mut().set_analog_input(channel, value)
    }

    /// The value of an analog output, from 1, in V or mA.
    ///
    /// # Errors
    /// There is no such channel.
    pub fn analog_output(&self, channel: i32) -> Result<f64, Fault> {
        self.shared.io.borrow().analog_output(channel)
    }

    /// The state of a PWM output, from 1.
    ///
    /// # Errors
    /// There is no such channel.
    pub fn pwm(&self, channel: i32) -> Result<Pwm, Fault> {
        self.shared.io.borrow().pwm(channel)
    }

    /// Sets an internal input signal, from 1.
    ///
    /// # Errors
    /// There is no such channel.
    pub fn set_internal_input(&mut self, channel: i32, level: bool) -> Result<(), Fault> {
        self.shared.io.borrow_mut().set_digital(Digital::InternalIn, channel, level)
    }

    /// Sets an internal output signal, from 1: the internal PLC's, which programs can only read.
    ///
    /// # Errors
    /// There is no such channel.
    pub fn set_internal_output(&mut self, channel: i32, level: bool) -> Result<(), Fault> {
        self.shared.io.borrow_mut().set_digital(Digital::InternalOut, channel, level)
    }

    /// The level of an internal output signal, from 1.
    ///
    /// # Errors
    /// There is no such channel.
    pub fn internal_output(&self, channel: i32) -> Result<bool, Fault> {
        self.shared.io.borrow().digital(Digital::InternalOut, channel)
    }
}
