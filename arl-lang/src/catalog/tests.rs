//! Walks the tables.

use std::collections::{HashMap, HashSet};

use super::*;

/// Every name of the manual's index except the basic types and the words of the grammar.
const INDEX: &str = "\
    accset ccir cir clock compen controlmode endcompen endweave exit frame interrupt joint jvel lin movej \
    num_base parity pause pos pose print printto ptp restart scan slip speed startcompen startmove startweave \
    stopbits stopmove stoptype timer tool ToolInertiaPara toolload toolswitch trigger velset waittime waituntil \
    weavedata weaverotaxis weaveshape wobj spl jump control compendata startdetect enddetect Centroid_Pos \
    Inertia_Tensor socket iodev modbus_dev melsec_dev jttq jtci tcpforce abs sin cos tan asin acos atan atan2 \
    sinh cosh tanh exp pow pow10 log log10 sqrt floor ceil frexp ldexp fmod modf hypot rand norm trunc bitclear \
    bitset bitcheck bitlcs bitrcs clkstart clkstop clkreset clkread strlen substr toascii setdo setdoimv syncdo \
    pulsedo getdo getdi getai getnostopdi setao syncao getao getintdo getintdi setpwm setip getip connect accept \
    write read readuntil clearbuff open close geterror dnwrite dnread readregisters writeregisters readcoils \
    writecoils setcycle toint todouble tobytes tostr ftobytes tofloat cjoint cpose getpose getjoint poseinv \
    offset reltool cjttq cjtcj channeltojoint channeltopose channeljoint channelpose channeljointvel \
    channeltcpvel ctcpforce getwobj_3p getwobj_indi getwobj_flange gettooltcp_ref gettoolrot_world gettoolrot_3p \
    gettool_3p getbase_3p StoEnd savearl savefilepose savefilejoint saveposenow savejointnow switcharl typeof \
    ctime cdate assert savesv init gettextstr curmpfile curmpline curppfile curppline savearl savefilepose savefilejoint filesize renamefile \
    removefile disableint enableint delint $EXT_CTL_ACT_DI $SERVO_ON_DI $SERVO_OFF_DI $START_PROG_DI \
    $PAUSE_PROG_DI $RESET_PROG_DI $CLEAR_ALARM_DI $PGNO_TYPE $PGNO_LENGTH $PGNO_FBIT_DI $PGNO_PARITY_DI \
    $PGNO_VALID_DI $EXT_CTL_ACT_CONF_DO $SERVO_ON_DO $PGNO_REQ_DO $AT_HOME_DO $AT_T1_DO $AT_T2_DO $AT_AUT_DO \
    $PGNO_ACK_FBIT_DO $CHAN_STATE_DO $I $I_NAME $B $B_NAME $D $D_NAME $P $J $TOOLS $TOOLS_NAME $WOBJS \
    $WOBJS_NAME $BASE $FLANGE $WORLD $WRIST $CONFIG_CHECK $DFSPEED $DFSLIP $DFTOOL $DFWOBJ $IGNORE_ORI \
    $ORI_REF_PATH $VEL_PROFILE $TRAJ_ELAPSE_TIME $TRAJ_LEFT_TIME $TRAJ_ELAPSE_DIS $TRAJ_LEFT_DIS $CJOINT \
    $RPP_ENABLE $AT_HOME $EXT_CTL_ACT $PGNO_REQ $PGNO $PI $CTL_MODE $WOBJ_OFFSET $TOOL_OFFSET $RESET_POS_TYPE \
    $RESET_POS_THRESHOLD $TOOL_INERTIA $DETECT_SOCKET_CLOSE $ERR_SOCKET_CLOSED";

const RUST_WORDS: &str = "as async await break const continue crate do dyn else enum extern false final fn for gen if \
    impl in let loop macro match mod move mut override priv pub ref return self static struct super trait true try type \
    typeof unsafe unsized use virtual where while yield";

