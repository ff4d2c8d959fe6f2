//! 5.10 and 7.2: how far the motion being executed has come. A blend belongs to the motion that it leads into.

use super::declare::{base, entries, folded, kind, param_type};
use crate::ast::Unit;

entries! { pub(super) TRIGGER =
    /// Whether the motion has run for a time, counted at 100 % override. Outside the motion's time it is never true.
    /// Without a motion that is being executed it is false.
    fn T(t: double [units(&[Unit::Second])] "time from its start, s") -> bool
        { "5.10.1", event::elapsed_time, acts, looks, foreground;
          "joint j = {30,-90,90,0,45,0}\nmovej j,vp:20%\nwhile(!T(0.5))\nendwhile\nprint \"0.5 s on the way\"" }
    /// Whether the TCP has gone a distance. Outside the path, and on movej and ptp, it is never true.
    fn S(s: double [units(&[Unit::Millimetre])] "distance from the start, mm") -> bool
        { "5.10.2", event::elapsed_distance, acts, looks, foreground;
          "joint j = {0,-90,90,0,45,0}\nmovej j,vp:20%\npose p = getpose(j,$FLANGE,$WORLD)\np.z = p.z - 200\nlin p,vl:100mm/s\nwhile(!S(100))\nendwhile\nprint \"100 mm on the way\"" }
    /// Whether the TCP is within a distance of its target. Outside the path, and on movej and ptp, it is never true.
    fn StoEnd(s: double [units(&[Unit::Millimetre])] "distance to the target, mm") -> bool
        { "5.10.3", event::left_distance, acts, looks, foreground;
          "joint j = {0,-90,90,0,45,0}\nmovej j,vp:20%\npose p = getpose(j,$FLANGE,$WORLD)\np.z = p.z - 200\nlin p,vl:100mm/s\nwhile(!StoEnd(100))\nendwhile\nprint \"100 mm to go\"" }
    /// Whether a part of the motion has been run; on every kind of motion.
    fn P(p: double [units(&[Unit::Percent]), doubted()] "the part, %, 0 to 100") -> bool
        { "7.2", event::elapsed_percent, acts, looks, foreground;
          "joint j = {30,-90,90,0,45,0}\nmovej j,vp:20%\nwhile(!P(50))\nendwhile\nprint \"half of it is done\"" }
}
