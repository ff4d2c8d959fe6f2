//! 5.10 and 7.2: how far the motion is that is being executed.

use super::declare::{base, entries, folded, kind, param_type};
use crate::ast::Unit;

entries! { pub(super) TRIGGER =
    /// Whether the motion has run for a time, counted at 100 % override. Outside the motion's time it never comes.
    fn T(t: double [units(&[Unit::Second])] "time from its start, s") -> bool
        { "5.10.1", event::elapsed_time, acts, foreground, notyet;
          "joint j = {0,-90,90,0,45,0}\ntrigger 1,when:T(0.5),do:setdo(1,true)\nmovej j,vp:20%" }
    /// Whether the TCP has gone a distance. Outside the path, and on movej and ptp, it never comes.
    fn S(s: double [units(&[Unit::Millimetre])] "distance from the start, mm") -> bool
        { "5.10.2", event::elapsed_distance, acts, foreground, notyet;
          "joint j = {0,-90,90,0,45,0}\nmovej j,vp:20%\npose p = getpose(j,$FLANGE,$WORLD)\np.z = p.z - 200\ntrigger 1,when:S(100),do:setdo(1,true)\nlin p,vl:100mm/s" }
    /// Whether the TCP is as near to its target. Outside the path, and on movej and ptp, it never comes.
    fn StoEnd(s: double [units(&[Unit::Millimetre])] "distance to the target, mm") -> bool
        { "5.10.3", event::left_distance, acts, foreground, notyet;
          "joint j = {0,-90,90,0,45,0}\nmovej j,vp:20%\npose p = getpose(j,$FLANGE,$WORLD)\np.z = p.z - 200\ntrigger 1,when:StoEnd(100),do:setdo(1,true)\nlin p,vl:100mm/s" }
    /// Whether a part of the motion has been run; on every kind of motion.
    fn P(p: double [units(&[Unit::Percent])] "the part, %, 0 to 100") -> bool
        { "7.2", event::elapsed_percent, acts, foreground, notyet;
          "joint j = {0,-90,90,0,45,0}\ntrigger 1,when:P(50),do:setdo(2,true)\nmovej j,vp:20%" }
}
