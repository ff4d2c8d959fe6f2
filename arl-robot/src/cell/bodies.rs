//! Objects in a cell or carried by its robots: `[[body]]` of a cell file.

use std::collections::HashSet;
use std::path::{Path, PathBuf};

use super::{Carrier, Names, Signal, SignalKind};
use crate::channels::Channels;
use crate::kinematics::{Frame, frame};
use crate::robot::LIMB_NAMES;
use crate::settings::{Section, SettingsError, Value, hint, kind, nearest, number, table};

const BODY: &[&str] = &[
    "name",
    "box",
    "cylinder",
    "sphere",
    "mesh",
    "scale",
    "urdf",
    "at",
    "on",
    "channel",
    "when",
    "gripped_by",
    "within",
    "count",
    "may_touch",
];
/// The possible forms of a body, which has one of them.
const FORMS: [&str; 5] = ["box", "cylinder", "sphere", "mesh", "urdf"];
/// The holders to which a body may be fixed, besides carriers.
const HOLDERS: &[&str] = &["world", "flange"];
/// The largest size of a cell, in mm.
pub const LARGEST_MM: f64 = 1e6;
/// The largest turn, in deg.
const LARGEST_DEG: f64 = 1e6;
/// The most bodies of a kind in a cell.
const MOST_OF_A_KIND: f64 = 1000.0;
/// The default distance within which the TCP must be to grip a body, in mm.
const WITHIN_MM: f64 = 5.0;

/// A body.
#[derive(Clone, PartialEq, Debug)]
pub struct Body {
    /// The name.
    pub name: String,
    /// The name of its kind, if the cell has several of them: `part` of `part 1`.
    pub kind: Option<String>,
    /// Its form.
    pub form: Form,
    /// The frame of its centre (of the origin of a mesh) relative to its holder, translation in mm.
    pub at: Frame,
    /// The holder to which it is fixed.
    pub holder: Holder,
    /// The body exists only while this digital input or output has this level; for a body that a robot can take, this
    /// applies until it is taken for the first time.
    pub when: Option<(Signal, bool)>,
    /// How a robot takes the body and puts it down again, if it can be taken. At first it is in the world.
    pub grip: Option<Grip>,
    /// The names of bodies, kinds of bodies, and parts of robots that it may touch.
    pub may_touch: Vec<String>,
}

/// The holder to which a body is fixed.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Holder {
    /// Fixed in the world.
    World,
    /// The flange of the robot of a channel, from 1.
    Flange(u32),
    /// One of the cell's carriers, by its index in their list.
    Carrier(usize),
}

/// The conditions under which a robot takes a body.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Grip {
    /// The digital input or output of the gripper, and the level at which it holds.
    pub by: (Signal, bool),
    /// The channel of the robot, from 1.
    pub channel: u32,
    /// The largest distance between the TCP and the body at which it is taken, in mm.
    pub within: f64,
    /// The body appears once the previous one was taken.
    pub follows: bool,
}

/// The form of a body.
#[derive(Clone, PartialEq, Debug)]
pub enum Form {
    /// One solid, around the body's middle.
    Solid(Solid),
    /// All links of a URDF file, from its root, with its joints at 0.
    Urdf(PathBuf),
}

/// A solid.
#[derive(Clone, PartialEq, Debug)]
pub enum Solid {
    /// Its edges along x, y and z in mm.
    Box([f64; 3]),
    /// A cylinder along z.
    Cylinder {
        /// Its radius in mm.
        radius: f64,
        /// Its length in mm.
        length: f64,
    },
    /// A ball: its radius in mm.
    Sphere(f64),
    /// The triangles of an STL file.
    Mesh {
        /// The file.
        file: PathBuf,
        /// The length of its unit in mm, along x, y and z.
        scale: [f64; 3],
    },
}

impl Body {
    /// The bodies of a cell file in `folder`.
    pub(super) fn read_all(
        top: &Section<'_>,
        channels: &Channels,
        names: &Names,
        foreground: u32,
        carriers: &[Carrier],
        folder: &Path,
    ) -> Result<Vec<Self>, SettingsError> {
        let tables = super::tables(top, "body", "tables that begin with [[body]]")?;
        let mut bodies: Vec<Self> = Vec::new();
        let mut known: HashSet<String> = HashSet::new();
        let mut sections = Vec::new();
        for value in tables {
            let section = table(top.source, value, "[[body]]", BODY)?;
            sections.push(section);
            let body = Self::read(&section, value, channels, names, foreground, carriers, folder)?;
            let count = count(&section)?;
            let of_kind = count.map(|_| body.name.clone());
            let all = all_of_a_kind(body, count);
            for name in of_kind.iter().chain(all.iter().map(|body| &body.name)) {
                if !known.insert(name.clone()) {
                    let text = format!("there is another [[body]] named `{name}`");
                    return Err(top.source.error(value.span(), text));
                }
            }
            bodies.extend(all);
        }
        known.extend(parts_of_robots(foreground));
        sections.iter().try_for_each(|section| are_known(section, &known))?;
        Ok(bodies)
    }

