//! The messages of RSI. The configuration of the robot's controller determines the elements; their order is free, and
//! unknown ones are ignored.

use std::io::Write;

use arl_rt::motion::Joints;
use quick_xml::Reader;
use quick_xml::events::{BytesStart, Event};

/// The longest message, in bytes.
pub const LONGEST: usize = 4096;
/// The longest answer, in bytes.
const LONGEST_ANSWER: usize = 1024;

/// A message of the robot's controller in a cycle.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Message {
    /// The time of the message in ms, which the answer has to repeat.
    pub ipoc: u64,
    /// The positions of the axes: `AIPos`, `EIPos`, in deg (mm).
    pub position: Joints,
    /// The number of external axes in it.
    pub external: usize,
    /// The number of late or missing answers: the attribute `D` of `Delay`.
    pub delay: u64,
    /// Whether the drives are on: `Ready`, if that is wired.
    pub ready: Option<bool>,
    /// The torques of the motors at the axes, in Nm: `Torque`, if that is wired.
    pub torque: Option<[f64; 6]>,
}

/// The answer to a message.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Answer {
    /// The time of the message.
    pub ipoc: u64,
    /// The desired offset of the axes from their positions at the start of RSI, in deg (mm): `AK`, `EK`.
    pub correction: Joints,
    /// The number of external axes.
    pub external: usize,
    /// Whether the robot shall stop: `Stop`.
    pub stop: bool,
}

impl Message {
    /// Parses a message; `None` if the bytes are not a message, or if it lacks the time or the axes.
    ///
    /// ```
    /// use arl_drivers::rsi::message::Message;
    ///
    /// let text = br#"<Rob Type="KUKA"><AIPos A1="1" A2="-90" A3="90" A4="0" A5="0" A6="0"/><IPOC>4208</IPOC></Rob>"#;
    /// let message = Message::parse(text).unwrap();
    /// assert_eq!((message.ipoc, message.position.axes[1]), (4208, -90.0));
    /// assert_eq!(Message::parse(b"<Rob></Rob>"), None);
    /// ```
    pub fn parse(bytes: &[u8]) -> Option<Self> {
        let mut reader = Reader::from_str(std::str::from_utf8(bytes).ok()?);
        let config = reader.config_mut();
        config.check_end_names = false;
        let mut axes = [None; 6];
        let mut external = [None; 6];
        let mut torque = [None; 6];
        let (mut ipoc, mut ready, mut delay) = (None, None, 0);
        let (mut begins, mut ends) = (false, false);
        let mut text_of = Field::Other;
        loop {
            match reader.read_event().ok()? {
                Event::Start(tag) | Event::Empty(tag) => {
                    text_of = Field::Other;
                    match tag.name().as_ref() {
                        "Rob" => begins = true,
                        "AIPos" => numbers(&tag, b'A', &mut axes)?,
                        "EIPos" => numbers(&tag, b'E', &mut external)?,
                        "Delay" => delay = number_of(&tag, "D").unwrap_or(0),
                        "Torque" => numbers(&tag, b'A', &mut torque)?,
                        "IPOC" => text_of = Field::Ipoc,
                        "Ready" => text_of = Field::Ready,
                        _ => {}
                    }
                }
                Event::Text(text) => match text_of {
                    Field::Ipoc => ipoc = Some(text.trim().parse().ok()?),
                    Field::Ready => ready = Some(matches!(text.trim(), "1" | "true" | "TRUE")),
                    Field::Other => {}
                },
                Event::End(tag) => {
                    text_of = Field::Other;
                    ends |= tag.name().as_ref() == "Rob";
                }
                Event::Eof => break,
                _ => {}
            }
        }
        let all = |numbers: [Option<f64>; 6]| -> Option<[f64; 6]> {
            let mut found = [0.0; 6];
            for (found, number) in found.iter_mut().zip(numbers) {
                *found = number?;
            }
            Some(found)
        };
        let count = external.iter().take_while(|axis| axis.is_some()).count();
        let position = Joints { axes: all(axes)?, external: external.map(Option::unwrap_or_default) };
        let torque = all(torque);
        (begins && ends).then_some(Self { ipoc: ipoc?, position, external: count, delay, ready, torque })
    }
}

/// The element that contains a text.
enum Field {
    Ipoc,
    Ready,
    Other,
}

/// An attribute that is a whole number.
fn number_of(tag: &BytesStart<'_>, key: &str) -> Option<u64> {
    let mut attributes = tag.attributes();
    attributes
        .with_checks(false)
        .filter_map(Result::ok)
        .find(|attribute| attribute.key.as_ref() == key)?
        .value
        .trim()
        .parse()
        .ok()
}

/// The attributes `A1` to `A6`, with another letter for other axes; `None` if one is not a number.
fn numbers(tag: &BytesStart<'_>, letter: u8, places: &mut [Option<f64>; 6]) -> Option<()> {
    for attribute in tag.attributes().with_checks(false) {
        let attribute = attribute.ok()?;
        let &[first, digit] = attribute.key.as_ref().as_bytes() else { continue };
        let place = digit.checked_sub(b'1').and_then(|at| places.get_mut(usize::from(at)));
        if let Some(place) = place.filter(|_| first == letter) {
            *place = Some(attribute.value.trim().parse().ok()?);
        }
    }
    Some(())
}

