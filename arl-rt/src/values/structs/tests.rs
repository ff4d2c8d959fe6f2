//! Structures: components, defaults, text.

use super::*;
use crate::values::*;
use arl_lang::catalog::{Base, Component, Family, Start, Struct, StructDef};

/// What a test needs to know about a structure without its type.
struct About {
    rust: &'static str,
    name: &'static str,
    components: Vec<(&'static str, String, String)>,
    positional: usize,
    find: fn(&str) -> Option<usize>,
    start: String,
}

fn shown(value: &dyn Print) -> String {
    value.printed(&Style::START).to_string()
}

fn about<S: Structure + Typed + Print>() -> About {
    let start = S::default();
    let component = |(at, name): (usize, &&'static str)| {
        let value = start.component(at).unwrap();
        (*name, value.type_name(), value.printed(&Style::START).to_string())
    };
    About {
        rust: std::any::type_name::<S>().rsplit("::").next().unwrap(),
        name: S::NAME,
        components: S::COMPONENTS.iter().enumerate().map(component).collect(),
        positional: S::POSITIONAL,
        find: S::component_index,
        start: shown(&start),
    }
}

macro_rules! all {
    ($($ty:ident)*) => { [$(about::<$ty>(),)*] };
}

fn all() -> [About; 21] {
    all!(Pos Frame Pose Joint JointScara Tool Wobj Weavedata Speed Slip SlipScara Jvel JvelScara CentroidPos InertiaTensor
        ToolInertiaPara Control Compendata Jttq Jtci Tcpforce)
}

fn type_name(base: Base, family: Family) -> &'static str {
    match base {
        Base::Int => "int",
        Base::Double => "double",
        Base::Bool => "bool",
        Base::String => "string",
        Base::Struct(id) => id.def(family).name,
        Base::Enum(id) => id.def().name,
        other => panic!("{other:?} in a structure"),
    }
}

fn start_text(component: &Component, family: Family) -> String {
    match (component.start, component.ty) {
        (Start::Unset, _) => "9e+09".to_owned(),
        (Start::Int(value), _) => value.to_string(),
        (Start::Zero, Base::Bool) => "false".to_owned(),
        (Start::Zero, Base::String) => String::new(),
        (Start::Zero, Base::Struct(id)) => {
            let inner = id.def(family).components;
            let texts: Vec<_> = inner.iter().map(|component| start_text(component, family)).collect();
            format!("{{{}}}", texts.join(","))
        }
        (Start::Zero, Base::Enum(id)) => id.def().constants[0].name.to_owned(),
        (Start::Zero, _) => "0".to_owned(),
    }
}

fn compare(def: &StructDef, family: Family) {
    let about = all().into_iter().find(|about| about.rust == def.rust);
    let about = about.unwrap_or_else(|| panic!("no type {}", def.rust));
    assert_eq!(about.name, def.name);
    assert_eq!(about.components.len(), def.components.len(), "{}", def.rust);
    for (at, (component, (name, ty, start))) in def.components.iter().zip(&about.components).enumerate() {
        assert_eq!(*name, component.name.to_ascii_lowercase(), "{}", def.rust);
        assert_eq!(ty, type_name(component.ty, family), "{}.{name}", def.rust);
        assert_eq!(start, &start_text(component, family), "{}.{name}", def.rust);
        assert_eq!(component.by_position, at < about.positional, "{}.{name}", def.rust);
        for name in component.aliases.iter().chain([&component.name]) {
            assert_eq!((about.find)(name), Some(at), "{}.{name}", def.rust);
        }
    }
    assert_eq!((about.find)("nobody"), None);
}

#[test]
fn are_those_of_the_catalog() {
    for id in Struct::ALL {
        for family in [Family::SixAxis, Family::Scara] {
            compare(id.def(family), family);
        }
    }
}

#[test]
fn start_values_print() {
    let unset = |count| format!("{{{}}}", vec!["9e+09"; count].join(","));
    let expected = [
        ("Pos", unset(3)),
        ("Frame", "{0,0,0,0,0,0}".into()),
        ("Pose", "{9e+09,9e+09,9e+09,9e+09,9e+09,9e+09,0,-1,9e+09,9e+09,9e+09,9e+09,9e+09,9e+09}".into()),
        ("Joint", unset(12)),
        ("JointScara", unset(10)),
        ("Tool", "{{0,0,0,0,0,0},false}".into()),
        ("Wobj", "{{0,0,0,0,0,0},false}".into()),
        ("Weavedata", "{simple,0,0,0,0,0,false,0,0,rot_x,0,false}".into()),
        ("Speed", unset(5)),
        ("Slip", unset(5)),
        ("SlipScara", unset(5)),
        ("Jvel", unset(12)),
        ("JvelScara", unset(10)),
        ("CentroidPos", "{0,0,0}".into()),
        ("InertiaTensor", "{0,0,0,0,0,0}".into()),
        ("ToolInertiaPara", "{0,{0,0,0},{0,0,0,0,0,0}}".into()),
        ("Control", unset(6)),
        ("Compendata", "{0,0,0,0,0,0}".into()),
        ("Jttq", unset(12)),
        ("Jtci", unset(12)),
        ("Tcpforce", unset(6)),
    ];
    for (about, (rust, text)) in all().iter().zip(expected) {
        assert_eq!((about.rust, &about.start), (rust, &text));
    }
}

