//! Whatever the text, reading ends, says what is wrong where it is wrong, and leaves a tree that can be walked.

mod support {
    pub(crate) mod random;
}

use std::collections::BTreeSet;

use arl_lang::span::LineIndex;
use arl_lang::symbol::Interner;
use arl_lang::{ParseOptions, Parsed, parse, parse_expression, parse_statements, text};
use support::random::Random;

/// A valid program with every kind of statement; lines that are no block's are indented by four.
const PROGRAM: &str = include_str!("support/program.arl");

fn read(source: &str) -> Parsed {
    parse(source, &mut Interner::new(), ParseOptions::default())
}

fn lines_of(source: &str, parsed: &Parsed) -> BTreeSet<u32> {
    let lines = LineIndex::new(source);
    parsed.errors.iter().map(|error| lines.line(error.span.start)).collect()
}

/// Everything that a caller may do with the outcome.
fn walk(source: &str) {
    for splices in [false, true] {
        let parsed = parse(source, &mut Interner::new(), ParseOptions { splices });
        for error in &parsed.errors {
            assert!(error.span.start <= error.span.end && error.span.end as usize <= source.len(), "{source:?}");
            let places = std::iter::once(error.span).chain(error.related.iter().map(|related| related.0));
            for place in places {
                assert!(source.get(place.start as usize..place.end as usize).is_some(), "{place:?} in {source:?}");
            }
            assert!(!error.kind.message().is_empty() && !error.kind.label().is_empty());
            error.kind.help();
        }
        for splice in &parsed.splices {
            assert!(source.get(splice.span.start as usize..splice.span.end as usize).is_some());
        }
        let _ = format!("{:?}", parsed.file);
    }
    parse_statements(source, &mut Interner::new(), ParseOptions::default());
    parse_expression(source, &mut Interner::new(), ParseOptions::default());
}

#[test]
fn the_program_is_valid() {
    assert!(read(PROGRAM).errors.is_empty(), "{:?}", read(PROGRAM).errors);
}

#[test]
fn any_bytes() {
    let mut random = Random::new(1);
    for _ in 0..3000 {
        let length = random.below(200);
        let bytes: Vec<u8> = (0..length).map(|_| random.next() as u8).collect();
        if let Ok(source) = text::decode(&bytes) {
            walk(&source);
        }
        walk(&String::from_utf8_lossy(&bytes));
    }
}

#[test]
fn any_tokens() {
    let words: Vec<&str> =
        "if ( ) endif while endwhile { } [ ] , ; : :: . = == + - -- ++ % 5 5mm .5 12b 3eh x y f $A $ # #a #( \" \
        \"s\" // /* */ \\ func endfunc int const void pose speed lin spl print import case default switch endswitch \
        goto return else elseif repeat until loop for endfor then end ， （ “ 变 ! ~ && true endl \n \n \n \r \r\n"
            .split(' ')
            .collect();
    let mut random = Random::new(2);
    for _ in 0..6000 {
        let count = random.below(40);
        let source: Vec<&str> = (0..count).map(|_| words[random.below(words.len())]).collect();
        walk(&source.join(if random.below(4) == 0 { "" } else { " " }));
    }
}

#[test]
fn any_mutation_of_a_program() {
    let mut random = Random::new(3);
    let characters: Vec<char> = PROGRAM.chars().collect();
    for _ in 0..400 {
        let mut mutated = characters.clone();
        for _ in 0..=random.below(3) {
            let at = random.below(mutated.len());
            let other = characters[random.below(characters.len())];
            match random.below(4) {
                0 => drop(mutated.remove(at)),
                1 => mutated.insert(at, other),
                2 => mutated[at] = other,
                _ => drop(mutated.splice(at..mutated.len().min(at + random.below(30)), [])),
            }
        }
        walk(&mutated.into_iter().collect::<String>());
    }
}

