//! `saveposenow` and `savejointnow`: points of a running program, in its data file and in its memory.

use arl_lang::symbol::Interner;

use super::{Components, Failure, NO_LITERAL, is_done, of_joint, of_pose, replace};
use crate::builtins::channel::{no_such, number, warn_of};
use crate::builtins::storing::done;
use crate::context::cx::Cx;
use crate::context::program::Program;
use crate::fault::Fault;
use crate::storage::data;
use crate::storage::data::{DataFile, DataVar};
use crate::values::{Joint, Pose, Str};

/// Writes a pose to a point of the program that a foreground channel runs, in its data file and in the program itself,
/// where it takes effect as soon as it is in the file; true on success. It does not wait for motion, and the robot
/// continues meanwhile.
///
/// # Errors
/// The channel is not within 1 to 6.
pub async fn saveposenow(cx: &Cx, channel: u32, file_name: &Str, pose_name: &Str, p: Pose) -> Result<bool, Fault> {
    save(cx, "saveposenow", channel, file_name, "pose", pose_name, of_pose(p)).await
}

/// Writes a joint to a point of the program that a foreground channel runs, in its data file and in the program itself,
/// where it takes effect as soon as it is in the file; true on success. It does not wait for motion, and the robot
/// continues meanwhile.
///
/// # Errors
/// The channel is not within 1 to 6.
pub async fn savejointnow(cx: &Cx, channel: u32, file_name: &Str, joint_name: &Str, j: Joint) -> Result<bool, Fault> {
    save(cx, "savejointnow", channel, file_name, "joint", joint_name, of_joint(j)).await
}

async fn save(
    cx: &Cx,
    function: &'static str,
    channel: u32,
    file: &Str,
    ty: &'static str,
    point: &Str,
    value: Components,
) -> Result<bool, Fault> {
    let number = number(function, channel)?;
    let Some(there) = cx.programs().foreground(number) else {
        warn_of(cx, function, &no_such(cx, number));
        return Ok(false);
    };
    let Some(value) = value.literal() else {
        warn_of(cx, function, NO_LITERAL);
        return Ok(false);
    };
    let point = Point { file: file.to_text().into_owned(), ty, name: point.to_text().into_owned() };
    let program = there.program_itself();
    let Some(data) = point.find(program, |data, _| data.file) else {
        let Point { file, name, .. } = &point;
        warn_of(
            cx,
            function,
            &format!("the program of channel {number} has no {ty} {name} in the data file of {file}"),
        );
        return Ok(false);
    };
    let places = data::places(data, &cx.shared().scripts.path().join(program.folder()));
    let (written, name) = (value.clone(), point.name.clone());
    let work = cx.shared().disk.begin(move || {
        let missing = || Failure::Problem(format!("the data file {data} was not found"));
        replace(&data::place(places).ok_or_else(missing)?, ty, &name, &written)
    });
    if !is_done(cx, function, done(work, cx).await) {
        return Ok(false);
    }
    Ok(point.find(program, |_, var| teach(var, &value)).flatten().is_some())
}

/// A point as named by a program.
struct Point {
    file: String,
    ty: &'static str,
    name: String,
}

impl Point {
    /// Calls `say` with the data file and the variable of a program that is this point; `None` if it does not exist.
    fn find<T>(&self, program: &dyn Program, say: impl FnOnce(&DataFile<'_>, &DataVar<'_>) -> T) -> Option<T> {
        let files = program.data();
        let data = files.iter().find(|data| is_meant(&self.file, data.file))?;
        let var = data.vars.iter().find(|var| {
            let same_type = var.sizes.is_empty() && var.slot.type_name().eq_ignore_ascii_case(self.ty);
            same_type && var.name.eq_ignore_ascii_case(&self.name)
        })?;
        Some(say(data, var))
    }
}

/// Gives a variable the value of a literal.
fn teach(var: &DataVar<'_>, value: &str) -> Option<()> {
    let mut names = Interner::default();
    let parsed = arl_lang::parse_expression(value, &mut names, arl_lang::ParseOptions::default());
    var.slot.teach(&parsed.expr, &names).ok()
}

/// Whether a name refers to a data file: its own name, or that of its program; with or without folders.
fn is_meant(name: &str, data: &str) -> bool {
    let plain = |name: &str| name.replace('\\', "/").to_ascii_lowercase();
    let (name, data) = (plain(name), plain(data));
    let of_program = data.strip_suffix("_data.arl").map(|stem| format!("{stem}.arl"));
    let same = |known: &str| known == name || known.rsplit('/').next() == Some(&name);
    same(&data) || of_program.is_some_and(|known| same(&known))
}

#[cfg(test)]
mod tests {
    use super::is_meant;

    #[test]
    fn a_data_file_is_named_by_itself_or_by_its_program() {
        for name in ["Prog1.arl", "prog1_data.arl", "lib/prog1.arl", "lib\\PROG1_data.arl"] {
            assert!(is_meant(name, "lib/prog1_data.arl"), "{name}");
        }
        for name in ["prog2.arl", "prog1", "other/prog1.arl", "rog1.arl", "_data.arl"] {
            assert!(!is_meant(name, "lib/prog1_data.arl"), "{name}");
        }
    }
}
