// Emitted by arl2rs 0.1.0 from fill.arl. Changes belong there.

/// `fill.arl`
pub mod fill {
    use super::Globals;
    use arl_rt::emit::*;

    const FILE: File = File::new("fill.arl");

    /// The global variables of `fill.arl`.
    #[derive(Default)]
    pub struct Variables {
        pub rate: Cell<f64>,
    }

    impl Variables {
        /// Gives all variables their first values.
        pub fn init(g: &Globals) {
            // 4: double rate = 2.5
            g.fill.rate.set(2.5);
        }
    }

    // 6: func void main()
    pub async fn main(cx: &Cx, g: &Globals) -> Done<()> {
        // 7: bool late
        // 8: clock watch
        let watch = Clock::default();
        // 9: valves::open(valves::INLET)
        super::valves::open(cx, g, 1).await.called(FILE, 9)?;
        // 10: clkstart(watch)
        cx.line(FILE, 10);
        clock::clkstart(cx, &watch);
        // 11: waituntil getdi(1), maxtime:10, timeoutflag:late
        cx.line(FILE, 11);
        let wait = flow::waituntil(cx).maxtime(10.0).start().await.at(FILE, 11)?;
        let late = loop {
            if io::getdi(cx, 1).await.at(FILE, 11)? {
                break false;
            }
            if wait.late() {
                break true;
            }
            cx.next_cycle().await;
        };
        // 12: clkstop(watch)
        cx.line(FILE, 12);
        clock::clkstop(cx, &watch);
        // 13: valves::close(valves::INLET)
        super::valves::close(cx, g, 1).await.called(FILE, 13)?;
        // 14: if(late)
        if late {
            // 15: print "the tank did not fill"
            cx.line(FILE, 15);
            text::print().argtoprint(&"the tank did not fill").run(cx).at(FILE, 15)?;
        } else {
            // 17: print valves::litres(clkread(watch), rate), " litres, valves switched ", valves::switched, " times"
            cx.line(FILE, 17);
            text::print()
                .argtoprint(
                    &super::valves::litres(clock::clkread(cx, &watch), g.fill.rate.get()),
                )
                .argtoprint(&" litres, valves switched ")
                .argtoprint(&g.valves.switched.get())
                .argtoprint(&" times")
                .run(cx)
                .at(FILE, 17)?;
        }
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
    pub fn litres(seconds: f64, rate: f64) -> f64 {
        // 19: return seconds * rate
        seconds * rate
    }
}

/// All global variables of the program.
#[derive(Default)]
pub struct Globals {
    pub fill: fill::Variables,
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
        arl_rt::emit::File::new("fill.arl")
    }

    fn family(&self) -> arl_rt::emit::Family {
        arl_rt::emit::Family::SixAxis
    }

    fn init<'a>(&'a self, _cx: &'a arl_rt::emit::Cx) -> arl_rt::emit::BoxFuture<'a> {
        Box::pin(async move {
            let g = self;
            valves::Variables::init(g);
            fill::Variables::init(g);
            Ok(())
        })
    }

    fn main<'a>(&'a self, cx: &'a arl_rt::emit::Cx) -> arl_rt::emit::BoxFuture<'a> {
        Box::pin(async move {
            let g = self;
            fill::main(cx, g).await
        })
    }
}
