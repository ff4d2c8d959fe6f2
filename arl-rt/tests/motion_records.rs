//! What the controller records of motions.

#![allow(clippy::disallowed_methods)]

mod common;

use arl_rt::Controller;
use arl_rt::emit::*;
use arl_rt::motion::MotionKind;
use arl_rt::motion::{Limited, MotionRecord, NoBlend, SmallerZone};
use common::*;

fn zone_program(cx: &Cx) -> BoxFuture<'_> {
    Box::pin(async move {
        cx.line(FILE, 3);
        motion::movej(bent(0.0)).vp(50.0).run(cx).await.at(FILE, 3)?;
        cx.line(FILE, 4);
        motion::ptp(aside(cx, 0.0, 0.0)?).sl(0.0).run(cx).await.at(FILE, 4)?;
        cx.line(FILE, 5);
        motion::lin(aside(cx, 0.0, -80.0)?).vl(100.0).sl(20.0).run(cx).await.at(FILE, 5)?;
        cx.line(FILE, 6);
        motion::lin(aside(cx, 300.0, -80.0)?).vl(100.0).sl(900.0).run(cx).await.at(FILE, 6)?;
        cx.line(FILE, 7);
        motion::lin(aside(cx, 300.0, 0.0)?).vl(100.0).run(cx).await.at(FILE, 7)?;
        cx.line(FILE, 8);
        flow::waittime(0.5).run(cx).await.at(FILE, 8)?;
        cx.line(FILE, 9);
        motion::movej(bent(0.0)).vp(20.0).run(cx).await.at(FILE, 9)
    })
}

fn aside(cx: &Cx, dy: f64, dz: f64) -> Done<Pose> {
    let start = pose::getpose(cx, bent(0.0), Tool::default(), &cx.system().world.get()).at(FILE, 1)?;
    Ok(pose::offset(start, 0.0, dy, dz, 0.0, 0.0, 0.0))
}

fn records() -> (Vec<MotionRecord>, f64) {
    let (mut controller, _) = controller(Controller::builder().record_motions(), zone_program);
    controller.run();
    (controller.motions(), controller.time())
}

#[test]
fn every_motion_has_its_figures() {
    let (records, time) = records();
    let lines: Vec<_> = records.iter().map(|record| (record.number, record.line, record.kind)).collect();
    let expected = [
        (1, 3, MotionKind::Joints),
        (2, 4, MotionKind::Pose),
        (3, 5, MotionKind::Line),
        (4, 6, MotionKind::Line),
        (5, 7, MotionKind::Line),
        (6, 9, MotionKind::Joints),
    ];
    assert_eq!(lines, expected);
    let moving: f64 = records.iter().map(|record| record.duration).sum();
    // Without the wait, and the cycles in which it stands until laws lead.
    assert!(moving < time - 0.49 && moving > time - 0.53, "{moving} {time}");
    // It goes nowhere, so it never begins.
    assert_eq!((records[1].start, records[1].duration), (None, 0.0));
    for pair in records.windows(2) {
        let end = pair[0].start.unwrap_or_default() + pair[0].duration;
        assert!(pair[1].start.is_none_or(|start| start > end - 1e-6), "{pair:?}");
    }
    // Long enough for the programmed speed, and not above it.
    for (at, unit, speed) in [(0, "%", 50.0), (2, "mm/s", 100.0), (3, "mm/s", 100.0), (5, "%", 20.0)] {
        let record = &records[at];
        assert_eq!((record.programmed.value, record.programmed.unit), (speed, unit));
        assert!(record.reached <= speed * 1.001 && record.reached > speed * 0.99, "{record:?}");
    }
    assert!((records[2].path_length + records[3].path_length + records[4].path_length - 460.0).abs() < 60.0);
}