    fn read(
        section: &Section<'_>,
        value: &Value<'_>,
        channels: &Channels,
        names: &Names,
        foreground: u32,
        carriers: &[Carrier],
        folder: &Path,
    ) -> Result<Self, SettingsError> {
        let lacks = |what: &str| section.source.error(value.span(), format!("this [[body]] lacks {what}"));
        let what = "a name, like \"table\"";
        let name = section.text("name", what)?.ok_or_else(|| lacks("`name`"))?;
        if let (Some(found), true) = (section.find("name"), name.is_empty() || name.contains(char::is_control)) {
            return Err(section.wrong("name", found, what));
        }
        let channel = channel(section, foreground, "the channel of the robot that carries it")?;
        let holder = holder(section, channel, carriers)?;
        if let (Some(found), Holder::World, None) = (section.find("channel"), holder, section.find("gripped_by")) {
            let text = "`channel` says whose robot carries a body; this one is fixed in the world";
            return Err(section.source.error(found.span(), text));
        }
        Ok(Self {
            name: name.to_owned(),
            kind: None,
            form: form(section, folder)?.ok_or_else(|| lacks(&format!("its form: {}", forms())))?,
            at: place(section, "at")?.map_or_else(Frame::identity, frame),
            holder,
            when: level(section, "when", channels, names)?,
            grip: grip(section, channels, names, channel)?,
            may_touch: may_touch(section)?,
        })
    }
}

/// The channel of a robot; the first one by default.
pub(super) fn channel(section: &Section<'_>, foreground: u32, what: &str) -> Result<u32, SettingsError> {
    let Some(found) = section.find("channel") else { return Ok(1) };
    let is_one = |channel: &f64| channel.fract() == 0.0 && (1.0..=f64::from(foreground)).contains(channel);
    match number(found.get_ref()).filter(is_one) {
        Some(channel) => Ok(channel as u32),
        None => Err(section.wrong("channel", found, &format!("{what}, from 1 to {foreground}"))),
    }
}

/// The holder to which a body is fixed.
fn holder(section: &Section<'_>, channel: u32, carriers: &[Carrier]) -> Result<Holder, SettingsError> {
    let expected = "\"world\", \"flange\", or the axis of a [[carrier]]";
    let (Some(on), Some(found)) = (section.text("on", expected)?, section.find("on")) else { return Ok(Holder::World) };
    match (on, Carrier::find(carriers, on, channel)) {
        ("world", _) => Ok(Holder::World),
        ("flange", _) => Ok(Holder::Flange(channel)),
        (_, Some(carrier)) => Ok(Holder::Carrier(carrier)),
        _ => {
            let known: Vec<&str> = HOLDERS.iter().copied().chain(Carrier::axes_of(carriers, channel)).collect();
            let text = match carriers.iter().find(|carrier| carrier.axis == on) {
                Some(other) => {
                    format!(
                        "the [[carrier]] of `{on}` is of channel {}, but this body is of channel {channel}",
                        other.channel
                    )
                }
                None => format!("a body is on {expected}, not on \"{on}\"; {}", hint(on, &known)),
            };
            Err(section.source.error(found.span(), text))
        }
    }
}

/// The number of bodies of a kind, if given.
fn count(section: &Section<'_>) -> Result<Option<u32>, SettingsError> {
    let count = section.number("count", "how many of these bodies come one after another", 1.0, MOST_OF_A_KIND)?;
    let (Some(count), Some(found)) = (count, section.find("count")) else { return Ok(None) };
    if count.fract() != 0.0 {
        return Err(section.wrong("count", found, "a whole number of bodies that come one after another"));
    }
    if section.find("gripped_by").is_none() {
        let text = "`count` bodies come one after another as they are taken; this one lacks `gripped_by`";
        return Err(section.source.error(found.span(), text));
    }
    Ok(Some(count as u32))
}

