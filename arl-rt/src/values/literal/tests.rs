//! Values written as text, and read back.

use super::*;
use crate::values::text::Style;
use crate::values::*;
use arl_lang::ast::{Decl, Item};
use std::cell::Cell;

/// Reads a declaration of one variable.
fn declaration(text: &str) -> (Decl, Interner) {
    let mut names = Interner::new();
    let parsed = arl_lang::parse(&format!("{text}\n"), &mut names, Default::default());
    assert!(parsed.errors.is_empty(), "{text}: {:?}", parsed.errors);
    match parsed.file.items.into_iter().next() {
        Some(Item::Global(decl)) => (decl, names),
        other => panic!("{text}: {other:?}"),
    }
}

/// Teaches the initialiser of a declaration of any type.
fn teach_sizes(slot: &dyn Teach, sizes: &[usize], text: &str) -> Result<(), String> {
    let (decl, names) = declaration(&format!("int x = {text}"));
    let value = decl.vars[0].init.as_ref().unwrap();
    slot.teach_nested(value, sizes, &names).map_err(|error| error.to_string())
}

/// Teaches a whole declaration.
fn redeclare(slot: &dyn Teach, sizes: &[usize], text: &str) -> Result<(), String> {
    let (decl, names) = declaration(text);
    teach_variable(slot, sizes, &decl.ty, &decl.vars[0], &names).map_err(|error| error.to_string())
}

fn teach(slot: &dyn Teach, text: &str) -> Result<(), String> {
    teach_sizes(slot, &[], text)
}

fn taught<T: Literal + Default + Clone>(text: &str) -> Result<String, String> {
    let slot = Shared::new(T::default());
    teach(&slot, text)?;
    Ok(slot.with(|value| value.printed(&Style::START).to_string()))
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
    fits::<i32>("fast", "1");
    fits::<i32>("parity::even", "2");
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
    fits::<VelProfile>("$VEL_PROFILE::O_type", "O_TYPE");
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
    refused::<Pos>("{x 1, 2}", "the braces mix values with and without names, or rows and elements");
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
    let shown = || slot.with(|array| array.printed(&Style::START).to_string());
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
        let shown = points.with(|points| points.printed(&Style::START));
        assert_eq!(shown, "{{1,1,1},{2,2,2},{3,3,3},{4,4,4}}");
    }
    let tools = Shared::new(Array::<Tool, 2>::start());
    teach_sizes(&tools, &[1, 2], "{{{{1}},{{2},true}}}").unwrap();
    assert_eq!(tools.with(|tools| tools.printed(&Style::START)), "{{{1,0,0,0,0,0},false},{{2,0,0,0,0,0},true}}");
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

#[test]
fn declarations_keep_their_type() {
    let slot = Cell::new(Pos { x: 1.0, y: 1.0, z: 1.0 });
    redeclare(&slot, &[], "pos p = {2,3}").unwrap();
    assert_eq!(slot.get(), Pos { x: 2.0, y: 3.0, z: UNSET });
    let again = "the program was compiled with type pos, and the type is ";
    assert_eq!(redeclare(&slot, &[], "frame p = {2,3}"), Err(format!("{again}frame now: compile it again")));
    assert_eq!(redeclare(&slot, &[], "pos p[2] = {{2,3}}"), Err(format!("{again}pos[2] now: compile it again")));
    redeclare(&slot, &[], "pos p").unwrap();
    assert_eq!(slot.get(), Pos::default());
    let profile = Cell::new(VelProfile::S);
    redeclare(&profile, &[], "$VEL_PROFILE v = T_TYPE").unwrap();
    assert_eq!(profile.get(), VelProfile::T);
    let centroid = Cell::new(CentroidPos::default());
    redeclare(&centroid, &[], "CentroidPos c = {1}").unwrap();
    assert_eq!(centroid.get().x, 1.0);
    let table = Shared::new(Array::<i32, 6>::start());
    redeclare(&table, &[], "int t[6] = {1}").unwrap();
    redeclare(&table, &[2, 3], "int t[2][3] = {{1},{2}}").unwrap();
    assert_eq!(*table.get(), [1, 0, 0, 2, 0, 0]);
    for (sizes, text) in [(&[][..], "int t[5]"), (&[], "int t[2][3]"), (&[2, 3], "int t[6]"), (&[2, 3], "int t[3][2]")]
    {
        assert!(redeclare(&table, sizes, text).is_err(), "{text}");
    }
    assert_eq!(
        redeclare(&table, &[2, 3], "double t[3][2]").unwrap_err(),
        "the program was compiled with type int[2][3], and the type is double[3][2] now: compile it again"
    );
}

#[test]
fn constants_keep_their_value() {
    let slot: &'static dyn Teach = &Fixed(5_u8);
    redeclare(slot, &[], "const byte b = 5").unwrap();
    let reason = "it is a constant, 05h in this program: only the text of the program changes it";
    assert_eq!(redeclare(slot, &[], "const byte b = 6"), Err(reason.to_owned()));
    assert_eq!(redeclare(slot, &[], "byte b"), Err(reason.to_owned()));
    let slot: &'static dyn Teach = &Fixed("text");
    redeclare(slot, &[], "const string s = \"text\"").unwrap();
    assert!(redeclare(slot, &[], "const string s = \"other\"").is_err());
    assert_eq!(slot.type_name(), "string");
}

/// The text of a value, which is read back as the same value.
fn rewritten<T: Literal + Default + Clone + PartialEq>(value: T) -> String {
    let slot = Shared::new(value.clone());
    let text = slot.written();
    let again = Shared::new(T::default());
    teach(&again, &text).unwrap();
    assert!(again.get() == value, "{text}");
    text
}

#[test]
fn what_is_written_is_read_back() {
    assert_eq!(rewritten(i32::MIN), "-2147483648");
    assert_eq!(rewritten(u32::MAX), "4294967295");
    assert_eq!(rewritten(200_u8), "200");
    assert_eq!(rewritten(0.1), "0.1");
    assert_eq!(rewritten(-1.0 / 3.0), "-0.3333333333333333");
    assert_eq!(rewritten(1e-9), "1e-9");
    assert_eq!(rewritten(2.5e300), "2.5e300");
    assert_eq!(rewritten(UNSET), "9e9");
    assert!(rewritten(true) == "true");
    assert_eq!(rewritten(Str::from("a \"b\" \\ c\n\t")), r#""a \"b\" \\ c\n\t""#);
    assert_eq!(rewritten(Controlmode::Manual), "MANUAL");
    assert_eq!(rewritten(Pose { x: 1.5, z: -2.0, ..Pose::default() }), "{x 1.5,z -2,cfg 0,turn -1}");
    assert_eq!(rewritten(Joint::default()), "{}");
    let tool = Tool { stationary: true, ..Tool::default() };
    assert_eq!(rewritten(tool), "{t_frame {x 0,y 0,z 0,a 0,b 0,c 0},stationary true}");
    assert_eq!(rewritten(Array::<i32, 3>::from_values(&[1, 2, 3])), "{1,2,3}");
}
