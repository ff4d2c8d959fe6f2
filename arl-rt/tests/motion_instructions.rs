//! Motion as programs order it.

mod common;

use arl_rt::emit::*;
use arl_rt::io::Override;
use arl_rt::{Controller, Outcome};
use common::*;

#[test]
fn motion_ends_where_it_should() {
    let (outcome, text) = run(|cx| {
        Box::pin(async move {
            motion::movej(bent(10.0)).vp(20.0).run(cx).await.at(FILE, 1)?;
            flow::waittime(0.0).run(cx).await.at(FILE, 2)?;
            say(cx, &pose::cjoint(cx))?;
            let world = cx.system().world.get();
            let flange = cx.system().flange.get();
            let start = pose::cpose(cx, flange, &world).at(FILE, 1)?;
            motion::lin(pose::offset(start, 0.0, 0.0, -50.0, 0.0, 0.0, 0.0)).vl(200.0).run(cx).await.at(FILE, 3)?;
            flow::waittime(0.0).run(cx).await.at(FILE, 4)?;
            let end = pose::cpose(cx, flange, &world).at(FILE, 1)?;
            say(cx, &((end.z - start.z) * 1e6).round())?;
            motion::ptp(start).vp(20.0).run(cx).await.at(FILE, 5)?;
            flow::waittime(0.0).run(cx).await.at(FILE, 6)?;
            say(cx, &pose::cjoint(cx))
        })
    });
    assert_eq!(outcome, Outcome::Ended);
    let joint = "{10,-90,90,0,45,0,9e+09,9e+09,9e+09,9e+09,9e+09,9e+09}";
    assert_eq!(text, format!("{joint}\n-5e+07\n{joint}\n"));
}

#[test]
fn the_program_runs_ahead_of_the_robot() {
    let (mut controller, messages) = controller(Controller::builder(), |cx| {
        Box::pin(async move {
            for goal in [80.0, -80.0, 80.0, -80.0] {
                motion::movej(bent(goal)).vp(10.0).run(cx).await.at(FILE, 1)?;
                say(cx, &cx.time())?;
                say(cx, &cx.system().cjoint.get().j1)?;
            }
            Ok(())
        })
    });
    controller.step();
    controller.step();
    assert_eq!(messages.text(), "0\n80\n0\n-80\n0.001\n80\n0.001\n-80\n", "two are planned in each cycle");
    assert_eq!(controller.run(), Outcome::Ended);
    assert_eq!(controller.joints().axes[0], -80.0);
}

#[test]
fn the_look_ahead_is_not_endless() {
    let (mut controller, messages) = controller(Controller::builder(), |cx| {
        Box::pin(async move {
            for round in 0..200 {
                motion::movej(bent(f64::from(round % 2) * 90.0)).vp(10.0).run(cx).await.at(FILE, 1)?;
                say(cx, &round)?;
            }
            Ok(())
        })
    });
    for _ in 0..100 {
        controller.step();
    }
    let planned = messages.text().lines().count();
    assert!((32..=70).contains(&planned), "{planned}");
    assert_eq!(controller.run(), Outcome::Ended);
}

#[test]
fn the_first_motion_needs_its_whole_target() {
    let (outcome, _) = run(|cx| {
        Box::pin(async move { motion::movej(Joint { j1: 10.0, ..Joint::default() }).run(cx).await.at(FILE, 3) })
    });
    let first = "alarm 20020: the first motion of a program must set all components of its target (t.arl:3)";
    assert_eq!(alarm(outcome), first);
    let (outcome, _) =
        run(|cx| Box::pin(async move { motion::ptp(Pose { x: 500.0, ..Pose::default() }).run(cx).await.at(FILE, 3) }));
    assert_eq!(alarm(outcome), first);
    let (outcome, text) = run(|cx| {
        Box::pin(async move {
            motion::movej(bent(0.0)).run(cx).await.at(FILE, 1)?;
            motion::movej(Joint { j1: 2.0, ..Joint::default() }).run(cx).await.at(FILE, 2)?;
            flow::waittime(0.0).run(cx).await.at(FILE, 3)?;
            say(cx, &pose::cjoint(cx))
        })
    });
    assert_eq!(outcome, Outcome::Ended);
    assert_eq!(text, "{2,-90,90,0,45,0,9e+09,9e+09,9e+09,9e+09,9e+09,9e+09}\n");
}

