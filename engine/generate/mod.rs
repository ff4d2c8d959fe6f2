//! What brings arguments to the functions of the runtime, written from the catalog.

use arl_lang::catalog::{
    Access, Base, Effect, Entry, Family, Form, Kind, Mode, Param, ParamType, Presence, Struct, Takes, all_entries,
    system_variables,
};
use std::fmt::Write;

/// The head of a generated file.
const HEAD: &str = "// Written from the catalog: `cargo run -p arl-engine --example renew_adapters`.\n";

/// The Rust type of a value; that of six-axis robots where the families differ.
fn rust_type(base: Base) -> &'static str {
    match base {
        Base::Void => "()",
        Base::Int => "i32",
        Base::Uint => "u32",
        Base::Byte => "u8",
        Base::Double => "f64",
        Base::Bool => "bool",
        Base::String => "Str",
        Base::Struct(id) => id.def(Family::SixAxis).rust,
        Base::Enum(id) => id.def().rust,
        Base::Handle(id) => id.def().rust,
    }
}

/// A base type as a pattern.
fn pattern(base: Base) -> String {
    match base {
        Base::Struct(id) => format!("Base::Struct(Struct::{id:?})"),
        Base::Enum(id) => format!("Base::Enum(Enum::{id:?})"),
        other => format!("Base::{other:?}"),
    }
}

fn method(name: &str) -> String {
    match name {
        "type" | "do" | "for" | "in" => format!("r#{name}"),
        name => name.to_owned(),
    }
}

/// The types that a parameter takes, `any` aside.
fn bases(ty: ParamType) -> Vec<Base> {
    match ty {
        ParamType::One(base) | ParamType::Array(base) => vec![base],
        ParamType::AnyOf(bases) => bases.to_vec(),
        ParamType::Any => Vec::new(),
    }
}

/// Whether the runtime takes the value by reference.
fn is_referred(base: Base) -> bool {
    matches!(base, Base::String | Base::Handle(_) | Base::Struct(Struct::Wobj))
}

/// The expression for the value of the argument at `at`.
fn read(param: &Param, base: Base, at: &str) -> String {
    match (param.ty, base) {
        (ParamType::Any, _) => format!("&args.printed({at})"),
        (ParamType::Array(_), base) => format!("&args.array::<{}>({at})?", rust_type(base)),
        (_, Base::String) => format!("&*args.text({at})?"),
        (_, Base::Handle(id)) => format!("args.handle({at})?.{}()?", handle_method(id.def().rust)),
        (_, base) if is_referred(base) => format!("&args.get::<{}>({at})?", rust_type(base)),
        (_, base) => format!("args.get::<{}>({at})?", rust_type(base)),
    }
}

fn handle_method(rust: &str) -> &'static str {
    match rust {
        "Clock" => "clock",
        "Socket" => "socket",
        "Iodev" => "iodev",
        "ModbusDev" => "modbus_dev",
        _ => "melsec_dev",
    }
}

/// One adapter.
struct Adapter<'e> {
    entry: &'e Entry,
    /// The types of the required parameters that take several, in this variant.
    chosen: Vec<(usize, Base)>,
}

