//! System variables are stored beside the cycle (manual 5.12.5 and chapter 10).
#![allow(clippy::unwrap_used, reason = "these are tests")]

mod common;

use std::collections::BTreeMap;
use std::io;
use std::sync::{Arc, Condvar, Mutex};
use std::time::Duration;

use arl_rt::clock::Clock;
use arl_rt::emit::*;
use arl_rt::storage::Storage;
use arl_rt::{Controller, Outcome};
use common::*;

/// A storage for values of variables that stores as long as its gate is open, and waits else.
#[derive(Clone, Default)]
struct Gated(Arc<(Mutex<Stored>, Condvar)>);

#[derive(Default)]
struct Stored {
    values: BTreeMap<String, String>,
    open: bool,
    /// What it says in place of storing.
    error: Option<&'static str>,
}

impl Gated {
    fn open() -> Self {
        let gated = Self::default();
        gated.open_gate();
        gated
    }

    fn open_gate(&self) {
        self.0.0.lock().unwrap().open = true;
        self.0.1.notify_all();
    }

    fn value(&self, name: &str) -> Option<String> {
        self.0.0.lock().unwrap().values.get(name).cloned()
    }

    /// Waits until a value has this part. The test hangs where it never has.
    fn wait_for(&self, name: &str, part: &str) {
        while self.value(name).is_none_or(|value| !value.contains(part)) {
            std::thread::sleep(Duration::from_millis(1));
        }
    }
}

impl Storage for Gated {
    fn load(&self, _: &str) -> io::Result<Option<Vec<u8>>> {
        Ok(None)
    }

    fn store(&mut self, name: &str, content: &[u8]) -> io::Result<()> {
        if name == "POINTERS" {
            return Ok(());
        }
        let mut stored = self.0.1.wait_while(self.0.0.lock().unwrap(), |stored| !stored.open).unwrap();
        if let Some(error) = stored.error {
            return Err(io::Error::other(error));
        }
        stored.values.insert(name.to_owned(), String::from_utf8(content.to_vec()).unwrap());
        Ok(())
    }

    fn another(&self) -> Option<Box<dyn Storage + Send>> {
        Some(Box::new(self.clone()))
    }
}

/// A clock of the world whose cycles the test makes.
struct Paced;

impl Clock for Paced {
    fn wait_for(&mut self, _: u64, _: f64) {}
}

/// Saves `$I` and says when it goes on.
fn saving(cx: &Cx) -> BoxFuture<'_> {
    Box::pin(async move {
        system::savesv(cx, &"I".into()).await.at(FILE, 1)?;
        say(cx, &convert::tostr(&cx.time()))
    })
}

#[test]
fn cycles_go_on_while_a_value_is_stored() {
    let gated = Gated::default();
    let (mut controller, messages) = controller(Controller::builder().storage(gated.clone()).clock(Paced), saving);
    controller.run_for(0.5);
    assert_eq!((controller.outcome(), messages.text()), (None, String::new()));
    gated.open_gate();
    assert_eq!(controller.run(), Outcome::Ended);
    assert!(gated.value("I").is_some() && !messages.text().is_empty());
}

#[test]
fn on_the_virtual_clock_a_value_is_stored_in_one_cycle() {
    let gated = Gated::default();
    let (mut controller, messages) = controller(Controller::builder().storage(gated.clone()), saving);
    let opener = std::thread::spawn(move || {
        std::thread::sleep(Duration::from_millis(20));
        gated.open_gate();
    });
    assert_eq!(controller.run(), Outcome::Ended);
    opener.join().unwrap();
    assert_eq!(messages.text(), "0.001\n");
}

#[test]
fn changes_are_kept_while_the_program_runs() {
    let gated = Gated::open();
    let (mut controller, _) = controller(Controller::builder().storage(gated.clone()), |cx| {
        Box::pin(async move {
            for name in ["first", "second", "third"] {
                cx.system().i_name.set_item(7, name.into());
                flow::waittime(0.3).run(cx).await.at(FILE, 1)?;
            }
            loop {
                cx.next_cycle().await;
            }
        })
    });
    controller.run_for(0.1);
    gated.wait_for("I_NAME", "first");
    controller.run_for(0.8);
    // Not more than once a second.
    assert!(gated.value("I_NAME").unwrap().contains("first"));
    controller.run_for(0.2);
    gated.wait_for("I_NAME", "third");
    controller.system().b_name.set_item(0, "before the end".into());
    drop(controller);
    assert!(gated.value("B_NAME").unwrap().contains("before%20the%20end"));
    assert!(gated.value("D_NAME").is_none(), "what has not changed is not stored");
}

#[test]
fn what_cannot_be_stored_is_reported() {
    let gated = Gated::open();
    gated.0.0.lock().unwrap().error = Some("the disk is full");
    let (mut controller, _) = controller(Controller::builder().storage(gated.clone()), |cx| {
        Box::pin(async move {
            cx.system().i_name.set_item(7, "name".into());
            system::savesv(cx, &"I".into()).await.at(FILE, 1)
        })
    });
    assert!(matches!(controller.run(), Outcome::Alarm(alarm) if alarm.to_string().contains("the disk is full")));
    let warnings = controller.take_warnings();
    assert!(
        matches!(&warnings[..], [one] if one.contains("cannot be saved") && one.contains("I_NAME")),
        "{warnings:?}"
    );
}
