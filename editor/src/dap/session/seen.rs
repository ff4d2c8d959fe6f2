//! What expressions can refer to from a frame: the variables of its function and of its program, system variables,
//! signals.

use crate::dap::evaluate::{Source, Value as Found, Variable};
use crate::dap::literal::Literal;
use crate::dap::process::Process;
use crate::dap::program::global_constants;
use crate::dap::variables::{Container, Frame, Target};
use arl_lang::catalog::Family;
use arl2rs::hir::Program;
use serde_json::{Value, json};

/// A variable as the program reports it.
pub(super) struct ReportedVariable {
    pub(super) name: String,
    pub(super) ty: String,
    pub(super) value: String,
}

/// The context in which expressions are evaluated.
pub(super) struct Seen<'a> {
    pub(super) process: &'a mut Process,
    pub(super) program: &'a Program,
    pub(super) frame: Frame,
    pub(super) locals: Named,
    /// Clocks and connections.
    pub(super) handles: Vec<ReportedVariable>,
    pub(super) module: String,
}

impl ReportedVariable {
    /// What cannot be set, as the editor shows it.
    pub(super) fn shown(&self) -> Value {
        let Self { name, ty, value } = self;
        json!({"name": name, "value": value, "type": ty, "variablesReference": 0, "evaluateName": name})
    }

    /// As a variable for expressions: words that are not literals.
    fn as_variable(&self) -> Variable {
        Variable { ty: self.ty.clone(), value: Literal::Plain(self.value.clone()) }
    }
}

/// The variables of an answer, or its clocks and connections: the list with this name.
pub(super) fn reported(answer: &Value, list: &str) -> Vec<ReportedVariable> {
    let text = |value: &Value, key: &str| value.get(key).and_then(Value::as_str).unwrap_or_default().to_owned();
    let all = answer.get(list).and_then(Value::as_array).cloned().unwrap_or_default();
    all.iter()
        .map(|value| ReportedVariable {
            name: text(value, "name"),
            ty: text(value, "type"),
            value: text(value, "value"),
        })
        .collect()
}

/// A variable with its name. An array of several dimensions, which is reported flat, is in rows.
pub(super) fn variable(reported: ReportedVariable) -> (String, Variable) {
    let sizes = reported.ty.split('[').skip(1).filter_map(|size| size.trim_end_matches(']').parse().ok());
    let value = Literal::parse(&reported.value).in_rows(&sizes.collect::<Vec<usize>>());
    (reported.name, Variable { ty: reported.ty, value })
}

/// The global variables of a file, as the program reports them: the file, variables, clocks and connections.
type ReportedFile = (String, Vec<ReportedVariable>, Vec<ReportedVariable>);

/// Variables by their names.
type Named = Vec<(String, Variable)>;

