//! 5.8: where the robot is and what it feels.

use super::declare::{base, entries, folded, kind, param_type};
use super::facts::{PoseShift, Space};

entries! { pub(super) POSE =
    /// Axis positions that the robot reports now; external axes that are not there stay unset.
    fn cjoint() -> joint
        { "5.8.1", pose::cjoint, acts, looks, foreground; "joint j = {0,-90,90,0,45,0}\nmovej j,vp:20%\nwaittime 0\nprint cjoint()" }
    /// Pose of the TCP that the robot reports now, with the tool $DFTOOL in the workpiece frame $DFWOBJ.
    fn cpose() -> pose
        { "5.8.2", pose::cpose_default, acts, looks, fails, foreground; "joint j = {0,-90,90,0,45,0}\nmovej j,vp:20%\nwaittime 0\nprint cpose()" }
    /// Pose of the TCP that the robot reports now. A tool or frame with a component that is not a number: alarm.
    fn cpose(t: tool "the tool", w: wobj "the workpiece frame") -> pose
        { "5.8.2", pose::cpose, acts, looks, fails, foreground; "joint j = {0,-90,90,0,45,0}\nmovej j,vp:20%\nwaittime 0\nprint cpose($FLANGE,$WORLD)" }
    /// Pose of the TCP for given axis positions. Unset axes: alarm.
    fn getpose(j: joint "the axis positions", t: tool "the tool", w: wobj "the workpiece frame") -> pose
        { "5.8.3", pose::getpose, acts, looks, fails, foreground; "joint j = {0,-90,90,0,45,0}\nprint getpose(j,$FLANGE,$WORLD)" }
    /// Axis positions for a pose of the TCP, in its arm configuration. A pose out of reach or not fully set: alarm.
    fn getjoint(p: pose "the pose", t: tool "the tool", w: wobj "the workpiece frame") -> joint
        { "5.8.4", pose::getjoint, acts, looks, fails, foreground;
          "joint j = {0,-90,90,0,45,0}\npose p = getpose(j,$FLANGE,$WORLD)\nprint getjoint(p,$FLANGE,$WORLD)" }
    /// The inverse: for the pose of a frame A seen from B, the pose of B seen from A.
    fn poseinv(p: pose "the pose") -> pose
        { "5.8.5", pose::poseinv, pure; "pose p = {x 1,y 2,z 3,a 0,b 0,c 0}\nprint poseinv(p)" }
    /// Shifts and turns a target in its workpiece frame. The point stays where the shift puts it; the turn acts about
    /// the point itself.
    fn offset(
        p: pose "the target",
        dx: double "shift along x of the workpiece frame, mm",
        dy: double "shift along y of the workpiece frame, mm",
        dz: double "shift along z of the workpiece frame, mm",
        rz: double "turn about z, deg, first",
        ry: double "turn about the new y, deg",
        rx: double "turn about the new x, deg",
    ) -> pose
        { "5.8.6", pose::offset, pure, shifts(PoseShift::Workpiece);
          "pose p = {x 1500,y 500,z 500,a 0,b 0,c 0}\nprint offset(p,10,20,30,60,50,40)" }
    /// Shifts and turns a target along the axes of its own tool frame.
    fn reltool(
        p: pose "the target",
        dx: double "shift along x of the tool, mm",
        dy: double "shift along y of the tool, mm",
        dz: double "shift along z of the tool, mm",
        rz: double "turn about z, deg, first",
        ry: double "turn about the new y, deg",
        rx: double "turn about the new x, deg",
    ) -> pose
        { "5.8.7", pose::reltool, pure, shifts(PoseShift::Tool);
          "pose p = {x 1500,y 500,z 500,a 0,b 0,c 0}\nprint reltool(p,10,20,30,40,50,60)" }
    /// Torques of the axes of a foreground channel, N*m.
    fn cjttq(
        chan_no: int [range(1.0, 6.0), addresses(Space::ForegroundChannel)] "the channel, 1 to 6",
        ls_cmd: bool "true: as commanded, false: as measured",
    ) -> jttq
        { "5.8.8", channel::cjttq, acts, looks, fails, alias(&["cjtq"]); "print cjttq(1,true)" }
    /// Motor currents of the axes of a foreground channel, A.
    fn cjtci(
        chan_no: int [range(1.0, 6.0), addresses(Space::ForegroundChannel)] "the channel, 1 to 6",
        ls_cmd: bool "true: as commanded, false: as measured",
    ) -> jtci
        { "5.8.9", channel::cjtci, acts, looks, fails, alias(&["cjtcj", "cjtc"]); "print cjtci(1,true)" }
    /// Axis positions of the target that a foreground channel moves to.
    fn channeltojoint(chan_no: int [range(1.0, 6.0), addresses(Space::ForegroundChannel)] "the channel, 1 to 6") -> joint
        { "5.8.10", channel::channeltojoint, acts, looks, fails; "print channeltojoint(1)" }
    /// Pose of the target that a foreground channel moves to.
    fn channeltopose(
        chan_no: int [range(1.0, 6.0), addresses(Space::ForegroundChannel)] "the channel, 1 to 6",
        t: tool "the tool",
        w: wobj "the workpiece frame",
    ) -> pose
        { "5.8.11", channel::channeltopose, acts, looks, fails; "print channeltopose(1,$FLANGE,$WORLD)" }
    /// Axis positions of a foreground channel now.
    fn channeljoint(
        chan_no: int [range(1.0, 6.0), addresses(Space::ForegroundChannel)] "the channel, 1 to 6",
        ls_cmd: bool "true: as commanded, false: as measured",
    ) -> joint
        { "5.8.12", channel::channeljoint, acts, looks, fails; "print channeljoint(1,true)" }
    /// Pose of the TCP of a foreground channel now.
    fn channelpose(
        chan_no: int [range(1.0, 6.0), addresses(Space::ForegroundChannel)] "the channel, 1 to 6",
        t: tool "the tool",
        w: wobj "the workpiece frame",
        ls_cmd: bool "true: as commanded, false: as measured",
    ) -> pose
        { "5.8.13", channel::channelpose, acts, looks, fails; "print channelpose(1,$FLANGE,$WORLD,true)" }
    /// Speeds of the axes of a foreground channel, rad/s.
    fn channeljointvel(
        chan_no: int [range(1.0, 6.0), addresses(Space::ForegroundChannel)] "the channel, 1 to 6",
        ls_cmd: bool "true: as commanded, false: as measured",
    ) -> jvel
        { "5.8.14", channel::channeljointvel, acts, looks, fails; "print channeljointvel(1,true)" }
    /// Speed of the TCP of a foreground channel, mm/s.
    fn channeltcpvel(
        chan_no: int [range(1.0, 6.0), addresses(Space::ForegroundChannel)] "the channel, 1 to 6",
        t: tool "the tool",
        w: wobj "the workpiece frame",
        ls_cmd: bool "true: as commanded, false: as measured",
    ) -> double
        { "5.8.15", channel::channeltcpvel, acts, looks, fails; "print channeltcpvel(1,$FLANGE,$WORLD,true)" }
    /// Force and torque that a foreground channel's robot exerts at its TCP, N and N*m.
    fn ctcpforce(
        chan_no: int [range(1.0, 6.0), addresses(Space::ForegroundChannel)] "the channel, 1 to 6",
        t: tool "the tool",
        w: wobj "the workpiece frame",
    ) -> tcpforce
        { "5.8.16", channel::ctcpforce, acts, looks, fails, foreground, alias(&["tcpforce"]);
          "print ctcpforce(1,$FLANGE,$WORLD)" }
}
