// Emitted by arl2rs 0.1.0 from plc_cell.arl. Changes belong there.

/// `plc_cell.arl`
pub mod plc_cell {
    use super::Globals;
    use arl_rt::emit::*;

    const FILE: File = File::new("plc_cell.arl");

    /// The global variables of `plc_cell.arl`.
    #[derive(Default)]
    pub struct Variables {
        pub home: Cell<Joint>,
        pub machine: Cell<Joint>,
        pub rack: Cell<Joint>,
    }

    impl Variables {
        /// Gives all variables their first values.
        pub fn init(g: &Globals) {
            // 6: joint home = {0, -90, 90, 0, 90, 0}
            g.plc_cell
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
            // 7: joint machine = {60, -60, 80, 0, 70, 0}
            g.plc_cell
                .machine
                .set(Joint {
                    j1: 60.0,
                    j2: -60.0,
                    j3: 80.0,
                    j4: 0.0,
                    j5: 70.0,
                    j6: 0.0,
                    ..Joint::default()
                });
            // 8: joint rack = {-60, -60, 80, 0, 70, 0}
            g.plc_cell
                .rack
                .set(Joint {
                    j1: -60.0,
                    j2: -60.0,
                    j3: 80.0,
                    j4: 0.0,
                    j5: 70.0,
                    j6: 0.0,
                    ..Joint::default()
                });
        }
    }

    // 11: func void carry(joint from, joint to, int done)
    pub async fn carry(cx: &Cx, from: Joint, to: Joint, done: i32) -> Done<()> {
        // 12: movej from, vp:50%
        cx.line(FILE, 12);
        motion::movej(from).vp(50.0).run(cx).await.at(FILE, 12)?;
        // 13: movej to, vp:50%
        cx.line(FILE, 13);
        motion::movej(to).vp(50.0).run(cx).await.at(FILE, 13)?;
        // 14: pulsedo(done, true, 0.1)
        cx.line(FILE, 14);
        io::pulsedo(cx, done, true, 0.1).await.at(FILE, 14)?;
        Ok(())
    }

    // 18: func int ask()
    pub async fn ask(cx: &Cx) -> Done<i32> {
        // 19: $PGNO = -1
        cx.system().pgno.set(-1);
        // 20: $PGNO_REQ = true
        cx.system().pgno_req.set(true);
        // 21: waituntil $PGNO >= 0
        cx.line(FILE, 21);
        flow::waituntil(cx).start().await.at(FILE, 21)?;
        while cx.system().pgno.get() < 0 {
            cx.change().await;
        }
        // 22: $PGNO_REQ = false
        cx.system().pgno_req.set(false);
        // 23: return $PGNO
        Ok(cx.system().pgno.get())
    }

    // 26: func void main()
    pub async fn main(cx: &Cx, g: &Globals) -> Done<()> {
        // 27: movej home, vp:50%
        cx.line(FILE, 27);
        motion::movej(g.plc_cell.home.get()).vp(50.0).run(cx).await.at(FILE, 27)?;
        // 28: loop
        loop {
            // 29: int number = ask()
            let number = ask(cx).await.called(FILE, 29)?;
            // 30: print "program ", number
            cx.line(FILE, 30);
            text::print()
                .argtoprint(&"program ")
                .argtoprint(&number)
                .run(cx)
                .at(FILE, 30)?;
            // 31: switch(number)
            match number {
                // 32: case 1:
                1 => {
                    // 33: carry(rack, machine, LOADED)
                    carry(cx, g.plc_cell.rack.get(), g.plc_cell.machine.get(), 30)
                        .await
                        .called(FILE, 33)?;
                }
                // 34: case 2:
                2 => {
                    // 35: carry(machine, rack, UNLOADED)
                    carry(cx, g.plc_cell.machine.get(), g.plc_cell.rack.get(), 31)
                        .await
                        .called(FILE, 35)?;
                }
                // 36: case 3:
                3 => {
                    // 37: movej home, vp:50%
                    cx.line(FILE, 37);
                    motion::movej(g.plc_cell.home.get())
                        .vp(50.0)
                        .run(cx)
                        .await
                        .at(FILE, 37)?;
                    // 38: waittime 0
                    cx.line(FILE, 38);
                    flow::waittime(0.0).run(cx).await.at(FILE, 38)?;
                    // 39: print "at home: ", $AT_HOME[1]
                    cx.line(FILE, 39);
                    text::print()
                        .argtoprint(&"at home: ")
                        .argtoprint(&cx.system().at_home.item(1))
                        .run(cx)
                        .at(FILE, 39)?;
                    // 40: exit
                    return Err(Stop::exit());
                }
                // 41: default:
                _ => {
                    // 42: print "the robot has no program ", number
                    cx.line(FILE, 42);
                    text::print()
                        .argtoprint(&"the robot has no program ")
                        .argtoprint(&number)
                        .run(cx)
                        .at(FILE, 42)?;
                }
            }
            if cx.spend() {
                cx.next_cycle().await;
            }
        }
    }
}

/// All global variables of the program.
#[derive(Default)]
pub struct Globals {
    pub plc_cell: plc_cell::Variables,
}

impl Globals {
    /// All variables with their start values.
    pub fn new() -> Self {
        Self::default()
    }
}

impl arl_rt::Program for Globals {
    fn file(&self) -> arl_rt::emit::File {
        arl_rt::emit::File::new("plc_cell.arl")
    }

    fn family(&self) -> arl_rt::emit::Family {
        arl_rt::emit::Family::SixAxis
    }

    fn init<'a>(&'a self, _cx: &'a arl_rt::emit::Cx) -> arl_rt::emit::BoxFuture<'a> {
        Box::pin(async move {
            let g = self;
            plc_cell::Variables::init(g);
            Ok(())
        })
    }

    fn main<'a>(&'a self, cx: &'a arl_rt::emit::Cx) -> arl_rt::emit::BoxFuture<'a> {
        Box::pin(async move {
            let g = self;
            plc_cell::main(cx, g).await
        })
    }
}