impl Seen<'_> {
    fn all_files(&mut self) -> Result<Vec<ReportedFile>, String> {
        let answer = self.process.ask("globals", &[&self.frame.channel.to_string()])?;
        let files = answer.get("files").and_then(Value::as_array).cloned().unwrap_or_default();
        let name = |file: &Value| file.get("file").and_then(Value::as_str).unwrap_or_default().to_owned();
        Ok(files.iter().map(|file| (name(file), reported(file, "variables"), reported(file, "handles"))).collect())
    }

    /// The files that have global variables or constants.
    pub(super) fn files(&mut self) -> Result<Vec<String>, String> {
        let with_variables: Vec<String> = self.all_files()?.into_iter().map(|(file, ..)| file).collect();
        let modules = self.program.modules.iter().map(|module| module.file.clone());
        Ok(modules
            .filter(|file| with_variables.contains(file) || !global_constants(self.program, file).is_empty())
            .collect())
    }

    /// The variables of a file with its constants, and its clocks and connections.
    pub(super) fn of_file(&mut self, file: &str) -> Result<(Named, Vec<ReportedVariable>), String> {
        let reported = self.all_files()?.into_iter().find(|(known, ..)| known == file);
        let (_, all, handles) = reported.unwrap_or_default();
        let mut found: Named = all.into_iter().map(variable).collect();
        for (name, ty, value) in global_constants(self.program, file) {
            if !found.iter().any(|(known, _)| known.eq_ignore_ascii_case(&name)) {
                found.push((name, Variable { ty, value: Literal::parse(&value) }));
            }
        }
        Ok((found, handles))
    }

    pub(super) fn all_system(&mut self) -> Result<Named, String> {
        let answer = self.process.ask("system", &[&self.frame.channel.to_string()])?;
        Ok(reported(&answer, "variables").into_iter().map(variable).collect())
    }

    /// The file that declares what a name means here: in the module that is named, else in this file, else in its data
    /// file.
    pub(super) fn file_of(&self, module: Option<&str>, name: &str) -> Option<String> {
        let declares = |file: &str| {
            let at = self.program.modules.iter().position(|module| module.file == file);
            let mut all = self.program.globals.iter();
            all.any(|global| Some(global.module.0 as usize) == at && global.name.eq_ignore_ascii_case(name))
        };
        let mut files = self.program.modules.iter().filter(|known| match module {
            Some(module) => known.name.eq_ignore_ascii_case(module),
            None => known.file == self.module || known.data,
        });
        files.find(|known| declares(&known.file)).map(|known| known.file.clone())
    }

    /// A value with what its variable holds now: it may have been set since the editor was shown it.
    pub(super) fn now(&mut self, container: Container) -> Container {
        let Container::Value { frame, target, ty, value, path } = container else { return container };
        let whole = self.whole(&target).ok();
        let value = whole.and_then(|whole| whole.value.part(&path).cloned()).unwrap_or(value);
        Container::Value { frame, target, ty, value, path }
    }

    pub(super) fn whole(&mut self, target: &Target) -> Result<Variable, String> {
        match target {
            Target::Local(name) => {
                let found = self.locals.iter().find(|(known, _)| known == name);
                found.map(|(_, variable)| variable.clone()).ok_or_else(|| format!("there is no variable {name}"))
            }
            Target::Global(file, name) => {
                let (variables, _) = self.of_file(file)?;
                let found = variables.into_iter().find(|(known, _)| known.eq_ignore_ascii_case(name));
                found.map(|(_, variable)| variable).ok_or_else(|| format!("there is no variable {name}"))
            }
            Target::System(name) => self.system(name),
            Target::Nothing => Err("this is not a variable".into()),
        }
    }
}

impl Source for Seen<'_> {
    fn variable(&mut self, module: Option<&str>, name: &str) -> Result<Variable, String> {
        let is = |known: &str| known.eq_ignore_ascii_case(name);
        if module.is_none() {
            if let Some((_, variable)) = self.locals.iter().rev().find(|(known, _)| is(known)) {
                return Ok(variable.clone());
            }
            if let Some(handle) = self.handles.iter().find(|handle| is(&handle.name)) {
                return Ok(handle.as_variable());
            }
        }
        let missing = || format!("there is no variable {name} here");
        let file = self.file_of(module, name).ok_or_else(missing)?;
        let (variables, handles) = self.of_file(&file)?;
        let variable = variables.into_iter().find(|(known, _)| is(known)).map(|(_, variable)| variable);
        let handle = || handles.iter().find(|handle| is(&handle.name)).map(ReportedVariable::as_variable);
        variable.or_else(handle).ok_or_else(missing)
    }

    fn system(&mut self, name: &str) -> Result<Variable, String> {
        let wanted = format!("${name}");
        let all = self.all_system()?;
        let found = all.into_iter().find(|(name, _)| name.eq_ignore_ascii_case(&wanted));
        found.map(|(_, variable)| variable).ok_or_else(|| format!("there is no system variable {wanted}"))
    }

    fn signal(&mut self, kind: &str, number: i32) -> Result<Found, String> {
        let answer = self.process.ask("signals", &[])?;
        let at = usize::try_from(number).ok().and_then(|number| number.checked_sub(1));
        let missing = || format!("there is no {kind} {number}");
        match answer.get(kind) {
            Some(Value::String(levels)) => {
                let level = at.and_then(|at| levels.chars().nth(at)).ok_or_else(missing)?;
                Ok(Found::Bool(level == '1'))
            }
            Some(Value::Array(values)) => {
                let value = at.and_then(|at| values.get(at)).and_then(Value::as_f64).ok_or_else(missing)?;
                Ok(Found::Double(value))
            }
            _ => Err(missing()),
        }
    }

    fn call(&mut self, function: &str, arguments: &[String]) -> Result<Variable, String> {
        let channel = self.frame.channel.to_string();
        let mut values = vec![channel.as_str(), function];
        values.extend(arguments.iter().map(String::as_str));
        let answer = self.process.ask("call", &values)?;
        let text = |key: &str| answer.get(key).and_then(Value::as_str).unwrap_or_default();
        Ok(Variable { ty: text("type").to_owned(), value: Literal::parse(text("value")) })
    }

    fn family(&self) -> Family {
        self.program.family
    }
}
