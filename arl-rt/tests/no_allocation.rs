//! A cycle in which no motion is planned, and no time law asked for, allocates nothing, whatever else goes on.

mod common;

use arl_rt::emit::*;
use arl_rt::io::Scenario;
use arl_rt::{Cell, Controller, Foreground};
use common::*;

/// How often a closure allocates.
fn allocations(run: impl FnOnce()) -> u64 {
    allocation_counter::measure(run).count_total
}

#[test]
fn the_counter_counts() {
    assert_eq!(allocations(|| drop(std::hint::black_box(vec![1_u8; 100]))), 1);
}

#[test]
fn cycles_without_statements_allocate_nothing() {
    let scenario = "[[event]]\nwhen = \"do.1\"\nafter = 0.01\ndi.1 = true\n[[event]]\nwhen = \"!do.1\"\ndi.1 = false\n\
                    [[event]]\nat = 0.3\nai.1 = 2.5\noverride = 50\nforce = [0, 0, 1]\ntorque.j2 = 0.1\n";
    let builder = Controller::builder().record_motions().scenario(Scenario::parse("s.toml", scenario).unwrap());
    let builder = builder.trace(std::io::sink());
    let (mut controller, _) = controller(builder, |cx| {
        Box::pin(async move {
            for priority in 0..20 {
                let when = async |cx: &Cx| Ok(io::getdi(cx, 20).await.at(FILE, 1)? || event::elapsed_time(cx, 1e9));
                event::interrupt(when, async |_: &Cx| Ok(())).priority(priority).run(cx).at(FILE, 1)?;
            }
            event::timer(1e6, async |_: &Cx| Ok(())).rmode(true).run(cx).at(FILE, 1)?;
            event::trigger(async |cx: &Cx| Ok(event::elapsed_percent(cx, 101.0)), async |_: &Cx| Ok(()))
                .run(cx)
                .at(FILE, 1)?;
            motion::startdetect(1).run(cx).at(FILE, 1)?;
            motion::movej(bent(60.0)).vp(100.0).run(cx).await.at(FILE, 1)?;
            motion::toolload(ToolInertiaPara { m: 500.0, ..Default::default() }).run(cx).at(FILE, 2)?;
            motion::movej(bent(-60.0)).vp(100.0).run(cx).await.at(FILE, 2)?;
            let there = cx.system().flange.get();
            let pose = pose::getpose(cx, bent(-60.0), there, &cx.system().world.get()).at(FILE, 3)?;
            // A cycle that asks for a time law copies the way for the thread that finds it; a duration needs none.
            motion::lin(pose::offset(pose, 0.0, 50.0, -50.0, 0.0, 0.0, 0.0)).dura(0.8).run(cx).await.at(FILE, 4)?;
            io::setdoimv(1, true).run(cx).at(FILE, 5)?;
            io::pulsedo(cx, 2, true, 0.05).await.at(FILE, 6)?;
            let wait = flow::waituntil(cx).maxtime(0.5).start().await.at(FILE, 7)?;
            while !wait.late() && !io::getdi(cx, 9).await.at(FILE, 7)? {
                cx.next_cycle().await;
            }
            Ok(())
        })
    });
    // In its first cycles the program plans, and what it has planned is laid on the way 0.05 s later at the latest.
    for _ in 0..60 {
        controller.step();
    }
    let mut cycles = 0;
    while controller.outcome().is_none() {
        let count = allocations(|| {
            controller.step();
        });
        cycles += 1;
        if controller.outcome().is_none() {
            assert_eq!(count, 0, "in cycle {cycles}, line {:?}", controller.place());
        }
    }
    assert!(cycles > 1500, "{cycles}");
    assert_eq!(controller.outcome(), Some(&arl_rt::Outcome::Ended));
}