fn is_rust_name(name: &str) -> bool {
    let plain = name.bytes().all(|byte| byte.is_ascii_lowercase() || byte.is_ascii_digit() || byte == b'_');
    plain && !name.is_empty() && !RUST_WORDS.split_whitespace().any(|word| word == name)
}

/// Whether `text` is a constant of a scalar type, as the checker fills it in.
fn is_constant(text: &str, ty: ParamType) -> bool {
    match ty {
        ParamType::One(Base::Int) => text.parse::<i32>().is_ok(),
        ParamType::One(Base::Double) => text.parse::<f64>().is_ok(),
        ParamType::One(Base::Bool) => text.parse::<bool>().is_ok(),
        ParamType::One(Base::String) => text.len() > 1 && text.starts_with('"') && text.ends_with('"'),
        ParamType::One(Base::Enum(id)) => id.def().constant(text).is_some(),
        _ => false,
    }
}

fn found(name: &str) -> bool {
    match name.strip_prefix('$') {
        Some(bare) => system_variable(bare).is_some(),
        None => {
            !functions(name).is_empty()
                || !instructions(name).is_empty()
                || base_type(name).is_some()
                || constant(name).is_some()
        }
    }
}

#[test]
fn every_name_of_the_index_is_found() {
    let missing: Vec<&str> = INDEX.split_whitespace().filter(|name| !found(name)).collect();
    assert!(missing.is_empty(), "{missing:?}");
    assert!(INDEX.split_whitespace().count() > 240);
    assert!(base_type("vel_profile").is_some_and(Base::is_system));
}

#[test]
fn names_match_in_any_case_and_by_alias() {
    assert_eq!(functions("SETDO"), functions("setdo"));
    assert_eq!(functions("setdo").len(), 2);
    assert_eq!(instructions("StartWeaveLin"), instructions("startweave"));
    assert_eq!(functions("dhread"), functions("dnread"));
    assert_eq!(system_element("Tool0"), system_variable("tools").map(|tools| (tools, 0)));
    assert_eq!(system_element("WOBJ31"), system_variable("wobjs").map(|frames| (frames, 31)));
    for name in
        ["tool", "tool32", "tool07", "tool-1", "tool4294967296", "tools1", "1tool1", "wobj", "flange0", "\u{e9}1"]
    {
        assert_eq!(system_element(name), None, "{name}");
    }
    assert_eq!(system_variable("congfig_CHECK"), system_variable("Config_Check"));
    assert_eq!(base_type("melsec"), Some(Base::Handle(Handle::MelsecDev)));
    assert_eq!(base_type("modbus_parity"), Some(Base::Enum(Enum::Parity)));
    assert_eq!(base_type("CENTROIDPOS"), base_type("centroid_pos"));
    assert_eq!(enum_constant("s_type"), Some((Enum::VelProfile, 1)));
    assert_eq!(enum_constant("t2"), Some((Enum::Controlmode, 2)));
    assert_eq!(renamed("$DFSPPED"), Some("$DFSPEED"));
    assert_eq!(renamed("weavedatalin"), Some("weavedata"));
    assert!(functions("no such name that is rather long, longer than all").is_empty());
    assert!(instructions("sin").is_empty() && functions("lin").is_empty() && functions("\u{e4}").is_empty());
}

#[test]
fn types_are_reserved_and_functions_are_not() {
    for word in ["WHILE", "ToolInertiaPara", "lin", "weavedata", "endl", "endswitch", "true"] {
        assert!(reserved(word), "{word}");
    }
    for word in ["t", "s", "p", "abs", "socket", "setdo", "pi", "i"] {
        assert!(!reserved(word), "{word}");
    }
}

#[test]
fn overloads_stand_together_and_differ() {
    let mut seen = HashSet::new();
    for group in all_entries().chunk_by(|a, b| a.kind == b.kind && a.name == b.name) {
        let name = group[0].name;
        assert!(seen.insert((group[0].kind, name.to_ascii_lowercase())), "{name} is in two places");
        let signatures: HashSet<String> = group
            .iter()
            .map(|entry| format!("{:?}", entry.params.iter().map(|p| (p.ty, p.mode)).collect::<Vec<_>>()))
            .collect();
        assert_eq!(signatures.len(), group.len(), "{name} has two equal signatures");
    }
    let counted: usize = CHAPTERS.iter().map(|chapter| chapter.entries.len()).sum();
    assert_eq!(counted, all_entries().len());
}

