//! The points of data files: read for the page, and written where they are.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use arl_lang::ast::{BraceItem, Expr, ExprKind, Item, UnaryOp, Var};
use arl_lang::catalog::UNSET;
use arl_lang::symbol::Interner;
use arl_robot::Family;
use arl_robot::atomic_file::{self, ChangeError};
use arl_robot::cell::LARGEST_MM;
use arl_robot::kinematics::frame;
use arl_robot::regular_file;
use serde::{Deserialize, Serialize};

use crate::texts::file_name;
use arl_wire::{Placed, written};

/// The end of data files' names.
const DATA: &str = "_data.arl";
/// The components of points, in the order in which literals without names have them.
const POSE: &[&str] = &["x", "y", "z", "a", "b", "c", "cfg", "turn", "ej1", "ej2", "ej3", "ej4", "ej5", "ej6"];
const JOINT_SCARA: &[&str] = &["j1", "j2", "j3", "j4", "ej1", "ej2", "ej3", "ej4", "ej5", "ej6"];
const JOINT: &[&str] = &["j1", "j2", "j3", "j4", "j5", "j6", "ej1", "ej2", "ej3", "ej4", "ej5", "ej6"];
/// The components that are whole numbers, and their ranges.
const WHOLE: &[(&str, [f64; 2])] = &[("cfg", [0.0, 7.0]), ("turn", [-1.0, 63.0])];
/// The most steps that can be undone.
const UNDONE: usize = 200;

/// The data files of a program, and what was written into them.
pub(super) struct Files {
    paths: Vec<PathBuf>,
    /// Determines which axes the joints have.
    family: Family,
    /// Each step: the content of the files before and after.
    steps: Vec<Vec<Step>>,
}

struct Step {
    path: PathBuf,
    before: Vec<u8>,
    after: Vec<u8>,
}

/// A point that gets other values.
#[derive(Clone, PartialEq, Deserialize, Debug)]
#[serde(deny_unknown_fields)]
pub(super) struct Change {
    pub(super) file: String,
    /// `pose` or `joint`
    pub(super) r#type: String,
    pub(super) name: String,
    /// By the names of the components, in mm and deg.
    pub(super) values: BTreeMap<String, f64>,
    /// The point's previous values, as far as the client knows them.
    pub(super) before: BTreeMap<String, f64>,
}

impl Files {
    /// The data files among the files of a program.
    pub(super) fn of(sources: &[PathBuf], family: Family) -> Self {
        let is_data = |path: &&PathBuf| path.to_string_lossy().to_ascii_lowercase().ends_with(DATA);
        Self { paths: sources.iter().filter(is_data).cloned().collect(), family, steps: Vec::new() }
    }

    /// Writes points, all or none.
    pub(super) fn save(&mut self, changes: &[Change]) -> Result<(), String> {
        let mut by_file: Vec<(PathBuf, Vec<&Change>)> = Vec::new();
        for change in changes {
            let path = self.path(&change.file)?;
            match by_file.iter_mut().find(|(known, _)| *known == path) {
                Some((_, of_file)) => of_file.push(change),
                None => by_file.push((path, vec![change])),
            }
        }
        // Errors are reported before anything is written.
        for (path, changes) in &by_file {
            changed(&read(path)?, changes, self.family)?;
        }
        let write = |(path, changes): &(PathBuf, Vec<&Change>)| replace(path, |now| changed(now, changes, self.family));
        let mut step = all_or_none(by_file.iter().map(write))?;
        step.retain(|one| one.before != one.after);
        if !step.is_empty() {
            if self.steps.len() == UNDONE {
                self.steps.remove(0);
            }
            self.steps.push(step);
        }
        Ok(())
    }

    /// Undoes the last step, unless its files have been written since.
    pub(super) fn undo(&mut self) -> Result<(), String> {
        let step = self.steps.last().ok_or("there is nothing to undo")?;
        for one in step {
            one.expect_written(&read(&one.path)?)?;
        }
        all_or_none(step.iter().map(Step::take_back))?;
        self.steps.pop();
        Ok(())
    }

    fn path(&self, name: &str) -> Result<PathBuf, String> {
        let found = self.paths.iter().find(|path| self.name(path) == name);
        found.cloned().ok_or_else(|| format!("{name} is not a data file of this program"))
    }

    /// The name of a file: without folders, if no other file has that name.
    fn name(&self, path: &Path) -> String {
        let of = |path: &Path| file_name(&path.to_string_lossy()).to_owned();
        let name = of(path);
        let alone = self.paths.iter().filter(|other| of(other) == name).count() < 2;
        if alone { name } else { path.display().to_string() }
    }
}

impl Step {
    /// Restores the previous content.
    fn take_back(&self) -> Result<Step, String> {
        replace(&self.path, |now| self.expect_written(now).map(|()| self.before.clone()))
    }

    /// Checks that a file still holds what was written.
    fn expect_written(&self, now: &[u8]) -> Result<(), String> {
        let name = self.path.display();
        if now == self.after {
            Ok(())
        } else {
            Err(format!("{name} has been changed by somebody else since: it is left as it is"))
        }
    }
}

