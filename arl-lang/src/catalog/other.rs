//! 5.12: time, files, system variables.

use super::declare::{base, entries, folded, kind, param_type};
use super::facts::Space;

entries! { pub(super) OTHER =
    /// Time of day as hh:mm:ss.
    fn ctime() -> string
        { "5.12.2", time::ctime, acts, looks; "print strlen(ctime())" }
    /// Date as YYYY-MM-DD.
    fn cdate() -> string
        { "5.12.3", time::cdate, acts, looks; "print strlen(cdate())" }
    /// Raises an alarm with file and line where a condition does not hold.
    fn assert(x: bool "what must hold")
        { "5.12.4", flow::assert, pure, fails; "int a = 6\nassert(a == 6)" }
    /// Saves a system variable: its value is restored at the next start. The program goes on when it is saved;
    /// robots go on meanwhile. A name that does not exist: alarm.
    fn savesv(svname: string [keeps] "the variable's name, without $")
        { "5.12.5", system::savesv, lasts, fails; "$TOOLS[0].t_frame.z = 120\nsavesv(\"TOOLS\")" }
    /// Sets the system variables of chapter 10.2 to their defaults and those of 10.1 to what was saved last.
    fn init()
        { "5.12.6", system::init, acts; "$DFSPEED = {10,50,5,5,5}\ninit()\nprint $DFSPEED" }
    /// A line of a text file. A file that is missing or damaged: alarm 10064; a line beyond the end: alarm 10065.
    fn gettextstr(
        file_path: string "the file",
        line_no: int "the line, from 1",
        external_file: bool [otherwise("false")] "false: below the script directory; true: below the USB directory",
    ) -> string
        { "5.12.7", files::gettextstr, waits, fails;
          "print to:file,filepath:\"notes.txt\",\"first line\",endl\nprint to:hmi,gettextstr(\"notes.txt\",1)" }
    /// Name of the file that contains the motion being executed, or the last one, even from before the controller was
    /// switched on.
    fn curmpfile(channel_index: int [range(1.0, 6.0), addresses(Space::ForegroundChannel)] "the foreground channel, 1 to 6") -> string
        { "5.12.8", channel::curmpfile, acts, looks, fails; "print curmpfile(1)" }
    /// Line of the motion being executed, or the last one, even from before the controller was switched on.
    fn curmpline(channel_index: int [range(1.0, 6.0), addresses(Space::ForegroundChannel)] "the foreground channel, 1 to 6") -> int
        { "5.12.9", channel::curmpline, acts, looks, fails; "print curmpline(1)" }
    /// Name of the file that the program is in; until it runs, the one that the channel's program was in when
    /// the controller was switched off.
    fn curppfile(channel_index: int [range(1.0, 6.0), addresses(Space::ForegroundChannel)] "the foreground channel, 1 to 6") -> string
        { "5.12.10", channel::curppfile, acts, looks, fails; "print curppfile(1)" }
    /// Line that the program is on; until it runs, the one that the channel's program was on when the controller
    /// was switched off.
    fn curppline(channel_index: int [range(1.0, 6.0), addresses(Space::ForegroundChannel)] "the foreground channel, 1 to 6") -> int
        { "5.12.11", channel::curppline, acts, looks, fails; "print curppline(1)" }
    /// Size of a file in the script directory, bytes. A file that is missing: alarm.
    fn filesize(file_name: string "the file") -> int
        { "5.12.12", files::filesize, waits, fails;
          "print to:file,filepath:\"size.txt\",\"ten bytes\",endl\nprint to:hmi,filesize(\"size.txt\") >= 10" }
    /// Gives a file in the script directory another name; true if it worked.
    fn renamefile(file_name: string "the file", new_file_name: string "its new name") -> bool
        { "5.12.13", files::renamefile, waits, fails;
          "print to:file,filepath:\"old.txt\",\"text\",endl\nprint to:hmi,renamefile(\"old.txt\",\"new.txt\")" }
    /// Deletes a file in the script directory; true if it worked.
    fn removefile(file_name: string "the file") -> bool
        { "5.12.14", files::removefile, waits, fails;
          "print to:file,filepath:\"gone.txt\",\"text\",endl\nprint to:hmi,removefile(\"gone.txt\")" }
}
