//! Robot files: TOML to [`Robot`].

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::description::{Description, LARGEST, LARGEST_LIMIT, lifts};
use super::section::{RobotSection, RobotSource};
use super::{
    Axis, DriveLimits, EXTERNAL_AXES, Family, Link, Robot, RobotError, TcpLimits, VelocityProfile, axis_name, own_axes,
};
use crate::kinematics::{Kinematics, Opw, OpwParameters, Scara};
use crate::settings::kind;

const TOP: &[&str] = &["name", "family", "profile", "geometry", "tcp", "drives", "axis", "link", "home"];
const OPW: &[&str] = &["a1", "a2", "b", "c1", "c2", "c3", "c4", "offsets", "signs"];
const SCARA: &[&str] = &["l1", "l2", "z0"];
const TCP: &[&str] = &["vel", "acc", "jerk", "ori_vel", "ori_acc", "ori_jerk"];
const AXIS: &[&str] = &["name", "linear", "min", "max", "vel", "acc", "jerk", "following"];
const DRIVES: &[&str] = &["feedback", "settled", "settling"];
const LINK: &[&str] = &["mass", "com", "inertia", "gear", "torque_constant"];

/// The default of the largest distance of an axis from its set-point: the distance at full speed in this time, s.
const FOLLOWING_S: f64 = 0.1;
/// The default of the longest time without a position, and of the longest settling time, in ms.
const FEEDBACK_MS: f64 = 20.0;
const SETTLING_MS: f64 = 2000.0;
/// The default distance from its set-point at which an axis counts as settled, in deg (mm).
const SETTLED: f64 = 0.001;

const FAMILIES: [(&str, Family); 2] = [("six-axis", Family::SixAxis), ("scara", Family::Scara)];
const PROFILES: [(&str, VelocityProfile); 3] =
    [("T", VelocityProfile::T), ("S", VelocityProfile::S), ("O", VelocityProfile::O)];

pub(super) fn robot(file: &str, text: &str) -> Result<Robot, RobotError> {
    let source = RobotSource { file, text };
    let root = DeTable::parse(text).map_err(|error| {
        source.error(error.span().unwrap_or(0..0), format!("this is not TOML: {}", error.message()))
    })?;
    let top = RobotSection::new(source, "the robot file", 0..0, root.get_ref(), TOP)?;

    let name = top.text("name", "the robot's name")?.to_owned();
    let family = word(&top, "family", &FAMILIES)?;
    let profile = if top.find("profile").is_some() { word(&top, "profile", &PROFILES)? } else { VelocityProfile::S };
    let kinematics = match family {
        Family::SixAxis => Kinematics::SixAxis(opw(&table(&top, "geometry", "[geometry]", OPW)?)?),
        Family::Scara => Kinematics::Scara(scara(&table(&top, "geometry", "[geometry]", SCARA)?)?),
    };
    let tcp = tcp(&table(&top, "tcp", "[tcp]", TCP)?)?;
    let axes = axes(&top, family)?;
    let drives = drives(&top, &axes)?;
    let links = links(&top, family)?;
    let home = home(&top, family, &axes)?;
    // Errors have been reported with their position; `new` rejects other invalid descriptions.
    Robot::new(Description { name, family, profile, kinematics, tcp, axes, drives, links, home })
}

/// One of a few words.
fn word<T: Copy>(section: &RobotSection<'_>, key: &str, words: &[(&str, T)]) -> Result<T, RobotError> {
    let all = words.iter().map(|(word, _)| format!("\"{word}\"")).collect::<Vec<_>>().join(" or ");
    let found = section.text(key, &all)?;
    words
        .iter()
        .find(|(word, _)| word.eq_ignore_ascii_case(found))
        .map(|(_, value)| *value)
        .ok_or_else(|| section.source.error(section.span_of(key), format!("`{key}` is \"{found}\": expected {all}")))
}

fn table<'a>(top: &RobotSection<'a>, key: &str, name: &'a str, known: &[&str]) -> Result<RobotSection<'a>, RobotError> {
    match top.find(key) {
        None => Err(top.source.error(top.place(), format!("{} lacks {name}, with {}", top.name, known.join(", ")))),
        Some(value) => section(top, value, name, known),
    }
}