#[test]
fn no_name_means_two_things_of_one_kind() {
    let mut owners: HashMap<(Kind, String), &str> = HashMap::new();
    for entry in all_entries() {
        for name in std::iter::once(&entry.name).chain(entry.aliases) {
            assert!(name.len() <= 32, "{name} does not fit the lookup's buffer");
            let owner = owners.entry((entry.kind, name.to_ascii_lowercase())).or_insert(entry.name);
            assert_eq!(*owner, entry.name, "{name}");
        }
    }
    let mut variables = HashSet::new();
    for variable in system_variables() {
        for name in std::iter::once(&variable.name).chain(variable.aliases) {
            assert!(name.len() <= 32 && variables.insert(name.to_ascii_lowercase()), "${name}");
        }
    }
    let mut constants = HashSet::new();
    for id in Enum::ALL {
        for constant in id.def().constants {
            for name in std::iter::once(&constant.name).chain(constant.aliases) {
                assert!(constants.insert(name.to_ascii_lowercase()), "{name}");
            }
        }
    }
}

#[test]
fn every_entry_is_whole() {
    let mut paths = HashSet::new();
    for entry in all_entries() {
        let name = entry.name;
        assert!(entry.doc.ends_with('.') && !entry.section.is_empty(), "{name}");
        let mentions = |name: &&str| entry.example.to_ascii_lowercase().contains(&name.to_ascii_lowercase());
        assert!(mentions(&name), "{name}: its example is about something else");
        assert!(paths.insert(entry.path), "{name}: {} is taken", entry.path);
        let (module, function) = entry.path.split_once("::").expect("module::function");
        assert!(is_rust_name(module) && is_rust_name(function), "{}", entry.path);
        if entry.effect == Effect::Plans {
            assert!(!entry.background && entry.kind == Kind::Instruction, "{name}");
        }
        if entry.kind == Kind::Instruction {
            assert_eq!(entry.result, Base::Void, "{name}");
        }
    }
}

/// Whether it leaves numbers out, and others not.
fn is_range(range: Range) -> bool {
    let bounds: &[f64] = match &range {
        Range::Within(low, high) => &[*low, *high],
        Range::Above(bound) | Range::AtLeast(bound) | Range::AtMost(bound) => &[*bound],
        Range::OnlyFalse => &[],
    };
    bounds.is_sorted_by(|low, high| low < high) && bounds.iter().all(|bound| bound.is_finite())
}

#[test]
fn parameters_are_sound() {
    for entry in all_entries() {
        let name = entry.name;
        let mut labels = HashSet::new();
        let mut rust = HashSet::new();
        let mut optional = false;
        for param in entry.params {
            for label in std::iter::once(&param.name).chain(param.aliases) {
                assert!(labels.insert(label.to_ascii_lowercase()), "{name}: {label} twice");
                assert_eq!(entry.param(label).map(|at| entry.params[at].name), Some(param.name));
            }
            assert!(is_rust_name(param.rust) && rust.insert(param.rust), "{name}: {}", param.rust);
            assert!(!param.doc.is_empty() && !param.doc.ends_with('.'), "{name}: {}", param.name);
            let required = param.presence == Presence::Required;
            assert!(!required || !optional || entry.kind == Kind::Instruction, "{name}: {} comes too late", param.name);
            optional |= !required;
            match param.presence {
                Presence::Default(text) => assert!(is_constant(text, param.ty), "{name}: {text}"),
                Presence::Repeat { min, max } => assert!(min <= max && max > 1),
                Presence::Required | Presence::Optional => {}
            }
            assert!(param.range.is_none_or(is_range), "{name}: {}", param.name);
            if param.mode == Mode::Out {
                let handle = matches!(param.ty, ParamType::One(Base::Handle(_)));
                assert!(!handle && !matches!(param.presence, Presence::Default(_)), "{name}: {}", param.name);
            }
            if entry.kind == Kind::Function {
                assert!(param.bare, "{name}: {}", param.name);
            }
        }
        for group in entry.exclusive {
            assert!(group.len() > 1, "{name}");
            for label in *group {
                let at = entry.param(label).unwrap_or_else(|| panic!("{name}: no parameter {label}"));
                assert_eq!(entry.params[at].presence, Presence::Optional, "{name}: {label}");
            }
        }
    }
}

