//! The points of data files: read for the page, and written where they stand.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use arl_lang::ast::{BraceItem, Expr, ExprKind, Item, UnaryOp, Var};
use arl_lang::symbol::Interner;
use arl_robot::kinematics::frame;
use arl_robot::{atomic_file, regular_file};
use serde::Deserialize;
use serde_json::{Value, json};

use super::super::super::texts::file_name;

/// How the names of data files end.
const DATA: &str = "_data.arl";
/// The components of points, in the order in which literals without names have them.
const POSE: &[&str] = &["x", "y", "z", "a", "b", "c", "cfg", "turn", "ej1", "ej2", "ej3", "ej4", "ej5", "ej6"];
const JOINT: &[&str] = &["j1", "j2", "j3", "j4", "j5", "j6", "ej1", "ej2", "ej3", "ej4", "ej5", "ej6"];
/// Those that are whole numbers.
const WHOLE: &[&str] = &["cfg", "turn"];
/// So many steps can be taken back.
const UNDONE: usize = 200;

/// The data files of a program, and what was written into them.
pub(super) struct Files {
    paths: Vec<PathBuf>,
    /// Each step: what was in which file before, and what after.
    steps: Vec<Vec<Step>>,
}

struct Step {
    path: PathBuf,
    before: Vec<u8>,
    after: Vec<u8>,
}

/// A point that is to have other values.
#[derive(Clone, PartialEq, Deserialize, Debug)]
#[serde(deny_unknown_fields)]
pub(super) struct Change {
    pub(super) file: String,
    /// `pose` or `joint`
    pub(super) r#type: String,
    pub(super) name: String,
    /// By the names of the components, in mm and deg.
    pub(super) values: BTreeMap<String, f64>,
}

impl Files {
    /// The data files among the files of a program.
    pub(super) fn of(sources: &[PathBuf]) -> Self {
        let is_data = |path: &&PathBuf| path.to_string_lossy().to_ascii_lowercase().ends_with(DATA);
        Self { paths: sources.iter().filter(is_data).cloned().collect(), steps: Vec::new() }
    }

    /// Writes points, all or none.
    pub(super) fn save(&mut self, changes: &[Change]) -> Result<(), String> {
        let mut step: Vec<Step> = Vec::new();
        for change in changes {
            let path = self.path(&change.file)?;
            let at = match step.iter().position(|one| one.path == path) {
                Some(at) => at,
                None => {
                    let before = read(&path)?;
                    step.push(Step { path, after: before.clone(), before });
                    step.len() - 1
                }
            };
            if let Some(one) = step.get_mut(at) {
                let changed = arl_lang::with_value(&one.after, &change.r#type, &change.name, &literal(change)?);
                one.after = changed.map_err(|what| format!("{} {what}", change.file))?;
            }
        }
        step.iter().try_for_each(|one| write(&one.path, &one.after))?;
        step.retain(|one| one.before != one.after);
        if !step.is_empty() {
            if self.steps.len() == UNDONE {
                self.steps.remove(0);
            }
            self.steps.push(step);
        }
        Ok(())
    }

    /// Takes the last step back, where nobody else has written since.
    pub(super) fn undo(&mut self) -> Result<(), String> {
        let step = self.steps.last().ok_or("nothing was written that could be taken back")?;
        for one in step {
            if read(&one.path)? != one.after {
                return Err(format!(
                    "{} was changed by somebody else since: nothing is taken back",
                    one.path.display()
                ));
            }
        }
        step.iter().try_for_each(|one| write(&one.path, &one.before))?;
        self.steps.pop();
        Ok(())
    }

    fn path(&self, name: &str) -> Result<PathBuf, String> {
        let found = self.paths.iter().find(|path| file_name(&path.to_string_lossy()) == name);
        found.cloned().ok_or_else(|| format!("{name} is no data file of this program"))
    }
}

fn read(path: &Path) -> Result<Vec<u8>, String> {
    regular_file::read(path).map_err(|error| format!("cannot read {}: {error}", path.display()))
}

fn write(path: &Path, content: &[u8]) -> Result<(), String> {
    atomic_file::write(path, content).map_err(|error| format!("cannot write {}: {error}", path.display()))
}

fn components(ty: &str) -> Option<&'static [&'static str]> {
    match ty {
        "pose" => Some(POSE),
        "joint" => Some(JOINT),
        _ => None,
    }
}

