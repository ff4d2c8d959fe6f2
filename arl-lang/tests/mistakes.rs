//! Each mistake is one error, on its line, of its kind.

use arl_lang::span::LineIndex;
use arl_lang::symbol::Interner;
use arl_lang::syntax_error::SyntaxError;
use arl_lang::{ParseOptions, parse, parse_statements};

/// The numbers and lines of the errors of a file.
fn of_file(source: &str) -> Vec<(u16, u32)> {
    placed(source, &parse(source, &mut Interner::new(), ParseOptions::default()).errors)
}

fn placed(source: &str, errors: &[SyntaxError]) -> Vec<(u16, u32)> {
    let lines = LineIndex::new(source);
    errors.iter().map(|error| (error.kind.number(), lines.line(error.span.start))).collect()
}

/// Each line, in a function, has the one error with the number, and the marked text.
fn check_lines(cases: &[(&str, u16, &str)]) {
    for (line, number, marked) in cases {
        let source = format!("func void main()\nint before = 1\n{line}\nint behind = 1\nendfunc\n");
        let parsed = parse(&source, &mut Interner::new(), ParseOptions::default());
        let found: Vec<(u16, u32, &str)> = parsed
            .errors
            .iter()
            .map(|error| {
                (error.kind.number(), LineIndex::new(&source).line(error.span.start), error.span.text(&source))
            })
            .collect();
        assert_eq!(found, [(*number, 3, *marked)], "{line}: {:?}", parsed.errors);
        let error = &parsed.errors[0];
        for words in [error.kind.message(), error.kind.label(), error.kind.help().unwrap_or_default()] {
            assert!(!words.contains("  ") && !words.contains("``"), "{words}");
        }
    }
}

#[test]
fn characters_and_numbers() {
    check_lines(&[
        ("x = a @ b", 101, "@"),
        ("x = a ? b : c", 101, "?"),
        ("setdo（1, true)", 102, "（"),
        ("setdo(1， true)", 102, "，"),
        ("print “hello”", 102, "“hello”"),
        ("x　= 1", 102, "　"),
        ("x ＝ 1", 102, "＝"),
        ("int 变量1 = 5", 103, "变量1"),
        ("int zähler = 5", 103, "zähler"),
        ("print \"abc", 104, "\"abc"),
        ("print \"abc, x //", 104, "\"abc, x //"),
        ("setdo(\"1, true)", 104, "\"1, true)"),
        ("print \"a\\qb\"", 106, "\\q"),
        ("x = 4294967296", 107, "4294967296"),
        ("x = 1ffffffffh", 107, "1ffffffffh"),
        ("x = 1e999", 108, "1e999"),
        ("x = 12b", 109, "12b"),
        ("x = 12e", 110, "12e"),
        ("x = 0x3e", 111, "0x3e"),
        ("x = 12abc", 112, "12abc"),
        ("x = 1.2.3", 112, "1.2.3"),
        ("int 1x = 3", 112, "1x"),
        ("$ = 3", 113, "$"),
        ("x = 1 \\ // comment", 114, "\\"),
        ("print 'abc'", 115, "'abc'"),
        ("print 'abc", 115, "'abc"),
        ("x = #y", 116, "#y"),
    ]);
    assert_eq!(of_file("int a\n/* abc\ndef"), [(105, 2)]);
}

