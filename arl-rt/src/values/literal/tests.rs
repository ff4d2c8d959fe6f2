use super::*;
use crate::text::Style;
use crate::values::*;
use arl_lang::ast::Ident;
use arl_lang::span::Span;
use std::cell::Cell;

/// Reads a literal with the least of a parser, so that these tests need none.
struct Reader<'a> {
    left: &'a str,
    names: Interner,
}

fn expr(kind: ExprKind) -> Expr {
    Expr { kind, span: Span::default() }
}

impl Reader<'_> {
    fn token(&mut self) -> String {
        self.left = self.left.trim_start();
        let end = match self.left.chars().next() {
            Some('"') => self.left[1..].find('"').unwrap() + 2,
            Some(first) if first.is_alphanumeric() => {
                self.left.find(|c: char| !c.is_alphanumeric() && !"._:".contains(c)).unwrap_or(self.left.len())
            }
            Some(_) => 1,
            None => 0,
        };
        let (token, left) = self.left.split_at(end);
        self.left = left;
        token.to_owned()
    }

    fn peek(&self) -> Option<char> {
        self.left.trim_start().chars().next()
    }

    fn value(&mut self) -> Expr {
        let token = self.token();
        let first = token.chars().next().unwrap();
        expr(match first {
            '{' => self.braces(),
            '-' => ExprKind::Unary(UnaryOp::Negate, Box::new(self.value())),
            '~' => ExprKind::Unary(UnaryOp::Complement, Box::new(self.value())),
            '"' => ExprKind::String(token.trim_matches('"').into()),
            '0'..='9' => match token.strip_suffix('h') {
                Some(digits) => ExprKind::Int(u32::from_str_radix(digits, 16).unwrap(), Radix::Hexadecimal),
                None => match token.parse() {
                    Ok(number) => ExprKind::Int(number, Radix::Decimal),
                    Err(_) => ExprKind::Double(token.parse().unwrap()),
                },
            },
            _ => match token.split_once("::") {
                Some((scope, name)) => {
                    ExprKind::Path { scope: self.ident(scope), system: false, name: self.ident(name) }
                }
                None => match token.as_str() {
                    "true" | "false" => ExprKind::Bool(token == "true"),
                    _ => ExprKind::Name(self.names.intern(&token)),
                },
            },
        })
    }

    fn ident(&mut self, name: &str) -> Ident {
        Ident { symbol: self.names.intern(name), span: Span::new(3, 4) }
    }

    fn braces(&mut self) -> ExprKind {
        let mut items = Vec::new();
        while self.peek() != Some('}') {
            let before = self.left;
            let word = self.token();
            let named = word.starts_with(char::is_alphabetic) && !matches!(self.peek(), Some(',' | '}'));
            let name = if named { Some(self.ident(&word)) } else { None };
            if !named {
                self.left = before;
            }
            items.push(BraceItem { name, value: self.value() });
            if self.peek() == Some(',') {
                self.token();
            }
        }
        self.token();
        ExprKind::Brace(items)
    }
}

fn teach(slot: &dyn Teach, text: &str) -> Result<(), String> {
    teach_sizes(slot, &[], text)
}

fn teach_sizes(slot: &dyn Teach, sizes: &[usize], text: &str) -> Result<(), String> {
    let mut reader = Reader { left: text, names: Interner::new() };
    let value = reader.value();
    slot.teach_nested(&value, sizes, &reader.names).map_err(|error| error.to_string())
}

fn taught<T: Literal + Default + Clone>(text: &str) -> Result<String, String> {
    let slot = Shared::new(T::default());
    teach(&slot, text)?;
    Ok(slot.with(|value| value.to_text(&Style::START).to_string()))
}

fn fits<T: Literal + Default + Clone>(text: &str, shown: &str) {
    assert_eq!(taught::<T>(text), Ok(shown.to_owned()), "{text}");
}

fn refused<T: Literal + Default + Clone>(text: &str, reason: &str) {
    assert_eq!(taught::<T>(text), Err(reason.to_owned()), "{text}");
}

#[test]
fn scalars() {
    fits::<i32>("12", "12");
    fits::<i32>("-2147483648", "-2147483648");
    fits::<i32>("0ffffffffh", "-1");
    fits::<i32>("ffh", "255");
    fits::<i32>("-1h", "-1");
    fits::<i32>("~0fh", "-16");
    fits::<i32>("~5", "-6");
    fits::<u32>("4294967295", "4294967295");
    fits::<u32>("ffffffffh", "4294967295");
    fits::<u8>("255", "ffh");
    fits::<f64>("-3", "-3");
    fits::<f64>("9e9", "9e+09");
    fits::<f64>("PI", "3.14159");
    fits::<bool>("true", "true");
    fits::<bool>("2", "true");
    fits::<bool>("0.0", "false");
    fits::<Str>("\"a b\"", "a b");
    refused::<i32>("2147483648", "the number is outside the range of int");
    refused::<u8>("256", "the number is outside the range of byte");
    refused::<u8>("-1", "the number is outside the range of byte");
    refused::<u32>("-1", "the number is outside the range of uint");
    refused::<i32>("1.5", "expected a value of type int, found a double");
    refused::<i32>("true", "expected a value of type int, found a bool");
    refused::<f64>("\"1\"", "expected a value of type double, found a string");
    refused::<Str>("1", "expected a value of type string, found an integer");
    refused::<f64>("speed1", "expected a value of type double, found a name");
    refused::<bool>("{1}", "expected a value of type bool, found braces");
}

