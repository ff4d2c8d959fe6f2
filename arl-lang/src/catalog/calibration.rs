//! 5.9: frames from taught points.

use super::declare::{base, entries, folded, kind, param_type};
use super::facts::Role;

entries! { pub(super) CALIBRATION =
    /// Workpiece frame from three taught points.
    fn getwobj_3p(
        j1: joint "the tool at the frame's origin",
        j2: joint "the tool on the frame's +x axis",
        j3: joint "the tool in the frame's xy plane, on the +y side",
        t: tool "the tool",
    ) -> wobj
        { "5.9.1", calibration::getwobj_3p, acts, fails, foreground;
          "joint j1 = {1,0,120,0,30,0}\njoint j2 = {10,0,120,0,30,0}\njoint j3 = {15,0,110,0,30,0}\nprint getwobj_3p(j1,j2,j3,$TOOL0)" }
    /// Workpiece frame from three taught points whose coordinates in it are known.
    fn getwobj_indi(
        j1: joint "the tool at p1",
        j2: joint "the tool at p2",
        j3: joint "the tool at p3",
        p1: pos "first point in the workpiece frame, mm",
        p2: pos "second point in the workpiece frame, mm",
        p3: pos "third point in the workpiece frame, mm",
        t: tool "the tool",
    ) -> wobj
        { "5.9.2", calibration::getwobj_indi, acts, fails, foreground;
          "joint j1 = {1,0,120,0,30,0}\njoint j2 = {10,0,120,0,30,0}\njoint j3 = {15,0,110,0,30,0}\npos p1 = {10,20,20}\npos p2 = {40,60,20}\npos p3 = {50,20,40}\nprint getwobj_indi(j1,j2,j3,p1,p2,p3,$TOOL0)" }
    /// Workpiece frame (or the frame of a stationary tool) with its directions taken from the flange.
    fn getwobj_flange(
        j1: joint "the tool at the frame's origin",
        j2: joint "the flange's z along the frame's z, and x along x where the directions count",
        t: tool "the tool; its x, y, z count",
        xydefault: bool "true: only z is taken, x and y are chosen; false: all three",
    ) -> wobj
        { "5.9.3", calibration::getwobj_flange, acts, fails, foreground;
          "joint j1 = {4,42,85,88,85,-36}\njoint j2 = {3,42,86,92,85,-37}\nprint getwobj_flange(j1,j2,$TOOL0,true)" }
    /// Position of a tool's TCP from a tool that is known.
    fn gettooltcp_ref(
        j1: joint "the known tool at a point",
        j2: joint "the new tool at the same point",
        ref: tool [rust("reference")] "the known tool; its x, y, z count",
        t: tool [out] "the new tool: its x, y, z are written",
    )
        { "5.9.4", calibration::gettooltcp_ref, acts, fails, foreground;
          "joint j1 = {1,0,120,0,30,0}\njoint j2 = {10,0,120,0,30,0}\ntool known = {{x 10,y 10,z 50},false}\ntool t\ngettooltcp_ref(j1,j2,known,t)\nprint t" }
    /// Orientation of a tool that was aligned with the world: +x along the world's -z, +y along +y, +z along +x.
    fn gettoolrot_world(j: joint "the tool in that orientation", t: tool [out] "the tool: its a, b, c are written")
        { "5.9.5", calibration::gettoolrot_world, acts, fails, foreground;
          "joint j = {1,0,120,0,30,0}\ntool t\ngettoolrot_world(j,t)\nprint t" }
    /// Orientation of a tool from three taught points. The tool's x, y, z must be right already.
    fn gettoolrot_3p(
        j1: joint "the TCP at a point",
        j2: joint "a position on the tool's -x axis at the same point",
        j3: joint "a position in the tool's xy plane, on the -y side, at the same point",
        t: tool [out] "the tool: its a, b, c are written",
    )
        { "5.9.6", calibration::gettoolrot_3p, acts, fails, foreground;
          "joint j1 = {1,0,120,0,30,0}\njoint j2 = {10,0,120,0,30,0}\njoint j3 = {15,0,110,0,30,0}\ntool t\ngettoolrot_3p(j1,j2,j3,t)\nprint t" }
    /// Tool frame (or the frame of a workpiece that the robot holds) from a point of the cell that is known.
    fn gettool_3p(
        j1: joint "the frame's origin at the point",
        j2: joint "a position on the frame's +x axis at the point",
        j3: joint "a position in the frame's xy plane, on the +y side, at the point",
        w: wobj "the point in the world; its x, y, z count",
    ) -> tool
        { "5.9.7", calibration::gettool_3p, acts, fails, foreground;
          "wobj w = {{935,0,1300,0,0,0},false}\njoint j1 = {0,0,90,0,90,0}\njoint j2 = {0,0,90,0,-90,0}\njoint j3 = {0,0,90,90,90,0}\nprint gettool_3p(j1,j2,j3,w)" }
    /// Base frame of a mechanical unit from three taught points of the world; it is written to $BASE.
    fn getbase_3p(
        j1: joint "the tool at the world's origin",
        j2: joint "the tool on the world's +x axis",
        j3: joint "the tool in the world's xy plane, on the +y side",
        t: tool "the tool",
        index: int [at_least(1.0)] "number of the mechanical unit, from 1",
    )
        { "5.9.8", calibration::getbase_3p, acts, fails, foreground, changes(Role::Frame);
          "joint j1 = {1,0,120,0,30,0}\njoint j2 = {10,0,120,0,30,0}\njoint j3 = {15,0,110,0,30,0}\ngetbase_3p(j1,j2,j3,$TOOL0,1)\nprint $BASE" }
}
