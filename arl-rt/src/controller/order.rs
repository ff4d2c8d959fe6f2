//! Orders from outside, in the words of a scenario.

use std::fmt;

use super::Controller;
use super::effects::act;
use crate::io::{Effect, Order};
use arl_robot::cell::Names;

impl Controller {
    /// The cell's names for signals.
    pub fn names(&self) -> &Names {
        &self.names
    }

    /// Carries out now what an event of an io [`Scenario`](crate::io::Scenario) does, in the same words: `di.5 = true`,
    /// `ai.2 = 4.2`, `pendant = "start"`, `override = 50`; several orders are written on lines of their own. Signals
    /// may be given by the cell's names for them.
    ///
    /// # Errors
    /// The text is not an order, or it names something that does not exist; then nothing was done.
    pub fn order(&mut self, text: &str) -> Result<(), OrderError> {
        let order = Order::parse(text, &self.names).map_err(|error| OrderError::Text(error.message))?;
        let robots: Vec<_> = self.channels.units().map(|unit| unit.borrow().shared_robot()).collect();
        let robots: Vec<_> = robots.iter().map(|robot| &**robot).collect();
        // An effect may access the image itself.
        let mut effects = Vec::new();
        let done = order.carry_out(&mut self.shared.io.borrow_mut(), &robots, |effect| effects.push(effect));
        done.map_err(OrderError::NotThere)?;
        for effect in effects {
            match effect {
                Effect::Pendant(button) => self.press(button),
                effect => act(&mut self.channels, effect),
            }
        }
        Ok(())
    }
}

/// The reason why an order was not carried out.
#[derive(Clone, PartialEq, Eq, Debug)]
#[non_exhaustive]
pub enum OrderError {
    /// The text is not an order; the error in it.
    Text(String),
    /// The signal, axis or robot does not exist, or cannot do it; which one.
    NotThere(String),
}

impl fmt::Display for OrderError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            OrderError::Text(why) | OrderError::NotThere(why) => write!(f, "{why}"),
        }
    }
}

impl std::error::Error for OrderError {}