fn section<'a>(
    top: &RobotSection<'a>,
    value: &'a Spanned<DeValue<'a>>,
    name: &'a str,
    known: &[&str],
) -> Result<RobotSection<'a>, RobotError> {
    match value.get_ref() {
        DeValue::Table(table) => RobotSection::new(top.source, name, value.span(), table, known),
        other => Err(top.source.error(value.span(), format!("expected the table {name}, found {}", kind(other)))),
    }
}

/// The tables of `[[key]]`.
fn tables<'a>(
    top: &RobotSection<'a>,
    key: &str,
    name: &'a str,
    known: &[&str],
) -> Result<Vec<RobotSection<'a>>, RobotError> {
    let Some(value) = top.find(key) else { return Ok(Vec::new()) };
    match value.get_ref() {
        DeValue::Array(array) => array.iter().map(|value| section(top, value, name, known)).collect(),
        other => Err(top.source.error(value.span(), format!("expected tables {name}, found {}", kind(other)))),
    }
}

fn opw(geometry: &RobotSection<'_>) -> Result<Opw, RobotError> {
    let length = |key| geometry.number(key, "a length in mm");
    let signs: [f64; 6] = geometry.fixed("signs", "six signs, 1 or -1", LARGEST)?;
    if signs.iter().any(|sign| sign.abs() != 1.0) {
        let message = "`signs` of [geometry]: expected six signs, 1 or -1".to_owned();
        return Err(geometry.source.error(geometry.span_of("signs"), message));
    }
    let c2 = geometry.positive_length("c2", "the length of the upper arm in mm")?;
    let c3 = geometry.positive_length("c3", "the length of the forearm in mm")?;
    Ok(Opw::new(OpwParameters {
        a1: length("a1")?,
        a2: length("a2")?,
        b: length("b")?,
        c1: length("c1")?,
        c2,
        c3,
        c4: length("c4")?,
        offsets: geometry.fixed("offsets", "six angles in deg", LARGEST)?,
        signs,
    }))
}

fn scara(geometry: &RobotSection<'_>) -> Result<Scara, RobotError> {
    Ok(Scara {
        l1: geometry.positive_length("l1", "the length of the first arm in mm")?,
        l2: geometry.positive_length("l2", "the length of the second arm in mm")?,
        z0: geometry.number("z0", "the height of the flange at j3 = 0 in mm")?,
    })
}

fn tcp(tcp: &RobotSection<'_>) -> Result<TcpLimits, RobotError> {
    Ok(TcpLimits {
        vel: tcp.positive("vel", "a speed in mm/s")?,
        acc: tcp.positive("acc", "an acceleration in mm/s2")?,
        jerk: tcp.positive("jerk", "a jerk in mm/s3")?,
        ori_vel: tcp.positive("ori_vel", "a speed in deg/s")?,
        ori_acc: tcp.positive("ori_acc", "an acceleration in deg/s2")?,
        ori_jerk: tcp.positive("ori_jerk", "a jerk in deg/s3")?,
    })
}

fn axes(top: &RobotSection<'_>, family: Family) -> Result<Vec<Axis>, RobotError> {
    let own = own_axes(family);
    let tables = tables(top, "axis", "[[axis]]", AXIS)?;
    let most = own + EXTERNAL_AXES;
    if !(own..=most).contains(&tables.len()) {
        let message = format!(
            "this family has {own} to {most} [[axis]] (j1..j{own}, then ej1.. for external axes), found {}",
            tables.len()
        );
        let place = tables.last().map_or(top.place(), RobotSection::place);
        return Err(top.source.error(place, message));
    }
    tables.iter().enumerate().map(|(at, table)| axis(table, at, family)).collect()
}

