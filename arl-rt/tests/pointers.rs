//! Program and motion pointers outlive the controller (manual 5.12.8 to 5.12.11).
#![allow(clippy::unwrap_used, reason = "these are tests")]

mod common;

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::io;
use std::path::PathBuf;
use std::rc::Rc;

use arl_rt::emit::*;
use arl_rt::storage::{Directory, Storage};
use arl_rt::{Controller, Foreground, Outcome};
use common::*;

/// A state directory that is removed at the end.
struct State(PathBuf);

impl State {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("arl-rt-pointers-{name}-{}", std::process::id()));
        let _ = std::fs::remove_dir_all(&path);
        Self(path)
    }

    fn builder(&self) -> arl_rt::Builder {
        Controller::builder().storage(Directory::new(&self.0))
    }

    fn text(&self) -> String {
        std::fs::read_to_string(self.0.join("POINTERS.state")).unwrap()
    }
}

impl Drop for State {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

/// Moves the robot in line 3, says something in line 4 and waits for ever in line 5 of this file.
fn moving(file: &'static str) -> impl Fn(&Cx) -> BoxFuture<'_> + 'static {
    let file = File::new(file);
    move |cx| {
        Box::pin(async move {
            cx.line(file, 3);
            motion::movej(bent(10.0)).vp(100.0).run(cx).await.at(file, 3)?;
            cx.line(file, 5);
            flow::waittime(0.0).run(cx).await.at(file, 5)?;
            loop {
                cx.next_cycle().await;
            }
        })
    }
}

/// Says where the channel with this number stands.
fn tell(cx: &Cx, number: i32) -> Done<()> {
    let motion = (channel::curmpfile(cx, number).at(FILE, 1)?, channel::curmpline(cx, number).at(FILE, 1)?);
    let program = (channel::curppfile(cx, number).at(FILE, 1)?, channel::curppline(cx, number).at(FILE, 1)?);
    let text = format!("{} {}, {} {}", motion.0.to_text(), motion.1, program.0.to_text(), program.1);
    say(cx, &Str::from(text.as_str()))
}

#[test]
fn another_controller_knows_where_programs_stood_until_they_run_again() {
    let state = State::new("kept");
    let second = Foreground::new(Box::new(script(moving("second.arl"))));
    let (mut before, _) = controller(state.builder().foreground(second), moving("first.arl"));
    before.run_for(2.0);
    drop(before);

    let second = Foreground::new(Box::new(script(|cx| {
        Box::pin(async move {
            cx.line(FILE, 8);
            flow::waittime(0.1).run(cx).await.at(FILE, 8)?;
            cx.line(FILE, 9);
            motion::movej(bent(-10.0)).vp(100.0).run(cx).await.at(FILE, 9)?;
            cx.line(FILE, 10);
            flow::waittime(0.0).run(cx).await.at(FILE, 10)
        })
    })));
    let (mut after, messages) = controller(state.builder().foreground(second), |cx| {
        Box::pin(async move {
            cx.line(FILE, 2);
            // The second channel's program has not run yet. This one does, and no motion of it.
            tell(cx, 1)?;
            tell(cx, 2)?;
            cx.next_cycle().await;
            tell(cx, 2)?;
            flow::waittime(2.0).run(cx).await.at(FILE, 4)?;
            tell(cx, 2)
        })
    });
    assert_eq!(after.run(), Outcome::Ended);
    let expected =
        ["first.arl 3, t.arl 2\n", "second.arl 3, second.arl 5\n", "second.arl 3, t.arl 8\n", "t.arl 9, t.arl 10\n"];
    assert_eq!(messages.text(), expected.concat());
    let text = state.text();
    let kept: Vec<&str> = text.lines().take(4).collect();
    let expected =
        ["program 1 \"t.arl\" 2", "motion 1 \"first.arl\" 3", "program 2 \"t.arl\" 10", "motion 2 \"t.arl\" 9"];
    assert_eq!(kept, expected);
}

#[test]
fn a_channel_that_is_not_there_this_time_keeps_its_own() {
    let state = State::new("others");
    let second = Foreground::new(Box::new(script(moving("second.arl"))));
    let (mut before, _) = controller(state.builder().foreground(second), moving("first.arl"));
    before.run_for(2.0);
    drop(before);
    let (mut alone, _) = controller(state.builder(), |cx| Box::pin(async move { tell(cx, 1) }));
    assert_eq!(alone.run(), Outcome::Ended);
    assert!(state.text().contains("program 2 \"second.arl\" 5\nmotion 2 \"second.arl\" 3\n"), "{}", state.text());
}

#[test]
fn a_program_that_waits_for_the_start_button_has_not_run() {
    let state = State::new("paused");
    let (mut before, _) = controller(state.builder(), moving("first.arl"));
    before.run_for(2.0);
    drop(before);
    let (mut after, messages) = controller(state.builder(), |cx| Box::pin(async move { tell(cx, 1) }));
    after.press(arl_rt::io::Pendant::Pause);
    after.run_for(0.1);
    after.settle_state();
    assert!(state.text().starts_with("program 1 \"first.arl\" 5\nmotion 1 \"first.arl\" 3\n"), "{}", state.text());
    after.resume();
    assert_eq!(after.run(), Outcome::Ended);
    assert_eq!(messages.text(), "first.arl 3, t.arl 0\n");
}

#[test]
fn what_cannot_be_stored_beside_the_cycle_is_not_kept() {
    /// Keeps values in this thread.
    #[derive(Clone, Default)]
    struct Here(Rc<RefCell<BTreeMap<String, Vec<u8>>>>);

    impl Storage for Here {
        fn load(&self, name: &str) -> io::Result<Option<Vec<u8>>> {
            Ok(self.0.borrow().get(name).cloned())
        }

        fn store(&mut self, name: &str, content: &[u8]) -> io::Result<()> {
            self.0.borrow_mut().insert(name.to_owned(), content.to_vec());
            Ok(())
        }
    }

    let here = Here::default();
    let (mut only, _) = controller(Controller::builder().storage(here.clone()), |cx| {
        Box::pin(async move { system::savesv(cx, &"I".into()).await.at(FILE, 1) })
    });
    assert_eq!(only.run(), Outcome::Ended);
    assert_eq!(here.0.borrow().keys().collect::<Vec<_>>(), ["I"]);
}
