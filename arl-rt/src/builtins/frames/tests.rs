//! Products and inverses of frames and poses, compared with their matrices.

use super::*;
use crate::values::text::{Print, Style};

fn shown(value: &dyn Print) -> String {
    value.printed(&Style::START).to_string()
}

fn pose(components: [f64; 6]) -> Pose {
    Pose::default().with_components(components)
}

/// Pseudo-random numbers from -1 to 1 by xorshift with a fixed seed.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0 as f64 / u64::MAX as f64 * 2.0 - 1.0
    }

    fn frame(&mut self) -> Frame {
        let scales = [2000.0, 2000.0, 2000.0, 180.0, 180.0, 180.0];
        Frame::of_components(scales.map(|scale| scale * self.next()))
    }
}

fn assert_same_rotation(left: &Matrix3<f64>, right: &Matrix3<f64>, about: &str) {
    assert!((left - right).abs().max() < 1e-9, "{about}: {left} is not {right}");
}

#[test]
fn multiples_of_ninety_are_exact() {
    for (angle, expected) in [
        (0.0, (0.0, 1.0)),
        (90.0, (1.0, 0.0)),
        (180.0, (0.0, -1.0)),
        (270.0, (-1.0, 0.0)),
        (-90.0, (-1.0, 0.0)),
        (-450.0, (-1.0, 0.0)),
        (720.0, (0.0, 1.0)),
        (3.6e9 + 90.0, (1.0, 0.0)),
    ] {
        assert_eq!(sin_cos(angle), expected, "{angle}");
    }
    let mut random = Random(7);
    for _ in 0..1000 {
        let angle = 1000.0 * random.next();
        let (sin, cos) = sin_cos(angle);
        assert!((sin - angle.to_radians().sin()).abs() < 1e-14);
        assert!((cos - angle.to_radians().cos()).abs() < 1e-14);
    }
}

#[test]
fn turns_are_about_the_new_axes() {
    let x = Vector3::x();
    assert_eq!(rotation([90.0, 0.0, 0.0]) * x, Vector3::y());
    assert_eq!(rotation([0.0, 90.0, 0.0]) * x, -Vector3::z());
    assert_eq!(rotation([0.0, 0.0, 90.0]) * Vector3::y(), Vector3::z());
    // After 90 about z, the new y points to -x: turning about it takes the new x, that is y, to -z.
    assert_eq!(rotation([90.0, 90.0, 0.0]) * x, -Vector3::z());
    assert_eq!(rotation([90.0, 0.0, 90.0]) * Vector3::z(), x);
    let parts = rotation([30.0, 0.0, 0.0]) * rotation([0.0, -40.0, 0.0]) * rotation([0.0, 0.0, 50.0]);
    assert_same_rotation(&rotation([30.0, -40.0, 50.0]), &parts, "zyx");
}

#[test]
fn angles_come_back() {
    let mut random = Random(42);
    for _ in 0..20_000 {
        let own = [180.0 * random.next(), 90.0 * random.next(), 180.0 * random.next()];
        let back = angles(&rotation(own));
        for (there, here) in own.iter().zip(back) {
            assert!((there - here).abs() < 1e-6, "{own:?} came back as {back:?}");
        }
    }
}

#[test]
fn near_the_lock_the_rotation_stays() {
    let mut random = Random(3);
    for round in 0..20_000 {
        let distance = 10f64.powf(-16.0 * f64::from(round % 100) / 99.0);
        let side = if round % 2 == 0 { 90.0 } else { -90.0 };
        let own = [180.0 * random.next(), side * (1.0 - distance * random.next()), 180.0 * random.next()];
        let matrix = rotation(own);
        let back = angles(&matrix);
        assert_same_rotation(&rotation(back), &matrix, &format!("{own:?} as {back:?}"));
        assert!(back[1].abs() <= 90.0 && back[0].abs() <= 180.0 && back[2].abs() <= 180.0);
    }
    assert_eq!(angles(&rotation([0.0, 90.0, 0.0])), [0.0, 90.0, 0.0]);
    assert_eq!(angles(&rotation([30.0, -90.0, 0.0])).map(f64::round), [30.0, -90.0, 0.0]);
    assert_eq!(angles(&rotation([30.0, 90.0, 10.0])).map(f64::round), [20.0, 90.0, 0.0]);
}

#[test]
fn angles_have_one_form() {
    assert_eq!(angles(&rotation([180.0, 0.0, 0.0])), [180.0, 0.0, 0.0]);
    assert_eq!(angles(&rotation([-180.0, 0.0, 0.0])), [180.0, 0.0, 0.0]);
    assert_eq!(angles(&rotation([0.0, 180.0, 0.0])), [180.0, 0.0, 180.0]);
    assert_eq!(angles(&rotation([270.0, 0.0, -540.0])), [-90.0, 0.0, 180.0]);
}

#[test]
fn frames_compose() {
    let a = Frame::of_components([100.0, 0.0, 0.0, 90.0, 0.0, 0.0]);
    let b = Frame::of_components([10.0, 20.0, 30.0, 0.0, 0.0, 90.0]);
    assert_eq!(shown(&(a * b)), "{80,10,30,90,0,90}");
    assert_eq!(shown(&(b * a)), "{110,20,30,90,-90,0}");
    assert_eq!(shown(&(a * a.inverse())), "{0,0,0,0,0,0}");
    let skew = Frame::of_components([1.5, 2.5, 3.5, 17.0, 0.0, 0.0]);
    assert_eq!(shown(&(skew.inverse() * skew)), "{0,0,0,0,0,0}", "no noise");
}