/// The literal of a point: to a thousandth of a mm or deg.
fn literal(change: &Change) -> Result<String, String> {
    let known = components(&change.r#type).ok_or("a point is a pose or a joint")?;
    if let Some((name, _)) = change.values.iter().find(|(name, value)| {
        !known.contains(&name.as_str()) || !value.is_finite() || WHOLE.contains(&name.as_str()) && value.fract() != 0.0
    }) {
        return Err(format!("`{name}` is no component of a {}, or no number for it", change.r#type));
    }
    let rounded = |value: f64| (value * 1000.0).round() / 1000.0 + 0.0;
    let written = known.iter().filter_map(|name| Some(format!("{name} {}", rounded(*change.values.get(*name)?))));
    let written: Vec<String> = written.collect();
    if written.is_empty() {
        return Err(format!("`{}` would have no components", change.name));
    }
    Ok(format!("{{{}}}", written.join(", ")))
}

/// The points, tools and workpieces of all files, for the page.
pub(super) fn told(files: &Files) -> Value {
    let (mut points, mut frames, mut troubles) = (Vec::new(), Vec::new(), Vec::new());
    for path in &files.paths {
        let name = file_name(&path.to_string_lossy()).to_owned();
        let text = read(path).and_then(|bytes| {
            arl_lang::text::decode(&bytes).map(std::borrow::Cow::into_owned).map_err(|error| format!("{name}: {error}"))
        });
        match text {
            Ok(text) => of_text(&name, &text, &mut points, &mut frames),
            Err(why) => troubles.push(why),
        }
    }
    let files_names: Vec<_> = files.paths.iter().map(|path| file_name(&path.to_string_lossy()).to_owned()).collect();
    json!({"points": points, "frames": frames, "files": files_names, "undo": files.steps.len(), "troubles": troubles})
}

fn of_text(file: &str, text: &str, points: &mut Vec<Value>, frames: &mut Vec<Value>) {
    let mut names = Interner::default();
    let parsed = arl_lang::parse(text, &mut names, arl_lang::ParseOptions::default());
    for item in &parsed.file.items {
        let Item::Global(decl) = item else { continue };
        let ty = names.name(decl.ty.name).to_ascii_lowercase();
        for var in decl.vars.iter().filter(|var| var.dims.is_empty()) {
            let name = names.name(var.name.symbol);
            let items = braced(var);
            match ty.as_str() {
                "pose" | "joint" => {
                    let values = values(items, components(&ty).unwrap_or_default(), &names);
                    points.push(json!({"file": file, "type": ty, "name": name, "values": values}));
                }
                "tool" | "wobj" => {
                    if let Some((angles, placed, other)) = mount(items, &names) {
                        frames.push(
                            json!({"type": ty, "name": name, "angles": angles, "placed": placed, "other": other}),
                        );
                    }
                }
                _ => {}
            }
        }
    }
}

/// What stands between the braces of a variable's value.
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

/// The angles a, b, c of a tool or workpiece in deg, its frame, and whether it is where such usually are not: a tool that stands, a workpiece that is held.
fn mount(items: &[BraceItem], names: &Interner) -> Option<([f64; 3], [f64; 7], bool)> {
    let ExprKind::Brace(inner) = &items.first()?.value.kind else { return None };
    let found = values(inner, POSE.get(..6)?, names);
    let component = |name: &str| found.get(name).copied().unwrap_or_default();
    let angles = ["a", "b", "c"].map(component);
    let [a, b, c] = angles;
    let placed = frame([component("x"), component("y"), component("z"), a, b, c]);
    let ([x, y, z], [i, j, k, w]): ([f64; 3], [f64; 4]) =
        (placed.translation.vector.into(), placed.rotation.coords.into());
    let other = matches!(items.get(1).map(|item| &item.value.kind), Some(ExprKind::Bool(true)));
    Some((angles, [x, y, z, i, j, k, w], other))
}
