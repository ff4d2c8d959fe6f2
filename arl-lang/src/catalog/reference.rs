//! Reference pages in Markdown, written from the tables.

use std::fmt::Write;

use super::entry::{
    Access, Constant, ConstantValue, Effect, Entry, Kind, Mode, Param, ParamType, Presence, Restore, SystemVariable,
    Takes,
};
use super::lookup::{self, Chapter};
use super::types::{Base, Component, Enum, Family, Handle, Start, Struct, StructDef};

/// Everything that has this name (with or without `$`, in any case): instructions, functions, types, system variables,
/// constants. `None` where nothing has it.
pub fn page(name: &str) -> Option<String> {
    let bare = name.trim_start_matches('$');
    let plain = bare == name;
    let mut parts = Vec::new();
    if plain {
        parts.extend([lookup::instructions(name), lookup::functions(name)].iter().filter_map(|group| entries(group)));
        parts.extend(lookup::constant(name).map(constant));
    }
    if let Some(base) = lookup::base_type(bare).filter(|base| plain || base.is_system()) {
        parts.extend(type_page(base));
    }
    let element = || lookup::system_element(bare).map(|(variable, _)| variable);
    parts.extend(lookup::system_variable(bare).or_else(element).map(system_variable));
    if plain {
        let found = lookup::enum_constant(name);
        parts.extend(
            found.filter(|(id, _)| lookup::base_type(name) != Some(Base::Enum(*id))).map(|(id, _)| enumeration(id)),
        );
    }
    (!parts.is_empty()).then(|| parts.join("\n"))
}

/// A chapter: its title and all its entries, overloads together.
pub fn chapter(chapter: &Chapter) -> String {
    let mut text = format!("## {}\n\n", chapter.title);
    let groups = chapter.entries.chunk_by(|a, b| a.kind == b.kind && a.name == b.name);
    let sections: Vec<String> = groups.filter_map(entries).collect();
    text.push_str(&sections.join("\n"));
    text
}

/// The overloads of one name under one heading; `None` for an empty slice.
pub fn entries(group: &[Entry]) -> Option<String> {
    let first = group.first()?;
    let kind = match first.kind {
        Kind::Function => "function",
        Kind::Instruction => "instruction",
    };
    let mut text = format!("### `{}` ({kind})\n", first.name);
    for one in group {
        text.push('\n');
        text.push_str(&entry(one));
    }
    Some(text)
}

/// One overload without a heading: signature, text, parameters, effect, example.
pub fn entry(entry: &Entry) -> String {
    let mut text = format!("```text\n{}\n```\n\n{}\n", signature(entry, None), entry.doc);
    if !entry.params.is_empty() {
        text.push_str("\n| parameter | type | unit | given | meaning |\n|---|---|---|---|---|\n");
        for param in entry.params {
            let units: Vec<&str> = param.units.iter().map(|unit| unit.text()).collect();
            row(
                &mut text,
                &[&format!("`{}`", param.name), &param_type(param), &units.join(", "), &presence(param), param.doc],
            );
        }
    }
    let mut notes = vec![effect(entry).to_string()];
    if entry.fails {
        notes.push("It can raise an alarm.".to_string());
    }
    if !entry.background {
        notes.push("It is not allowed in a background channel.".to_string());
    }
    notes.extend(entry.family.map(|family| format!("For {} only.", family_name(family))));
    if !entry.aliases.is_empty() {
        notes.push(format!("Also accepted: {}.", code_list(entry.aliases)));
    }
    notes.push(manual(entry.section));
    let _ = write!(text, "\n{}\n", notes.join(" "));
    example(&mut text, entry.example);
    text
}

/// The signature, with the parameters of one robot family or with all of them: a prototype for a function, the format
/// line for an instruction.
pub fn signature(entry: &Entry, family: Option<Family>) -> String {
    let params = || entry.params.iter().filter(|param| family.is_none_or(|family| param.is_of(family)));
    match entry.kind {
        Kind::Function => {
            let params: Vec<String> = params().map(prototype).collect();
            format!("{} {}({})", entry.result.name(), entry.name, params.join(", "))
        }
        Kind::Instruction => {
            let mut parts: Vec<String> = Vec::new();
            for param in params() {
                let rivals = entry.exclusive.iter().find(|group| group.contains(&param.name));
                match rivals {
                    Some(group) if group.first() != Some(&param.name) => {}
                    Some(group) => parts.push(format!("[ {}: ]", group.join(": | "))),
                    None => parts.push(label(param)),
                }
            }
            format!("{} {}", entry.name, parts.join(", ")).trim_end().to_string()
        }
    }
}

