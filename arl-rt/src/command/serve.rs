//! A program that makes run after run: each line of the standard input requests one, and a line of the standard output
//! answers.
//!
//! A request is the words of a command line separated by tabs; `\t`, `\n`, `\r` and `\\` stand for the characters
//! themselves in a word. An answer is a JSON object: `{"summary": {..}, "said": [..]}` with the results of
//! [`Run::summary`] and [`Run::take_said`], or `{"refused": ".."}`. When the input is closed the process ends, even in
//! the middle of a run, so that no run outlives the requesting process.

use std::ffi::OsString;
use std::io::{self, BufRead, Write};
use std::sync::mpsc::channel;

use crate::command::in_process::{Outside, Run};
use crate::command::json::quoted;
use crate::command::stack::Stack;
use crate::context::program::{Other, Program};

pub(super) fn serve(make: impl Fn() -> Box<dyn Program> + Send, others: &[Other], script_dir: &str) -> u8 {
    // The requesting process need not announce its end.
    let served = std::thread::scope(|scope| {
        let thread = std::thread::Builder::new().stack_size(Stack::WHOLE_BYTES);
        thread.spawn_scoped(scope, move || answer_all(&make, others, script_dir)).map(|thread| thread.join())
    });
    match served {
        Ok(Ok(Ok(()))) => 0,
        _ => 1,
    }
}

fn answer_all(make: &dyn Fn() -> Box<dyn Program>, others: &[Other], script_dir: &str) -> io::Result<()> {
    let mut out = io::stdout().lock();
    let (tell, questions) = channel();
    std::thread::spawn(move || {
        for question in io::stdin().lock().lines().map_while(Result::ok) {
            if tell.send(question).is_err() {
                break;
            }
        }
        std::process::exit(0);
    });
    for question in questions {
        let answer = match Run::begin(make(), others, script_dir, words(&question), false, Stack::Whole) {
            Ok(mut run) => {
                run.go_on(u64::MAX, Outside::Nobody);
                let lines = run.take_said();
                let lines: Vec<&str> = lines.lines().collect();
                format!("{{\"summary\":{},\"said\":[{}]}}", run.summary(), lines.join(","))
            }
            Err(problem) => format!("{{\"refused\":{}}}", quoted(&problem)),
        };
        writeln!(out, "{answer}")?;
        out.flush()?;
    }
    Ok(())
}

fn words(line: &str) -> Vec<OsString> {
    if line.is_empty() {
        return Vec::new();
    }
    line.split('\t').map(|word| OsString::from(unescaped(word))).collect()
}

fn unescaped(word: &str) -> String {
    let mut text = String::new();
    let mut rest = word.chars();
    while let Some(c) = rest.next() {
        match c {
            '\\' => text.extend(match rest.next() {
                Some('t') => Some('\t'),
                Some('n') => Some('\n'),
                Some('r') => Some('\r'),
                other => other,
            }),
            c => text.push(c),
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_have_tabs_between_them_and_may_have_any_character() {
        assert_eq!(words("--seed\t5"), ["--seed", "5"]);
        assert_eq!(words("a b\tc\\td\\ne\\\\f\\r"), ["a b", "c\td\ne\\f\r"]);
        assert_eq!(words("--robot\t\t--seed"), ["--robot", "", "--seed"]);
        assert_eq!(words(""), Vec::<OsString>::new());
    }
}