#[test]
fn system_variables_are_whole() {
    let mut fields = HashSet::new();
    for variable in system_variables() {
        let name = variable.name;
        assert!(!variable.default.is_empty() && variable.doc.ends_with('.'), "${name}");
        assert!(is_rust_name(variable.field) && fields.insert(variable.field), "${name}: {}", variable.field);
        assert!(variable.example.contains(&format!("${name}")), "${name}");
        assert!(variable.dims.iter().all(|size| *size > 0), "${name}");
        let computed = matches!(variable.ty, Base::Handle(_) | Base::Void);
        assert!(!computed, "${name}");
    }
    for name in [
        "AT_HOME",
        "EXT_CTL_ACT",
        "CTL_MODE",
        "CJOINT",
        "TRAJ_ELAPSE_TIME",
        "TRAJ_LEFT_TIME",
        "TRAJ_ELAPSE_DIS",
        "TRAJ_LEFT_DIS",
        "PI",
        "FLANGE",
        "WORLD",
    ] {
        assert_eq!(system_variable(name).map(|variable| variable.access), Some(Access::ReadOnly), "${name}");
    }
}

#[test]
fn structures_have_the_components_of_their_family() {
    let count = |id: Struct, family| id.def(family).components.len();
    assert_eq!((count(Struct::Joint, Family::SixAxis), count(Struct::Joint, Family::Scara)), (12, 10));
    assert_eq!((count(Struct::Jvel, Family::SixAxis), count(Struct::Jvel, Family::Scara)), (12, 10));
    assert_eq!((count(Struct::Slip, Family::SixAxis), count(Struct::Slip, Family::Scara)), (6, 5));
    assert_eq!(count(Struct::Pose, Family::SixAxis), 14);
    assert_eq!(count(Struct::Weavedata, Family::SixAxis), 12);
    for id in Struct::ALL {
        for family in [Family::SixAxis, Family::Scara] {
            let def = id.def(family);
            assert_eq!(def.id, id);
            assert!(def.doc.ends_with('.') && !def.section.is_empty(), "{}", def.name);
            let mut names = HashSet::new();
            for component in def.components {
                assert!(names.insert(component.name.to_ascii_lowercase()) && !component.doc.is_empty(), "{}", def.name);
                assert!(is_rust_name(&component.name.to_ascii_lowercase()), "{}.{}", def.name, component.name);
                assert!(component.start != Start::Unset || component.ty == Base::Double, "{}", def.name);
                assert!(component.range.is_none_or(is_range), "{}.{}", def.name, component.name);
            }
        }
    }
    let slip = Struct::Slip.def(Family::SixAxis);
    assert_eq!(slip.component("JDIS"), Some(5));
    assert!(slip.components[..5].iter().all(|component| component.by_position) && !slip.components[5].by_position);
    let tensor = Struct::InertiaTensor.def(Family::SixAxis);
    assert_eq!(tensor.component("lyz"), tensor.component("Iyz"));
    let pose = Struct::Pose.def(Family::Scara);
    assert_eq!(pose.component("turn").map(|at| pose.components[at].start), Some(Start::Int(-1)));
}

#[test]
fn enumerations_know_their_constants() {
    for id in Enum::ALL {
        let def = id.def();
        assert_eq!(def.id, id);
        for (at, constant) in (0..).zip(def.constants) {
            assert_eq!(enum_constant(constant.name), Some((id, at)));
            assert_eq!(def.constant(&constant.name.to_ascii_uppercase()), Some(at));
            assert!(!constant.doc.is_empty(), "{}", constant.name);
        }
    }
}

