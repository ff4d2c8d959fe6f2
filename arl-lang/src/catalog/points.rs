//! 5.11: points in data files, and the programs of channels.

use super::declare::{base, entries, folded, kind, param_type};

entries! { pub(super) POINTS =
    /// Copies a program file in the script directory; true if it worked.
    fn savearl(
        file_src: string "the file",
        file_dst: string "the copy",
        mode: bool "true: a file of that name is overwritten, false: it is left alone and the result is false",
    ) -> bool
        { "5.11.1", points::savearl, waits, fails, uses_disk; "print savearl(\"recipe1.arl\",\"recipe2.arl\",true)" }
    /// Writes a pose to a point of a data file; it takes effect at the next load. A file or point that is missing:
    /// false.
    fn savefilepose(
        file_name: string "the _data.arl file",
        pose_name: string [alias(&["p_name"])] "name of the pose in it",
        p: pose "the value",
    ) -> bool
        { "5.11.2", points::savefilepose, waits, fails, uses_disk;
          "pose a = {x 0,y 10,z 15,a 0,b 90,c 0}\nprint savefilepose(\"recipe1_data.arl\",\"p1\",a)" }
    /// Writes a joint to a point of a data file; it takes effect at the next load. A file or point that is missing:
    /// false.
    fn savefilejoint(
        file_name: string "the _data.arl file",
        joint_name: string [alias(&["pose_name"])] "name of the joint in it",
        j: joint "the value",
    ) -> bool
        { "5.11.3", points::savefilejoint, waits, fails, uses_disk;
          "joint a = {0,10,20,30,40,50}\nprint savefilejoint(\"recipe1_data.arl\",\"j1\",a)" }
    /// Writes a pose to a point of the program of a foreground channel; it takes effect at once.
    fn saveposenow(
        channel: uint [range(1.0, 6.0)] "the channel, 1 to 6",
        file_name: string "the program",
        pose_name: string "name of the pose in it",
        p: pose "the value",
    ) -> bool
        { "5.11.4", points::saveposenow, lasts, fails, teaches;
          "pose a = {x 0,y 10,z 15,a 0,b 90,c 0}\nprint saveposenow(1,\"prog1.arl\",\"p1\",a)" }
    /// Writes a joint to a point of the program of a foreground channel; it takes effect at once.
    fn savejointnow(
        channel: uint [range(1.0, 6.0)] "the channel, 1 to 6",
        file_name: string "the program",
        joint_name: string [alias(&["pose_name"])] "name of the joint in it",
        j: joint "the value",
    ) -> bool
        { "5.11.5", points::savejointnow, lasts, fails, teaches;
          "joint a = {0,10,20,30,40,50}\nprint savejointnow(1,\"prog1.arl\",\"j1\",a)" }
    /// Stops and unloads the program of a foreground channel and runs another one there; from background channels only.
    fn switcharl(
        channel: uint [range(1.0, 6.0)] "the channel, 1 to 6",
        file_name: string "the program",
    ) -> bool
        { "5.11.6", channel::switcharl, lasts, fails, alias(&["switchar"]);
          "print switcharl(1,\"recipe1.arl\")" }
}
