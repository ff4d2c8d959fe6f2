//! What programs and statements in Rust do.
#![allow(clippy::expect_used, reason = "tests may fail")]

use arl_rt::emit::{BoxFuture, Done, Family, File};
use arl_rt::{Captured, Controller, Cx, Outcome, Program, arl};

fn run(program: impl Program + 'static) -> (Outcome, String) {
    let messages = Captured::new();
    let controller = Controller::builder().output(messages.clone()).build(Box::new(program));
    let outcome = controller.expect("a controller").run();
    (outcome, messages.text())
}

/// Tokens that come through another macro have no text of their own; their places give it.
macro_rules! forwarded {
    ($name:ident, $($tokens:tt)*) => {
        mod $name {
            arl_rt::arl! { $($tokens)* }
        }
    };
}

forwarded! {
    through_a_macro,
    func int twice(int n)
        return n * 2
    endfunc
    func void main()
        print "twice ", twice(21)
    endfunc
}

#[test]
fn programs_come_through_other_macros() {
    assert_eq!(run(through_a_macro::Globals::new()), (Outcome::Ended, "twice 42\n".into()));
    assert_eq!(through_a_macro::program::twice(4), 8);
}

mod text {
    arl_rt::arl!(
        r#"
        func void main()
            print "0bh is ", 0bh   // Rust could not read this number
        endfunc
        "#
    );
}

#[test]
fn programs_may_be_texts() {
    let (outcome, printed) = run(text::Globals::new());
    assert_eq!((outcome, printed.as_str()), (Outcome::Ended, "0bh is 11\n"));
}

mod numbers {
    arl_rt::arl! {
        func void main()
            print 0x3e, " ", 0x0b, " ", 10b, " ", 0ch, " ", 9e+09
        endfunc
    }
}

#[test]
fn numbers_that_rust_cannot_read_are_written_as_it_does() {
    assert_eq!(run(numbers::Globals::new()), (Outcome::Ended, "62 11 2 12 9e+09\n".into()));
}

mod alarm {
    pub(super) const LINE: u32 = line!() + 4;
    arl_rt::arl! {
        func void main()
            int zero = 0
            print 1 / zero
        endfunc
    }
}

#[test]
fn alarms_name_the_line_of_the_rust_file() {
    match run(alarm::Globals::new()).0 {
        Outcome::Alarm(alarm) => {
            assert!(alarm.file.name().ends_with("expanding.rs"), "{alarm}");
            assert_eq!(alarm.line, alarm::LINE);
        }
        Outcome::Ended => panic!("it divides by zero"),
        other => panic!("{other:?}"),
    }
}

/// A program in Rust.
struct InRust(for<'a> fn(&'a Cx) -> BoxFuture<'a>);

impl Program for InRust {
    fn file(&self) -> File {
        File::new(file!())
    }

    fn family(&self) -> Family {
        Family::SixAxis
    }

    fn init<'a>(&'a self, _cx: &'a Cx) -> BoxFuture<'a> {
        Box::pin(async { Ok(()) })
    }

    fn main<'a>(&'a self, cx: &'a Cx) -> BoxFuture<'a> {
        (self.0)(cx)
    }
}

/// Does everything with statements in ARL.
async fn statements(cx: &Cx) -> Done<()> {
    let words = ["one".to_string(), "two".to_string()];
    let mut sum = 0.5;
    let start = cx.time();
    for (at, word) in words.iter().enumerate() {
        sum += 1.0;
        let index = at as i32;
        arl!(cx, {
            for(int i = 0; i < #(index + 1); i++)
                print #(word.as_str() as string), " ", i, " ", #(sum * 2.0 as double)
                waittime 0.25
            endfor
        })
        .await?;
    }
    let waited = cx.time() - start;
    arl!(cx, r#"print "waited ", #(waited as double) > 0ah / 20.0, #(words.len() == 2 as bool)"#).await?;
    let stopped = arl!(cx, { exit }).await;
    assert!(stopped.is_err(), "exit ends the whole program");
    stopped
}

#[test]
fn statements_take_rust_values() {
    let expected = "one 0 3\ntwo 0 5\ntwo 1 5\nwaited truetrue\n";
    let program = InRust(|cx| Box::pin(statements(cx)));
    assert_eq!(run(program), (Outcome::Ended, expected.into()));
}

/// Uses the variables of a module: twice, and not at all.
async fn with_a_module(cx: &Cx) -> Done<()> {
    for _ in 0..2 {
        arl!(cx, {
            tally::count++
            print tally::count, " ", tally::places[1].x, " ", tally::name
        })
        .await?;
    }
    arl!(cx, {
        print "most ", tally::most
    })
    .await
}

#[test]
fn variables_of_modules_have_their_first_values_each_time() {
    let program = InRust(|cx| Box::pin(with_a_module(cx)));
    let expected = "named\n8 20 tally of 7\nnamed\n8 20 tally of 7\nnamed\nmost 7\n";
    assert_eq!(run(program), (Outcome::Ended, expected.into()));
}

#[test]
fn alarms_of_first_values_name_the_line_of_the_module() {
    let program = InRust(|cx| {
        Box::pin(async move {
            arl!(cx, {
                print "not reached ", broken::half
            })
            .await
        })
    });
    let (outcome, printed) = run(program);
    assert_eq!(printed, "");
    let Outcome::Alarm(alarm) = outcome else { panic!("it divides by zero: {outcome:?}") };
    assert!(alarm.file.name().ends_with("broken.arl") && alarm.line == 3, "{alarm}");
}

mod library {
    arl_rt::arl! {
        int base = 40
        func int above(int n)
            base++
            return base + n
        endfunc
    }
}

#[test]
fn functions_without_main_have_their_variables() {
    let program = InRust(|cx| {
        Box::pin(async move {
            let globals = library::Globals::new();
            globals.init(cx).await?;
            assert_eq!(library::program::above(&globals, 2), 43);
            assert_eq!(library::program::above(&globals, 2), 44);
            globals.init(cx).await?;
            assert_eq!(library::program::above(&globals, 2), 43);
            Ok(())
        })
    });
    assert_eq!(run(program).0, Outcome::Ended);
}

mod waiting {
    arl_rt::arl! {
        func int ticks(double seconds)
            int count = 0
            while(count * 0.1 < seconds)
                waittime 0.1
                count++
            endwhile
            return count
        endfunc
    }
}

#[test]
fn values_come_out_of_functions_that_wait() {
    let program = InRust(|cx| {
        Box::pin(async move {
            assert_eq!(waiting::program::ticks(cx, 0.45).await?, 5);
            Ok(())
        })
    });
    assert_eq!(run(program).0, Outcome::Ended);
}
