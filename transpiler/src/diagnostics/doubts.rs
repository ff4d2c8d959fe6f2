//! Code that is allowed but most often not meant.

use super::Problem;
use super::declare::problems;

problems! {
    /// Code that is probably not meant.
    pub(crate) enum Doubt {
        warning 913 "An assignment as a condition" => {
            /// `if(n = 2)`.
            AssignedCondition,
        }
        warning 914 "A comparison as a statement" => {
            /// `n == 5` on a line of its own.
            ComparedStatement,
        }
        warning 915 "A target that looks like radians or metres" => {
            /// `found`: the unit that the numbers look like; `wanted`: ARL's; `example`: a value in both.
            OtherUnit { structure: &'static str, found: &'static str, wanted: &'static str, example: String },
        }
        warning 916 "A blending zone without effect" => {
            /// The robot stops at the target anyway, because of the statement `culprit`.
            IdleZone { culprit: &'static str },
        }
        warning 918 "A break at the end of each case" => {
            /// All cases of a `switch` in a loop end with `break`.
            BreakOfCase,
        }
        warning 919 "A local variable whose name hides another one by case alone" => {
            /// `n` inside, `N` outside. `hidden`: the name as declared outside; `what`: the kind of thing that it
            /// names.
            HiddenByCase { name: String, hidden: String, what: &'static str },
        }
        warning 920 "Fewer values than elements" => {
            /// `int a[5] = {1,2,3}`, or rows of an array. `of`: what is missing, elements or rows.
            TooFewValues { given: usize, size: usize, of: &'static str, rest: &'static str, help: String },
        }
        warning 921 "A number that looks as if it were in another unit" => {
            /// `vl:0.15`: `found` is the unit that it looks like, `right` the same value in ARL's unit.
            OtherScale { name: String, value: String, found: &'static str, wanted: &'static str, right: String },
        }
        warning 922 "A loop that only reads an input" => {
            /// `while(!getdi(1))` and similar loops. `condition`: what the loop waits for.
            Polls { condition: String },
        }
        warning 917 "A handler that may wait forever" => {
            /// A `waituntil` without a time limit in a function that handles an event.
            EndlessHandler { handler: String },
        }
        warning 924 "A weave or a compensation that nothing ends" => {
            /// `begins` is called, and nowhere in the program `ends`.
            NothingEnds { begins: &'static str, ends: &'static str },
        }
    }
}

impl Problem for Doubt {
    fn message(&self) -> String {
        match self {
            Doubt::AssignedCondition => "this condition assigns: `=` writes the variable".into(),
            Doubt::ComparedStatement => "this compares, but the result is not used".into(),
            Doubt::OtherUnit { structure, found, wanted, .. } => {
                format!("this `{structure}` looks like {found}: ARL takes {wanted}")
            }
            Doubt::IdleZone { culprit } => {
                format!("this zone has no effect: the robot stops at the target, since `{culprit}` waits for it")
            }
            Doubt::BreakOfCase => "this leaves the loop around the `switch`, not only the case".into(),
            Doubt::HiddenByCase { name, hidden, what } => {
                format!("`{name}` hides the {what} `{hidden}`: names that differ in case alone are the same name")
            }
            Doubt::TooFewValues { given, size, of, rest, .. } => {
                let last =
                    if size - given == 1 { "the last one is".into() } else { format!("the last {} are", size - given) };
                format!("values for {given} of {size} {of}: {last} {rest}")
            }
            Doubt::OtherScale { name, value, found, wanted, .. } => {
                format!("`{name}` is {value}, which looks like {found}: ARL takes {wanted}")
            }
            Doubt::Polls { .. } => "this loop only polls, as fast as it can, until the condition holds".into(),
            Doubt::EndlessHandler { handler } => {
                format!("`{handler}` handles an event, and this may hold up the program forever")
            }
            Doubt::NothingEnds { begins, ends } => {
                format!("no `{ends}` in this program ends what this `{begins}` begins")
            }
        }
    }

    fn label(&self) -> String {
        match self {
            Doubt::AssignedCondition => "did you mean `==`?".into(),
            _ => String::new(),
        }
    }

    fn help(&self) -> Option<String> {
        Some(match self {
            Doubt::AssignedCondition => "`==` compares; to assign first, do it on a line of its own".into(),
            Doubt::ComparedStatement => "`=` assigns".into(),
            Doubt::OtherUnit { example, .. } => example.clone(),
            Doubt::IdleZone { .. } => {
                "leave it out, or act during the motion with an event: `lin p1,sl:10;T(0.2),setdo(2,true)`".into()
            }
            Doubt::BreakOfCase => "a case ends by itself where the next one begins: remove the `break`".into(),
            Doubt::HiddenByCase { hidden, .. } => {
                format!("here `{hidden}` means the inner one, too: give one of them another name")
            }
            Doubt::TooFewValues { help, .. } => help.clone(),
            Doubt::OtherScale { right, .. } => right.clone(),
            Doubt::Polls { condition } => {
                format!(
                    "`waituntil {condition}` waits for it, and may have a `maxtime`; a run that waits in \
                     vain then says so"
                )
            }
            Doubt::EndlessHandler { .. } => "give it a `maxtime`, and look at its `timeoutflag`".into(),
            Doubt::NothingEnds { ends, .. } => {
                format!("write `{ends}` after its last line: until then every line, circle and spline is changed")
            }
        })
    }
}