#[test]
fn blends_tell_what_was_asked_and_used() {
    let (records, _) = records();
    let blends: Vec<_> = records.iter().map(|record| record.zone().map(|it| (it.asked, it.used, it.unit))).collect();
    assert_eq!(blends[0], None);
    let Some((asked, used, "mm")) = blends[2] else { panic!("{blends:?}") };
    assert!(asked == 20.0 && (used - 20.0).abs() < 1e-6, "{used}");
    // A zone is half of the motion at most.
    let Some((asked, used, "mm")) = blends[3] else { panic!("{blends:?}") };
    assert!(asked == 900.0 && used <= 150.0 + 1e-6 && used > 30.0, "{used}");
    // The zone is still asked for, but the program waits.
    let Some((_, used, "mm")) = blends[4] else { panic!("{blends:?}") };
    assert_eq!(used, 0.0);
}

#[test]
fn the_closest_limits_are_within_reach() {
    let (records, _) = records();
    for record in records.iter().filter(|record| record.start.is_some()) {
        let [vel, acc, jerk] = record.closest().map(|closest| closest.expect("it moves"));
        for closest in [vel, acc, jerk] {
            assert!(closest.share > 0.0 && closest.share < 1.01, "{record:?}");
        }
    }
    // Axis motions between rests use all of something.
    for record in [&records[0], &records[5]] {
        let shares = record.closest().map(|closest| closest.map_or(0.0, |closest| closest.share));
        assert!(shares.into_iter().fold(0.0, f64::max) > 0.98, "{record:?}");
    }
    // j1 alone turns there, at half of its speed; the robot stands with all other axes.
    let [vel, ..] = records[0].closest();
    assert!(matches!(vel.map(|it| it.of), Some(Limited::Axis(_))) && (vel.unwrap().share - 0.5).abs() < 0.01);
}

#[test]
fn motions_that_wait_for_the_next_one_are_recorded_when_they_go() {
    let (mut controller, _) = controller(Controller::builder().record_motions(), |cx| {
        Box::pin(async move {
            motion::movej(bent(0.0)).vp(50.0).run(cx).await.at(FILE, 3)?;
            motion::lin(aside(cx, 0.0, -80.0)?).vl(100.0).sl(20.0).run(cx).await.at(FILE, 4)?;
            motion::spl(aside(cx, 60.0, -80.0)?).vl(100.0).run(cx).await.at(FILE, 5)?;
            motion::spl(aside(cx, 120.0, -40.0)?).vl(100.0).run(cx).await.at(FILE, 6)?;
            motion::lin(aside(cx, 120.0, 0.0)?).vl(100.0).run(cx).await.at(FILE, 7)
        })
    });
    assert_eq!(controller.run(), arl_rt::Outcome::Ended);
    let records = controller.motions();
    let kinds: Vec<_> = records.iter().map(|record| record.kind).collect();
    assert_eq!(kinds, [MotionKind::Joints, MotionKind::Line, MotionKind::Spline, MotionKind::Spline, MotionKind::Line]);
    for record in &records {
        assert!(record.start.is_some() && record.duration > 0.1 && record.reached > 0.0, "{record:?}");
        // A zone stays what it is where motions flow into each other.
        assert!(record.zone().is_none_or(|blend| blend.used <= blend.asked + 1e-6), "{record:?}");
    }
    assert!(records[1].zone().is_some_and(|blend| blend.used > 5.0), "{:?}", records[1].zone());
    assert!((records[2].path_length + records[3].path_length - 132.0).abs() < 25.0, "{records:?}");
}

#[test]
fn a_target_without_its_blend_has_the_reason() {
    let (mut controller, _) = controller(Controller::builder().record_motions(), |cx| {
        Box::pin(async move {
            motion::movej(bent(0.0)).vp(50.0).run(cx).await.at(FILE, 3)?;
            motion::lin(aside(cx, 0.0, -80.0)?).vl(100.0).sl(20.0).run(cx).await.at(FILE, 4)?;
            motion::lin(aside(cx, 0.0, 0.0)?).vl(100.0).sl(-1.0).run(cx).await.at(FILE, 5)
        })
    });
    controller.run();
    let why: Vec<_> = controller.motions().into_iter().map(|record| record.unblended).collect();
    assert_eq!(why, [None, Some(NoBlend::Reversal), None]);
    assert!(controller.motions()[1].zone().is_some_and(|blend| blend.used == 0.0));
}

