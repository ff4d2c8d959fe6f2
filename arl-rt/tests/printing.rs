//! `print` and the files of a program.
#![allow(clippy::unwrap_used, reason = "helpers of tests are tests, too")]

mod common;

use std::cell::RefCell;
use std::path::PathBuf;
use std::rc::Rc;

use arl_rt::emit::*;
use arl_rt::{Controller, Message, Outcome};
use common::*;

/// A script directory that is removed at the end.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("arl-rt-print-{name}-{}", std::process::id()));
        let _ = std::fs::remove_dir_all(&path);
        std::fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    fn text(&self, name: &str) -> String {
        std::fs::read_to_string(self.0.join(name)).unwrap()
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

#[test]
fn styles_hold_for_the_rest_of_one_message() {
    let (_, text) = run(|cx| {
        Box::pin(async move {
            text::print().precision(3).argtoprint(&"PI:").argtoprint(&std::f64::consts::PI).run(cx).at(FILE, 1)?;
            let message = text::print().argtoprint(&"255 =").numbase(NumBase::Hex).argtoprint(&255).argtoprint(&"h");
            message.numbase(NumBase::Dec).argtoprint(&16).run(cx).at(FILE, 2)?;
            text::print().argtoprint(&255).argtoprint(&" ").argtoprint(&std::f64::consts::PI).run(cx).at(FILE, 3)?;
            text::print().argtoprint(&"ends by itself\n").run(cx).at(FILE, 4)?;
            text::print().precision(-1).argtoprint(&1.5).run(cx).at(FILE, 5)
        })
    });
    assert_eq!(text, "PI:3.14\n255 =ffh16\n255 3.14159\nends by itself\n");
}

#[test]
fn targets_are_modal_and_the_same_stream_gets_a_message_once() {
    let seen = Rc::new(RefCell::new(Vec::new()));
    let keep = Rc::clone(&seen);
    let output = move |message: &Message<'_>| {
        keep.borrow_mut().push((message.hmi, message.console, String::from_utf8_lossy(message.text).into_owned()));
    };
    let mut controller = plain(Controller::builder().output(output), |cx| {
        Box::pin(async move {
            let say = |text: &'static str| text::print().argtoprint(&text);
            say("a").run(cx).at(FILE, 1)?;
            say("b").to(Printto::Console).run(cx).at(FILE, 2)?;
            say("c").run(cx).at(FILE, 3)?;
            say("d").to(Printto::Hmi).to(Printto::Console).run(cx).at(FILE, 4)?;
            say("e").to(Printto::Hmi).to(Printto::Off).run(cx).at(FILE, 5)?;
            say("f").run(cx).at(FILE, 6)?;
            say("g").to(Printto::Console).to(Printto::Off).to(Printto::Hmi).run(cx).at(FILE, 7)?;
            let mut text = Str::new();
            say("h").tostr(&mut text).run(cx).at(FILE, 8)?;
            text::print().argtoprint(&text).argtoprint(&"i").run(cx).at(FILE, 9)
        })
    });
    assert_eq!(controller.run(), Outcome::Ended);
    let message = |hmi, console, text: &str| (hmi, console, text.to_owned());
    let expected = [
        message(true, false, "a"),
        message(false, true, "b"),
        message(false, true, "c"),
        message(true, true, "d"),
        message(true, false, "g"),
        message(true, false, "hi"),
    ];
    assert_eq!(*seen.borrow(), expected);
}

#[test]
fn files_are_appended_below_the_script_directory() {
    let folder = Folder::new("append");
    let (mut controller, messages) = controller(Controller::builder().script_dir(&folder.0), |cx| {
        Box::pin(async move {
            for i in 1..=3 {
                let to = text::print().to(Printto::File).filepath(&"mylog".into());
                to.argtoprint(&"loop ").argtoprint(&i).argtoprint(&"\n").run(cx).at(FILE, 1)?;
            }
            text::print().argtoprint(&"same file").run(cx).at(FILE, 2)?;
            let both = text::print().to(Printto::File).to(Printto::Hmi).filepath(&"/home/ae/script/other".into());
            both.argtoprint(&"both").run(cx).at(FILE, 3)
        })
    });
    assert_eq!(controller.run(), Outcome::Ended);
    assert_eq!(folder.text("mylog"), "loop 1\nloop 2\nloop 3\nsame file\n");
    assert_eq!(folder.text("other"), "both\n");
    assert_eq!(messages.text(), "both\n");
}

