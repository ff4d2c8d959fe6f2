//! 3.2 and 3.3: motion.

use super::declare::{base, entries, folded, kind, param_type};
use super::facts::{Form, Motion, Role};
use super::types::Family;
use crate::ast::Unit;

// Speed and blending are given once each: as a structure, or in the simple way.
const AXIS: &[&[&str]] = &[&["v", "vp"], &["s", "sp", "sl"]];
const PATH: &[&[&str]] = &[&["v", "vl", "vp"], &["s", "sl", "sp"]];

entries! { pub(super) MOTION =
    /// Moves the axes to a target; all arrive together. Unset components stay where they are; the first motion of a
    /// program needs all of them.
    instr movej(
        j: joint "the target as axis positions",
        v: speed [optional] "speed: per and exj count; its set components go to $DFSPEED, which applies without it",
        vp: double [optional, units(&[Unit::Percent]), range(0.001, 100.0), set(), doubted()] "speed, % of the axes' limits",
        s: slip [optional] "blending: perdis, jdis and ejdis count; its set components go to $DFSLIP, which applies without it",
        sp: double [optional, units(&[Unit::Percent]), at_most(100.0), set(), doubted()] "blending zone, % of the largest; 0 or less: none",
        sl: double [optional, units(&[Unit::Millimetre]), set(), doubted()] "blending distance, mm; 0 or less: none",
        t: tool [optional, of(Family::SixAxis)] "the tool, whose speed is limited in manual mode; it goes to $DFTOOL, which applies without it",
        dura: double [optional, units(&[Unit::Second]), above(0.0), set()] "how long the motion takes, s; the speed is then ignored",
    )
        { "3.2.1", motion::movej, plans(Motion::Joint), fails, exclusive(AXIS);
          "joint j = {0,-90,90,0,45,0}\nmovej j,vp:20%\nmovej j:{j1 30},v:{per 10},sp:-1%" }
    /// Moves to a pose by the axes' shortest path; all arrive together. The TCP's path is not defined. Unset components
    /// stay where they are; the first motion of a program needs all of them.
    instr ptp(
        p: pose "the target; cfg and turn choose among the solutions",
        v: speed [optional] "speed: per and exj count; its set components go to $DFSPEED, which applies without it",
        vp: double [optional, units(&[Unit::Percent]), range(0.001, 100.0), set(), doubted()] "speed, % of the axes' limits",
        s: slip [optional] "blending: perdis, jdis and ejdis count; its set components go to $DFSLIP, which applies without it",
        sl: double [optional, units(&[Unit::Millimetre]), set(), doubted()] "blending distance, mm; 0 or less: none",
        sp: double [optional, units(&[Unit::Percent]), at_most(100.0), set(), doubted()] "blending zone, % of the largest; 0 or less: none",
        t: tool [optional] "the tool whose TCP moves; it goes to $DFTOOL, which applies without it",
        w: wobj [optional] "the frame of the target; it goes to $DFWOBJ, which applies without it",
        dura: double [optional, units(&[Unit::Second]), above(0.0), set()] "how long the motion takes, s; the speed is then ignored",
    )
        { "3.2.2", motion::ptp, plans(Motion::PointToPoint), fails, exclusive(AXIS);
          "joint j = {0,-90,90,0,45,0}\npose p = getpose(j,$FLANGE,$WORLD)\nptp p,vp:20%" }
    /// Moves the TCP on a straight line; the tool turns along with it. The arm configuration of the start is kept.
    instr lin(
        p: pose "the target; its cfg is ignored",
        v: speed [optional] "speed: tcp, ori, exj and exl count; its set components go to $DFSPEED, which applies without it",
        vl: double [optional, units(&[Unit::MillimetrePerSecond]), above(0.0), set(), doubted()] "speed of the TCP, mm/s",
        vp: double [optional, units(&[Unit::Percent]), range(0.001, 100.0), set(), doubted()] "speed, % of the robot's TCP limits",
        s: slip [optional] "blending: perdis, pdis, odis and ejdis count; its set components go to $DFSLIP, which applies without it",
        sl: double [optional, units(&[Unit::Millimetre]), set(), doubted()] "blending distance, mm; 0 or less: none",
        sp: double [optional, units(&[Unit::Percent]), at_most(100.0), set(), doubted()] "blending zone, % of the largest; 0 or less: none",
        t: tool [optional] "the tool whose TCP moves; it goes to $DFTOOL, which applies without it",
        w: wobj [optional] "the frame of the target; it goes to $DFWOBJ, which applies without it",
        dura: double [optional, units(&[Unit::Second]), above(0.0), set()] "how long the motion takes, s; the speed is then ignored",
    )
        { "3.2.3", motion::lin, plans(Motion::Line), fails, exclusive(PATH);
          "joint j = {0,-90,90,0,45,0}\npose p = getpose(j,$FLANGE,$WORLD)\nptp p,vp:20%\np.z = p.z - 50\nlin p,vl:100mm/s" }
    /// Moves the TCP through taught points on a smooth curve, without pause.
    instr spl(
        p: pose "the target; its cfg is ignored",
        v: speed [optional] "speed: tcp, ori and exj count; its set components go to $DFSPEED, which applies without it",
        vl: double [optional, units(&[Unit::MillimetrePerSecond]), above(0.0), set(), doubted()] "speed of the TCP, mm/s",
        vp: double [optional, units(&[Unit::Percent]), range(0.001, 100.0), set(), doubted()] "speed, % of the robot's TCP limits",
        s: slip [optional] "blending: perdis, pdis, odis and ejdis count; its set components go to $DFSLIP, which applies without it",
        sl: double [optional, units(&[Unit::Millimetre]), set(), doubted()] "blending distance, mm; 0 or less: none",
        sp: double [optional, units(&[Unit::Percent]), at_most(100.0), set(), doubted()] "blending zone, % of the largest; 0 or less: none",
        t: tool [optional] "the tool whose TCP moves; it goes to $DFTOOL, which applies without it",
        w: wobj [optional] "the frame of the target; it goes to $DFWOBJ, which applies without it",
    )
        { "3.2.4", motion::spl, plans(Motion::Spline), fails, exclusive(PATH);
          "joint j = {0,-90,90,0,45,0}\npose p = getpose(j,$FLANGE,$WORLD)\nptp p,vp:20%\np.y = p.y + 50\nspl p\np.x = p.x + 50\nspl p" }
    /// Moves the TCP on an arc through an auxiliary point to the target. Points on one line: alarm.
    instr cir(
        m: pose "a point on the arc; its x, y, z count",
        p: pose "the target; its cfg is ignored",
        v: speed [optional] "speed: tcp, ori and exj count; its set components go to $DFSPEED, which applies without it",
        vl: double [optional, units(&[Unit::MillimetrePerSecond]), above(0.0), set(), doubted()] "speed of the TCP, mm/s",
        vp: double [optional, units(&[Unit::Percent]), range(0.001, 100.0), set(), doubted()] "speed, % of the robot's TCP limits",
        s: slip [optional] "blending: perdis, pdis, odis and ejdis count; its set components go to $DFSLIP, which applies without it",
        sl: double [optional, units(&[Unit::Millimetre]), set(), doubted()] "blending distance, mm; 0 or less: none",
        sp: double [optional, units(&[Unit::Percent]), at_most(100.0), set(), doubted()] "blending zone, % of the largest; 0 or less: none",
        t: tool [optional] "the tool whose TCP moves; it goes to $DFTOOL, which applies without it",
        w: wobj [optional] "the frame of the points; it goes to $DFWOBJ, which applies without it",
        CA: double [optional, units(&[Unit::Degree]), range(-7200.0, 7200.0), set()] "angle of the arc, deg: the motion ends there, p only shapes the circle",
        dura: double [optional, units(&[Unit::Second]), above(0.0), set()] "how long the motion takes, s; the speed is then ignored",
    )
        { "3.2.5", motion::cir, plans(Motion::Arc), fails, exclusive(PATH);
          "joint j = {0,-90,90,0,45,0}\npose p = getpose(j,$FLANGE,$WORLD)\nptp p,vp:20%\npose m = offset(p,50,50,0,0,0,0)\np.x = p.x + 100\ncir m,p,vl:100mm/s" }
    /// Moves the TCP on an arc that consecutive ccir instructions make together, one point each. Fewer than three
    /// points, points on one line, equal neighbours, or a stop of the look-ahead between them: alarm 12002.
    instr ccir(
        p: pose "the target; its cfg is ignored",
        v: speed [optional] "speed: tcp, ori and exj count; its set components go to $DFSPEED, which applies without it",
        vl: double [optional, units(&[Unit::MillimetrePerSecond]), above(0.0), set(), doubted()] "speed of the TCP, mm/s",
        vp: double [optional, units(&[Unit::Percent]), range(0.001, 100.0), set(), doubted()] "speed, % of the robot's TCP limits",
        s: slip [optional] "blending: perdis, pdis, odis and ejdis count; its set components go to $DFSLIP, which applies without it",
        sl: double [optional, units(&[Unit::Millimetre]), set(), doubted()] "blending distance, mm; 0 or less: none",
        sp: double [optional, units(&[Unit::Percent]), at_most(100.0), set(), doubted()] "blending zone, % of the largest; 0 or less: none",
        t: tool [optional] "the tool whose TCP moves; it goes to $DFTOOL, which applies without it",
        w: wobj [optional] "the frame of the target; it goes to $DFWOBJ, which applies without it",
    )
        { "3.2.6", motion::ccir, plans(Motion::JoinedArc), fails, exclusive(PATH), only(Family::SixAxis);
          "joint j = {0,-90,90,0,45,0}\npose p = getpose(j,$FLANGE,$WORLD)\nptp p,vp:20%\np.x = p.x + 50\np.y = p.y + 50\nccir p\np.x = p.x + 50\np.y = p.y - 50\nccir p" }
    /// Lifts, moves over and lowers: the fast SCARA motion from position to position. Start or target above the limit
    /// Z: alarm 12042.
    instr jump(
        p: pose "the target",
        v: speed [optional] "speed: per and exj count; its set components go to $DFSPEED, which applies without it",
        vp: double [optional, units(&[Unit::Percent]), range(0.001, 100.0), set(), doubted()] "speed, % of the axes' limits",
        t: tool [optional] "the tool whose TCP moves; it goes to $DFTOOL, which applies without it",
        w: wobj [optional] "the frame of the target; it goes to $DFWOBJ, which applies without it",
        a: double [otherwise("25"), units(&[Unit::Millimetre]), at_least(0.0), set()] "how far it rises straight up, mm; 25 without it",
        b: double [otherwise("25"), units(&[Unit::Millimetre]), at_least(0.0), set()] "how far it sinks straight down, mm; 25 without it",
        Z: double [otherwise("0"), units(&[Unit::Millimetre])] "height that is not exceeded, mm; 0 without it: the robot's own limit",
        ctr: control [optional] "speeds and accelerations of rising and sinking; the motion's own without it",
        s: bool [otherwise("false")] "true: goes on to the next motion without stopping at the target",
        sig: bool [condition, otherwise("false")] "evaluated before sinking: if it is true, the robot stops above the target",
    )
        { "3.3.6", motion::jump, plans(Motion::Jump), fails, form(Form::Jump), exclusive(&[&["v", "vp"]]), only(Family::Scara);
          "movej j:{0,30,100,0},vp:50%\npose p = {x 400,y 100,z 350,a 0,b 0,c 0}\njump p,vp:50%,a:30,b:30" }
    /// Lays a weave over the lines, circles and splines that follow, up to endweave. It begins and ends on the path;
    /// what is too fast for the robot slows the path down.
    instr startweave(weave: weavedata "the pattern")
        { "3.2.7.1", motion::startweave, acts, fails, foreground, until("endweave"), only(Family::SixAxis),
          alias(&["startweavelin", "startweavespa"]);
          "weavedata zigzag = {weaveshape simple,frequency 2,amplitude 5}\nstartweave zigzag\nendweave" }
    /// Ends the weave.
    instr endweave()
        { "3.2.7.2", motion::endweave, acts, fails, foreground, only(Family::SixAxis);
          "weavedata zigzag = {weaveshape simple,frequency 2,amplitude 5}\nstartweave zigzag\nendweave" }
    /// Begins to compensate the lines, circles and splines that follow, up to endcompen. All limits must be above 0.
    instr startcompen(data: compendata "how fast the compensation may grow")
        { "3.2.11.1", motion::startcompen, acts, fails, foreground, until("endcompen"), changes(Role::Compensation),
          only(Family::SixAxis);
          "compendata limits = {200,600,1000,200,50,1000}\nstartcompen data:limits\nendcompen" }
    /// Shifts and turns the lines, circles and splines that follow, up to endcompen, cumulatively. At most 90 deg in
    /// all about each axis.
    instr compen(
        x: double [optional, units(&[Unit::Millimetre]), set()] "shift along x of the frame, mm",
        y: double [optional, units(&[Unit::Millimetre]), set()] "shift along y of the frame, mm",
        z: double [optional, units(&[Unit::Millimetre]), set()] "shift along z of the frame, mm",
        a: double [optional, units(&[Unit::Degree]), range(-180.0, 180.0), set()] "turn about z of the frame, deg",
        b: double [optional, units(&[Unit::Degree]), range(-180.0, 180.0), set()] "turn about y of the frame, deg",
        c: double [optional, units(&[Unit::Degree]), range(-180.0, 180.0), set()] "turn about x of the frame, deg",
        type: {compentype, string} [rust("frame")] "the frame, as a constant or as its name in a string",
    )
        { "3.2.11.2", motion::compen, acts, fails, foreground, only(Family::SixAxis);
          "compendata limits = {200,600,1000,200,50,1000}\nstartcompen data:limits\ncompen x:100,y:0,z:0,a:0,b:0,c:0,type:\"WOBJ\"\nendcompen" }
    /// Ends the compensation; the next motion starts from the compensated point.
    instr endcompen()
        { "3.2.11.3", motion::endcompen, acts, fails, foreground, only(Family::SixAxis);
          "compendata limits = {200,600,1000,200,50,1000}\nstartcompen data:limits\nendcompen" }
}
