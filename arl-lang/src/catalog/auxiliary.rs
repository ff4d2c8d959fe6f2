//! 3.5: print, scan, settings.

use super::declare::{base, entries, folded, kind, param_type};
use crate::ast::Unit;

entries! { pub(super) AUXILIARY =
    /// Writes values one after the other to the message bar, a file, the terminal or a string. A file in a directory
    /// that does not exist, or outside the script directory: alarm.
    instr print(
        to: {printto} [repeat(0, 4)] "where to, up to four; also applies to later prints of the channel; initially hmi",
        tostr: string [out, optional, labelled] "a variable that gets the text; nothing is then written elsewhere",
        filepath: string [optional, labelled] "the file for to:file, below the script directory; text is appended",
        precision: int [repeat(0, 255), labelled] "significant digits of doubles from here on, 0 counts as 1; 6 without it",
        numbase: {num_base} [repeat(0, 255)] "base of whole numbers from here on; dec without it",
        argtoprint: any [repeat(1, 255)] "a value; endl is a new line",
    )
        { "3.5.1", text::print, acts, fails; "print \"PI is \",precision:3,PI,\", 255 is \",hex,255,\"h\"" }
    /// Splits a text at a delimiter and reads the fields into variables, each as its type. Fields that are missing
    /// leave their variables unchanged; text that is not of the type: alarm.
    instr scan(
        from: string "the text",
        delimiter: string "what separates the fields",
        argtosave: {int, double, bool, string} [out, repeat(1, 255)] "a variable",
    )
        { "3.5.2", text::scan, pure, fails;
          "double x,y,z\nbool b\nscan from:\"1.1,1.2,1.3,true\",delimiter:\",\",x,y,z,b\nprint x,\" \",y,\" \",z,\" \",b" }
    /// Scales the programmed speeds of the motions that follow and limits their TCP speed.
    instr velset(
        override: int [units(&[Unit::Percent]), range(0.0, 100.0), rust("percent")] "part of the programmed speed, %, 0 to 100",
        max: int [units(&[Unit::MillimetrePerSecond]), at_least(0.0)] "largest TCP speed on paths, mm/s",
    )
        { "3.5.4", motion::velset, acts, fails, foreground; "velset 50,800" }
    /// Scales the acceleration and jerk of the motions that follow. Values below 20 count as 20.
    instr accset(
        acc: int [units(&[Unit::Percent]), range(0.0, 300.0)] "acceleration, % of the limit, up to 300",
        ramp: int [units(&[Unit::Percent]), range(0.0, 300.0)] "jerk, % of the limit, up to 300",
    )
        { "3.5.5", motion::accset, acts, fails, foreground; "accset 50,100" }
    /// Tells the controller which load the robot carries.
    instr toolload(toolinertia: tool_inertia_para "the load")
        { "3.5.6", motion::toolload, acts, fails, foreground;
          "ToolInertiaPara load = {30,{15,25,100},{10,20,30,40,50,60}}\ntoolload load\ntoolload $TOOL_INERTIA[3]" }
    /// Takes a load of $TOOL_INERTIA by its index.
    instr toolswitch(
        toolindex: int [range(0.0, 31.0)] "the index, 0 to 31",
        mu: string [optional, alias(&["mu_name"])] "name of the mechanical unit; the channel's own without it",
    )
        { "3.5.7", motion::toolswitch, acts, fails, foreground; "toolswitch toolindex:2" }
    /// Switches collision detection on.
    instr startdetect(
        cid: int [range(0.0, 16.0)] "number of the conditions: 0 for jogging, 1 to 16 for programs",
        mu: string [optional, alias(&["mu_name"])] "name of the mechanical unit; the channel's own without it",
    )
        { "3.5.8", motion::startdetect, acts, fails, foreground; "startdetect cid:1,mu:R1" }
    /// Switches collision detection off.
    instr enddetect(mu: string [optional, alias(&["mu_name"])] "name of the mechanical unit; the channel's own without it")
        { "3.5.9", motion::enddetect, acts, fails, foreground; "enddetect mu:R1" }
}
