// Emitted by arl2rs 0.1.0 from greet.arl. Changes belong there.

/// `greet.arl`
pub mod greet {
    use arl_rt::emit::*;

    const FILE: File = File::new("greet.arl");

    // 2: func void main()
    pub async fn main(cx: &Cx) -> Done<()> {
        // 3: bool late
        // 4: waituntil getdi(1), maxtime:2, timeoutflag:late
        cx.line(FILE, 4);
        let wait = flow::waituntil(cx).maxtime(2.0).start().await.at(FILE, 4)?;
        let late = loop {
            if io::getdi(cx, 1).await.at(FILE, 4)? {
                break false;
            }
            if wait.late() {
                break true;
            }
            cx.next_cycle().await;
        };
        // 5: if(late)
        if late {
            // 6: print "nobody came"
            cx.line(FILE, 6);
            text::print().argtoprint(&"nobody came").run(cx).at(FILE, 6)?;
        } else {
            // 8: print "hello"
            cx.line(FILE, 8);
            text::print().argtoprint(&"hello").run(cx).at(FILE, 8)?;
        }
        Ok(())
    }
}

/// All global variables of the program.
#[derive(Default)]
pub struct Globals {}

impl Globals {
    /// All variables with their start values.
    pub fn new() -> Self {
        Self::default()
    }
}

impl arl_rt::Program for Globals {
    fn file(&self) -> arl_rt::emit::File {
        arl_rt::emit::File::new("greet.arl")
    }

    fn family(&self) -> arl_rt::emit::Family {
        arl_rt::emit::Family::SixAxis
    }

    fn init<'a>(&'a self, _cx: &'a arl_rt::emit::Cx) -> arl_rt::emit::BoxFuture<'a> {
        Box::pin(async move { Ok(()) })
    }

    fn main<'a>(&'a self, cx: &'a arl_rt::emit::Cx) -> arl_rt::emit::BoxFuture<'a> {
        Box::pin(async move { greet::main(cx).await })
    }
}
