//! Several programs in one controller: what they share, what is each one's own, and in which order they run.
#![allow(clippy::unwrap_used, reason = "these are tests")]

mod common;

use arl_rt::emit::*;
use arl_rt::status::ChannelId;
use arl_rt::{Builder, Captured, Controller, Foreground, Outcome, SetupError, State};
use common::*;

/// A channel for a closure.
fn channel<F>(run: F) -> Foreground
where
    F: for<'a> Fn(&'a Cx) -> BoxFuture<'a> + 'static,
{
    Foreground::new(Box::new(script(run)))
}

/// A controller and what its programs say, each message with its channel before it.
fn with_channels(builder: Builder, first: impl Program + 'static) -> (Controller, Captured) {
    let messages = Captured::new();
    let mut out = messages.clone();
    let output = move |message: &arl_rt::Message<'_>| {
        let text = format!("{}: {}", message.channel, String::from_utf8_lossy(message.text));
        arl_rt::output::Output::message(&mut out, &arl_rt::Message { text: text.as_bytes(), ..*message });
    };
    (builder.output(output).build(Box::new(first)).unwrap(), messages)
}

#[test]
fn channels_share_io_and_time_and_run_in_their_order() {
    let second = channel(|cx| {
        Box::pin(async move {
            // What the first channel has set in this cycle is there.
            say(cx, &io::getdo(cx, 1).await.at(FILE, 1)?)?;
            io::setdo(cx, 2, true).await.at(FILE, 2)?;
            flow::waittime(0.2).run(cx).await.at(FILE, 3)?;
            say(cx, &cx.time())
        })
    });
    let watching = script(|cx| {
        Box::pin(async move {
            say(cx, &io::getdo(cx, 2).await.at(FILE, 1)?)?;
            loop {
                cx.next_cycle().await;
            }
        })
    });
    let builder = Controller::builder().foreground(second).background(Box::new(watching));
    let first = script(|cx| {
        Box::pin(async move {
            say(cx, &io::getdo(cx, 2).await.at(FILE, 1)?)?;
            io::setdo(cx, 1, true).await.at(FILE, 2)?;
            flow::waittime(0.1).run(cx).await.at(FILE, 3)?;
            say(cx, &cx.time())
        })
    });
    let (mut controller, messages) = with_channels(builder, first);
    // The background program never ends; the run does, with the last foreground program.
    assert_eq!(controller.run(), Outcome::Ended);
    assert_eq!(
        messages.text(),
        "channel 1: false\nchannel 2: true\nbackground channel 1: true\nchannel 1: 0.1\nchannel 2: 0.2\n"
    );
}

#[test]
fn each_channel_has_its_own_robot_and_modal_variables() {
    let second = channel(|cx| {
        Box::pin(async move {
            motion::movej(bent(-30.0)).vp(100.0).run(cx).await.at(FILE, 1)?;
            flow::waittime(0.0).run(cx).await.at(FILE, 2)?;
            say(cx, &(cx.system().dfspeed.get().per == 100.0, cx.system().i.item(3)).1)?;
            say(cx, &pose::cjoint(cx).j1)?;
            flow::waittime(1.0).run(cx).await.at(FILE, 3)?;
            say(cx, &channel::channeljoint(cx, 1, true).at(FILE, 4)?.j1)
        })
    });
    let first = script(|cx| {
        Box::pin(async move {
            cx.system().i.set_item(3, 7);
            motion::movej(bent(60.0)).vp(50.0).run(cx).await.at(FILE, 1)?;
            flow::waittime(0.0).run(cx).await.at(FILE, 2)?;
            say(cx, &cx.system().dfspeed.get().per)?;
            say(cx, &channel::channeljoint(cx, 2, true).at(FILE, 3)?.j1)?;
            channel::channeljoint(cx, 3, true).map(drop).at(FILE, 5)
        })
    });
    let (mut controller, messages) = with_channels(Controller::builder().foreground(second), first);
    let outcome = controller.run();
    assert_eq!(
        alarm(outcome),
        "alarm 20004: channeljoint: there is no foreground channel 3, only channels 1 to 2 (t.arl:5)"
    );
    assert_eq!(messages.text(), "channel 2: 7\nchannel 2: -30\nchannel 1: 50\nchannel 1: -30\nchannel 2: 60\n");
}

#[test]
fn an_alarm_ends_the_program_of_its_channel_alone() {
    let second = channel(|_| Box::pin(async move { flow::assert(false).at(FILE, 12) }));
    let first = script(|cx| {
        Box::pin(async move {
            flow::waittime(0.5).run(cx).await.at(FILE, 1)?;
            say(cx, &"still here")
        })
    });
    let (mut controller, messages) = with_channels(Controller::builder().foreground(second), first);
    assert_eq!(controller.run_for(0.1), State::Running);
    let alarms = controller.take_alarms();
    assert_eq!(
        alarms.iter().map(ToString::to_string).collect::<Vec<_>>(),
        ["alarm 20008: assertion failed (t.arl:12, channel 2)"]
    );
    assert_eq!(alarms[0].channel, ChannelId::Foreground(2));
    // The alarm is how the whole ended.
    assert!(matches!(controller.run(), Outcome::Alarm(_)));
    assert_eq!(messages.text(), "channel 1: still here\n");
}

