//! Diagnostics as shown to people and tools.

use super::*;
use crate::diagnostics::{Code, Diagnostic, FileId, Fix, Label, Location};
use arl_lang::span::Span;

const TEXT: &str = "func void main()\n\tint größe = 1\n\tint b = gröse + 1\r\nendfunc\n";

fn files() -> Files {
    let mut files = Files::default();
    files.add("pick.arl".into(), TEXT.into());
    files.add("pick_data.arl".into(), "joint home\n".into());
    files
}

fn at(file: u32, text: &str, what: &str) -> Location {
    let start = text.find(what).expect("the text is there") as u32;
    Location { file: FileId(file), span: Span::new(start, start + what.len() as u32) }
}

fn unknown_name() -> Diagnostic {
    Diagnostic {
        code: Code(201),
        severity: Severity::Error,
        message: "no variable is called `gröse`".into(),
        primary: Label { at: at(0, TEXT, "gröse"), text: "not known".into() },
        labels: Vec::new(),
        help: Some("did you mean `größe`?".into()),
        fix: None,
    }
}

#[test]
fn one_line_for_build_logs() {
    let shown = plain(&unknown_name(), &files());
    assert_eq!(shown, "pick.arl:3:10: ARL0201: no variable is called `gröse`; did you mean `größe`?");
}

#[test]
fn block_marks_the_place_under_tabs() {
    let expected = "ARL0201: no variable is called `gröse`\n --> pick.arl:3:10\n  |\n\
        3 | \tint b = gröse + 1\n  | \t        ^^^^^ not known\n  = help: did you mean `größe`?\n";
    assert_eq!(plain_block(&unknown_name(), &files()), expected);
}

#[test]
fn block_of_a_place_over_several_lines_ends_with_the_line() {
    let mut diagnostic = unknown_name();
    diagnostic.primary.at.span.end = TEXT.len() as u32;
    assert!(plain_block(&diagnostic, &files()).contains("\n  | \t        ^^^^^^^^^ not known\n"));
}

#[test]
fn json_has_all_members_and_escapes() {
    let mut diagnostic = unknown_name();
    diagnostic.message = "a \"b\" \\ \n\u{1}".into();
    diagnostic.help = None;
    let expected = r#"{"code":"ARL0201","severity":"error","message":"a \"b\" \\ \n\u0001","file":"pick.arl","line":3,"column":10,"end_line":3,"end_column":15,"help":null}"#;
    assert_eq!(json(&diagnostic, &files()), expected);
}

#[test]
fn place_in_an_empty_file_is_line_one() {
    let mut files = Files::default();
    files.add("none.arl".into(), String::new());
    let mut diagnostic = unknown_name();
    diagnostic.primary.at = Location { file: FileId(0), span: Span::default() };
    assert!(plain(&diagnostic, &files).starts_with("none.arl:1:1: "));
}

#[cfg(feature = "tools")]
mod for_people {
    use super::*;

    #[test]
    fn looks_like_rustc() {
        let shown = human(&unknown_name(), &files(), false);
        assert!(shown.starts_with("error[ARL0201]: no variable is called `gröse`\n"), "{shown}");
        assert!(shown.contains("--> pick.arl:3:10\n"), "{shown}");
        assert!(shown.contains("^^^^^ not known"), "{shown}");
        assert!(shown.contains("= help: did you mean `größe`?"), "{shown}");
        assert!(!shown.contains('\u{1b}'));
        assert!(human(&unknown_name(), &files(), true).contains('\u{1b}'));
    }

    #[test]
    fn labels_of_other_files_show_their_source() {
        let mut diagnostic = unknown_name();
        diagnostic.labels.push(Label { at: at(0, TEXT, "größe"), text: "this one".into() });
        diagnostic.labels.push(Label { at: at(1, "joint home\n", "home"), text: "or this".into() });
        let shown = human(&diagnostic, &files(), false);
        assert!(shown.contains("----- this one"), "{shown}");
        assert!(shown.contains("pick_data.arl:1:7"), "{shown}");
        assert!(shown.contains("---- or this"), "{shown}");
    }

    #[test]
    fn fix_is_shown_as_a_patch() {
        let mut diagnostic = unknown_name();
        diagnostic.fix = Some(Fix { at: diagnostic.primary.at, text: "größe".into() });
        let shown = human(&diagnostic, &files(), false);
        assert!(shown.contains("+     int b = größe + 1"), "{shown}");
    }

    #[test]
    fn endless_lines_and_lone_returns_are_shown_without_harm() {
        let mut files = Files::default();
        let long = "x".repeat(5000);
        files.add("long.arl".into(), long);
        files.add("mac.arl".into(), "int a\rint a\rint c".into());
        let mut diagnostic = unknown_name();
        diagnostic.primary.at = Location { file: FileId(0), span: Span::new(4000, 4001) };
        assert!(human(&diagnostic, &files, false).contains("--> long.arl:1:4001\n"));
        diagnostic.primary.at = Location { file: FileId(1), span: Span::new(10, 11) };
        let shown = human(&diagnostic, &files, false);
        assert!(shown.contains("--> mac.arl:2:5\n"), "{shown}");
    }

    #[test]
    fn places_outside_the_text_do_no_harm() {
        let mut diagnostic = unknown_name();
        diagnostic.primary.at = Location { file: FileId(0), span: Span::new(9000, 9001) };
        human(&diagnostic, &files(), false);
        diagnostic.primary.at = Location { file: FileId(7), span: Span::new(0, 1) };
        assert!(!human(&diagnostic, &files(), false).is_empty());
    }
}
