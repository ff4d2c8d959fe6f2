//! The kinds of robots, if the crate is compiled without the language: otherwise they are those of `arl-lang`.

/// The kind of a robot.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug, Default)]
pub enum Family {
    /// Six axes with a spherical wrist.
    #[default]
    SixAxis,
    /// Four axes: two arms, a lift, a turning flange.
    Scara,
}