impl Adapter<'_> {
    fn base_of(&self, at: usize, param: &Param) -> Base {
        let chosen = self.chosen.iter().find(|(chosen, _)| *chosen == at).map(|(_, base)| *base);
        chosen.or_else(|| bases(param.ty).first().copied()).unwrap_or(Base::Void)
    }

    /// The statements that bring the arguments and call the function; the value of the last one is its result.
    fn body(&self) -> String {
        let (mut out, back) = self.prepared();
        let entry = self.entry;
        if entry.kind == Kind::Instruction {
            let wait = if entry.effect.takes_time() { ".await" } else { "" };
            let ask = if entry.fails { "?" } else { "" };
            let cx = if entry.effect == Effect::Pure { "" } else { "cx" };
            let _ = writeln!(out, "    let done = call.run({cx}){wait}{ask};");
        }
        out.push_str(&self.written_back(&back));
        out
    }

    /// The statements that bring the arguments; a function is called, an instruction is ready to run. Also what is
    /// written back afterwards.
    fn prepared(&self) -> (String, String) {
        let entry = self.entry;
        let mut out = String::new();
        let mut back = String::new();
        let mut values = Vec::new();
        for (at, param) in entry.params.iter().enumerate() {
            let is_given = entry.kind == Kind::Function || param.presence == Presence::Required;
            if !is_given || matches!(param.mode, Mode::Condition | Mode::Action) {
                continue;
            }
            values.push(self.argument(at, param, &mut out, &mut back));
        }
        let wait = if entry.effect.takes_time() { ".await" } else { "" };
        let ask = if entry.fails { "?" } else { "" };
        let cx = if entry.effect == Effect::Pure { "" } else { "cx" };
        let values = values.join(", ");
        match entry.kind {
            Kind::Function => {
                let comma = if cx.is_empty() || values.is_empty() { "" } else { ", " };
                let _ = writeln!(out, "    let done = {}({cx}{comma}{values}){wait}{ask};", entry.path);
            }
            Kind::Instruction => {
                let _ = writeln!(out, "    let call = {}({values});", entry.path);
                self.labels(&mut out);
            }
        }
        (out, back)
    }

    /// The statement that brings an argument, and the expression that hands it over.
    fn argument(&self, at: usize, param: &Param, out: &mut String, back: &mut String) -> String {
        let base = self.base_of(at, param);
        if param.mode == Mode::Out {
            let (get, put) = written(param, base);
            let _ = writeln!(out, "    let n{at} = args.at({at})?;\n    let mut v{at} = {get}(n{at})?;");
            let _ = writeln!(back, "    {put}(n{at}, &v{at})?;");
            return format!("&mut v{at}");
        }
        if param.presence == Presence::Optional {
            let value = read(param, base, &format!("n{at}"));
            let value = if is_referred(base) { value.trim_start_matches(['&', '*']) } else { &value };
            let taken = match base {
                Base::Struct(Struct::Wobj) => ".as_ref()",
                base if is_referred(base) => ".as_deref()",
                _ => "",
            };
            let some = format!("Some(n{at}) => Some({value})");
            let _ = writeln!(out, "    let v{at} = match args.find({at}) {{ {some}, None => None }};");
            return format!("v{at}{taken}");
        }
        if let Base::Handle(id) = base
            && param.ty != ParamType::Any
        {
            let _ = writeln!(out, "    let h{at} = args.handle(args.at({at})?)?;");
            return format!("h{at}.{}()?", handle_method(id.def().rust));
        }
        let value = read(param, base, &format!("args.at({at})?"));
        let bare = value.trim_start_matches(['&', '*']);
        let reference = &value[..value.len() - bare.len()];
        // What the call writes may be what it reads.
        let is_owned = base == Base::String && self.writes_in_turn();
        let (owned, reference) = if is_owned { (".into_owned()", "&") } else { ("", reference) };
        let _ = writeln!(out, "    let v{at} = {bare}{owned};");
        format!("{reference}v{at}")
    }

    /// The labels of an instruction, in the order of the program.
    fn labels(&self, out: &mut String) {
        let labels = || {
            let params = self.entry.params.iter().enumerate();
            params.filter(|(_, param)| {
                param.presence != Presence::Required && !matches!(param.mode, Mode::Condition | Mode::Action)
            })
        };
        if labels().next().is_none() {
            return;
        }
        // A variable that the whole instruction writes: it is borrowed until the instruction runs.
        for (at, param) in labels().filter(|(_, param)| self.is_kept(param)) {
            let base = self.base_of(at, param);
            let (get, _) = written(param, base);
            let _ = writeln!(
                out,
                "    let n{at} = args.find({at});\n    let mut v{at} = match n{at} {{ Some(n) => {get}(n)?, None => Default::default() }};\n    let mut r{at} = Some(&mut v{at});"
            );
        }
        let _ =
            writeln!(out, "    let mut call = call;\n    for n in 0..args.count() {{\n        match args.param(n) {{");
        for (at, param) in labels() {
            let label = method(param.rust);
            let all = bases(param.ty);
            let _ = match (param.mode, all.as_slice()) {
                _ if self.is_kept(param) => {
                    writeln!(out, "            {at} => if let Some(v) = r{at}.take() {{ call = call.{label}(v) }},")
                }
                (Mode::Out, all) => {
                    let mut arms = String::new();
                    for base in all {
                        let ty = rust_type(*base);
                        let _ = write!(
                            arms,
                            "{} => {{ let mut v = args.get::<{ty}>(n)?; call = call.{label}(&mut v); args.put(n, &v)?; }} ",
                            pattern(*base)
                        );
                    }
                    writeln!(out, "            {at} => match args.base(n)? {{ {arms} _ => return Err(damaged()) }},")
                }
                (_, all) if all.len() > 1 => {
                    let mut arms = String::new();
                    for base in all {
                        let _ = write!(arms, "{} => call.{label}({}), ", pattern(*base), read(param, *base, "n"));
                    }
                    writeln!(
                        out,
                        "            {at} => call = match args.base(n)? {{ {arms} _ => return Err(damaged()) }},"
                    )
                }
                (_, all) => {
                    let base = all.first().copied().unwrap_or(Base::Void);
                    writeln!(out, "            {at} => call = call.{label}({}),", read(param, base, "n"))
                }
            };
        }
        let _ = writeln!(out, "            _ => {{}}\n        }}\n    }}");
    }

    /// Whether the instruction writes several variables, one after the other.
    fn writes_in_turn(&self) -> bool {
        self.entry
            .params
            .iter()
            .any(|param| param.mode == Mode::Out && matches!(param.presence, Presence::Repeat { .. }))
    }

    /// Whether the instruction keeps a reference to the variable until it runs.
    fn is_kept(&self, param: &Param) -> bool {
        param.mode == Mode::Out && param.presence == Presence::Optional
    }

    fn written_back(&self, back: &str) -> String {
        let mut out = back.to_owned();
        for (at, param) in self.entry.params.iter().enumerate() {
            if self.entry.kind == Kind::Instruction && self.is_kept(param) {
                let (_, put) = written(param, self.base_of(at, param));
                let _ = writeln!(out, "    if let Some(n) = n{at} {{ {put}(n, &v{at})?; }}");
            }
        }
        let _ = match self.entry.result {
            Base::Void => writeln!(out, "    let () = done;\n    Ok(())"),
            _ => writeln!(out, "    args.result(&done)"),
        };
        out
    }
}