/// A body, or `count` bodies of its kind with numbers after their name.
fn all_of_a_kind(body: Body, count: Option<u32>) -> Vec<Body> {
    let Some(count) = count else { return vec![body] };
    let numbered = |number: u32| Body {
        name: format!("{} {number}", body.name),
        kind: Some(body.name.clone()),
        grip: body.grip.map(|grip| Grip { follows: number > 1, ..grip }),
        ..body.clone()
    };
    (1..=count).map(numbered).collect()
}

/// The forms, listed for a sentence.
fn forms() -> String {
    let [others @ .., last] = FORMS.map(|form| format!("`{form}`"));
    format!("{} or {last}", others.join(", "))
}

/// Reads the form of a body; only one is allowed.
fn form(section: &Section<'_>, folder: &Path) -> Result<Option<Form>, SettingsError> {
    let mut found = None;
    for key in FORMS {
        let Some(value) = section.find(key) else { continue };
        if found.is_some() {
            return Err(section.source.error(value.span(), format!("a [[body]] has one form: {}", forms())));
        }
        found = Some(match key {
            "box" => {
                let expected = "its edges along x, y and z in mm, like [800, 600, 40]";
                let edges = lengths(value).and_then(|edges| <[f64; 3]>::try_from(edges).ok());
                Form::Solid(Solid::Box(edges.ok_or_else(|| section.wrong(key, value, expected))?))
            }
            "cylinder" => {
                let expected = "its radius and its length along z in mm, like [30, 200]";
                let two = lengths(value).and_then(|two| <[f64; 2]>::try_from(two).ok());
                let [radius, length] = two.ok_or_else(|| section.wrong(key, value, expected))?;
                Form::Solid(Solid::Cylinder { radius, length })
            }
            "sphere" => {
                let radius = number(value.get_ref()).filter(|radius| is_length(*radius));
                Form::Solid(Solid::Sphere(
                    radius.ok_or_else(|| section.wrong(key, value, "its radius in mm, like 30"))?,
                ))
            }
            "mesh" => {
                let file = section.text(key, "an STL file, like \"fixture.stl\"")?.unwrap_or_default();
                let scale = match section.find("scale") {
                    None => 1.0,
                    Some(found) => {
                        let scale = number(found.get_ref()).filter(|scale| is_length(*scale));
                        scale
                            .ok_or_else(|| section.wrong("scale", found, "how many mm the mesh's unit is, like 1000"))?
                    }
                };
                Form::Solid(Solid::Mesh { file: folder.join(file), scale: [scale; 3] })
            }
            _ => {
                let file = section.text(key, "a URDF file, like \"fixture.urdf\"")?.unwrap_or_default();
                Form::Urdf(folder.join(file))
            }
        });
    }
    if let (Some(scale), None) = (section.find("scale"), section.find("mesh")) {
        return Err(section
            .source
            .error(scale.span(), "`scale` says in what unit a `mesh` is measured; this body has no `mesh`"));
    }
    Ok(found)
}

fn is_length(length: f64) -> bool {
    length > 0.0 && length <= LARGEST_MM
}

/// Lengths above 0.
fn lengths(value: &Value<'_>) -> Option<Vec<f64>> {
    let all = value.get_ref().as_array()?.iter().map(|one| number(one.get_ref())).collect::<Option<Vec<f64>>>()?;
    all.iter().all(|length| is_length(*length)).then_some(all)
}

/// Reads a position: x, y, z in mm, a, b, c in deg.
pub(super) fn place(section: &Section<'_>, key: &str) -> Result<Option<[f64; 6]>, SettingsError> {
    let Some(value) = section.find(key) else { return Ok(None) };
    let all: Option<Vec<f64>> =
        value.get_ref().as_array().and_then(|all| all.iter().map(|one| number(one.get_ref())).collect());
    let place = match all.as_deref() {
        Some([x, y, z]) => Some([*x, *y, *z, 0.0, 0.0, 0.0]),
        Some([x, y, z, a, b, c]) => Some([*x, *y, *z, *a, *b, *c]),
        _ => None,
    };
    match place {
        Some([at @ .., a, b, c]) if !is_near(&at, LARGEST_MM) || !is_near(&[a, b, c], LARGEST_DEG) => {
            let expected = format!("positions within {LARGEST_MM} mm and rotations within {LARGEST_DEG} deg");
            Err(section.wrong(key, value, &expected))
        }
        Some(place) => Ok(Some(place)),
        None => {
            let expected =
                "x, y, z in mm, with a, b, c in deg if it is rotated, like [800, 0, -20] or [800, 0, 0, 90, 0, 0]";
            Err(section.wrong(key, value, expected))
        }
    }
}

