//! The system variables: chapter 10, the settings of chapter 9, and those of the sockets.

use super::declare::{base, folded, variables};
use super::facts::Role;

variables! { pub(super) DATA =
    /// 100 ints for the user; savesv keeps them.
    I: int[100] = "{0}" { "10.1.1", saved; "$I[0] = 7\nprint $I[0]" }
    /// Names for the elements of $I.
    I_NAME: string[100] = "{\"\"}" { "10.1.2", permanent, alias(&["_NAME"]); "$I_NAME[0] = \"parts\"\nprint $I_NAME[0]" }
    /// 100 bools for the user; savesv keeps them.
    B: bool[100] = "{false}" { "10.1.3", saved; "$B[0] = true\nprint $B[0]" }
    /// Names for the elements of $B.
    B_NAME: string[100] = "{\"\"}" { "10.1.4", permanent; "$B_NAME[0] = \"ready\"\nprint $B_NAME[0]" }
    /// 100 doubles for the user; savesv keeps them.
    D: double[100] = "{0}" { "10.1.5", saved; "$D[0] = 1.5\nprint $D[0]" }
    /// Names for the elements of $D.
    D_NAME: string[100] = "{\"\"}" { "10.1.6", permanent; "$D_NAME[0] = \"height\"\nprint $D_NAME[0]" }
    /// 100 poses for the user; savesv keeps them.
    P: pose[100] = "{{9e+09}}" { "10.1.7", saved; "$P[0] = {x 100,y 0,z 50}\nprint $P[0].x" }
    /// 100 joints for the user; savesv keeps them.
    J: joint[100] = "{{9e+09}}" { "10.1.8", saved; "$J[0] = {j1 10}\nprint $J[0].j1" }
    /// 32 tools for the user; savesv keeps them. By their default names they are $tool0 to $tool31.
    TOOLS: tool[32] = "{{{0},false}}" { "10.1.9", saved, elements("tool"); "$TOOLS[1] = {{0,0,120,0,0,0},false}\nprint $TOOLS[1]" }
    /// Names for the elements of $TOOLS.
    TOOLS_NAME: string[32] = "{\"\"}" { "10.1.10", permanent; "$TOOLS_NAME[1] = \"gripper\"\nprint $TOOLS_NAME[1]" }
    /// 32 workpiece frames for the user; savesv keeps them. By their default names they are $wobj0 to $wobj31.
    WOBJS: wobj[32] = "{{{0},false}}" { "10.1.11", saved, elements("wobj"); "$WOBJS[1] = {{500,0,100,0,0,0},false}\nprint $WOBJS[1]" }
    /// Names for the elements of $WOBJS.
    WOBJS_NAME: string[32] = "{\"\"}" { "10.1.12", permanent; "$WOBJS_NAME[1] = \"pallet\"\nprint $WOBJS_NAME[1]" }
    /// Where the bases of the mechanical units stand in the world.
    BASE: wobj[3] = "{{{0,0,0,0,0,0},false},{{0,0,0,0,0,0},false},{{0,0,0,0,0,0},false}}"
        { "10.1.13", saved, role(Role::Frame); "print $BASE[0]" }
    /// The flange as a tool: no tool at all.
    FLANGE: tool = "{{0,0,0,0,0,0},false}" { "10.1.14", permanent, role(Role::Flange), readonly; "print $FLANGE" }
    /// The world as a workpiece frame.
    WORLD: wobj = "{{0,0,0,0,0,0},false,\"WORLD\"}" { "10.1.15", permanent, role(Role::World), readonly; "print $WORLD" }
    /// 32 loads, for toolload and toolswitch.
    TOOL_INERTIA: tool_inertia_para[32] = "{{0}}" { "3.5.6", saved; "$TOOL_INERTIA[3].m = 1500\nprint $TOOL_INERTIA[3].m" }
}