#[test]
fn products_obey_the_laws_of_transforms() {
    let mut random = Random(11);
    let close = |left: Frame, right: Frame| {
        let (l, r) = (left.components(), right.components());
        for at in 0..3 {
            assert!((l[at] - r[at]).abs() < 1e-8, "{left:?} is not {right:?}");
        }
        let [left, right] = [l, r].map(|c| rotation([c[3], c[4], c[5]]));
        assert_same_rotation(&left, &right, "product");
    };
    for _ in 0..2000 {
        let (a, b, c) = (random.frame(), random.frame(), random.frame());
        close((a * b) * c, a * (b * c));
        close(a * a.inverse(), Frame::default());
        close((a * b).inverse(), b.inverse() * a.inverse());
        close(a * Frame::default(), a);
        let p = pose(b.components());
        close(Frame::of_components((a * p).components()), a * b);
        close(Frame::of_components((p * a).components()), b * a);
        close(Frame::of_components((pose(a.components()) * p).components()), a * b);
    }
}

#[test]
fn a_pose_keeps_what_is_not_geometry() {
    let target = Pose { cfg: 3, turn: 5, ej1: 20.0, ..pose([1.0, 2.0, 3.0, 0.0, 0.0, 0.0]) };
    let other = Pose { cfg: 1, ej2: 9.0, ..pose([10.0, 0.0, 0.0, 90.0, 0.0, 0.0]) };
    let frame = Frame::of_components([10.0, 0.0, 0.0, 90.0, 0.0, 0.0]);
    let moved = "{8,1,3,90,0,0,3,5,20,9e+09,9e+09,9e+09,9e+09,9e+09}";
    assert_eq!(shown(&(frame * target)), moved);
    assert_eq!(shown(&(other * target)), moved);
    assert_eq!(shown(&(target * frame)), "{11,2,3,90,0,0,3,5,20,9e+09,9e+09,9e+09,9e+09,9e+09}");
    let inverse = poseinv(target);
    assert_eq!(shown(&inverse), "{-1,-2,-3,0,0,0,3,5,20,9e+09,9e+09,9e+09,9e+09,9e+09}");
}

#[test]
fn the_manuals_poses() {
    let p = pose([1.0, 2.0, 3.0, 0.0, 0.0, 0.0]);
    assert_eq!(shown(&poseinv(p)), "{-1,-2,-3,0,0,0,0,-1,9e+09,9e+09,9e+09,9e+09,9e+09,9e+09}");
    let p = pose([1500.0, 500.0, 500.0, 0.0, 0.0, 0.0]);
    let end = ",0,-1,9e+09,9e+09,9e+09,9e+09,9e+09,9e+09}";
    assert_eq!(shown(&offset(p, 10.0, 20.0, 30.0, 60.0, 50.0, 40.0)), format!("{{1510,520,530,60,50,40{end}"));
    assert_eq!(shown(&reltool(p, 10.0, 20.0, 30.0, 40.0, 50.0, 60.0)), format!("{{1510,520,530,40,50,60{end}"));
}

#[test]
fn displacements_act_in_their_own_axes() {
    let p = pose([100.0, 0.0, 0.0, 90.0, 0.0, 0.0]);
    assert_eq!(offset(p, 10.0, 0.0, 0.0, 0.0, 0.0, 90.0).components(), [110.0, 0.0, 0.0, 90.0, -90.0, 0.0]);
    assert_eq!(reltool(p, 10.0, 0.0, 0.0, 0.0, 0.0, 90.0).components(), [100.0, 10.0, 0.0, 90.0, 0.0, 90.0]);
    let odd = pose([1.0, 2.0, 3.0, 10.0, 135.0, 200.0]);
    assert_eq!(offset(odd, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0).components(), [2.0, 2.0, 3.0, 10.0, 135.0, 200.0]);
    assert_eq!(reltool(odd, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0).components()[3..], [10.0, 135.0, 200.0]);
    assert_eq!(reltool(odd, 0.0, 0.0, 0.0, 5.0, 0.0, 0.0).components()[..3], [1.0, 2.0, 3.0]);
}

#[test]
fn what_depends_on_an_unset_component_is_unset() {
    let unturned = pose([1.0, 2.0, 3.0, UNSET, 0.0, 0.0]);
    let unplaced = pose([UNSET, 2.0, 3.0, 90.0, 0.0, 0.0]);
    let frame = Frame::of_components([10.0, 0.0, 0.0, 90.0, 0.0, 0.0]);
    let u = UNSET;
    assert_eq!((frame * unturned).components(), [8.0, 1.0, 3.0, u, u, u]);
    assert_eq!((frame * unplaced).components(), [u, u, u, 180.0, 0.0, 0.0]);
    assert_eq!((unturned * frame).components(), [u; 6]);
    assert_eq!(poseinv(unplaced).components(), [u, u, u, -90.0, 0.0, 0.0]);
    assert_eq!(offset(unplaced, 1.0, 1.0, 1.0, 90.0, 0.0, 0.0).components(), [u, 3.0, 4.0, 180.0, 0.0, 0.0]);
    assert_eq!(offset(unturned, 1.0, 1.0, 1.0, 90.0, 0.0, 0.0).components(), [2.0, 3.0, 4.0, u, u, u]);
    assert_eq!(offset(unturned, 1.0, 1.0, 1.0, 0.0, 0.0, 0.0).components(), [2.0, 3.0, 4.0, u, 0.0, 0.0]);
    assert_eq!(reltool(unturned, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0).components(), [u, u, u, u, 0.0, 0.0]);
}
