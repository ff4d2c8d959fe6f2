//! Conversions between the structures of the robot families, and between positions and arrays.

use super::{Joint, JointScara, Jvel, JvelScara, Pose, Slip, SlipScara, UNSET};

/// Converts between structures that share components by name; components that only the target has keep their start
/// value.
macro_rules! shares {
    ($($from:ident => $to:ident { $($field:ident)* })*) => { $(
        impl From<$from> for $to {
            fn from(value: $from) -> $to {
                #[allow(clippy::needless_update, reason = "some targets have nothing of their own")]
                $to { $($field: value.$field,)* ..$to::default() }
            }
        }
    )* };
}

shares! {
    JointScara => Joint { j1 j2 j3 j4 ej1 ej2 ej3 ej4 ej5 ej6 }
    Joint => JointScara { j1 j2 j3 j4 ej1 ej2 ej3 ej4 ej5 ej6 }
    JvelScara => Jvel { jv1 jv2 jv3 jv4 ev1 ev2 ev3 ev4 ev5 ev6 }
    Jvel => JvelScara { jv1 jv2 jv3 jv4 ev1 ev2 ev3 ev4 ev5 ev6 }
    SlipScara => Slip { perdis pdis odis ejdis eldis }
    Slip => SlipScara { perdis pdis odis ejdis eldis }
}

/// All values of a structure that holds nothing but doubles, in the order of its components.
macro_rules! lists {
    ($($ty:ident[$count:literal] { $($field:ident)* })*) => { $(
        impl From<$ty> for [f64; $count] {
            #[inline]
            fn from(value: $ty) -> [f64; $count] {
                [$(value.$field,)*]
            }
        }

        impl From<[f64; $count]> for $ty {
            #[inline]
            fn from([$($field,)*]: [f64; $count]) -> $ty {
                $ty { $($field,)* }
            }
        }
    )* };
}

lists! {
    Joint[12] { j1 j2 j3 j4 j5 j6 ej1 ej2 ej3 ej4 ej5 ej6 }
    JointScara[10] { j1 j2 j3 j4 ej1 ej2 ej3 ej4 ej5 ej6 }
    Jvel[12] { jv1 jv2 jv3 jv4 jv5 jv6 ev1 ev2 ev3 ev4 ev5 ev6 }
    JvelScara[10] { jv1 jv2 jv3 jv4 ev1 ev2 ev3 ev4 ev5 ev6 }
}

impl Joint {
    /// A target with the robot's axes `j1` to `j6`; the external axes are unset.
    pub const fn of_axes([j1, j2, j3, j4, j5, j6]: [f64; 6]) -> Self {
        let ej = UNSET;
        Self { j1, j2, j3, j4, j5, j6, ej1: ej, ej2: ej, ej3: ej, ej4: ej, ej5: ej, ej6: ej }
    }

    /// The robot's axes, deg.
    pub const fn axes(&self) -> [f64; 6] {
        [self.j1, self.j2, self.j3, self.j4, self.j5, self.j6]
    }

    /// The external axes, deg or mm.
    pub const fn external(&self) -> [f64; 6] {
        [self.ej1, self.ej2, self.ej3, self.ej4, self.ej5, self.ej6]
    }
}

impl Pose {
    /// The external axes, deg or mm.
    pub const fn external(&self) -> [f64; 6] {
        [self.ej1, self.ej2, self.ej3, self.ej4, self.ej5, self.ej6]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn families_convert() {
        let scara = JointScara { j1: 1.0, j4: 4.0, ej2: 7.0, ..JointScara::default() };
        let joint = Joint::from(scara);
        assert_eq!(joint, Joint { j1: 1.0, j4: 4.0, ej2: 7.0, ..Joint::default() });
        assert_eq!(JointScara::from(joint), scara);
        let slip = Slip { perdis: 1.0, pdis: 2.0, odis: 3.0, ejdis: 4.0, eldis: 5.0, jdis: 6.0 };
        assert_eq!(Slip::from(SlipScara::from(slip)), Slip { jdis: UNSET, ..slip });
        let jvel = Jvel { jv1: 1.0, ev6: 2.0, ..Jvel::default() };
        assert_eq!(Jvel::from(JvelScara::from(jvel)), jvel);
    }

    #[test]
    fn lists_keep_the_order() {
        let numbers: [f64; 12] = std::array::from_fn(|at| at as f64);
        let joint = Joint::from(numbers);
        assert_eq!(<[f64; 12]>::from(joint), numbers);
        assert_eq!((joint.j6, joint.ej1, joint.external()[5]), (5.0, 6.0, 11.0));
        assert_eq!(Joint::of_axes(joint.axes()).ej1, UNSET);
    }
}
