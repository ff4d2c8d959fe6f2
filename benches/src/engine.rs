//! Programs of the benches on the engine.

use std::path::Path;

use crate::run::{Run, run};
use arl_engine::Engine;
use arl_rt::Program;
use arl2rs::{CheckOptions, SourceError, Sources};

/// A program that is one text.
struct Text<'a>(&'a str);

const NAME: &str = "program.arl";

impl Sources for Text<'_> {
    fn read(&self, path: &Path) -> Result<Vec<u8>, SourceError> {
        if path == Path::new(NAME) { Ok(self.0.as_bytes().to_vec()) } else { Err(SourceError::Missing) }
    }
}

/// Makes the engine of a program.
///
/// # Errors
/// The program has mistakes, or is too large.
pub fn engine(text: &str) -> Result<Engine, String> {
    let checked = arl2rs::check(Path::new(NAME), &Text(text), &CheckOptions::default());
    let program = checked.program.ok_or("the program has mistakes")?;
    let code = arl2rs::lower::lower(&program).map_err(|problem| problem.to_string())?;
    Ok(Engine::new(code))
}

/// Runs a function of a program with an argument, in place of all that its `main` does; the checksum is what the
/// function gives, as `print` shows it.
///
/// # Errors
/// The program has mistakes, or ended otherwise than by itself.
pub fn run_function(text: &str, call: &str) -> Result<Run, String> {
    let (before, _) = text.split_once("func void main()").ok_or("the program has no main")?;
    let engine = engine(&format!("{before}func void main()\n  {call}\nendfunc\n"))?;
    run(engine, |cx, engine| {
        Box::pin(async {
            engine.main(cx).await?;
            Ok(0.0)
        })
    })
}

/// The text of a program of the benches.
///
/// # Errors
/// It cannot be read.
pub fn program(file: &str) -> Result<String, String> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(file);
    std::fs::read_to_string(&path).map_err(|error| format!("{}: {error}", path.display()))
}