/// A robot goes to and fro, with interrupts that stop it and let it go on, and a timer.
fn busy(cx: &Cx) -> BoxFuture<'_> {
    Box::pin(async move {
        for priority in 0..20 {
            let when = async |cx: &Cx| io::getdi(cx, 3).await.at(FILE, 1);
            let action = async |cx: &Cx| flow::waittime(0.002).run(cx).await.at(FILE, 2);
            event::interrupt(when, action).priority(priority).run(cx).at(FILE, 1)?;
        }
        let (stop, go) =
            (async |cx: &Cx| io::getdi(cx, 1).await.at(FILE, 3), async |cx: &Cx| io::getdi(cx, 2).await.at(FILE, 4));
        event::interrupt(stop, async |cx: &Cx| event::stopmove().run(cx).at(FILE, 3)).run(cx).at(FILE, 3)?;
        event::interrupt(go, async |cx: &Cx| event::startmove().run(cx).at(FILE, 4)).run(cx).at(FILE, 4)?;
        event::timer(0.01, async |cx: &Cx| io::setdo(cx, 1, true).await.at(FILE, 5)).rmode(true).run(cx).at(FILE, 5)?;
        motion::movej(bent(60.0)).vp(30.0).run(cx).await.at(FILE, 6)?;
        let at_half = async |cx: &Cx| Ok(event::elapsed_percent(cx, 50.0));
        event::trigger(at_half, async |cx: &Cx| io::setdoimv(2, true).run(cx).at(FILE, 7)).run(cx).at(FILE, 7)?;
        motion::movej(bent(-60.0)).vp(30.0).run(cx).await.at(FILE, 8)?;
        flow::waituntil(cx).start().await.at(FILE, 9)?;
        while !io::getdi(cx, 9).await.at(FILE, 9)? {
            cx.next_cycle().await;
        }
        Ok(())
    })
}

#[test]
fn events_stops_and_pauses_of_several_channels_allocate_nothing() {
    let scenario = "[[event]]\nat = 0.1\ndi.1 = true\n[[event]]\nat = 0.5\ndi.2 = true\n[[event]]\nat = 0.7\ndi.3 = true\n\
                    [[event]]\nat = 0.8\npendant = \"pause\"\n[[event]]\nat = 1.1\npendant = \"start\"\n\
                    [[event]]\nat = 1.2\ndi.3 = false\n[[event]]\nat = 1.3\ndi.3 = true\n[[event]]\nat = 5\ndi.9 = true\n";
    let builder = Controller::builder().scenario(Scenario::parse("s.toml", scenario).unwrap());
    let others = (1..6).map(|_| Foreground::new(Box::new(script(busy))));
    let builder = others.fold(builder, |builder, other| builder.foreground(other));
    let (mut controller, _) = controller(builder, busy);
    controller.step();
    let mut cycles = 0;
    let mut speeds = Vec::with_capacity(10_000);
    while controller.outcome().is_none() {
        let before = controller.joints().axes[0];
        let count = allocations(|| {
            controller.step();
        });
        cycles += 1;
        speeds.push((controller.joints().axes[0] - before).abs());
        if controller.outcome().is_none() {
            assert_eq!(count, 0, "in cycle {cycles}, line {:?}", controller.place());
        }
    }
    assert_eq!(controller.outcome(), Some(&arl_rt::Outcome::Ended));
    for (still, from, to) in [("stopped", 400, 490), ("paused", 1000, 1090)] {
        assert!(speeds[from..to].iter().all(|speed| *speed == 0.0), "the robot is {still}");
    }
    for (moving, at) in [("goes before", 90), ("goes on after the stop", 700), ("goes on after the pause", 1250)] {
        assert!(speeds[at] > 0.0, "the robot {moving}");
    }
    assert!(
        controller.digital_output(1).unwrap() && controller.digital_output(2).unwrap(),
        "the timer and the trigger did their work"
    );
}

#[test]
fn cycles_with_an_island_allocate_nothing() {
    let cell = Cell::parse("plc.toml", "[modbus_tcp]\nport = 0\n").unwrap();
    let (plc, _) = controller(Controller::builder().cell(cell), |_| Box::pin(async { Ok(()) }));
    let port = plc.modbus_tcp_address().unwrap().port();
    let text = format!(
        "[[island]]\naddress = \"127.0.0.1\"\nport = {port}\npoll = 1\n\
         di = [{{ channel = 1, count = 16, coil = 0 }}]\nai = [{{ channel = 1, count = 2, holding_register = 0 }}]\n\
         do = [{{ channel = 1, count = 16, coil = 0 }}]\nao = [{{ channel = 1, count = 2, holding_register = 0 }}]\n"
    );
    let builder = Controller::builder().cell(Cell::parse("cell.toml", &text).unwrap());
    let (mut controller, _) = controller(builder, |cx| {
        Box::pin(async move {
            for round in 0..20 {
                io::syncdo(cx, 3, round % 2 == 0).await.at(FILE, 1)?;
                io::syncao(cx, 2, f64::from(round) / 2.0).await.at(FILE, 2)?;
                while io::getdi(cx, 3).await.at(FILE, 3)? != (round % 2 == 0) {
                    cx.next_cycle().await;
                }
            }
            Ok(())
        })
    });
    controller.step();
    while controller.outcome().is_none() {
        let count = allocations(|| {
            controller.step();
        });
        if controller.outcome().is_none() {
            assert_eq!(count, 0, "in line {:?}", controller.place());
        }
    }
    assert_eq!(controller.outcome(), Some(&arl_rt::Outcome::Ended));
}