/// The records of a program, and its trace: rows of numbers, those of absent axes 0.
fn records_and_rows<F>(program: F) -> (Vec<MotionRecord>, Vec<Vec<f64>>)
where
    F: for<'a> Fn(&'a Cx) -> BoxFuture<'a> + 'static,
{
    let kept = Kept::default();
    let (mut controller, _) = controller(Controller::builder().record_motions().trace(kept.clone()), program);
    assert_eq!(controller.run(), arl_rt::Outcome::Ended);
    let text = String::from_utf8_lossy(&kept.0.borrow()).into_owned();
    let number = |cell: &str| cell.parse().unwrap_or(0.0);
    let rows = text.lines().skip(1).map(|row| row.split(',').map(number).collect());
    (controller.motions(), rows.collect())
}

/// Lines at different speeds, with zones that take a part of them, and all of one.
fn zigzag(cx: &Cx) -> BoxFuture<'_> {
    Box::pin(async move {
        motion::movej(bent(0.0)).vp(50.0).run(cx).await.at(FILE, 3)?;
        motion::lin(aside(cx, 150.0, 0.0)?).vl(300.0).sl(20.0).run(cx).await.at(FILE, 4)?;
        motion::lin(aside(cx, 150.0, -200.0)?).vl(100.0).sl(20.0).run(cx).await.at(FILE, 5)?;
        motion::lin(aside(cx, 0.0, -200.0)?).vl(300.0).sl(40.0).run(cx).await.at(FILE, 6)?;
        motion::lin(aside(cx, 0.0, -170.0)?).vl(100.0).sl(40.0).run(cx).await.at(FILE, 7)?;
        motion::lin(aside(cx, 150.0, -170.0)?).vl(300.0).sl(30.0).run(cx).await.at(FILE, 8)
    })
}

#[test]
fn the_speed_that_is_reached_is_that_outside_of_zones() {
    let (records, rows) = records_and_rows(zigzag);
    // With its zones the slow line is twice as fast as programmed.
    let speed =
        |pair: &[Vec<f64>]| (0..3).map(|at| (pair[1][15 + at] - pair[0][15 + at]).powi(2)).sum::<f64>().sqrt() / 1e-3;
    let fastest = rows.windows(2).filter(|pair| pair[1][2] == 3.0).map(speed).fold(0.0, f64::max);
    assert!(fastest > 150.0, "{fastest}");
    for (record, speed) in records[1..].iter().zip([300.0, 100.0, 300.0]) {
        assert!(record.reached <= speed * 1.001 && record.reached > speed * 0.99, "{record:?}");
    }
    // Where zones take all of it, it is the speed between them.
    assert!(records[4].reached > 50.0 && records[4].reached < 300.0, "{:?}", records[4]);
}

#[test]
fn a_zone_that_is_not_used_as_asked_has_its_reason() {
    let (records, _) = records_and_rows(zigzag);
    let why: Vec<_> = records.iter().map(MotionRecord::smaller_zone).collect();
    assert_eq!(why, [None, None, None, None, Some(SmallerZone::Half), Some(SmallerZone::NothingBehind)]);
    let blend = records[4].zone().unwrap_or_else(|| panic!("no zone: {:?}", records[4]));
    assert!(blend.asked == 40.0 && (blend.used - 15.0).abs() < 1e-9, "{blend:?}");
    let (records, _) = records_and_rows(|cx| {
        Box::pin(async move {
            motion::movej(bent(0.0)).vp(50.0).run(cx).await.at(FILE, 3)?;
            motion::lin(aside(cx, 50.0, 0.0)?).vl(100.0).sl(20.0).run(cx).await.at(FILE, 4)?;
            flow::waittime(0.5).run(cx).await.at(FILE, 5)?;
            motion::spl(aside(cx, 60.0, -80.0)?).vl(100.0).sl(20.0).run(cx).await.at(FILE, 6)?;
            motion::spl(aside(cx, 120.0, -40.0)?).vl(100.0).run(cx).await.at(FILE, 7)
        })
    });
    let why: Vec<_> = records.iter().map(MotionRecord::smaller_zone).collect();
    // The zone holds on for the last one.
    let last = Some(SmallerZone::NothingBehind);
    assert_eq!(why, [None, Some(SmallerZone::NothingBehind), Some(SmallerZone::Flows), last]);
}