#[test]
fn values_print_in_order() {
    let frame = Frame { x: 10.0, y: 10.0, b: 90.0, ..Frame::default() };
    assert_eq!(shown(&Tool { t_frame: frame, stationary: true }), "{{10,10,0,0,90,0},true}");
    let mut wobj = Wobj { w_frame: frame, ..Wobj::default() };
    assert_eq!(shown(&wobj), "{{10,10,0,0,90,0},false}");
    wobj.mu_name = Str::from("turn table");
    assert_eq!(shown(&wobj), "{{10,10,0,0,90,0},false,turn table}");
    let mut slip = Slip { perdis: 100.0, pdis: 2.0, odis: 3.0, ejdis: 4.0, eldis: 5.0, ..Slip::default() };
    assert_eq!(shown(&slip), "{100,2,3,4,5}");
    slip.jdis = 6.5;
    assert_eq!(shown(&slip), "{100,2,3,4,5,6.5}");
    assert_eq!(shown(&SlipScara::from(slip)), "{2,4,5,3,100}");
    let weave = Weavedata {
        weaveshape: Weaveshape::VShape,
        frequency: 2.0,
        amplitude: 15.0,
        dwell_left: 1.0,
        dwell_right: 2.0,
        dwell_middle: 3.0,
        track: true,
        swing_angle: 4.0,
        radius: 5.0,
        weaverotaxis: Weaverotaxis::Z,
        rotation_angle: 6.0,
        vibrat: true,
    };
    assert_eq!(shown(&weave), "{V_shape,2,15,1,2,3,true,4,5,rot_z,6,true}");
    let load = ToolInertiaPara {
        m: 30.0,
        centroidpos: CentroidPos { x: 15.0, y: 25.0, z: 100.0 },
        inertiatensor: InertiaTensor { ixx: 10.0, ixy: 20.0, ixz: 30.0, iyy: 40.0, iyz: 50.0, izz: 60.0 },
    };
    assert_eq!(shown(&load), "{30,{15,25,100},{10,20,30,40,50,60}}");
    let pose = Pose { y: 10.0, z: 15.0, b: 90.0, turn: 255, ej1: 20.0, x: 0.0, a: -0.0, c: 0.0, ..Pose::default() };
    assert_eq!(shown(&pose), "{0,10,15,0,90,0,0,255,20,9e+09,9e+09,9e+09,9e+09,9e+09}");
    let hex = Style { base: Some(NumBase::Hex), precision: 2 };
    assert_eq!(
        Pose { x: 1234.0, ..pose }.printed(&hex),
        "{1.2e+03,10,15,0,90,0,0,ff,20,9e+09,9e+09,9e+09,9e+09,9e+09}"
    );
}

#[test]
fn numbered_components_print_in_order() {
    /// Sets each component to its number and compares with the numbers.
    fn walk<S: Structure + Print>() {
        let mut value = S::default();
        for at in 0..S::COMPONENTS.len() {
            let number = arl_lang::ast::Expr {
                kind: arl_lang::ast::ExprKind::Int(at as u32 + 1, arl_lang::ast::Radix::Decimal),
                span: arl_lang::span::Span::default(),
            };
            value.component_mut(at).unwrap().put(&number, &arl_lang::symbol::Interner::new()).unwrap();
        }
        let numbers: Vec<_> = (1..=S::COMPONENTS.len()).map(|number| number.to_string()).collect();
        assert_eq!(shown(&value), format!("{{{}}}", numbers.join(",")));
        assert!(value.component(S::COMPONENTS.len()).is_none());
        assert!(value.component_mut(S::COMPONENTS.len()).is_none());
    }
    walk::<Pos>();
    walk::<Frame>();
    walk::<Pose>();
    walk::<Joint>();
    walk::<JointScara>();
    walk::<Speed>();
    walk::<Slip>();
    walk::<SlipScara>();
    walk::<Jvel>();
    walk::<JvelScara>();
    walk::<CentroidPos>();
    walk::<InertiaTensor>();
    walk::<Control>();
    walk::<Compendata>();
    walk::<Jttq>();
    walk::<Jtci>();
    walk::<Tcpforce>();
}

#[test]
fn arrays_of_structures_print() {
    let points: Array<Pos, 2> = [Pos { x: 1.0, y: 2.0, z: 3.0 }, Pos::default()].into();
    assert_eq!(shown(&points), "{{1,2,3},{9e+09,9e+09,9e+09}}");
    assert_eq!(shown(&crate::values::text::nested(&points, &[2, 1])), "{{{1,2,3}},{{9e+09,9e+09,9e+09}}}");
    assert_eq!(Print::type_name(&points), "pos[2]");
    assert_eq!(shown(&[VelProfile::T, VelProfile::O]), "{T_TYPE,O_TYPE}");
}
