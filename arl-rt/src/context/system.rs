//! The system variables: `$DFSPEED`, `$I`, `$CJOINT` and their like.

use std::cell::Cell;
use std::ops::Deref;
use std::rc::Rc;

use crate::cycle::channel_id::{ChannelId, MOST_FOREGROUND};
use crate::storage::disk::Disk;
use crate::storage::state::{KeptState, Saved, StateError};
use crate::storage::state_format::StateFormat;
use crate::values::{
    Array, AsScara, Controlmode, Frame, Joint, Pose, Shared, Slip, SmallArray, Speed, Str, Teach, Tool,
    ToolInertiaPara, VelProfile, Watched, Wobj,
};

/// Declares variables: field, type, default, name, and when the default is restored.
macro_rules! system {
    (
        $(#[$meta:meta])*
        pub struct $Struct:ident { $( $(#[doc = $other_doc:literal])+ $other:ident: $Other:ty, )* }
        $( $(#[doc = $doc:literal])+ $field:ident: $kind:ident<$ty:ty> = $default:expr, $name:literal, $restore:ident; )*
    ) => {
        $(#[$meta])*
        #[derive(Debug)]
        pub struct $Struct {
            $( $(#[doc = $other_doc])+ $other: $Other, )*
            $(
                $(#[doc = $doc])+
                pub $field: $kind<$ty>,
            )*
        }

        impl $Struct {
            fn at_defaults($($other: $Other),*) -> Self {
                Self { $($other,)* $($field: $kind::<$ty>::new($default),)* }
            }

            /// Sets the variables of chapter 10.2 to their defaults, except those that the controller keeps current.
            fn reset_own(&self) {
                $( system!(@reset $restore self.$field = $default); )*
            }

            /// The variables that are stored when the controller is switched off.
            pub(crate) fn kept_own(&self) -> Vec<RetainedVariable<'_>> {
                let all: Vec<Option<RetainedVariable<'_>>> =
                    vec![$( system!(@keep $restore self.$field, $name, $ty, $default), )*];
                all.into_iter().flatten().collect()
            }

            /// Name and value of every variable, for a debugger.
            fn shown_own(&self) -> Vec<(&'static str, &dyn Teach)> {
                vec![$(($name, &self.$field as &dyn Teach),)*]
            }

            #[inline]
            fn has_changed_own(&self) -> bool {
                false $(|| system!(@changed $restore self.$field))*
            }

            /// Name and value of every variable, for tests that compare with the catalog.
            #[cfg(test)]
            fn all_own(&self) -> Vec<(&'static str, &'static str, &'static str, String, Str)> {
                use crate::values::text::{Print, Style};
                vec![$({
                    let value = self.$field.get();
                    (stringify!($field), $name, stringify!($restore), value.type_name(), value.printed(&Style::START))
                },)*]
            }
        }
    };
    (@reset Reset $self:ident.$field:ident = $default:expr) => { $self.$field.set($default) };
    (@reset $other:ident $self:ident.$field:ident = $default:expr) => {};
    (@changed Permanent $self:ident.$field:ident) => { $self.$field.is_changed() };
    (@changed $other:ident $self:ident.$field:ident) => { false };
    (@keep Saved $self:ident.$field:ident, $name:literal, $ty:ty, $default:expr) => {
        Some(RetainedVariable::new($name, false, &$self.$field, || encode::<$ty>(&$default)))
    };
    (@keep Permanent $self:ident.$field:ident, $name:literal, $ty:ty, $default:expr) => {
        Some(RetainedVariable::new($name, true, &$self.$field, || encode::<$ty>(&$default)))
    };
    (@keep $other:ident $self:ident.$field:ident, $name:literal, $ty:ty, $default:expr) => {
        None
    };
}

system! {
    /// The system variables of a controller that all its channels share.
    pub struct Common {}
    /// 100 ints for the user.
    i: Shared<SmallArray<i32, 100>> = SmallArray::start(), "I", Saved;
    /// Names for the elements of `$I`.
    i_name: Watched<Array<Str, 100>> = Array::start(), "I_NAME", Permanent;
    /// 100 bools for the user.
    b: Shared<SmallArray<bool, 100>> = SmallArray::start(), "B", Saved;
    /// Names for the elements of `$B`.
    b_name: Watched<Array<Str, 100>> = Array::start(), "B_NAME", Permanent;
    /// 100 doubles for the user.
    d: Shared<SmallArray<f64, 100>> = SmallArray::start(), "D", Saved;
    /// Names for the elements of `$D`.
    d_name: Watched<Array<Str, 100>> = Array::start(), "D_NAME", Permanent;
    /// 100 poses for the user.
    p: Shared<Array<Pose, 100>> = Array::start(), "P", Saved;
    /// 100 joints for the user.
    j: Shared<Array<Joint, 100>> = Array::start(), "J", Saved;
    /// 32 tools for the user.
    tools: Shared<Array<Tool, 32>> = Array::start(), "TOOLS", Saved;
    /// Names for the elements of `$TOOLS`.
    tools_name: Watched<Array<Str, 32>> = Array::start(), "TOOLS_NAME", Permanent;
    /// 32 workpiece frames for the user.
    wobjs: Shared<Array<Wobj, 32>> = Array::start(), "WOBJS", Saved;
    /// Names for the elements of `$WOBJS`.
    wobjs_name: Watched<Array<Str, 32>> = Array::start(), "WOBJS_NAME", Permanent;
    /// The flange as a tool: no tool at all. Read-only.
    flange: Cell<Tool> = Tool::default(), "FLANGE", Constant;
    /// The world as a workpiece frame. Read-only.
    world: Shared<Wobj> = world(), "WORLD", Constant;
    /// 32 loads.
    tool_inertia: Shared<Array<ToolInertiaPara, 32>> = Array::start(), "TOOL_INERTIA", Saved;
    /// Whether the external control is active. Read-only.
    ext_ctl_act: Cell<bool> = false, "EXT_CTL_ACT", Current;
    /// Whether the external control is asked for a program number.
    pgno_req: Cell<bool> = false, "PGNO_REQ", Reset;
    /// The program number that the external control has given; -1: none yet.
    pgno: Cell<i32> = NO_PROGRAM_NUMBER, "PGNO", Current;
    /// The value of `geterror` for a lost connection. Read-only.
    err_socket_closed: Cell<i32> = 1, "ERR_SOCKET_CLOSED", Constant;
    /// The number pi. Read-only.
    pi: Cell<f64> = std::f64::consts::PI, "PI", Constant;
    /// The operating mode. Read-only.
    ctl_mode: Cell<Controlmode> = Controlmode::Auto, "CTL_MODE", Current;
    /// The position that each mechanical unit assumes at servo-on.
    reset_pos_type: Watched<Array<Str, 100>> = Array::start(), "RESET_POS_TYPE", Permanent;
    /// The greatest distance for `$RESET_POS_TYPE`, deg.
    reset_pos_threshold: Watched<SmallArray<f64, 100>> = SmallArray::start(), "RESET_POS_THRESHOLD", Permanent;
    /// Input that activates the external control; 0: it is active by itself.
    ext_ctl_act_di: Cell<i32> = 0, "EXT_CTL_ACT_DI", Saved;
    /// Input that switches the servos on with a pulse of 30 ms or more; 0: none.
    servo_on_di: Cell<i32> = 0, "SERVO_ON_DI", Saved;
    /// Input that switches the servos off with a pulse of 30 ms or more; 0: none.
    servo_off_di: Cell<i32> = 0, "SERVO_OFF_DI", Saved;
    /// Input whose rising edge starts the program; 0: none.
    start_prog_di: Cell<i32> = 0, "START_PROG_DI", Saved;
    /// Input whose rising edge pauses the program; 0: none.
    pause_prog_di: Cell<i32> = 0, "PAUSE_PROG_DI", Saved;
    /// Input that resets the program while it is true; 0: none.
    reset_prog_di: Cell<i32> = 0, "RESET_PROG_DI", Saved;
    /// Input whose rising edge clears the alarm; 0: none.
    clear_alarm_di: Cell<i32> = 0, "CLEAR_ALARM_DI", Saved;
    /// How the program number is coded: 0 binary, 1 BCD, 2 one input out of n.
    pgno_type: Cell<i32> = 0, "PGNO_TYPE", Saved;
    /// How many inputs the program number has, 1 to 16; 4, 8, 12 or 16 in BCD.
    pgno_length: Cell<i32> = 8, "PGNO_LENGTH", Saved;
    /// Input of the program number's lowest bit; 0: none.
    pgno_fbit_di: Cell<i32> = 0, "PGNO_FBIT_DI", Saved;
    /// Input of the program number's parity bit: positive for even, negative for odd; 0: no parity.
    pgno_parity_di: Cell<i32> = 0, "PGNO_PARITY_DI", Saved;
    /// Input whose rising edge signals that the program number is valid; 0: none.
    pgno_valid_di: Cell<i32> = 0, "PGNO_VALID_DI", Saved;
    /// Output that shows that the external control is active; 0: none.
    ext_ctl_act_conf_do: Cell<i32> = 0, "EXT_CTL_ACT_CONF_DO", Saved;
    /// Output that shows that the servos are on; 0: none.
    servo_on_do: Cell<i32> = 0, "SERVO_ON_DO", Saved;
    /// Output that asks for a program number; 0: none.
    pgno_req_do: Cell<i32> = 0, "PGNO_REQ_DO", Saved;
    /// Outputs that show that the robot is at each of the five home points; 0: none.
    at_home_do: Shared<SmallArray<i32, 5>> = SmallArray::start(), "AT_HOME_DO", Saved;
    /// Output that shows manual mode; 0: none.
    at_t1_do: Cell<i32> = 0, "AT_T1_DO", Saved;
    /// Output that shows manual mode at full speed; 0: none.
    at_t2_do: Cell<i32> = 0, "AT_T2_DO", Saved;
    /// Output that shows automatic mode; 0: none.
    at_aut_do: Cell<i32> = 0, "AT_AUT_DO", Saved;
    /// Output of the lowest bit of the program number that was taken over; 0: none.
    pgno_ack_fbit_do: Cell<i32> = 0, "PGNO_ACK_FBIT_DO", Saved;
    /// First of the two outputs that show the channel's state: 00 not loaded, 10 running, 01 paused, 11 stopped; 0:
    /// none.
    chan_state_do: Cell<i32> = 0, "CHAN_STATE_DO", Saved;
}

system! {
    /// The system variables as a channel's program sees them: its own ones, and through [`Deref`] those that all
    /// channels share. Programs read and write them like their own global variables; the controller keeps those marked
    /// as read-only current.
    pub struct System {
        /// The variables that all channels share.
        common: Rc<Common>,
        /// The channel.
        channel: ChannelId,
    }
    /// The bases of the mechanical units in the world.
    base: Shared<SmallArray<Wobj, 3>> = SmallArray::start(), "BASE", Saved;
    /// Whether lines and arcs may pass near the wrist singularity.
    wrist: Cell<bool> = false, "WRIST", Reset;
    /// Whether targets are reached in the configuration that they were taught in.
    config_check: Cell<bool> = true, "CONFIG_CHECK", Reset;
    /// The speed of motions that give no speed: %, mm/s, deg/s, deg/s, mm/s.
    dfspeed: Cell<Speed> = DFSPEED, "DFSPEED", Reset;
    /// The blending of motions that give no blending.
    dfslip: Cell<Slip> = Slip { perdis: -1.0, pdis: -1.0, ..Slip::default() }, "DFSLIP", Reset;
    /// The tool of motions that give no tool.
    dftool: Cell<Tool> = Tool::default(), "DFTOOL", Reset;
    /// The workpiece frame of motions that give no workpiece frame.
    dfwobj: Shared<Wobj> = Wobj::default(), "DFWOBJ", Reset;
    /// Whether the orientation of targets is ignored.
    ignore_ori: Cell<bool> = false, "IGNORE_ORI", Reset;
    /// Whether the tool turns along with the path on arcs.
    ori_ref_path: Cell<bool> = false, "ORI_REF_PATH", Reset;
    /// The velocity profile of motions. The default is the robot's.
    vel_profile: Cell<VelProfile> = VelProfile::S, "VEL_PROFILE", Reset;
    /// Time since the motion being executed began, s. Read-only.
    traj_elapse_time: Cell<f64> = 0.0, "TRAJ_ELAPSE_TIME", Reset;
    /// Time until the motion being executed ends, s. Read-only.
    traj_left_time: Cell<f64> = 0.0, "TRAJ_LEFT_TIME", Reset;
    /// Distance covered by the TCP since the motion being executed began, mm. Read-only.
    traj_elapse_dis: Cell<f64> = 0.0, "TRAJ_ELAPSE_DIS", Reset;
    /// Distance left to the TCP until the motion being executed ends, mm. Read-only.
    traj_left_dis: Cell<f64> = 0.0, "TRAJ_LEFT_DIS", Reset;
    /// The axes of the target planned last, deg. Read-only.
    cjoint: Cell<Joint> = Joint::default(), "CJOINT", Reset;
    /// Whether the first motion of a program runs at manual speed.
    rpp_enable: Cell<bool> = false, "RPP_ENABLE", Reset;
    /// Whether the robot stands at each of the home points. Read-only.
    at_home: Shared<SmallArray<bool, 5>> = SmallArray::start(), "AT_HOME", Current;
    /// Shift and turn of all workpiece frames: mm, deg.
    wobj_offset: Shared<SmallArray<f64, 6>> = SmallArray::start(), "WOBJ_OFFSET", Reset;
    /// Shift and turn of all tools: mm, deg.
    tool_offset: Shared<SmallArray<f64, 6>> = SmallArray::start(), "TOOL_OFFSET", Reset;
    /// Whether programs check for lost connections themselves (`geterror`), instead of being ended by an alarm.
    detect_socket_close: Cell<bool> = false, "DETECT_SOCKET_CLOSE", Reset;
}

impl Deref for System {
    type Target = Common;

    #[inline]
    fn deref(&self) -> &Common {
        &self.common
    }
}

impl Common {
    /// All variables at their defaults.
    pub(crate) fn new() -> Self {
        Self::at_defaults()
    }
}

impl System {
    /// All variables at their defaults.
    pub fn new() -> Self {
        Self::beside(Rc::new(Common::new()), ChannelId::FIRST)
    }

    /// The variables of one more channel, at their defaults, together with the shared ones.
    pub(crate) fn beside(common: Rc<Common>, channel: ChannelId) -> Self {
        Self::at_defaults(common, channel)
    }

    /// Sets the variables of chapter 10.2 to their defaults, except those that the controller keeps current. The shared
    /// ones are reset by the first channel.
    pub(crate) fn reset(&self) {
        self.reset_own();
        if self.channel == ChannelId::FIRST {
            self.common.reset_own();
        }
    }

    /// All variables with their names without `$`, for a debugger.
    pub(crate) fn shown(&self) -> Vec<(&'static str, &dyn Teach)> {
        self.common.shown_own().into_iter().chain(self.shown_own()).collect()
    }

    /// Whether a variable may have changed all of whose changes are stored.
    #[inline]
    pub(crate) fn has_changed(&self) -> bool {
        self.has_changed_own() || self.common.has_changed_own()
    }

    /// The variables that are stored when the controller is switched off, as this channel sees them.
    pub(crate) fn kept(&self) -> Vec<RetainedVariable<'_>> {
        let mut kept = self.common.kept_own();
        kept.extend(self.kept_by_channel());
        kept
    }

    /// The channel's own ones among them: the base of its robot.
    pub(crate) fn kept_by_channel(&self) -> Vec<RetainedVariable<'_>> {
        let ChannelId::Foreground(number) = self.channel else { return Vec::new() };
        let own = self.kept_own().into_iter();
        let stored = |name: &'static str| BASES.get(usize::from(number)).copied().unwrap_or(name);
        own.map(|kept| RetainedVariable { stored: stored(kept.name), ..kept }).collect()
    }

    /// Name and value of every variable, for tests that compare with the catalog.
    #[cfg(test)]
    fn all(&self) -> Vec<(&'static str, &'static str, &'static str, String, Str)> {
        self.common.all_own().into_iter().chain(self.all_own()).collect()
    }
}

/// The variables whose type depends on the robot's family, as the programs of SCARA robots see them.
#[derive(Debug)]
pub struct ScaraSystem<'a> {
    /// `$J`.
    pub j: AsScara<'a, Shared<Array<Joint, 100>>>,
    /// `$DFSLIP`.
    pub dfslip: AsScara<'a, Cell<Slip>>,
    /// `$CJOINT`. Read-only.
    pub cjoint: AsScara<'a, Cell<Joint>>,
}

impl System {
    /// The variables as a SCARA robot's program sees them.
    pub fn scara(&self) -> ScaraSystem<'_> {
        ScaraSystem { j: AsScara::new(&self.j), dfslip: AsScara::new(&self.dfslip), cjoint: AsScara::new(&self.cjoint) }
    }
}

impl System {
    /// Sets the base of the robot in the world in `$BASE`.
    pub(crate) fn stand_on(&self, base: Frame) {
        self.base.update(|bases| {
            if let Some(first) = bases.first_mut() {
                first.w_frame = base;
            }
        });
    }
}

/// `$PGNO` before a program number was given.
const NO_PROGRAM_NUMBER: i32 = -1;

/// The default of `$DFSPEED`.
pub(crate) const DFSPEED: Speed = Speed { per: 5.0, tcp: 50.0, ori: 400.0, exj: 5.0, exl: 5.0 };

/// `$WORLD`.
fn world() -> Wobj {
    Wobj { mu_name: "WORLD".into(), ..Wobj::default() }
}

impl Default for System {
    fn default() -> Self {
        Self::new()
    }
}

/// The names of the files of `$BASE`, by the number of the channel.
const BASES: [&str; MOST_FOREGROUND + 1] = ["BASE", "BASE", "BASE.2", "BASE.3", "BASE.4", "BASE.5", "BASE.6"];

/// A variable that is stored when the controller is switched off.
pub(crate) struct RetainedVariable<'a> {
    /// The name without `$`.
    pub(crate) name: &'static str,
    /// The name of its file.
    stored: &'static str,
    /// Whether every change is stored, not only what `savesv` saves.
    always: bool,
    slot: &'a dyn Slot,
    default: fn() -> String,
}

impl<'a> RetainedVariable<'a> {
    fn new(name: &'static str, always: bool, slot: &'a dyn Slot, default: fn() -> String) -> Self {
        Self { name, stored: name, always, slot, default }
    }

    /// Begins to save its value.
    pub(crate) fn save(&self, state: &mut KeptState, disk: &Disk) -> Saved {
        state.save(self.stored, self.slot.write(), disk)
    }

    /// Sets it to the value that was saved last, where this controller has that; otherwise to its default.
    fn restore(&self, state: &KeptState) {
        match state.known(self.stored) {
            Some(text) => self.slot.read(text),
            None => self.slot.read(&(self.default)()),
        };
    }
}

/// A variable as text.
trait Slot {
    fn write(&self) -> String;
    fn read(&self, text: &str) -> bool;

    /// Whether it may have changed since the last call.
    fn take_changed(&self) -> bool {
        true
    }
}

impl<T: StateFormat> Slot for Shared<T> {
    fn write(&self) -> String {
        self.with(encode)
    }

    fn read(&self, text: &str) -> bool {
        let value = T::read(&mut text.split_ascii_whitespace());
        value.map(|value| self.set(value)).is_some()
    }
}

impl<T: StateFormat> Slot for Watched<T> {
    fn write(&self) -> String {
        self.with(encode)
    }

    fn read(&self, text: &str) -> bool {
        let value = T::read(&mut text.split_ascii_whitespace());
        value.map(|value| self.set(value)).is_some()
    }

    fn take_changed(&self) -> bool {
        Watched::take_changed(self)
    }
}

impl<T: StateFormat + Copy> Slot for Cell<T> {
    fn write(&self) -> String {
        encode(&self.get())
    }

    fn read(&self, text: &str) -> bool {
        let mut words = text.split_ascii_whitespace();
        let value = T::read(&mut words).filter(|_| words.next().is_none());
        value.map(|value| self.set(value)).is_some()
    }
}

fn encode<T: StateFormat>(value: &T) -> String {
    let mut text = String::new();
    value.write(&mut text);
    text
}

/// Sets stored variables to the values that were saved last.
pub(crate) fn load(variables: &[RetainedVariable<'_>], state: &mut KeptState) -> Result<(), StateError> {
    for kept in variables {
        let text = state.load(kept.stored)?;
        if let Some(text) = text
            && !kept.slot.read(&text)
        {
            return Err(state.damaged(kept.stored));
        }
        kept.slot.take_changed();
    }
    Ok(())
}

/// Sets the variables of chapter 10.1 to the values that were saved last, and the names and program numbers of chapter
/// 10.2 to their defaults.
pub(crate) fn restore(system: &System, state: &KeptState) {
    system.pgno.set(NO_PROGRAM_NUMBER);
    for kept in system.kept() {
        if kept.always {
            // Names have been saved with every change, so they stay.
            let known = arl_lang::catalog::system_variable(kept.name);
            if known.is_some_and(|variable| variable.section.starts_with("10.2.")) {
                kept.slot.read(&(kept.default)());
            }
        } else {
            kept.restore(state);
        }
    }
}

/// Begins to save the variables all of whose changes are stored, where they have changed.
pub(crate) fn store_changed(system: &System, state: &mut KeptState, disk: &Disk) -> Result<(), StateError> {
    for kept in system.kept() {
        if kept.always && kept.slot.take_changed() {
            let text = kept.slot.write();
            let same = match state.known(kept.stored) {
                Some(known) => known == text,
                None => text == (kept.default)(),
            };
            if !same && let Some(Err(error)) = state.save(kept.stored, text, disk).take() {
                return Err(error);
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::values::text::{Print, Style};
    use arl_lang::catalog::{Access, Base, Family, Restore, SystemVariable};
    use arl_lang::symbol::Interner;

    /// Puts the default of the catalog into a fresh variable of our type.
    fn catalog_default(variable: &SystemVariable, slot: &dyn Teach) -> bool {
        let mut names = Interner::default();
        let parsed = arl_lang::parse_expression(variable.default, &mut names, Default::default());
        assert!(parsed.errors.is_empty(), "{}: {}", variable.name, variable.default);
        slot.teach(&parsed.expr, &names).is_ok()
    }

    #[test]
    fn all_variables_of_the_catalog_are_there() {
        let system = System::new();
        let all = system.all();
        for variable in arl_lang::catalog::system_variables() {
            let found = all.iter().find(|(field, ..)| *field == variable.field);
            let Some((_, name, restore, type_name, _)) = found else {
                panic!("${} has no field {}", variable.name, variable.field);
            };
            assert_eq!(*name, variable.name);
            if variable.dims.is_empty() == type_name.contains('[') {
                panic!("${}: {type_name} for dimensions {:?}", variable.name, variable.dims);
            }
            let expected = match (variable.restore, variable.access) {
                (Restore::Saved, _) => "Saved",
                (Restore::Permanent, Access::ReadWrite) => "Permanent",
                (Restore::Permanent, Access::ReadOnly) => "Constant",
                (Restore::Reset, _) => "Reset",
                (Restore::Startup, _) => "Current",
            };
            assert_eq!(*restore, expected, "${}", variable.name);
            let _ = Base::Int;
        }
    }

    #[test]
    fn defaults_are_those_of_the_catalog() {
        let system = System::new();
        macro_rules! same {
            ($($field:ident: $fresh:expr),*) => { $({
                let name = stringify!($field);
                let variable = arl_lang::catalog::system_variables().find(|variable| variable.field == name).unwrap();
                let fresh = $fresh;
                assert!(catalog_default(variable, &fresh), "{name}");
                assert_eq!(fresh.get().printed(&Style::START), system.$field.get().printed(&Style::START), "{name}");
            })* };
        }
        same! {
            dfspeed: Cell::new(Speed::default()), dfslip: Cell::new(Slip::default()), dftool: Cell::new(Tool::default()),
            dfwobj: Shared::new(Wobj::default()), world: Shared::new(Wobj::default()),
            flange: Cell::new(Tool::default()), config_check: Cell::new(false), pgno: Cell::new(0), pi: Cell::new(0.0),
            ctl_mode: Cell::new(Controlmode::Manual), vel_profile: Cell::new(VelProfile::T),
            cjoint: Cell::new(Joint::default())
        }
    }

    #[test]
    fn variables_of_types_that_depend_on_the_family_have_a_scara_s_view() {
        let families = arl_lang::catalog::system_variables().filter(|variable| match variable.ty {
            Base::Struct(id) => id.def(Family::SixAxis).rust != id.def(Family::Scara).rust,
            _ => false,
        });
        assert_eq!(families.map(|variable| variable.field).collect::<Vec<_>>(), ["j", "dfslip", "cjoint"]);
    }

    #[test]
    fn kept_variables_survive_as_text() {
        let (one, other) = (System::new(), System::new());
        one.i.update(|i| i[99] = -7);
        one.d.update(|d| d[..4].copy_from_slice(&[0.1, -1e300, f64::INFINITY, 9e9]));
        one.b.update(|b| b[3] = true);
        one.i_name.update(|names| names[0] = "a \"b\"\n\u{e4} \\%".into());
        one.p.update(|p| p[1] = Pose { x: 1.5, cfg: 3, turn: 5, ej6: 1.0 / 3.0, ..Pose::default() });
        one.tools.update(|tools| tools[1].t_frame.z = 120.5);
        one.wobjs.update(|wobjs| wobjs[2].mu_name = "R 1".into());
        one.tool_inertia.update(|loads| loads[3].inertiatensor.izz = 2.5);
        let (from, to) = (one.kept(), other.kept());
        for (from, to) in from.iter().zip(&to) {
            assert!(to.slot.read(&from.slot.write()), "{}", from.name);
            assert_eq!(from.slot.write(), to.slot.write());
            assert!(!to.slot.read("1 2 3"), "{}: too short", from.name);
        }
        assert_eq!(other.i_name.with(|names| names.at(0)), "a \"b\"\n\u{e4} \\%");
        assert_eq!(other.p.with(|p| p.at(1).ej6), 1.0 / 3.0);
    }
}