#[test]
fn paths_that_lead_elsewhere_are_alarms() {
    let folder = Folder::new("elsewhere");
    for (path, words) in
        [("../x", "`..` may lead out"), ("/tmp/x", "relative to the script directory"), ("missing/x", "does not exist")]
    {
        let (mut controller, _) = controller(Controller::builder().script_dir(&folder.0), move |cx| {
            Box::pin(async move {
                text::print().to(Printto::File).filepath(&path.into()).argtoprint(&1).run(cx).at(FILE, 6)
            })
        });
        let text = alarm(controller.run());
        assert!(text.starts_with("alarm 20009: ") && text.contains(words), "{text}");
    }
    assert_eq!(std::fs::read_dir(&folder.0).unwrap().count(), 0);
    let (outcome, _) =
        run(|cx| Box::pin(async move { text::print().to(Printto::File).argtoprint(&1).run(cx).at(FILE, 6) }));
    assert_eq!(alarm(outcome), "alarm 20004: print: to:file needs a file name: filepath:\"...\" (t.arl:6)");
}

#[test]
fn text_files_are_read_renamed_and_removed() {
    let folder = Folder::new("read");
    std::fs::write(folder.0.join("lines.txt"), "one\r\ntwo\n\nfour").unwrap();
    std::fs::write(folder.0.join("empty.txt"), "").unwrap();
    std::fs::create_dir(folder.0.join("USB")).unwrap();
    std::fs::write(folder.0.join("USB/stick.txt"), "from outside\n").unwrap();
    let (mut controller, messages) = controller(Controller::builder().script_dir(&folder.0), |cx| {
        Box::pin(async move {
            let name = Str::from("lines.txt");
            for line in 1..=4 {
                say(cx, &files::gettextstr(cx, &name, line, false).await.at(FILE, 1)?)?;
            }
            say(cx, &files::gettextstr(cx, &"stick.txt".into(), 1, true).await.at(FILE, 2)?)?;
            say(cx, &files::filesize(cx, &name).await.at(FILE, 3)?)?;
            say(cx, &files::renamefile(cx, &name, &"empty.txt".into()).await.at(FILE, 4)?)?;
            say(cx, &files::renamefile(cx, &name, &"new.txt".into()).await.at(FILE, 5)?)?;
            say(cx, &files::renamefile(cx, &name, &"other.txt".into()).await.at(FILE, 6)?)?;
            say(cx, &files::removefile(cx, &"new.txt".into()).await.at(FILE, 7)?)?;
            say(cx, &files::removefile(cx, &"new.txt".into()).await.at(FILE, 8)?)?;
            files::gettextstr(cx, &"empty.txt".into(), 1, false).await.at(FILE, 9).map(|_| ())
        })
    });
    assert_eq!(alarm(controller.run()), "alarm 10065: line 1 was asked for, but the file has 0 lines (t.arl:9)");
    assert_eq!(messages.text(), "one\ntwo\n\nfour\nfrom outside\n14\nfalse\ntrue\nfalse\ntrue\nfalse\n");
    let (mut controller, _) = common::controller(Controller::builder().script_dir(&folder.0), |cx| {
        Box::pin(async move { files::gettextstr(cx, &"gone.txt".into(), 1, false).await.at(FILE, 3).map(|_| ()) })
    });
    assert_eq!(alarm(controller.run()), "alarm 10064: the file \"gone.txt\" does not exist or is damaged (t.arl:3)");
}

#[test]
fn saved_variables_come_back_at_the_next_start_and_with_init() {
    let folder = Folder::new("savesv");
    let start = || Controller::builder().storage(arl_rt::storage::Directory::new(folder.0.join("state")));
    let (mut first, messages) = controller(start(), |cx| {
        Box::pin(async move {
            let system = cx.system();
            system.d.update(|d| d[0] = 1.5);
            system.i.update(|i| i[0] = 7);
            system::savesv(cx, &"D".into()).await.at(FILE, 1)?;
            system.d.update(|d| d[0] = 2.5);
            system::init(cx);
            say(cx, &system.d.with(|d| d[0]))?;
            say(cx, &system.i.with(|i| i[0]))?;
            system.i.update(|i| i[0] = 7);
            system.i_name.update(|names| names[0] = "parts".into());
            system::savesv(cx, &"DFSPEEED".into()).await.at(FILE, 2)
        })
    });
    let text = alarm(first.run());
    assert!(text.contains("savesv: \"DFSPEEED\" is not a system variable that is saved"), "{text}");
    assert_eq!(messages.text(), "1.5\n0\n");
    let (mut second, messages) = controller(start(), |cx| {
        Box::pin(async move {
            say(cx, &cx.system().d.with(|d| d[0]))?;
            say(cx, &cx.system().i.with(|i| i[0]))?;
            say(cx, &cx.system().i_name.with(|names| names[0].clone()))
        })
    });
    assert_eq!(second.run(), Outcome::Ended);
    assert_eq!(messages.text(), "1.5\n0\nparts\n");
}