/// The bytes of an answer.
#[derive(Clone, Copy, Debug)]
pub struct AnswerBytes {
    bytes: [u8; LONGEST_ANSWER],
    length: usize,
}

impl AnswerBytes {
    /// The bytes.
    pub fn as_bytes(&self) -> &[u8] {
        self.bytes.get(..self.length).unwrap_or_default()
    }
}

impl Answer {
    /// The bytes of the answer. This allocates no memory.
    ///
    /// ```
    /// use arl_drivers::rsi::message::Answer;
    /// use arl_rt::motion::Joints;
    ///
    /// let correction = Joints { axes: [0.5, 0.0, 0.0, 0.0, 0.0, -1.0], external: [0.0; 6] };
    /// let answer = Answer { ipoc: 4208, correction, external: 0, stop: false }.to_bytes();
    /// let text = std::str::from_utf8(answer.as_bytes())?;
    /// assert!(text.starts_with(r#"<Sen Type="ARL"><AK A1="0.500000" A2="0.000000""#));
    /// assert!(text.ends_with("<Stop>0</Stop><IPOC>4208</IPOC></Sen>"));
    /// # Ok::<(), std::str::Utf8Error>(())
    /// ```
    pub fn to_bytes(&self) -> AnswerBytes {
        let mut bytes = [0; LONGEST_ANSWER];
        let mut place = &mut bytes[..];
        // Numbers are within the ranges of axes, so that everything fits, which a test checks.
        let _ = self.write(&mut place);
        let unused = place.len();
        AnswerBytes { bytes, length: LONGEST_ANSWER - unused }
    }

    fn write(&self, to: &mut &mut [u8]) -> std::io::Result<()> {
        let Self { ipoc, correction, external, stop } = self;
        to.write_all(b"<Sen Type=\"ARL\"><AK")?;
        for (number, value) in (1..).zip(&correction.axes) {
            write!(to, " A{number}=\"{value:.6}\"")?;
        }
        to.write_all(b"/>")?;
        if *external > 0 {
            to.write_all(b"<EK")?;
            for (number, value) in (1..).zip(correction.external.iter().take(*external)) {
                write!(to, " E{number}=\"{value:.6}\"")?;
            }
            to.write_all(b"/>")?;
        }
        write!(to, "<Stop>{}</Stop><IPOC>{ipoc}</IPOC></Sen>", u8::from(*stop))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const WHOLE: &str = "<Rob Type=\"KUKA\">\r\n<RIst X=\"1445.0\" Y=\"0.0\" Z=\"1790\" A=\"0\" B=\"90\" C=\"0\"/>\
        <AIPos A1=\"1.5\" A2=\"-90\" A3=\"90\" A4=\"0\" A5=\"1e-3\" A6=\"-2.25\"/><EIPos E1=\"100\" E2=\"0\"/>\
        <ASPos A1=\"9\" A2=\"9\" A3=\"9\" A4=\"9\" A5=\"9\" A6=\"9\"/><Delay D=\"3\"/><Tech C11=\"0\"/>\
        <Torque A1=\"1\" A2=\"2\" A3=\"3\" A4=\"4\" A5=\"5\" A6=\"6\"/><Ready>1</Ready><DiL>0</DiL>\
        <IPOC>123645634563</IPOC></Rob>";

    #[test]
    fn a_message_is_read_whatever_else_it_has() {
        let message = Message::parse(WHOLE.as_bytes()).unwrap();
        assert_eq!((message.ipoc, message.delay, message.external), (123_645_634_563, 3, 2));
        assert_eq!(message.position.axes, [1.5, -90.0, 90.0, 0.0, 0.001, -2.25]);
        assert_eq!(message.position.external, [100.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
        assert_eq!((message.ready, message.torque), (Some(true), Some([1.0, 2.0, 3.0, 4.0, 5.0, 6.0])));
    }

    #[test]
    fn what_is_no_message_is_none() {
        assert_eq!(Message::parse(WHOLE.trim_end_matches("</Rob>").as_bytes()), None);
        for wrong in ["", "<Rob", "<Rob></Rob>", "{}", "\u{fffd}", "<Sen><IPOC>1</IPOC></Sen>"] {
            assert_eq!(Message::parse(wrong.as_bytes()), None, "{wrong}");
        }
        for (right, wrong) in [
            ("A1=\"1.5\"", ""),
            ("A1=\"1.5\"", "A1=\"one\""),
            ("<IPOC>123645634563</IPOC>", ""),
            ("123645634563", "-4"),
            ("Rob", "Sen"),
        ] {
            assert_eq!(Message::parse(WHOLE.replace(right, wrong).as_bytes()), None, "{wrong}");
        }
        // The controller has to detect values that are not a number.
        let none = Message::parse(WHOLE.replace("A1=\"1.5\"", "A1=\"NaN\"").as_bytes()).unwrap();
        assert!(none.position.axes[0].is_nan());
    }

    #[test]
    fn the_longest_answer_fits() {
        let correction = Joints { axes: [-1.0e6 / 3.0; 6], external: [-1.0e6 / 3.0; 6] };
        let answer = Answer { ipoc: u64::MAX, correction, external: 6, stop: true }.to_bytes();
        let text = std::str::from_utf8(answer.as_bytes()).unwrap();
        assert!(text.contains("E6=\"-333333.333333\"/><Stop>1</Stop>") && text.ends_with("</Sen>"), "{text}");
    }
}