/// A parameter of an instruction or function: its type, how it is given, its meaning, its units and range.
pub fn parameter(entry: &Entry, param: &Param) -> String {
    let mut text =
        format!("`{}` of `{}`: {}; {}\n\n{}", param.name, entry.name, param_type(param), presence(param), param.doc);
    if !param.units.is_empty() {
        let units: Vec<&str> = param.units.iter().map(|unit| unit.text()).collect();
        let _ = write!(text, "\n\nUnits: {}.", code_list(&units));
    }
    if let Some(range) = param.range {
        let _ = write!(text, "\n\nRange: {range}.");
    }
    text
}

/// A parameter of a function as in its prototype: `double x`, in brackets where it may be missing.
pub fn prototype(param: &Param) -> String {
    let mark = if param.mode == Mode::Out { "&" } else { "" };
    let plain = format!("{} {mark}{}", type_name(param), param.name);
    match param.presence {
        Presence::Required => plain,
        Presence::Optional => format!("[{plain}]"),
        Presence::Default(text) => format!("[{plain} = {text}]"),
        Presence::Repeat { .. } => format!("{plain}..."),
    }
}

fn label(param: &Param) -> String {
    match param.presence {
        Presence::Required => format!("{}:", param.name),
        Presence::Optional | Presence::Default(_) => format!("[ {}: ]", param.name),
        Presence::Repeat { min: 0, .. } => format!("[ {}: ]...", param.name),
        Presence::Repeat { .. } => format!("{}:...", param.name),
    }
}

fn type_name(param: &Param) -> String {
    match param.ty {
        ParamType::One(base) => base.name().to_string(),
        ParamType::Array(base) => format!("{}[]", base.name()),
        ParamType::AnyOf(bases) => bases.iter().map(|base| base.name()).collect::<Vec<_>>().join("/"),
        ParamType::Any => "any".to_string(),
    }
}

fn param_type(param: &Param) -> String {
    let name = type_name(param);
    match param.mode {
        Mode::In => name,
        Mode::Out => format!("{name}, a variable that is written"),
        Mode::Condition => format!("{name}, evaluated again and again"),
        Mode::Action => "an expression, usually a call".to_string(),
    }
}

fn presence(param: &Param) -> String {
    let given = match param.presence {
        Presence::Required => "always".to_string(),
        Presence::Optional => "may be missing".to_string(),
        Presence::Default(text) => format!("`{text}` without it"),
        Presence::Repeat { min: 0, max: u8::MAX } => "any number".to_string(),
        Presence::Repeat { min, max: u8::MAX } => format!("{min} or more"),
        Presence::Repeat { min: 0, max } => format!("up to {max}"),
        Presence::Repeat { min, max } => format!("{min} to {max}"),
    };
    let given = if param.bare { given } else { format!("{given}; with its label") };
    match param.family {
        Some(family) => format!("{given}; {} only", family_name(family)),
        None => given,
    }
}

fn effect(entry: &Entry) -> &'static str {
    match entry.effect {
        Effect::Pure => "It only computes.",
        Effect::Acts => "It takes effect at once and does not wait for the robot.",
        Effect::Plans => "It plans motion ahead: the program goes on while the robot moves.",
        Effect::Lasts => "The program goes on when it is done; motion goes on meanwhile.",
        Effect::Waits => "It waits until all motion so far has ended: the robot stops at its last target.",
        Effect::Ends => "All motion so far runs to its end first.",
    }
}

fn type_page(base: Base) -> Option<String> {
    match base {
        Base::Struct(id) => Some(structure(id)),
        Base::Enum(id) => Some(enumeration(id)),
        Base::Handle(id) => Some(handle(id)),
        Base::Void | Base::Int | Base::Uint | Base::Byte | Base::Double | Base::Bool | Base::String => None,
    }
}

/// A structure: its components, with those of both robot families where they differ.
pub fn structure(id: Struct) -> String {
    let six = id.def(Family::SixAxis);
    let scara = id.def(Family::Scara);
    let mut text = format!("### `{}` (structure)\n\n{}\n", six.name, six.doc);
    if six.components == scara.components {
        components(&mut text, six);
    } else {
        text.push_str("\nSix-axis robots:\n");
        components(&mut text, six);
        text.push_str("\nSCARA robots:\n");
        components(&mut text, scara);
    }
    let mut notes = vec![manual(six.section)];
    notes.extend(six.family.map(|family| format!("For {} only.", family_name(family))));
    if !six.aliases.is_empty() {
        notes.push(format!("Also accepted: {}.", code_list(six.aliases)));
    }
    let _ = write!(text, "\n{}\n", notes.join(" "));
    text
}

