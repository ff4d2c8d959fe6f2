//! Compiles every conformance case that runs, and writes them down for the macro.

use arl_lang::catalog::Family;
use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::{Path, PathBuf};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let out = PathBuf::from(std::env::var_os("OUT_DIR").ok_or("OUT_DIR is not set")?);
    let corpus = std::path::absolute("../conformance")?;
    println!("cargo::rerun-if-changed={}", corpus.display());
    let mut cases = Vec::new();
    find(&corpus, &mut cases)?;
    cases.sort();

    let mut builds: BTreeMap<bool, arl2rs::Build> = BTreeMap::new();
    let mut built = String::from("// The cases through the build script.\n");
    let mut expanded = String::from("// The cases through the macro.\n");
    let mut tables = (String::new(), String::new());
    for (number, source) in cases.iter().enumerate() {
        let name = format!("case_{number}");
        let scara = family(source)? == Family::Scara;
        let build = builds.entry(scara).or_default();
        *build = std::mem::take(build).program_as(&name, source);
        writeln!(built, "mod {name} {{ arl_rt::include_arl!(\"{name}\"); }}")?;
        writeln!(tables.0, "    (|| Box::new({name}::Globals::new()), {source:?}, 0),")?;

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
        writeln!(tables.1, "    (|| Box::new({name}::Globals::new()), {source:?}, {offset}),")?;
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

/// The family of the robot that NAME.toml names.
fn family(source: &Path) -> Result<Family, Box<dyn std::error::Error>> {
    let Ok(options) = std::fs::read_to_string(source.with_extension("toml")) else { return Ok(Family::SixAxis) };
    let options: toml::Table = toml::from_str(&options)?;
    let robot = options.get("robot").and_then(toml::Value::as_str).unwrap_or_default();
    let built_in = std::fs::read_to_string(format!("../../arl-robot/src/robot/files/{robot}.toml"));
    let text = built_in.or_else(|_| std::fs::read_to_string(source.with_file_name(robot))).unwrap_or_default();
    Ok(if text.contains("family = \"scara\"") { Family::Scara } else { Family::SixAxis })
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
