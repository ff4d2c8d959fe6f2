// Emitted by arl2rs 0.1.0 from pick_and_place.arl. Changes belong there.

/// `pick_and_place.arl`
pub mod pick_and_place {
    use super::Globals;
    use arl_rt::emit::*;

    const FILE: File = File::new("pick_and_place.arl");

    // 12: func pose above(pose point, double height)
    pub fn above(point: Pose, height: f64) -> Pose {
        // 13: return offset(point, 0, 0, height, 0, 0, 0)
        pose::offset(point, 0.0, 0.0, height, 0.0, 0.0, 0.0)
    }

    // 17: func pose place(int number)
    pub fn place(g: &Globals, number: i32) -> Pose {
        // 18: double dx = (number / COLUMNS) * pitch
        let dx = f64::from(number / 3) * g.pick_and_place_data.pitch.get();
        // 19: double dy = (number % COLUMNS) * pitch
        let dy = f64::from(number % 3) * g.pick_and_place_data.pitch.get();
        // 20: return offset(pallet, dx, dy, 0, 0, 0, 0)
        pose::offset(g.pick_and_place_data.pallet.get(), dx, dy, 0.0, 0.0, 0.0, 0.0)
    }

    // 24: func bool grip()
    pub async fn grip(cx: &Cx) -> Done<bool> {
        // 25: bool late
        // 26: setdo(1, true)
        cx.line(FILE, 26);
        io::setdo(cx, 1, true).await.at(FILE, 26)?;
        // 27: waituntil getdi(2), maxtime:1, timeoutflag:late
        cx.line(FILE, 27);
        let wait = flow::waituntil(cx).maxtime(1.0).start().await.at(FILE, 27)?;
        let late = loop {
            if io::getdi(cx, 2).await.at(FILE, 27)? {
                break false;
            }
            if wait.late() {
                break true;
            }
            cx.next_cycle().await;
        };
        // 28: return !late
        Ok(!late)
    }

    // 31: func void main()
    pub async fn main(cx: &Cx, g: &Globals) -> Done<()> {
        // 32: int placed = 0
        let mut placed: i32 = 0;
        // 33: int missed = 0
        let mut missed: i32 = 0;
        // 34: movej home, vp:50%
        cx.line(FILE, 34);
        motion::movej(g.pick_and_place_data.home.get())
            .vp(50.0)
            .run(cx)
            .await
            .at(FILE, 34)?;
        // 35: print "ready"
        cx.line(FILE, 35);
        text::print().argtoprint(&"ready").run(cx).at(FILE, 35)?;
        // 36: while(placed < ROWS * COLUMNS)
        while placed < 6 {
            // 37: ptp above(feeder, clearance), vp:80%
            cx.line(FILE, 37);
            motion::ptp(
                    above(
                        g.pick_and_place_data.feeder.get(),
                        g.pick_and_place_data.clearance.get(),
                    ),
                )
                .vp(80.0)
                .run(cx)
                .await
                .at(FILE, 37)?;
            // 38: waituntil getdi(1)
            cx.line(FILE, 38);
            flow::waituntil(cx).start().await.at(FILE, 38)?;
            while !io::getdi(cx, 1).await.at(FILE, 38)? {
                cx.change().await;
            }
            // 39: lin feeder, vl:200mm/s
            cx.line(FILE, 39);
            motion::lin(g.pick_and_place_data.feeder.get())
                .vl(200.0)
                .run(cx)
                .await
                .at(FILE, 39)?;
            // 40: if(grip())
            if grip(cx).await.called(FILE, 40)? {
                // 41: lin above(feeder, clearance), vl:400mm/s
                cx.line(FILE, 41);
                motion::lin(
                        above(
                            g.pick_and_place_data.feeder.get(),
                            g.pick_and_place_data.clearance.get(),
                        ),
                    )
                    .vl(400.0)
                    .run(cx)
                    .await
                    .at(FILE, 41)?;
                // 42: ptp above(place(placed), clearance), vp:80%
                cx.line(FILE, 42);
                motion::ptp(
                        above(place(g, placed), g.pick_and_place_data.clearance.get()),
                    )
                    .vp(80.0)
                    .run(cx)
                    .await
                    .at(FILE, 42)?;
                // 43: lin place(placed), vl:200mm/s
                cx.line(FILE, 43);
                motion::lin(place(g, placed)).vl(200.0).run(cx).await.at(FILE, 43)?;
                // 44: setdo(1, false)
                cx.line(FILE, 44);
                io::setdo(cx, 1, false).await.at(FILE, 44)?;
                // 45: waittime 0.1
                cx.line(FILE, 45);
                flow::waittime(0.1).run(cx).await.at(FILE, 45)?;
                // 46: lin above(place(placed), clearance), vl:400mm/s
                cx.line(FILE, 46);
                motion::lin(
                        above(place(g, placed), g.pick_and_place_data.clearance.get()),
                    )
                    .vl(400.0)
                    .run(cx)
                    .await
                    .at(FILE, 46)?;
                // 47: placed++
                placed = placed.wrapping_add(1);
                // 48: print "part ", placed, " placed"
                cx.line(FILE, 48);
                text::print()
                    .argtoprint(&"part ")
                    .argtoprint(&placed)
                    .argtoprint(&" placed")
                    .run(cx)
                    .at(FILE, 48)?;
            } else {
                // 50: setdo(1, false)
                cx.line(FILE, 50);
                io::setdo(cx, 1, false).await.at(FILE, 50)?;
                // 51: lin above(feeder, clearance), vl:400mm/s
                cx.line(FILE, 51);
                motion::lin(
                        above(
                            g.pick_and_place_data.feeder.get(),
                            g.pick_and_place_data.clearance.get(),
                        ),
                    )
                    .vl(400.0)
                    .run(cx)
                    .await
                    .at(FILE, 51)?;
                // 52: missed++
                missed = missed.wrapping_add(1);
                // 53: print "missed one"
                cx.line(FILE, 53);
                text::print().argtoprint(&"missed one").run(cx).at(FILE, 53)?;
            }
        }
        // 56: movej home, vp:50%
        cx.line(FILE, 56);
        motion::movej(g.pick_and_place_data.home.get())
            .vp(50.0)
            .run(cx)
            .await
            .at(FILE, 56)?;
        // 57: setdo(2, true)
        cx.line(FILE, 57);
        io::setdo(cx, 2, true).await.at(FILE, 57)?;
        // 58: print placed, " parts placed, ", missed, " missed"
        cx.line(FILE, 58);
        text::print()
            .argtoprint(&placed)
            .argtoprint(&" parts placed, ")
            .argtoprint(&missed)
            .argtoprint(&" missed")
            .run(cx)
            .at(FILE, 58)?;
        Ok(())
    }
}

