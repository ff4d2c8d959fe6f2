::core::compile_error!(r#"ARL0201: there is no variable `form` here
 --> tests/emitted/wrong.arl:3:12
  |
3 |     return form + 1
  |            ^^^^ not known
  = help: did you mean `from`?
"#);
::core::compile_error!(r#"ARL0201: there is no variable `home` here
 --> tests/emitted/wrong.arl:8:9
  |
8 |     lin home
  |         ^^^^ not known
  = help: declare it first, for example `pose home`
"#);
/// The program has errors.
pub struct Globals {}

impl Globals {
    /// The program has errors.
    pub fn new() -> Self {
        Self {}
    }
}
