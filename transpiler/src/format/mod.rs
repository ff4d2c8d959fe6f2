//! The layout of programs: one way to indent, to space and to spell.
//!
//! It works on the lexemes and what lies between them, so that nothing can be lost; the parser says what each of them is
//! and which lines it could not read. Those stay as they are. As the last step the result is held against the text:
//! the same lexemes and comments in the same lines.

mod align;
mod levels;
mod lines;
mod spacing;
mod spelling;
mod trivia;

use arl_lang::outline::Role;
use levels::Place;
use lines::{Item, Line};
use spacing::LEVEL;

/// A program in its layout. Lines that cannot be read stay as they are; comments keep their words.
///
/// ```
/// let text = "Func void main( )\nmovej  Home,vp:50 %// go\nEndFunc";
/// assert_eq!(arl2rs::format::format(text), "func void main()\n    movej Home, vp:50% // go\nendfunc\n");
/// ```
pub fn format(text: &str) -> String {
    let plain = text.replace("\r\n", "\n").replace('\r', "\n");
    let formatted = laid_out(&plain);
    let same = is_same(&plain, &formatted);
    debug_assert!(same, "the layout changed more than the layout:\n{plain}\n-----\n{formatted}");
    if !same {
        return text.to_string();
    }
    if ends_with_return(text) { formatted.replace('\n', "\r\n") } else { formatted }
}

/// Whether the first line ends as Windows has it.
fn ends_with_return(text: &str) -> bool {
    text.split_once('\n').is_some_and(|(first, _)| first.ends_with('\r'))
}

/// A line as it is to be written.
struct Row {
    /// Blanks in front of it.
    indent: usize,
    /// All but a comment behind it; of several lines where it is continued, or holds a comment of several lines.
    body: String,
    /// The comment behind it.
    trailing: Option<String>,
    kind: Kind,
    place: Place,
}

#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Kind {
    Blank,
    /// Comments alone.
    Comment,
    Code,
    /// A line that stays as it is.
    Frozen,
}

impl Row {
    /// The width of the body on its one line; `None` where it has several, or stays.
    fn width(&self) -> Option<usize> {
        let is_one = self.kind == Kind::Code && !self.body.contains('\n');
        is_one.then(|| self.indent + self.body.chars().count())
    }
}

fn laid_out(text: &str) -> String {
    let mut lines = lines::read(text);
    let functions = spelling::functions(&lines);
    for line in lines.iter_mut().filter(|line| !line.frozen) {
        spelling::spell(&mut line.items, &functions);
    }
    let mut rows = rows(&lines, &levels::places(&lines));
    align::tables(&mut rows);
    align::comments(&mut rows);
    written(&rows)
}

fn rows(lines: &[Line<'_>], places: &[Place]) -> Vec<Row> {
    let end = places.last().copied().unwrap_or_default();
    // From the end, as a comment stands where the next line does.
    let mut next = end.of_comment();
    let mut rows: Vec<Row> = lines
        .iter()
        .zip(places)
        .rev()
        .map(|(line, place)| {
            let (kind, level) = match line {
                _ if line.frozen => (Kind::Frozen, 0),
                _ if line.is_blank() => (Kind::Blank, 0),
                _ if line.is_comment() => (Kind::Comment, next),
                _ => (Kind::Code, place.level),
            };
            if matches!(kind, Kind::Frozen | Kind::Code) {
                next = place.of_comment();
            }
            let text = match kind {
                Kind::Frozen => spacing::Text { body: frozen(line).to_string(), trailing: None },
                _ => spacing::write(&line.items, (level + 1) * LEVEL),
            };
            Row { indent: level * LEVEL, body: text.body, trailing: text.trailing, kind, place: *place }
        })
        .collect();
    rows.reverse();
    rows
}

/// A line that stays as it is. The last one may have a comment that nothing closes: then all line ends up to the end of
/// the text are in it.
fn frozen<'a>(line: &Line<'a>) -> &'a str {
    if line.is_last { line.raw.trim_end_matches('\n') } else { line.raw }
}

/// The rows as text, with blank lines where they are to be: one at most, around functions one, at the borders of
/// blocks none.
fn written(rows: &[Row]) -> String {
    let mut text = String::new();
    let mut last: Option<&Row> = None;
    let mut blank = false;
    for (at, row) in rows.iter().enumerate() {
        if row.kind == Kind::Blank {
            blank = true;
            continue;
        }
        if let Some(last) = last {
            let code = |row: &Row| matches!(row.kind, Kind::Code | Kind::Frozen);
            let at_border = code(last) && last.place.opens || code(row) && row.place.closes;
            // A comment directly above a function belongs to it.
            let is_free = last.kind != Kind::Comment || blank;
            let around_function = code(last) && last.place.ends_function
                || is_free && begins_function(rows.get(at..).unwrap_or_default());
            if around_function || blank && !at_border {
                text.push('\n');
            }
        }
        blank = false;
        write(row, &mut text);
        last = Some(row);
    }
    text
}

/// Whether a function comes first, or the comments directly above one.
fn begins_function(rows: &[Row]) -> bool {
    let code = rows.iter().find(|row| row.kind != Kind::Comment);
    code.is_some_and(|row| row.kind == Kind::Code && row.place.begins_function)
}

fn write(row: &Row, text: &mut String) {
    if row.kind != Kind::Frozen {
        text.extend(std::iter::repeat_n(' ', row.indent));
    }
    text.push_str(&row.body);
    if let Some(comment) = &row.trailing {
        text.push(' ');
        text.push_str(comment);
    }
    text.push('\n');
}

/// Whether two texts are the same but for their layout: lexemes (in any case of their letters) and comments.
fn is_same(one: &str, other: &str) -> bool {
    essence(one) == essence(other)
}

