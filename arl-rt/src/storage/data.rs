//! Data files: `_data.arl` files, whose points may have been taught again, are read again when a program is loaded.

pub(crate) use crate::values::Teach;

use std::collections::HashMap;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use arl_lang::ast::{Decl, Item, Var};
use arl_lang::span::Span;
use arl_lang::symbol::Interner;
use arl_robot::regular_file;

use crate::fault::{Alarm, Fault, File};
use crate::values::teach_variable;

/// A data file and the variables that it gives values to.
pub struct DataFile<'a> {
    /// The name of the file when the program was compiled.
    pub file: &'static str,
    /// Its variables.
    pub vars: Vec<DataVar<'a>>,
}

/// A variable of a data file.
pub struct DataVar<'a> {
    /// Its name as it was declared.
    pub name: &'static str,
    /// The sizes of an array of several dimensions, outermost first; otherwise empty.
    pub sizes: &'static [usize],
    /// The variable.
    pub slot: &'a dyn Teach,
}

/// Reads data files in the folder of their program again and gives their variables the values found there. Without the
/// file, the compiled values stay. Errors are returned as alarms; the variables concerned keep their values.
pub(crate) fn reload(files: &[DataFile<'_>], folder: &Path) -> Vec<Alarm> {
    files.iter().flat_map(|data| file(data, folder)).collect()
}

fn file(data: &DataFile<'_>, folder: &Path) -> Vec<Alarm> {
    let alarm = |line: u32, text: String| Alarm::new(Fault::Data(text.into()), File::new(data.file), line);
    let Some((path, content)) = read(data.file, folder) else { return Vec::new() };
    let content = match content {
        Ok(content) => content,
        Err(error) => return vec![alarm(0, format!("{} cannot be read: {error}", path.display()))],
    };
    teach_file(data, &content)
}

/// Gives the variables of a data file the values in `content`. Errors are returned as alarms; the variables concerned
/// keep their values.
pub(crate) fn teach_file(data: &DataFile<'_>, content: &[u8]) -> Vec<Alarm> {
    let alarm = |line: u32, text: String| Alarm::new(Fault::Data(text.into()), File::new(data.file), line);
    let text = match arl_lang::text::decode(content) {
        Ok(text) => text,
        Err(error) => return vec![alarm(0, error.to_string())],
    };
    let mut names = Interner::default();
    let parsed = arl_lang::parse(&text, &mut names, arl_lang::ParseOptions::default());
    if !parsed.errors.is_empty() {
        return parsed.errors.iter().map(|error| alarm(line(&text, error.span), error.kind.message())).collect();
    }
    let declared: HashMap<String, (&Decl, &Var)> = parsed
        .file
        .items
        .iter()
        .filter_map(|item| match item {
            Item::Global(decl) => Some(decl),
            _ => None,
        })
        .flat_map(|decl| decl.vars.iter().map(move |var| (decl, var)))
        // Of two declarations with one name the first counts.
        .rev()
        .map(|(decl, var)| (names.name(var.name.symbol).to_ascii_lowercase(), (decl, var)))
        .collect();
    data.vars
        .iter()
        .filter_map(|wanted| teach(wanted, &declared, &names).err())
        .map(|(span, problem)| alarm(span.map_or(0, |span| line(&text, span)), problem))
        .collect()
}

/// Gives one variable its value.
fn teach(
    wanted: &DataVar<'_>,
    declared: &HashMap<String, (&Decl, &Var)>,
    names: &Interner,
) -> Result<(), (Option<Span>, String)> {
    let name = wanted.name;
    let Some((decl, var)) = declared.get(&name.to_ascii_lowercase()) else {
        return Err((
            None,
            format!("the program needs {} {name}, which is no longer declared here", wanted.slot.type_name()),
        ));
    };
    teach_variable(wanted.slot, wanted.sizes, &decl.ty, var, names)
        .map_err(|error| (Some(error.span), format!("{name}: {error}")))
}

/// The possible paths of a data file: its own path if that is absolute, otherwise the path in the folder of its
/// program; in that folder also its bare name.
pub(crate) fn places(name: &str, folder: &Path) -> impl Iterator<Item = PathBuf> + use<> {
    let path = Path::new(name);
    let bare = path.file_name().map(|bare| folder.join(bare));
    // Joining an absolute path gives that path.
    [Some(folder.join(path)), bare].into_iter().flatten()
}

/// The first of these paths at which a file exists.
pub(crate) fn place(mut places: impl Iterator<Item = PathBuf>) -> Option<PathBuf> {
    places.find(|path| path.is_file())
}

/// The content of a data file, and its path.
fn read(name: &str, folder: &Path) -> Option<(PathBuf, std::io::Result<Vec<u8>>)> {
    for place in places(name, folder) {
        match regular_file::read(&place) {
            Err(error) if matches!(error.kind(), ErrorKind::NotFound | ErrorKind::NotADirectory) => {}
            content => return Some((place, content)),
        }
    }
    None
}

/// The line at which a span begins, from 1.
fn line(text: &str, span: Span) -> u32 {
    let before = text.as_bytes().get(..span.start as usize).unwrap_or(text.as_bytes());
    let feeds = before.iter().filter(|byte| **byte == b'\n').count();
    let lone_returns = before.iter().zip(before.iter().skip(1)).filter(|(a, b)| **a == b'\r' && **b != b'\n').count();
    (feeds + lone_returns) as u32 + 1
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::cell::Cell;

    use crate::values::{Joint, Shared, SmallArray, Str};

    struct Points {
        home: Cell<Joint>,
        count: Cell<i32>,
        table: Shared<SmallArray<f64, 4>>,
        title: Shared<Str>,
    }

    impl Points {
        fn data(&self) -> Vec<DataFile<'_>> {
            let vars = vec![
                DataVar { name: "home", sizes: &[], slot: &self.home },
                DataVar { name: "count", sizes: &[], slot: &self.count },
                DataVar { name: "table", sizes: &[2, 2], slot: &self.table },
                DataVar { name: "title", sizes: &[], slot: &self.title },
            ];
            vec![DataFile { file: "p_data.arl", vars }]
        }
    }

    fn reloaded(name: &str, text: &[u8]) -> (Points, Vec<String>) {
        let folder = std::env::temp_dir().join(format!("arl-rt-data-{name}-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        std::fs::write(folder.join("p_data.arl"), text).unwrap();
        let points =
            Points { home: Cell::default(), count: Cell::new(7), table: Shared::default(), title: Shared::default() };
        let alarms = reload(&points.data(), &folder).iter().map(ToString::to_string).collect();
        std::fs::remove_dir_all(&folder).unwrap();
        (points, alarms)
    }

    #[test]
    fn values_come_from_the_file() {
        let text =
            b"joint HOME = {j1 1.5,j3 -2}\nint count = 3\ndouble table[2][2] = {{1,2},{3,4}}\nstring title = \"t\"\n";
        let (points, alarms) = reloaded("good", text);
        assert_eq!(alarms, [""; 0]);
        assert_eq!(points.home.get(), Joint { j1: 1.5, j3: -2.0, ..Joint::default() });
        assert_eq!(points.count.get(), 3);
        assert_eq!(*points.table.get(), [1.0, 2.0, 3.0, 4.0]);
        assert_eq!(points.title.get(), "t");
    }

    #[test]
    fn a_file_that_is_not_there_changes_nothing() {
        let points =
            Points { home: Cell::default(), count: Cell::new(7), table: Shared::default(), title: Shared::default() };
        assert_eq!(reload(&points.data(), Path::new("/nowhere/at/all")), []);
        assert_eq!(points.count.get(), 7);
    }

    #[test]
    fn mistakes_are_alarms_with_file_and_line() {
        let (points, alarms) = reloaded(
            "wrong",
            b"joint home = {j1 1.5}\r\nint count = \"many\"\r\ndouble table[3] = {1}\r\n// title is gone\r\n",
        );
        assert_eq!(points.home.get().j1, 1.5);
        assert_eq!(points.count.get(), 7, "it stays as it was");
        assert_eq!(alarms.len(), 3, "{alarms:?}");
        for (alarm, (place, word)) in
            alarms.iter().zip([("(p_data.arl:2)", "count"), ("(p_data.arl:3)", "table"), ("(p_data.arl:0)", "title")])
        {
            assert!(alarm.starts_with("alarm 20030: ") && alarm.ends_with(place) && alarm.contains(word), "{alarm}");
        }
    }

    #[test]
    fn a_file_that_does_not_parse_is_an_alarm() {
        let (_, alarms) = reloaded("broken", b"joint home = {j1 1.5\n\nint count = = 3\n");
        assert!(!alarms.is_empty() && alarms.iter().any(|alarm| alarm.contains("p_data.arl:3")), "{alarms:?}");
        let (_, alarms) = reloaded("bytes", b"int count = \xff\xff\xff\n");
        assert_eq!(alarms.len(), 1, "{alarms:?}");
    }
}
