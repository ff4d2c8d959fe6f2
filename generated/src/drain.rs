// Emitted by arl2rs 0.1.0 from drain.arl. Changes belong there.

/// `drain.arl`
pub mod drain {
    use super::Globals;
    use arl_rt::emit::*;

    const FILE: File = File::new("drain.arl");

    // 4: func void main()
    pub async fn main(cx: &Cx, g: &Globals) -> Done<()> {
        // 5: valves::open(valves::OUTLET)
        super::valves::open(cx, g, 2).await.called(FILE, 5)?;
        // 6: waittime 2
        cx.line(FILE, 6);
        flow::waittime(2.0).run(cx).await.at(FILE, 6)?;
        // 7: valves::close(valves::OUTLET)
        super::valves::close(cx, g, 2).await.called(FILE, 7)?;
        // 8: print "empty"
        cx.line(FILE, 8);
        text::print().argtoprint(&"empty").run(cx).at(FILE, 8)?;
        Ok(())
    }
}

/// `valves.arl`
pub mod valves {
    use super::Globals;
    use arl_rt::emit::*;

    const FILE: File = File::new("valves.arl");

    /// The global variables of `valves.arl`.
    #[derive(Default)]
    pub struct Variables {
        pub switched: Cell<i32>,
    }

    impl Variables {
        /// Gives all variables their first values.
        pub fn init(g: &Globals) {
            // 5: int switched
            g.valves.switched.set(0);
        }
    }

    // 7: func void open(int valve)
    pub async fn open(cx: &Cx, g: &Globals, valve: i32) -> Done<()> {
        // 8: setdo(valve, true)
        cx.line(FILE, 8);
        io::setdo(cx, valve, true).await.at(FILE, 8)?;
        // 9: switched++
        g.valves.switched.update(|it| it.wrapping_add(1));
        Ok(())
    }

    // 12: func void close(int valve)
    pub async fn close(cx: &Cx, g: &Globals, valve: i32) -> Done<()> {
        // 13: setdo(valve, false)
        cx.line(FILE, 13);
        io::setdo(cx, valve, false).await.at(FILE, 13)?;
        // 14: switched++
        g.valves.switched.update(|it| it.wrapping_add(1));
        Ok(())
    }

    // 18: func double litres(double seconds, double rate)
    #[allow(dead_code)]
    pub fn litres(seconds: f64, rate: f64) -> f64 {
        // 19: return seconds * rate
        seconds * rate
    }
}

/// All global variables of the program.
#[derive(Default)]
pub struct Globals {
    pub valves: valves::Variables,
}

impl Globals {
    /// All variables with their start values.
    pub fn new() -> Self {
        Self::default()
    }
}

impl arl_rt::Program for Globals {
    fn file(&self) -> arl_rt::emit::File {
        arl_rt::emit::File::new("drain.arl")
    }

    fn family(&self) -> arl_rt::emit::Family {
        arl_rt::emit::Family::SixAxis
    }

    fn init<'a>(&'a self, _cx: &'a arl_rt::emit::Cx) -> arl_rt::emit::BoxFuture<'a> {
        Box::pin(async move {
            let g = self;
            valves::Variables::init(g);
            Ok(())
        })
    }

    fn main<'a>(&'a self, cx: &'a arl_rt::emit::Cx) -> arl_rt::emit::BoxFuture<'a> {
        Box::pin(async move {
            let g = self;
            drain::main(cx, g).await
        })
    }
}