#[test]
fn enumerations() {
    fits::<VelProfile>("s_type", "S_TYPE");
    fits::<VelProfile>("VEL_PROFILE::O_type", "O_TYPE");
    fits::<Controlmode>("T1", "MANUAL");
    fits::<Parity>("ParityType::even", "even");
    fits::<Stoptype>("1", "fast");
    refused::<Stoptype>("2", "the number is outside the range of stoptype");
    refused::<Stoptype>("slow", "expected a value of type stoptype, found a name");
    refused::<Stoptype>("parity::odd", "expected a value of type stoptype, found a name");
}

#[test]
fn structures() {
    fits::<Pos>("{1,2}", "{1,2,9e+09}");
    fits::<Pos>("{x 3, Z -4,}", "{3,9e+09,-4}");
    fits::<Pos>("{}", "{9e+09,9e+09,9e+09}");
    fits::<Tool>("{{x 10, b 90},true}", "{{10,0,0,0,90,0},true}");
    fits::<Tool>("{stationary 1}", "{{0,0,0,0,0,0},true}");
    fits::<Wobj>("{{1},false,\"table\"}", "{{1,0,0,0,0,0},false,table}");
    fits::<Slip>("{jdis 5}", "{9e+09,9e+09,9e+09,9e+09,9e+09,5}");
    fits::<InertiaTensor>("{lxx 1, Izz 2}", "{1,0,0,0,0,2}");
    fits::<Weavedata>("{V_shape,2,15,1,1,0,true}", "{V_shape,2,15,1,1,0,true,0,0,rot_x,0,false}");
    refused::<Slip>("{1,2,3,4,5,6}", "slip takes at most 5 values");
    refused::<Pos>("{x 1, 2}", "values with and without names, or rows and elements, stand side by side in braces");
    refused::<Pos>("{x 1, X 2}", "component x is set twice");
    refused::<Pos>("{q 1}", "pos has no component q; it has x, y, z");
    refused::<Pos>("1", "expected a value of type pos, found an integer");
    refused::<Tool>("{{1,2,\"3\"}}", "t_frame.z: expected a value of type double, found a string");
    refused::<Pose>("{cfg 1.5}", "cfg: expected a value of type int, found a double");
}

#[test]
fn arrays() {
    fits::<Array<f64, 4>>("{1,2}", "{1,2,0,0}");
    fits::<SmallArray<u8, 2>>("{ffh,0bh}", "{ffh,0bh}");
    fits::<Array<Pos, 2>>("{{1,2,3},{x 4}}", "{{1,2,3},{4,9e+09,9e+09}}");
    refused::<Array<f64, 2>>("{1,2,3}", "an array of double takes at most 2 values");
    refused::<Array<i32, 2>>("{1,2.5}", "[1]: expected a value of type int, found a double");
    refused::<Array<Pos, 2>>("{{1},{2,true}}", "[1].y: expected a value of type double, found a bool");
    refused::<Array<i32, 2>>("5", "expected a value of type int[2], found an integer");
    fits::<Array<i32, 4>>("{{1,2},{3,4}}", "{1,2,3,4}");
    refused::<Array<i32, 4>>("{{1},{3,4}}", "[0]: expected a value of type int, found braces");
}

#[test]
fn arrays_of_more_dimensions() {
    let slot = Shared::new(Array::<i32, 6>::start());
    let shown = || slot.with(|array| array.to_text(&Style::START).to_string());
    for (text, values) in [
        ("{1,2,3,4,5,6}", "{1,2,3,4,5,6}"),
        ("{{1,2,3},{4,5,6}}", "{1,2,3,4,5,6}"),
        ("{{1},{4,5}}", "{1,0,0,4,5,0}"),
        ("{{1,2,3}}", "{1,2,3,0,0,0}"),
    ] {
        teach_sizes(&slot, &[2, 3], text).unwrap();
        assert_eq!(shown(), values, "{text}");
    }
    for (text, reason) in [
        ("{{1,2,3,4}}", "[0]: an array of int takes at most 3 values"),
        ("{{1},{2},{3}}", "an array of int takes at most 2 values"),
        ("{1,{2}}", "[1]: expected a value of type int, found braces"),
        ("{{1},{2,true}}", "[1][1]: expected a value of type int, found a bool"),
    ] {
        assert_eq!(teach_sizes(&slot, &[2, 3], text), Err(reason.to_owned()), "{text}");
    }
    assert_eq!(shown(), "{1,2,3,0,0,0}", "a value that does not fit changes nothing");
    let points = Shared::new(Array::<Pos, 4>::start());
    for text in ["{{{1,1,1},{2,2,2}},{{3,3,3},{4,4,4}}}", "{{1,1,1},{2,2,2},{3,3,3},{4,4,4}}"] {
        teach_sizes(&points, &[2, 2], text).unwrap();
        let shown = points.with(|points| points.to_text(&Style::START));
        assert_eq!(shown, "{{1,1,1},{2,2,2},{3,3,3},{4,4,4}}");
    }
    let tools = Shared::new(Array::<Tool, 2>::start());
    teach_sizes(&tools, &[1, 2], "{{{{1}},{{2},true}}}").unwrap();
    assert_eq!(tools.with(|tools| tools.to_text(&Style::START)), "{{{1,0,0,0,0,0},false},{{2,0,0,0,0,0},true}}");
}

#[test]
fn slots_keep_their_value_where_another_does_not_fit() {
    let slot = Cell::new(Joint { j1: 1.0, ..Joint::default() });
    assert!(teach(&slot, "{2,true}").is_err());
    assert_eq!(slot.get().j1, 1.0);
    teach(&slot, "{j2 3}").unwrap();
    assert_eq!(slot.get(), Joint { j2: 3.0, ..Joint::default() });
    assert_eq!(Teach::type_name(&slot), "joint");
    assert_eq!(Teach::type_name(&Shared::new(Array::<Pose, 3>::start())), "pose[3]");
}
