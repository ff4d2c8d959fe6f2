//! Alarms of interrupts while the robot moves: each names what it is about, the robot comes to rest on its path, and
//! what was saved last is still there.
#![allow(clippy::unwrap_used, clippy::panic, reason = "these are tests, too")]

mod common;

use std::cell::RefCell;
use std::rc::Rc;

use arl_rt::emit::*;
use arl_rt::storage::{Memory, Storage};
use arl_rt::{Controller, Outcome};
use common::*;

/// A store that outlives its controller.
#[derive(Clone, Default)]
struct Shared(Rc<RefCell<Memory>>);

impl Storage for Shared {
    fn load(&self, name: &str) -> std::io::Result<Option<Vec<u8>>> {
        self.0.borrow().load(name)
    }

    fn store(&mut self, name: &str, content: &[u8]) -> std::io::Result<()> {
        self.0.borrow_mut().store(name, content)
    }
}

/// What goes wrong in the handler, in line 9; the condition goes wrong in line 8 where it is `None`.
type Wrong = Option<fn(&Cx) -> Result<(), Fault>>;

/// The robot goes along a line; half a second later an input raises the handler.
fn program(cx: &Cx, wrong: Wrong) -> BoxFuture<'_> {
    Box::pin(async move {
        cx.system().i.set_item(1, 5);
        system::savesv(cx, &"I".into()).await.at(FILE, 1)?;
        motion::movej(bent(0.0)).vp(100.0).run(cx).await.at(FILE, 2)?;
        flow::waittime(0.0).run(cx).await.at(FILE, 3)?;
        let when = async move |cx: &Cx| {
            let raised = io::getdi(cx, 1).await.at(FILE, 8)?;
            if raised && wrong.is_none() { Err(Fault::DivideByZero).at(FILE, 8) } else { Ok(raised) }
        };
        let handle = async move |cx: &Cx| {
            cx.system().i.set_item(1, 99);
            wrong.map_or(Ok(()), |wrong| wrong(cx)).at(FILE, 9)
        };
        event::interrupt(when, handle).name(&"door".into()).priority(3).run(cx).at(FILE, 4)?;
        let there = cx.system().flange.get();
        let pose = pose::getpose(cx, bent(0.0), there, &cx.system().world.get()).at(FILE, 5)?;
        io::setdoimv(1, true).run(cx).at(FILE, 6)?;
        motion::lin(pose::offset(pose, 0.0, 300.0, 0.0, 0.0, 0.0, 0.0)).vl(200.0).run(cx).await.at(FILE, 7)?;
        flow::waittime(0.0).run(cx).await.at(FILE, 7)?;
        say(cx, &"not reached")
    })
}

fn declare(cx: &Cx, name: &str, priority: i32) -> Result<(), Fault> {
    event::interrupt(async |_: &Cx| Ok(false), async |_: &Cx| Ok(())).name(&name.into()).priority(priority).run(cx)
}