#[test]
fn pages_show_what_the_tables_say() {
    let lin = reference::page("LIN").expect("lin has a page");
    assert!(lin.contains("lin p:, [ v: | vl: | vp: ], [ s: | sl: | sp: ], [ t: ], [ w: ], [ dura: ]"), "{lin}");
    assert!(lin.contains("mm/s") && lin.contains("Manual 3.2.3.") && lin.contains("lin p,vl:100mm/s"), "{lin}");
    let bitlcs = reference::page("bitlcs").expect("bitlcs has a page");
    assert!(
        bitlcs.contains("byte bitlcs(byte data, [int n = 1])") && bitlcs.contains("int bitlcs(int data"),
        "{bitlcs}"
    );
    let frexp = reference::page("frexp").expect("frexp has a page");
    assert!(frexp.contains("double frexp(double val, int &exp)"), "{frexp}");
    let speed = reference::page("$dfspeed").expect("$DFSPEED has a page");
    assert!(speed.contains("`{5,50,400,5,5}`") && speed.contains("at each program reset"), "{speed}");
    let joint = reference::page("joint").expect("joint has a page");
    assert!(joint.contains("SCARA robots:") && joint.contains("`j6`"), "{joint}");
    assert!(reference::page("S_type").is_some_and(|text| text.contains("`S_TYPE` | 1 |")));
    let profile = reference::page("$VEL_PROFILE").expect("$VEL_PROFILE has a page");
    assert!(profile.contains("(enumeration)") && profile.contains("(system variable)"), "{profile}");
    assert!(reference::page("endl").is_some_and(|text| text.contains("`\"\\n\"`")));
    assert_eq!(reference::page("no_such_thing"), None);
    for name in INDEX.split_whitespace() {
        assert!(reference::page(name).is_some(), "{name}");
    }
    for chapter in CHAPTERS {
        let text = reference::chapter(chapter);
        for entry in chapter.entries {
            assert!(
                text.contains(&reference::signature(entry, None)) && text.contains(entry.example),
                "{}",
                entry.name
            );
        }
    }
}

#[test]
fn what_one_family_has_may_be_missing_for_the_other() {
    for entry in all_entries() {
        for param in entry.params.iter().filter(|param| param.family.is_some()) {
            assert_ne!(param.presence, Presence::Required, "{}: {}", entry.name, param.name);
            let [six, scara] = [Family::SixAxis, Family::Scara].map(|family| reference::signature(entry, Some(family)));
            assert_ne!(six, scara, "{}", entry.name);
        }
    }
}

#[test]
fn every_example_is_read_without_a_mistake() {
    let entries = all_entries().iter().map(|entry| (entry.name, entry.example));
    for (name, example) in entries.chain(system_variables().map(|variable| (variable.name, variable.example))) {
        let mut names = crate::symbol::Interner::new();
        let read = crate::parse_statements(example, &mut names, crate::ParseOptions::default());
        assert!(read.errors.is_empty(), "{name}: {example}\n{:?}", read.errors);
    }
}

#[test]
fn every_type_declares_variables() {
    for (name, base) in type_names().filter(|(_, base)| *base != Base::Void) {
        let mark = if base.is_system() { "$" } else { "" };
        let mut names = crate::symbol::Interner::new();
        let text = format!("{mark}{name} first, second[2]");
        let read = crate::parse_statements(&text, &mut names, crate::ParseOptions::default());
        let declares = matches!(read.block.first().map(|stmt| &stmt.kind), Some(crate::ast::StmtKind::Decl(_)));
        assert!(declares && read.errors.is_empty(), "{text}: {:?}", read.errors);
    }
}