/// How a written variable is read before, and written after a call.
fn written(param: &Param, base: Base) -> (String, &'static str) {
    let ty = rust_type(base);
    match param.ty {
        ParamType::Array(_) => (format!("args.array::<{ty}>"), "args.put_array"),
        _ => (format!("args.get::<{ty}>"), "args.put"),
    }
}

/// Whether the engine itself does what the entry says.
fn is_own(entry: &Entry) -> bool {
    matches!(entry.form, Form::WaitUntil | Form::Exit | Form::Restart | Form::Event)
}

/// `src/adapters.rs`
pub(crate) fn adapters() -> String {
    let mut functions = String::new();
    let mut now = String::new();
    let mut later: Vec<usize> = Vec::new();
    for (number, entry) in all_entries().iter().enumerate().filter(|(_, entry)| !is_own(entry)) {
        let takes_time = entry.effect.takes_time();
        let asynchronous = if takes_time { "async " } else { "" };
        let cx = if entry.effect == Effect::Pure { "_cx" } else { "cx" };
        // A required parameter of several types: a variant for each.
        let several = entry.params.iter().position(|param| {
            let is_given = entry.kind == Kind::Function || param.presence == Presence::Required;
            is_given && bases(param.ty).len() > 1
        });
        let _ = writeln!(functions, "/// `{}`", entry.name);
        let body = match several {
            None => Adapter { entry, chosen: Vec::new() }.body(),
            Some(at) => {
                let mut arms = String::new();
                for base in bases(entry.params[at].ty) {
                    let body = Adapter { entry, chosen: vec![(at, base)] }.body();
                    let _ = writeln!(arms, "        {} => {{\n{body}        }}", pattern(base));
                }
                format!("    match args.base(args.at({at})?)? {{\n{arms}        _ => Err(damaged()),\n    }}\n")
            }
        };
        let args = if body.contains("args") { "args" } else { "_args" };
        let _ = writeln!(
            functions,
            "{asynchronous}fn entry_{number}({cx}: &Cx, {args}: &mut Args<'_>) -> Result<(), Fault> {{\n{body}}}\n"
        );
        if takes_time {
            later.push(number);
        } else {
            let _ = writeln!(now, "        Target::Entry({number}) => entry_{number}(cx, args),");
        }
    }
    let (mut groups, mut choice) = (String::new(), String::new());
    for (at, group) in later.chunks(GROUP).enumerate() {
        let numbers: Vec<String> = group.iter().map(usize::to_string).collect();
        let _ = writeln!(choice, "        {} => group_{at}(number, cx, args).await,", numbers.join(" | "));
        let arms: String = group.iter().fold(String::new(), |mut arms, number| {
            let _ = writeln!(arms, "        {number} => entry_{number}(cx, args).await,");
            arms
        });
        let _ = writeln!(
            groups,
            "async fn group_{at}(number: u16, cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {{\n    match number {{\n{arms}        \
             _ => Err(damaged()),\n    }}\n}}\n"
        );
    }
    let jump = all_entries().iter().find(|entry| entry.form == Form::Jump);
    let jump = jump.map_or_else(String::new, |entry| Adapter { entry, chosen: Vec::new() }.prepared().0);
    let jump = JUMP.replace("    JUMP_BODY", &format!("{jump}    Ok(call)"));
    format!(
        "{HEAD}//! Brings the arguments of built-ins to the functions of the runtime.\n\n\
         use crate::args::Args;\nuse crate::handles::damaged;\nuse arl_code::{{StructureOperator, Target}};\n\
         use arl_lang::catalog::{{Base, Enum}};\nuse arl_rt::emit::*;\n\n\
         /// Calls a built-in that takes no time.\n///\n/// # Errors\n/// The fault of the built-in.\n\
         pub(crate) fn call_now(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {{\n    match args.site.target {{\n{now}        \
         Target::Entry(_) => Err(damaged()),\n        Target::Operator(operator) => operate(operator, args),\n    }}\n}}\n\n\
         /// Calls a built-in that may take longer than its cycle.\n///\n/// # Errors\n/// The fault of the built-in.\n\
         pub(crate) async fn call(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {{\n    \
         let Target::Entry(number) = args.site.target else {{ return Err(damaged()) }};\n    match number {{\n{choice}        \
         _ => Err(damaged()),\n    }}\n}}\n\n{groups}{OPERATORS}\n{jump}\n{functions}"
    )
}