/// Writes files one after the other; if one cannot be written, those written before are restored.
fn all_or_none(steps: impl Iterator<Item = Result<Step, String>>) -> Result<Vec<Step>, String> {
    let mut written: Vec<Step> = Vec::new();
    for step in steps {
        match step {
            Ok(step) => written.push(step),
            Err(why) => {
                let stays = written.iter().filter_map(|step| step.take_back().err());
                return Err(
                    stays.fold(why, |all, why| format!("{all}; what was written before cannot be undone: {why}"))
                );
            }
        }
    }
    Ok(written)
}

/// Replaces the content of a file by the result of `change`, even if others write the file meanwhile; returns the
/// content before and after.
fn replace(path: &Path, mut change: impl FnMut(&[u8]) -> Result<Vec<u8>, String>) -> Result<Step, String> {
    let mut step = Step { path: path.to_owned(), before: Vec::new(), after: Vec::new() };
    let changed = atomic_file::change(path, |now| {
        (step.before, step.after) = (now.to_vec(), change(now)?);
        Ok(step.after.clone())
    });
    match changed {
        Ok(()) => Ok(step),
        Err(ChangeError::Refused(why)) => Err(why),
        Err(ChangeError::Read(error)) => Err(format!("cannot read {}: {error}", path.display())),
        Err(ChangeError::Write(error)) => Err(format!("cannot write {}: {error}", path.display())),
        Err(aside @ ChangeError::Aside(..)) => Err(format!("{} {aside}", path.display())),
    }
}

fn read(path: &Path) -> Result<Vec<u8>, String> {
    regular_file::read(path).map_err(|error| format!("cannot read {}: {error}", path.display()))
}

