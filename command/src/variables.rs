//! The global variables of programs: what can be set, watched and queried from outside.

use crate::parameters::Parameters;
use arl_lang::catalog::Base;
use arl_project::cell_programs;
use arl_project::options::Checking;
use arl_project::program::{bug, check_options};
use arl_robot::settings::hint_of_many;
use arl_terminal::failure::Failure;
use arl2rs::check::type_name;
use arl2rs::compile::check_program;
use arl2rs::sources::FileSystem;
use arl2rs::{CheckOptions, Sources};
use serde::Serialize;
use std::path::Path;

/// A global variable, as its declaration has it.
#[derive(Clone, PartialEq, Eq, Debug, Serialize)]
#[non_exhaustive]
pub struct Variable {
    /// Its name.
    pub name: String,
    /// The file that declares it, relative to the folder of the main file.
    pub file: String,
    /// The line of its declaration, from 1.
    pub line: u32,
    /// The type of the variable, or of the elements of an array: `pose`.
    #[serde(rename = "type")]
    pub ty: String,
    /// The sizes of an array; empty for one value.
    pub sizes: Vec<u16>,
    /// Whether it is `const`: it cannot be set.
    pub constant: bool,
    /// Its initial value as in the declaration; `None` if the declaration has none.
    pub first: Option<String>,
    /// The places of numbers and truth values in one element: `.x`; the empty text is the element itself.
    pub numbers: Vec<String>,
}

/// The global variables of a program, in the order of their files and declarations.
///
/// # Errors
/// The file cannot be read, or the robot or cell is not there.
pub(crate) fn of_program(main: &Path, checking: &Checking) -> Result<Vec<Variable>, Failure> {
    let options = CheckOptions { index: true, ..check_options(checking)? };
    let sources: &dyn Sources = &FileSystem;
    let compiled = check_program(main, sources, &options).map_err(bug)?;
    let Some(index) = &compiled.checked.index else { return Ok(Vec::new()) };
    let firsts = compiled.checked.program.as_ref().map_or(&[][..], |program| &program.globals);
    let files = &compiled.checked.files;
    let of_global = |(at, global): (usize, &arl2rs::index::GlobalInfo)| {
        let file = files.get(global.at.file)?;
        let ty = global.ty?;
        let first = firsts.get(at).and_then(|it| it.init.as_ref());
        let first = first.map(|init| init.span.text(&file.text).trim().to_owned());
        let mut numbers = Vec::new();
        push_numbers(ty.base, &options, String::new(), &mut numbers);
        Some(Variable {
            name: global.name.clone(),
            file: file.name.clone(),
            line: files.line(global.at),
            ty: type_name(ty.element(), options.family),
            sizes: ty.dims().to_vec(),
            constant: global.constant,
            first: first.filter(|text| !text.is_empty()),
            numbers,
        })
    };
    let mut all: Vec<Variable> = index.globals.iter().enumerate().filter_map(of_global).collect();
    all.sort_by(|one, other| (&one.file, one.line).cmp(&(&other.file, other.line)));
    Ok(all)
}

/// Collects the places of numbers and truth values in a value of this type.
fn push_numbers(base: Base, options: &CheckOptions, place: String, all: &mut Vec<String>) {
    match base {
        Base::Int | Base::Uint | Base::Byte | Base::Double | Base::Bool => all.push(place),
        Base::Struct(id) => {
            for component in id.def(options.family).components {
                push_numbers(component.ty, options, format!("{place}.{}", component.name.to_ascii_lowercase()), all);
            }
        }
        Base::Void | Base::String | Base::Enum(_) | Base::Handle(_) => {}
    }
}

/// The names of all variables that parameters of runs can set: those of the program, and those of the other programs of
/// its cell.
fn settable(main: &Path, cell: Option<&Path>, checking: &Checking) -> Result<Vec<(String, String)>, Failure> {
    let named = |variable: Variable| (stem(&variable.file), variable.name);
    let mut all: Vec<_> = of_program(main, checking)?.into_iter().map(named).collect();
    for other in cell_programs::named(cell, checking.robot.as_deref())? {
        all.extend(of_program(&other.path, &other.checking(checking))?.into_iter().map(named));
    }
    Ok(all)
}

fn stem(file: &str) -> String {
    Path::new(file).file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default()
}

