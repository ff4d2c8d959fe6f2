//! The signals that the condition of a line reads, for programs that wait in vain.

use arl_lang::catalog::{self, Space};
use arl_lang::lexer::{Lexeme, lexemes};
use arl_lang::number::NumberValue;
use arl_robot::cell::{Names, Signal, SignalKind};

/// The meaning of a lexeme in the search.
#[derive(Clone, Copy)]
enum Part<'a> {
    Word(&'a str),
    Open,
    Close,
    Assign,
    Number(u32),
    Other,
}

fn parts(text: &str) -> Vec<Part<'_>> {
    let part = |(lexeme, span): (Result<Lexeme, _>, arl_lang::span::Span)| match lexeme {
        Ok(Lexeme::Word) => Part::Word(span.text(text)),
        Ok(Lexeme::ParenOpen) => Part::Open,
        Ok(Lexeme::ParenClose) => Part::Close,
        Ok(Lexeme::Assign) => Part::Assign,
        Ok(Lexeme::Number(number)) => match number.value {
            NumberValue::Int(value, _) => Part::Number(value),
            NumberValue::Double(_) => Part::Other,
        },
        _ => Part::Other,
    };
    lexemes(text).map(part).collect()
}

/// The signals that a line of a program reads, by their numbers or by constants of its file, each once.
pub(super) fn signals(line: &str, file: &str) -> Vec<Signal> {
    let mut found = Vec::new();
    // Calculated channels, and ranges, are left out: only signals that the line certainly reads are reported.
    for four in parts(line).windows(4) {
        let [Part::Word(function), Part::Open, number, Part::Close] = *four else { continue };
        let Some(kind) = catalog::functions(function).first().and_then(|entry| kind(entry.space()?)) else { continue };
        let channel = match number {
            Part::Number(channel) => Some(channel),
            Part::Word(name) => constant(name, file),
            _ => None,
        };
        let signal = channel.map(|channel| Signal { kind, channel });
        found.extend(signal.filter(|signal| !found.contains(signal)));
    }
    found
}

/// The value of a constant of a file.
fn constant(name: &str, file: &str) -> Option<u32> {
    parts(file).windows(5).find_map(|five| match *five {
        [Part::Word(first), Part::Word(_), Part::Word(word), Part::Assign, Part::Number(value)]
            if first.eq_ignore_ascii_case("const") && word.eq_ignore_ascii_case(name) =>
        {
            Some(value)
        }
        _ => None,
    })
}

fn kind(space: Space) -> Option<SignalKind> {
    match space {
        Space::DigitalInput => Some(SignalKind::DigitalInput),
        Space::DigitalOutput => Some(SignalKind::DigitalOutput),
        Space::AnalogInput => Some(SignalKind::AnalogInput),
        Space::AnalogOutput => Some(SignalKind::AnalogOutput),
        _ => None,
    }
}

/// A signal with its name and its value: `di.12 (part_present) is off`.
pub(super) fn signal_text(signal: Signal, names: &Names, value: Option<String>) -> String {
    let name = names.of(signal).map(|name| format!(" ({name})")).unwrap_or_default();
    match value {
        Some(value) => format!("{signal}{name} is {value}"),
        None => format!("there is no {signal}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn signals_of_a_condition() {
        let file =
            "const int PART = 12\nfunc void main()\n  waituntil getdi(part) && !GETDO(3) || getai(1) > 2\nendfunc\n";
        let line = file.lines().nth(2).unwrap();
        let found: Vec<String> = signals(line, file).iter().map(ToString::to_string).collect();
        assert_eq!(found, ["di.12", "do.3", "ai.1"]);
        let file = "const int n = 3\nint i = 0\n";
        assert!(
            signals("waituntil ready && clkread(c) > 5 || getdi(n + 1) || getdi(i) || getdi(1, 4)", file).is_empty()
        );
    }

    #[test]
    fn words_for_a_signal() {
        let signal = Signal { kind: SignalKind::DigitalInput, channel: 12 };
        assert_eq!(signal_text(signal, &Names::default(), Some("off".into())), "di.12 is off");
    }
}
