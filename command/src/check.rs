//! `arl2rs check`

use crate::collisions;
use arl_lang::files::is_data;
use arl_project::cell_programs;
use arl_project::listing::{self, Limit};
use arl_project::options::Checking;
use arl_project::program::{bug, check_options};
use arl_project::robots;
use arl_robot::cell::{Cell, fit};
use arl_terminal::answer;
use arl_terminal::answer::Format;
use arl_terminal::exit::Exit;
use arl_terminal::failure::Failure;
use arl2rs::CheckOptions;
use arl2rs::compile::{Compiled, check_program};
use arl2rs::render::json;
use arl2rs::sources::FileSystem;
use std::collections::HashSet;
use std::io::Write;
use std::path::{Path, PathBuf};

/// Checks each file as a program, and the programs that the cell names. A data file, and a file that an earlier one
/// uses, is a module and needs no `main`. Programs without mistakes are run if collisions are looked for.
pub(crate) fn check(
    files: &[PathBuf],
    format: Format,
    mut limit: Limit,
    look: Option<collisions::Look>,
    checking: &Checking,
) -> Result<Exit, Failure> {
    let mut say = |compiled: Compiled| {
        match format {
            Format::Human => listing::show(&compiled, &mut limit),
            Format::Json => {
                let mut out = std::io::BufWriter::new(std::io::stdout().lock());
                let mut lines = lines(&compiled).into_iter();
                answer::written(lines.try_for_each(|line| writeln!(out, "{line}")).and_then(|()| out.flush()))?;
            }
        }
        Ok(())
    };
    let mut refused = false;
    for (checking, files) in groups(files, checking)? {
        let Checked { mistaken, programs } = check_group(&files, &checking, &mut say)?;
        refused |= mistaken;
        if let Some(look) = look {
            for file in programs {
                refused |= collisions::check(file, &checking, look)?;
            }
        }
    }
    Ok(if refused { Exit::FAILURE } else { Exit::SUCCESS })
}

/// The diagnostics of files, a JSON object each, and whether there are errors.
pub(crate) fn found(files: &[PathBuf], checking: &Checking) -> Result<(Vec<String>, bool), Failure> {
    let (mut all, mut refused) = (Vec::new(), false);
    let mut keep = |compiled: Compiled| {
        all.extend(lines(&compiled));
        Ok(())
    };
    for (checking, files) in groups(files, checking)? {
        refused |= check_group(&files, &checking, &mut keep)?.mistaken;
    }
    Ok((all, refused))
}

fn lines(compiled: &Compiled) -> Vec<String> {
    let files = compiled.shown_files();
    compiled.checked.diagnostics.iter().map(|diagnostic| json(diagnostic, &files)).collect()
}

/// The files, grouped by what they are checked for.
fn groups(files: &[PathBuf], checking: &Checking) -> Result<Vec<(Checking, Vec<PathBuf>)>, Failure> {
    // Files of several projects are for robots and cells of their own.
    let mut groups: Vec<(Checking, Vec<PathBuf>)> = Vec::new();
    for file in files {
        let checking = checking.of_program(file)?;
        match groups.iter_mut().find(|(known, _)| *known == checking) {
            Some((_, files)) => files.push(file.clone()),
            None => groups.push((checking, vec![file.clone()])),
        }
    }
    Ok(groups)
}

/// The result of checking some files.
struct Checked<'a> {
    /// Whether there were errors.
    mistaken: bool,
    /// The programs without errors that run first, in channel 1.
    programs: Vec<&'a Path>,
}