fn components(text: &mut String, def: &StructDef) {
    text.push_str("\n| component | type | start value | meaning |\n|---|---|---|---|\n");
    for component in def.components {
        row(text, &[&format!("`{}`", component.name), component.ty.name(), &start(component), component.doc]);
    }
}

fn start(component: &Component) -> String {
    match (component.start, component.ty) {
        (Start::Unset, _) => "9e+09 (not set)".to_string(),
        (Start::Int(value), _) => value.to_string(),
        (Start::Zero, Base::Bool) => "false".to_string(),
        (Start::Zero, Base::String) => "\"\"".to_string(),
        (Start::Zero, Base::Enum(id)) => id.def().constants.first().map_or("", |constant| constant.name).to_string(),
        (Start::Zero, Base::Struct(_)) => "its own".to_string(),
        (Start::Zero, _) => "0".to_string(),
    }
}

/// An enumeration with its constants.
pub fn enumeration(id: Enum) -> String {
    let def = id.def();
    let mut text = format!("### `{}` (enumeration)\n\n{}\n\n", def.name, def.doc);
    text.push_str("| constant | number | meaning |\n|---|---|---|\n");
    for (number, constant) in def.constants.iter().enumerate() {
        let other = if constant.aliases.is_empty() {
            String::new()
        } else {
            format!(" (also {})", code_list(constant.aliases))
        };
        row(&mut text, &[&format!("`{}`{other}", constant.name), &number.to_string(), constant.doc]);
    }
    let mut notes = vec![manual(def.section)];
    if !def.aliases.is_empty() {
        notes.push(format!("Also accepted: {}.", code_list(def.aliases)));
    }
    let _ = write!(text, "\n{}\n", notes.join(" "));
    text
}

/// A handle type.
pub fn handle(id: Handle) -> String {
    let def = id.def();
    let mut text = format!("### `{}` (handle)\n\n{}\n\n{}", def.name, def.doc, manual(def.section));
    if !def.aliases.is_empty() {
        let _ = write!(text, " Also accepted: {}.", code_list(def.aliases));
    }
    text.push('\n');
    text
}

/// A system variable.
pub fn system_variable(variable: &SystemVariable) -> String {
    let mut ty = variable.ty.name().to_string();
    for size in variable.dims {
        let _ = write!(ty, "[{size}]");
    }
    let mut text = format!("### `${}` (system variable)\n\n{}\n\n", variable.name, variable.doc);
    text.push_str("| type | default | takes | access | goes back to its default |\n|---|---|---|---|---|\n");
    let access = match variable.access {
        Access::ReadWrite => "programs may write it",
        Access::ReadOnly => "read only",
    };
    let restore = match variable.restore {
        Restore::Reset => "at start-up and at each program reset",
        Restore::Saved => "at start-up, to what savesv saved last",
        Restore::Permanent => "never",
        Restore::Startup => "at start-up",
    };
    row(&mut text, &[&ty, &format!("`{}`", variable.default), &taken(variable.takes), access, restore]);
    let mut notes = vec![manual(variable.section)];
    if !variable.aliases.is_empty() {
        let names: Vec<String> = variable.aliases.iter().map(|alias| format!("`${alias}`")).collect();
        notes.push(format!("Also accepted: {}.", names.join(", ")));
    }
    let _ = write!(text, "\n{}\n", notes.join(" "));
    example(&mut text, variable.example);
    text
}

/// What a system variable accepts; empty where it accepts every value.
fn taken(takes: Takes) -> String {
    match takes {
        Takes::All => String::new(),
        Takes::Range(low, high) => format!("{low} to {high}"),
        Takes::Words(words) => words.iter().map(|word| format!("`\"{word}\"`")).collect::<Vec<_>>().join(" or "),
    }
}

/// A constant with a plain name.
pub fn constant(constant: &Constant) -> String {
    let value = match constant.value {
        ConstantValue::Double(number) => number.to_string(),
        ConstantValue::String(text) => format!("\"{}\"", text.escape_default()),
    };
    format!(
        "### `{}` (constant)\n\n{} Its value is `{value}`. {}\n",
        constant.name,
        constant.doc,
        manual(constant.section)
    )
}

fn family_name(family: Family) -> &'static str {
    match family {
        Family::SixAxis => "six-axis robots",
        Family::Scara => "SCARA robots",
    }
}

fn manual(section: &str) -> String {
    format!("Manual {section}.")
}

fn code_list(names: &[&str]) -> String {
    let quoted: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
    quoted.join(", ")
}

fn row(text: &mut String, cells: &[&str]) {
    for cell in cells {
        let _ = write!(text, "| {} ", cell.replace('|', "\\|"));
    }
    text.push_str("|\n");
}

fn example(text: &mut String, code: &str) {
    let _ = write!(text, "\n```arl\n{code}\n```\n");
}