fn is_near(values: &[f64], most: f64) -> bool {
    values.iter().all(|value| value.abs() <= most)
}

/// The names of the parts of robots in a cell with this number of robots. With several robots, a name without a channel
/// means that part of all of them.
fn parts_of_robots(robots: u32) -> impl Iterator<Item = String> {
    let channels = if robots > 1 { robots } else { 0 };
    let of_channel = |channel: u32| LIMB_NAMES.iter().map(move |name| format!("{name} of channel {channel}"));
    LIMB_NAMES.iter().map(|name| (*name).to_owned()).chain((1..=channels).flat_map(of_channel))
}

const MAY_TOUCH: &str = "the names of bodies and of parts of robots, like [\"table\", \"the hand\"]";

/// The names in `may_touch` of a body, each with its value.
fn names_in<'a>(section: &Section<'a>) -> Result<Vec<(&'a str, &'a Value<'a>)>, SettingsError> {
    let Some(value) = section.find("may_touch") else { return Ok(Vec::new()) };
    let name = |one: &'a Value<'a>| Some((one.get_ref().as_str()?, one));
    let names = value.get_ref().as_array().and_then(|all| all.iter().map(name).collect());
    names.ok_or_else(|| section.wrong("may_touch", value, MAY_TOUCH))
}

fn may_touch(section: &Section<'_>) -> Result<Vec<String>, SettingsError> {
    Ok(names_in(section)?.into_iter().map(|(name, _)| name.to_owned()).collect())
}

/// Checks that everything that a body may touch exists.
fn are_known(section: &Section<'_>, known: &HashSet<String>) -> Result<(), SettingsError> {
    let unknown = names_in(section)?.into_iter().find(|(name, _)| !known.contains(*name));
    let Some((name, value)) = unknown else { return Ok(()) };
    let mut all: Vec<&str> = known.iter().map(String::as_str).collect();
    all.sort_unstable();
    let near = nearest(name, &all).map_or_else(String::new, |near| format!(": did you mean `{near}`?"));
    let text = format!("`may_touch`: no body and no part of a robot is called `{name}`{near}");
    Err(section.source.error(value.span(), text))
}

/// Reads how the robot of a channel takes the body, if it does.
fn grip(
    section: &Section<'_>,
    channels: &Channels,
    names: &Names,
    channel: u32,
) -> Result<Option<Grip>, SettingsError> {
    let within =
        section.number("within", "the largest distance of the TCP at which the body is taken, in mm,", 0.0, 1e4)?;
    let Some(by) = level(section, "gripped_by", channels, names)? else {
        return match section.find("within") {
            Some(found) => {
                let text = "`within` says how near the TCP must be when a body is taken; this one lacks `gripped_by`";
                Err(section.source.error(found.span(), text))
            }
            None => Ok(None),
        };
    };
    if let Some(found) = section.find("on") {
        let text = "a body with `gripped_by` is in the world until it is taken, and has no `on`";
        return Err(section.source.error(found.span(), text));
    }
    Ok(Some(Grip { by, channel, within: within.unwrap_or(WITHIN_MM), follows: false }))
}