#[test]
fn defaults_of_system_variables_are_read_without_a_mistake() {
    for variable in system_variables() {
        let mut names = crate::symbol::Interner::new();
        let read = crate::parse_expression(variable.default, &mut names, crate::ParseOptions::default());
        assert!(read.errors.is_empty(), "${}: {}", variable.name, variable.default);
        let braces = matches!(read.expr.kind, crate::ast::ExprKind::Brace(_));
        let wanted = !variable.dims.is_empty() || matches!(variable.ty, Base::Struct(_));
        assert_eq!(braces, wanted, "${}: {}", variable.name, variable.default);
    }
}

#[test]
fn forms_and_effects_fit_each_other() {
    for entry in all_entries() {
        let name = entry.name;
        let repeats = entry.params.iter().any(|param| matches!(param.mode, Mode::Condition | Mode::Action));
        let has_form = matches!(entry.form, Form::WaitUntil | Form::Jump | Form::Event);
        assert_eq!(repeats, has_form, "{name}: a condition or an action needs a form of its own");
        let ends = matches!(entry.form, Form::Exit | Form::Restart);
        assert_eq!(ends, entry.effect == Effect::Ends, "{name}: only `exit` and `restart` end the program");
        assert_eq!(entry.motion.is_some(), entry.effect == Effect::Plans, "{name}: what plans is a motion");
        assert!(!(entry.connects || entry.uses_disk) || entry.effect == Effect::Waits, "{name}: it takes its time");
        let known = |ends: &str| all_entries().iter().any(|entry| entry.name == ends);
        assert!(entry.ended_by.is_none_or(known), "{name}: {:?} ends it, which is no instruction", entry.ended_by);
        let delays = entry.params.iter().any(|param| param.delays);
        assert!(!delays || entry.effect == Effect::Waits, "{name}: what delays waits");
    }
}

#[test]
fn motions_and_shifts_have_the_parameters_that_checks_read() {
    for entry in all_entries() {
        let target = match entry.motion {
            Some(Motion::Joint) => Some("j"),
            Some(_) => Some("p"),
            None => entry.shift.map(|_| "p"),
        };
        let by = if entry.shift.is_some() { &["dx", "dy", "dz", "rz", "ry", "rx"][..] } else { &[] };
        for label in target.iter().chain(by) {
            assert!(entry.params.iter().any(|param| param.name == *label), "{}: no parameter `{label}`", entry.name);
        }
    }
}

#[test]
fn what_is_related_has_something_addressed_before_it() {
    for entry in all_entries() {
        let mut spaces = Vec::new();
        for param in entry.params {
            let at = format!("{}, {}", entry.name, param.name);
            spaces.extend(param.addresses);
            if let Some(relation) = param.relation {
                assert!(!spaces.is_empty(), "{at}: it is related to nothing");
                let is_value = relation == Relation::Content;
                assert_eq!(is_value, spaces.last() == Some(&Space::AnalogOutput), "{at}: levels are content");
                assert!(relation != Relation::Extent(0), "{at}: none of it is one place");
            }
            let whole = param.ty == ParamType::One(Base::Int);
            assert!(whole || param.accepts.is_none(), "{at}: only whole numbers are accepted or not");
        }
        assert!(spaces.windows(2).all(|pair| pair[0] == pair[1]), "{}: it addresses two spaces", entry.name);
        assert!(spaces.len() < 3, "{}: a first and a last place at most", entry.name);
    }
}

#[test]
fn spellings_of_other_editions_are_aliases() {
    let of_entries = all_entries().iter().flat_map(|entry| entry.aliases.iter().copied());
    let of_params = all_entries().iter().flat_map(|entry| entry.params).flat_map(|param| param.aliases.iter().copied());
    let of_variables = system_variables().flat_map(|variable| variable.aliases.iter().copied());
    let aliases: HashSet<&str> = of_entries.chain(of_params).chain(of_variables).collect();
    let strangers: Vec<_> = OTHER_EDITIONS.iter().filter(|name| !aliases.contains(**name)).collect();
    assert!(strangers.is_empty(), "no entry has the alias {strangers:?}");
    assert!(is_of_other_edition("StartWeaveLin") && !is_of_other_edition("startweave"));
}
