//! URDF files: the chain of their joints, and `arl2rs robots --import FILE.urdf`, which makes a robot file from a URDF
//! whose geometry fits.

mod chain;
mod fit;
mod place;
mod tree;
mod vet;

use arl_robot::{Robot, regular_file};
use arl_terminal::failure::Failure;
use chain::Moving;
pub use chain::{Chain, parse};
use fit::{Scara, SixAxes};
pub use place::Transform;
use std::fmt::Write;
use std::path::Path;
pub use tree::Tree;

/// The most joints that are named where there are too many.
const MOST_NAMED: usize = 8;
/// The values that no URDF has, as in the built-in robots: mm and deg, per s, s2, s3.
const TCP: &str = "\
[tcp]  # mm/s, mm/s2, mm/s3, deg/s, deg/s2, deg/s3
vel = 2000.0
acc = 8000.0
jerk = 80000.0
ori_vel = 500.0
ori_acc = 2000.0
ori_jerk = 20000.0
";

/// The robot file of the robot in a URDF file.
///
/// # Errors
/// The file cannot be read, is not URDF, or is of a robot that cannot have a robot file: the reason.
pub fn import(file: &Path) -> Result<String, Failure> {
    let text = regular_file::read_text(file)
        .map_err(|error| Failure::Usage(format!("cannot read {}: {error}", file.display())))?;
    robot_file(&text, &file.file_name().unwrap_or_default().to_string_lossy())
        .map_err(|problem| Failure::Usage(format!("{}: {problem}", file.display())))
}

/// The robot file of the robot of a URDF; `from` is its file's name.
///
/// # Errors
/// The text is not URDF, or is of a robot that cannot have a robot file: the reason.
pub fn robot_file(text: &str, from: &str) -> Result<String, String> {
    let robot = parse(text)?;
    let chain = Chain::of(&Tree::of(&robot)?)?;
    let (family, geometry, joints) = match chain.joints.len() {
        6 => {
            if let Some(joint) = chain.joints.iter().find(|joint| joint.slides) {
                return Err(format!("the joint `{}` slides; the axes of a six-axis robot turn", joint.name));
            }
            ("six-axis", six_axes(&fit::six_axes(&chain)?), chain.joints.iter().collect())
        }
        4 => {
            let fit = fit::scara(&chain)?;
            let joints: Vec<&Moving> = fit.order.iter().filter_map(|at| chain.joints.get(*at)).collect();
            ("scara", scara(&fit), joints)
        }
        count => {
            let mut names: Vec<&str> = chain.joints.iter().take(MOST_NAMED).map(|joint| joint.name.as_str()).collect();
            if count > MOST_NAMED {
                names.push("..");
            }
            let names = if names.is_empty() { String::new() } else { format!(" ({})", names.join(", ")) };
            return Err(format!(
                "the arm has {count} moving joints{names}; a robot file describes six turning ones, or the four of a SCARA"
            ));
        }
    };
    let name = toml::Value::String(chain.name.clone());
    let mut out = format!(
        "# Made from {from}.\n# Assumed, because a URDF does not say: acceleration 5 x the speed per second, jerk 60 x the \
         speed per second\n# squared, and all of [tcp].\n\nname = {name}\nfamily = \"{family}\"\nprofile = \"S\"\n\n\
         {geometry}\n{TCP}"
    );
    for (at, joint) in joints.iter().enumerate() {
        axis(&mut out, at, joint);
    }
    // A URDF may have values that a robot file may not have: a speed of nearly 0.
    match Robot::parse(from, &out) {
        Ok(_) => Ok(out),
        Err(error) => Err(format!("no robot file can describe it: {}", error.message)),
    }
}

/// For each axis, the index of its joint: the joints of a SCARA may be in another order.
///
/// # Errors
/// The four joints are not those of a SCARA.
pub fn order(chain: &Chain) -> Result<Vec<usize>, String> {
    if chain.joints.len() == 4 { Ok(fit::scara(chain)?.order.to_vec()) } else { Ok((0..chain.joints.len()).collect()) }
}

fn six_axes(fit: &SixAxes) -> String {
    let mut out = String::from("[geometry]  # OPW, mm and deg\n");
    for (name, length) in ["a1", "a2", "b", "c1", "c2", "c3", "c4"].iter().zip(fit.lengths) {
        // A String accepts everything that is written to it.
        let _ = writeln!(out, "{name} = {}", number(length * 1e3));
    }
    let list = |values: [String; 6]| values.join(", ");
    let offsets = fit.offsets.map(|offset| number(offset.to_degrees()));
    let _ = writeln!(out, "offsets = [{}]", list(offsets));
    let _ = writeln!(out, "signs = [{}]", list(fit.signs.map(|sign| format!("{sign}"))));
    out
}

fn scara(fit: &Scara) -> String {
    let Scara { l1, l2, z0, .. } = fit;
    let [l1, l2, z0] = [l1, l2, z0].map(|length| number(length * 1e3));
    format!(
        "[geometry]  # mm: the two arms, and the height of the flange where j3 is 0\nl1 = {l1}\nl2 = {l2}\nz0 = {z0}\n"
    )
}

fn axis(out: &mut String, at: usize, joint: &Moving) {
    let (unit, factor) = if joint.slides { ("mm", 1e3) } else { ("deg", 1f64.to_degrees()) };
    let [min, max, vel] = [joint.lower, joint.upper, joint.velocity].map(|value| value * factor);
    let (acc, jerk) = (number(5.0 * vel), number(60.0 * vel));
    // A line of a comment can hold the escaped name, whatever the name is.
    let (min, max, vel, name) = (number(min), number(max), number(vel), joint.name.escape_debug());
    let at = at + 1;
    let _ = write!(
        out,
        "\n[[axis]]  # {unit}; `{name}` in the URDF\nname = \"j{at}\"\nmin = {min}\nmax = {max}\nvel = {vel}\nacc = {acc}\njerk = {jerk}\n"
    );
}

/// A number without the noise of converting: with six decimals at most.
fn number(value: f64) -> String {
    let rounded = (value * 1e6).round() / 1e6;
    let rounded = if rounded == 0.0 { 0.0 } else { rounded };
    format!("{rounded:?}")
}

#[cfg(test)]
mod tests;