#[test]
fn a_mistake_in_a_line_stays_on_its_line() {
    // What is put into a line, as a word of its own or in the place of one, without making or removing a block.
    let junk = [
        ")",
        "]",
        "}",
        "= =",
        "@",
        "12b",
        "\"",
        "4294967296",
        "$ ",
        "，",
        "1.2.3",
        "* /",
        "变",
        "{ (",
        "( [",
        ":: ::",
        "'a",
        "0x1f",
        "x y z w",
        ". .",
        "? :",
        "[ }",
    ];
    let lines: Vec<&str> = PROGRAM.lines().collect();
    let mut random = Random::new(4);
    let mut reported = 0;
    for (at, line) in lines.iter().enumerate() {
        let free = line.trim_start();
        if free.is_empty() || free.starts_with("//") || free.ends_with('\\') || lines[at.max(1) - 1].ends_with('\\') {
            continue;
        }
        for junk in junk {
            let words: Vec<&str> = free.split(' ').collect();
            // Behind the first word, which says what the line is.
            let position = 1 + random.below(words.len());
            let mut changed = words.clone();
            changed.insert(position.min(words.len()), junk);
            let mut all = lines.clone();
            let changed = changed.join(" ");
            all[at] = &changed;
            let source = all.join("\n");
            let parsed = read(&source);
            let found = lines_of(&source, &parsed);
            let line_number = at as u32 + 1;
            // A quote may hide the junk in a string; otherwise something is reported.
            assert!(found.is_empty() || found == BTreeSet::from([line_number]), "{changed}: {:?}", parsed.errors);
            reported += usize::from(!found.is_empty());
        }
    }
    assert!(reported > 500, "{reported}");
}

#[test]
fn mistakes_in_several_lines_are_all_reported() {
    let lines: Vec<&str> = PROGRAM.lines().collect();
    let simple: Vec<usize> = (0..lines.len()).filter(|at| lines[*at].starts_with("    x")).collect();
    assert!(simple.len() >= 5);
    let mut random = Random::new(5);
    for _ in 0..200 {
        let mut all: Vec<String> = lines.iter().map(|line| String::from(*line)).collect();
        let mut wanted = BTreeSet::new();
        for _ in 0..=random.below(4) {
            let at = simple[random.below(simple.len())];
            if wanted.insert(at as u32 + 1) {
                all[at].push_str([" )", " = =", " 12b", " @", " +"][random.below(5)]);
            }
        }
        let source = all.join("\n");
        let parsed = read(&source);
        assert_eq!(lines_of(&source, &parsed), wanted, "{source}");
        assert_eq!(parsed.errors.len(), wanted.len(), "{:?}", parsed.errors);
    }
}

#[test]
fn a_missing_closing_line_is_one_error() {
    let lines: Vec<&str> = PROGRAM.lines().collect();
    let closers = ["endif", "endwhile", "endloop", "endfor", "endswitch", "until", "endfunc"];
    let mut tried = 0;
    for at in 0..lines.len() {
        if !closers.iter().any(|closer| lines[at].trim_start().starts_with(closer)) {
            continue;
        }
        tried += 1;
        let mut without = lines.clone();
        without.remove(at);
        let source = without.join("\n");
        let parsed = read(&source);
        assert_eq!(parsed.errors.len(), 1, "without line {}: {:?}", at + 1, parsed.errors);
        // One too many is one error as well.
        let mut twice = lines.clone();
        twice.insert(at, lines[at]);
        let parsed = read(&twice.join("\n"));
        assert_eq!(parsed.errors.len(), 1, "line {} twice: {:?}", at + 1, parsed.errors);
    }
    assert!(tried >= 10, "{tried}");
}

/// The numbers of the errors, each once.
fn numbers(source: &str) -> BTreeSet<u16> {
    read(source).errors.iter().map(|error| error.kind.number()).collect()
}

