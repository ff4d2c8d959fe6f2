//! `arl2rs explain` and `arl2rs doc`

use arl_lang::near::nearest;
use arl_terminal::failure::Failure;
use arl2rs::diagnostics::{Code, info, registry};
use arl2rs::{alarms, reference};

/// The first number of an alarm.
const FIRST_ALARM: u32 = 10_000;

/// The page of a diagnostic (`ARL0203`, `arl203` or `203`) or of an alarm (`20003`).
pub(crate) fn explain(code: &str) -> Result<String, Failure> {
    let digits = code.trim().to_ascii_uppercase();
    match digits.strip_prefix("ARL").unwrap_or(&digits).parse::<u32>() {
        Ok(number) if number >= FIRST_ALARM => alarm(&number.to_string()),
        Ok(number) => diagnostic(number),
        Err(_) => Err(Failure::Usage(format!(
            "`{code}` is not a code: diagnostics have codes like ARL0203, alarms numbers like 20003"
        ))),
    }
}

fn diagnostic(number: u32) -> Result<String, Failure> {
    let code = Code(u16::try_from(number).unwrap_or(u16::MAX));
    if let Some(info) = info(code) {
        return Ok(info.page.to_string());
    }
    let names: Vec<String> = registry().iter().map(|info| info.code.to_string()).collect();
    Err(unknown("diagnostic", &code.to_string(), names.iter().map(String::as_str)))
}

fn alarm(number: &str) -> Result<String, Failure> {
    match alarms::all().find(|alarm| alarm.number == number) {
        Some(alarm) => Ok(alarm.page()),
        None => Err(unknown("alarm", number, alarms::all().map(|alarm| alarm.number))),
    }
}

fn unknown<'a>(what: &str, name: &str, known: impl Iterator<Item = &'a str>) -> Failure {
    let hint = nearest(name, known).map(|near| format!("; did you mean {near}?")).unwrap_or_default();
    Failure::Usage(format!("there is no {what} {name}{hint}"))
}

/// The pages of a name; without a name, the list of pages; with words, the pages that contain them.
pub(crate) fn doc(name: Option<&str>, search: &[String]) -> Result<String, Failure> {
    if !search.is_empty() {
        let nothing = || Failure::Usage(format!("no page has all of these words: {}", search.join(" ")));
        return reference::search(search).ok_or_else(nothing);
    }
    let Some(name) = name else { return Ok(reference::list()) };
    reference::page(name).ok_or_else(|| {
        let hint = match reference::suggestion(name) {
            Some(near) => format!("; did you mean `{near}`?"),
            None => format!("; `arl2rs doc` lists all pages, `arl2rs doc --search {name}` searches them"),
        };
        Failure::Usage(format!("no page is called `{name}`{hint}"))
    })
}