#[test]
fn labels_update_the_system_variables() {
    let (outcome, text) = run(|cx| {
        Box::pin(async move {
            let system = cx.system();
            let tool = Tool { t_frame: Frame { z: 120.0, ..Frame::default() }, stationary: false };
            let wobj = Wobj { w_frame: Frame { x: 10.0, ..Frame::default() }, ..Wobj::default() };
            motion::movej(bent(0.0))
                .v(Speed { per: 20.0, exj: 7.0, ..Speed::default() })
                .s(Slip { perdis: -2.0, ..Slip::default() })
                .t(tool)
                .run(cx)
                .await
                .at(FILE, 1)?;
            say(cx, &system.dfspeed.get())?;
            say(cx, &system.dfslip.get())?;
            say(cx, &system.dftool.get())?;
            flow::waittime(0.0).run(cx).await.at(FILE, 2)?;
            let here = pose::cpose(cx, tool, &wobj).at(FILE, 1)?;
            motion::lin(here).vl(100.0).sl(-1.0).w(&wobj).run(cx).await.at(FILE, 3)?;
            say(cx, &system.dfspeed.get())?;
            say(cx, &system.dfslip.get())?;
            say(cx, &system.dfwobj.get())?;
            motion::lin(here).vp(50.0).sp(-3.0).run(cx).await.at(FILE, 4)?;
            say(cx, &system.dfspeed.get())?;
            say(cx, &system.dfslip.get())?;
            system::init(cx);
            say(cx, &system.dfspeed.get())
        })
    });
    assert_eq!(outcome, Outcome::Ended);
    assert_eq!(
        text,
        "{20,50,400,7,5}\n{-2,-1,9e+09,9e+09,9e+09}\n{{0,0,120,0,0,0},false}\n\
         {20,100,400,7,5}\n{-1,-1,-1,-1,-1,-1}\n{{10,0,0,0,0,0},false}\n\
         {20,1000,250,7,5}\n{-1,-1,-1,-1,-1,-1}\n{5,50,400,5,5}\n"
    );
}

/// How long a program takes, in s.
fn duration<F>(builder: arl_rt::Builder, script: F) -> f64
where
    F: for<'a> Fn(&'a Cx) -> BoxFuture<'a> + 'static,
{
    let (mut controller, _) = controller(builder, script);
    assert_eq!(controller.run(), Outcome::Ended);
    controller.time()
}

#[test]
fn speeds_come_from_labels_velset_override_and_mode() {
    fn go(percent: i32) -> impl for<'a> Fn(&'a Cx) -> BoxFuture<'a> {
        move |cx| {
            Box::pin(async move {
                motion::velset(percent, 100_000).run(cx).at(FILE, 1)?;
                motion::movej(bent(0.0)).vp(100.0).run(cx).await.at(FILE, 2)?;
                motion::movej(bent(60.0)).vp(10.0).run(cx).await.at(FILE, 3)
            })
        }
    }
    let full = duration(Controller::builder(), go(100));
    let half = duration(Controller::builder(), go(50));
    assert!((half / full - 2.0).abs() < 0.2, "velset 50: {half} against {full}");
    let slow = duration(Controller::builder().speed_override(Override::from_percent(50.0).unwrap()), go(100));
    assert!((slow / full - 2.0).abs() < 0.05, "override 50: {slow} against {full}");
    let manual = |mode| {
        duration(Controller::builder().mode(mode), |cx| {
            Box::pin(async move {
                motion::movej(bent(0.0)).vp(100.0).run(cx).await.at(FILE, 2)?;
                motion::movej(bent(90.0)).vp(100.0).run(cx).await.at(FILE, 3)
            })
        })
    };
    let (by_hand, auto) = (manual(Controlmode::Manual), manual(Controlmode::Auto));
    assert!(by_hand > 2.0 * auto, "{by_hand} against {auto}");
    assert_eq!(manual(Controlmode::Manufast), manual(Controlmode::Auto));
    let timed = duration(Controller::builder(), |cx| {
        Box::pin(async move {
            motion::movej(bent(0.0)).vp(100.0).run(cx).await.at(FILE, 2)?;
            flow::waittime(0.0).run(cx).await.at(FILE, 2)?;
            let start = cx.time();
            motion::movej(bent(60.0)).dura(2.5).run(cx).await.at(FILE, 3)?;
            flow::waittime(0.0).run(cx).await.at(FILE, 2)?;
            assert!((cx.time() - start - 2.5).abs() < 0.05);
            Ok(())
        })
    });
    assert!(timed > 2.5);
    let (outcome, _) = run(|cx| Box::pin(async move { motion::velset(101, 800).run(cx).at(FILE, 1) }));
    assert_eq!(alarm(outcome), "alarm 20004: velset: override is 101 %, but must be 0 to 100 % (t.arl:1)");
}