#[test]
fn brackets_and_values() {
    check_lines(&[
        ("setdo(1,true", 122, "true"),
        ("p = {1,2", 122, "2"),
        ("a[1 = 2", 122, "2"),
        ("if(getdi(3) setdo(3,true)", 122, ")"),
        ("x = (a + b", 122, "b"),
        ("x = a + b)", 123, ")"),
        ("a] = 1", 123, "]"),
        ("p = {1,2)", 124, ")"),
        ("f(a]", 124, "]"),
        ("setdo(1 true)", 125, "true"),
        ("lin p1 v:v1", 125, "v"),
        ("print \"a\" b", 125, "b"),
        ("p = {x 1 y 2}", 125, "y"),
        ("int a b", 125, "b"),
        ("movej j:1 30", 125, "30"),
        ("x = 1 +", 127, "+"),
        ("x = ", 127, "="),
        ("x = * 2", 127, "*"),
        ("x = (1 + )", 127, ")"),
        ("f(1,)", 127, ")"),
        ("f(,1)", 127, ","),
        ("x = ()", 127, ")"),
        ("while()\nendwhile", 127, ")"),
        ("lin p1,", 127, ","),
        ("lin p:", 127, "p"),
        ("int a[] = {1}", 120, "]"),
        ("b[1,2] = 3", 120, ","),
        ("print(\"a\", 1)", 120, ","),
    ]);
}

#[test]
fn lines_of_other_languages() {
    check_lines(&[
        ("x = 1;", 128, ";"),
        ("lin p1;", 128, ";"),
        ("if(a);\nendif", 128, ";"),
        ("x = 1; y = 2", 129, "y"),
        ("x = 1 break", 129, "break"),
        ("if(a) endif", 129, "endif"),
        ("endless = 1 return", 129, "return"),
        ("int speed = 5", 130, "speed"),
        ("speed = 5", 130, "speed"),
        ("lin = 5", 130, "lin"),
        ("int while = 1", 130, "while"),
        ("x = tool", 130, "tool"),
        ("x = speed + 1", 130, "speed"),
        ("x = f(speed + 1)", 130, "speed"),
        ("goto loop", 130, "loop"),
        ("x = waittime(1)", 120, "waittime"),
        ("next: i++", 131, "i++"),
        ("if(a) then\nendif", 133, "then"),
        ("while(a) do\nendwhile", 133, "do"),
        ("if(a) then x = 1", 133, "then"),
        ("if(a) {\n}", 134, "{"),
        ("while(a) {\nendwhile", 134, "{"),
        ("if(a) { x = 1 }", 134, "{ x = 1 }"),
        ("a + b = c", 135, "="),
        ("x = 5mm", 136, "mm"),
        ("p = {x 5mm}", 136, "mm"),
        ("p = {x:1, y 2}", 138, ":"),
        ("int a += 1", 139, "a +="),
        ("if a == 1\nendif", 120, "a"),
        ("if(a) && (b)\nendif", 120, "&&"),
        ("int(x)", 120, "("),
        ("if(a) if(b) x()", 120, "if"),
        ("if(a) int b = 1", 120, "int"),
        ("for(int i = 0, i < 5, i++)\nendfor", 120, "<"),
        ("for(i = 0; i < 5)\nendfor", 120, ")"),
        ("joint j1 = j:{j1 1}", 120, ":"),
        ("lin p1;T(1)", 121, ")"),
        ("goto", 121, "goto"),
        ("int", 121, "int"),
        ("while\nendwhile", 121, "while"),
        ("= 5", 120, "="),
        ("x y z", 125, "z"),
        ("x = 5 6", 120, "6"),
        ("f(a) b", 120, "b"),
        ("import \"a.arl\"", 145, "import \"a.arl\""),
    ]);
}