fn axis(table: &RobotSection<'_>, at: usize, family: Family) -> Result<Axis, RobotError> {
    let own = own_axes(family);
    let expected = axis_name(family, at);
    let name = table.text("name", &format!("\"{expected}\""))?;
    if !name.eq_ignore_ascii_case(&expected) {
        let message =
            format!("axis {} is named \"{name}\": expected \"{expected}\"; the axes must be in order", at + 1);
        return Err(table.source.error(table.span_of("name"), message));
    }
    let lifts = lifts(family, at);
    let linear = table.flag("linear")?;
    if at < own && linear.is_some_and(|linear| linear != lifts) {
        let message =
            format!("`linear` of {name}: whether j1 to j{own} are linear comes from the family; leave it out");
        return Err(table.source.error(table.span_of("linear"), message));
    }
    let (min, max) = (table.number("min", "the lowest position")?, table.number("max", "the highest position")?);
    if min >= max {
        let message = format!("`min` of {name} is {min}: expected less than its `max`, {max}");
        return Err(table.source.error(table.span_of("min"), message));
    }
    Ok(Axis {
        name: expected,
        linear: linear.unwrap_or(lifts),
        min,
        max,
        vel: table.positive("vel", "a speed per second")?,
        acc: table.positive("acc", "an acceleration per second squared")?,
        jerk: table.positive("jerk", "a jerk per second cubed")?,
    })
}

/// Reads the limits for monitoring the drives.
fn drives(top: &RobotSection<'_>, axes: &[Axis]) -> Result<DriveLimits, RobotError> {
    let of_axis = |(table, axis): (&RobotSection<'_>, &Axis)| match table.find("following") {
        Some(_) => table.positive("following", "a distance in deg (mm) from its set-point"),
        None => Ok(axis.vel * FOLLOWING_S),
    };
    let following = tables(top, "axis", "[[axis]]", AXIS)?.iter().zip(axes).map(of_axis).collect::<Result<_, _>>()?;
    let table = top.find("drives").map(|value| section(top, value, "[drives]", DRIVES)).transpose()?;
    let limit = |key: &str, what: &str, default: f64| match &table {
        Some(table) if table.find(key).is_some() => table.positive(key, what),
        _ => Ok(default),
    };
    let feedback = limit("feedback", "a time without a position in ms", FEEDBACK_MS)? / 1000.0;
    let settling = limit("settling", "a time for settling in ms", SETTLING_MS)? / 1000.0;
    let settled = limit("settled", "a distance in deg (mm) from its set-point", SETTLED)?;
    Ok(DriveLimits { following, feedback, settling, settled })
}

fn links(top: &RobotSection<'_>, family: Family) -> Result<Vec<Link>, RobotError> {
    let tables = tables(top, "link", "[[link]]", LINK)?;
    if !tables.is_empty() && tables.len() != own_axes(family) {
        let place = tables.last().map_or(top.place(), RobotSection::place);
        let message = format!(
            "expected {} [[link]], one for each axis of the robot, or none; found {}",
            own_axes(family),
            tables.len()
        );
        return Err(top.source.error(place, message));
    }
    let read = |link: &RobotSection<'_>| {
        Ok(Link {
            mass: link.positive("mass", "a mass in kg")?,
            com: link.fixed("com", "the centre of mass: three lengths in mm", LARGEST)?,
            inertia: link.fixed("inertia", "six moments in kg mm2: xx, xy, xz, yy, yz, zz", LARGEST_LIMIT)?,
            gear: link.positive("gear", "turns of the motor for one of the axis")?,
            torque_constant: link.positive("torque_constant", "a torque constant in Nm/A")?,
        })
    };
    tables.iter().map(read).collect()
}

/// The start position: as given, or every axis at 0, clamped to its range.
fn home(top: &RobotSection<'_>, family: Family, axes: &[Axis]) -> Result<Vec<f64>, RobotError> {
    let mut home: Vec<f64> = axes.iter().map(|axis| 0.0_f64.clamp(axis.min, axis.max)).collect();
    let what = "positions in deg (mm), one for each axis";
    let Some(given) = top.numbers("home", what)? else { return Ok(home) };
    let own = own_axes(family);
    if given.len() != own && given.len() != axes.len() {
        let message = format!("`home`: expected {own} {what} (or {}), found {}", axes.len(), given.len());
        return Err(top.source.error(top.span_of("home"), message));
    }
    for ((at, axis), (value, span)) in home.iter_mut().zip(axes).zip(given) {
        if !(axis.min..=axis.max).contains(&value) {
            let message = format!("`home` of {} is {value}: expected {} to {}", axis.name, axis.min, axis.max);
            return Err(top.source.error(span, message));
        }
        *at = value;
    }
    Ok(home)
}