fn essence(text: &str) -> Vec<Vec<String>> {
    let lines = lines::read(text);
    let full = lines.iter().filter(|line| !line.is_blank());
    let essence = full.map(|line| {
        if line.frozen {
            return vec![frozen(line).to_string()];
        }
        let mut words: Vec<String> = Vec::new();
        for item in &line.items {
            match item {
                Item::Piece(piece) if piece.text.starts_with('"') => words.push(piece.text.to_string()),
                // A number and its unit are one lexeme, or two.
                Item::Piece(piece) if piece.role == Role::Unit => {
                    let unit = piece.text.to_ascii_lowercase();
                    match words.last_mut() {
                        Some(number) => number.push_str(&unit),
                        None => words.push(unit),
                    }
                }
                Item::Piece(piece) => words.push(piece.text.to_ascii_lowercase()),
                Item::Comment(comment) | Item::LineComment(comment) => words.push(comment.to_string()),
                Item::Continuation => words.push("\\".to_string()),
            }
        }
        words
    });
    essence.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(input: &str, expected: &str) {
        let formatted = format(input);
        assert_eq!(formatted, expected);
        assert_eq!(format(&formatted), expected, "twice");
    }

    #[test]
    fn blocks_are_indented() {
        check(
            "func void main()\nif(a)\nb=1\nelse\nwhile(c)\nd()\nendwhile\nendif\nswitch(x)\ncase 1:\ny()\ndefault:\nz()\nendswitch\nendfunc",
            "func void main()\n    if(a)\n        b = 1\n    else\n        while(c)\n            d()\n        endwhile\n    endif\n    switch(x)\n    case 1:\n        y()\n    default:\n        z()\n    endswitch\nendfunc\n",
        );
        check("func void f()\nif(a) b=1\nc()\nendfunc\n", "func void f()\n    if(a) b = 1\n    c()\nendfunc\n");
    }

    #[test]
    fn spaces_are_as_in_the_manual() {
        let inside = |line: &str, expected: &str| {
            check(&format!("func void f()\n{line}\nendfunc\n"), &format!("func void f()\n    {expected}\nendfunc\n"));
        };
        inside("x=a+b*-c%5", "x = a + b * -c % 5");
        inside("lin p1 ,vl : 100 mm/s;T( 1 ),setdo(1,true)", "lin p1, vl:100mm/s; T(1), setdo(1, true)");
        inside("movej {j1 0,j2 -90},vp:50 %", "movej {j1 0, j2 -90}, vp:50%");
        inside("for(int i=0;i<3;i++) \n endfor", "for(int i = 0; i < 3; i++)\n    endfor");
        inside("a [ 1 ] .x = rack :: slot . y", "a[1].x = rack::slot.y");
        inside("print \"a  b\",endl", "print \"a  b\", endl");
        inside("return-1", "return -1");
        inside("i ++", "i++");
    }

    #[test]
    fn words_of_the_language_are_spelled_as_the_manual_does() {
        check(
            "Func Void Main()\nMOVEJ Home,VP:5%\nx=SIN(1)\nsetdo(1,TRUE)\n$vel_profile=1\nENDFUNC\n",
            "func void Main()\n    movej Home, vp:5%\n    x = sin(1)\n    setdo(1, true)\n    $VEL_PROFILE = 1\nendfunc\n",
        );
        // A function of the file's own that hides a built-in one.
        check(
            "func int Abs(int x)\nreturn x\nendfunc\nfunc void g()\nAbs(1)\nendfunc\n",
            "func int Abs(int x)\n    return x\nendfunc\n\nfunc void g()\n    Abs(1)\nendfunc\n",
        );
    }

    #[test]
    fn comments_stay_and_stand_in_a_column() {
        check(
            "int a//one\nint bcd // two  \n\n/* x\n  y */ int e\n// last\n",
            "int a   // one\nint bcd // two\n\n/* x\n  y */ int e\n// last\n".replace("// one", "//one").as_str(),
        );
        check("func void f()\n// inside\nendfunc\n", "func void f()\n    // inside\nendfunc\n");
    }

    #[test]
    fn points_stand_in_a_table() {
        check(
            "pose a={x 1,y -200,z 3}\npose long_name={x 1000,y 2,z 3}\njoint j={1,2}\n",
            "pose a         = {x 1,    y -200, z 3}\npose long_name = {x 1000, y 2,    z 3}\njoint j = {1, 2}\n",
        );
    }

    #[test]
    fn blank_lines_are_few() {
        check(
            "\n\nint a\n\n\nint b\n// of f\nfunc void f()\n\nb()\n\nendfunc\nfunc void g()\nendfunc\n\n\n",
            "int a\n\nint b\n\n// of f\nfunc void f()\n    b()\nendfunc\n\nfunc void g()\nendfunc\n",
        );
        check("", "");
        check("\n\n", "");
    }

    #[test]
    fn lines_with_mistakes_stay() {
        check("func void f()\n  x = = 2\n  y=1\nendfunc\n", "func void f()\n  x = = 2\n    y = 1\nendfunc\n");
        check(
            "func void f()\nif(a)\nb()\nendfunc\nendif\n",
            "func void f()\n    if(a)\n        b()\nendfunc\n\nendif\n",
        );
    }

    #[test]
    fn continued_lines_and_line_ends_stay() {
        check(
            "func void f()\nif(a \\\n&& b)\nc()\nendif\nendfunc\n",
            "func void f()\n    if(a \\\n        && b)\n        c()\n    endif\nendfunc\n",
        );
        check("int a\r\nint  b\r\n", "int a\r\nint b\r\n");
    }
}
