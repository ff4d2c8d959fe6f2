//! `enableint`, `disableint` and `delint` enable, disable and delete interrupts and timers.

use crate::context::cx::Cx;
use crate::context::events::{EventTable, Which, priority};
use crate::fault::Fault;
use crate::values::Str;

/// Declares an instruction that acts on interrupts and timers.
macro_rules! switch {
    (
        $(#[doc = $doc:literal])+
        $name:ident $builder:ident |$table:ident, $found:ident, $now:ident| $effect:expr
    ) => {
        $(#[doc = $doc])+
        pub fn $name() -> $builder {
            $builder::default()
        }

        #[doc = concat!("`", stringify!($name), "`, ready to run. Without name and priority all are meant.")]
        #[derive(Clone, Default, Debug)]
        #[must_use = "an instruction does nothing until it is run"]
        pub struct $builder {
            name: Option<Str>,
            priority: Option<i32>,
        }

        impl $builder {
            /// Selects the one with this name.
            pub fn name(mut self, name: &Str) -> Self {
                self.name = Some(name.clone());
                self
            }

            /// Selects all of this priority.
            pub fn priority(mut self, priority: i32) -> Self {
                self.priority = Some(priority);
                self
            }

            /// Acts at once.
            ///
            /// # Errors
            /// Nothing has this name or priority.
            pub fn run(self, cx: &Cx) -> Result<(), Fault> {
                const FUNCTION: &str = stringify!($name);
                let which = which(FUNCTION, self.name, self.priority)?;
                let ($table, $now): (&mut EventTable, u64) = (&mut cx.events().borrow_mut(), cx.cycle());
                let $found = $table.find(FUNCTION, &which)?;
                $effect;
                Ok(())
            }
        }
    };
}

switch! {
    /// `enableint`: enables interrupts and timers again. A timer that was disabled restarts its interval.
    enableint EnableInt |table, found, now| table.enable(&found, now)
}

switch! {
    /// `disableint`: interrupts still monitor their conditions, but drop their events, also those that wait to be
    /// handled.
    disableint DisableInt |table, found, _now| table.disable(&found)
}

switch! {
    /// `delint`: deletes interrupts and timers. A running action continues to its end.
    delint DelInt |table, found, _now| table.delete(&found)
}

fn which(function: &'static str, name: Option<Str>, of: Option<i32>) -> Result<Which, Fault> {
    if name.is_none() && of.is_none() {
        return Ok(Which::All);
    }
    Ok(Which::These { name, priority: of.map(|of| priority(of, function)).transpose()? })
}
