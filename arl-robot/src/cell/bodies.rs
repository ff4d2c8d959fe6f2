//! What stands in a cell or is carried by its robots: `[[body]]` of a cell file.

use std::path::{Path, PathBuf};

use super::{Names, Signal, SignalKind};
use crate::channels::Channels;
use crate::kinematics::{Frame, frame};
use crate::settings::{Section, SettingsError, Value, hint, kind, number, table};

const BODY: &[&str] = &["name", "box", "cylinder", "mesh", "at", "on", "channel", "when", "may_touch"];
/// What a body may be fixed to.
const HOLDERS: &[&str] = &["world", "flange"];
/// No cell is larger, in mm.
const LARGEST_MM: f64 = 1e6;

/// A body.
#[derive(Clone, PartialEq, Debug)]
pub struct Body {
    /// What people call it.
    pub name: String,
    /// Its form.
    pub solid: Solid,
    /// Where its middle is (the origin of a mesh), in what it is fixed to: in the world or in the flange, translation in mm.
    pub at: Frame,
    /// The channel, from 1, whose robot carries it on its flange; `None`: it stands in the world.
    pub carried_by: Option<u32>,
    /// It is there only while this digital input or output has this level.
    pub when: Option<(Signal, bool)>,
    /// The names of bodies, and of parts of robots, that it may touch.
    pub may_touch: Vec<String>,
}

/// The form of a body, around its middle.
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
    /// The triangles of an STL file, in mm.
    Mesh(PathBuf),
}

impl Body {
    /// The bodies of a cell file that lies in `folder`.
    pub(super) fn read_all(
        top: &Section<'_>,
        (channels, names): (&Channels, &Names),
        (foreground, folder): (u32, &Path),
    ) -> Result<Vec<Self>, SettingsError> {
        let tables = super::tables(top, "body", "tables that begin with [[body]]")?;
        let mut bodies: Vec<Self> = Vec::new();
        for value in tables {
            let section = table(top.source, value, "[[body]]", BODY)?;
            let body = Self::read(&section, value, (channels, names), (foreground, folder))?;
            if bodies.iter().any(|other| other.name == body.name) {
                return Err(top.source.error(value.span(), format!("there is another [[body]] named `{}`", body.name)));
            }
            bodies.push(body);
        }
        Ok(bodies)
    }

    fn read(
        section: &Section<'_>,
        value: &Value<'_>,
        (channels, names): (&Channels, &Names),
        (foreground, folder): (u32, &Path),
    ) -> Result<Self, SettingsError> {
        let lacks = |what: &str| section.source.error(value.span(), format!("this [[body]] lacks {what}"));
        let what = "what it is called, like \"table\"";
        let name = section.text("name", what)?.ok_or_else(|| lacks("`name`"))?;
        if let (Some(found), true) = (section.find("name"), name.is_empty() || name.contains(char::is_control)) {
            return Err(section.wrong("name", found, what));
        }
        let holder = section.text("on", "\"world\" or \"flange\"")?.unwrap_or("world");
        if !HOLDERS.contains(&holder) {
            let text =
                format!("a body is on \"world\" or on \"flange\", not on \"{holder}\"; {}", hint(holder, HOLDERS));
            return Err(section.source.error(section.find("on").map_or(value.span(), |on| on.span()), text));
        }
        let channel = match section.find("channel") {
            None => 1,
            Some(found) => match number(found.get_ref()) {
                Some(channel) if channel.fract() == 0.0 && (1.0..=f64::from(foreground)).contains(&channel) => {
                    channel as u32
                }
                _ => {
                    let expected = format!("the channel of the robot that carries it, from 1 to {foreground}");
                    return Err(section.wrong("channel", found, &expected));
                }
            },
        };
        if holder == "world" && section.find("channel").is_some() {
            let text = "`channel` says whose flange carries a body; this one stands in the world";
            return Err(section.source.error(section.find("channel").map_or(value.span(), |at| at.span()), text));
        }
        Ok(Self {
            name: name.to_owned(),
            solid: solid(section, folder)?.ok_or_else(|| lacks("its form: `box`, `cylinder` or `mesh`"))?,
            at: place(section)?,
            carried_by: (holder == "flange").then_some(channel),
            when: when(section, channels, names)?,
            may_touch: may_touch(section)?,
        })
    }
}

/// The form; one of the three.
fn solid(section: &Section<'_>, folder: &Path) -> Result<Option<Solid>, SettingsError> {
    let mut found = None;
    for key in ["box", "cylinder", "mesh"] {
        let Some(value) = section.find(key) else { continue };
        if found.is_some() {
            let text = "a [[body]] has one form: `box`, `cylinder` or `mesh`";
            return Err(section.source.error(value.span(), text));
        }
        found = Some(match key {
            "box" => {
                let expected = "its edges along x, y and z in mm, like [800, 600, 40]";
                let edges = lengths(value).and_then(|edges| <[f64; 3]>::try_from(edges).ok());
                Solid::Box(edges.ok_or_else(|| section.wrong(key, value, expected))?)
            }
            "cylinder" => {
                let expected = "its radius and its length along z in mm, like [30, 200]";
                let two = lengths(value).and_then(|two| <[f64; 2]>::try_from(two).ok());
                let [radius, length] = two.ok_or_else(|| section.wrong(key, value, expected))?;
                Solid::Cylinder { radius, length }
            }
            _ => {
                let file = section.text(key, "an STL file, like \"fixture.stl\"")?.unwrap_or_default();
                Solid::Mesh(folder.join(file))
            }
        });
    }
    Ok(found)
}

