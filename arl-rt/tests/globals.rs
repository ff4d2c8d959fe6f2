//! Global variables as Rust has them: set once a program has given them their first values, read at any time.

#![allow(clippy::unwrap_used, clippy::panic, reason = "tests may fail")]

mod common;

use std::cell::Cell;

use arl_rt::emit::At;
use arl_rt::emit::{BoxFuture, Cx, Family, File, Pose, Program, Shared, Str, flow};
use arl_rt::program::{DataFile, DataVar, Elsewhere};
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

/// The same as it is emitted with names, from two files.
#[derive(Default)]
struct Named {
    globals: Globals,
    other: Cell<i32>,
    place: Cell<Pose>,
}

impl Program for Named {
    fn file(&self) -> File {
        FILE
    }

    fn family(&self) -> Family {
        Family::SixAxis
    }

    fn init<'a>(&'a self, cx: &'a Cx) -> BoxFuture<'a> {
        self.place.set(Pose { x: 1.0, y: 2.0, ..Pose::default() });
        self.globals.init(cx)
    }

    fn main<'a>(&'a self, cx: &'a Cx) -> BoxFuture<'a> {
        self.globals.main(cx)
    }

    fn variables(&self) -> Vec<DataFile<'_>> {
        let own = |name, slot| DataVar { name, sizes: &[], slot };
        let first =
            vec![own("parts", &self.globals.parts as _), own("name", &self.globals.name), own("place", &self.place)];
        vec![
            DataFile { file: "count.arl", vars: first },
            DataFile { file: "tools/more.arl", vars: vec![own("parts", &self.other)] },
        ]
    }
}

#[test]
fn they_are_set_by_name_where_the_program_has_names() {
    let messages = Captured::new();
    let mut controller = Controller::builder()
        .output(messages.clone())
        .global("count::parts", "1")
        .global("NAME", "\"b\"")
        .global("place", "{y 5}")
        .build(Box::new(Named::default()))
        .unwrap();
    assert_eq!(controller.run(), Outcome::Ended);
    assert_eq!(messages.take(), "1\nb\n");
    let place = controller.global("place").unwrap();
    assert!(place.contains("x 1") && place.contains("y 5"), "what is left out stays: {place}");
    controller.set_global("more::parts", "7").unwrap();
    assert_eq!(controller.global("more::parts").as_deref(), Ok("7"));
    assert_eq!(controller.global("count::parts").as_deref(), Ok("0"));
}

#[test]
fn a_name_that_is_none_is_reported_before_anything_begins() {
    let refused = |name: &str, value: &str| {
        let built = Controller::builder().global(name, value).build(Box::new(Named::default()));
        built.map(drop).unwrap_err().to_string()
    };
    assert!(
        refused("parts", "1")
            .contains("one in count.arl and one in tools/more.arl; `count::parts` is the one in count.arl")
    );
    assert!(refused("nme", "\"b\"").contains("did you mean `name`?"));
    assert!(refused("speed", "1").contains("there are parts, name, place, parts"));
    assert!(refused("place", "{q 1}").contains("pose has no component q"));
    assert!(refused("name", "5").contains("global variable `name` = 5: expected a value of type string"));
    assert!(refused("name", "getdi(1)").contains("global variable `name`"));
    let without = Controller::builder().global("parts", "1").build(Box::new(Globals::default()));
    assert!(without.map(drop).unwrap_err().to_string().contains("was compiled without their names"));
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
