//! Texts that no one should write, and that a check must get through all the same.

use std::iter;

/// How many bytes, lines and members of one thing an input has.
#[derive(Clone, Copy, Debug)]
pub struct Amount {
    /// Bytes of texts in one line.
    pub bytes: usize,
    /// Lines, each with a mistake.
    pub lines: usize,
    /// Arguments, branches, labels, variables, functions.
    pub members: usize,
}

impl Amount {
    /// What the goals are about.
    pub const WHOLE: Self = Self { bytes: 1_000_000, lines: 200_000, members: 10_000 };

    /// A tenth of it.
    pub fn tenth(self) -> Self {
        Self { bytes: self.bytes / 10, lines: self.lines / 10, members: self.members / 10 }
    }
}

/// All inputs of an amount, each with its name.
pub fn all(amount: Amount) -> Vec<(String, String)> {
    let repeated =
        REPEATED.iter().map(|(name, word)| (format!("1 MB: {name}"), word.repeat(amount.bytes / word.len())));
    let lines = LINES.iter().map(|(name, before, line, after)| {
        (format!("200 000 lines: {name}"), format!("{before}{}{after}", line.repeat(amount.lines)))
    });
    let counted = COUNTED.iter().map(|(name, make)| (format!("200 000 lines: {name}"), make(amount.lines)));
    let members = MEMBERS.iter().map(|(name, make)| (format!("10 000 {name}"), make(amount.members)));
    repeated.chain(lines).chain(counted).chain(members).collect()
}

/// A name, and what is written again and again in one line.
const REPEATED: [(&str, &str); 26] = [
    ("NUL", "\0"),
    ("@", "@"),
    ("a", "a"),
    ("1", "1"),
    ("(", "("),
    ("{", "{"),
    ("quotes", "\""),
    ("single quotes", "'"),
    ("\\", "\\"),
    ("#", "#"),
    ("$", "$"),
    ("?", "?"),
    ("-", "-"),
    ("letters of other alphabets", "ä"),
    ("punctuation of other alphabets", "\u{ff08}"),
    ("quotes of other alphabets", "“x”"),
    ("line ends", "\n"),
    ("a blank", "a "),
    ("a+", "a+"),
    ("a.", "a."),
    ("if(a)", "if(a) "),
    ("case 1:", "case 1:"),
    ("wrong escapes", "\"\\q\""),
    ("spliced Rust", "#(a) "),
    ("comments", "/**/"),
    ("a@", "a@"),
];

/// A name, what stands before the lines, the line, and what stands behind them.
const LINES: [(&str, &str, &str, &str); 18] = [
    ("x y z", "", "x y z\n", ""),
    ("x y z in main", MAIN, "x y z\n", END),
    ("@", MAIN, "@\n", END),
    ("a wrong label", MAIN, "print(1,2,a:3)\n", END),
    ("an instruction like a function", MAIN, "setdo 1,true\n", END),
    ("braces without a label", MAIN, "lin {1,2}\n", END),
    ("a wrong type", "func void main()\nint a\n", "a = \"x\"\n", END),
    ("a wrong component", "func void main()\npose p\n", "p.q = 1\n", END),
    ("a variable again", MAIN, "int a\n", END),
    ("a label again", MAIN, "a:\n", END),
    ("goto nowhere", MAIN, "goto a\n", END),
    ("break outside a loop", MAIN, "break\n", END),
    ("else again", "func void main()\nif(true)\n", "else\n", "endif\nendfunc\n"),
    ("endif", "", "endif\n", ""),
    ("if without an end", "", "if(true)\n", ""),
    ("functions without an end", "", "func void f()\n", ""),
    ("a semicolon", "func void main()\nint a\n", "a = 1;\n", END),
    ("division by 0", "func void main()\nint a\n", "a = 1/0\n", END),
];

const MAIN: &str = "func void main()\n";
const END: &str = "endfunc\n";

/// A name, and what makes an input of so many lines or members.
type Make = (&'static str, fn(usize) -> String);

const COUNTED: [Make; 4] = [
    ("names that are not known", |count| in_main(numbered(count, |at| format!("x{at} = 1\n")))),
    ("functions that are not known", |count| in_main(numbered(count, |at| format!("foo{at}(1)\n")))),
    ("labels that are not there", |count| in_main(numbered(count, |at| format!("goto a{at}\n")))),
    ("variables that nobody uses", |count| in_main(numbered(count, |at| format!("int v{at}\n")))),
];

const MEMBERS: [Make; 11] = [
    ("arguments of scan", |count| in_main(format!("int g\nscan from:\"1\",delimiter:\",\"{}\n", ",g".repeat(count)))),
    ("arguments of print", |count| in_main(format!("print 1{}\n", ",2".repeat(count)))),
    ("branches", |count| {
        let branches = numbered(count, |at| format!("elseif(a=={at})\na={at}\n"));
        in_main(format!("int a\nif(a==0)\n{branches}endif\n"))
    }),
    ("cases", |count| {
        in_main(format!("int a\nswitch(a)\n{}endswitch\n", numbered(count, |at| format!("case {at}:\na={at}\n"))))
    }),
    ("labels with goto", |count| {
        let label = |at: usize| format!("a{at}:\nif(x=={at}) goto a{}\n", at * 7919 % count);
        in_main(format!("int x\n{}", numbered(count, label)))
    }),
    ("local variables", |count| {
        let uses = numbered(count, |at| format!("a{at} = a{}\n", count - 1 - at));
        in_main(numbered(count, |at| format!("int a{at} = {at}\n")) + &uses)
    }),
    ("global variables", |count| {
        let uses = numbered(count, |at| format!("a{at} = a{}\n", count - 1 - at));
        numbered(count, |at| format!("int a{at} = {at}\n")) + &in_main(uses)
    }),
    ("functions", |count| {
        let functions = numbered(count, |at| format!("func void f{at}()\nprint {at}\nendfunc\n"));
        functions + &in_main(numbered(count, |at| format!("f{at}()\n")))
    }),
    ("parameters by name", |count| {
        let parameters = joined(count, |at| format!("int a{at}"));
        let arguments = joined(count, |at| format!("a{at}:1"));
        format!("func void f({parameters})\nendfunc\n") + &in_main(format!("f({arguments})\n"))
    }),
    ("elements in braces", |count| in_main(format!("int a[{count}] = {{{}}}\n", joined(count, |_| "1".into())))),
    ("loops", |count| in_main(format!("int a\n{}", "while(a<1)\na=a+1\nendwhile\n".repeat(count)))),
];

fn in_main(statements: String) -> String {
    format!("{MAIN}{statements}{END}")
}

fn numbered(count: usize, line: impl Fn(usize) -> String) -> String {
    (0..count).map(line).collect()
}

fn joined(count: usize, item: impl Fn(usize) -> String) -> String {
    let items = (0..count).flat_map(|at| iter::once(",".to_string()).chain(iter::once(item(at))));
    items.skip(1).collect()
}
