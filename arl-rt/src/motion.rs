//! What programs call to move the robot, and what they say about motion: the instructions, on the planner of `arl_motion`.

pub use arl_motion::*;

pub use crate::motion_instructions::{
    Above, AccSet, Ccir, Cir, Compen, CompenFrame, EndCompen, EndDetect, EndWeave, Jump, Lin, MoveJ, Ptp, Spl,
    StartCompen, StartDetect, StartWeave, ToolLoad, ToolSwitch, VelSet, accset, ccir, cir, compen, endcompen,
    enddetect, endweave, jump, lin, movej, ptp, spl, startcompen, startdetect, startweave, toolload, toolswitch,
    velset,
};