/// Checks files that are for the same robot and cell.
fn check_group<'a>(
    files: &'a [PathBuf],
    checking: &Checking,
    say: &mut dyn FnMut(Compiled) -> Result<(), Failure>,
) -> Result<Checked<'a>, Failure> {
    let options = options(checking)?;
    cell_fits(checking)?;
    let others = cell_programs::named(checking.cell.as_deref(), checking.robot.as_deref())?;
    let mut used = HashSet::new();
    let (programs, modules): (Vec<&PathBuf>, Vec<&PathBuf>) = files.iter().partition(|file| !is_data(file));
    let same =
        |one: &Path, other: &Path| one.canonicalize().is_ok_and(|one| other.canonicalize().is_ok_and(|it| it == one));
    let mut all: Vec<(&Path, CheckOptions)> = Vec::new();
    for file in programs {
        // The programs that the cell names are checked as the cell has them.
        if !others.iter().any(|other| same(&other.path, file)) {
            all.push((file, options.clone()));
        }
    }
    for other in &others {
        all.push((&other.path, self::options(&other.checking(checking))?));
    }
    // For a single program nothing is reported twice.
    let reported = (all.len() + modules.len() > 1).then(HashSet::new);
    let mut reporter = Reporter { say, reported };
    let mut refused = false;
    let mut found = Vec::new();
    let mut later = Vec::new();
    for (file, options) in all {
        let compiled = check_program(file, &FileSystem, &options).map_err(bug)?;
        used.extend(compiled.read().skip(1).filter_map(|path| path.canonicalize().ok()));
        later.push((file, compiled));
    }
    for (file, mut compiled) in later {
        if compiled.checked.program.is_none() && file.canonicalize().is_ok_and(|path| used.contains(&path)) {
            compiled = as_module(file, &options)?;
        }
        let runs = compiled.checked.program.is_some();
        refused |= reporter.report(compiled)?;
        found.extend(runs.then_some(file));
    }
    for file in modules {
        refused |= reporter.report(as_module(file, &options)?)?;
    }
    // Programs of the cell's other channels run with the first one.
    let programs = files
        .iter()
        .map(PathBuf::as_path)
        .filter(|file| found.contains(file) && !others.iter().any(|other| same(&other.path, file)));
    Ok(Checked { mistaken: refused, programs: programs.collect() })
}

/// The options of a check that no run follows. A program that runs gets its robot itself, and one that is compiled may
/// get several.
fn options(checking: &Checking) -> Result<CheckOptions, Failure> {
    let mut options = check_options(checking)?;
    if let Some(robot) = &checking.robot {
        options.robot = Some(robots::load(Some(robot))?);
    }
    Ok(options)
}

/// Whether what the cell says of robots fits them: what the program would refuse when it starts.
fn cell_fits(checking: &Checking) -> Result<(), Failure> {
    let Some(path) = &checking.cell else { return Ok(()) };
    let cell = Cell::load(path).map_err(|error| Failure::Usage(error.to_string()))?;
    let fits = |homes, collisions, robot: Option<&str>| {
        let wrong = |text| Failure::Usage(format!("{}: {text}", path.display()));
        fit(homes, collisions, &robots::load(robot)?).map_err(wrong)
    };
    if !checking.background {
        fits(&cell.homes, &cell.collisions, checking.robot.as_deref())?;
    }
    let mut with_robot = cell.programs.channels.iter().filter(|channel| !channel.background);
    with_robot.try_for_each(|channel| fits(&channel.homes, &channel.collisions, channel.robot.as_deref()))
}

fn as_module(file: &Path, options: &CheckOptions) -> Result<Compiled, Failure> {
    check_program(file, &FileSystem, &CheckOptions { library: true, ..options.clone() }).map_err(bug)
}

/// Reports diagnostics, a module's mistakes only once.
struct Reporter<'a> {
    say: &'a mut dyn FnMut(Compiled) -> Result<(), Failure>,
    /// What was reported, as JSON; `None` where nothing can come twice.
    reported: Option<HashSet<String>>,
}

impl Reporter<'_> {
    /// Reports the diagnostics of a program; returns whether there were errors.
    fn report(&mut self, mut compiled: Compiled) -> Result<bool, Failure> {
        let refused = compiled.checked.has_errors();
        let files = compiled.shown_files();
        if let Some(reported) = &mut self.reported {
            compiled.checked.diagnostics.retain(|diagnostic| reported.insert(json(diagnostic, &files)));
        }
        drop(files);
        (self.say)(compiled)?;
        Ok(refused)
    }
}