#[test]
fn what_needs_a_robot_is_an_alarm_in_the_background() {
    type Wrong = fn(&Cx) -> BoxFuture<'_>;
    let cases: [(Wrong, &str); 4] = [
        (|cx| Box::pin(async move { motion::movej(bent(0.0)).run(cx).await.at(FILE, 2) }), "motion needs a robot"),
        (|cx| Box::pin(async move { motion::velset(50, 100).run(cx).at(FILE, 2) }), "velset needs a robot"),
        (
            |cx| {
                Box::pin(async move {
                    cx.line(FILE, 2);
                    pose::cjoint(cx);
                    cx.next_cycle().await;
                    say(cx, &"never")
                })
            },
            "cjoint needs a robot",
        ),
        (|cx| Box::pin(async move { motion::startdetect(1).run(cx).at(FILE, 2) }), "startdetect needs a robot"),
    ];
    for (wrong, words) in cases {
        let builder = Controller::builder().background(Box::new(script(wrong)));
        let first = script(|cx| Box::pin(async move { flow::waittime(0.1).run(cx).await.at(FILE, 1) }));
        let (mut controller, messages) = with_channels(builder, first);
        let text = alarm(controller.run());
        assert!(text.starts_with("alarm 20023: ") && text.contains(words), "{text}");
        assert!(text.ends_with("(t.arl:2, background channel 1)"), "{text}");
        assert_eq!(messages.text(), "");
    }
}

#[test]
fn pulses_and_outputs_in_motion_belong_to_their_channel() {
    let second = channel(|cx| {
        Box::pin(async move {
            motion::movej(bent(20.0)).vp(30.0).run(cx).await.at(FILE, 1)?;
            io::setdoimv(5, true).run(cx).at(FILE, 2)?;
            motion::movej(bent(-20.0)).vp(100.0).run(cx).await.at(FILE, 3)
        })
    });
    let first = script(|cx| {
        Box::pin(async move {
            io::pulsedo(cx, 1, true, 9.0).await.at(FILE, 1)?;
            // The motions of the first robot are none of the second one's.
            motion::movej(bent(1.0)).vp(100.0).run(cx).await.at(FILE, 2)?;
            motion::movej(bent(0.0)).vp(100.0).run(cx).await.at(FILE, 3)?;
            flow::waittime(0.0).run(cx).await.at(FILE, 4)?;
            say(cx, &io::getdo(cx, 5).await.at(FILE, 5)?)
        })
    });
    let (mut controller, messages) = with_channels(Controller::builder().foreground(second), first);
    assert_eq!(controller.run(), Outcome::Ended);
    assert_eq!(messages.text(), "channel 1: false\n");
    assert!(controller.digital_output(5).unwrap());
    // The second program ended long before the pulse of the first one did.
    assert!(controller.time() > 8.9, "{}", controller.time());
}

#[test]
fn a_controller_has_at_most_six_foreground_channels() {
    let nothing = || script(|_| Box::pin(async { Ok(()) }));
    let builder = |count| {
        (1..count).fold(Controller::builder(), |builder, _| builder.foreground(Foreground::new(Box::new(nothing()))))
    };
    assert_eq!(builder(6).build(Box::new(nothing())).unwrap().run(), Outcome::Ended);
    let error = builder(7).build(Box::new(nothing())).map(drop).unwrap_err();
    assert_eq!(error, SetupError::Channels("7 foreground channels: a controller has at most 6".into()));
}

/// Moves one after the other way for ever, and says who it is.
fn swinging(name: &'static str, to: f64) -> Box<dyn Program> {
    Box::new(script(move |cx| {
        Box::pin(async move {
            say(cx, &name)?;
            loop {
                motion::movej(bent(to)).vp(100.0).run(cx).await.at(FILE, 1)?;
                motion::movej(bent(-to)).vp(100.0).run(cx).await.at(FILE, 2)?;
            }
        })
    }))
}

#[test]
fn the_background_switches_the_program_of_a_foreground_channel() {
    let switching = script(|cx| {
        Box::pin(async move {
            let switch = |channel: u32, name: &'static str| {
                let name = Str::literal(name);
                async move { channel::switcharl(cx, channel, &name).await.at(FILE, 3) }
            };
            cx.line(FILE, 3);
            flow::waittime(1.5).run(cx).await.at(FILE, 1)?;
            say(cx, &switch(1, "RECIPE.arl").await?)?;
            flow::waittime(1.0).run(cx).await.at(FILE, 1)?;
            say(cx, &channel::channeljoint(cx, 1, true).at(FILE, 2)?.j2)?;
            for (channel, name) in [(1, "nothing.arl"), (2, "recipe.arl")] {
                say(cx, &switch(channel, name).await?)?;
            }
            switch(7, "recipe.arl").await.map(drop)
        })
    });
    let builder = Controller::builder().background(Box::new(switching));
    let builder = builder.loadable("recipe.arl", || swinging("recipe", 5.0));
    let messages = Captured::new();
    let mut controller = builder.output(messages.clone()).build(swinging("first", 40.0)).unwrap();
    let mut last = controller.joints();
    for _ in 0..6000 {
        assert_eq!(controller.step(), State::Running);
        // The robot stops on its path before the other program moves it.
        let joints = controller.joints();
        assert!((joints.axes[0] - last.axes[0]).abs() < 0.4, "{} then {}", last.axes[0], joints.axes[0]);
        last = joints;
    }
    assert_eq!(messages.text(), "first\nrecipe\ntrue\n-90\nfalse\nfalse\n");
    assert!(last.axes[0].abs() < 5.1, "{}", last.axes[0]);
    let warnings = [
        "t.arl:3: switcharl: the controller has no program nothing.arl to load",
        "t.arl:3: switcharl: there is no foreground channel 2, only channel 1",
    ];
    assert_eq!(controller.take_warnings(), warnings);
    let alarms: Vec<String> = controller.take_alarms().iter().map(ToString::to_string).collect();
    let text = "alarm 20004: switcharl: the channel is 7, but must be 1 to 6 (t.arl:3, background channel 1)";
    assert_eq!(alarms, [text]);
}
