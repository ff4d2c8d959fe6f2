//! `savearl`, `savefilepose` and `savefilejoint` (manual 5.11): copies of program files, and points written into data
//! files.

mod now;

pub use now::{savejointnow, saveposenow};

use std::fmt::Write as _;
use std::io::ErrorKind;
use std::path::Path;

use arl_robot::regular_file;

use crate::builtins::channel::warn_of;
use crate::builtins::storing::done;
use crate::context::cx::Cx;
use crate::fault::Fault;
use crate::values::{Joint, Pose, Str, UNSET};
use arl_robot::atomic_file;

/// Copies a program file in the script directory; true on success. If the process is killed at any moment, either the
/// old or the new copy is there, complete. The file is copied outside the cycle, and the program continues once that is
/// done.
///
/// # Errors
/// A path leads out of the script directory.
pub async fn savearl(cx: &Cx, file_src: &Str, file_dst: &Str, mode: bool) -> Result<bool, Fault> {
    cx.motion_end().await;
    let scripts = &cx.shared().scripts;
    let (from, to) = (scripts.file(file_src)?, scripts.file(file_dst)?);
    let work = cx.shared().disk.begin(move || copy(&from, &to, mode));
    Ok(is_done(cx, "savearl", done(work, cx).await))
}

/// Whether a disk job has succeeded; warns of errors, but not of a requested refusal.
fn is_done(cx: &Cx, function: &str, done: Option<Result<(), Failure>>) -> bool {
    match done {
        Some(Ok(())) => true,
        Some(Err(Failure::Refused)) | None => false,
        Some(Err(Failure::Problem(why))) => {
            warn_of(cx, function, &why);
            false
        }
    }
}

/// The reason why nothing was written.
#[derive(Debug)]
enum Failure {
    /// Refused as requested.
    Refused,
    /// An error.
    Problem(String),
}

/// The error of a file.
fn problem(path: &Path, what: impl std::fmt::Display) -> Failure {
    Failure::Problem(format!("{} {what}", path.display()))
}

/// Copies a file; refuses to replace an existing one unless `replaces` is set.
fn copy(from: &Path, to: &Path, replaces: bool) -> Result<(), Failure> {
    if to.exists() && !replaces {
        return Err(Failure::Refused);
    }
    let content = regular_file::read(from).map_err(|error| problem(from, format_args!("cannot be read: {error}")))?;
    clear_beside(to);
    let written = if replaces { atomic_file::write(to, &content) } else { atomic_file::create(to, &content) };
    written.map_err(|error| match error.kind() {
        ErrorKind::AlreadyExists => Failure::Refused,
        _ => problem(to, format_args!("cannot be written: {error}")),
    })
}

/// Clears the directory of a file of leftovers of killed processes.
fn clear_beside(path: &Path) {
    atomic_file::remove_leftovers(atomic_file::directory_of(path));
}

/// Writes a pose to a point of a data file, whose other text stays as it is; true on success. It takes effect from the
/// next load on.
///
/// # Errors
/// The path leads out of the script directory.
pub async fn savefilepose(cx: &Cx, file_name: &Str, pose_name: &Str, p: Pose) -> Result<bool, Fault> {
    save(cx, "savefilepose", file_name, "pose", pose_name, of_pose(p)).await
}

/// The literal of a pose.
fn of_pose(p: Pose) -> Components {
    let Pose { x, y, z, a, b, c, cfg, turn, ej1, ej2, ej3, ej4, ej5, ej6 } = p;
    let mut value = Components::new();
    value.numbers(&[("x", x), ("y", y), ("z", z), ("a", a), ("b", b), ("c", c)]);
    value.whole("cfg", cfg);
    // Without `turn` the nearest solution is meant.
    if turn != -1 {
        value.whole("turn", turn);
    }
    value.numbers(&[("ej1", ej1), ("ej2", ej2), ("ej3", ej3), ("ej4", ej4), ("ej5", ej5), ("ej6", ej6)]);
    value
}

/// Writes a joint to a point of a data file, whose other text stays as it is; true on success. It takes effect from the
/// next load on.
///
/// # Errors
/// The path leads out of the script directory.
pub async fn savefilejoint(cx: &Cx, file_name: &Str, joint_name: &Str, j: Joint) -> Result<bool, Fault> {
    save(cx, "savefilejoint", file_name, "joint", joint_name, of_joint(j)).await
}

/// The literal of a joint.
fn of_joint(j: Joint) -> Components {
    let Joint { j1, j2, j3, j4, j5, j6, ej1, ej2, ej3, ej4, ej5, ej6 } = j;
    let mut value = Components::new();
    value.numbers(&[("j1", j1), ("j2", j2), ("j3", j3), ("j4", j4), ("j5", j5), ("j6", j6)]);
    value.numbers(&[("ej1", ej1), ("ej2", ej2), ("ej3", ej3), ("ej4", ej4), ("ej5", ej5), ("ej6", ej6)]);
    value
}

/// The error of a point with an infinite or NaN component.
const NO_LITERAL: &str = "a component of the point is not a number";

async fn save(
    cx: &Cx,
    function: &'static str,
    file: &Str,
    ty: &'static str,
    point: &Str,
    value: Components,
) -> Result<bool, Fault> {
    cx.motion_end().await;
    let path = cx.shared().scripts.file(file)?;
    let Some(value) = value.literal() else {
        warn_of(cx, function, NO_LITERAL);
        return Ok(false);
    };
    let point = point.to_text().into_owned();
    let work = cx.shared().disk.begin(move || replace(&path, ty, &point, &value));
    Ok(is_done(cx, function, done(work, cx).await))
}

/// The literal of a structure, under construction.
struct Components {
    text: String,
    /// Whether a literal can represent all numbers so far.
    finite: bool,
}

