//! Several programs in one: the one of the command line, and those that its cell file names.

use super::args::Checking;
use super::cache::{Cache, Place};
use super::failure::Failure;
use super::program::{Ready, check_options, compile};
use super::progress::Progress;
use super::runtime::Runtime;
use super::{cargo, project};
use serde::Deserialize;
use std::path::{Path, PathBuf};

/// What a cell file says of programs. The runtime reads the whole of it, and tells what is wrong there.
#[derive(Deserialize, Default)]
struct Cell {
    #[serde(default)]
    channel: Vec<Channel>,
    #[serde(default)]
    load: Vec<String>,
}

#[derive(Deserialize)]
struct Channel {
    program: String,
    robot: Option<String>,
    #[serde(default)]
    background: bool,
    #[serde(default)]
    load: Vec<String>,
}

/// A program beside the first one.
#[derive(Clone, PartialEq, Debug)]
pub(super) struct Other {
    /// As the cell file names it.
    pub(super) file: String,
    path: PathBuf,
    robot: Option<String>,
    background: bool,
}

/// The programs that a cell file names; none where it cannot be read.
pub(super) fn named(cell: &Path, robot: Option<&str>) -> Vec<Other> {
    let text = std::fs::read_to_string(cell).unwrap_or_default();
    let Cell { channel, load } = toml::from_str(&text).unwrap_or_default();
    let folder = cell.parent().unwrap_or(Path::new(""));
    let mut all: Vec<Other> = Vec::new();
    let mut add =
        |file: String, robot: Option<String>, background: bool| match all.iter_mut().find(|it| it.file == file) {
            // What runs in the background somewhere may do there only what it may do everywhere.
            Some(known) => known.background |= background,
            None => all.push(Other { path: folder.join(&file), file, robot, background }),
        };
    load.into_iter().for_each(|file| add(file, robot.map(String::from), false));
    for Channel { program, robot, background, load } in channel {
        let robot = robot.map(|robot| {
            let file = folder.join(&robot);
            if file.is_file() { file.display().to_string() } else { robot }
        });
        add(program, robot.clone(), background);
        load.into_iter().for_each(|file| add(file, robot.clone(), false));
    }
    all
}

/// Compiles them all into one program. Their check is done each time, the Rust is compiled where it has changed.
pub(super) fn prepare(file: &Path, cell: &Path, others: &[Other], checking: &Checking) -> Result<Ready, Failure> {
    let absolute = |path: &Path| std::path::absolute(path).map_err(|error| Failure::io("use", path, &error));
    let main = absolute(file)?;
    let first = compile(file, &check_options(checking)?);
    let mut sources: Vec<PathBuf> = first.as_ref().map(|(compiled, _)| compiled.read().collect()).unwrap_or_default();
    let mut rust = Vec::new();
    let mut refused = false;
    for Other { file, path, robot, background } in others {
        let checking = Checking { robot: robot.clone(), background: *background, ..checking.clone() };
        match compile(path, &check_options(&checking)?) {
            Ok((compiled, text)) => {
                sources.extend(compiled.read());
                rust.push((file.as_str(), text));
            }
            // The mistakes of all programs are shown.
            Err(Failure::Shown) => refused = true,
            Err(failure) => return Err(failure),
        }
    }
    let (_, first) = first?;
    if refused {
        return Err(Failure::Shown);
    }
    let cache = Cache::find()?;
    let place = cache.programs(&main, &absolute(cell)?);
    let lock = place.lock(false)?;
    let program = build(&cache, &place, &first, &rust, &main)?;
    Ok(Ready { program, lock, sources })
}

fn build(
    cache: &Cache,
    place: &Place,
    first: &str,
    others: &[(&str, String)],
    main: &Path,
) -> Result<PathBuf, Failure> {
    let folder = main.parent().unwrap_or(Path::new("/"));
    project::write_several(place, &Runtime::find(), first, others, folder)?;
    let progress = Progress::start("compiling");
    let built = cargo::build(&place.folder, &cache.target(), false, &progress)?;
    drop(progress);
    let made = built.programs.into_iter().next().filter(|_| built.errors.is_empty());
    let (_, made) = made.ok_or_else(|| cargo::bug(&built.errors, main))?;
    let path = place.folder.join(format!("program{}", std::env::consts::EXE_SUFFIX));
    // One that runs goes on as it is.
    let _ = std::fs::remove_file(&path);
    std::fs::copy(&made, &path).map_err(|error| Failure::io("write", &path, &error))?;
    Ok(path)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cell_names_programs_once() {
        let path = std::env::temp_dir().join(format!("arl2rs-several-{}.toml", std::process::id()));
        let text = "load = [\"r.arl\"]\n[io]\ndi = 3\n[[channel]]\nprogram = \"a.arl\"\nrobot = \"hsr065\"\nload = [\"s.arl\"]\n\
                    [[channel]]\nprogram = \"w.arl\"\nbackground = true\n[[channel]]\nprogram = \"a.arl\"\n";
        std::fs::write(&path, text).expect("written");
        let found = named(&path, Some("six-10"));
        std::fs::remove_file(&path).expect("removed");
        let short: Vec<_> = found.iter().map(|it| (it.file.as_str(), it.robot.as_deref(), it.background)).collect();
        let expected = [
            ("r.arl", Some("six-10"), false),
            ("a.arl", Some("hsr065"), false),
            ("s.arl", Some("hsr065"), false),
            ("w.arl", None, true),
        ];
        assert_eq!(short, expected);
        assert_eq!(named(Path::new("nowhere.toml"), None), []);
    }
}