#[test]
fn deep_nesting_ends_with_a_clear_limit() {
    let deep = 100_000;
    let within = |statement: String| format!("func void f()\n{statement}\nendfunc\n");
    for (open, close) in [("(", ")"), ("{", "}"), ("f(", ")"), ("a[", "]"), ("{x ", "}")] {
        let source = within(format!("x = {}1{}", open.repeat(deep), close.repeat(deep)));
        assert_eq!(numbers(&source), BTreeSet::from([137]), "{open}");
        let unclosed = within(format!("x = {}", open.repeat(deep)));
        assert_eq!(numbers(&unclosed), BTreeSet::from([137]), "{open}");
    }
    for chain in ["- ", "!", "~", "++", "a = ", "a + ", "a += "] {
        let source = within(format!("x = {}a", chain.repeat(deep)));
        assert_eq!(numbers(&source), BTreeSet::from([137]), "{chain}");
        assert_eq!(read(&source).errors.len(), 1);
    }
    for chain in ["[0]", ".b", "++", "+a*b"] {
        let source = within(format!("x = a{}", chain.repeat(deep)));
        assert_eq!(numbers(&source), BTreeSet::from([137]), "{chain}");
    }
    for (open, close) in [
        ("if(a)\n", "endif\n"),
        ("while(a)\n", "endwhile\n"),
        ("if(a)\nelse\n", "endif\n"),
        ("switch(a)\ncase 1:\n", "endswitch\n"),
        ("repeat\n", "until(a)\n"),
    ] {
        let source = within(format!("{}x()\n{}", open.repeat(deep), close.repeat(deep)));
        assert_eq!(numbers(&source), BTreeSet::from([151]), "{open}");
        assert_eq!(read(&source).errors.len(), 1, "{open}");
        let unclosed = within(open.repeat(deep));
        assert_eq!(read(&unclosed).errors.len(), 1, "{open}");
    }
}

#[test]
fn what_is_within_the_limits_is_read() {
    let within = |statement: String| format!("func void f()\n{statement}\nendfunc\n");
    for statement in [
        format!("x = {}1{}", "(".repeat(199), ")".repeat(199)),
        format!("x = {}1", "1 + ".repeat(250)),
        format!("int a[10000] = {{{}}}", vec!["1"; 10_000].join(", ")),
        format!("{}x()\n{}", "if(a)\n".repeat(190), "endif\n".repeat(190)),
        format!("print {}", vec!["\"x\""; 5000].join(",")),
        format!("s = \"{}\"", "x".repeat(1_000_000)),
    ] {
        assert!(read(&within(statement)).errors.is_empty());
    }
}

#[test]
fn long_lines_and_files_end_quickly() {
    // Each of these would take minutes if reading or reporting were quadratic.
    for source in [
        ";".repeat(60_000),
        "}".repeat(60_000),
        "(".repeat(60_000),
        ")".repeat(60_000),
        "a b ".repeat(20_000),
        "x = 1,".repeat(20_000),
        "if(a)".repeat(20_000),
        "if(a)\n}\n{\n".repeat(20_000),
        "endif\n".repeat(20_000),
        "= 5\n".repeat(5_000),
        "\"\n".repeat(20_000),
        "@".repeat(60_000),
        "/*".repeat(60_000),
        "case 1: ".repeat(20_000),
        "switch(a)\nendwhile\n".repeat(20_000),
        "func void f()\nif(a)\n".repeat(20_000),
        "else if(a)\n".repeat(20_000),
        "end if\n".repeat(20_000),
        "#(".repeat(20_000),
        "“".repeat(20_000),
        "a.".repeat(20_000),
        "x:".repeat(20_000),
        "{a:".repeat(20_000),
        "int ".repeat(20_000),
        "foo foo, ".repeat(20_000),
    ] {
        let source = format!("func void f()\n{source}\nendfunc\n");
        let parsed = parse(&source, &mut Interner::new(), ParseOptions { splices: true });
        assert!(!parsed.errors.is_empty());
        assert!(parsed.errors.iter().all(|error| error.span.end as usize <= source.len()));
    }
}
