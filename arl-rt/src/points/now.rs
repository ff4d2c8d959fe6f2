//! `saveposenow` and `savejointnow`: points of a running program, in its data file and in its memory.

use std::path::Path;

use arl_lang::symbol::Interner;

use super::{Components, of_joint, of_pose, replace};
use crate::channel::number;
use crate::cx::Cx;
use crate::data;
use crate::fault::Fault;
use crate::program::{DataVar, Program};
use crate::values::{Joint, Pose, Str};

/// Writes a pose to a point of the program that a foreground channel runs, in its data file and in the program itself,
/// where it counts at once; whether it worked. It does not wait for motion.
///
/// # Errors
/// The channel is not within 1 to 6.
pub async fn saveposenow(cx: &Cx, channel: u32, file_name: &Str, pose_name: &Str, p: Pose) -> Result<bool, Fault> {
    save(cx, "saveposenow", channel, file_name, "pose", pose_name, of_pose(p)).await
}

/// Writes a joint to a point of the program that a foreground channel runs, in its data file and in the program itself,
/// where it counts at once; whether it worked. It does not wait for motion.
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
    ty: &str,
    point: &Str,
    value: Components,
) -> Result<bool, Fault> {
    let number = number(function, channel)?;
    let (Some(there), Some(value)) = (cx.world().foreground(number), value.literal()) else { return Ok(false) };
    let scripts = cx.world().scripts.path();
    let saved = write(there.program_itself(), &file.to_text(), ty, &point.to_text(), &value, scripts).is_some();
    // A disk is slow: one write a cycle.
    cx.next_cycle().await;
    Ok(saved)
}

/// Writes a value to the file and then to the variable. `None` where there is no such point, or where it cannot be written.
fn write(program: &dyn Program, file: &str, ty: &str, point: &str, value: &str, scripts: &Path) -> Option<()> {
    let files = program.data();
    let data = files.iter().find(|data| is_meant(file, data.file))?;
    let is_point = |var: &&DataVar<'_>| {
        var.name.eq_ignore_ascii_case(point) && var.sizes.is_empty() && var.slot.type_name().eq_ignore_ascii_case(ty)
    };
    let var = data.vars.iter().find(is_point)?;
    let mut names = Interner::default();
    let parsed = arl_lang::parse_expression(value, &mut names, arl_lang::ParseOptions::default());
    let path = data::place(data.file, program, scripts)?;
    replace(&path, ty, point, value)?;
    var.slot.teach(&parsed.expr, &names).ok()
}

/// Whether a data file is meant by a name: its own, or that of the program that it belongs to; with its folders, or without.
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
