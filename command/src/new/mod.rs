//! `arl2rs new`: a folder with a working program, its cell, a scenario and its expected output.

use arl_lang::files::is_data;
use arl_terminal::answer;
use arl_terminal::failure::Failure;
use arl2rs::check::clean;
use std::path::Path;

/// The placeholder for the program's name in the files and their names.
const NAME: &str = "PROGRAM";

/// The files: name and text.
const FILES: [(&str, &str); 7] = [
    ("PROGRAM.arl", include_str!("template/program.arl")),
    ("PROGRAM_data.arl", include_str!("template/points.arl")),
    ("PROGRAM.io.toml", include_str!("template/scenario.toml")),
    ("PROGRAM.out", include_str!("template/printed.txt")),
    ("arl.toml", include_str!("template/arl.toml")),
    ("cell.toml", include_str!("template/cell.toml")),
    (".gitignore", ".arl-state/\n"),
];

/// Makes the folder, and prints what can be done in it.
pub(crate) fn new(folder: &Path) -> Result<(), Failure> {
    let full = std::path::absolute(folder).map_err(|error| Failure::io("use", folder, &error))?;
    let name = clean(&full).file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    check_name(&name)?;
    let is_empty = std::fs::read_dir(folder).map(|mut entries| entries.next().is_none());
    if folder.exists() && !is_empty.unwrap_or(false) {
        return Err(Failure::Usage(format!("{} already exists and is not empty", folder.display())));
    }
    std::fs::create_dir_all(folder).map_err(|error| Failure::io("make the folder", folder, &error))?;
    for (file, text) in FILES {
        let path = folder.join(file.replace(NAME, &name));
        std::fs::write(&path, text.replace(NAME, &name)).map_err(|error| Failure::io("write", &path, &error))?;
    }
    let commands = [
        (format!("run {name}.arl"), "runs it on a simulated robot".to_owned()),
        (format!("run {name}.arl --pendant"), "runs it in real time, with a pendant in the terminal".to_owned()),
        (format!("check {name}.arl"), "finds mistakes".to_owned()),
        ("test .".to_owned(), format!("compares what it prints with {name}.out")),
    ];
    let width = commands.iter().map(|(command, _)| command.len()).max().unwrap_or(0);
    let lines = commands.iter().map(|(command, what)| format!("  arl2rs {command:width$}   {what}\n"));
    let lines: String = lines.collect();
    let folder = folder.display();
    answer::write(&format!("{folder} has a program, its points, a cell and a scenario. In that folder:\n\n{lines}"))
}

/// Checks that a program can have this name.
fn check_name(name: &str) -> Result<(), Failure> {
    let wrong = |why: &str| Err(Failure::Usage(format!("a program cannot be called `{name}`: {why}")));
    let mut letters = name.chars();
    let begins = letters.next().is_some_and(|first| first.is_ascii_alphabetic());
    if !begins || !letters.all(|letter| letter.is_ascii_alphanumeric() || letter == '_') {
        return wrong("a name has letters, digits and `_`, and begins with a letter");
    }
    if arl_lang::is_reserved(name) {
        return wrong("it is a word of the language");
    }
    if ["arl", "cell"].contains(&name.to_ascii_lowercase().as_str()) {
        return wrong("a settings file with this name has another meaning");
    }
    if is_data(Path::new(name)) {
        return wrong("names that end in `_data` are those of data files");
    }
    Ok(())
}
