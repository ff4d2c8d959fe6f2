//! Global variables as Rust has them: set once a program has given them their first values, read at any time.

#![allow(clippy::unwrap_used, clippy::panic, reason = "tests may fail")]

mod common;

use std::cell::Cell;

use arl_rt::emit::At;
use arl_rt::emit::{BoxFuture, Cx, Family, File, Program, Shared, Str, flow};
use arl_rt::program::Elsewhere;
use arl_rt::status::ChannelId;
use arl_rt::{Captured, Controller, Foreground, Outcome};
use common::{FILE, say};

/// What the compiler emits for `int parts = 3`, `string name = "a"`, and a program that counts down.
#[derive(Default)]
struct Globals {
    parts: Cell<i32>,
    name: Shared<Str>,
}

impl Program for Globals {
    fn file(&self) -> File {
        FILE
    }

    fn family(&self) -> Family {
        Family::SixAxis
    }

    fn init<'a>(&'a self, _cx: &'a Cx) -> BoxFuture<'a> {
        Box::pin(async {
            self.parts.set(3);
            self.name.set("a".into());
            Ok(())
        })
    }

    fn main<'a>(&'a self, cx: &'a Cx) -> BoxFuture<'a> {
        Box::pin(async move {
            while self.parts.get() > 0 {
                say(cx, &self.parts.get())?;
                self.parts.set(self.parts.get() - 1);
                flow::waittime(0.1).run(cx).await.at(FILE, 2)?;
            }
            say(cx, &self.name.get())
        })
    }
}

#[test]
fn they_are_set_once_they_have_their_first_values_also_after_a_reset() {
    let messages = Captured::new();
    let mut controller = Controller::builder()
        .output(messages.clone())
        .on_init(|globals: &Globals| globals.parts.set(globals.parts.get() - 1))
        .on_init(|globals: &Globals| globals.name.set("b".into()))
        .on_init(|_: &String| panic!("no program has such globals"))
        .build(Box::new(Globals::default()))
        .unwrap();
    assert_eq!(controller.run(), Outcome::Ended);
    assert_eq!(messages.take(), "2\n1\nb\n");
    controller.reset().unwrap();
    assert_eq!(controller.run(), Outcome::Ended);
    assert_eq!(messages.take(), "2\n1\nb\n");
}

#[test]
fn they_are_read_and_set_between_two_cycles() {
    let messages = Captured::new();
    let second = Elsewhere { program: Globals::default(), folder: "other".into() };
    let mut controller = Controller::builder()
        .output(messages.clone())
        .foreground(Foreground::new(Box::new(second)))
        .build(Box::new(Globals::default()))
        .unwrap();
    controller.run_for(0.15);
    assert_eq!(controller.globals::<Globals>().unwrap().parts.get(), 1);
    controller.globals::<Globals>().unwrap().parts.set(0);
    let second = controller.globals_of::<Globals>(ChannelId::Foreground(2)).unwrap();
    assert_eq!(second.parts.get(), 1, "those of the program that lies elsewhere");
    assert!(controller.globals::<String>().is_none());
    assert!(controller.globals_of::<Globals>(ChannelId::Foreground(3)).is_none());
    let handle = controller.handle();
    let asking = std::thread::spawn(move || handle.ask(|it| it.globals::<Globals>().map(|it| it.parts.get())));
    while !asking.is_finished() {
        controller.step();
    }
    assert_eq!(asking.join().unwrap().unwrap(), Some(0));
    assert_eq!(controller.run(), Outcome::Ended);
}