/// Refuses a table in which every row has an unknown global variable: a slip in a name, which would cost all runs.
///
/// # Errors
/// Every row has one; the error names variables that are similar to the first of them.
pub(crate) fn refuse_unknown<'p>(
    rows: impl Iterator<Item = &'p Parameters> + Clone,
    main: &Path,
    cell: Option<&Path>,
    checking: &Checking,
) -> Result<(), Failure> {
    if rows.clone().next().is_none() || rows.clone().any(|row| row.globals().next().is_none()) {
        return Ok(());
    }
    let known = settable(main, cell, checking)?;
    let unknown = |row: &'p Parameters| row.globals().find(|name| !is_known(name, &known));
    // One good row is enough to accept the table.
    if !rows.clone().all(|row| unknown(row).is_some()) {
        return Ok(());
    }
    rows.clone().find_map(unknown).map_or(Ok(()), |name| Err(Failure::Usage(no_such_variable(name, &known))))
}

fn is_known(name: &str, known: &[(String, String)]) -> bool {
    let (file, own) = name.rsplit_once("::").map_or((None, name), |(file, own)| (Some(file), own));
    known.iter().any(|(of, it)| it.eq_ignore_ascii_case(own) && file.is_none_or(|file| file.eq_ignore_ascii_case(of)))
}

fn no_such_variable(name: &str, known: &[(String, String)]) -> String {
    let names: Vec<&str> = known.iter().map(|(_, name)| name.as_str()).collect();
    let near = if names.is_empty() { "the program has none".to_owned() } else { hint_of_many(name, &names) };
    format!("there is no global variable `{name}`: {near}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use arl_terminal::private_folder::PrivateFolder;

    fn checking() -> Checking {
        Checking { strict: false, background: false, robot: None, cell: None, script_dir: None, verbose: false }
    }

    fn pick() -> PrivateFolder {
        let folder = PrivateFolder::new("arl2rs-variables-").unwrap();
        let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
        let main = "import \"pick_grip.arl\"\nconst int MANY = 3\npose place[2] = {{x 1}, {x 2}}\n\
                    func void main()\n    print MANY, place[0].x, feeder.x\nendfunc\n";
        write("pick.arl", main);
        write("pick_data.arl", "pose feeder = {x 900, y -500, z 400, a 0, b 180, c 0}\nstring name = \"a\"\n");
        write("pick_grip.arl", "bool held\n");
        folder
    }

    #[test]
    fn variables_have_their_declarations() {
        let folder = pick();
        let all = of_program(&folder.path().join("pick.arl"), &checking()).unwrap();
        let shown: Vec<_> = all
            .iter()
            .map(|it| (it.name.as_str(), it.file.as_str(), it.line, it.ty.as_str(), &it.sizes[..], it.constant))
            .collect();
        assert_eq!(
            shown,
            [
                ("MANY", "pick.arl", 2, "int", &[][..], true),
                ("place", "pick.arl", 3, "pose", &[2][..], false),
                ("feeder", "pick_data.arl", 1, "pose", &[][..], false),
                ("name", "pick_data.arl", 2, "string", &[][..], false),
                ("held", "pick_grip.arl", 1, "bool", &[][..], false),
            ]
        );
        let [many, place, feeder, name, held] = &all[..] else { panic!("{all:?}") };
        assert_eq!(many.first.as_deref(), Some("3"));
        assert_eq!(feeder.first.as_deref(), Some("{x 900, y -500, z 400, a 0, b 180, c 0}"));
        assert_eq!(
            (&place.numbers[..2], &place.numbers[6..8]),
            (&[".x".to_owned(), ".y".into()][..], &[".cfg".to_owned(), ".turn".into()][..])
        );
        assert_eq!((name.numbers.len(), &held.numbers[..], held.first.as_deref()), (0, &[String::new()][..], None));
    }

    #[test]
    fn a_table_of_slips_is_refused_with_what_is_near() {
        let folder = pick();
        let main = folder.path().join("pick.arl");
        let refused = |rows: &[&str]| {
            let rows: Vec<Parameters> = rows.iter().map(|row| serde_json::from_str(row).unwrap()).collect();
            match refuse_unknown(rows.iter(), &main, None, &checking()) {
                Err(Failure::Usage(text)) => Some(text),
                Err(other) => panic!("{other:?}"),
                Ok(()) => None,
            }
        };
        let text = refused(&[r#"{"global.feder":1}"#, r#"{"global.feder":2}"#]).unwrap();
        assert_eq!(text, "there is no global variable `feder`: did you mean `feeder`?");
        assert!(refused(&[r#"{"global.xyzzy":1}"#]).unwrap().contains("there are MANY, place, feeder, name, held"));
        assert_eq!(refused(&[r#"{"global.feder":1}"#, r#"{"global.FEEDER":2}"#]), None);
        assert_eq!(refused(&[r#"{"global.pick_data::feeder":1}"#]), None);
        assert!(refused(&[r#"{"global.pick::feeder":1}"#]).is_some());
        assert_eq!(refused(&[r#"{"override":50}"#, r#"{"global.feder":1}"#]), None);
        assert_eq!(refused(&[]), None);
    }
}