/// The content of a data file in which points have other values.
fn changed(now: &[u8], changes: &[&Change], family: Family) -> Result<Vec<u8>, String> {
    changes.iter().try_fold(now.to_vec(), |now, change| {
        expect_known(&now, change, family)?;
        let changed = arl_lang::with_value(&now, &change.r#type, &change.name, &literal(change, family)?);
        changed.map_err(|what| format!("{} {what}", change.file))
    })
}

/// Checks that neither what a program computes is replaced by numbers, nor what others have changed since it was read.
fn expect_known(bytes: &[u8], change: &Change, family: Family) -> Result<(), String> {
    // Texts that cannot be read are reported where the value is replaced.
    let Ok(text) = arl_lang::text::decode(bytes) else { return Ok(()) };
    let (name, file) = (&change.name, &change.file);
    let mut known = Points::default();
    known.read(file, &text, family);
    let is = |own: &str, asked: &str| own.eq_ignore_ascii_case(asked);
    let Some(point) = known.points.iter().find(|one| is(&one.name, name) && is(&one.r#type, &change.r#type)) else {
        return Ok(());
    };
    if !point.plain {
        return Err(format!("{name} is computed in {file}: only values that are plain numbers can be replaced"));
    }
    let before = change.before.iter().map(|(component, value)| (component.as_str(), *value));
    if !point.values.iter().map(|(component, value)| (*component, *value)).eq(before) {
        return Err(format!("{name} has been changed in {file} by somebody else since: look at it again first"));
    }
    Ok(())
}

fn components(ty: &str, family: Family) -> Option<&'static [&'static str]> {
    match ty {
        "pose" => Some(POSE),
        "joint" if family == Family::Scara => Some(JOINT_SCARA),
        "joint" => Some(JOINT),
        _ => None,
    }
}

/// The literal of a point: to a thousandth of a mm or deg.
fn literal(change: &Change, family: Family) -> Result<String, String> {
    let known = components(&change.r#type, family).ok_or("a point is a pose or a joint")?;
    for (name, value) in &change.values {
        if !known.contains(&name.as_str()) {
            return Err(format!("`{name}` is not a component of a {}", change.r#type));
        }
        expect_component(name, *value)?;
    }
    let rounded = |value: f64| (value * 1000.0).round() / 1000.0 + 0.0;
    let written = known.iter().filter_map(|name| Some(format!("{name} {}", rounded(*change.values.get(*name)?))));
    let written: Vec<String> = written.collect();
    if written.is_empty() {
        return Err(format!("`{}` would have no components", change.name));
    }
    Ok(format!("{{{}}}", written.join(", ")))
}

/// Checks that a component has a value that a cell may have.
fn expect_component(name: &str, value: f64) -> Result<(), String> {
    match WHOLE.iter().find(|(whole, _)| *whole == name) {
        Some((_, [least, most])) if value.fract() != 0.0 || !(*least..=*most).contains(&value) => {
            Err(format!("`{name}` is {value}: expected a whole number from {least} to {most}"))
        }
        None if value != UNSET => expect_sensible(value).map_err(|why| format!("`{name}`: {why}")),
        _ => Ok(()),
    }
}

/// Checks that a number of mm or deg is one that a cell may have.
pub(super) fn expect_sensible(number: f64) -> Result<(), String> {
    if number.abs() <= LARGEST_MM {
        Ok(())
    } else {
        Err(format!("{number:e} is out of range: expected mm or deg from {:e} to {LARGEST_MM:e}", -LARGEST_MM))
    }
}

/// The content of data files, for the page.
#[derive(Default, Serialize, Debug)]
#[cfg_attr(test, derive(ts_rs::TS))]
pub(in crate::view) struct Points {
    points: Vec<Point>,
    frames: Vec<Mounted>,
    /// How many steps can be undone.
    undo: usize,
    /// What cannot be read, and the reason.
    troubles: Vec<String>,
}

/// A point: its components that are plain numbers, in mm and deg.
#[derive(Serialize, Debug)]
#[cfg_attr(test, derive(ts_rs::TS))]
pub(in crate::view) struct Point {
    file: String,
    r#type: String,
    name: String,
    values: BTreeMap<&'static str, f64>,
    /// Whether it has no other components.
    plain: bool,
}

/// A tool or workpiece.
#[derive(Serialize, Debug)]
#[cfg_attr(test, derive(ts_rs::TS))]
pub(in crate::view) struct Mounted {
    file: String,
    r#type: String,
    name: String,
    /// a, b, c in deg.
    angles: [f64; 3],
    placed: Placed,
    /// Whether it is mounted in the less usual way: a stationary tool, a workpiece that the robot holds.
    other: bool,
}

/// The points, tools and workpieces of all files.
pub(super) fn read_all(files: &Files) -> Points {
    let mut found = Points { undo: files.steps.len(), ..Points::default() };
    for path in &files.paths {
        let name = files.name(path);
        let text = read(path).and_then(|bytes| {
            arl_lang::text::decode(&bytes).map(std::borrow::Cow::into_owned).map_err(|error| format!("{name}: {error}"))
        });
        match text {
            Ok(text) => found.read(&name, &text, files.family),
            Err(why) => found.troubles.push(why),
        }
    }
    found
}

impl Points {
    fn read(&mut self, file: &str, text: &str, family: Family) {
        let mut names = Interner::default();
        let parsed = arl_lang::parse(text, &mut names, arl_lang::ParseOptions::default());
        for item in &parsed.file.items {
            let Item::Global(decl) = item else { continue };
            let r#type = names.name(decl.ty.name).to_ascii_lowercase();
            for var in decl.vars.iter().filter(|var| var.dims.is_empty()) {
                let (file, r#type, name) = (file.to_owned(), r#type.clone(), names.name(var.name.symbol).to_owned());
                let items = braced(var);
                if let Some(known) = components(&r#type, family) {
                    let values = values(items, known, &names);
                    let plain = values.len() == items.len() && var.init.is_some() == is_braced(var);
                    self.points.push(Point { file, r#type, name, values, plain });
                } else if matches!(r#type.as_str(), "tool" | "wobj")
                    && let Some((angles, placed, other)) = mount(items, &names)
                {
                    self.frames.push(Mounted { file, r#type, name, angles, placed, other });
                }
            }
        }
    }
}

fn is_braced(var: &Var) -> bool {
    var.init.as_ref().is_some_and(|init| matches!(init.kind, ExprKind::Brace(_)))
}

/// The items between the braces of a variable's value.
fn braced(var: &Var) -> &[BraceItem] {
    match var.init.as_ref().map(|init| &init.kind) {
        Some(ExprKind::Brace(items)) => items,
        _ => &[],
    }
}

/// The components that are plain numbers.
fn values(items: &[BraceItem], known: &[&'static str], names: &Interner) -> BTreeMap<&'static str, f64> {
    let of = |(at, item): (usize, &BraceItem)| {
        let name = match &item.name {
            Some(name) => known.iter().find(|known| names.name(name.symbol).eq_ignore_ascii_case(known)),
            None => known.get(at),
        };
        Some((*name?, number(&item.value)?))
    };
    items.iter().enumerate().filter_map(of).collect()
}

fn number(expr: &Expr) -> Option<f64> {
    match &expr.kind {
        ExprKind::Int(value, _) => Some(f64::from(*value)),
        ExprKind::Double(value) => Some(*value),
        ExprKind::Unary(UnaryOp::Negate, inner) => Some(-number(inner)?),
        _ => None,
    }
}

/// The angles of a tool or workpiece, its frame, and whether it is mounted in the less usual way.
fn mount(items: &[BraceItem], names: &Interner) -> Option<([f64; 3], Placed, bool)> {
    let ExprKind::Brace(inner) = &items.first()?.value.kind else { return None };
    let found = values(inner, POSE.get(..6)?, names);
    if found.len() < inner.len() {
        // Computed values are not known here.
        return None;
    }
    let component = |name: &str| found.get(name).copied().unwrap_or_default();
    let angles = ["a", "b", "c"].map(component);
    let [a, b, c] = angles;
    let placed = frame([component("x"), component("y"), component("z"), a, b, c]);
    let other = matches!(items.get(1).map(|item| &item.value.kind), Some(ExprKind::Bool(true)));
    Some((angles, written(&placed), other))
}
