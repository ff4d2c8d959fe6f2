//! Checks the text of a URDF before the library reads it: the library accepts numbers that are not valid, and reads
//! nested elements by recursion.

use arl_robot::cell::LARGEST_MM;
use quick_xml::Reader;
use quick_xml::events::{BytesStart, Event};

/// Elements of a URDF are nested four deep, those that other programs add to it somewhat deeper.
const DEEPEST: usize = 64;
/// No place is farther and no length is greater, in m.
const LARGEST_M: f64 = LARGEST_MM / 1000.0;
/// No other number is larger: angles, speeds, scales, masses.
const LARGEST: f64 = 1e6;
/// How much of a wrong value is shown.
const SHOWN_CHARS: usize = 40;
/// What a robot is made of; everything else in it belongs to other programs.
const PARTS: [&str; 3] = ["link", "joint", "material"];

/// Attributes that are numbers: of which element, how many there are, and how large each may be.
const NUMBERS: &[(&str, &str, usize, f64)] = &[
    ("origin", "xyz", 3, LARGEST_M),
    ("origin", "rpy", 3, LARGEST),
    ("origin", "quat_xyzw", 4, LARGEST),
    ("axis", "xyz", 3, LARGEST),
    ("box", "size", 3, LARGEST_M),
    ("cylinder", "radius", 1, LARGEST_M),
    ("cylinder", "length", 1, LARGEST_M),
    ("capsule", "radius", 1, LARGEST_M),
    ("capsule", "length", 1, LARGEST_M),
    ("sphere", "radius", 1, LARGEST_M),
    ("mesh", "scale", 3, LARGEST),
    ("limit", "lower", 1, LARGEST),
    ("limit", "upper", 1, LARGEST),
    ("limit", "velocity", 1, LARGEST),
    ("color", "rgba", 4, LARGEST),
    ("mass", "value", 1, LARGEST),
    ("inertia", "ixx", 1, LARGEST),
    ("inertia", "ixy", 1, LARGEST),
    ("inertia", "ixz", 1, LARGEST),
    ("inertia", "iyy", 1, LARGEST),
    ("inertia", "iyz", 1, LARGEST),
    ("inertia", "izz", 1, LARGEST),
];

/// Checks that a text is XML of no unusual depth, and that every number in use is one that a robot can have.
///
/// # Errors
/// What is wrong, with the line.
pub(super) fn vet(text: &str) -> Result<(), String> {
    let mut reader = Reader::from_str(text);
    let mut at = Transform { text, offset: 0, line: 1 };
    let mut depth = 0;
    // The part of the robot that is being read, by its element and its name.
    let mut part: Option<String> = None;
    loop {
        let begins = reader.buffer_position();
        let event = reader.read_event();
        at.go_to(usize::try_from(begins).unwrap_or(usize::MAX));
        match event.map_err(|error| format!("this is not URDF: line {}: {error}", at.line))? {
            Event::Start(tag) => {
                look_at(&tag, depth, &mut part, at.line)?;
                depth += 1;
                if depth > DEEPEST {
                    return Err(format!("line {}: elements are nested deeper than {DEEPEST}", at.line));
                }
            }
            Event::Empty(tag) => look_at(&tag, depth, &mut part, at.line)?,
            Event::End(_) => depth = depth.saturating_sub(1),
            Event::Eof => return Ok(()),
            _ => {}
        }
    }
}

/// Checks an element that has `depth` others around it.
fn look_at(tag: &BytesStart<'_>, depth: usize, part: &mut Option<String>, line: usize) -> Result<(), String> {
    let name = tag.name();
    let element: &str = name.as_ref();
    if depth <= 1 {
        let of = || attribute(tag, "name").map_or_else(String::new, |name| format!(" of the {element} `{name}`"));
        *part = (depth == 1 && PARTS.contains(&element)).then(of);
    }
    let Some(part) = part else { return Ok(()) };
    for (_, key, count, most) in NUMBERS.iter().filter(|(of, ..)| *of == element) {
        let Some(value) = attribute(tag, key) else { continue };
        if !are_numbers(&value, *count, *most) {
            let wanted = if *count == 1 { "a number".to_owned() } else { format!("{count} numbers") };
            let value: String = value.chars().take(SHOWN_CHARS).collect();
            return Err(format!(
                "line {line}: `{key}` of `{element}`{part}: expected {wanted} from -{most} to {most}, found `{}`",
                value.escape_debug()
            ));
        }
    }
    Ok(())
}