variables! { pub(super) FUNCTION =
    /// Whether lines and arcs may pass near the wrist singularity (axis 5 at 0): the TCP's position is kept at the cost
    /// of its orientation.
    WRIST: bool = "false" { "10.2.1", reset, role(Role::WristPassage); "$WRIST = true" }
    /// Whether targets are reached in the configuration they were taught in (cfg and turn); false: in the one nearest
    /// to the current axes.
    CONFIG_CHECK: bool = "true"
        { "10.2.2", reset, role(Role::ConfigurationCheck), alias(&["Congfig_check", "check_congfig", "check_config"]); "$CONFIG_CHECK = false" }
    /// Speed of motions that give none: per %, tcp mm/s, ori deg/s, exj deg/s, exl mm/s.
    DFSPEED: speed = "{5,50,400,5,5}" { "10.2.3", reset; "$DFSPEED.per = 20\nprint $DFSPEED" }
    /// Blending of motions that give none.
    DFSLIP: slip = "{-1.0,-1.0}" { "10.2.4", reset; "print $DFSLIP" }
    /// Tool of motions that give none.
    DFTOOL: tool = "{{0,0,0,0,0,0},false}" { "10.2.5", reset, role(Role::DefaultTool); "$DFTOOL = $TOOLS[1]\nprint $DFTOOL" }
    /// Workpiece frame of motions that give none.
    DFWOBJ: wobj = "{{0,0,0,0,0,0},false}" { "10.2.6", reset, role(Role::DefaultWorkpiece); "$DFWOBJ = $WOBJS[1]\nprint $DFWOBJ" }
    /// Whether targets' a, b, c are ignored: the tool keeps its orientation.
    IGNORE_ORI: bool = "false" { "10.2.7", reset, role(Role::Frame); "$IGNORE_ORI = true" }
    /// Whether the tool turns along with the path on arcs.
    ORI_REF_PATH: bool = "false" { "10.2.8", reset, role(Role::ArcOrientation); "$ORI_REF_PATH = true" }
    /// Speed profile of the motions that follow; initially the robot file's.
    VEL_PROFILE: vel_profile = "S_TYPE" { "10.2.9", reset; "$VEL_PROFILE = S_TYPE\nprint $VEL_PROFILE" }
    /// Time since the motion being executed began, s.
    TRAJ_ELAPSE_TIME: double = "0" { "10.2.10", reset, readonly; "print $TRAJ_ELAPSE_TIME" }
    /// Time until the motion being executed ends, s.
    TRAJ_LEFT_TIME: double = "0" { "10.2.11", reset, readonly; "print $TRAJ_LEFT_TIME" }
    /// Distance covered by the TCP since the motion being executed began, mm.
    TRAJ_ELAPSE_DIS: double = "0" { "10.2.12", reset, readonly; "print $TRAJ_ELAPSE_DIS" }
    /// Distance left to the TCP until the motion being executed ends, mm.
    TRAJ_LEFT_DIS: double = "0" { "10.2.13", reset, readonly; "print $TRAJ_LEFT_DIS" }
    /// Axis positions of the target planned last, for motions relative to it.
    CJOINT: joint = "{9e+09}" { "10.2.14", reset, readonly; "joint j = {0,-90,90,0,45,0}\nmovej j,vp:20%\nprint $CJOINT" }
    /// Whether the first motion of a program runs at manual speed and stops at its end.
    RPP_ENABLE: bool = "false" { "10.2.15", reset; "$RPP_ENABLE = true" }
    /// Whether the robot is at each of the five home points.
    AT_HOME: bool[5] = "{false,false,false,false,false}" { "10.2.16", startup, readonly; "print $AT_HOME[0]" }
    /// Whether the external control is active.
    EXT_CTL_ACT: bool = "false" { "10.2.17", startup, readonly; "print $EXT_CTL_ACT" }
    /// Set to true to ask the external control for a program number; it drives the output $PGNO_REQ_DO.
    PGNO_REQ: bool = "false" { "10.2.18", reset; "$PGNO_REQ = true" }
    /// The program number that the external control has given; -1: none yet.
    PGNO: int = "-1" { "10.2.19", startup; "print $PGNO" }
    /// The number pi.
    PI: double = "3.1415926535897932" { "10.2.20", permanent, readonly; "print $PI" }
    /// The operating mode.
    CTL_MODE: controlmode = "AUTO" { "10.2.21", startup, readonly; "print $CTL_MODE" }
    /// Shift and turn of all workpiece frames: x, y, z mm, a, b, c deg.
    WOBJ_OFFSET: double[6] = "{0,0,0,0,0,0}" { "10.2.22", reset, role(Role::Frame); "$WOBJ_OFFSET = {50,50,50,0,0,0}\nprint $WOBJ_OFFSET" }
    /// Shift and turn of all tools: x, y, z mm, a, b, c deg.
    TOOL_OFFSET: double[6] = "{0,0,0,0,0,0}" { "10.2.23", reset, role(Role::Frame); "$TOOL_OFFSET = {50,0,0,0,0,0}\nprint $TOOL_OFFSET" }
    /// Where each mechanical unit is assumed to be at servo-on: "feedback", where it is; "cmd", where it was sent last,
    /// if it is near enough.
    RESET_POS_TYPE: string[100] = "{\"\"}"
        { "10.2.24", permanent, words(&["", "feedback", "cmd"]); "$RESET_POS_TYPE[0] = \"feedback\"" }
    /// How near is near enough for $RESET_POS_TYPE, deg.
    RESET_POS_THRESHOLD: double[100] = "{0}"
        { "10.2.25", permanent, range(0.0, 0.5), alias(&["RESET_POS_THESHOLD"]); "$RESET_POS_THRESHOLD[0] = 0.1" }
}

