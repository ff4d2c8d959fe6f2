// Emitted by hand from pick.arl, as arl2rs does it. Changes belong there.

/// `pick.arl`
pub mod pick {
    use super::Globals;
    use arl_rt::emit::*;

    const FILE: File = File::new("pick.arl");

    /// The global variables of `pick.arl`.
    pub struct Variables {
        pub count: Cell<i32>,
        pub home: Cell<Joint>,
        pub title: Shared<Str>,
        pub table: Shared<Array<f64, 6>>,
        pub watch: Clock,
    }

    impl Variables {
        pub fn new() -> Self {
            Self {
                count: Cell::default(),
                home: Cell::default(),
                title: Shared::default(),
                table: Shared::default(),
                watch: Clock::new(),
            }
        }

        pub fn init(&self) {
            // 1: int count = 2
            self.count.set(2);
            // 2: joint home = {0,-90,90,0,45,0}
            self.home.set(Joint { j1: 0.0, j2: -90.0, j3: 90.0, j4: 0.0, j5: 45.0, j6: 0.0, ..Joint::default() });
            // 3: string title = "pick and place"
            self.title.set("pick and place".into());
            // 4: double table[6] = {1,2,4}
            self.table.set(Array::from_values(&[1.0, 2.0, 4.0]));
            // 5: clock watch
        }
    }

    // 7: func double sum(double values[6], int n)
    pub fn sum(cx: &Cx, values: Array<f64, 6>, n: i32) -> Done<f64> {
        let _entered = cx.enter(1, 48).at(FILE, 7)?;
        // 8: if(n == 0) return 0.0
        if n == 0 {
            return Ok(0.0);
        }
        // 9: return values[n - 1] + sum(values, n - 1)
        cx.line(FILE, 9);
        Ok(values[index(n.wrapping_sub(1), 6).at(FILE, 9)?] + sum(cx, values.clone(), n.wrapping_sub(1))?)
    }

    // 12: func bool part(int number)
    pub async fn part(cx: &Cx, g: &Globals, number: i32) -> Done<bool> {
        // 13: bool late
        let mut late = false;
        // 14: movej home,vp:20%
        cx.line(FILE, 14);
        motion::movej(g.pick.home.get()).vp(20.0).run(cx).await.at(FILE, 14)?;
        // 15: setdo(3,true)
        cx.line(FILE, 15);
        io::setdo(cx, 3, true).await.at(FILE, 15)?;
        // 16: clkreset(watch)
        cx.line(FILE, 16);
        clock::clkreset(cx, &g.pick.watch);
        // 17: clkstart(watch)
        cx.line(FILE, 17);
        clock::clkstart(cx, &g.pick.watch);
        // 18: waituntil getdi(3),maxtime:5,timeoutflag:late
        cx.line(FILE, 18);
        let wait = flow::waituntil(cx).maxtime(5.0).start().await.at(FILE, 18)?;
        let timed_out = loop {
            if io::getdi(cx, 3).await.at(FILE, 18)? {
                break false;
            }
            if wait.late() {
                break true;
            }
            cx.next_cycle().await;
        };
        late = timed_out | (late & timed_out);
        // 19: clkstop(watch)
        cx.line(FILE, 19);
        clock::clkstop(cx, &g.pick.watch);
        // 20: setdo(3,false)
        cx.line(FILE, 20);
        io::setdo(cx, 3, false).await.at(FILE, 20)?;
        // 21: print "part ",number," in time: ",!late
        cx.line(FILE, 21);
        text::print()
            .argtoprint(&"part ")
            .argtoprint(&number)
            .argtoprint(&" in time: ")
            .argtoprint(&!late)
            .run(cx)
            .at(FILE, 21)?;
        // 22: return late
        Ok(late)
    }

    // 25: func void main()
    pub async fn main(cx: &Cx, g: &Globals) -> Done<()> {
        // 26: print title
        cx.line(FILE, 26);
        text::print().argtoprint(&g.pick.title.get()).run(cx).at(FILE, 26)?;
        // 27: for(int i = 1; i <= count; i++)
        let mut i = 1;
        while i <= g.pick.count.get() {
            // 28: part(i)
            part(cx, g, i).await?;
            i = i.wrapping_add(1);
            if cx.spend() {
                cx.next_cycle().await;
            }
        }
        // 30: print "at ",cjoint()
        cx.line(FILE, 30);
        text::print().argtoprint(&"at ").argtoprint(&pose::cjoint(cx)).run(cx).at(FILE, 30)?;
        // 31: print "sum is ",sum(table,6)
        cx.line(FILE, 31);
        text::print().argtoprint(&"sum is ").argtoprint(&sum(cx, g.pick.table.get(), 6)?).run(cx).at(FILE, 31)?;
        // 32: print "waited ",clkread(watch)," s",endl,"limits ",off,to:console
        cx.line(FILE, 32);
        text::print()
            .argtoprint(&"waited ")
            .argtoprint(&clock::clkread(cx, &g.pick.watch))
            .argtoprint(&" s\nlimits ")
            .argtoprint(&Printto::Off)
            .to(Printto::Hmi)
            .to(Printto::Console)
            .run(cx)
            .at(FILE, 32)?;
        // 33: $I[0]++
        cx.line(FILE, 33);
        let first = cx.system().i.update(|i| {
            i[0] = i[0].wrapping_add(1);
            i[0]
        });
        // 34: if($I[0] < 2) { print "again" ... } — the compact form of a restart
        if first < 2 {
            text::print().argtoprint(&"again").run(cx).at(FILE, 34)?;
            text::print().argtoprint(&"a line of text").run(cx).at(FILE, 34)?;
        }
        // 35: table[count * 3] = 1
        cx.line(FILE, 35);
        g.pick.table.update(|table| -> Done<()> {
            table[index(g.pick.count.get().wrapping_mul(3), 6).at(FILE, 35)?] = 1.0;
            Ok(())
        })
    }
}

/// All global variables of the program.
pub struct Globals {
    pub pick: pick::Variables,
}

impl Globals {
    pub fn new() -> Self {
        Self { pick: pick::Variables::new() }
    }
}

impl arl_rt::Program for Globals {
    fn file(&self) -> arl_rt::emit::File {
        arl_rt::emit::File::new("pick.arl")
    }

    fn family(&self) -> arl_rt::Family {
        arl_rt::Family::SixAxis
    }

    fn init<'a>(&'a self, _cx: &'a arl_rt::Cx) -> arl_rt::program::BoxFuture<'a> {
        Box::pin(async {
            self.pick.init();
            Ok(())
        })
    }

    fn main<'a>(&'a self, cx: &'a arl_rt::Cx) -> arl_rt::program::BoxFuture<'a> {
        Box::pin(pick::main(cx, self))
    }
}
