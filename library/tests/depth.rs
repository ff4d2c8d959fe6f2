//! Functions that call themselves as deep as everywhere, on a thread of the host with little stack.

#![allow(clippy::unwrap_used, reason = "tests may fail")]

use arl_library::{Library, LoadError};
use arl_rt::emit::*;

const FILE: File = File::new("deep.arl");
/// Nearly as many calls as may be nested.
const CALLS: u32 = 19_990;

/// Calls itself, and says so or not.
struct Deep {
    says_so: bool,
}

fn deep(cx: &Cx, calls: u32) -> Result<u32, Fault> {
    let _entered = cx.enter(1, 0)?;
    let frame = std::hint::black_box([calls; 64]);
    if calls == 0 { Ok(0) } else { Ok(deep(cx, calls - 1)? + frame[63] - calls + 1) }
}

impl Program for Deep {
    fn file(&self) -> File {
        FILE
    }

    fn family(&self) -> Family {
        Family::SixAxis
    }

    fn main<'a>(&'a self, cx: &'a Cx) -> BoxFuture<'a> {
        Box::pin(async move {
            let calls = deep(cx, CALLS).at(FILE, 2)? as i32;
            text::print().argtoprint(&calls).run(cx).at(FILE, 3)
        })
    }

    fn recurs(&self) -> bool {
        self.says_so
    }
}

/// The exit code of a run, and what it said.
fn run(says_so: bool) -> (Result<Option<u8>, LoadError>, String) {
    let make = move || Box::new(Deep { says_so }) as Box<dyn Program>;
    let library = Library::in_process(make, Vec::new(), ".".to_owned());
    let thread = std::thread::Builder::new().stack_size(2 << 20);
    let run = move || {
        let mut run = library.begin(&[], true).unwrap();
        (run.go_on(10, true), run.take_said())
    };
    thread.spawn(run).unwrap().join().unwrap()
}

#[test]
fn calls_are_nested_as_deep_as_in_a_process_of_their_own() {
    let (code, said) = run(true);
    assert_eq!(code, Ok(Some(0)), "{said}");
    assert!(said.contains(&CALLS.to_string()), "{said}");
    // The thread of the host alone is not enough for that, which is an alarm.
    let (code, said) = run(false);
    assert_eq!(code, Ok(Some(3)), "{said}");
}
