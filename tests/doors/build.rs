//! Compiles every conformance case that runs, and writes them down for the macro.

use arl_lang::catalog::Family;
use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::{Path, PathBuf};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let out = PathBuf::from(std::env::var_os("OUT_DIR").ok_or("OUT_DIR is not set")?);
    let corpus = std::path::absolute("../conformance")?;
    println!("cargo::rerun-if-changed={}", corpus.display());
    if !corpus.is_dir() {
        // In a package of its own; its tests do not compile then.
        for name in ["built.rs", "expanded.rs"] {
            std::fs::write(out.join(name), "compile_error!(\"there is no `conformance` beside this package\");\n")?;
        }
        return Ok(());
    }
    let mut cases = Vec::new();
    find(&corpus, &mut cases)?;
    cases.sort();

    let mut builds: BTreeMap<bool, arl2rs::Build> = BTreeMap::new();
    let mut built = String::from("// The cases through the build script.\nuse arl_rt::program::Other;\n");
    let mut expanded = String::from("// The cases through the macro.\nuse arl_rt::program::Other;\n");
    let mut tables = (String::new(), String::new());
    for (number, source) in cases.iter().enumerate() {
        let name = format!("case_{number}");
        let options = options(source)?;
        let scara = is_scara(source, text(&options, "robot"));
        let mut others = (String::new(), String::new());
        for (at, other) in others_of(source, text(&options, "cell"))?.into_iter().enumerate() {
            let module = format!("{name}_beside_{at}");
            let robot = if other.scara { "scara" } else { "six_axis" };
            let build = builds.entry(other.scara).or_default();
            *build = std::mem::take(build).program_as(&module, &other.path);
            writeln!(built, "mod {module} {{ arl_rt::include_arl!(\"{module}\"); }}")?;
            writeln!(expanded, "mod {module} {{ arl_rt::arl_file!({:?}, {robot}); }}", other.path)?;
            let make = format!("&|| Box::new({module}::Globals::new())");
            let entry = format!("Other {{ file: {:?}, folder: \"\", make: {make} }},", other.file);
            others.0 += &entry;
            others.1 += &entry;
        }
        let build = builds.entry(scara).or_default();
        *build = std::mem::take(build).program_as(&name, source);
        writeln!(built, "mod {name} {{ arl_rt::include_arl!(\"{name}\"); }}")?;
        writeln!(tables.0, "    (&|| Box::new({name}::Globals::new()), {source:?}, 0, &[{}]),", others.0)?;

        let text = std::fs::read(source)?;
        let robot = if scara { "scara" } else { "six_axis" };
        let offset = match std::str::from_utf8(&text).ok().filter(|text| fits_rust(source, text)) {
            Some(text) => {
                writeln!(expanded, "mod {name} {{ arl_rt::arl! {{ #![{robot}]")?;
                let offset = expanded.lines().count();
                writeln!(expanded, "{text}\n}} }}")?;
                offset
            }
            None => {
                writeln!(expanded, "mod {name} {{ arl_rt::arl_file!({source:?}, {robot}); }}")?;
                0
            }
        };
        writeln!(tables.1, "    (&|| Box::new({name}::Globals::new()), {source:?}, {offset}, &[{}]),", others.1)?;
    }
    for (scara, build) in builds {
        build.family(if scara { Family::Scara } else { Family::SixAxis }).warnings(false).compile();
    }
    std::fs::write(out.join("built.rs"), format!("{built}\nconst CASES: &[door_tests::Entry] = &[\n{}];\n", tables.0))?;
    std::fs::write(
        out.join("expanded.rs"),
        format!("{expanded}\nconst CASES: &[door_tests::Entry] = &[\n{}];\n", tables.1),
    )?;
    Ok(())
}