#[test]
fn headers_that_cannot_be_read_still_open_and_close() {
    for (source, wanted) in [
        ("func void main(\nx()\nendfunc\n", vec![(122, 1)]),
        ("func main()\nx()\nendfunc\n", vec![(120, 1)]),
        ("func main\nx()\nendfunc\n", vec![(121, 1)]),
        ("func void add(int & a)\nx()\nendfunc\n", vec![(120, 1)]),
        ("func void add(a)\nx()\nendfunc\n", vec![(120, 1)]),
        ("func\nx()\nendfunc\n", vec![(121, 1)]),
        ("func int while()\nx()\nendfunc\n", vec![(130, 1)]),
        ("func void f(speed)\nx()\nendfunc\n", vec![(120, 1)]),
        (
            "func void f()\nif(a ==)\nx()\nelseif(= b)\nx()\nelse x()\nx()\nendif\nendfunc\n",
            vec![(127, 2), (127, 4), (120, 6)],
        ),
        ("func void f()\nif(a\nx()\nendif\nif(b c)\nendif\nendfunc\n", vec![(122, 2), (122, 5)]),
        ("func void f()\nif(a) x(\nwhile(b +\nendwhile\nfor(;\nendfor\nendfunc\n", vec![(122, 2), (127, 3), (127, 5)]),
        (
            "func void f()\nrepeat\nuntil a\nswitch(\ncase 1\nx()\ncase 2 x()\ndefault\nendswitch\nendfunc\n",
            vec![(120, 3), (127, 4), (126, 5), (120, 7), (126, 8)],
        ),
        (
            "func void f()\nrepeat x\nuntil(a)\nloop 5\nendloop\nendwhile2\nendfunc x\n",
            vec![(120, 2), (120, 4), (120, 7)],
        ),
        ("func void f()\nif（a)\nx()\nendif\nendfunc\n", vec![(102, 2)]),
        ("func void f()\nif(a) x(@)\nif(b @)\nendif\nendfunc\n", vec![(101, 2), (101, 3)]),
        ("func void f()\nif(a @\nx()\nif(b @ y()\nendif\nendfunc\n", vec![(101, 2), (101, 4)]),
    ] {
        assert_eq!(of_file(source), wanted, "{source}");
    }
}

#[test]
fn blocks() {
    for (source, wanted) in [
        // Missing: the error is on the opening line.
        ("func void f()\nif(a)\nx()\nendfunc\n", vec![(140, 2)]),
        ("func void f()\nwhile(a)\nif(b)\nendwhile\nendfunc\n", vec![(140, 3)]),
        ("func void f()\nwhile(a)\nif(b)\nfor(;;)\nendfunc\n", vec![(140, 2), (140, 3), (140, 4)]),
        ("func void f()\nx()\nfunc void g()\nendfunc\n", vec![(140, 1)]),
        ("func void f()\nx()\n", vec![(140, 1)]),
        ("func void f()\nloop\nx()", vec![(140, 1), (140, 2)]),
        ("func void f()\nrepeat\nswitch(a)\ncase 1:\nendfunc", vec![(140, 2), (140, 3)]),
        ("func void f()\nswitch(a)\ncase 1:\nif(b)\ncase 2:\nendswitch\nendfunc", vec![(140, 4)]),
        ("func void f()\nif(a)\nwhile(b)\nelse\nendif\nendfunc", vec![(140, 3)]),
        // Too many.
        ("func void f()\nx()\nendif\nendfunc\n", vec![(141, 3)]),
        ("func void f()\nendfunc\nendfunc\n", vec![(141, 3)]),
        ("func void f()\nif(a)\nendif\nendif\nuntil(a)\nendfunc\n", vec![(141, 4), (141, 5)]),
        // Another's.
        ("func void f()\nfor(;;)\nx()\nendwhile\nendfunc\n", vec![(142, 4)]),
        ("func void f()\nwhile(a)\nfor(;;)\nx()\nendwhile\nendwhile\nendfunc\n", vec![(142, 5)]),
        ("func void f()\nloop\nif(a)\nendloop\nendloop\nendfunc\n", vec![(142, 4)]),
        ("func void f()\nrepeat\nx()\nendrepeat\nendfunc\n", vec![(152, 4)]),
        ("func void f()\nif(a)\nx()\nend if\nx()\nendfunc\n", vec![(152, 4)]),
        ("func void f()\nwhile(a)\nwend\nendfunc\n", vec![(152, 3)]),
        ("func void f()\nif(a)\nendfunction\nfunc void g()\nendfunc", vec![(140, 2), (152, 3)]),
        ("func void f()\nfor(;;)\nend\nend\n", vec![(152, 3), (152, 4)]),
        // Branches.
        ("func void f()\nelse\nendfunc\n", vec![(148, 2)]),
        ("func void f()\nif(a)\nelse\nelse\nelseif(b)\nendif\nendfunc\n", vec![(149, 4), (149, 5)]),
        ("func void f()\nif(a)\nelse if(b)\nelse if(c)\nelse\nendif\nx()\nendfunc\n", vec![(132, 3), (132, 4)]),
        ("func void f()\nif(a)\nelse if(b)\nendif\nendif\nx()\nendfunc\n", vec![(132, 3)]),
        ("func void f()\ncase 1:\nendfunc\n", vec![(147, 2)]),
        ("func void f()\nswitch(a)\nx()\ny()\ncase 1:\nendswitch\nendfunc\n", vec![(146, 3)]),
        ("func void f()\nswitch(a)\nif(b)\nendif\ncase 1:\nendswitch\nendfunc\n", vec![(146, 3)]),
        ("func void f()\nswitch(a)\ndefault:\ncase 1:\ndefault:\nendswitch\nendfunc\n", vec![(150, 5)]),
        // Braces.
        (
            "func void f() {\nif(a) {\nx()\n} else {\ny()\n}\nwhile(b)\n{\nx()\n}\n}\n",
            vec![(134, 1), (134, 2), (134, 4), (134, 8)],
        ),
        ("func void f()\nif(a)\n}\nendfunc\n", vec![(140, 2), (123, 3)]),
        // Outside of functions.
        ("x = 1\nif(a)\ny()\nendif\nfunc void f()\nendfunc\nz()\n", vec![(143, 1), (143, 7)]),
        ("x = 1\nint a\ny = 1\nendfunc\nfunc void f()\nendfunc\n", vec![(143, 1)]),
        ("func void f()\nimport \"a\"\nendfunc\n", vec![(145, 2)]),
        // The rest of the file is read as if nothing had happened.
        ("func void f()\nif(a)\nendfunc\nfunc void g()\nx(\nendif\nendfunc\n", vec![(140, 2), (122, 5), (141, 6)]),
    ] {
        assert_eq!(of_file(source), wanted, "{source}");
    }
}

