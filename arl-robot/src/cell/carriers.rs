//! Objects moved by external axes, with the bodies on them: `[[carrier]]` of a cell file.

use super::bodies::{channel, place};
use crate::kinematics::{Frame, LinkJoint, frame};
use crate::robot::EXTERNAL_AXES;
use crate::settings::{Section, SettingsError, Value, hint, table};

const CARRIER: &[&str] = &["axis", "channel", "at", "on"];

/// An object moved by an external axis: a turntable, a tilting table, a slide.
#[derive(Clone, PartialEq, Debug)]
pub struct Carrier {
    /// The name of the axis: `ej1` and so on.
    pub axis: String,
    /// The index of that external axis, from 0.
    pub number: usize,
    /// The channel, from 1, of the robot that has the axis.
    pub channel: u32,
    /// The frame while the axis is at 0, in the world or relative to the carrier below, translation in mm. It turns
    /// about z, or slides along z if the axis is linear.
    pub at: Frame,
    /// The index of the carrier below, which precedes it in the list; `None` if it is fixed to the world.
    pub on: Option<usize>,
}

impl Carrier {
    /// The joint by which the axis moves it relative to what it is on.
    pub fn joint(&self, linear: bool) -> LinkJoint {
        LinkJoint { origin: self.at, axis: nalgebra::Vector3::z_axis(), linear }
    }

    /// The chain of carriers from the world to the one with this index, which is the last.
    pub fn chain(all: &[Carrier], at: usize) -> Vec<&Carrier> {
        let below = |carrier: &&Carrier| carrier.on.and_then(|on| all.get(on));
        let mut chain: Vec<&Carrier> = std::iter::successors(all.get(at), below).collect();
        chain.reverse();
        chain
    }

    /// The index in the list of the carrier with this axis of the robot of a channel.
    pub(super) fn find(all: &[Carrier], axis: &str, channel: u32) -> Option<usize> {
        all.iter().position(|carrier| carrier.axis == axis && carrier.channel == channel)
    }

    /// The axes of the carriers that the robot of a channel moves.
    pub(super) fn axes_of(all: &[Carrier], channel: u32) -> impl Iterator<Item = &str> {
        all.iter().filter(move |carrier| carrier.channel == channel).map(|carrier| &*carrier.axis)
    }

    /// The carriers of a cell file with this number of channels that have robots.
    pub(super) fn read_all(top: &Section<'_>, foreground: u32) -> Result<Vec<Carrier>, SettingsError> {
        let mut carriers = Vec::new();
        for value in super::tables(top, "carrier", "tables that begin with [[carrier]]")? {
            let section = table(top.source, value, "[[carrier]]", CARRIER)?;
            carriers.push(Self::read(&section, value, foreground, &carriers)?);
        }
        Ok(carriers)
    }

    fn read(section: &Section<'_>, value: &Value<'_>, foreground: u32, all: &[Self]) -> Result<Self, SettingsError> {
        let expected = "the external axis that moves it, \"ej1\" to \"ej6\"";
        let lacks = || section.source.error(value.span(), format!("this [[carrier]] lacks `axis`, {expected}"));
        let axis = section.text("axis", expected)?.ok_or_else(lacks)?.to_owned();
        let wrong = |key: &str, text: String| {
            section.source.error(section.find(key).map_or(value.span(), |found| found.span()), text)
        };
        let number = (0..EXTERNAL_AXES).find(|number| axis == format!("ej{}", number + 1));
        let number = number.ok_or_else(|| wrong("axis", format!("expected {expected}, found \"{axis}\"")))?;
        let channel = channel(section, foreground, "the channel of the robot that has the axis")?;
        if Self::find(all, &axis, channel).is_some() {
            return Err(wrong("axis", format!("there is another [[carrier]] of `{axis}`")));
        }
        let on = match section.text("on", "\"world\", or the axis of a [[carrier]] above it")? {
            None | Some("world") => None,
            Some(below) => Some(Self::find(all, below, channel).ok_or_else(|| {
                let known: Vec<&str> = Self::axes_of(all, channel).chain(["world"]).collect();
                let hint = hint(below, &known);
                wrong("on", format!("no [[carrier]] above it has the axis `{below}` of channel {channel}; {hint}"))
            })?),
        };
        Ok(Self { axis, number, channel, at: place(section, "at")?.map_or_else(Frame::identity, frame), on })
    }
}

#[cfg(test)]
mod tests {
    use crate::cell::{Cell, Holder};

    #[test]
    fn a_table_on_a_tilting_frame() {
        let text = "[[carrier]]\naxis = \"ej1\"\nat = [1000, 0, 500, 0, 90, 0]\n\
                    [[carrier]]\naxis = \"ej2\"\non = \"ej1\"\nat = [0, 0, 100, 0, -90, 0]\n\
                    [[body]]\nname = \"disc\"\ncylinder = [200, 20]\non = \"ej2\"\n";
        let cell = Cell::parse("cell.toml", text).unwrap();
        assert_eq!(
            cell.carriers.iter().map(|carrier| (carrier.number, carrier.on)).collect::<Vec<_>>(),
            [(0, None), (1, Some(0))]
        );
        assert_eq!(cell.bodies[0].holder, Holder::Carrier(1));
    }

    #[test]
    fn mistakes_say_what_would_be_right() {
        let known = "[[carrier]]\naxis = \"ej1\"\n";
        for (text, words) in [
            ("[[carrier]]\nat = [0, 0, 0]", "lacks `axis`, the external axis that moves it, \"ej1\" to \"ej6\""),
            (
                "[[carrier]]\naxis = \"j1\"",
                "expected the external axis that moves it, \"ej1\" to \"ej6\", found \"j1\"",
            ),
            ("[[carrier]]\naxis = \"ej1\"\nchannel = 2", "the channel of the robot that has the axis, from 1 to 1"),
            ("[[carrier]]\naxis = \"ej2\"\non = \"ej1\"", "no [[carrier]] above it has the axis `ej1` of channel 1"),
            (
                "[[carrier]]\naxis = \"ej1\"\nspeed = 2",
                "[[carrier]] has no key `speed`; expected one of: axis, channel, at, on",
            ),
            (&format!("{known}{known}"), "there is another [[carrier]] of `ej1`"),
            (&format!("{known}[[body]]\nname = \"a\"\nsphere = 2\non = \"ej2\""), "did you mean `ej1`?"),
            (
                &format!(
                    "{known}[[body]]\nname = \"a\"\nsphere = 2\non = \"ej1\"\nchannel = 2\n[[channel]]\nprogram = \"b.arl\""
                ),
                "the [[carrier]] of `ej1` is of channel 1, but this body is of channel 2",
            ),
        ] {
            let error = Cell::parse("cell.toml", text).unwrap_err();
            assert!(error.message.contains(words), "{error}");
        }
    }
}