fn attribute(tag: &BytesStart<'_>, key: &str) -> Option<String> {
    let mut attributes = tag.attributes();
    let mut all = attributes.with_checks(false).filter_map(Result::ok);
    let found = all.find(|attribute| attribute.key.as_ref() == key)?;
    Some(found.value.trim().to_owned())
}

fn are_numbers(text: &str, count: usize, most: f64) -> bool {
    let mut found = 0;
    let all = text.split_whitespace().all(|word| {
        found += 1;
        word.parse::<f64>().is_ok_and(|number| number.abs() <= most)
    });
    all && found == count
}

/// A place in a text, with its line from 1.
struct Transform<'a> {
    text: &'a str,
    offset: usize,
    line: usize,
}

impl Transform<'_> {
    fn go_to(&mut self, offset: usize) {
        let over = self.text.as_bytes().get(self.offset..offset).unwrap_or_default();
        self.line += over.iter().filter(|byte| **byte == b'\n').count();
        self.offset = self.offset.max(offset);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_held_where_they_stand() {
        let robot = |body: &str| format!("<?xml version=\"1.0\"?>\n<robot name=\"a\">\n{body}\n</robot>\n");
        let link = |form: &str| robot(&format!("<link name=\"b\">\n<visual>\n{form}</visual>\n</link>"));
        for (text, words) in [
            (
                link("<origin xyz=\"0 0 nan\"/>"),
                "line 5: `xyz` of `origin` of the link `b`: expected 3 numbers from -1000 to 1000, found `0 0 nan`",
            ),
            (link("<origin rpy=\"0 inf 0\"/>"), "found `0 inf 0`"),
            (link("<origin xyz=\"0 0 1e300\"/>"), "found `0 0 1e300`"),
            (link("<origin xyz=\"0 0 x 1\"/>"), "found `0 0 x 1`"),
            (link("<origin xyz=\"0 0\"/>"), "found `0 0`"),
            (
                link("<geometry><sphere radius=\"\"/></geometry>"),
                "`radius` of `sphere` of the link `b`: expected a number",
            ),
            (link("<geometry>\n<mesh filename=\"a.stl\" scale=\"1 1 NaN\"/></geometry>"), "line 6: `scale` of `mesh`"),
            (robot("<joint name=\"j\"><limit lower=\"-inf\"/></joint>"), "line 3: `lower` of `limit` of the joint `j`"),
            (robot("<material name=\"m\"><color rgba=\"1 1 1\"/></material>"), "expected 4 numbers"),
            (robot(&"<link>".repeat(70)), "line 3: elements are nested deeper than 64"),
            (robot("</link>"), "this is not URDF: line 3: "),
        ] {
            let problem = vet(&text).expect_err(words);
            assert!(problem.contains(words), "{problem}\ninstead of {words}");
        }
        for right in [
            link("<origin xyz=\" 0 -1.5e-3\n2 \" rpy=\"0 0 3.14\"/>"),
            // What other programs add to it is not checked.
            robot("<gazebo><origin xyz=\"as you like\"/></gazebo><link name=\"c\"/>"),
            robot("<transmission name=\"t\"><joint name=\"j\"><limit lower=\"none\"/></joint></transmission>"),
        ] {
            assert_eq!(vet(&right), Ok(()), "{right}");
        }
    }

    #[test]
    fn depth_and_length_cost_no_more_than_reading() {
        let nested = "<robot name=\"a\">".to_owned() + &"<link name=\"b\">".repeat(200_000);
        assert!(vet(&nested).is_err_and(|problem| problem.contains("nested deeper")));
        let long = format!("<robot name=\"a\">{}</robot>", "\n<link name=\"b\"/>".repeat(200_000));
        assert_eq!(vet(&long), Ok(()));
    }
}
