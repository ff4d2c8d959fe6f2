//! `arl2rs explain` and `arl2rs doc`

use super::failure::Failure;
use crate::diagnostics::{Code, info, registry};
use crate::near::nearest;
use arl_lang::catalog;

/// The page of a code: `ARL0203`, `arl203` or `203`.
pub(super) fn explain(code: &str) -> Result<String, Failure> {
    let digits = code.trim().to_ascii_uppercase();
    let number = digits.strip_prefix("ARL").unwrap_or(&digits).parse().ok().map(Code);
    let Some(code) = number else {
        return Err(Failure::Usage(format!("`{code}` is no code of a diagnostic; codes look like ARL0203")));
    };
    match info(code) {
        Some(info) => Ok(info.page.to_string()),
        None => {
            let name = code.to_string();
            let names: Vec<String> = registry().iter().map(|info| info.code.to_string()).collect();
            let near = nearest(&name, names.iter().map(String::as_str));
            let hint = near.map(|near| format!("; did you mean {near}?")).unwrap_or_default();
            Err(Failure::Usage(format!("there is no diagnostic {name}{hint}")))
        }
    }
}

/// The reference of something built in.
pub(super) fn doc(name: &str) -> Result<String, Failure> {
    catalog::reference::page(name).ok_or_else(|| {
        let entries = catalog::all_entries().iter().map(|entry| entry.name);
        let variables = catalog::system_variables().map(|variable| variable.name);
        let types = catalog::type_names().map(|(name, _)| name);
        let near = nearest(name, entries.chain(variables).chain(types));
        let hint = near.map(|near| format!("; did you mean `{near}`?")).unwrap_or_default();
        Failure::Usage(format!("nothing that is built in is called `{name}`{hint}"))
    })
}