/// Reads a digital input or output, and its required level.
fn level(
    section: &Section<'_>,
    key: &str,
    channels: &Channels,
    names: &Names,
) -> Result<Option<(Signal, bool)>, SettingsError> {
    let expected = "a digital input or output, like \"do.1\", or \"!do.1\" where it is to be off";
    let (Some(text), Some(value)) = (section.text(key, expected)?, section.find(key)) else { return Ok(None) };
    let (text, level) = text.strip_prefix('!').map_or((text, true), |text| (text, false));
    let signal = names.signal(text).or_else(|| Signal::parse(text));
    let is_digital = |signal: &Signal| matches!(signal.kind, SignalKind::DigitalInput | SignalKind::DigitalOutput);
    let Some(signal) = signal.filter(is_digital) else {
        return Err(section.wrong(key, value, expected));
    };
    let most = signal.kind.count(channels);
    if signal.channel > most {
        let (kind, found) = (signal.kind.text(), kind(value.get_ref()));
        let text = format!("the cell has {kind}.1 to {kind}.{most}, found {found}");
        return Err(section.source.error(value.span(), text));
    }
    Ok(Some((signal, level)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cell::Cell;

    #[test]
    fn bodies_are_read() {
        let text = "[names]\n\"do.3\" = \"gripper\"\n\
                    [[body]]\nname = \"table\"\nbox = [800, 600, 40]\nat = [900, 0, -20]\n\
                    [[body]]\nname = \"part\"\ncylinder = [20, 50.5]\nat = [0, 0, 100, 90, 0, 0]\non = \"flange\"\nwhen = \"gripper\"\n\
                    [[body]]\nname = \"fixture\"\nmesh = \"fixture.stl\"\nscale = 1000\nwhen = \"!di.1\"\nmay_touch = [\"part\", \"ball\"]\n\
                    [[body]]\nname = \"tool\"\nurdf = \"tool.urdf\"\non = \"flange\"\nchannel = 2\n\
                    [[body]]\nname = \"ball\"\nsphere = 15\ngripped_by = \"gripper\"\nwithin = 20\nchannel = 2\nwhen = \"di.1\"\ncount = 2\n\
                    [[channel]]\nprogram = \"b.arl\"\n";
        let cell = Cell::parse("cells/a.toml", text).unwrap();
        let [table, part, fixture, tool, ball, next] = &cell.bodies[..] else { panic!("six") };
        assert_eq!(
            (&table.form, table.holder, table.when),
            (&Form::Solid(Solid::Box([800.0, 600.0, 40.0])), Holder::World, None)
        );
        assert_eq!(table.at, frame([900.0, 0.0, -20.0, 0.0, 0.0, 0.0]));
        assert_eq!(part.form, Form::Solid(Solid::Cylinder { radius: 20.0, length: 50.5 }));
        assert_eq!((part.holder, part.when), (Holder::Flange(1), Signal::parse("do.3").map(|signal| (signal, true))));
        assert_eq!(
            (fixture.when, &fixture.may_touch[..]),
            (Signal::parse("di.1").map(|signal| (signal, false)), &["part".into(), "ball".into()][..])
        );
        let file = PathBuf::from("cells/fixture.stl");
        assert_eq!(fixture.form, Form::Solid(Solid::Mesh { file, scale: [1000.0; 3] }));
        assert_eq!((tool.holder, &tool.form), (Holder::Flange(2), &Form::Urdf(PathBuf::from("cells/tool.urdf"))));
        let grip = Grip { by: (Signal::parse("do.3").unwrap(), true), channel: 2, within: 20.0, follows: false };
        assert_eq!(
            (&ball.form, ball.holder, ball.grip),
            (&Form::Solid(Solid::Sphere(15.0)), Holder::World, Some(grip))
        );
        assert_eq!((&*ball.name, &*next.name, next.grip), ("ball 1", "ball 2", Some(Grip { follows: true, ..grip })));
        assert_eq!(next.when, Signal::parse("di.1").map(|signal| (signal, true)));
    }

    #[test]
    fn bodies_of_a_kind_have_one_name_together() {
        let text = "[[body]]\nname = \"part\"\nsphere = 1\ngripped_by = \"do.1\"\ncount = 2\nmay_touch = [\"table\", \"part\"]\n\
                    [[body]]\nname = \"table\"\nsphere = 1\nmay_touch = [\"part 2\", \"the hand\", \"the hand of channel 2\"]\n\
                    [[channel]]\nprogram = \"b.arl\"\n";
        let cell = Cell::parse("cell.toml", text).unwrap();
        let named: Vec<_> = cell.bodies.iter().map(|body| (&*body.name, body.kind.as_deref())).collect();
        assert_eq!(named, [("part 1", Some("part")), ("part 2", Some("part")), ("table", None)]);
        let twice = text.replace("\"table\"\nsphere", "\"part\"\nsphere");
        let error = Cell::parse("cell.toml", &twice).unwrap_err();
        assert!(error.message.contains("there is another [[body]] named `part`"), "{error}");
    }

    #[test]
    fn mistakes_say_what_would_be_right() {
        for (text, line, words) in [
            ("body = 3", 1, "tables that begin with [[body]]"),
            ("[[body]]\nbox = [1, 2, 3]", 1, "lacks `name`"),
            ("[[body]]\nname = \"a\"", 1, "lacks its form: `box`, `cylinder`, `sphere`, `mesh` or `urdf`"),
            ("[[body]]\nname = \"a\"\nbox = [1, 2]", 3, "its edges along x, y and z in mm"),
            ("[[body]]\nname = \"a\"\nbox = [1, 2, 0]", 3, "its edges along x, y and z in mm"),
            ("[[body]]\nname = \"a\"\nbox = [1, 2, 3]\nmesh = \"a.stl\"", 4, "a [[body]] has one form"),
            ("[[body]]\nname = \"a\"\ncylinder = [-1, 2]", 3, "its radius and its length"),
            ("[[body]]\nname = \"a\"\nbox = [1, 2, 3]\nat = [1, 2]", 4, "x, y, z in mm"),
            ("[[body]]\nname = \"a\"\nbox = [1, 2, 3]\nat = [0, 0, nan]", 4, "x, y, z in mm"),
            ("[[body]]\nname = \"a\"\nbox = [1, 2, 3]\nat = [0, 0, 1e7]", 4, "within 1000000 mm"),
            ("[[body]]\nname = \"a\"\nbox = [1, 2, 3]\nat = [0, 0, 0, 1e7, 0, 0]", 4, "within 1000000 deg"),
            ("[[body]]\nname = \"a\"\nbox = [1, 2, inf]", 3, "its edges along x, y and z in mm"),
            ("base = [0, -inf, 0]", 1, "x, y, z in mm"),
            ("[[body]]\nname = \"a\"\nbox = [1, 2, 3]\non = \"flansh\"", 4, "did you mean `flange`?"),
            ("[[body]]\nname = \"a\"\nbox = [1, 2, 3]\nchannel = 1", 4, "this one is fixed in the world"),
            ("[[body]]\nname = \"a\"\nbox = [1, 2, 3]\non = \"flange\"\nchannel = 2", 5, "from 1 to 1"),
            ("[[body]]\nname = \"a\"\nsphere = 0", 3, "its radius in mm"),
            ("[[body]]\nname = \"a\"\nmesh = \"a.stl\"\nscale = 0", 4, "how many mm the mesh's unit is"),
            ("[[body]]\nname = \"a\"\nbox = [1, 2, 3]\nscale = 1", 4, "this body has no `mesh`"),
            ("[[body]]\nname = \"a\"\nbox = [1, 2, 3]\nwithin = 1", 4, "this one lacks `gripped_by`"),
            ("[[body]]\nname = \"a\"\nbox = [1, 2, 3]\ngripped_by = \"do.1\"\non = \"flange\"", 5, "and has no `on`"),
            ("[[body]]\nname = \"a\"\nbox = [1, 2, 3]\ngripped_by = \"ao.1\"", 4, "a digital input or output"),
            ("[[body]]\nname = \"a\"\nbox = [1, 2, 3]\ncount = 2", 4, "this one lacks `gripped_by`"),
            ("[[body]]\nname = \"a\"\nbox = [1, 2, 3]\ngripped_by = \"do.1\"\ncount = 1.5", 5, "a whole number"),
            ("[[body]]\nname = \"\"\nbox = [1, 2, 3]", 2, "a name, like"),
            ("[[body]]\nname = \"a\"\nbox = [1, 2, 3]\nmay_touch = \"b\"", 4, "the names of bodies"),
            (
                "[[body]]\nname = \"table\"\nbox = [1, 2, 3]\nmay_touch = [\"the hand\", \"tabel\"]",
                4,
                "no body and no part of a robot is called `tabel`: did you mean `table`?",
            ),
            ("[[body]]\nname = \"a\"\nbox = [1, 2, 3]\nmay_touch = [\"the hnad\"]", 4, "did you mean `the hand`?"),
            ("[[body]]\nname = \"a\"\nbox = [1, 2, 3]\nmay_touch = [\"something else\"]", 4, "`something else`"),
            (
                "[[body]]\nname = \"a\"\nbox = [1, 2, 3]\nmay_touch = [\"the hand of channel 2\"]",
                4,
                "called `the hand of channel 2`",
            ),
            ("[[body]]\nname = \"a\"\nbox = [1, 2, 3]\nwhen = \"ai.1\"", 4, "a digital input or output"),
            ("[[body]]\nname = \"a\"\nbox = [1, 2, 3]\nwhen = \"do.65\"", 4, "the cell has do.1 to do.64"),
            ("[[body]]\nname = \"a\"\nbox = [1, 2, 3]\ncolour = 1", 4, "has no key `colour`"),
            (
                "[[body]]\nname = \"a\"\nbox = [1, 2, 3]\n[[body]]\nname = \"a\"\nbox = [1, 2, 3]",
                4,
                "another [[body]] named `a`",
            ),
        ] {
            let error = Cell::parse("cell.toml", text).unwrap_err();
            assert_eq!(error.line, line, "{error}");
            assert!(error.message.contains(words), "{error}");
        }
    }
}
