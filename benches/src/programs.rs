//! Programs of any length, for the speed of the check.

use std::fmt::Write;

/// A kind of program.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Kind {
    /// Functions as robot programs have them, some 45 lines each.
    Typical,
    /// Functions of three lines that call the one before.
    SmallFunctions,
    /// One function with all statements.
    HugeFunction,
    /// Global variables only.
    Globals,
    /// Taught points only: constants of type pose.
    Points,
}

impl Kind {
    /// All kinds with their names.
    pub const ALL: [(Kind, &'static str); 5] = [
        (Kind::Typical, "typical"),
        (Kind::SmallFunctions, "small-functions"),
        (Kind::HugeFunction, "huge-function"),
        (Kind::Globals, "globals"),
        (Kind::Points, "points"),
    ];

    /// A program with about so many lines.
    pub fn program(self, lines: usize) -> String {
        let mut text = String::with_capacity(lines * 40);
        match self {
            Kind::Typical => typical(lines, &mut text),
            Kind::SmallFunctions => small_functions(lines / 3, &mut text),
            Kind::HugeFunction => huge_function(lines, &mut text),
            Kind::Globals => globals(lines, &mut text),
            Kind::Points => points(lines, &mut text),
        }
        text
    }
}

/// Writes a line, each `#` replaced by a number.
fn line(text: &mut String, pattern: &str, number: usize) {
    for (at, part) in pattern.split('#').enumerate() {
        if at > 0 {
            // Writing to a string does not fail.
            let _ = write!(text, "{number}");
        }
        text.push_str(part);
    }
    text.push('\n');
}

/// A function of typical lines. The default robot can do what it does.
const TYPICAL: &[&str] = &[
    "// Station #: takes a part from the conveyor and puts it into the press.",
    "func int station#(int wanted, double limit)",
    "  pose above = {x 911.138, y -5.704, z 339.959, a -178.159, b 3.881, c 177.799}",
    "  joint ready = {0, -30, 80, 0, 60, 0}",
    "  speed slow = {per 20, tcp 200}",
    "  int count = 0",
    "  int retries[8]",
    "  double total = limit * 2.5 + #",
    "  bool late = false",
    "  movej ready,vp:50%",
    "  lin p:above,vl:100mm/s",
    "  lin offset(above, 0, 0, -50, 0, 0, 0),v:slow",
    "  setdo(3, true)",
    "  waituntil getdi(6),maxtime:5,timeoutflag:late",
    "  if(late)",
    "    print \"station #: no part after 5 s\"",
    "    return -1",
    "  endif",
    "  while(count < wanted && total <= limit * 100)",
    "    count++",
    "    total = total + count * 2.5 - sqrt(total) / 3",
    "    if(getdi(4))",
    "      retries[count % 8] = retries[count % 8] + 1",
    "    elseif(count > 50)",
    "      setdo(3, false)",
    "      break",
    "    else",
    "      waittime 0.2",
    "    endif",
    "  endwhile",
    "  for(int i = 0; i < 8; i++)",
    "    // a part that needed more than one try",
    "    if(retries[i] > 1) total = total + retries[i]",
    "    above.x = above.x + i * 0.25",
    "  endfor",
    "  switch(count)",
    "  case 0:",
    "    print \"nothing done\"",
    "  case 1:",
    "    total = abs(sin(total))",
    "  default:",
    "    ready.j1 = total % 90",
    "    $DFSPEED = {10,50,5,5,5}",
    "  endswitch",
    "  movej ready,vp:100%",
    "  print \"station #: \", count, \" of \", wanted, \" total \", total, endl",
    "  return count + toint(total)",
    "endfunc",
    "",
];

fn typical(lines: usize, text: &mut String) {
    let functions = (lines / TYPICAL.len()).max(1);
    for number in 0..functions {
        for pattern in TYPICAL {
            if number > 0 && pattern.starts_with("  movej ready,vp:100%") {
                line(text, "  if(total > 1000) count = station#(count, total)", number - 1);
            }
            line(text, pattern, number);
        }
    }
    main(&format!("  print station{}(5, 2.5)", functions - 1), text);
}

fn main(body: &str, text: &mut String) {
    text.push_str("func void main()\n");
    text.push_str(body);
    text.push_str("\nendfunc\n");
}

fn small_functions(functions: usize, text: &mut String) {
    text.push_str("func int f0(int n)\n  return n + 1\nendfunc\n");
    for number in 1..functions.max(1) {
        line(text, "func int f#(int n)", number);
        line(text, "  return f#(n) * 3", number - 1);
        text.push_str("endfunc\n");
    }
    main("  print f0(1)", text);
}

fn huge_function(statements: usize, text: &mut String) {
    text.push_str("func void main()\n  int count = 0\n  double total = 0\n");
    for number in 0..statements / 4 {
        line(text, "  count = count + #", number);
        line(text, "  total = total * 0.5 + count", number);
        line(text, "  int v# = count % 7", number);
        line(text, "  if(v# > 3) setdo(v#, true)", number);
    }
    text.push_str("  print count, total\nendfunc\n");
}

fn globals(lines: usize, text: &mut String) {
    for number in 0..lines / 4 {
        line(text, "int count# = #", number);
        line(text, "double limit# = count# * 1.5", number);
        line(text, "string name# = \"part #\"", number);
        line(text, "int table#[3] = {1, 2, #}", number);
    }
    main("  print count0, limit0, name0, table0", text);
}

fn points(lines: usize, text: &mut String) {
    for number in 0..lines {
        line(
            text,
            "const pose p# = {x #.138, y -5.704, z 739.959, a -178.159, b 43.881, c 2.201, cfg 0, turn -1}",
            number,
        );
    }
    main("  print p0.x", text);
}
