//! Finds the sources of the runtime: they lie beside this package, unless it came from the registry.

use std::error::Error;
use std::fmt::Write;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::{Path, PathBuf};

/// What programs are compiled with.
const PACKAGES: [&str; 6] = ["arl-lang", "arl-robot", "arl-motion", "arl-rt", "drivers", "library"];

/// Set, a build that is not optimised carries the sources, too: for a test of what is installed.
const CARRIES: &str = "ARL2RS_CARRIES_SOURCES";

fn main() -> Result<(), Box<dyn Error>> {
    println!("cargo::rerun-if-env-changed={CARRIES}");
    let checkout = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap_or(Path::new(""));
    let carries = std::env::var("PROFILE")? == "release" || std::env::var_os(CARRIES).is_some();
    let origin = if !PACKAGES.iter().all(|package| checkout.join(package).join("Cargo.toml").is_file()) {
        "Origin::Registry".into()
    } else if carries {
        carried(checkout)?
    } else {
        println!("cargo::rerun-if-changed=build.rs");
        format!("Origin::Checkout({:?})", checkout.display().to_string())
    };
    std::fs::write(Path::new(&std::env::var("OUT_DIR")?).join("origin.rs"), origin)?;
    Ok(())
}

/// The expression of an `Origin` with all files.
fn carried(checkout: &Path) -> Result<String, Box<dyn Error>> {
    let mut hasher = DefaultHasher::new();
    let mut files = String::new();
    let mut add = |name: &str, text: &str, expression: String| {
        (name, text).hash(&mut hasher);
        writeln!(files, "({name:?}, {expression}),")
    };
    let mut add_text = |name: &str, text: String| add(name, &text, format!("{text:?}"));
    add_text("Cargo.toml", workspace(&read(&checkout.join("Cargo.toml"))?)?)?;
    add_text("Cargo.lock", read(&checkout.join("Cargo.lock"))?)?;
    for package in PACKAGES {
        let manifest = manifest(&read(&checkout.join(package).join("Cargo.toml"))?)?;
        add_text(&format!("{package}/Cargo.toml"), manifest)?;
    }
    for package in PACKAGES {
        for path in sources(&checkout.join(package).join("src"))? {
            let below = path.strip_prefix(checkout)?.components();
            let name: Vec<_> = below.map(|part| part.as_os_str().to_string_lossy()).collect();
            let from = format!("include_str!({:?})", path.display().to_string());
            add(&name.join("/"), &read(&path)?, from)?;
        }
    }
    let state = hasher.finish();
    Ok(format!("Origin::Carried(&Carried {{ state: \"{state:016x}\", files: &[\n{files}] }})"))
}

/// Reads a file, and asks for this script again when it changes.
fn read(path: &Path) -> Result<String, Box<dyn Error>> {
    println!("cargo::rerun-if-changed={}", path.display());
    std::fs::read_to_string(path).map_err(|error| format!("{}: {error}", path.display()).into())
}

/// What a package is compiled from, sorted; asks for this script again when a file comes or goes.
fn sources(folder: &Path) -> Result<Vec<PathBuf>, Box<dyn Error>> {
    /// What Rust files are made of, once and in the checkout.
    const MADE_INTO_RUST: [&str; 2] = ["lalrpop", "logos"];
    println!("cargo::rerun-if-changed={}", folder.display());
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder)? {
        let path = entry?.path();
        if path.is_dir() {
            found.extend(sources(&path)?);
        } else if !MADE_INTO_RUST.iter().any(|ending| path.extension().is_some_and(|it| it == *ending)) {
            found.push(path);
        }
    }
    found.sort();
    Ok(found)
}

/// The manifest of the workspace, for these packages alone.
fn workspace(text: &str) -> Result<String, Box<dyn Error>> {
    let mut manifest: toml::Table = text.parse()?;
    manifest.retain(|key, _| key == "workspace");
    let workspace = manifest.get_mut("workspace").and_then(toml::Value::as_table_mut);
    let workspace = workspace.ok_or("the checkout is not a workspace")?;
    workspace.insert("members".into(), PACKAGES.map(toml::Value::from).to_vec().into());
    workspace.remove("exclude");
    workspace.remove("lints");
    if let Some(dependencies) = workspace.get_mut("dependencies").and_then(toml::Value::as_table_mut) {
        let is_kept = |path: &toml::Value| path.as_str().is_some_and(|path| PACKAGES.contains(&path));
        dependencies.retain(|_, value| value.get("path").is_none_or(is_kept));
    }
    Ok(manifest.to_string())
}

/// The manifest of a package, without what only its own tests need, and without the compiler.
fn manifest(text: &str) -> Result<String, Box<dyn Error>> {
    let mut manifest: toml::Table = text.parse()?;
    manifest.retain(|key, _| !["lints", "test", "bench", "example", "dev-dependencies"].contains(&key));
    let mut remove = |table: &str, key: &str| {
        if let Some(table) = manifest.get_mut(table).and_then(toml::Value::as_table_mut) {
            table.remove(key);
        }
    };
    remove("dependencies", "arl-macros");
    remove("features", "macros");
    if let Some(targets) = manifest.get_mut("target").and_then(toml::Value::as_table_mut) {
        targets.iter_mut().filter_map(|(_, target)| target.as_table_mut()).for_each(|target| {
            target.remove("dev-dependencies");
        });
    }
    Ok(manifest.to_string())
}
