//! Errors as exceptions; the Python side turns them into those of the package.

use arl_library::LoadError;
use arl2rs_cli::host::HostError;
use pyo3::create_exception;
use pyo3::exceptions::PyException;
use pyo3::prelude::*;

create_exception!(_arl2rs, Mistakes, PyException, "A program has mistakes: JSON objects.");
create_exception!(_arl2rs, Refused, PyException, "What is asked for is not possible; why.");
create_exception!(_arl2rs, Failed, PyException, "Something around the compiler went wrong; what.");
create_exception!(_arl2rs, Gone, PyException, "A session is not available to the caller; why.");

pub(crate) fn of_host(error: HostError) -> PyErr {
    match error {
        HostError::Mistakes(all) => Mistakes::new_err(all),
        HostError::Usage(text) => Refused::new_err(text),
        other => Failed::new_err(other.to_string()),
    }
}

pub(crate) fn of_library(error: LoadError) -> PyErr {
    match error {
        LoadError::Refused(text) => Refused::new_err(text),
        // It cannot be loaded: there was never a session.
        other @ (LoadError::Open(_) | LoadError::NotOurs | LoadError::Version(_)) => Failed::new_err(other.to_string()),
        other => Gone::new_err(other.to_string()),
    }
}
