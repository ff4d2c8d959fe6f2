//! The builds of robots, where there is no language that has programs for them: otherwise they are those of `arl-lang`.

/// The build of a robot.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug, Default)]
pub enum Family {
    /// Six axes with a spherical wrist.
    #[default]
    SixAxis,
    /// Four axes: two arms, a lift, a turning flange.
    Scara,
}
