//! Orders from outside, in the words of a scenario.

use super::{Controller, act};
use crate::io::{Effect, Order};
use arl_robot::cell::Names;

impl Controller {
    /// What the cell calls signals.
    pub fn names(&self) -> &Names {
        &self.names
    }

    /// Does now what an event of an io [`Scenario`](crate::io::Scenario) does, in the same words: `di.5 = true`,
    /// `ai.2 = 4.2`, `pendant = "start"`, `override = 50`; several of them stand on lines of their own. Signals may be called by
    /// the names that the cell has for them.
    ///
    /// # Errors
    /// The text is no order, or it names what is not there; then nothing of it was done.
    pub fn order(&mut self, text: &str) -> Result<(), String> {
        let order = Order::parse(text, &self.names).map_err(|error| error.message)?;
        let robots: Vec<_> = self.channels.units().map(|unit| unit.borrow().shared_robot()).collect();
        let robots: Vec<_> = robots.iter().map(|robot| &**robot).collect();
        // An effect may look at the image itself.
        let mut effects = Vec::new();
        order.carry_out(&mut self.shared.io.borrow_mut(), &robots, |effect| effects.push(effect))?;
        for effect in effects {
            match effect {
                Effect::Pendant(button) => self.press(button),
                effect => act(&mut self.channels, effect),
            }
        }
        Ok(())
    }
}