#[test]
fn what_would_go_elsewhere_is_refused() {
    type Change = fn(&arl_rt::system::System);
    let changes: [(Change, &str); 2] = [
        (|system| system.dftool.set(Tool { stationary: true, ..Tool::default() }), "holds neither"),
        (|system| system.dfwobj.set(Wobj { robhold: true, ..Wobj::default() }), "holds both"),
    ];
    for (change, words) in changes {
        let (outcome, _) = run(move |cx| {
            Box::pin(async move {
                motion::movej(bent(0.0)).vp(100.0).run(cx).await.at(FILE, 1)?;
                change(cx.system());
                motion::lin(Pose { x: 700.0, ..Pose::default() }).run(cx).await.at(FILE, 2)
            })
        });
        let text = alarm(outcome);
        assert!(text.contains(words) && text.ends_with("(t.arl:2)"), "{text}");
    }
}

#[test]
fn unreachable_targets_are_alarms_of_their_line() {
    let (outcome, _) = run(|cx| {
        Box::pin(async move {
            motion::movej(bent(0.0)).vp(100.0).run(cx).await.at(FILE, 1)?;
            motion::ptp(Pose { x: 9000.0, ..Pose::default() }).run(cx).await.at(FILE, 2)
        })
    });
    let text = alarm(outcome);
    assert!(
        text.starts_with("alarm 20020: ") && text.contains("out of reach") && text.ends_with("(t.arl:2)"),
        "{text}"
    );
    let (outcome, _) = run(|cx| Box::pin(async move { motion::movej(bent(500.0)).run(cx).await.at(FILE, 3) }));
    assert!(alarm(outcome).contains("j1 would have to go to 500"));
}

#[test]
fn an_alarm_names_the_frames_that_the_motion_does_not_give() {
    let (outcome, _) = run(|cx| {
        Box::pin(async move {
            let tool = Tool { t_frame: Frame { z: 120.0, ..Frame::default() }, stationary: false };
            let wobj = Wobj { w_frame: Frame { x: 5000.0, ..Frame::default() }, ..Wobj::default() };
            let down = |x: f64| Pose { x, y: 0.0, z: 400.0, a: 0.0, b: 180.0, c: 0.0, ..Pose::default() };
            cx.line(FILE, 1);
            motion::movej(bent(0.0)).t(tool).run(cx).await.at(FILE, 1)?;
            cx.line(FILE, 2);
            motion::ptp(down(-4200.0)).w(&wobj).run(cx).await.at(FILE, 2)?;
            cx.line(FILE, 3);
            motion::ptp(down(800.0)).run(cx).await.at(FILE, 3)
        })
    });
    let text = alarm(outcome);
    for words in [
        "this motion gives no `w:`, so the workpiece frame {5000,0,0,0,0,0} of line 2 applies",
        "this motion gives no `t:`, so the tool {0,0,120,0,0,0} of line 1 applies",
    ] {
        assert!(text.contains(words), "{text}");
    }
}

#[test]
fn poses_and_joints_belong_together() {
    let (outcome, text) = run(|cx| {
        Box::pin(async move {
            let (flange, world) = (cx.system().flange.get(), cx.system().world.get());
            let there = Joint::of_axes([30.0, -60.0, 80.0, 20.0, 40.0, -50.0]);
            let pose = pose::getpose(cx, there, flange, &world).at(FILE, 1)?;
            say(cx, &pose::getjoint(cx, pose, flange, &world).at(FILE, 2)?)?;
            let tool = Tool { t_frame: Frame { x: 5.0, z: 100.0, b: 30.0, ..Frame::default() }, stationary: false };
            let wobj = Wobj { w_frame: Frame { x: 400.0, a: 45.0, ..Frame::default() }, ..Wobj::default() };
            let pose = pose::getpose(cx, there, tool, &wobj).at(FILE, 3)?;
            say(cx, &pose::getjoint(cx, pose, tool, &wobj).at(FILE, 4)?)?;
            // A tool that stands in the world and a workpiece on the flange.
            let tool = Tool { t_frame: Frame { x: 900.0, z: 600.0, ..Frame::default() }, stationary: true };
            let wobj =
                Wobj { w_frame: Frame { z: 80.0, a: 10.0, ..Frame::default() }, robhold: true, mu_name: Str::new() };
            let pose = pose::getpose(cx, there, tool, &wobj).at(FILE, 5)?;
            say(cx, &pose::getjoint(cx, pose, tool, &wobj).at(FILE, 6)?)?;
            pose::getpose(cx, Joint { j6: 1.0, ..Joint::default() }, flange, &world).at(FILE, 7).map(|_| ())
        })
    });
    let line = "{30,-60,80,20,40,-50,9e+09,9e+09,9e+09,9e+09,9e+09,9e+09}\n";
    assert_eq!(text, [line; 3].concat());
    assert_eq!(alarm(outcome), "alarm 20004: getpose: axes of the robot are not set or are not numbers (t.arl:7)");
}