/// The programs that run: those with `.out` or `.alarm`.
fn find(folder: &Path, cases: &mut Vec<PathBuf>) -> std::io::Result<()> {
    for entry in std::fs::read_dir(folder)? {
        let path = entry?.path();
        if path.is_dir() {
            find(&path, cases)?;
        } else if path.extension().is_some_and(|ending| ending == "arl")
            && (path.with_extension("out").is_file() || path.with_extension("alarm").is_file())
        {
            cases.push(path);
        }
    }
    Ok(())
}

/// NAME.toml
fn options(source: &Path) -> Result<toml::Table, Box<dyn std::error::Error>> {
    Ok(toml::from_str(&std::fs::read_to_string(source.with_extension("toml")).unwrap_or_default())?)
}

fn text<'a>(table: &'a toml::Table, key: &str) -> Option<&'a str> {
    table.get(key).and_then(toml::Value::as_str)
}

/// Whether a robot, built in or beside the case, is a SCARA.
fn is_scara(source: &Path, robot: Option<&str>) -> bool {
    let robot = robot.unwrap_or_default();
    let built_in = std::fs::read_to_string(format!("../../arl-robot/src/robot/files/{robot}.toml"));
    let text = built_in.or_else(|_| std::fs::read_to_string(source.with_file_name(robot))).unwrap_or_default();
    text.contains("family = \"scara\"")
}

/// A program beside the first one.
struct Beside {
    file: String,
    path: PathBuf,
    scara: bool,
}

/// The programs that the cell of a case names.
fn others_of(source: &Path, cell: Option<&str>) -> Result<Vec<Beside>, Box<dyn std::error::Error>> {
    let Some(cell) = cell else { return Ok(Vec::new()) };
    let cell: toml::Table = toml::from_str(&std::fs::read_to_string(source.with_file_name(cell))?)?;
    let own = options(source)?;
    let mut all: Vec<Beside> = Vec::new();
    let mut add = |file: &str, robot: Option<&str>| {
        if !all.iter().any(|known| known.file == file) {
            let path = source.with_file_name(file);
            all.push(Beside { file: file.into(), path, scara: is_scara(source, robot) });
        }
    };
    let load = |table: &toml::Table| match table.get("load").and_then(toml::Value::as_array) {
        Some(files) => files.iter().filter_map(|file| Some(file.as_str()?.to_owned())).collect(),
        None => Vec::new(),
    };
    load(&cell).iter().for_each(|file| add(file, text(&own, "robot")));
    let channels = cell.get("channel").and_then(toml::Value::as_array).into_iter().flatten();
    for channel in channels.filter_map(toml::Value::as_table) {
        let robot = text(channel, "robot");
        add(text(channel, "program").unwrap_or_default(), robot);
        load(channel).iter().for_each(|file| add(file, robot));
    }
    Ok(all)
}

/// Whether the text can stand in a Rust file, and needs no file beside it.
fn fits_rust(source: &Path, text: &str) -> bool {
    let data = source.with_file_name(format!("{}_data.arl", source.file_stem().unwrap_or_default().to_string_lossy()));
    let alone = !data.is_file() && !text.contains("import") && !text.contains("::");
    alone && !text.contains('\r') && !glued(text) && text.parse::<proc_macro2::TokenStream>().is_ok()
}

/// Whether a word touches a string, a number ends in a letter that Rust reads otherwise, or the like.
fn glued(text: &str) -> bool {
    let bytes = text.as_bytes();
    let word = |byte: &u8| byte.is_ascii_alphanumeric() || *byte == b'_';
    let quoted =
        bytes.windows(2).any(|pair| pair.first().is_some_and(word) && matches!(pair.get(1), Some(b'"' | b'\'' | b'#')));
    let number = |token: &str| {
        let lower = token.to_ascii_lowercase();
        token.starts_with(|c: char| c.is_ascii_digit())
            && (lower.starts_with("0b") || lower.starts_with("0x") || lower.starts_with("0o") || lower.contains('e'))
    };
    quoted || text.contains('\\') || text.split(|c: char| !c.is_ascii_alphanumeric() && c != '_').any(number)
}