/// `pick_and_place_data.arl`
pub mod pick_and_place_data {
    use super::Globals;
    use arl_rt::emit::*;

    /// The global variables of `pick_and_place_data.arl`.
    #[derive(Default)]
    pub struct Variables {
        pub home: Cell<Joint>,
        pub feeder: Cell<Pose>,
        pub pallet: Cell<Pose>,
        pub pitch: Cell<f64>,
        pub clearance: Cell<f64>,
    }

    impl Variables {
        /// Gives all variables their first values.
        pub fn init(g: &Globals) {
            // 2: joint home = {0, -90, 90, 0, 90, 0}
            g.pick_and_place_data
                .home
                .set(Joint {
                    j1: 0.0,
                    j2: -90.0,
                    j3: 90.0,
                    j4: 0.0,
                    j5: 90.0,
                    j6: 0.0,
                    ..Joint::default()
                });
            // 3: pose feeder = {x 900, y -500, z 400, a 0, b 180, c 0}
            g.pick_and_place_data
                .feeder
                .set(Pose {
                    x: 900.0,
                    y: -500.0,
                    z: 400.0,
                    a: 0.0,
                    b: 180.0,
                    c: 0.0,
                    ..Pose::default()
                });
            // 4: pose pallet = {x 800, y 300, z 350, a 0, b 180, c 0}
            g.pick_and_place_data
                .pallet
                .set(Pose {
                    x: 800.0,
                    y: 300.0,
                    z: 350.0,
                    a: 0.0,
                    b: 180.0,
                    c: 0.0,
                    ..Pose::default()
                });
            // 5: double pitch = 120
            g.pick_and_place_data.pitch.set(120.0);
            // 6: double clearance = 150
            g.pick_and_place_data.clearance.set(150.0);
        }
    }

    impl Variables {
        /// The variables whose values are read again at load.
        pub fn data(&self) -> DataFile<'_> {
            DataFile {
                file: "pick_and_place_data.arl",
                vars: Vec::from([
                    DataVar {
                        name: "home",
                        sizes: &[],
                        slot: &self.home,
                    },
                    DataVar {
                        name: "feeder",
                        sizes: &[],
                        slot: &self.feeder,
                    },
                    DataVar {
                        name: "pallet",
                        sizes: &[],
                        slot: &self.pallet,
                    },
                    DataVar {
                        name: "pitch",
                        sizes: &[],
                        slot: &self.pitch,
                    },
                    DataVar {
                        name: "clearance",
                        sizes: &[],
                        slot: &self.clearance,
                    },
                ]),
            }
        }
    }
}

/// All global variables of the program.
#[derive(Default)]
pub struct Globals {
    pub pick_and_place_data: pick_and_place_data::Variables,
}

impl Globals {
    /// All variables with their start values.
    pub fn new() -> Self {
        Self::default()
    }
}

impl arl_rt::Program for Globals {
    fn file(&self) -> arl_rt::emit::File {
        arl_rt::emit::File::new("pick_and_place.arl")
    }

    fn family(&self) -> arl_rt::emit::Family {
        arl_rt::emit::Family::SixAxis
    }

    fn init<'a>(&'a self, _cx: &'a arl_rt::emit::Cx) -> arl_rt::emit::BoxFuture<'a> {
        Box::pin(async move {
            let g = self;
            pick_and_place_data::Variables::init(g);
            Ok(())
        })
    }

    fn main<'a>(&'a self, cx: &'a arl_rt::emit::Cx) -> arl_rt::emit::BoxFuture<'a> {
        Box::pin(async move {
            let g = self;
            pick_and_place::main(cx, g).await
        })
    }

    fn data(&self) -> Vec<arl_rt::emit::DataFile<'_>> {
        vec![self.pick_and_place_data.data()]
    }
}
