//! Values of the wrong type, and things that cannot be written.

use super::Problem;
use super::declare::problems;

problems! {
    /// What is wrong with a type or value.
    pub(crate) enum TypeProblem {
        error 301 "A value of the wrong type" => {
            /// A value of one type where another is wanted.
            Mismatch { found: String, wanted: String, what: String, use_instead: Option<String> },
            /// Braces where a single value is wanted.
            BraceForValue { wanted: String },
        }
        error 302 "A constant that does not fit its type" => {
            /// A constant that the wanted type cannot hold.
            DoesNotFit { value: String, wanted: String, range: String },
        }
        error 303 "An operator on types that it does not work on" => {
            /// An operator that does not work on these types.
            Operator { operator: String, left: String, right: Option<String>, hint: Option<String> },
        }
        error 304 "An index on something that is not an array" => {
            /// Indexing something that is not an array.
            NotAnArray { ty: String },
        }
        error 305 "The wrong number of indices" => {
            /// Too many or too few indices.
            IndexCount { found: usize, wanted: usize },
        }
        error 306 "An index that is not an integer" => {
            /// An index that is not an integer.
            IndexType { found: String },
        }
        error 307 "A component of something that is not a structure" => {
            /// A component of something that has no components.
            NotAStructure { ty: String },
        }
        error 308 "Braces without a type" => {
            /// Braces at a place that does not determine their type.
            BraceWithoutType,
        }
        error 309 "Too many values in braces" => {
            /// More values than components or elements.
            TooManyValues { wanted: usize, ty: String },
        }
        error 310 "Named and unnamed values mixed in braces" => {
            /// Named and unnamed values in one pair of braces.
            MixedBraces,
        }
        error 311 "A component given twice" => {
            /// A component that is given twice.
            ComponentTwice { name: String },
        }
        error 312 "A const that is changed" => {
            /// Writing a const.
            AssignConst { name: String },
        }
        error 313 "Writing to something that is not a variable" => {
            /// Writing something that is not a variable.
            NotAssignable { text: String },
        }
        error 314 "A read-only system variable that is written" => {
            /// Writing a system variable that only the controller sets.
            ReadOnly { name: String },
        }
        error 315 "Structures or arrays compared" => {
            /// Comparing structures or arrays.
            Compare { ty: String },
        }
        error 316 "A handle that is copied" => {
            /// Copying a handle.
            HandleCopy { ty: String },
        }
        error 317 "A value taken from something that has none" => {
            /// Using the result of something that has none.
            NoValue { what: String },
        }
        error 318 "An array size that is not a positive constant" => {
            /// An array size that is not a positive constant.
            ArraySize,
        }
        error 319 "An array of more than 10000 elements" => {
            /// An array beyond 10 000 elements.
            ArrayTooLarge { len: u64 },
        }
        error 320 "An array of too many dimensions" => {
            /// More dimensions than supported.
            TooManyDimensions { most: usize },
        }
        error 321 "A const without a value" => {
            /// A const without a value.
            ConstWithoutValue { name: String },
        }
        error 322 "A variable of type void" => {
            /// A variable of type void.
            VoidVariable,
        }
        error 323 "A type of the other kind of robot" => {
            /// A type of the other robot family.
            OtherFamily { name: String, family: &'static str },
        }
        error 324 "A whole number that is too large for int" => {
            /// An int literal of 2^31 or more where no uint is wanted.
            WideLiteral { text: String },
        }
        error 325 "A Rust value of unknown ARL type" => {
            /// A spliced Rust value whose type is not known.
            SpliceType,
        }
        error 326 "An array and a value of another size" => {
            /// An array where a single value is wanted, or vice versa.
            Dimensions { found: String, wanted: String },
        }
        error 327 "Braces that do not fit the array" => {
            /// More rows in braces than the array has.
            TooManyRows { rows: usize },
            /// A single value between rows in braces.
            NotARow { row: usize },
        }
        error 328 "A result of a type that cannot be returned" => {
            /// A result type that is an array or handle.
            ResultType { ty: String },
        }
        error 329 "A structure in a structure without its braces" => {
            /// Numbers where a component that is a structure needs braces of its own. `right`: the whole value with
            /// these braces.
            FlatStructure { ty: String, component: String, inner: String, right: String },
        }
    }
}

impl Problem for TypeProblem {
    fn message(&self) -> String {
        match self {
            TypeProblem::Mismatch { found, wanted, what, .. } => {
                format!("{what} must be of type {wanted}, but this is of type {found}")
            }
            TypeProblem::DoesNotFit { value, wanted, .. } => format!("{value} does not fit the type {wanted}"),
            TypeProblem::Operator { operator, left, right: Some(right), .. } => {
                format!("`{operator}` does not work on {left} and {right}")
            }
            TypeProblem::Operator { operator, left, right: None, .. } => {
                format!("`{operator}` does not work on {left}")
            }
            TypeProblem::NotAnArray { ty } => format!("only arrays have elements, but this is of type {ty}"),
            TypeProblem::IndexCount { found, wanted } => {
                format!(
                    "the array has {wanted} dimension{}, but {found} {}",
                    plural(*wanted),
                    match found {
                        1 => "index is given",
                        _ => "indices are given",
                    }
                )
            }
            TypeProblem::IndexType { found } => format!("an index must be of type int, but this is of type {found}"),
            TypeProblem::NotAStructure { ty } => format!("only structures have components, but this is of type {ty}"),
            TypeProblem::BraceForValue { wanted } => {
                format!("braces make structures and arrays, but a value of type {wanted} is wanted here")
            }
            TypeProblem::BraceWithoutType => "nothing here says what type these braces make".into(),
            TypeProblem::TooManyValues { wanted, ty } => {
                format!("too many values: {ty} holds {wanted}")
            }
            TypeProblem::MixedBraces => "braces give values by position or by name, not both".into(),
            TypeProblem::ComponentTwice { name } => format!("the component `{name}` is given twice"),
            TypeProblem::AssignConst { name } => format!("`{name}` is const and cannot be written"),
            TypeProblem::NotAssignable { text } => format!("`{text}` is not a variable and cannot be written"),
            TypeProblem::ReadOnly { name } => format!("`${name}` is read-only: the controller sets it"),
            TypeProblem::Compare { ty } => format!("values of type {ty} cannot be compared as a whole"),
            TypeProblem::HandleCopy { ty } => format!("a {ty} is a handle and cannot be copied"),
            TypeProblem::NoValue { what } => format!("{what} has no value"),
            TypeProblem::ArraySize => "the size of an array must be a constant integer of 1 or more".into(),
            TypeProblem::ArrayTooLarge { len } => format!("the array has {len} elements, but 10000 is the most"),
            TypeProblem::TooManyDimensions { most } => format!("an array has at most {most} dimensions"),
            TypeProblem::ConstWithoutValue { name } => format!("the const `{name}` has no value"),
            TypeProblem::VoidVariable => "a variable cannot be of type void".into(),
            TypeProblem::OtherFamily { name, family } => format!("`{name}` exists for {family} robots only"),
            TypeProblem::WideLiteral { text } => format!("{text} is too large for int, and nothing here takes a uint"),
            TypeProblem::SpliceType => "nothing here says what ARL type this Rust value has".into(),
            TypeProblem::Dimensions { found, wanted } => format!("this must be {wanted}, but it is {found}"),
            TypeProblem::TooManyRows { rows } => format!("too many rows: the array has {rows}"),
            TypeProblem::NotARow { .. } => "the first values are rows in braces, but this one is not".into(),
            TypeProblem::FlatStructure { ty, component, inner, .. } => {
                format!("the `{component}` of a `{ty}` is a {inner} and needs braces of its own")
            }
            TypeProblem::ResultType { ty } => format!("a function cannot return a value of type {ty}"),
        }
    }

    fn label(&self) -> String {
        match self {
            TypeProblem::Mismatch { found, .. } => format!("this is {found}"),
            TypeProblem::DoesNotFit { range, .. } => range.clone(),
            TypeProblem::AssignConst { .. } | TypeProblem::NotAssignable { .. } | TypeProblem::ReadOnly { .. } => {
                "written here".into()
            }
            TypeProblem::TooManyValues { .. } | TypeProblem::TooManyRows { .. } => "one too many".into(),
            TypeProblem::NotARow { row } => format!("expected braces with {row} values"),
            _ => String::new(),
        }
    }

    fn help(&self) -> Option<String> {
        match self {
            TypeProblem::Mismatch { use_instead, .. } => use_instead.clone(),
            TypeProblem::Operator { hint, .. } => hint.clone(),
            TypeProblem::BraceWithoutType => {
                Some("declare a variable of the type first, or write the label: `j:{...}`".into())
            }
            TypeProblem::NotAssignable { .. } => Some("`==` compares; `=` writes a variable".into()),
            TypeProblem::MixedBraces => Some("write `{1, 2}` or `{x 1, y 2}`".into()),
            TypeProblem::Compare { .. } => Some("compare the components or elements one by one".into()),
            TypeProblem::NoValue { what } if what.ends_with(")`") => {
                Some("it returns nothing: call it on a line of its own".into())
            }
            TypeProblem::HandleCopy { .. } => {
                Some("use the one variable everywhere; make it global to share it".into())
            }
            TypeProblem::ConstWithoutValue { name } => Some(format!("write `const ... {name} = value`")),
            TypeProblem::WideLiteral { .. } => {
                Some("store it in a uint, write it as a double (`3e9`), or as a bit pattern in hexadecimal".into())
            }
            TypeProblem::SpliceType => Some("give the type: `#(value as double)`".into()),
            TypeProblem::IndexType { found } if found == "double" => Some("`toint(...)` makes an int of it".into()),
            TypeProblem::NotAnArray { ty } if ty == "string" => {
                Some("`substr` takes characters out of a string".into())
            }
            TypeProblem::Dimensions { wanted, .. } if !wanted.ends_with(']') => {
                Some("take one element of the array with an index".into())
            }
            TypeProblem::FlatStructure { right, .. } => Some(format!("write `{right}`")),
            TypeProblem::NotARow { .. } => Some("give all rows their braces, or none".into()),
            TypeProblem::VoidVariable => Some("void is for functions that return nothing".into()),
            TypeProblem::OtherFamily { .. } => Some("name the robot that the program is for with `--robot`".into()),
            _ => None,
        }
    }

    fn fix(&self) -> Option<String> {
        match self {
            TypeProblem::FlatStructure { right, .. } => Some(right.clone()),
            _ => None,
        }
    }
}

fn plural(count: usize) -> &'static str {
    if count == 1 { "" } else { "s" }
}