/// How many built-ins that wait share a function: rustc's time grows with the square of the waits in one.
const GROUP: usize = 8;

const OPERATORS: &str = "/// An operator on structures.
fn operate(operator: StructureOperator, args: &mut Args<'_>) -> Result<(), Fault> {
    match operator {
        StructureOperator::AddJoints => {
            let value = args.get::<Joint>(0)? + args.get::<Joint>(1)?;
            args.result(&value)
        }
        StructureOperator::SubtractJoints => {
            let value = args.get::<Joint>(0)? - args.get::<Joint>(1)?;
            args.result(&value)
        }
        StructureOperator::NegateJoint => {
            let value = -args.get::<Joint>(0)?;
            args.result(&value)
        }
        StructureOperator::FrameByFrame => {
            let value = args.get::<Frame>(0)? * args.get::<Frame>(1)?;
            args.result(&value)
        }
        StructureOperator::FrameByPose => {
            let value = args.get::<Frame>(0)? * args.get::<Pose>(1)?;
            args.result(&value)
        }
        StructureOperator::PoseByFrame => {
            let value = args.get::<Pose>(0)? * args.get::<Frame>(1)?;
            args.result(&value)
        }
        StructureOperator::PoseByPose => {
            let value = args.get::<Pose>(0)? * args.get::<Pose>(1)?;
            args.result(&value)
        }
    }
}
";

const JUMP: &str = "/// A `jump` that is to stop above its target.
///
/// # Errors
/// The code is damaged.
pub(crate) fn jump(args: &mut Args<'_>) -> Result<motion::Jump, Fault> {
    JUMP_BODY
}
";

/// `src/system.rs`
pub(crate) fn system() -> String {
    let (mut get, mut set) = (String::new(), String::new());
    for (number, variable) in system_variables().enumerate() {
        let field = method(variable.field);
        let ty = rust_type(variable.ty);
        let is_array = !variable.dims.is_empty();
        let value = if is_array { format!("system.{field}.item(element)") } else { format!("system.{field}.get()") };
        let _ = writeln!(get, "        {number} => {value}.store(to),");
        if variable.access == Access::ReadOnly {
            continue;
        }
        let value = format!("{ty}::load(from)");
        let is_number = matches!(variable.ty, Base::Int | Base::Uint | Base::Byte | Base::Double);
        let value = match variable.takes {
            Takes::Range(low, high) if is_number => format!("in_range({value}, {low:?}, {high:?})?"),
            Takes::Words(words) if variable.ty == Base::String => format!("one_of({value}, &{words:?})?"),
            _ => value,
        };
        let _ = match is_array {
            true => writeln!(set, "        {number} => system.{field}.set_item(element, {value}),"),
            false => writeln!(set, "        {number} => system.{field}.set({value}),"),
        };
    }
    format!(
        "{HEAD}//! Reads and writes system variables.\n\nuse crate::handles::damaged;\nuse crate::values::{{Source, Target, Value}};\n\
         use arl_rt::emit::*;\n\n/// Reads a system variable, or an element of one.\n///\n/// # Errors\n/// It does not exist: the code is damaged.\n\
         pub(crate) fn get(cx: &Cx, number: u16, element: usize, to: &mut Target) -> Result<(), Fault> {{\n    let system = cx.system();\n    \
         match number {{\n{get}        _ => return Err(damaged()),\n    }}\n    Ok(())\n}}\n\n\
         /// Writes a system variable, or an element of one.\n///\n/// # Errors\n/// It does not take the value.\n\
         pub(crate) fn set(cx: &Cx, number: u16, element: usize, from: &mut Source<'_>) -> Result<(), Fault> {{\n    let system = cx.system();\n    \
         match number {{\n{set}        _ => return Err(damaged()),\n    }}\n    Ok(())\n}}\n"
    )
}
