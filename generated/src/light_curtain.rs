// Emitted by arl2rs 0.1.0 from light_curtain.arl. Changes belong there.

/// `light_curtain.arl`
pub mod light_curtain {
    use super::Globals;
    use arl_rt::emit::*;

    const FILE: File = File::new("light_curtain.arl");

    /// The global variables of `light_curtain.arl`.
    #[derive(Default)]
    pub struct Variables {
        pub stops: Cell<i32>,
    }

    impl Variables {
        /// Gives all variables their first values.
        pub fn init(g: &Globals) {
            // 9: int stops = 0
            g.light_curtain.stops.set(0);
        }
    }

    // 12: func void reached_in(string name)
    pub async fn reached_in(cx: &Cx, g: &Globals, name: Str) -> Done<()> {
        // 13: stopmove fast
        cx.line(FILE, 13);
        event::stopmove().stop(Stoptype::Fast).run(cx).at(FILE, 13)?;
        // 14: stops++
        g.light_curtain.stops.update(|it| it.wrapping_add(1));
        // 15: setdo(1, true)
        cx.line(FILE, 15);
        io::setdo(cx, 1, true).await.at(FILE, 15)?;
        // 16: waituntil !getdi(1)
        cx.line(FILE, 16);
        flow::waituntil(cx).start().await.at(FILE, 16)?;
        while io::getdi(cx, 1).await.at(FILE, 16)? {
            cx.change().await;
        }
        // 17: setdo(1, false)
        cx.line(FILE, 17);
        io::setdo(cx, 1, false).await.at(FILE, 17)?;
        // 18: print name, " was broken, the robot goes on"
        cx.line(FILE, 18);
        text::print()
            .argtoprint(&name)
            .argtoprint(&" was broken, the robot goes on")
            .run(cx)
            .at(FILE, 18)?;
        // 19: startmove
        cx.line(FILE, 19);
        event::startmove().run(cx).at(FILE, 19)?;
        Ok(())
    }

    // 22: func void main()
    pub async fn main(cx: &Cx, g: &Globals) -> Done<()> {
        // 23: string name = "curtain 1"
        let name = Str::literal("curtain 1");
        // 24: int seconds = 0
        let seconds: Rc<Cell<i32>> = Rc::new(Cell::new(0));
        // 25: interrupt 1, when:getdi(1), do:reached_in(name)
        cx.line(FILE, 25);
        event::interrupt(
                async |cx: &Cx| io::getdi(cx, 1).await.at(FILE, 25),
                {
                    let name = name.clone();
                    async move |cx: &Cx| {
                        let g: &Globals = cx.globals().at(FILE, 25)?;
                        reached_in(cx, g, name.clone()).await.called(FILE, 25)
                    }
                },
            )
            .priority(1)
            .run(cx)
            .at(FILE, 25)?;
        // 26: timer "watch", 2, interval:1, rmode:true, do:seconds++
        cx.line(FILE, 26);
        event::timer(
                1.0,
                {
                    let seconds = Rc::clone(&seconds);
                    async move |_: &Cx| {
                        seconds.update(|it| it.wrapping_add(1));
                        Ok(())
                    }
                },
            )
            .name(&Str::literal("watch"))
            .priority(2)
            .rmode(true)
            .run(cx)
            .at(FILE, 26)?;
        // 27: for(int round = 1; round <= ROUNDS; round++)
        for _round in 1..=2i32 {
            // 28: movej j:{-60,-90,90,0,45,0}, vp:20%
            cx.line(FILE, 28);
            motion::movej(Joint {
                    j1: -60.0,
                    j2: -90.0,
                    j3: 90.0,
                    j4: 0.0,
                    j5: 45.0,
                    j6: 0.0,
                    ..Joint::default()
                })
                .vp(20.0)
                .run(cx)
                .await
                .at(FILE, 28)?;
            // 29: movej j:{60,-90,90,0,45,0}, vp:20%
            cx.line(FILE, 29);
            motion::movej(Joint {
                    j1: 60.0,
                    j2: -90.0,
                    j3: 90.0,
                    j4: 0.0,
                    j5: 45.0,
                    j6: 0.0,
                    ..Joint::default()
                })
                .vp(20.0)
                .run(cx)
                .await
                .at(FILE, 29)?;
        }
        // 31: waittime 0
        cx.line(FILE, 31);
        flow::waittime(0.0).run(cx).await.at(FILE, 31)?;
        // 32: print stops, " stops within ", seconds, " s"
        cx.line(FILE, 32);
        text::print()
            .argtoprint(&g.light_curtain.stops.get())
            .argtoprint(&" stops within ")
            .argtoprint(&seconds.get())
            .argtoprint(&" s")
            .run(cx)
            .at(FILE, 32)?;
        Ok(())
    }
}

/// All global variables of the program.
#[derive(Default)]
pub struct Globals {
    pub light_curtain: light_curtain::Variables,
}

impl Globals {
    /// All variables with their start values.
    pub fn new() -> Self {
        Self::default()
    }
}

impl arl_rt::Program for Globals {
    fn file(&self) -> arl_rt::emit::File {
        arl_rt::emit::File::new("light_curtain.arl")
    }

    fn family(&self) -> arl_rt::emit::Family {
        arl_rt::emit::Family::SixAxis
    }

    fn init<'a>(&'a self, _cx: &'a arl_rt::emit::Cx) -> arl_rt::emit::BoxFuture<'a> {
        Box::pin(async move {
            let g = self;
            light_curtain::Variables::init(g);
            Ok(())
        })
    }

    fn main<'a>(&'a self, cx: &'a arl_rt::emit::Cx) -> arl_rt::emit::BoxFuture<'a> {
        Box::pin(async move {
            let g = self;
            light_curtain::main(cx, g).await
        })
    }
}
