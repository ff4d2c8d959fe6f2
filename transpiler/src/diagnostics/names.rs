//! Names that are unknown or ambiguous.

use super::Problem;
use super::declare::problems;
use arl_lang::elsewhere;
use arl_lang::other_motions::OtherMotion;

problems! {
    /// What is wrong with a name.
    pub(crate) enum NameProblem {
        error 201 "A variable that is not known" => {
            /// No variable or constant of this name.
            /// `quoted`: the string that is probably meant; `ty`: a type that would fit.
            UnknownVariable { name: String, near: Option<String>, is_function: bool, quoted: Option<String>, ty: String },
            /// The name of a module used as a variable.
            IsModule { name: String },
        }
        error 202 "A function that is not known" => {
            /// No function of this name.
            UnknownFunction {
                name: String,
                near: Option<String>,
                is_instruction: bool,
                /// The motion that the call means in another language.
                motion: Option<OtherMotion>,
            },
        }
        error 203 "A module or enumeration that is not known" => {
            /// Neither a module nor an enumeration.
            UnknownModule { name: String, looked: String },
        }
        error 204 "A type that is not known" => {
            /// No type of this name.
            UnknownType { name: String, near: Option<String> },
        }
        error 205 "A name declared twice in one scope" => {
            /// Declared before in the same scope.
            Duplicate { name: String, what: &'static str },
        }
        error 206 "A global variable used above its declaration" => {
            /// A global variable that is declared further down.
            VariableBelow { name: String },
        }
        error 207 "A function called above its definition" => {
            /// A function that is defined further down.
            FunctionBelow { name: String, calls_back: bool },
        }
        error 208 "A component that the structure does not have" => {
            /// A structure has no such component.
            UnknownComponent { name: String, ty: String, components: String, near: Option<String> },
        }
        error 209 "A system variable that is not known" => {
            /// No system variable of this name.
            /// `elements`: the elements of an array that have such names.
            UnknownSystem { name: String, near: Option<String>, elements: Option<String> },
        }
        error 210 "A constant that the enumeration does not have" => {
            /// An enumeration has no such constant.
            UnknownConstant { name: String, ty: String, constants: String },
        }
        error 211 "An instruction that is not known" => {
            /// No instruction of this name.
            UnknownInstruction { name: String, near: Option<String>, is_function: bool },
        }
        error 212 "A label that the function does not have" => {
            /// `goto` to a label that the function does not have.
            UnknownLabel { name: String, near: Option<String> },
        }
        error 213 "A name that the module does not have" => {
            /// A module has no such variable or function.
            NotInModule { name: String, module: String, what: &'static str, near: Option<String> },
        }
        error 214 "An old or misprinted name" => {
            /// A spelling from other manuals that is not accepted.
            Renamed { name: String, now: String },
        }
        error 215 "The name of a signal in a program" => {
            /// The cell's name for a signal; programs use its number.
            SignalName { name: String, signal: String, channel: u32 },
        }
    }
}

impl Problem for NameProblem {
    fn message(&self) -> String {
        match self {
            NameProblem::IsModule { name } => format!("`{name}` is a module, not a variable"),
            NameProblem::UnknownVariable { name, .. } | NameProblem::SignalName { name, .. } => {
                format!("there is no variable `{name}` here")
            }
            NameProblem::UnknownFunction { name, .. } => format!("there is no function `{name}`"),
            NameProblem::UnknownModule { name, .. } => format!("there is no module or enumeration `{name}`"),
            NameProblem::UnknownType { name, .. } => format!("there is no type `{name}`"),
            NameProblem::Duplicate { name, what } => format!("the {what} `{name}` is declared twice"),
            NameProblem::VariableBelow { name } => format!("the variable `{name}` is used above its declaration"),
            NameProblem::FunctionBelow { name, .. } => format!("the function `{name}` is called above its definition"),
            NameProblem::UnknownComponent { name, ty, .. } => format!("a `{ty}` has no component `{name}`"),
            NameProblem::UnknownSystem { name, .. } => format!("there is no system variable `${name}`"),
            NameProblem::UnknownConstant { name, ty, .. } => format!("`{ty}` has no constant `{name}`"),
            NameProblem::UnknownInstruction { name, .. } => format!("there is no instruction `{name}`"),
            NameProblem::UnknownLabel { name, .. } => format!("this function has no label `{name}`"),
            NameProblem::NotInModule { name, module, what, .. } => {
                format!("the module `{module}` has no {what} `{name}`")
            }
            NameProblem::Renamed { name, .. } => format!("`{name}` is not a name that ARL knows"),
        }
    }

    fn label(&self) -> String {
        match self {
            NameProblem::Duplicate { .. } => "declared again here".into(),
            NameProblem::VariableBelow { .. } | NameProblem::FunctionBelow { .. } => "not known yet here".into(),
            NameProblem::IsModule { .. } => "a module".into(),
            _ => "not known".into(),
        }
    }

    fn help(&self) -> Option<String> {
        let meant = |near: &Option<String>| near.as_ref().map(|near| format!("did you mean `{near}`?"));
        let has = |ours: &str| format!("ARL has {ours}");
        match self {
            NameProblem::UnknownVariable { name, is_function: true, .. } => {
                Some(format!("`{name}` is a function: call it with parentheses, `{name}(...)`"))
            }
            NameProblem::UnknownVariable { quoted: Some(text), .. } => {
                Some(format!("a text, such as the name of a file or of a point, is written in quotes: `\"{text}\"`"))
            }
            NameProblem::UnknownVariable { near, name, ty, .. } => {
                let word = elsewhere::argument_word(name).map(has);
                let other = || elsewhere::argument(name).map(has);
                let declare = || Some(format!("declare it first, for example `{ty} {name}`"));
                word.or_else(|| meant(near)).or_else(other).or_else(declare)
            }
            NameProblem::UnknownFunction { name, is_instruction: true, .. } => {
                Some(format!("`{name}` is an instruction: write its arguments without parentheses around them"))
            }
            NameProblem::UnknownType { near, name } => meant(near).or_else(|| {
                let of_others = |ours| format!("`{name}` of other languages is called `{ours}` here");
                elsewhere::type_of(name).map(of_others).or_else(|| elsewhere::word(name).map(has))
            }),
            NameProblem::UnknownFunction { motion: Some(motion), .. } => {
                let OtherMotion { language, ours } = motion;
                Some(format!("this is {language}; write `{ours}`: {}", arl_lang::OTHER_MOTIONS.trim_end_matches('.')))
            }
            NameProblem::UnknownFunction { near, name, .. } => {
                // A match in an imported module was surely meant.
                let member = meant(near).filter(|_| near.as_ref().is_some_and(|near| near.contains("::")));
                let operator = elsewhere::operator(name).map(|ours| format!("ARL writes `{ours}` for this"));
                member.or(operator).or_else(|| elsewhere::word(name).map(has)).or_else(|| meant(near))
            }
            NameProblem::UnknownLabel { near, .. } | NameProblem::NotInModule { near, .. } => meant(near),
            NameProblem::UnknownSystem { elements: Some(elements), .. } => Some(format!("there are {elements}")),
            NameProblem::UnknownSystem { name, near, .. } => {
                let near = near.as_ref().map(|near| format!("did you mean `${near}`?"));
                elsewhere::system(name).map(has).or(near)
            }
            NameProblem::UnknownModule { looked, .. } => {
                Some(format!("looked for {looked}; a module in another folder needs an `import` line"))
            }
            NameProblem::Duplicate { .. } => Some("give one of them another name (case makes no difference)".into()),
            NameProblem::VariableBelow { .. } => {
                Some("a global variable is only known below its declaration: move the declaration up".into())
            }
            NameProblem::FunctionBelow { calls_back: false, .. } => {
                Some("a function must be defined above its first call: move the definition up".into())
            }
            NameProblem::FunctionBelow { .. } => {
                let why = "a function must be defined above its first call in its file";
                Some(format!("{why}: of two that call each other, one has to go to another file"))
            }
            NameProblem::UnknownComponent { near, components, .. } => {
                meant(near).or_else(|| Some(format!("its components are {components}")))
            }
            NameProblem::UnknownConstant { constants, .. } => Some(format!("its constants are {constants}")),
            NameProblem::UnknownInstruction { name, is_function: true, .. } => {
                Some(format!("`{name}` is a function: put its arguments in parentheses, `{name}(...)`"))
            }
            NameProblem::UnknownInstruction { near, name, .. } => {
                elsewhere::word(name).map(has).or_else(|| meant(near))
            }
            NameProblem::IsModule { name } => {
                Some(format!("the members of a module are written after two colons, `{name}::...`"))
            }
            NameProblem::SignalName { name, signal, channel } => Some(format!(
                "that is the cell's name for {signal}; a program uses its number: `const int {name} = {channel}`"
            )),
            NameProblem::Renamed { now, .. } => Some(format!("did you mean `{now}`?")),
        }
    }

    fn fix(&self) -> Option<String> {
        match self {
            NameProblem::UnknownVariable { is_function: true, .. }
            | NameProblem::UnknownVariable { quoted: Some(_), .. }
            | NameProblem::UnknownFunction { is_instruction: true, .. }
            | NameProblem::UnknownInstruction { is_function: true, .. } => None,
            NameProblem::UnknownType { near, name } => {
                near.clone().or_else(|| elsewhere::type_of(name).map(Into::into))
            }
            NameProblem::UnknownFunction { near: Some(near), .. } if near.contains("::") => Some(near.clone()),
            NameProblem::UnknownFunction { name, .. } | NameProblem::UnknownInstruction { name, .. }
                if elsewhere::word(name).is_some() || elsewhere::operator(name).is_some() =>
            {
                None
            }
            NameProblem::UnknownVariable { near, .. }
            | NameProblem::UnknownFunction { near, .. }
            | NameProblem::UnknownComponent { near, .. }
            | NameProblem::UnknownInstruction { near, .. }
            | NameProblem::UnknownLabel { near, .. }
            | NameProblem::NotInModule { near, .. } => near.clone(),
            NameProblem::UnknownSystem { name, elements, .. }
                if elements.is_some() || elsewhere::system(name).is_some() =>
            {
                None
            }
            NameProblem::UnknownSystem { near, .. } => near.as_ref().map(|near| format!("${near}")),
            NameProblem::Renamed { now, .. } => Some(now.clone()),
            _ => None,
        }
    }
}