variables! { pub(super) SOCKETS =
    /// Whether a connection that the other side closes sets the socket's error state instead of raising an alarm.
    DETECT_SOCKET_CLOSE: bool = "false"
        { "5.6.1.5", reset, alias(&["DETECT_SOCK_CLOSE"]); "$DETECT_SOCKET_CLOSE = true" }
    /// What geterror gives for a connection that the other side has closed.
    ERR_SOCKET_CLOSED: int = "1"
        { "5.6.1.5", permanent, readonly, alias(&["ERR_SOCKET_CLOSE", "ERR_SOCK_CLOSED"]);
          "socket s\nif(geterror(s) == $ERR_SOCKET_CLOSED) print \"closed\"" }
}

variables! { pub(super) EXTERNAL =
    /// Input that activates the external control; 0: it is active by itself.
    EXT_CTL_ACT_DI: int = "0" { "9.1.15", saved; "$EXT_CTL_ACT_DI = 1" }
    /// Input that switches the servos on with a pulse of 30 ms or more; 0: none.
    SERVO_ON_DI: int = "0" { "9.1.15", saved; "$SERVO_ON_DI = 2" }
    /// Input that switches the servos off with a pulse of 30 ms or more; 0: none.
    SERVO_OFF_DI: int = "0" { "9.1.15", saved; "$SERVO_OFF_DI = 3" }
    /// Input whose rising edge starts the program; 0: none.
    START_PROG_DI: int = "0" { "9.1.15", saved; "$START_PROG_DI = 4" }
    /// Input whose rising edge pauses the program; 0: none.
    PAUSE_PROG_DI: int = "0" { "9.1.15", saved; "$PAUSE_PROG_DI = 5" }
    /// Input that resets the program while it is true; 0: none.
    RESET_PROG_DI: int = "0" { "9.1.15", saved; "$RESET_PROG_DI = 6" }
    /// Input whose rising edge clears the alarm; 0: none.
    CLEAR_ALARM_DI: int = "0" { "9.1.15", saved; "$CLEAR_ALARM_DI = 7" }
    /// How the program number is coded: 0 binary, 1 BCD, 2 one input out of n.
    PGNO_TYPE: int = "0" { "9.1.15", saved, range(0.0, 2.0); "$PGNO_TYPE = 1" }
    /// How many inputs the program number has, 1 to 16; 4, 8, 12 or 16 in BCD.
    PGNO_LENGTH: int = "8" { "9.1.15", saved, range(1.0, 16.0); "$PGNO_LENGTH = 4" }
    /// Input of the program number's lowest bit; 0: none.
    PGNO_FBIT_DI: int = "0" { "9.1.15", saved; "$PGNO_FBIT_DI = 21" }
    /// Input of the program number's parity bit: positive for even, negative for odd; 0: no parity.
    PGNO_PARITY_DI: int = "0" { "9.1.15", saved; "$PGNO_PARITY_DI = -30" }
    /// Input whose rising edge says that the program number is there; 0: none.
    PGNO_VALID_DI: int = "0" { "9.1.15", saved; "$PGNO_VALID_DI = 31" }
    /// Output that shows that the external control is active; 0: none.
    EXT_CTL_ACT_CONF_DO: int = "0" { "9.1.16", saved; "$EXT_CTL_ACT_CONF_DO = 1" }
    /// Output that shows that the servos are on; 0: none.
    SERVO_ON_DO: int = "0" { "9.1.16", saved; "$SERVO_ON_DO = 2" }
    /// Output that asks for a program number; 0: none.
    PGNO_REQ_DO: int = "0" { "9.1.16", saved; "$PGNO_REQ_DO = 3" }
    /// Outputs that show that the robot is at each of the five home points; 0: none.
    AT_HOME_DO: int[5] = "{0,0,0,0,0}" { "9.1.16", saved; "$AT_HOME_DO[0] = 4" }
    /// Output that shows manual mode; 0: none.
    AT_T1_DO: int = "0" { "9.1.16", saved; "$AT_T1_DO = 9" }
    /// Output that shows manual mode at full speed; 0: none.
    AT_T2_DO: int = "0" { "9.1.16", saved; "$AT_T2_DO = 10" }
    /// Output that shows automatic mode; 0: none.
    AT_AUT_DO: int = "0" { "9.1.16", saved; "$AT_AUT_DO = 11" }
    /// Output of the lowest bit of the program number that was taken; 0: none.
    PGNO_ACK_FBIT_DO: int = "0" { "9.1.16", saved; "$PGNO_ACK_FBIT_DO = 12" }
    /// First of the two outputs that show the channel's state: 00 not loaded, 10 running, 01 paused, 11 stopped; 0:
    /// none.
    CHAN_STATE_DO: int = "0" { "9.1.16", saved; "$CHAN_STATE_DO = 20" }
}
