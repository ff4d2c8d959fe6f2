//! The part of the package `arl2rs` that is Rust: what the command and the libraries of programs do, for its Python side.

mod farm;
mod problem;
mod session;

use std::ffi::OsString;
use std::path::PathBuf;

use arl2rs::cli::host::{self, Settings};
use pyo3::prelude::*;

#[pymodule]
mod _arl2rs {
    #[pymodule_export]
    use super::farm::{Bundle, Kept, Worker, lost, row, sweep, table};
    #[pymodule_export]
    use super::problem::{Mistakes, Refused};
    #[pymodule_export]
    use super::session::{Library, Session};
    #[pymodule_export]
    use super::{check, command, literal, words};
}

/// What is run, of what Python says.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Given {
    program: PathBuf,
    robot: Option<String>,
    cell: Option<PathBuf>,
    io: Option<PathBuf>,
    script_dir: Option<PathBuf>,
    files: Vec<PathBuf>,
    max_time: Option<f64>,
    timeout: Option<f64>,
}

impl From<Given> for Settings {
    fn from(given: Given) -> Self {
        let Given { program, robot, cell, io, script_dir, files, max_time, timeout } = given;
        Self { program, robot, cell, io, script_dir, files, max_time, timeout }
    }
}

/// What there is to say of programs, a JSON object each.
#[pyfunction]
fn check(py: Python<'_>, files: Vec<PathBuf>, given: Given, strict: bool, background: bool) -> PyResult<Vec<String>> {
    let settings = given.into();
    py.detach(|| host::check(&files, &settings, (strict, background))).map_err(problem::of_host)
}

/// The words of parameters, which are JSON.
#[pyfunction]
fn words(parameters: &str) -> PyResult<Vec<String>> {
    farm::parameters(parameters)?.words().map_err(problem::Refused::new_err)
}

/// A value, which is JSON, as a literal of ARL.
#[pyfunction]
fn literal(value: &str) -> PyResult<String> {
    let value = farm::read(value)?;
    host::as_arl(&value).ok_or_else(|| problem::Refused::new_err("None is no value of ARL"))
}

/// Does what these words say, as the command does; gives its exit code.
#[pyfunction]
fn command(py: Python<'_>, words: Vec<OsString>) -> u8 {
    py.detach(|| arl2rs::cli::command(words))
}
