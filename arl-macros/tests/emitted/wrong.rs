::core::compile_error!("ARL0201: there is no variable `form` here\n --> tests/emitted/wrong.arl:3:12\n  |\n3 |     return form + 1\n  |            ^^^^ not known\n  = help: did you mean `from`?\n");
::core::compile_error!("ARL0201: there is no variable `home` here\n --> tests/emitted/wrong.arl:8:9\n  |\n8 |     lin home\n  |         ^^^^ not known\n  = help: declare it first, for example `pose home`\n");
/// The program has errors.
pub struct Globals {}

impl Globals {
    /// The program has errors.
    pub fn new() -> Self {
        Self {}
    }
}