#[test]
fn alarms_of_events_stop_the_robot_on_its_path() {
    let cases: [(&str, Wrong, &str); 8] = [
        ("condition", None, "alarm 20001: "),
        ("handler", Some(|_| Err(Fault::DivideByZero)), "alarm 20001: "),
        (
            "name twice",
            Some(|cx| declare(cx, "door", 1)),
            "alarm 20004: interrupt: there is already an interrupt or a timer with the name \"door\"",
        ),
        (
            "priority too low",
            Some(|cx| declare(cx, "a", -1)),
            "alarm 20004: interrupt: the priority is -1, but must be 0 to 255",
        ),
        (
            "priority too high",
            Some(|cx| declare(cx, "a", 256)),
            "alarm 20004: interrupt: the priority is 256, but must be 0 to 255",
        ),
        (
            "name unknown to enableint",
            Some(|cx| event::enableint().name(&"window".into()).run(cx)),
            "alarm 20004: enableint: there is no interrupt or timer with the name \"window\"",
        ),
        (
            "name unknown to delint",
            Some(|cx| event::delint().name(&"window".into()).run(cx)),
            "alarm 20004: delint: there is no interrupt or timer with the name \"window\"",
        ),
        (
            "priority unknown to disableint",
            Some(|cx| event::disableint().priority(4).run(cx)),
            "alarm 20004: disableint: there is no interrupt or timer of priority 4",
        ),
    ];
    for (what, wrong, words) in cases {
        let kept = Shared::default();
        let builder = Controller::builder().storage(kept.clone());
        let (mut controller, messages) = controller(builder, move |cx| program(cx, wrong));
        while !controller.digital_output(1).unwrap() {
            controller.step();
        }
        let rest = controller.joints();
        controller.run_for(0.7);
        let before = tcp(&controller);
        controller.set_digital_input(1, true).unwrap();
        let mut path = vec![before];
        let mut ended = None;
        for cycle in 0..1000 {
            controller.step();
            path.push(tcp(&controller));
            if ended.is_none() && controller.outcome().is_some() {
                ended = Some(cycle);
            }
        }
        let text = alarm(controller.outcome().unwrap().clone());
        assert!(text.starts_with(words), "{what}: {text}");
        assert!(text.contains(if wrong.is_some() { "(t.arl:9)" } else { "(t.arl:8)" }), "{what}: {text}");
        assert_eq!(messages.text(), "", "{what}");
        check_path(what, &robot_tcp(&controller, &rest), &path);
        // What the program saved last is what the next start finds; what it changed since is gone.
        let next = Controller::builder().storage(kept).build(Box::new(script(|_| Box::pin(async { Ok(()) })))).unwrap();
        assert_eq!(next.system().i.item(1), 5, "{what}");
    }
}

fn robot_tcp(controller: &Controller, joints: &arl_rt::motion::Joints) -> [f64; 3] {
    let at = controller.robot().kinematics.forward(&joints.axes).translation.vector;
    [at.x, at.y, at.z]
}

fn tcp(controller: &Controller) -> [f64; 3] {
    robot_tcp(controller, &controller.joints())
}

/// The robot brakes along y, takes some cycles for that, and rests before the target.
fn check_path(what: &str, start: &[f64; 3], path: &[[f64; 3]]) {
    for at in path {
        assert!(
            (at[0] - start[0]).abs() < 1e-3 && (at[2] - start[2]).abs() < 1e-3,
            "{what}: {at:?} is beside the line"
        );
    }
    let steps: Vec<f64> = path.windows(2).map(|two| two[1][1] - two[0][1]).collect();
    assert!(steps[0] > 0.05, "{what}: it moved before: {}", steps[0]);
    let moving = steps.iter().take_while(|step| **step > 0.0).count();
    assert!((10..500).contains(&moving), "{what}: it took {moving} ms to stop");
    assert!(steps[moving..].iter().all(|step| *step == 0.0), "{what}: it rests");
    let jump = steps.windows(2).map(|two| (two[1] - two[0]).abs()).fold(0.0, f64::max);
    assert!(jump < 0.02, "{what}: no jump of the speed: {jump}");
    let last = path[path.len() - 1];
    assert!(last[1] - start[1] < 290.0, "{what}: before the target: {last:?}");
}

#[test]
fn a_handler_that_never_ends_holds_nobody_up() {
    let (mut controller, messages) = controller(Controller::builder(), |cx| {
        Box::pin(async move {
            let handle = async |cx: &Cx| {
                loop {
                    if cx.spend() {
                        cx.next_cycle().await;
                    }
                }
            };
            event::interrupt(async |cx: &Cx| io::getdi(cx, 1).await.at(FILE, 1), handle).run(cx).at(FILE, 1)?;
            motion::movej(bent(60.0)).vp(50.0).run(cx).await.at(FILE, 2)?;
            flow::waittime(0.0).run(cx).await.at(FILE, 2)?;
            say(cx, &"not reached")
        })
    });
    controller.run_for(0.2);
    controller.set_digital_input(1, true).unwrap();
    controller.run_for(5.0);
    // The motion goes on to its target; the program stands in the handler until somebody stops it.
    assert!((controller.joints().axes[0] - 60.0).abs() < 1e-6);
    assert!(controller.outcome().is_none());
    controller.stop();
    assert_eq!(controller.run(), Outcome::Stopped);
    assert_eq!(messages.text(), "");
}