#[test]
fn a_motion_that_is_cut_off_says_so_of_its_zone() {
    let (mut controller, _) = controller(Controller::builder().record_motions(), zigzag);
    let has_begun = |controller: &Controller| controller.motions().get(5).is_some_and(|record| record.start.is_some());
    while !has_begun(&controller) {
        controller.step();
    }
    (0..20).for_each(|_| {
        controller.step();
    });
    controller.stop();
    (0..1000).for_each(|_| {
        controller.step();
    });
    let cut = controller.motions().swap_remove(5);
    assert_eq!(cut.smaller_zone(), Some(SmallerZone::Unfinished), "{cut:?}");
    assert_eq!(cut.zone().map(|zone| zone.used), Some(0.0), "{cut:?}");
}

#[test]
fn a_motion_that_is_cut_off_behind_its_first_blend_has_not_used_its_zone() {
    let (mut controller, _) = controller(Controller::builder().record_motions(), zigzag);
    let has_begun = |controller: &Controller| controller.motions().get(3).is_some_and(|record| record.start.is_some());
    while !has_begun(&controller) {
        controller.step();
    }
    controller.run_for(0.3);
    controller.stop();
    controller.run_for(1.0);
    let cut = controller.motions().swap_remove(3);
    assert_eq!(
        (cut.zone().map(|zone| zone.used), cut.smaller_zone()),
        (Some(0.0), Some(SmallerZone::Unfinished)),
        "{cut:?}"
    );
}

#[test]
fn a_zone_that_is_passed_within_a_cycle_is_used() {
    let (records, _) = records_and_rows(|cx| {
        Box::pin(async move {
            motion::movej(bent(0.0)).vp(50.0).run(cx).await.at(FILE, 3)?;
            for (line, far) in [(4, 100.0), (5, 200.0), (6, 300.0)] {
                motion::lin(aside(cx, far, 0.1 * far)?).vl(1000.0).sl(0.2).run(cx).await.at(FILE, line)?;
            }
            motion::lin(aside(cx, 300.0, -100.0)?).vl(1000.0).run(cx).await.at(FILE, 7)
        })
    });
    for record in &records[1..3] {
        assert_eq!(record.smaller_zone(), None, "{record:?}");
    }
}

#[test]
fn a_weave_is_not_part_of_the_speed_that_is_reached() {
    let (records, _) = records_and_rows(|cx| {
        Box::pin(async move {
            motion::movej(bent(0.0)).vp(50.0).run(cx).await.at(FILE, 3)?;
            let weave = Weavedata { frequency: 2.0, amplitude: 3.0, ..Weavedata::default() };
            motion::startweave(weave).run(cx).at(FILE, 4)?;
            motion::lin(aside(cx, 20.0, 0.0)?).vl(8.0).run(cx).await.at(FILE, 5)?;
            motion::endweave().run(cx).at(FILE, 6)
        })
    });
    let woven = &records[1];
    assert!(woven.reached <= 8.0001 && woven.reached > 7.9, "{woven:?}");
    // The way is that of the TCP, with the weave.
    assert!(woven.path_length > 40.0, "{woven:?}");
}

#[test]
fn the_distance_is_that_of_the_trace() {
    let (records, rows) = records_and_rows(zigzag);
    for record in records.iter().filter(|record| record.start.is_some()) {
        let step =
            |pair: &[Vec<f64>]| (0..3).map(|at| (pair[1][15 + at] - pair[0][15 + at]).powi(2)).sum::<f64>().sqrt();
        // The first row is that of the first cycle, which has gone a step already.
        let distance: f64 = rows.windows(2).filter(|pair| pair[1][2] == record.number as f64).map(step).sum();
        assert!((distance - record.path_length).abs() < 0.01, "{distance} {record:?}");
    }
}

#[test]
fn nothing_is_recorded_unless_asked_for() {
    let (mut controller, _) = controller(Controller::builder(), zone_program);
    controller.run();
    assert_eq!(controller.motions(), []);
}
