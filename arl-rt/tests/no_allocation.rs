//! A cycle in which the program only waits allocates nothing, whatever else goes on.

mod common;

use arl_rt::Controller;
use arl_rt::emit::*;
use arl_rt::io::Scenario;
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
            motion::lin(pose::offset(pose, 0.0, 50.0, -50.0, 0.0, 0.0, 0.0)).vl(300.0).run(cx).await.at(FILE, 4)?;
            io::setdoimv(1, true).run(cx).at(FILE, 5)?;
            io::pulsedo(cx, 2, true, 0.05).await.at(FILE, 6)?;
            let wait = flow::waituntil(cx).maxtime(0.5).start().await.at(FILE, 7)?;
            while !wait.late() && !io::getdi(cx, 9).await.at(FILE, 7)? {
                cx.next_cycle().await;
            }
            Ok(())
        })
    });
    // In its first cycle the program plans.
    controller.step();
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