/// Lengths above 0.
fn lengths(value: &Value<'_>) -> Option<Vec<f64>> {
    let all = value.get_ref().as_array()?.iter().map(|one| number(one.get_ref())).collect::<Option<Vec<f64>>>()?;
    all.iter().all(|length| *length > 0.0 && *length <= LARGEST_MM).then_some(all)
}

fn place(section: &Section<'_>) -> Result<Frame, SettingsError> {
    let Some(value) = section.find("at") else { return Ok(Frame::identity()) };
    let all: Option<Vec<f64>> =
        value.get_ref().as_array().and_then(|all| all.iter().map(|one| number(one.get_ref())).collect());
    match all.as_deref() {
        Some([x, y, z]) => Ok(frame([*x, *y, *z, 0.0, 0.0, 0.0])),
        Some([x, y, z, a, b, c]) => Ok(frame([*x, *y, *z, *a, *b, *c])),
        _ => {
            let expected =
                "x, y, z in mm, with a, b, c in deg if it is turned, like [800, 0, -20] or [800, 0, 0, 90, 0, 0]";
            Err(section.wrong("at", value, expected))
        }
    }
}

fn may_touch(section: &Section<'_>) -> Result<Vec<String>, SettingsError> {
    let Some(value) = section.find("may_touch") else { return Ok(Vec::new()) };
    let names = value.get_ref().as_array().and_then(|all| all.iter().map(|one| one.get_ref().as_str()).collect());
    let names: Option<Vec<&str>> = names;
    let expected = "the names of bodies and of parts of robots, like [\"table\", \"the hand\"]";
    Ok(names.ok_or_else(|| section.wrong("may_touch", value, expected))?.into_iter().map(str::to_owned).collect())
}

fn when(section: &Section<'_>, channels: &Channels, names: &Names) -> Result<Option<(Signal, bool)>, SettingsError> {
    let expected = "a digital input or output, like \"do.1\", or \"!do.1\" where it is to be off";
    let (Some(text), Some(value)) = (section.text("when", expected)?, section.find("when")) else { return Ok(None) };
    let (text, level) = text.strip_prefix('!').map_or((text, true), |text| (text, false));
    let signal = names.signal(text).or_else(|| Signal::parse(text));
    let is_digital = |signal: &Signal| matches!(signal.kind, SignalKind::DigitalInput | SignalKind::DigitalOutput);
    let Some(signal) = signal.filter(is_digital) else {
        return Err(section.wrong("when", value, expected));
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
                    [[body]]\nname = \"fixture\"\nmesh = \"fixture.stl\"\nwhen = \"!di.1\"\nmay_touch = [\"part\"]\n\
                    [[body]]\nname = \"tool\"\nbox = [1, 2, 3]\non = \"flange\"\nchannel = 2\n\
                    [[channel]]\nprogram = \"b.arl\"\n";
        let cell = Cell::parse("cells/a.toml", text).unwrap();
        let [table, part, fixture, tool] = &cell.bodies[..] else { panic!("four") };
        assert_eq!((&table.solid, table.carried_by, table.when), (&Solid::Box([800.0, 600.0, 40.0]), None, None));
        assert_eq!(table.at, frame([900.0, 0.0, -20.0, 0.0, 0.0, 0.0]));
        assert_eq!(part.solid, Solid::Cylinder { radius: 20.0, length: 50.5 });
        assert_eq!((part.carried_by, part.when), (Some(1), Signal::parse("do.3").map(|signal| (signal, true))));
        assert_eq!(
            (fixture.when, &fixture.may_touch[..]),
            (Signal::parse("di.1").map(|signal| (signal, false)), &["part".into()][..])
        );
        assert_eq!(fixture.solid, Solid::Mesh(PathBuf::from("cells/fixture.stl")));
        assert_eq!(tool.carried_by, Some(2));
    }

    #[test]
    fn mistakes_say_what_would_be_right() {
        for (text, line, words) in [
            ("body = 3", 1, "tables that begin with [[body]]"),
            ("[[body]]\nbox = [1, 2, 3]", 1, "lacks `name`"),
            ("[[body]]\nname = \"a\"", 1, "lacks its form: `box`, `cylinder` or `mesh`"),
            ("[[body]]\nname = \"a\"\nbox = [1, 2]", 3, "its edges along x, y and z in mm"),
            ("[[body]]\nname = \"a\"\nbox = [1, 2, 0]", 3, "its edges along x, y and z in mm"),
            ("[[body]]\nname = \"a\"\nbox = [1, 2, 3]\nmesh = \"a.stl\"", 4, "a [[body]] has one form"),
            ("[[body]]\nname = \"a\"\ncylinder = [-1, 2]", 3, "its radius and its length"),
            ("[[body]]\nname = \"a\"\nbox = [1, 2, 3]\nat = [1, 2]", 4, "x, y, z in mm"),
            ("[[body]]\nname = \"a\"\nbox = [1, 2, 3]\non = \"flansh\"", 4, "did you mean `flange`?"),
            ("[[body]]\nname = \"a\"\nbox = [1, 2, 3]\nchannel = 1", 4, "this one stands in the world"),
            ("[[body]]\nname = \"a\"\nbox = [1, 2, 3]\non = \"flange\"\nchannel = 2", 5, "from 1 to 1"),
            ("[[body]]\nname = \"\"\nbox = [1, 2, 3]", 2, "what it is called"),
            ("[[body]]\nname = \"a\"\nbox = [1, 2, 3]\nmay_touch = \"b\"", 4, "the names of bodies"),
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