impl Components {
    fn new() -> Self {
        Self { text: String::new(), finite: true }
    }

    /// Adds the components that are set.
    fn numbers(&mut self, components: &[(&str, f64)]) {
        for (name, value) in components.iter().filter(|(_, value)| *value != UNSET) {
            self.finite &= value.is_finite();
            self.add(name, value);
        }
    }

    fn whole(&mut self, name: &str, value: i32) {
        self.add(name, value);
    }

    fn add(&mut self, name: &str, value: impl std::fmt::Display) {
        let comma = if self.text.is_empty() { "" } else { "," };
        // Writing to a string does not fail.
        let _ = write!(self.text, "{comma}{name} {value}");
    }

    fn literal(self) -> Option<String> {
        self.finite.then(|| format!("{{{}}}", self.text))
    }
}

/// Replaces the value of a variable of this type in a file. Fails if the file or the variable does not exist, if the
/// file has errors, and if it cannot be written.
fn replace(path: &Path, ty: &str, variable: &str, value: &str) -> Result<(), Failure> {
    clear_beside(path);
    let changed = atomic_file::change(path, |content| arl_lang::with_value(content, ty, variable, value));
    changed.map_err(|error| problem(path, error))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    fn replaced(name: &str, content: &[u8], ty: &str, variable: &str) -> Option<Vec<u8>> {
        let folder = std::env::temp_dir().join(format!("arl-rt-points-{name}-{}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        let path = folder.join("p_data.arl");
        fs::write(&path, content).unwrap();
        let done = replace(&path, ty, variable, "{x 1}");
        let now = fs::read(&path).unwrap();
        let alone = fs::read_dir(&folder).unwrap().count();
        fs::remove_dir_all(&folder).unwrap();
        assert_eq!(alone, 1, "nothing is left beside the file");
        if done.is_err() {
            assert_eq!(now, content);
        }
        done.ok().map(|()| now)
    }

    fn text(name: &str, content: &str, variable: &str) -> Option<String> {
        replaced(name, content.as_bytes(), "pose", variable).map(|bytes| String::from_utf8(bytes).unwrap())
    }

    #[test]
    fn comments_layout_and_neighbours_stay() {
        let before =
            "\u{feff}// points\r\nconst pose P1   =  {x 5,y 6} // the first\r\n\r\n  pose p2, p3 = {z 1}\r\nint n = 3";
        let first =
            "\u{feff}// points\r\nconst pose P1   =  {x 1} // the first\r\n\r\n  pose p2, p3 = {z 1}\r\nint n = 3";
        assert_eq!(text("first", before, "p1").as_deref(), Some(first));
        let second = before.replace("p2,", "p2 = {x 1},");
        assert_eq!(text("second", before, "p2"), Some(second));
        assert_eq!(text("third", before, "p3"), Some(before.replace("{z 1}", "{x 1}")));
    }

    #[test]
    fn text_in_gb18030_stays_in_gb18030() {
        let before = b"// \xd2\xc6\xb6\xaf\npose p = {x 2} // \xb5\xe3\n";
        let after = b"// \xd2\xc6\xb6\xaf\npose p = {x 1} // \xb5\xe3\n";
        assert_eq!(replaced("gb", before, "pose", "p").as_deref(), Some(&after[..]));
    }

    #[cfg(unix)]
    #[test]
    fn a_link_and_a_mode_stay() {
        use std::os::unix::fs::{PermissionsExt, symlink};
        let folder = std::env::temp_dir().join(format!("arl-rt-points-link-{}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        let (link, file) = (folder.join("p_data.arl"), folder.join("shared.arl"));
        fs::write(&file, "pose p = {x 2}\n").unwrap();
        fs::set_permissions(&file, fs::Permissions::from_mode(0o660)).unwrap();
        symlink("shared.arl", &link).unwrap();
        replace(&link, "pose", "p", "{x 1}").unwrap();
        copy(&file, &link, true).unwrap();
        assert!(link.is_symlink() && fs::metadata(&file).unwrap().permissions().mode() & 0o777 == 0o660);
        assert_eq!(fs::read_to_string(&file).unwrap(), "pose p = {x 1}\n");
        fs::remove_dir_all(&folder).unwrap();
    }

    #[test]
    fn what_cannot_be_written_says_why() {
        let folder = std::env::temp_dir().join(format!("arl-rt-points-why-{}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        let why = |name: &str, variable: &str| match replace(&folder.join(name), "pose", variable, "{x 1}") {
            Err(Failure::Problem(why)) => why.rsplit_once(name).unwrap().1.to_owned(),
            other => panic!("{other:?}"),
        };
        fs::write(folder.join("p_data.arl"), "pose p = {x 2}\n").unwrap();
        fs::write(folder.join("wrong_data.arl"), "pose p = {x 2\n").unwrap();
        assert_eq!(why("p_data.arl", "q"), " has no pose q");
        assert_eq!(why("wrong_data.arl", "p"), " has mistakes");
        assert!(why("none_data.arl", "p").starts_with(" cannot be read: "));
        let there = folder.join("p_data.arl");
        assert!(matches!(copy(&there, &there, false), Err(Failure::Refused)), "that was asked for");
        fs::remove_dir_all(&folder).unwrap();
    }

    #[test]
    fn what_is_no_such_point_stays() {
        let file = "pose p = {x 2}\njoint j = {j1 1}\npose a[2]\nfunc void main()\n  pose inner\nendfunc\n";
        for (name, variable) in [("missing", "q"), ("type", "j"), ("array", "a"), ("local", "inner")] {
            assert_eq!(text(name, file, variable), None, "{name}");
        }
        assert_eq!(text("broken", "pose p = {x 2\n", "p"), None);
    }
}