#[test]
fn functions_among_statements() {
    let source = "x = 1\nfunc void f()\ny = 1\nendfunc\nz = 1\nimport \"a\"\n";
    let parsed = parse_statements(source, &mut Interner::new(), ParseOptions::default());
    assert_eq!(placed(source, &parsed.errors), [(144, 2), (145, 6)]);
    assert_eq!(parsed.block.len(), 2);
}

#[test]
fn splices_that_are_none() {
    for source in ["x = # + 1", "x = #(a + 1", "x = #1"] {
        let parsed = parse_statements(source, &mut Interner::new(), ParseOptions { splices: true });
        assert_eq!(placed(source, &parsed.errors), [(117, 1)], "{source}");
    }
}

#[test]
fn many_mistakes_are_all_reported() {
    let source = "\
func void main()
int a = 12b
print \"abc
setdo(1 true)
if(a = 1)
x = = 2
endwhile
lin p1,v:{tcp 20;T(1)
y = 1;
endfunc
";
    let wanted = [(109, 2), (104, 3), (125, 4), (127, 6), (142, 7), (122, 8), (128, 9)];
    assert_eq!(of_file(source), wanted);
}

#[test]
fn what_a_broken_line_declares_is_kept() {
    let source = "int a = (1, b = 2\nfunc int f(int x, speed)\nfor(int i = 0; i < )\nendfor\nendfunc\n";
    let parsed = parse(source, &mut Interner::new(), ParseOptions::default());
    assert_eq!(parsed.errors.len(), 3, "{:?}", parsed.errors);
    let [arl_lang::ast::Item::Global(decl), arl_lang::ast::Item::Func(func)] = parsed.file.items.as_slice() else {
        panic!("{:?}", parsed.file)
    };
    assert_eq!(decl.vars.len(), 1);
    assert_eq!((func.name.span.text(source), func.params.len()), ("f", 1));
    let arl_lang::ast::StmtKind::For(parts) = &func.body[0].kind else { panic!() };
    assert!(parts.init.is_some());
}