#[test]
fn the_controller_keeps_its_variables_current() {
    let cell = arl_rt::Cell::parse("c.toml", "[home]\nhome2 = [25, -90, 90, 0, 45, 0]\n").unwrap();
    let (mut controller, messages) = controller(Controller::builder().cell(cell), |cx| {
        Box::pin(async move {
            motion::movej(bent(25.0)).vp(100.0).run(cx).await.at(FILE, 1)?;
            flow::waittime(0.0).run(cx).await.at(FILE, 2)?;
            cx.next_cycle().await;
            say(cx, &cx.system().at_home.get())?;
            motion::movej(bent(0.0)).vp(10.0).run(cx).await.at(FILE, 3)
        })
    });
    assert!(controller.system().at_home.with(|at_home| !at_home[1]));
    while messages.text().is_empty() {
        controller.step();
    }
    assert_eq!(messages.text(), "{false,true,false,false,false}\n");
    controller.run_for(0.5);
    let system = controller.system();
    let (elapsed, remaining) = (system.traj_elapse_time.get(), system.traj_left_time.get());
    assert!((0.4..0.6).contains(&elapsed) && remaining > 0.5, "{elapsed} {remaining}");
    controller.run();
    assert_eq!(controller.system().traj_left_time.get(), 0.0);
}

#[test]
fn a_motion_that_comes_too_late_to_be_blended_is_reported() {
    let (mut controller, _) = controller(Controller::builder(), |cx| {
        Box::pin(async move {
            motion::movej(bent(30.0)).vp(100.0).sp(50.0).run(cx).await.at(FILE, 1)?;
            // It brakes for its target by now.
            for _ in 0..330 {
                cx.next_cycle().await;
            }
            motion::movej(bent(60.0)).sp(-1.0).run(cx).await.at(FILE, 2)
        })
    });
    assert_eq!(controller.run(), Outcome::Ended);
    let warnings = controller.take_warnings();
    assert!(warnings.len() == 1 && warnings[0].contains("too late to be blended"), "{warnings:?}");
    assert!((controller.joints().axes[0] - 60.0).abs() < 1e-9);
}

#[test]
fn a_target_that_is_not_rounded_off_is_reported_once_with_the_cause() {
    let (mut controller, _) = controller(Controller::builder(), |cx| {
        Box::pin(async move {
            motion::movej(bent(0.0)).vp(100.0).sp(-1.0).run(cx).await.at(FILE, 1)?;
            let (flange, world) = (cx.system().flange.get(), cx.system().world.get());
            let here = pose::getpose(cx, bent(0.0), flange, &world).at(FILE, 1)?;
            for _ in 0..4 {
                let there = Pose { z: here.z - 50.0, ..here };
                motion::lin(there).vl(500.0).sl(5.0).run(cx).await.at(FILE, 2)?;
                motion::lin(here).vl(500.0).sl(-1.0).run(cx).await.at(FILE, 3)?;
            }
            Ok(())
        })
    });
    assert_eq!(controller.run(), Outcome::Ended);
    let warnings = controller.take_warnings();
    assert!(warnings.len() == 1 && warnings[0].contains("goes back along the same path"), "{warnings:?}");
}

#[test]
fn the_virtual_clock_gives_the_same_run_every_time() {
    let trace = || {
        let kept = Kept::default();
        let (mut controller, _) = controller(Controller::builder().trace(kept.clone()), |cx| {
            Box::pin(async move {
                for _ in 0..5 {
                    let j1 = f64::from(math::rand(cx) % 90);
                    motion::movej(bent(j1)).vp(100.0).run(cx).await.at(FILE, 1)?;
                }
                Ok(())
            })
        });
        controller.run();
        kept.0.take()
    };
    let first = trace();
    assert!(first.len() > 10_000);
    assert!(first == trace());
}
