// Emitted by arl2rs 0.1.0 from right.arl. Changes belong there.

/// `right.arl`
pub mod right {
    use super::Globals;
    use arl_rt::emit::*;

    const FILE: File = File::new("right.arl");

    /// The global variables of `right.arl`.
    #[derive(Default)]
    pub struct Variables {
        pub pieces: Cell<i32>,
    }

    impl Variables {
        /// Gives all variables their first values.
        pub fn init(g: &Globals) {
            // 2: int pieces = 2
            g.right.pieces.set(2);
        }
    }

    // 4: func int count(int from)
    pub fn count(g: &Globals, from: i32) -> i32 {
        // 5: return from + pieces
        from.wrapping_add(g.right.pieces.get())
    }

    // 8: func void main()
    pub async fn main(cx: &Cx, g: &Globals) -> Done<()> {
        // 9: waittime 0.5
        cx.line(FILE, 9);
        flow::waittime(0.5).run(cx).await.at(FILE, 9)?;
        // 10: print count(1)
        cx.line(FILE, 10);
        text::print().argtoprint(&count(g, 1)).run(cx).at(FILE, 10)?;
        Ok(())
    }
}

/// All global variables of the program.
#[derive(Default)]
pub struct Globals {
    pub right: right::Variables,
}

impl Globals {
    /// All variables with their start values.
    pub fn new() -> Self {
        Self::default()
    }
}

impl arl_rt::Program for Globals {
    fn file(&self) -> arl_rt::emit::File {
        arl_rt::emit::File::new("right.arl")
    }

    fn family(&self) -> arl_rt::emit::Family {
        arl_rt::emit::Family::SixAxis
    }

    fn init<'a>(&'a self, _cx: &'a arl_rt::emit::Cx) -> arl_rt::emit::BoxFuture<'a> {
        Box::pin(async move {
            let g = self;
            right::Variables::init(g);
            Ok(())
        })
    }

    fn main<'a>(&'a self, cx: &'a arl_rt::emit::Cx) -> arl_rt::emit::BoxFuture<'a> {
        Box::pin(async move {
            let g = self;
            right::main(cx, g).await
        })
    }
}
